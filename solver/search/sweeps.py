"""Values carried along the layers, in pieces short enough for progress and cancelling."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from solver.progress import Monitor, checkpoint
from solver.search.graph import JOINTS, LayeredGraph
from solver.search.kernels_edges import ABSOLUTE, EUCLIDEAN, SQUARED, GraphArrays
from solver.search.kernels_sweep import sweep
from solver.transforms import FloatArray

STAGE = "search"

PIECE_EDGES = 4_000_000
"""Edges looked at between two checkpoints; under 20 ms on one core."""

MIDDLE_SAMPLE = 512
"""Nodes from which the angles between clusters are taken."""

GAP_WORK = 500
"""What a gap costs beside its edges, counted in edges."""

METRIC_ABSOLUTE, METRIC_SQUARED, METRIC_EUCLIDEAN = ABSOLUTE, SQUARED, EUCLIDEAN


class Piece(NamedTuple):
    """`gaps` whole gaps from gap `first` on, or the targets low..high-1 of one gap."""

    first: int
    gaps: int
    low: int
    high: int
    work: int


def pieces(graph: LayeredGraph, first: int, last: int, forward: bool) -> Iterator[Piece]:
    """Cut the gaps first..last-1 into pieces, in the order in which they must be done."""
    sizes = graph.layer_sizes
    work = np.maximum(sizes[:-1] * sizes[1:], GAP_WORK)
    gaps = range(first, last) if forward else range(last - 1, first - 1, -1)
    begin, held, pending = first, 0, 0
    for gap in gaps:
        if held and pending + work[gap] > PIECE_EDGES:
            yield Piece(begin, held, 0, graph.node_count, pending)
            held, pending = 0, 0
        if work[gap] > PIECE_EDGES:
            yield from _cut(graph, gap, forward)
            continue
        begin = begin if held else gap
        held, pending = held + 1, pending + int(work[gap])
    if held:
        yield Piece(begin, held, 0, graph.node_count, pending)


def _cut(graph: LayeredGraph, gap: int, forward: bool) -> Iterator[Piece]:
    """Pieces of one large gap."""
    sizes = graph.layer_sizes
    sources, targets = int(sizes[gap]), int(sizes[gap + 1])
    if not forward:
        sources, targets = targets, sources
    width = max(1, PIECE_EDGES // max(sources, 1))
    for low in range(0, targets, width):
        high = min(low + width, targets)
        yield Piece(gap, 1, low, high, sources * (high - low))


def total_work(graph: LayeredGraph, first: int, last: int) -> int:
    """Work of all pieces of the gaps first..last-1 in one direction."""
    sizes = graph.layer_sizes[first : last + 1]
    return int(np.sum(np.maximum(sizes[:-1] * sizes[1:], GAP_WORK)))


def metric_of(graph: LayeredGraph) -> int:
    """Return the kernel's number of the graph's edge cost."""
    return SQUARED if graph.squared else ABSOLUTE


class Progress:
    """Counts the work of one computation and tells the monitor."""

    def __init__(self, monitor: Monitor, total: int) -> None:
        self._monitor, self._done, self._total = monitor, 0, total
        checkpoint(monitor, STAGE, 0, total)

    def add(self, work: int) -> None:
        """Report more work as done; raises Cancelled if the monitor wants to stop."""
        self._done = min(self._done + work, self._total)
        checkpoint(self._monitor, STAGE, self._done, self._total)


def carry(
    graph: LayeredGraph,
    values: FloatArray,
    progress: Progress,
    *,
    forward: bool = True,
    gaps: tuple[int, int] | None = None,
    node_cost: FloatArray | None = None,
    gap_weight: FloatArray | None = None,
    metric: int | None = None,
    widest: bool = False,
) -> None:
    """Carry `values` (K,) over the gaps, in place; the layer that they start from is given.

    `node_cost`, `gap_weight` and `metric` replace the graph's own; `widest` keeps the larger of
    node cost and value instead of their sum.
    """
    first, last = gaps if gaps is not None else (0, graph.layer_count - 1)
    arrays, middle = kernel_arrays(graph, node_cost, gap_weight), _middle(graph)
    for piece in pieces(graph, first, last, forward):
        sweep(
            arrays,
            middle,
            metric_of(graph) if metric is None else metric,
            forward,
            widest,
            piece.first,
            piece.gaps,
            piece.low,
            piece.high,
            values,
        )
        progress.add(piece.work)


def _middle(graph: LayeredGraph) -> FloatArray:
    """Return (6,) angles that separate clusters; they matter for speed alone."""
    if graph.node_count == 0:
        return np.zeros(JOINTS)
    some = graph.joints[:: graph.node_count // MIDDLE_SAMPLE + 1]
    middle: FloatArray = (some.min(axis=0) + some.max(axis=0)) / 2.0
    return middle


def kernel_arrays(
    graph: LayeredGraph, node_cost: FloatArray | None = None, gap_weight: FloatArray | None = None
) -> GraphArrays:
    """Return the arrays of a graph; `node_cost` and `gap_weight` replace its own."""
    return GraphArrays(
        graph.offsets,
        graph.joints,
        graph.ranges,
        graph.node_cost if node_cost is None else _read_only(node_cost),
        graph.gap_weight if gap_weight is None else _read_only(gap_weight),
        _read_only(np.empty((0, JOINTS))) if graph.steps is None else graph.steps,
        _read_only(np.empty((0, JOINTS))) if graph.step_limits is None else graph.step_limits,
        _read_only(np.empty(0)) if graph.lean is None else graph.lean,
        _read_only(np.empty(0)) if graph.lean_limits is None else graph.lean_limits,
    )


def _read_only(values: FloatArray) -> FloatArray:
    """Return a read-only view: with one kind of array, one compiled kernel serves all callers."""
    view = values[:]
    view.setflags(write=False)
    return view
