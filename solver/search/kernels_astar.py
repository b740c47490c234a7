"""Compiled best-first search with a binary heap; expansions in pieces."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from solver.kernel import kernel
from solver.search.kernels_edges import (
    BEST_ROW,
    EUCLIDEAN,
    ROWS,
    TILE,
    GraphArrays,
    fill_tile,
    gap_limits,
    relax,
    step_allowed,
)
from solver.transforms import FloatArray, IntArray

UNKNOWN = -1.0

HEAP_SIZE = 0
EXPANDED = 1
GOAL = 2
DEEPEST = 3

PUSH_WORK = 16
POP_WORK = 64


@kernel
def before(key: float, node: int, other_key: float, other_node: int) -> bool:
    """Order of the open list: least key first, then least node number."""
    return key < other_key or (key == other_key and node < other_node)


@kernel
def push(keys: FloatArray, nodes: IntArray, size: int, key: float, node: int) -> None:
    """Add an entry to a heap of `size` entries."""
    at = size
    while at > 0:
        parent = (at - 1) // 2
        if not before(key, node, keys[parent], nodes[parent]):
            break
        keys[at] = keys[parent]
        nodes[at] = nodes[parent]
        at = parent
    keys[at] = key
    nodes[at] = node


@kernel
def pop(keys: FloatArray, nodes: IntArray, size: int) -> int:
    """Take the first entry from a heap of `size` entries and return its node."""
    result = nodes[0]
    key = keys[size - 1]
    node = nodes[size - 1]
    size -= 1
    at = 0
    while True:
        child = 2 * at + 1
        if child >= size:
            break
        if child + 1 < size and before(
            keys[child + 1], nodes[child + 1], keys[child], nodes[child]
        ):
            child += 1
        if not before(keys[child], nodes[child], key, node):
            break
        keys[at] = keys[child]
        nodes[at] = nodes[child]
        at = child
    keys[at] = key
    nodes[at] = node
    return int(result)


@kernel
def estimate(
    tile: FloatArray,
    points: FloatArray,
    low: int,
    high: int,
    goals: FloatArray,
    zeros: FloatArray,
    weight: float,
    heuristic: FloatArray,
) -> None:
    """Heuristic of the nodes low..high-1: weight times the least L2 distance to any goal.

    At most one tile of nodes; `points` are the joints divided by their ranges.
    """
    if weight == 0.0:
        heuristic[low:high] = 0.0
        return
    padded = fill_tile(tile, points, low, high, 6)
    relax(tile, padded, goals, zeros, 0, len(goals), weight, EUCLIDEAN)
    for node in range(low, high):
        heuristic[node] = tile[BEST_ROW * TILE + node - low]


@kernel
def open_starts(
    points: FloatArray,
    node_cost: FloatArray,
    goals: FloatArray,
    weight: float,
    low: int,
    high: int,
    cost: FloatArray,
    heuristic: FloatArray,
    keys: FloatArray,
    nodes: IntArray,
    state: IntArray,
) -> None:
    """Push the start nodes low..high-1 (at most one tile), each with its node cost."""
    tile = np.zeros(ROWS * TILE)
    estimate(tile, points, low, high, goals, np.zeros(len(goals)), weight, heuristic)
    for node in range(low, high):
        cost[node] = node_cost[node]
        push(keys, nodes, state[HEAP_SIZE], cost[node] + heuristic[node], node)
        state[HEAP_SIZE] += 1


@kernel
def best_first(
    graph: GraphArrays,
    points: FloatArray,
    goals: FloatArray,
    goal_low: int,
    goal_high: int,
    heuristic_weight: FloatArray,
    cost: FloatArray,
    heuristic: FloatArray,
    parent: IntArray,
    closed: NDArray[np.uint8],
    order: IntArray,
    keys: FloatArray,
    nodes: IntArray,
    state: IntArray,
    work: int,
) -> None:
    """Expand nodes until a goal is popped, the heap is empty or too full, or `work` is used up.

    An open node that is reached more cheaply is pushed again; its earlier entry is stale and
    is not counted when it is popped. `points` are the joints divided by their ranges.
    """
    tile = np.zeros(ROWS * TILE)
    zeros = np.zeros(len(goals))
    layers = len(graph.offsets) - 1
    widest = 0
    for layer in range(layers):
        widest = max(widest, graph.offsets[layer + 1] - graph.offsets[layer])
    while state[HEAP_SIZE] > 0 and work > 0 and state[HEAP_SIZE] + widest <= len(keys):
        node = pop(keys, nodes, state[HEAP_SIZE])
        state[HEAP_SIZE] -= 1
        work -= POP_WORK
        if closed[node]:
            continue
        closed[node] = 1
        order[state[EXPANDED]] = node
        state[EXPANDED] += 1
        if goal_low <= node < goal_high:
            state[GOAL] = node
            return
        gap = int(np.searchsorted(graph.offsets, node, side="right")) - 1
        state[DEEPEST] = max(state[DEEPEST], gap)
        if gap + 1 >= layers:
            continue
        limits = gap_limits(gap, graph.step_limits, graph.lean_limits)
        weight = graph.gap_weight[gap]
        start = int(graph.offsets[gap + 1])
        stop = graph.offsets[gap + 2]
        work -= stop - start
        for target in range(start, stop):
            if closed[target]:
                continue
            distance = 0.0
            for joint in range(6):
                distance += abs(points[target, joint] - points[node, joint])
            reached = cost[node] + weight * distance + graph.node_cost[target]
            if reached >= cost[target]:
                continue
            if not step_allowed(graph, limits, node, target):
                continue
            cost[target] = reached
            parent[target] = node
            if heuristic[target] == UNKNOWN:
                low = start + (target - start) // TILE * TILE
                high = min(low + TILE, stop)
                scale = heuristic_weight[gap + 1]
                estimate(tile, points, low, high, goals, zeros, scale, heuristic)
                work -= (high - low) * len(goals)
            push(keys, nodes, state[HEAP_SIZE], reached + heuristic[target], target)
            state[HEAP_SIZE] += 1
            work -= PUSH_WORK
