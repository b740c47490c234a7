"""Compiled dynamic programming over the edges between neighbouring layers.

Two things make it fast, and neither changes a bit of the result:

- Targets are held in a tile, structure of arrays with constant row length, and each source
  passes over the whole tile: the inner loop has no reduction, so that it vectorises under the
  strict rules of floating-point arithmetic.
- The nodes of a layer are grouped into clusters with bounding boxes. Rounding is monotone, so
  the cost from box to box, computed by the same operations in the same order, is never above
  the computed cost of any edge between the two; a cluster that cannot improve a tile is skipped.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from solver.transforms import FloatArray, IntArray

TILE = 32
FEWEST = 16
KEYS = 64
LEAN_ROW = 12
BEST_ROW = 13
ROWS = 14
INFINITE = np.inf
TOLERANCE = 1e-12

ABSOLUTE = 0
SQUARED = 1
EUCLIDEAN = 2


@njit(cache=True, nogil=True)
def group(
    joints: FloatArray,
    middle: FloatArray,
    start: int,
    stop: int,
    order: IntArray,
    first: IntArray,
    cluster_key: IntArray,
) -> int:
    """Sort nodes start..stop-1 by which joints exceed `middle`, and cut them into clusters.

    Writes the nodes to `order`, where each cluster begins to `first` and its key to
    `cluster_key`; returns the number of clusters. A cluster holds at most a tile; small ones are joined.
    """
    counts = np.zeros(KEYS + 1, dtype=np.int64)
    count = stop - start
    keys = np.empty(count, dtype=np.int64)
    for i in range(count):
        key = 0
        for joint in range(6):
            key = 2 * key + (1 if joints[start + i, joint] > middle[joint] else 0)
        keys[i] = key
        counts[key + 1] += 1
    for key in range(KEYS):
        counts[key + 1] += counts[key]
    clusters = 0
    begin = 0
    for key in range(KEYS):
        end = counts[key + 1]
        if end - begin < FEWEST and end < count:
            continue
        pieces = (end - begin + TILE - 1) // TILE
        for piece in range(pieces):
            first[clusters] = begin + (end - begin) * piece // pieces
            cluster_key[clusters] = key
            clusters += 1
        begin = end
    first[clusters] = count
    for i in range(count):
        order[counts[keys[i]]] = start + i
        counts[keys[i]] += 1
    return clusters


@njit(cache=True, nogil=True)
def gather(
    joints: FloatArray,
    ranges: FloatArray,
    steps: FloatArray,
    lean: FloatArray,
    order: IntArray,
    first: IntArray,
    clusters: int,
    rows: FloatArray,
    low: FloatArray,
    high: FloatArray,
) -> None:
    """Copy the ordered nodes into `rows` (normalised joints, steps, lean) and box each cluster."""
    width = 6
    if len(steps) > 0 or len(lean) > 0:
        width = 13
    for cluster in range(clusters):
        for row in range(width):
            low[cluster, row] = INFINITE
            high[cluster, row] = -INFINITE
        for i in range(first[cluster], first[cluster + 1]):
            node = order[i]
            for joint in range(6):
                rows[i, joint] = joints[node, joint] / ranges[joint]
            if len(steps) > 0:
                for joint in range(6):
                    rows[i, 6 + joint] = steps[node, joint]
            if len(lean) > 0:
                rows[i, LEAN_ROW] = lean[node]
            for row in range(width):
                low[cluster, row] = min(low[cluster, row], rows[i, row])
                high[cluster, row] = max(high[cluster, row], rows[i, row])


@njit(cache=True, nogil=True)
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


@njit(cache=True, nogil=True)
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


@njit(cache=True, nogil=True)
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
def box_improves(
    value: float,
    weight: float,
    metric: int,
    low: FloatArray,
    high: FloatArray,
    source: int,
    other_low: FloatArray,
    other_high: FloatArray,
    target: int,
    worst: float,
) -> bool:
    """Whether value + weight * distance between two boxes can be below `worst`."""
    d = 0.0
    for joint in range(6):
        apart = max(
            0.0,
            low[source, joint] - other_high[target, joint],
            other_low[target, joint] - high[source, joint],
        )
        d += apart if metric == ABSOLUTE else apart * apart
        if metric != EUCLIDEAN and value + weight * d >= worst:
            return False
    return metric != EUCLIDEAN or value + weight * np.sqrt(d) < worst


@njit(cache=True, nogil=True)
def boxes_allow(
    limits: FloatArray,
    low: FloatArray,
    high: FloatArray,
    source: int,
    other_low: FloatArray,
    other_high: FloatArray,
    target: int,
) -> bool:
    """Whether some step between two boxes may stay within the limits."""
    for bound in range(7):
        if limits[bound] == INFINITE:
            continue
        row = 6 + bound
        if low[source, row] - other_high[target, row] > limits[bound]:
            return False
        if other_low[target, row] - high[source, row] > limits[bound]:
            return False
    return True


@njit(cache=True, nogil=True)
def relax_clusters(
    tile: FloatArray,
    rows: FloatArray,
    values: FloatArray,
    first: IntArray,
    low: FloatArray,
    high: FloatArray,
    least: FloatArray,
    clusters: int,
    other_rows: FloatArray,
    other_first: IntArray,
    other_low: FloatArray,
    other_high: FloatArray,
    target: int,
    weight: float,
    metric: int,
    bounded: bool,
    limits: FloatArray,
    guess: int,
) -> None:
    """Fill the tile with a target cluster and relax it from all source clusters that matter.

    The source cluster `guess` comes first: the lower its costs, the more others are skipped.
    """
    begin = other_first[target]
    count = other_first[target + 1] - begin
    padded = fill_tile(tile, other_rows, begin, begin + count, 13 if bounded else 6)
    worst = INFINITE
    for turn in range(clusters + 1):
        source = guess if turn == 0 else turn - 1
        if least[source] >= worst or (turn > 0 and source == guess):
            continue
        if not box_improves(
            least[source],
            weight,
            metric,
            low,
            high,
            source,
            other_low,
            other_high,
            target,
            worst,
        ):
            continue
        if bounded and not boxes_allow(limits, low, high, source, other_low, other_high, target):
            continue
        if bounded:
            relax_bounded(
                tile,
                padded,
                rows,
                values,
                first[source],
                first[source + 1],
                weight,
                metric,
                limits,
            )
        else:
            relax(tile, padded, rows, values, first[source], first[source + 1], weight, metric)
        worst = -INFINITE
        for j in range(count):
            worst = max(worst, tile[BEST_ROW * TILE + j])


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
    middle: FloatArray,
    metric: int,
    forward: bool,
    widest: bool,
    gap_first: int,
    gap_count: int,
    piece_low: int,
    piece_high: int,
    values: FloatArray,
) -> None:
    """Carry `values` over gaps gap_first, gap_first +- 1, ...; a single gap may be cut in pieces.

    Forward: value of a target = least value + edge, plus its node cost; backward: least
    (node cost + value) + edge. `widest` takes the larger of node cost and value instead of
    the sum. piece_low..piece_high-1 are the targets to do, counted within their layer.
    """
    size = 0
    for index in range(gap_count):
        gap = gap_first + index if forward else gap_first - index
        size = max(size, offsets[gap + 1] - offsets[gap], offsets[gap + 2] - offsets[gap + 1])
    most = size // FEWEST + size // TILE + 2
    tile = np.zeros(ROWS * TILE)
    key = np.empty((2, most), dtype=np.int64)
    least = np.empty(most)
    source_values = np.empty(size)
    order = np.empty((2, size), dtype=np.int64)
    first = np.zeros((2, most + 1), dtype=np.int64)
    rows = np.zeros((2, size, 13))
    low = np.zeros((2, most, 13))
    high = np.zeros((2, most, 13))
    clusters = 0
    side = 0
    for index in range(gap_count):
        gap = gap_first + index if forward else gap_first - index
        source_layer = gap if forward else gap + 1
        target_layer = gap + 1 if forward else gap
        limits = gap_limits(gap, step_limits, lean_limits)
        bounded = False
        for bound in range(7):
            bounded = bounded or limits[bound] < INFINITE
        if index == 0:
            clusters = group(
                joints,
                middle,
                offsets[source_layer],
                offsets[source_layer + 1],
                order[side],
                first[side],
                key[side],
            )
            gather(
                joints,
                ranges,
                steps,
                lean,
                order[side],
                first[side],
                clusters,
                rows[side],
                low[side],
                high[side],
            )
        other = 1 - side
        begin = offsets[target_layer] + piece_low
        end = min(offsets[target_layer] + piece_high, offsets[target_layer + 1])
        targets = group(joints, middle, begin, end, order[other], first[other], key[other])
        gather(
            joints,
            ranges,
            steps,
            lean,
            order[other],
            first[other],
            targets,
            rows[other],
            low[other],
            high[other],
        )
        for cluster in range(clusters):
            least[cluster] = INFINITE
            for i in range(first[side, cluster], first[side, cluster + 1]):
                node = order[side, i]
                value = values[node] if forward else values[node] + node_cost[node]
                source_values[i] = value
                least[cluster] = min(least[cluster], value)
        guess = 0
        if clusters == 0:
            for node in range(begin, end):
                values[node] = INFINITE
        for target in range(targets if clusters > 0 else 0):
            while guess + 1 < clusters and key[side, guess + 1] <= key[other, target]:
                guess += 1
            relax_clusters(
                tile,
                rows[side],
                source_values,
                first[side],
                low[side],
                high[side],
                least,
                clusters,
                rows[other],
                first[other],
                low[other],
                high[other],
                target,
                gap_weight[gap],
                metric,
                bounded,
                limits,
                guess,
            )
            for i in range(first[other, target], first[other, target + 1]):
                node = order[other, i]
                best = tile[BEST_ROW * TILE + i - first[other, target]]
                if widest:
                    values[node] = max(best, node_cost[node])
                else:
                    values[node] = best + node_cost[node] if forward else best
        clusters = targets
        side = other


@njit(cache=True, nogil=True)
def step_allowed(
    steps: FloatArray, lean: FloatArray, limits: FloatArray, source: int, target: int
) -> bool:
    """Whether the steps between two nodes stay within the limits."""
    if len(steps) > 0:
        for joint in range(6):
            if abs(steps[target, joint] - steps[source, joint]) > limits[joint]:
                return False
    return not (len(lean) > 0 and abs(lean[target] - lean[source]) > limits[6])


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
    spent = 0.0
    limits = np.full(7, INFINITE)
    point = np.zeros(6)
    for layer in range(len(path)):
        start = offsets[layer]
        stop = offsets[layer + 1]
        weight = 0.0
        before = 0
        if layer > 0:
            before = path[layer - 1]
            weight = gap_weight[layer - 1]
            limits = gap_limits(layer - 1, step_limits, lean_limits)
            for joint in range(6):
                point[joint] = joints[before, joint] / ranges[joint]
        chosen = -1
        chosen_cost = INFINITE
        least = INFINITE
        for node in range(start, stop):
            reached = spent + node_cost[node]
            if layer > 0:
                d = 0.0
                for joint in range(6):
                    change = joints[node, joint] / ranges[joint] - point[joint]
                    d += abs(change) if metric == ABSOLUTE else change * change
                    # Partial sums only grow: a node that is over already cannot be chosen.
                    reached = (spent + weight * d) + node_cost[node]
                    if reached + to_go[node] >= least and reached + to_go[node] > threshold:
                        break
                if not step_allowed(steps, lean, limits, before, node):
                    continue
            total = reached + to_go[node]
            if total <= threshold:
                chosen = node
                chosen_cost = reached
                break
            if total < least:
                least = total
                chosen = node
                chosen_cost = reached
        path[layer] = chosen
        spent = chosen_cost
