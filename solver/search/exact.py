"""The optimal sequence by exact dynamic programming, and what every detour would cost."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solver.progress import Monitor, SilentMonitor
from solver.search.graph import NO_PATH, LayeredGraph
from solver.search.kernels_sweep import first_path
from solver.search.sweeps import Progress, carry, kernel_arrays, metric_of, total_work
from solver.transforms import FloatArray, IntArray

TIE = 1e-12
"""Sequences whose costs differ by no more than this share of the optimum count as equal."""


@dataclass(frozen=True, slots=True, eq=False)
class ExactResult:
    """The proven optimum of a graph.

    Attributes
    ----------
    path : (N,) int array
        One node a layer; empty when no sequence exists.
    cost : float
        The least cost; infinite when no sequence exists.
    cost_so_far : (K,) array
        Least cost of reaching each node, its own node cost included.
    cost_to_go : (K,) array
        Least cost from each node to the last layer, its own node cost left out.
    """

    path: IntArray
    cost: float
    cost_so_far: FloatArray
    cost_to_go: FloatArray

    @property
    def found(self) -> bool:
        """Whether any sequence exists."""
        return len(self.path) > 0

    @property
    def extra_cost(self) -> FloatArray:
        """(K,) how much the best sequence through each node exceeds the optimum.

        Infinite where no sequence passes.
        """
        total = self.cost_so_far + self.cost_to_go
        if not self.found:
            return np.full(total.shape, np.inf)
        return np.maximum(total - self.cost, 0.0)


def exact(graph: LayeredGraph, monitor: Monitor | None = None) -> ExactResult:
    """Find the sequence of least cost by forward and backward dynamic programming.

    Of all sequences whose cost exceeds the least by no more than 1e-12 of it, the one with the
    lexicographically smallest node numbers is returned, first layer first.

    Raises
    ------
    Cancelled
        If the monitor asks to stop; it is asked at least every 4 million edges.
    """
    last = graph.layer_count - 1
    progress = Progress(monitor or SilentMonitor(), 2 * total_work(graph, 0, last))
    so_far = np.full(graph.node_count, np.inf)
    so_far[graph.layer(0)] = graph.node_cost[graph.layer(0)]
    carry(graph, so_far, progress)
    to_go = np.full(graph.node_count, np.inf)
    to_go[graph.layer(last)] = 0.0
    carry(graph, to_go, progress, forward=False)
    cost = float(np.min(so_far[graph.layer(last)], initial=np.inf))
    path = NO_PATH if cost == np.inf else _first_path(graph, to_go, cost)
    so_far.setflags(write=False)
    to_go.setflags(write=False)
    return ExactResult(path, cost, so_far, to_go)


def cheapest(graph: LayeredGraph, monitor: Monitor | None = None) -> tuple[IntArray, float]:
    """Find the sequence of least cost alone, by backward dynamic programming: half the work.

    Returns the path of :func:`exact` and its cost; an empty path and inf without a sequence.

    Raises
    ------
    Cancelled
        If the monitor asks to stop.
    """
    last = graph.layer_count - 1
    progress = Progress(monitor or SilentMonitor(), total_work(graph, 0, last))
    to_go = np.full(graph.node_count, np.inf)
    to_go[graph.layer(last)] = 0.0
    carry(graph, to_go, progress, forward=False)
    first = graph.layer(0)
    cost = float(np.min(graph.node_cost[first] + to_go[first], initial=np.inf))
    return (NO_PATH if cost == np.inf else _first_path(graph, to_go, cost)), cost


def _first_path(graph: LayeredGraph, to_go: FloatArray, cost: float) -> IntArray:
    """Return the lexicographically smallest sequence within the tie of the optimum."""
    path = np.empty(graph.layer_count, dtype=np.int64)
    first_path(kernel_arrays(graph), metric_of(graph), to_go, cost * (1.0 + TIE), path)
    path.setflags(write=False)
    return path
