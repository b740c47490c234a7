"""Compiled dynamic programming over the layers.

The nodes of a layer are grouped into clusters with bounding boxes. Rounding is monotone, so the
cost from box to box, computed by the same operations in the same order, is never above the
computed cost of any edge between the two: leaving out a cluster that cannot improve a tile
does not change a bit of the result.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from solver.kernel import kernel
from solver.search.kernels_edges import (
    ABSOLUTE,
    BEST_ROW,
    EUCLIDEAN,
    INFINITE,
    LEAN_ROW,
    ROWS,
    STEP_ROW,
    TILE,
    GraphArrays,
    fill_tile,
    gap_limits,
    relax,
    relax_bounded,
    step_allowed,
)
from solver.transforms import FloatArray, IntArray

KEYS = 64
FINE = 32
FEWEST = 16
COARSE_GAPS = 8


class Clusters(NamedTuple):
    """Some nodes of a layer in clusters.

    `order` are the nodes, `first` where each cluster begins among them, `key` what its nodes
    share; `rows` hold normalised joints, steps and lean; `low` and `high` box each cluster.
    """

    order: IntArray
    first: IntArray
    key: IntArray
    rows: FloatArray
    low: FloatArray
    high: FloatArray


@kernel
def empty_clusters(size: int) -> Clusters:
    """Room for the clusters of up to `size` nodes."""
    most = size // FEWEST + size // FINE + 2
    return Clusters(
        np.empty(size, dtype=np.int64),
        np.zeros(most + 1, dtype=np.int64),
        np.empty(most, dtype=np.int64),
        np.zeros((size, LEAN_ROW + 1)),
        np.zeros((most, LEAN_ROW + 1)),
        np.zeros((most, LEAN_ROW + 1)),
    )


@kernel
def fill_clusters(graph: GraphArrays, clusters: int, out: Clusters) -> None:
    """Copy the ordered nodes into rows and box each cluster."""
    width = 6
    if len(graph.steps) > 0 or len(graph.lean) > 0:
        width = LEAN_ROW + 1
    for cluster in range(clusters):
        for row in range(width):
            out.low[cluster, row] = INFINITE
            out.high[cluster, row] = -INFINITE
        for i in range(out.first[cluster], out.first[cluster + 1]):
            node = out.order[i]
            for joint in range(6):
                out.rows[i, joint] = graph.joints[node, joint] / graph.ranges[joint]
            if len(graph.steps) > 0:
                for joint in range(6):
                    out.rows[i, STEP_ROW + joint] = graph.steps[node, joint]
            if len(graph.lean) > 0:
                out.rows[i, LEAN_ROW] = graph.lean[node]
            for row in range(width):
                out.low[cluster, row] = min(out.low[cluster, row], out.rows[i, row])
                out.high[cluster, row] = max(out.high[cluster, row], out.rows[i, row])


@kernel
def cluster_nodes(
    graph: GraphArrays, middle: FloatArray, start: int, stop: int, coarse: bool, out: Clusters
) -> int:
    """Sort the nodes start..stop-1 by which joints exceed `middle`, and cut them into clusters.

    Large clusters are cut and small ones joined; a coarse one fills a tile. Returns their number.
    """
    fewest = TILE if coarse else FEWEST
    largest = TILE if coarse else FINE
    counts = np.zeros(KEYS + 1, dtype=np.int64)
    count = stop - start
    keys = np.empty(count, dtype=np.int64)
    for i in range(count):
        key = 0
        for joint in range(6):
            key = 2 * key + (1 if graph.joints[start + i, joint] > middle[joint] else 0)
        keys[i] = key
        counts[key + 1] += 1
    for key in range(KEYS):
        counts[key + 1] += counts[key]
    clusters = 0
    begin = 0
    for key in range(KEYS):
        end = counts[key + 1]
        if end - begin < fewest and end < count:
            continue
        pieces = (end - begin + largest - 1) // largest
        for piece in range(pieces):
            out.first[clusters] = begin + (end - begin) * piece // pieces
            out.key[clusters] = key
            clusters += 1
        begin = end
    out.first[clusters] = count
    for i in range(count):
        out.order[counts[keys[i]]] = start + i
        counts[keys[i]] += 1
    fill_clusters(graph, clusters, out)
    return clusters


@kernel
def box_improves(
    value: float,
    weight: float,
    metric: int,
    sources: Clusters,
    source: int,
    targets: Clusters,
    target: int,
    worst: float,
) -> bool:
    """Whether value + weight * distance between two boxes can be below `worst`."""
    d = 0.0
    for joint in range(6):
        apart = max(
            0.0,
            sources.low[source, joint] - targets.high[target, joint],
            targets.low[target, joint] - sources.high[source, joint],
        )
        d += apart if metric == ABSOLUTE else apart * apart
        if metric != EUCLIDEAN and value + weight * d >= worst:
            return False
    return metric != EUCLIDEAN or value + weight * np.sqrt(d) < worst


@kernel
def boxes_allow(
    limits: FloatArray, sources: Clusters, source: int, targets: Clusters, target: int
) -> bool:
    """Whether some step between two boxes may stay within the limits."""
    for bound in range(7):
        if limits[bound] < INFINITE:
            row = STEP_ROW + bound
            if sources.low[source, row] - targets.high[target, row] > limits[bound]:
                return False
            if targets.low[target, row] - sources.high[source, row] > limits[bound]:
                return False
    return True


@kernel
def relax_cluster(
    tile: FloatArray,
    sources: Clusters,
    values: FloatArray,
    least: FloatArray,
    guess: int,
    targets: Clusters,
    target: int,
    weight: float,
    metric: int,
    limits: FloatArray,
    bounded: bool,
) -> int:
    """Fill the tile with a target cluster and relax it from every source cluster that matters.

    `least` holds the least value of each source cluster. The cluster `guess` comes first: the
    lower its costs, the more of the others are skipped. Returns how many were not.
    """
    begin = targets.first[target]
    count = targets.first[target + 1] - begin
    width = LEAN_ROW + 1 if bounded else 6
    padded = fill_tile(tile, targets.rows, begin, begin + count, width)
    worst = INFINITE
    done = 0
    for turn in range(len(least) + 1):
        source = guess if turn == 0 else turn - 1
        if least[source] >= worst or (turn > 0 and source == guess):
            continue
        if not box_improves(least[source], weight, metric, sources, source, targets, target, worst):
            continue
        low, high = sources.first[source], sources.first[source + 1]
        if not bounded:
            relax(tile, padded, sources.rows, values, low, high, weight, metric)
        elif boxes_allow(limits, sources, source, targets, target):
            relax_bounded(tile, padded, sources.rows, values, low, high, weight, metric, limits)
        else:
            continue
        done += 1
        worst = -INFINITE
        for j in range(count):
            worst = max(worst, tile[BEST_ROW * TILE + j])
    return done


@kernel
def sweep(
    graph: GraphArrays,
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
    if gap_count == 0:
        return
    offsets = graph.offsets
    size = 0
    for index in range(gap_count):
        gap = gap_first + index if forward else gap_first - index
        size = max(size, offsets[gap + 1] - offsets[gap], offsets[gap + 2] - offsets[gap + 1])
    tile = np.zeros(ROWS * TILE)
    sources, targets = empty_clusters(size), empty_clusters(size)
    source_values, least = np.empty(size), np.empty(len(sources.key))
    layer = gap_first if forward else gap_first + 1
    coarse = 0
    source_count = cluster_nodes(graph, middle, offsets[layer], offsets[layer + 1], False, sources)
    for index in range(gap_count):
        gap = gap_first + index if forward else gap_first - index
        layer = gap + 1 if forward else gap
        begin = offsets[layer] + piece_low
        end = min(offsets[layer] + piece_high, offsets[layer + 1])
        target_count = cluster_nodes(graph, middle, begin, end, coarse > 0, targets)
        for cluster in range(source_count):
            least[cluster] = INFINITE
            for i in range(sources.first[cluster], sources.first[cluster + 1]):
                node = sources.order[i]
                value = values[node] if forward else values[node] + graph.node_cost[node]
                source_values[i] = value
                least[cluster] = min(least[cluster], value)
        limits = gap_limits(gap, graph.step_limits, graph.lean_limits)
        bounded = limits.min() < INFINITE
        guess = 0
        done = 0
        for target in range(target_count):
            while guess + 1 < source_count and sources.key[guess + 1] <= targets.key[target]:
                guess += 1
            if source_count == 0:
                tile[BEST_ROW * TILE :] = INFINITE
            else:
                done += relax_cluster(
                    tile,
                    sources,
                    source_values,
                    least[:source_count],
                    guess,
                    targets,
                    target,
                    graph.gap_weight[gap],
                    metric,
                    limits,
                    bounded,
                )
            for i in range(targets.first[target], targets.first[target + 1]):
                node = targets.order[i]
                best = tile[BEST_ROW * TILE + i - targets.first[target]]
                if widest:
                    values[node] = max(best, graph.node_cost[node])
                else:
                    values[node] = best + graph.node_cost[node] if forward else best
        # Where hardly any cluster can be skipped, large ones cost less; look again now and then.
        coarse -= 1
        if coarse <= 0 and 2 * done > source_count * target_count:
            coarse = COARSE_GAPS
        sources, targets = targets, sources
        source_count = target_count


@kernel
def first_path(
    graph: GraphArrays,
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
        start = graph.offsets[layer]
        stop = graph.offsets[layer + 1]
        weight = 0.0
        before = 0
        if layer > 0:
            before = path[layer - 1]
            weight = graph.gap_weight[layer - 1]
            limits = gap_limits(layer - 1, graph.step_limits, graph.lean_limits)
            for joint in range(6):
                point[joint] = graph.joints[before, joint] / graph.ranges[joint]
        chosen = -1
        chosen_cost = INFINITE
        least = INFINITE
        for node in range(start, stop):
            reached = spent + graph.node_cost[node]
            if layer > 0:
                d = 0.0
                for joint in range(6):
                    change = graph.joints[node, joint] / graph.ranges[joint] - point[joint]
                    d += abs(change) if metric == ABSOLUTE else change * change
                    # Partial sums only grow: a node that is over already cannot be chosen.
                    reached = (spent + weight * d) + graph.node_cost[node]
                    if reached + to_go[node] >= least and reached + to_go[node] > threshold:
                        break
                if not step_allowed(graph, limits, before, node):
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
