"""Compiled loops over the edges between neighbouring layers.

Targets are held in a tile, structure of arrays with constant row length, and each source sweeps
the whole tile: the inner loop has no reduction, so that it vectorises without relaxing the rules
of floating-point arithmetic, and every edge costs the same to the bit on every machine.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from solver.transforms import FloatArray, IntArray

TILE = 256
STEP_ROW = 6
LEAN_ROW = 12
BEST_ROW = 13
ROWS = 14
INFINITE = np.inf
TOLERANCE = 1e-12

ABSOLUTE = 0
SQUARED = 1
EUCLIDEAN = 2


@njit(cache=True, nogil=True)
def fill_tile(
    tile: FloatArray,
    joints: FloatArray,
    ranges: FloatArray,
    steps: FloatArray,
    lean: FloatArray,
    low: int,
    high: int,
) -> int:
    """Put the nodes low..high-1 into the tile, best infinite; returns the padded length."""
    count = high - low
    padded = (count + 7) // 8 * 8
    for j in range(count):
        for joint in range(6):
            tile[joint * TILE + j] = joints[low + j, joint] / ranges[joint]
    if len(steps) > 0:
        for j in range(count):
            for joint in range(6):
                tile[(STEP_ROW + joint) * TILE + j] = steps[low + j, joint]
    if len(lean) > 0:
        for j in range(count):
            tile[LEAN_ROW * TILE + j] = lean[low + j]
    for row in range(BEST_ROW):
        for j in range(count, padded):
            tile[row * TILE + j] = 0.0
    for j in range(padded):
        tile[BEST_ROW * TILE + j] = INFINITE
    return padded


@njit(cache=True, nogil=True)
def relax(
    tile: FloatArray, count: int, points: FloatArray, values: FloatArray, weight: float, metric: int
) -> None:
    """Lower the tile's best to the least value + weight * distance over all sources."""
    for i in range(len(values)):
        value = values[i]
        if value == INFINITE:
            continue
        a0 = points[i, 0]
        a1 = points[i, 1]
        a2 = points[i, 2]
        a3 = points[i, 3]
        a4 = points[i, 4]
        a5 = points[i, 5]
        for j in range(count):
            d0 = tile[j] - a0
            d1 = tile[TILE + j] - a1
            d2 = tile[2 * TILE + j] - a2
            d3 = tile[3 * TILE + j] - a3
            d4 = tile[4 * TILE + j] - a4
            d5 = tile[5 * TILE + j] - a5
            if metric == ABSOLUTE:
                d = abs(d0) + abs(d1) + abs(d2) + abs(d3) + abs(d4) + abs(d5)
            else:
                d = d0 * d0 + d1 * d1 + d2 * d2 + d3 * d3 + d4 * d4 + d5 * d5
                if metric == EUCLIDEAN:
                    d = np.sqrt(d)
            cost = value + weight * d
            best = tile[BEST_ROW * TILE + j]
            tile[BEST_ROW * TILE + j] = best if best <= cost else cost


@njit(cache=True, nogil=True)
def relax_bounded(
    tile: FloatArray,
    count: int,
    points: FloatArray,
    values: FloatArray,
    weight: float,
    metric: int,
    steps: FloatArray,
    lean: FloatArray,
    limits: FloatArray,
) -> None:
    """As `relax`, over the edges whose steps stay within `limits` (six joints and the lean)."""
    l0 = limits[0]
    l1 = limits[1]
    l2 = limits[2]
    l3 = limits[3]
    l4 = limits[4]
    l5 = limits[5]
    l6 = limits[6]
    for i in range(len(values)):
        value = values[i]
        if value == INFINITE:
            continue
        a0 = points[i, 0]
        a1 = points[i, 1]
        a2 = points[i, 2]
        a3 = points[i, 3]
        a4 = points[i, 4]
        a5 = points[i, 5]
        b0 = steps[i, 0]
        b1 = steps[i, 1]
        b2 = steps[i, 2]
        b3 = steps[i, 3]
        b4 = steps[i, 4]
        b5 = steps[i, 5]
        b6 = lean[i]
        for j in range(count):
            d0 = tile[j] - a0
            d1 = tile[TILE + j] - a1
            d2 = tile[2 * TILE + j] - a2
            d3 = tile[3 * TILE + j] - a3
            d4 = tile[4 * TILE + j] - a4
            d5 = tile[5 * TILE + j] - a5
            if metric == ABSOLUTE:
                d = abs(d0) + abs(d1) + abs(d2) + abs(d3) + abs(d4) + abs(d5)
            else:
                d = d0 * d0 + d1 * d1 + d2 * d2 + d3 * d3 + d4 * d4 + d5 * d5
                if metric == EUCLIDEAN:
                    d = np.sqrt(d)
            cost = value + weight * d
            cost = cost if abs(tile[6 * TILE + j] - b0) <= l0 else INFINITE
            cost = cost if abs(tile[7 * TILE + j] - b1) <= l1 else INFINITE
            cost = cost if abs(tile[8 * TILE + j] - b2) <= l2 else INFINITE
            cost = cost if abs(tile[9 * TILE + j] - b3) <= l3 else INFINITE
            cost = cost if abs(tile[10 * TILE + j] - b4) <= l4 else INFINITE
            cost = cost if abs(tile[11 * TILE + j] - b5) <= l5 else INFINITE
            cost = cost if abs(tile[12 * TILE + j] - b6) <= l6 else INFINITE
            best = tile[BEST_ROW * TILE + j]
            tile[BEST_ROW * TILE + j] = best if best <= cost else cost


