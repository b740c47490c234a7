"""Why a graph holds no sequence: empty layers, and gaps that no allowed step crosses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solver.progress import Monitor, SilentMonitor
from solver.search.graph import JOINTS, LayeredGraph
from solver.search.kernels_reach import nearest_pair
from solver.search.sweeps import PIECE_EDGES, Progress, carry, kernel_arrays, total_work
from solver.transforms import FloatArray, IntArray


@dataclass(frozen=True, slots=True)
class GapCut:
    """A gap that no sequence crosses, and the pair of nodes that comes nearest to crossing it.

    Attributes
    ----------
    gap : int
        The cut lies between the layers `gap` and ``gap + 1``.
    source, target : int
        The pair whose worst step exceeds its limit by the smallest factor; the source can be
        reached, the lowest node numbers come first.
    joint : int or None
        The pendant joint 1..6 of that worst step; None is the lean.
    step, limit : float
        That step and its limit [rad].
    """

    gap: int
    source: int
    target: int
    joint: int | None
    step: float
    limit: float

    @property
    def excess(self) -> float:
        """By how much the step exceeds its limit [rad]."""
        return self.step - self.limit


@dataclass(frozen=True, slots=True)
class Cut:
    """Everything that interrupts the sequences of a graph, in path order.

    After each cut the search for the next begins with all nodes of the following layer.
    """

    empty_layers: tuple[int, ...]
    gaps: tuple[GapCut, ...]


def diagnose_cut(graph: LayeredGraph, monitor: Monitor | None = None) -> Cut | None:
    """Find what cuts the graph; None when a sequence exists."""
    sizes = graph.layer_sizes
    empty = tuple(int(layer) for layer in np.flatnonzero(sizes == 0))
    gaps = _cut_gaps(graph, monitor or SilentMonitor())
    return Cut(empty, gaps) if empty or gaps else None


def _cut_gaps(graph: LayeredGraph, monitor: Monitor) -> tuple[GapCut, ...]:
    """Find the gaps between two layers with nodes over which the reachable set dies."""
    last = graph.layer_count - 1
    sizes, bounded = graph.layer_sizes, graph.bounded_gaps
    progress = Progress(monitor, total_work(graph, 0, last))
    # A value of 0 marks a node that can be reached, infinity one that cannot.
    values, free = np.zeros(graph.node_count), np.zeros(graph.node_count)
    weight = np.zeros(last)
    cuts: list[GapCut] = []
    for gap in np.flatnonzero(bounded & (sizes[:-1] > 0) & (sizes[1:] > 0)).tolist():
        target = graph.layer(gap + 1)
        carry(graph, values, progress, gaps=(gap, gap + 1), node_cost=free, gap_weight=weight)
        if np.all(np.isinf(values[target])):
            reached = np.flatnonzero(values[graph.layer(gap)] == 0.0) + graph.offsets[gap]
            cuts.append(_nearest(graph, gap, reached, progress))
            values[target] = 0.0
    return tuple(cuts)


def _nearest(graph: LayeredGraph, gap: int, sources: IntArray, progress: Progress) -> GapCut:
    """Find the pair over a cut gap whose largest ratio of step to limit is least."""
    targets = graph.layer(gap + 1)
    arrays = kernel_arrays(graph)
    limits = np.full(JOINTS + 1, np.inf)
    if graph.step_limits is not None:
        limits[:JOINTS] = graph.step_limits[gap]
    if graph.lean_limits is not None:
        limits[JOINTS] = graph.lean_limits[gap]
    best, pair = np.array([np.inf]), np.array([-1, -1], dtype=np.int64)
    rows = max(1, PIECE_EDGES // 4 // (targets.stop - targets.start))
    for low in range(0, len(sources), rows):
        nearest_pair(
            arrays.steps,
            arrays.lean,
            limits,
            sources[low : low + rows],
            targets.start,
            targets.stop,
            best,
            pair,
        )
        progress.add(0)
    source, target = int(pair[0]), int(pair[1])
    step = _steps(graph, source, target)
    worst = int(np.argmax(step / limits))
    joint = None if worst == JOINTS else worst + 1
    return GapCut(gap, source, target, joint, float(step[worst]), float(limits[worst]))


def _steps(graph: LayeredGraph, source: int, target: int) -> FloatArray:
    """(7,) steps of the six pendant joints and of the lean between two nodes [rad]."""
    steps = np.zeros(JOINTS + 1)
    if graph.steps is not None:
        steps[:JOINTS] = np.abs(graph.steps[target] - graph.steps[source])
    if graph.lean is not None:
        steps[JOINTS] = abs(float(graph.lean[target]) - float(graph.lean[source]))
    return steps
