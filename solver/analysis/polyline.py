"""Distances between points and polylines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from solver.transforms import FloatArray, IntArray
from solver.units import MM


@dataclass(frozen=True, slots=True, eq=False)
class Projection:
    """Nearest points of a polyline to k points.

    `distance` (k,) [m], `segment` (k,) number of the segment, `share` (k,) 0..1 along it.
    """

    distance: FloatArray
    segment: IntArray
    share: FloatArray


def project(points: FloatArray, line: FloatArray) -> Projection:
    """Nearest point of the polyline through `line` (n, 3) for each of `points` (k, 3) [m]."""
    if len(line) == 1:
        distance = np.linalg.norm(points - line[0], axis=1)
        return Projection(distance, np.zeros(len(points), np.int64), np.zeros(len(points)))
    along = np.diff(line, axis=0)
    length = np.einsum("ij,ij->i", along, along)
    offset = points[:, None, :] - line[None, :-1, :]
    share = np.einsum("kij,ij->ki", offset, along) / np.where(length > 0.0, length, 1.0)
    share = np.clip(share, 0.0, 1.0)
    away = np.linalg.norm(offset - share[..., None] * along, axis=2)
    segment = np.argmin(away, axis=1)
    rows = np.arange(len(points))
    return Projection(away[rows, segment], segment.astype(np.int64), share[rows, segment])


SAME_PLACE = 0.05 * MM
"""Distance below which a point counts as being at its target [m]: rounding decides nothing."""


def match(
    points: FloatArray,
    targets: FloatArray,
    *,
    strictly: bool,
    late: Sequence[bool] | None = None,
) -> IntArray:
    """Number of the point that stands for each target, in ascending order, nearest in all.

    Dynamic programming over the sum of distances: `points` (m, 3) are visited in their order,
    and no target (n, 3) comes before the one ahead of it; with `strictly` no two targets share
    a point, and m must be at least n. Where several points serve a target equally well the
    first one is taken, or the last one where `late` (n,) says so.
    """
    count, gap = len(points), 1 if strictly else 0
    last = [False] * len(targets) if late is None else list(late)
    total = _away(points, targets[0], settled=late is not None)
    choices = np.zeros((len(targets), count), dtype=np.int32)
    for row in range(1, len(targets)):
        # Best sum over all points up to each one.
        best = np.minimum.accumulate(total)
        better = total[1:] <= best[:-1] if last[row - 1] else total[1:] < best[:-1]
        is_new = np.concatenate([[True], better])
        choice = np.maximum.accumulate(np.where(is_new, np.arange(count), 0))
        if gap:
            best = np.concatenate([[np.inf], best[:-1]])
            choice = np.concatenate([[0], choice[:-1]])
        choices[row] = choice
        total = best + _away(points, targets[row], settled=late is not None)
    found = np.empty(len(targets), dtype=np.int64)
    end = int(np.argmin(total[::-1])) if last[-1] else int(np.argmin(total))
    found[-1] = count - 1 - end if last[-1] else end
    for row in range(len(targets) - 1, 0, -1):
        found[row - 1] = choices[row, found[row]]
    return found


def _away(points: FloatArray, target: FloatArray, *, settled: bool) -> FloatArray:
    """Distances from a target; with `settled` those at the same place are all 0."""
    away: FloatArray = np.linalg.norm(points - target, axis=1)
    return np.where(away < SAME_PLACE, 0.0, away) if settled else away
