"""The paper's three search schemes: f, f1 and f2."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from solver.errors import ModelError
from solver.progress import Monitor, SilentMonitor, checkpoint
from solver.search.graph import NO_PATH, LayeredGraph
from solver.search.kernels_astar import (
    DEEPEST,
    EXPANDED,
    GOAL,
    HEAP_SIZE,
    UNKNOWN,
    best_first,
    estimate,
    open_starts,
)
from solver.search.kernels_edges import ROWS, TILE
from solver.search.sweeps import STAGE, kernel_arrays
from solver.transforms import FloatArray, IntArray

HEURISTIC_WEIGHT = 0.9
"""The paper's lambda."""

PIECE_WORK = 1_000_000
"""Edges, pushes and distances between two checkpoints; under 20 ms on one core."""


@dataclass(frozen=True, slots=True, eq=False)
class SearchResult:
    """What a best-first search found.

    Attributes
    ----------
    path : (N,) int array
        One node a layer; empty when no sequence exists.
    cost : float
        Its cost; infinite when no sequence exists.
    expanded : int
        Nodes closed, the goal's pop included; stale pops are not counted.
    order : (expanded,) int array
        The closed nodes in their order.
    dijkstra_expanded : int
        Nodes closed by the Dijkstra search that comes first in scheme f, else 0.
    """

    path: IntArray
    cost: float
    expanded: int
    order: IntArray
    dijkstra_expanded: int = 0

    @property
    def found(self) -> bool:
        """Whether a sequence was found."""
        return len(self.path) > 0


def f(
    graph: LayeredGraph, weight: float = HEURISTIC_WEIGHT, monitor: Monitor | None = None
) -> SearchResult:
    """Scheme f: Dijkstra picks the best start and its goal, then A* runs between these two.

    Parameters
    ----------
    graph : LayeredGraph
        The graph to search.
    weight : float
        lambda in 0..1, the factor of the L2 distance to the goal.
    monitor : Monitor, optional
        Told about progress and asked about cancelling; silent by default.
    """
    first, last = graph.layer(0), graph.layer(graph.layer_count - 1)
    chosen = _search(graph, first, last, 0.0, monitor)
    if not chosen.found:
        return replace(chosen, expanded=0, order=NO_PATH, dijkstra_expanded=chosen.expanded)
    start, goal = int(chosen.path[0]), int(chosen.path[-1])
    result = _search(graph, slice(start, start + 1), slice(goal, goal + 1), weight, monitor)
    return replace(result, dijkstra_expanded=chosen.expanded)


def f1(
    graph: LayeredGraph, weight: float = HEURISTIC_WEIGHT, monitor: Monitor | None = None
) -> SearchResult:
    """Scheme f1: A* from all nodes of the first layer to any node of the last.

    The heuristic is lambda times the least L2 distance of range-normalised joints to any node
    of the last layer; L1 edges are never shorter, so it is admissible and consistent for every
    lambda up to 1. Where later gaps weigh less than 1 it is scaled by the least of them.
    """
    first, last = graph.layer(0), graph.layer(graph.layer_count - 1)
    return _search(graph, first, last, weight, monitor)


def f2(
    graph: LayeredGraph,
    penalty: ArrayLike,
    weight: float = HEURISTIC_WEIGHT,
    monitor: Monitor | None = None,
) -> SearchResult:
    """Scheme f2: f1 with a penalty (K,) added to the cost of every node, start nodes too.

    See :func:`solver.costs.penalty.safety_penalty`.
    """
    return f1(replace(graph, node_cost=graph.node_cost + np.asarray(penalty)), weight, monitor)


def heuristic_weights(graph: LayeredGraph, weight: float) -> FloatArray:
    """(N,) factor of the heuristic of each layer: lambda times the least gap weight to come."""
    least = np.minimum.accumulate(np.append(graph.gap_weight, 1.0)[::-1])[::-1]
    return weight * least


