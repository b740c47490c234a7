"""Reference orientations of many points at once, from the forms that path files use.

A value that cannot be an orientation raises :class:`PointError`, which carries the index of the
point, so that the importer can name the place in its file.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from solver.transforms import FloatArray
from solver.units import DEG, DEG_PER_RAD

LENGTH_TOLERANCE: Final = 1e-3
"""How far the length of a quaternion or a normal may be from 1; it is normalised then."""

PARALLEL_TOLERANCE: Final = 1e-3
"""Least angle between the normal and the travel direction [rad]."""

_ZERO: Final = 1e-9


class PointError(ValueError):
    """What is wrong with the point number `index` of an array, without a place."""

    def __init__(self, index: int, message: str) -> None:
        self.index = index
        super().__init__(message)


def rotations_from_quaternions(quaternions: FloatArray) -> FloatArray:
    """Return the (n, 3, 3) rotations of (n, 4) unit quaternions (w, x, y, z)."""
    w, x, y, z = _unit(quaternions, "the quaternion").T
    return _stack(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def rotations_from_wpr_degrees(angles: FloatArray) -> FloatArray:
    """Return the (n, 3, 3) rotations Rz(R) Ry(P) Rx(W) of (n, 3) FANUC angles W, P, R [deg]."""
    (cw, cp, cr), (sw, sp, sr) = np.cos(angles * DEG).T, np.sin(angles * DEG).T
    return _stack(
        [
            [cr * cp, cr * sp * sw - sr * cw, cr * sp * cw + sr * sw],
            [sr * cp, sr * sp * sw + cr * cw, sr * sp * cw - cr * sw],
            [-sp, cp * sw, cp * cw],
        ]
    )


def unit_normals(normals: FloatArray) -> FloatArray:
    """Return (n, 3) outward normals of length 1 within the tolerance, normalised."""
    return _unit(normals, "the normal")


def rotations_from_normals_and_travels(
    normals: FloatArray, travels: FloatArray, convention: str = "normal_travel"
) -> FloatArray:
    """Return the (n, 3, 3) rotations from unit normals and travel directions of any length.

    z points against the outward normal. With 'normal_travel', y lies along the travel (made
    square to z) and x = y x z; with 'normal_travel_x', x lies along the travel and y = z x x.
    """
    lengths = np.linalg.norm(travels, axis=1)
    for index in np.flatnonzero(~(lengths > _ZERO)):
        raise PointError(
            int(index), "the travel direction is zero, expected a direction along the path"
        )
    along = travels / lengths[:, None]
    z = -normals
    across = _cross(along, z)
    sines = np.linalg.norm(across, axis=1)
    for index in np.flatnonzero(~(sines >= math.sin(PARALLEL_TOLERANCE))):
        angle = math.asin(float(sines[index])) * DEG_PER_RAD
        raise PointError(
            int(index),
            f"the normal and the travel direction are parallel (within {angle:.3g} deg), "
            f"expected 0.0573 deg or more between their lines",
        )
    across /= sines[:, None]
    straight = _cross(z, across)
    if convention == "normal_travel_x":
        return np.stack([straight, -across, z], axis=-1)
    return np.stack([across, straight, z], axis=-1)


def _unit(vectors: FloatArray, what: str) -> FloatArray:
    lengths = np.linalg.norm(vectors, axis=1)
    for index in np.flatnonzero(~(np.abs(lengths - 1.0) <= LENGTH_TOLERANCE)):
        length = float(lengths[index])
        if length <= _ZERO:
            raise PointError(int(index), f"{what} is zero, expected a length of 1")
        raise PointError(
            int(index),
            f"{what} has a length of {length:.6g}, expected 1 within {LENGTH_TOLERANCE:g}",
        )
    unit: FloatArray = vectors / lengths[:, None]
    return unit


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.column_stack(
        [
            a[:, 1] * b[:, 2] - a[:, 2] * b[:, 1],
            a[:, 2] * b[:, 0] - a[:, 0] * b[:, 2],
            a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0],
        ]
    )


def _stack(rows: list[list[FloatArray]]) -> FloatArray:
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
