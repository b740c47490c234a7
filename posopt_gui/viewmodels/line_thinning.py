"""Which points of a line over many waypoints have to be drawn so that it looks the same."""

from __future__ import annotations

from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

from solver.transforms import FloatArray, IntArray

STRAIGHT: Final = 0.2
"""How far a point that is not drawn may lie from what is drawn [px]."""

BLOCKS: Final = (256, 64, 16, 4, 2)
"""Numbers of steps that are tried as one straight line, the longest first."""

MANY_PARTS: Final = 200
"""A line of more parts is drawn with all of its points."""


def drawn_points(x: FloatArray, y: FloatArray, starts: IntArray | None = None) -> IntArray:
    """Numbers of the points of a line that are needed on the screen, in their order.

    Where several points stand in one column of pixels, the least and the greatest of them are
    kept, so that no extreme is lost; points on a straight line between others are left out.

    Parameters
    ----------
    x, y : (n,) array
        Places on the screen, x rising [px]; y may be nan where the line is interrupted.
    starts : (k,) array of int, optional
        Points at which another part of the line begins: they and those before them are kept.
    """
    cuts = _cuts(y, starts)
    if len(cuts) > MANY_PARTS:
        return np.arange(len(y))
    ends = [0, *cuts.tolist(), len(y)]
    parts = [
        first + _part(x[first:last], y[first:last])
        for first, last in pairwise(ends)
        if last > first
    ]
    return np.concatenate(parts) if parts else np.empty(0, dtype=np.int64)


def _cuts(y: FloatArray, starts: IntArray | None) -> IntArray:
    """Where parts begin: at the given points and wherever nan begins or ends."""
    known = np.isfinite(y)
    cuts = np.flatnonzero(known[1:] != known[:-1]) + 1
    if starts is not None and len(starts):
        cuts = np.union1d(cuts, starts)
    return cuts


def _part(x: FloatArray, y: FloatArray) -> IntArray:
    """The points of a part without interruptions; of a gap the first one."""
    if not np.isfinite(y[0]):
        return np.zeros(1, dtype=np.int64)
    kept = _extremes(x, y)
    return kept[_corners(x[kept], y[kept])]


def _extremes(x: FloatArray, y: FloatArray) -> IntArray:
    """Both ends, and the least and the greatest value in every column of pixels."""
    count = len(y)
    each = int((count - 1) / max(x[-1] - x[0], 1.0))
    if each < 3:
        return np.arange(count)
    columns = count // each
    first = each * np.arange(columns)
    values = y[: columns * each].reshape(columns, each)
    kept = np.zeros(count, dtype=np.bool_)
    kept[first + values.argmin(axis=1)] = kept[first + values.argmax(axis=1)] = True
    kept[columns * each :] = kept[0] = kept[-1] = True
    return np.flatnonzero(kept)


def _corners(x: FloatArray, y: FloatArray) -> NDArray[np.bool_]:
    """Where a line does not go straight on; a block of points that does keeps its ends."""
    count = len(y)
    kept = np.ones(count, dtype=np.bool_)
    for size in BLOCKS:
        blocks = (count - 1) // size
        if not blocks:
            continue
        inner = slice(0, blocks * size)
        begin, end = slice(0, blocks * size, size), slice(size, blocks * size + 1, size)
        across = x[inner].reshape(blocks, size) - x[begin, None]
        up = y[inner].reshape(blocks, size) - y[begin, None]
        slope = (y[end] - y[begin]) / (x[end] - x[begin])
        straight = np.abs(up - slope[:, None] * across).max(axis=1) <= STRAIGHT
        kept[inner].reshape(blocks, size)[straight, 1:] = False
    return kept


def tallest_of_groups(
    x: FloatArray, top: FloatArray, each: int
) -> tuple[IntArray, NDArray[np.int64]]:
    """The bar of the greatest `top` in each group of `each` waypoints, and the groups' numbers."""
    groups, starts = _groups(x, each)
    order = np.lexsort((top, groups))
    return order[np.append(starts[1:], len(x)) - 1], groups[starts]


def grouped_ranges(
    x: FloatArray, low: FloatArray, high: FloatArray, each: int
) -> tuple[NDArray[np.int64], FloatArray, FloatArray]:
    """Numbers of the groups of `each` waypoints, their least `low` and their greatest `high`."""
    groups, starts = _groups(x, each)
    least: FloatArray = np.minimum.reduceat(low, starts)
    greatest: FloatArray = np.maximum.reduceat(high, starts)
    return groups[starts], least, greatest


def _groups(x: FloatArray, each: int) -> tuple[NDArray[np.int64], IntArray]:
    """The group of every place of rising x (one place at least), and where each group begins."""
    groups = np.floor(x / each).astype(np.int64)
    return groups, np.flatnonzero(np.diff(groups, prepend=groups[0] - 1))
