"""Compiled loops over the edges from many sources to a tile of targets.

Targets are held in a tile, structure of arrays with constant row length, and each source passes
over the whole tile: the inner loop has no reduction, so that it vectorises under the strict
rules of floating-point arithmetic.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from solver.kernel import kernel
from solver.transforms import FloatArray, IntArray

TILE = 128
STEP_ROW = 6
LEAN_ROW = 12
BEST_ROW = 13
ROWS = 14
INFINITE = np.inf
TOLERANCE = 1e-12

ABSOLUTE = 0
SQUARED = 1
EUCLIDEAN = 2


class GraphArrays(NamedTuple):
    """A graph for compiled loops: read-only arrays, of length 0 where the graph has none."""

    offsets: IntArray
    joints: FloatArray
    ranges: FloatArray
    node_cost: FloatArray
    gap_weight: FloatArray
    steps: FloatArray
    step_limits: FloatArray
    lean: FloatArray
    lean_limits: FloatArray


@kernel
def fill_tile(tile: FloatArray, rows: FloatArray, begin: int, end: int, width: int) -> int:
    """Put rows begin..end-1 into the tile, best infinite; returns the length padded to eight."""
    count = end - begin
    padded = (count + 7) // 8 * 8
    for j in range(count):
        for row in range(width):
            tile[row * TILE + j] = rows[begin + j, row]
    for row in range(width):
        for j in range(count, padded):
            tile[row * TILE + j] = 0.0
    for j in range(padded):
        tile[BEST_ROW * TILE + j] = INFINITE
    return padded


@kernel
def relax(
    tile: FloatArray,
    count: int,
    rows: FloatArray,
    values: FloatArray,
    begin: int,
    end: int,
    weight: float,
    metric: int,
) -> None:
    """Lower the tile's best to the least value + weight * distance over sources begin..end-1."""
    for i in range(begin, end):
        value = values[i]
        if value == INFINITE:
            continue
        a0 = rows[i, 0]
        a1 = rows[i, 1]
        a2 = rows[i, 2]
        a3 = rows[i, 3]
        a4 = rows[i, 4]
        a5 = rows[i, 5]
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


@kernel
def relax_bounded(
    tile: FloatArray,
    count: int,
    rows: FloatArray,
    values: FloatArray,
    begin: int,
    end: int,
    weight: float,
    metric: int,
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
    for i in range(begin, end):
        value = values[i]
        if value == INFINITE:
            continue
        a0 = rows[i, 0]
        a1 = rows[i, 1]
        a2 = rows[i, 2]
        a3 = rows[i, 3]
        a4 = rows[i, 4]
        a5 = rows[i, 5]
        b0 = rows[i, 6]
        b1 = rows[i, 7]
        b2 = rows[i, 8]
        b3 = rows[i, 9]
        b4 = rows[i, 10]
        b5 = rows[i, 11]
        b6 = rows[i, 12]
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


@kernel
def gap_limits(gap: int, step_limits: FloatArray, lean_limits: FloatArray) -> FloatArray:
    """Seven limits of a gap, tolerance included; infinite where there is none."""
    limits = np.full(7, INFINITE)
    if len(step_limits) > 0:
        for joint in range(6):
            limits[joint] = step_limits[gap, joint] + TOLERANCE
    if len(lean_limits) > 0:
        limits[6] = lean_limits[gap] + TOLERANCE
    return limits


@kernel
def step_allowed(graph: GraphArrays, limits: FloatArray, source: int, target: int) -> bool:
    """Whether the steps between two nodes stay within the limits."""
    steps, lean = graph.steps, graph.lean
    if len(steps) > 0:
        for joint in range(6):
            if abs(steps[target, joint] - steps[source, joint]) > limits[joint]:
                return False
    return not (len(lean) > 0 and abs(lean[target] - lean[source]) > limits[6])
