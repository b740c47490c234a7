"""A* on a layered graph with any heuristic: what an experiment needs to compare heuristics.

The product's own searches compute the paper's heuristic inside their kernels; here it is a
given array, and edges are looked up one layer at a time.
"""

from __future__ import annotations

import heapq
from typing import NamedTuple

import numpy as np

from solver.search.graph import LayeredGraph
from solver.transforms import FloatArray, IntArray


class Expansion(NamedTuple):
    """Cost of the found sequence, its nodes, and the number of closed nodes."""

    cost: float
    path: IntArray
    expanded: int


def astar(graph: LayeredGraph, heuristic: FloatArray) -> Expansion:
    """Search from all nodes of the first layer to any of the last.

    `heuristic` (K,) must be consistent for the optimum to be found; infinite where the goal
    cannot be reached. Among equal priorities the lowest node number comes first.
    """
    count, last = graph.node_count, graph.layer_count - 1
    cost = np.full(count, np.inf)
    parent = np.full(count, -1, dtype=np.int64)
    closed = np.zeros(count, dtype=np.bool_)
    layers = graph.layer_of(np.arange(count))
    heap: list[tuple[float, int]] = []

    def push(nodes: IntArray) -> None:
        keys = cost[nodes] + heuristic[nodes]
        for key, node in zip(keys.tolist(), nodes.tolist(), strict=True):
            if key < np.inf:
                heapq.heappush(heap, (key, node))

    starts = np.arange(graph.offsets[0], graph.offsets[1])
    cost[starts] = graph.node_cost[starts]
    push(starts)
    expanded = 0
    while heap:
        _, node = heapq.heappop(heap)
        if closed[node]:
            continue
        closed[node] = True
        expanded += 1
        layer = int(layers[node])
        if layer == last:
            return Expansion(float(cost[node]), _path(parent, node, last), expanded)
        targets = np.arange(graph.offsets[layer + 1], graph.offsets[layer + 2])
        targets = targets[~closed[targets]]
        reached = cost[node] + graph.edge_costs(layer, node, targets) + graph.node_cost[targets]
        better = reached < cost[targets]
        improved = targets[better]
        cost[improved] = reached[better]
        parent[improved] = node
        push(improved)
    return Expansion(np.inf, np.empty(0, dtype=np.int64), expanded)


def _path(parent: IntArray, node: int, last: int) -> IntArray:
    path = np.empty(last + 1, dtype=np.int64)
    for layer in range(last, -1, -1):
        path[layer] = node
        node = int(parent[node])
    return path