@njit(cache=True, nogil=True)
def gap_limits(gap: int, step_limits: FloatArray, lean_limits: FloatArray) -> FloatArray:
    """Seven limits of a gap, tolerance included; infinite where there is none."""
    limits = np.full(7, INFINITE)
    if len(step_limits) > 0:
        for joint in range(6):
            limits[joint] = step_limits[gap, joint] + TOLERANCE
    if len(lean_limits) > 0:
        limits[6] = lean_limits[gap] + TOLERANCE
    return limits


@njit(cache=True, nogil=True)
def sweep(
    offsets: IntArray,
    joints: FloatArray,
    ranges: FloatArray,
    node_cost: FloatArray,
    gap_weight: FloatArray,
    steps: FloatArray,
    step_limits: FloatArray,
    lean: FloatArray,
    lean_limits: FloatArray,
    metric: int,
    forward: bool,
    widest: bool,
    gap_first: int,
    gap_count: int,
    low: int,
    high: int,
    values: FloatArray,
) -> None:
    """Carry `values` over gaps gap_first, gap_first +- 1, ...; a single gap may be cut in pieces.

    Forward: value of a target = least value + edge, plus its node cost; backward: least
    (node cost + value) + edge. `widest` takes the larger of node cost and value instead of
    the sum. low..high-1 are the targets to do, counted within their layer.
    """
    size = 0
    for index in range(gap_count):
        gap = gap_first + index if forward else gap_first - index
        size = max(size, offsets[gap + 1] - offsets[gap], offsets[gap + 2] - offsets[gap + 1])
    tile = np.zeros(ROWS * TILE)
    points = np.empty((size, 6))
    source_values = np.empty(size)
    source_steps = np.zeros((size, 6))
    source_lean = np.zeros(size)
    for index in range(gap_count):
        gap = gap_first + index if forward else gap_first - index
        source_layer = gap if forward else gap + 1
        target_layer = gap + 1 if forward else gap
        source_start = offsets[source_layer]
        target_start = offsets[target_layer]
        count = offsets[source_layer + 1] - source_start
        limits = gap_limits(gap, step_limits, lean_limits)
        bounded = False
        for bound in range(7):
            bounded = bounded or limits[bound] < INFINITE
        for i in range(count):
            node = source_start + i
            for joint in range(6):
                points[i, joint] = joints[node, joint] / ranges[joint]
            source_values[i] = values[node] if forward else values[node] + node_cost[node]
            if bounded and len(steps) > 0:
                for joint in range(6):
                    source_steps[i, joint] = steps[node, joint]
            if bounded and len(lean) > 0:
                source_lean[i] = lean[node]
        stop = min(target_start + high, offsets[target_layer + 1])
        for first in range(target_start + low, stop, TILE):
            last = min(first + TILE, stop)
            if bounded:
                padded = fill_tile(tile, joints, ranges, steps, lean, first, last)
                relax_bounded(
                    tile,
                    padded,
                    points[:count],
                    source_values[:count],
                    gap_weight[gap],
                    metric,
                    source_steps[:count],
                    source_lean[:count],
                    limits,
                )
            else:
                padded = fill_tile(tile, joints, ranges, steps[:0], lean[:0], first, last)
                relax(tile, padded, points[:count], source_values[:count], gap_weight[gap], metric)
            for node in range(first, last):
                best = tile[BEST_ROW * TILE + node - first]
                if widest:
                    values[node] = max(best, node_cost[node])
                else:
                    values[node] = best + node_cost[node] if forward else best


@njit(cache=True, nogil=True)
def first_path(
    offsets: IntArray,
    joints: FloatArray,
    ranges: FloatArray,
    node_cost: FloatArray,
    gap_weight: FloatArray,
    steps: FloatArray,
    step_limits: FloatArray,
    lean: FloatArray,
    lean_limits: FloatArray,
    metric: int,
    to_go: FloatArray,
    threshold: float,
    path: IntArray,
) -> None:
    """Lexicographically smallest path whose cost stays within `threshold`, given costs to go.

    Rounding may lift every total of a layer over the threshold; then the least ones still tie.
    """
    tile = np.zeros(ROWS * TILE)
    none = np.zeros(1)
    spent = 0.0
    for layer in range(len(path)):
        start = offsets[layer]
        stop = offsets[layer + 1]
        reached = node_cost[start:stop].copy()
        if layer > 0:
            node = path[layer - 1]
            limits = gap_limits(layer - 1, step_limits, lean_limits)
            point = joints[node : node + 1] / ranges
            step = steps[node : node + 1].copy() if len(steps) > 0 else np.zeros((1, 6))
            tilt = lean[node : node + 1].copy() if len(lean) > 0 else none
            value = np.full(1, spent)
            weight = gap_weight[layer - 1]
            for low in range(start, stop, TILE):
                high = min(low + TILE, stop)
                padded = fill_tile(tile, joints, ranges, steps, lean, low, high)
                relax_bounded(tile, padded, point, value, weight, metric, step, tilt, limits)
                for target in range(low, high):
                    reached[target - start] += tile[BEST_ROW * TILE + target - low]
        least = INFINITE
        for i in range(stop - start):
            least = min(least, reached[i] + to_go[start + i])
        bound = max(threshold, least)
        for i in range(stop - start):
            if reached[i] + to_go[start + i] <= bound:
                path[layer] = start + i
                spent = reached[i]
                break