def heuristic_values(graph: LayeredGraph, weight: float = HEURISTIC_WEIGHT) -> FloatArray:
    """(K,) heuristic of every node in scheme f1; infinite when the last layer is empty."""
    scales = heuristic_weights(graph, weight)
    points = graph.joints / graph.ranges
    goals = points[graph.layer(graph.layer_count - 1)]
    values = np.full(graph.node_count, UNKNOWN)
    tile, zeros = np.empty(ROWS * TILE), np.zeros(len(goals))
    for layer in range(graph.layer_count):
        nodes, scale = graph.layer(layer), float(scales[layer])
        for low in range(nodes.start, nodes.stop, TILE):
            high = min(low + TILE, nodes.stop)
            estimate(tile, points, low, high, goals, zeros, scale, values)
    return values


def _search(
    graph: LayeredGraph, starts: slice, goals: slice, weight: float, monitor: Monitor | None
) -> SearchResult:
    """Run A* from any of `starts` to any of `goals`."""
    if graph.squared:
        raise ModelError("the schemes f, f1 and f2 need absolute joint changes, not squared ones")
    if not 0.0 <= weight <= 1.0:
        raise ModelError(f"the heuristic weight lies in 0..1, got {weight:g}")
    search = _BestFirst(graph, starts, goals, weight)
    monitor = monitor or SilentMonitor()
    while True:
        checkpoint(monitor, STAGE, search.deepest, graph.layer_count)
        if not search.advance():
            return search.result()


class _BestFirst:
    """State of one search between its pieces."""

    def __init__(self, graph: LayeredGraph, starts: slice, goals: slice, weight: float) -> None:
        count = graph.node_count
        self._graph, self._goals = graph, goals
        self._points = graph.joints / graph.ranges
        self._weights = heuristic_weights(graph, weight)
        self._cost = np.full(count, np.inf)
        self._heuristic = np.full(count, UNKNOWN)
        self._parent = np.full(count, -1, dtype=np.int64)
        self._closed = np.zeros(count, dtype=np.uint8)
        self._order = np.empty(count, dtype=np.int64)
        self._state = np.array([0, 0, -1, 0], dtype=np.int64)
        self._keys = np.empty(1024)
        self._nodes = np.empty(1024, dtype=np.int64)
        self._widest = int(graph.layer_sizes.max(initial=0))
        self._starts = deque(
            slice(low, min(low + TILE, starts.stop))
            for low in range(starts.start, starts.stop, TILE)
        )

    @property
    def deepest(self) -> int:
        """The deepest layer of which a node is closed."""
        return int(self._state[DEEPEST])

    def advance(self) -> bool:
        """Do one piece of work; False once the search has ended."""
        if self._starts:
            self._open(self._starts.popleft())
            return True
        self._make_room(self._widest)
        best_first(
            kernel_arrays(self._graph),
            self._points,
            self._points[self._goals],
            self._goals.start,
            self._goals.stop,
            self._weights,
            self._cost,
            self._heuristic,
            self._parent,
            self._closed,
            self._order,
            self._keys,
            self._nodes,
            self._state,
            PIECE_WORK,
        )
        return bool(self._state[GOAL] < 0 and self._state[HEAP_SIZE] > 0)

    def result(self) -> SearchResult:
        """Follow the path back from the goal, if one was reached."""
        expanded = int(self._state[EXPANDED])
        order = self._order[:expanded].copy()
        node = int(self._state[GOAL])
        if node < 0:
            return SearchResult(NO_PATH, np.inf, expanded, order)
        cost = float(self._cost[node])
        path = np.empty(self._graph.layer_count, dtype=np.int64)
        for layer in range(self._graph.layer_count - 1, -1, -1):
            path[layer] = node
            node = int(self._parent[node])
        return SearchResult(path, cost, expanded, order)

    def _open(self, starts: slice) -> None:
        """Push a tile of start nodes."""
        self._make_room(starts.stop - starts.start)
        open_starts(
            self._points,
            self._graph.node_cost,
            self._points[self._goals],
            float(self._weights[0]),
            starts.start,
            starts.stop,
            self._cost,
            self._heuristic,
            self._keys,
            self._nodes,
            self._state,
        )

    def _make_room(self, entries: int) -> None:
        """Let the heap hold so many entries more."""
        need = int(self._state[HEAP_SIZE]) + entries
        if need > len(self._keys):
            more = max(need, 2 * len(self._keys)) - len(self._keys)
            self._keys = np.concatenate([self._keys, np.empty(more)])
            self._nodes = np.concatenate([self._nodes, np.empty(more, dtype=np.int64)])
