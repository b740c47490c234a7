"""Searches of one layered graph by several means; each gives the least joint cost."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec
from typing import NamedTuple

import numpy as np

from solver.benchmarks.plain_astar import plain_astar
from solver.search import paper
from solver.search.exact import cheapest, exact
from solver.search.graph import LayeredGraph
from solver.transforms import FloatArray

WEIGHT = 0.9
"""The heuristic's weight in both A* searches: the paper's lambda."""

Solve = Callable[[], float]
"""The search itself, after what its library needs has been built; returns the least cost."""


class Searcher(NamedTuple):
    """A way of searching: `prepare` builds what it needs of a graph and returns the search.

    `package` is the package that has to be installed, '' for none; `stores` says whether it
    keeps every edge, or computes edges when they are looked at.
    """

    name: str
    package: str
    stores: bool
    prepare: Callable[[LayeredGraph], Solve]


def _exact_sequence(graph: LayeredGraph) -> Solve:
    return lambda: cheapest(graph)[1]


def _exact_everywhere(graph: LayeredGraph) -> Solve:
    # One thread, as all others: their processor time is compared.
    return lambda: exact(graph, threads=1).cost


def _compiled_astar(graph: LayeredGraph) -> Solve:
    return lambda: paper.f1(graph, WEIGHT).cost


def _plain_astar(graph: LayeredGraph) -> Solve:
    layers = [graph.joints[a:b].tolist() for a, b in itertools.pairwise(graph.offsets)]
    costs = [[0.0] * len(layer) for layer in layers]
    ranges = graph.ranges.tolist()
    return lambda: plain_astar(layers, costs, ranges, WEIGHT).cost


def _networkx_dijkstra(graph: LayeredGraph) -> Solve:
    networkx = import_module("networkx")
    built = networkx.DiGraph()
    built.add_nodes_from(range(graph.node_count))
    for gap in range(graph.layer_count - 1):
        source, target = graph.layer(gap), graph.layer(gap + 1)
        targets = np.arange(target.start, target.stop)
        for node in range(source.start, source.stop):
            costs = graph.edge_costs(gap, node, targets)
            built.add_weighted_edges_from(
                zip(itertools.repeat(node), targets.tolist(), costs.tolist(), strict=False)
            )
    first, last = graph.layer(0), graph.layer(graph.layer_count - 1)
    goal = graph.node_count
    built.add_weighted_edges_from((node, goal, 0.0) for node in range(last.start, last.stop))
    starts = set(range(first.start, first.stop))

    def solve() -> float:
        try:
            return float(networkx.multi_source_dijkstra(built, starts, goal)[0])
        except networkx.NetworkXNoPath:
            return math.inf

    return solve


def _scipy_dijkstra(graph: LayeredGraph) -> Solve:
    cdist = import_module("scipy.spatial.distance").cdist
    csr_array = import_module("scipy.sparse").csr_array
    dijkstra = import_module("scipy.sparse.csgraph").dijkstra
    edges, count = graph.edge_count, graph.node_count
    number = np.int32 if edges < 2**31 else np.int64
    costs, columns = np.empty(edges), np.empty(edges, dtype=number)
    degrees = np.zeros(count, dtype=np.int64)
    points = graph.joints / graph.ranges
    low = 0
    for gap in range(graph.layer_count - 1):
        source, target = graph.layer(gap), graph.layer(gap + 1)
        block = cdist(points[source], points[target], "cityblock")
        costs[low : low + block.size] = block.ravel()
        columns[low : low + block.size] = np.tile(
            np.arange(target.start, target.stop, dtype=number), len(block)
        )
        degrees[source] = target.stop - target.start
        low += block.size
    rows = np.concatenate([[0], np.cumsum(degrees)]).astype(number)
    matrix = csr_array((costs, columns, rows), shape=(count, count))
    first, last = graph.layer(0), graph.layer(graph.layer_count - 1)
    starts = np.arange(first.start, first.stop)

    def solve() -> float:
        reached, _, _ = dijkstra(matrix, indices=starts, return_predecessors=True, min_only=True)
        return float(np.min(reached[last], initial=math.inf))

    return solve


def _scipy_by_layers(graph: LayeredGraph) -> Solve:
    """Dijkstra from layer to layer: edges of one gap at a time fit where all of them do not.

    A start node stands before every gap, with an edge to each of its sources that costs what it
    cost to come there.
    """
    cdist = import_module("scipy.spatial.distance").cdist
    csr_array = import_module("scipy.sparse").csr_array
    dijkstra = import_module("scipy.sparse.csgraph").dijkstra
    points = graph.joints / graph.ranges

    def carried(gap: int, so_far: FloatArray) -> FloatArray:
        source, target = graph.layer(gap), graph.layer(gap + 1)
        wide, long = source.stop - source.start, target.stop - target.start
        costs, columns = np.empty(wide * (long + 1)), np.empty(wide * (long + 1), np.int32)
        costs[:wide], columns[:wide] = so_far, np.arange(1, wide + 1)
        cdist(points[source], points[target], "cityblock", out=costs[wide:].reshape(wide, long))
        columns[wide:].reshape(wide, long)[:] = np.arange(wide + 1, wide + long + 1)
        degrees = np.concatenate([[0, wide], np.full(wide, long), np.zeros(long)])
        rows = np.cumsum(degrees).astype(np.int32)
        matrix = csr_array((costs, columns, rows), shape=(wide + long + 1, wide + long + 1))
        reached, _ = dijkstra(matrix, indices=0, return_predecessors=True)
        return np.asarray(reached[wide + 1 :])

    def solve() -> float:
        first = graph.layer(0)
        so_far = np.zeros(first.stop - first.start)
        for gap in range(graph.layer_count - 1):
            if not len(so_far):
                break
            so_far = carried(gap, so_far)
        return float(np.min(so_far, initial=math.inf))

    return solve


GET_PEERS = "pip install posopt[peers]"
"""How to get the packages that are compared."""

SEARCHERS = (
    Searcher("posopt exact", "", False, _exact_sequence),
    Searcher("posopt exact, every node", "", False, _exact_everywhere),
    Searcher("posopt A*", "", False, _compiled_astar),
    Searcher("plain Python A*", "", False, _plain_astar),
    Searcher("networkx Dijkstra", "networkx", True, _networkx_dijkstra),
    Searcher("scipy Dijkstra", "scipy", True, _scipy_dijkstra),
    Searcher("scipy Dijkstra, a layer at a time", "scipy", False, _scipy_by_layers),
)
"""All searches, the one that the others are compared with first."""


def searcher(name: str) -> Searcher:
    """Return the search of that name."""
    return next(one for one in SEARCHERS if one.name == name)


def installed(package: str) -> bool:
    """Whether a package can be imported; '' stands for none."""
    return not package or find_spec(package) is not None
