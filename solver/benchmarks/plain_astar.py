"""A plain Python A* of the paper, the peer that the compiled searches are compared with.

Lists, dicts and heapq, written as one would from the paper: edges and heuristic are computed
when a node is generated, the heuristic once per node.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Sequence
from typing import NamedTuple

Joints = Sequence[float]


class PlainResult(NamedTuple):
    """Nodes of the path, its cost, and the number of closed nodes."""

    path: list[int]
    cost: float
    expanded: int


def plain_astar(
    layers: Sequence[Sequence[Joints]],
    node_costs: Sequence[Sequence[float]],
    ranges: Joints,
    weight: float = 0.9,
    start: int | None = None,
    goal: int | None = None,
) -> PlainResult:
    """Multi-source A* to any node of the last layer; nodes are numbered through all layers.

    `layers` holds the joints of every node of every layer [rad]; scheme f1 has node costs 0,
    scheme f2 the safety penalty. `start` and `goal` narrow the first and the last layer to one
    node each; a weight of 0 makes it Dijkstra's search.
    """
    points: list[list[float]] = []
    costs = []
    layer_of = []
    first_of = []
    for number, (layer, layer_costs) in enumerate(zip(layers, node_costs, strict=True)):
        first_of.append(len(points))
        for joints, node_cost in zip(layer, layer_costs, strict=True):
            points.append([angle / span for angle, span in zip(joints, ranges, strict=True)])
            costs.append(node_cost)
            layer_of.append(number)
    first_of.append(len(points))
    last_layer = len(layers) - 1
    goal_nodes = range(first_of[last_layer], len(points)) if goal is None else [goal]
    goals = [points[node] for node in goal_nodes]

    heuristic = {}

    def estimate(node: int) -> float:
        if weight == 0.0:
            return 0.0
        if node not in heuristic:
            heuristic[node] = weight * min(math.dist(points[node], point) for point in goals)
        return heuristic[node]

    best = {}
    parent: dict[int, int] = {}
    closed = set()
    heap: list[tuple[float, int]] = []
    if goals:
        for node in range(first_of[1]) if start is None else [start]:
            best[node] = costs[node]
            heapq.heappush(heap, (best[node] + estimate(node), node))
    while heap:
        _, node = heapq.heappop(heap)
        if node in closed:
            continue
        closed.add(node)
        if node in goal_nodes:
            path = [node]
            while path[-1] in parent:
                path.append(parent[path[-1]])
            return PlainResult(path[::-1], best[node], len(closed))
        a0, a1, a2, a3, a4, a5 = points[node]
        below = layer_of[node] + 1
        if below > last_layer:
            continue
        for target in range(first_of[below], first_of[below + 1]):
            if target in closed:
                continue
            b0, b1, b2, b3, b4, b5 = points[target]
            edge = (
                abs(b0 - a0)
                + abs(b1 - a1)
                + abs(b2 - a2)
                + abs(b3 - a3)
                + abs(b4 - a4)
                + abs(b5 - a5)
            )
            reached = best[node] + edge + costs[target]
            if reached < best.get(target, math.inf):
                best[target] = reached
                parent[target] = node
                heapq.heappush(heap, (reached + estimate(target), target))
    return PlainResult([], math.inf, len(closed))


def plain_f(
    layers: Sequence[Sequence[Joints]], ranges: Joints, weight: float = 0.9
) -> tuple[PlainResult, int]:
    """Scheme f: Dijkstra picks start and goal, A* runs between them; also Dijkstra's expansions."""
    free = [[0.0] * len(layer) for layer in layers]
    chosen = plain_astar(layers, free, ranges, 0.0)
    if not chosen.path:
        return chosen, chosen.expanded
    ends = chosen.path[0], chosen.path[-1]
    return plain_astar(layers, free, ranges, weight, *ends), chosen.expanded
