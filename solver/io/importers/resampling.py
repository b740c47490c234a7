"""Resampling a toolpath by arc length."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from typing import Final

import numpy as np

from solver.errors import ModelError
from solver.io.importers.orientation import rotations_from_quaternions
from solver.io.importers.parametric import steps_of
from solver.model.toolpath import Pass, Toolpath
from solver.transforms import FloatArray, IntArray

CORNER: Final = 1e-3
"""A waypoint is kept where the path has turned by more than this since the last kept one [rad]."""

MAX_POINTS: Final = 1_000_000
"""Most waypoints of a resampled toolpath."""


def resample(toolpath: Toolpath, step: float) -> Toolpath:
    """Return the toolpath with waypoints at most `step` [m] apart, evenly between kept ones.

    Kept are the ends of every pass, waypoints with events, the last waypoint of a role and
    corners of more than 1e-3 rad, so that the polyline, its length and its events stay what
    they are; other waypoints are replaced. Between two given waypoints positions run straight
    and orientations turn about one axis (slerp); a new waypoint has the role of the given one
    that it leads to. Passes are never joined.

    Raises
    ------
    ModelError
        For a step that is not positive, or that makes more than 1,000,000 waypoints.
    """
    if not (math.isfinite(step) and step > 0.0):
        raise ModelError(f"the resampling step must be positive, got {step:g} m")
    lengths = [_lengths(one)[-1] for one in toolpath.passes]
    if sum(lengths) / step > MAX_POINTS:
        raise ModelError(
            f"a step of {step:g} m makes more than {MAX_POINTS:,} waypoints, expected a larger one"
        )
    return toolpath.with_passes(tuple(_resampled(one, step) for one in toolpath.passes))


def slerp(rotations: FloatArray, index: IntArray, share: FloatArray) -> FloatArray:
    """Return the (k, 3, 3) rotations at `share` (k,) of the way from `index` (k,) to the next.

    `rotations` is (n, 3, 3). Each turns about one axis at constant speed, the short way; at
    half a turn the axis is one of two, and which one is fixed by the quaternions' signs.
    """
    quaternions = np.array([_quaternion(one) for one in rotations])
    first, last = quaternions[index], quaternions[np.minimum(index + 1, len(rotations) - 1)]
    last = np.where((first * last).sum(axis=1) < 0.0, -1.0, 1.0)[:, None] * last
    # The angle between two unit vectors, accurate for small ones and for large ones.
    angle = 2.0 * np.arctan2(
        np.linalg.norm(last - first, axis=1), np.linalg.norm(last + first, axis=1)
    )
    sine = np.sin(angle)
    small = sine < 1e-9
    divisor = np.where(small, 1.0, sine)
    before = np.where(small, 1.0 - share, np.sin((1.0 - share) * angle) / divisor)
    after = np.where(small, share, np.sin(share * angle) / divisor)
    turned = before[:, None] * first + after[:, None] * last
    return rotations_from_quaternions(turned / np.linalg.norm(turned, axis=1)[:, None])


def _resampled(one: Pass, step: float) -> Pass:
    if len(one) == 1:
        return one
    lengths = _lengths(one)
    stations, new_index = [0.0], {0: 0}
    for start, end in pairwise(_kept(one)):
        count = steps_of(lengths[end] - lengths[start], step)
        stations += list(np.linspace(lengths[start], lengths[end], count + 1)[1:])
        new_index[end] = len(stations) - 1
    where = np.array(stations)
    segment = np.clip(np.searchsorted(lengths, where, side="left") - 1, 0, len(one) - 2)
    share = (where - lengths[segment]) / (lengths[segment + 1] - lengths[segment])
    poses = np.zeros((len(where), 4, 4))
    poses[:, 3, 3] = 1.0
    poses[:, :3, :3] = slerp(one.poses[:, :3, :3], segment, share)
    before, after = one.positions[segment], one.positions[segment + 1]
    poses[:, :3, 3] = before + share[:, None] * (after - before)
    roles = [one.roles[given + 1] for given in segment]
    for given, index in new_index.items():
        # Kept waypoints are exactly what they were, not what interpolation rounds them to.
        poses[index] = one.poses[given]
        roles[index] = one.roles[given]
    events = {new_index[given]: those for given, those in one.events.items()}
    return replace(one, poses=poses, roles=tuple(roles), events=events)


def _lengths(one: Pass) -> FloatArray:
    """Return the arc length from the start of the pass to every waypoint (n,) [m]."""
    gaps = np.linalg.norm(np.diff(one.positions, axis=0), axis=1)
    lengths: FloatArray = np.concatenate([[0.0], np.cumsum(gaps)])
    return lengths


def _kept(one: Pass) -> list[int]:
    """Return the indices of the waypoints that resampling does not replace, ascending."""
    last = len(one) - 1
    steps = np.diff(one.positions, axis=0)
    before, after = steps[:-1], steps[1:]
    cross = np.linalg.norm(np.cross(before, after), axis=1)
    turns = np.arctan2(cross, (before * after).sum(axis=1))
    kept = {0, last, *one.events}
    kept |= {index for index in range(last) if one.roles[index] is not one.roles[index + 1]}
    turned = 0.0
    for index, turn in enumerate(turns, start=1):
        # Many small turns add up to an arc, which long steps would cut.
        turned = 0.0 if index in kept else turned + float(turn)
        if turned > CORNER:
            kept.add(index)
            turned = 0.0
    return sorted(kept)


def _quaternion(rotation: FloatArray) -> FloatArray:
    """Return the unit quaternion (w, x, y, z) of a rotation, from its largest component."""
    r = rotation
    squares = np.array(
        [
            1.0 + r[0, 0] + r[1, 1] + r[2, 2],
            1.0 + r[0, 0] - r[1, 1] - r[2, 2],
            1.0 - r[0, 0] + r[1, 1] - r[2, 2],
            1.0 - r[0, 0] - r[1, 1] + r[2, 2],
        ]
    )
    largest = int(np.argmax(squares))
    rows = np.array(
        [
            [squares[0], r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]],
            [r[2, 1] - r[1, 2], squares[1], r[0, 1] + r[1, 0], r[0, 2] + r[2, 0]],
            [r[0, 2] - r[2, 0], r[0, 1] + r[1, 0], squares[2], r[1, 2] + r[2, 1]],
            [r[1, 0] - r[0, 1], r[0, 2] + r[2, 0], r[1, 2] + r[2, 1], squares[3]],
        ]
    )
    quaternion: FloatArray = rows[largest] / np.linalg.norm(rows[largest])
    return quaternion
