"""The optimal sequence by exact dynamic programming, and what every detour would cost."""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from threading import Event

import numpy as np

from solver.progress import Monitor, SilentMonitor, checkpoint
from solver.search.graph import NO_PATH, LayeredGraph
from solver.search.kernels_sweep import first_path
from solver.search.sweeps import (
    PIECE_EDGES,
    STAGE,
    Progress,
    carry,
    kernel_arrays,
    metric_of,
    total_work,
)
from solver.transforms import FloatArray, IntArray

TIE = 1e-12
"""Sequences whose costs differ by no more than this share of the optimum count as equal."""

THREADED_WORK = PIECE_EDGES
"""Edges of one direction from which on both directions run at the same time.

Below, a search takes a few milliseconds, of which a second thread saves one or two at best.
"""

QUESTION_INTERVAL = 0.02
"""How often the monitor is asked while the other direction is waited for [s]."""


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


def exact(
    graph: LayeredGraph, monitor: Monitor | None = None, *, threads: int | None = None
) -> ExactResult:
    """Find the sequence of least cost by forward and backward dynamic programming.

    Of all sequences whose cost exceeds the least by no more than 1e-12 of it, the one with the
    lexicographically smallest node numbers is returned, first layer first.

    Parameters
    ----------
    graph : LayeredGraph
        The nodes and what edges cost.
    monitor : Monitor, optional
        Told about progress and asked about cancelling, by the calling thread alone.
    threads : int, optional
        1 for one direction after the other, 2 for both at the same time; by default two for a
        graph that is large enough. The result is the same to the byte.

    Raises
    ------
    Cancelled
        If the monitor asks to stop; it is asked at least every 4 million edges.
    """
    last = graph.layer_count - 1
    work = total_work(graph, 0, last)
    so_far = np.full(graph.node_count, np.inf)
    so_far[graph.layer(0)] = graph.node_cost[graph.layer(0)]
    to_go = np.full(graph.node_count, np.inf)
    to_go[graph.layer(last)] = 0.0
    asked = monitor or SilentMonitor()
    if threads is None:
        threads = 2 if work >= THREADED_WORK else 1
    if threads > 1:
        _carry_both(graph, so_far, to_go, asked, work)
    else:
        progress = Progress(asked, 2 * work)
        carry(graph, so_far, progress)
        carry(graph, to_go, progress, forward=False)
    cost = float(np.min(so_far[graph.layer(last)], initial=np.inf))
    path = NO_PATH if cost == np.inf else _first_path(graph, to_go, cost)
    so_far.setflags(write=False)
    to_go.setflags(write=False)
    return ExactResult(path, cost, so_far, to_go)


def _carry_both(
    graph: LayeredGraph, so_far: FloatArray, to_go: FloatArray, monitor: Monitor, work: int
) -> None:
    """Carry forward on this thread and backward on another: neither needs the other.

    The kernel runs without the interpreter's lock. However this ends, the thread has ended too.
    """
    other = _Other()
    here = _Here(monitor, other, 2 * work)
    with ThreadPoolExecutor(1, thread_name_prefix="posopt-backward") as pool:
        try:
            here.waits_for = pool.submit(carry, graph, to_go, Progress(other, work), forward=False)
            carry(graph, so_far, Progress(here, work))
            while not here.waits_for.done():
                wait([here.waits_for], timeout=QUESTION_INTERVAL)
                checkpoint(here, STAGE, work, work)
        except BaseException:
            other.stop.set()
            raise
    here.waits_for.result()
    checkpoint(monitor, STAGE, 2 * work, 2 * work)


class _Other:
    """The monitor of the second thread: it keeps what is done, and is stopped by the first."""

    def __init__(self) -> None:
        self.stop = Event()
        self.done = 0

    def report(self, stage: str, done: int, total: int) -> None:
        """Keep what is done."""
        self.done = done

    def cancelled(self) -> bool:
        """Whether the first thread has stopped."""
        return self.stop.is_set()


class _Here:
    """The monitor of the first thread: it tells the real one of both, and asks it for both."""

    def __init__(self, monitor: Monitor, other: _Other, total: int) -> None:
        self._monitor, self._other, self._total = monitor, other, total
        self.waits_for: Future[None] = Future()

    def report(self, stage: str, done: int, total: int) -> None:
        """Tell what both have done."""
        self._monitor.report(stage, done + self._other.done, self._total)

    def cancelled(self) -> bool:
        """Whether to stop; what went wrong in the other thread is raised here."""
        if self.waits_for.done():
            self.waits_for.result()
        return self._monitor.cancelled()


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
