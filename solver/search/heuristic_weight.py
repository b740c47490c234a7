"""The heuristic's weight lambda by sampling, as the paper chooses it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from solver.errors import ModelError, PlanningError
from solver.progress import Monitor, SilentMonitor
from solver.search.graph import LayeredGraph
from solver.search.sweeps import (
    METRIC_ABSOLUTE,
    METRIC_EUCLIDEAN,
    Progress,
    carry,
    total_work,
)

SHARE = 0.9
"""The paper's factor on the least sampled ratio."""

TRIES = 20
"""Draws for each wanted pair before giving up on a graph with hardly any connected pairs."""


@dataclass(frozen=True, slots=True)
class SampledWeight:
    """Ratio of graph distance to direct distance over sampled pairs.

    `weight` is 0.9 times the least ratio, but never above 1: up to there the heuristic is
    proven admissible, beyond it a sample is no proof.
    """

    ratio_min: float
    ratio_max: float
    weight: float
    pairs: int


def sample_heuristic_weight(
    graph: LayeredGraph,
    pairs: int = 50,
    seed: int = 1,
    edge: Literal["l2", "l1"] = "l2",
    monitor: Monitor | None = None,
) -> SampledWeight:
    """Compare graph distance with direct L2 distance for random pairs of nodes.

    Both nodes are drawn uniformly, in different layers; the graph distance is exact, over L2
    (as published: ratios from 1.00 to 1.24) or L1 edges of range-normalised joints, without
    node costs and gap weights. Pairs that coincide or are not connected are drawn again.

    Raises
    ------
    PlanningError
        If the graph holds too few connected pairs.
    """
    if pairs < 1 or edge not in {"l2", "l1"}:
        raise ModelError("lambda needs at least one pair, and edges 'l2' or 'l1'")
    if np.count_nonzero(graph.layer_sizes) < 2:
        raise PlanningError("lambda cannot be sampled: fewer than two layers hold a node")
    random = np.random.default_rng(seed)
    metric = METRIC_EUCLIDEAN if edge == "l2" else METRIC_ABSOLUTE
    monitor = monitor or SilentMonitor()
    free, ones = np.zeros(graph.node_count), np.ones(graph.layer_count - 1)
    values = np.empty(graph.node_count)
    ratios: list[float] = []
    for _ in range(TRIES * pairs):
        start, goal = sorted(random.integers(graph.node_count, size=2).tolist())
        first, last = (int(layer) for layer in graph.layer_of([start, goal]))
        change = (graph.joints[goal] - graph.joints[start]) / graph.ranges
        direct = float(np.linalg.norm(change))
        if first == last or direct == 0.0:
            continue
        values[graph.layer(first)] = np.inf
        values[start] = 0.0
        progress = Progress(monitor, total_work(graph, first, last))
        carry(
            graph,
            values,
            progress,
            gaps=(first, last),
            node_cost=free,
            gap_weight=ones,
            metric=metric,
        )
        if np.isfinite(values[goal]):
            ratios.append(float(values[goal]) / direct)
        if len(ratios) == pairs:
            break
    if len(ratios) < pairs:
        raise PlanningError(
            f"lambda cannot be sampled: only {len(ratios)} of {pairs} pairs are connected"
        )
    least, most = min(ratios), max(ratios)
    return SampledWeight(least, most, min(SHARE * least, 1.0), pairs)
