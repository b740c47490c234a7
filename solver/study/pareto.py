"""The front of clearance against joint motion: exact optima for a rising hard minimum."""

from __future__ import annotations

from collections.abc import Sequence as Rows

import numpy as np

from solver.analysis.result import PlanningResult, Sequence, sequence_of
from solver.model.settings import Scheme
from solver.progress import Monitor, checkpoint
from solver.search.bottleneck import best_minimum_clearance
from solver.search.exact import cheapest
from solver.transforms import FloatArray

SAME_COST = 1e-12


def front_of(result: PlanningResult, step: float, monitor: Monitor) -> tuple[Sequence, ...]:
    """Exact optima of a series of hard minima, by rising clearance; none dominates another.

    The first has no minimum at all. Each further one must have at least `step` [m] more
    clearance than the one before, so with a step of zero no point of the front is left out.
    """
    clearance = result.candidates.nodes.clearance
    best = best_minimum_clearance(result.graph, clearance, monitor)
    found: list[Sequence] = []
    least = -np.inf
    while least <= best:
        checkpoint(monitor, "front", len(found), len(found) + 1)
        one = optimum_above(result, least)
        if one is None:
            break
        found.append(one)
        least = np.nextafter(one.least_clearance + step, np.inf)
        if least > best > one.least_clearance:
            least = best  # the end of the front belongs to it, however near
    return tuple(
        one
        for one, after in zip(found, [*found[1:], None], strict=True)
        if after is None or after.joint_cost > one.joint_cost + SAME_COST
    )


def optimum_above(result: PlanningResult, least: float) -> Sequence | None:
    """The cheapest sequence whose nodes all have at least this clearance [m]."""
    graph, parent = result.graph.subgraph(result.candidates.nodes.clearance >= least)
    if np.any(np.diff(graph.offsets) == 0):
        return None
    path, cost = cheapest(graph)
    if not len(path):
        return None
    return sequence_of(result.candidates, Scheme.EXACT, parent[path], cost)


def knee(points: FloatArray) -> int | None:
    """The point (k, 2) farthest below the line from the first to the last, both scaled to 0..1.

    None where fewer than three points, or none below the line, exist.
    """
    if len(points) < 3:
        return None
    low, span = points.min(axis=0), np.ptp(points, axis=0)
    if not (span > 0.0).all():
        return None
    x, y = ((points - low) / span).T
    below = (y[0] + (x - x[0]) * (y[-1] - y[0]) / (x[-1] - x[0])) - y
    at = int(below.argmax())
    return at if below[at] > 0.0 else None


def front_points(front: Rows[Sequence]) -> FloatArray:
    """(k, 2) least clearance [m] and joint cost."""
    return np.array([(one.least_clearance, one.joint_cost) for one in front])
