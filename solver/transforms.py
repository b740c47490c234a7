"""Rotations and rigid transforms as plain arrays.

A transform is a (4, 4) array named ``target_from_source``; it maps homogeneous coordinates of the
source frame to the target frame. Angles are in radians, lengths in metres.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def frozen(values: ArrayLike, shape: tuple[int, ...] | None = None) -> FloatArray:
    """Return a read-only float copy, checked to have `shape` (-1 matches any length)."""
    array: FloatArray = np.array(values, dtype=np.float64)
    if shape is not None and not (
        array.ndim == len(shape)
        and all(want in (-1, have) for want, have in zip(shape, array.shape, strict=True))
    ):
        raise ValueError(f"expected an array of shape {shape}, got {array.shape}")
    array.setflags(write=False)
    return array


def rotation_x(angle: float) -> FloatArray:
    """(3, 3) rotation about x by `angle` [rad]."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def rotation_y(angle: float) -> FloatArray:
    """(3, 3) rotation about y by `angle` [rad]."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def rotation_z(angle: float) -> FloatArray:
    """(3, 3) rotation about z by `angle` [rad]."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def rigid(rotation: ArrayLike | None = None, position: ArrayLike | None = None) -> FloatArray:
    """(4, 4) transform from a (3, 3) rotation and a (3,) position [m]."""
    transform = np.eye(4)
    if rotation is not None:
        transform[:3, :3] = rotation
    if position is not None:
        transform[:3, 3] = position
    return transform


def inverse(transform: FloatArray) -> FloatArray:
    """Inverse of one or many (..., 4, 4) rigid transforms."""
    rotation = np.swapaxes(transform[..., :3, :3], -1, -2)
    result = np.zeros_like(transform)
    result[..., :3, :3] = rotation
    result[..., :3, 3] = -np.einsum("...ij,...j->...i", rotation, transform[..., :3, 3])
    result[..., 3, 3] = 1.0
    return result


def rotation_from_wpr(w: float, p: float, r: float) -> FloatArray:
    """(3, 3) rotation Rz(R) Ry(P) Rx(W) of FANUC's W, P, R [rad]."""
    return rotation_z(r) @ rotation_y(p) @ rotation_x(w)


def wpr_from_rotation(rotation: FloatArray) -> tuple[float, float, float]:
    """FANUC's W, P, R [rad] of a (3, 3) rotation; P in [-pi/2, pi/2].

    At P = +-90 deg only W -+ R is determined; W carries it and R is 0.
    """
    cosine = math.hypot(rotation[0, 0], rotation[1, 0])
    p = math.atan2(-rotation[2, 0], cosine)
    r = 0.0 if cosine < 1e-12 else math.atan2(rotation[1, 0], rotation[0, 0])
    # W from Rz(R)^T rotation, not from its last row: close to P = +-90 deg the rounding of that
    # row would not match that of R, and the three angles would miss the rotation.
    sine_r, cosine_r = math.sin(r), math.cos(r)
    w = math.atan2(
        sine_r * rotation[0, 2] - cosine_r * rotation[1, 2],
        cosine_r * rotation[1, 1] - sine_r * rotation[0, 1],
    )
    return w, p, r


def rotation_from_quaternion(w: float, x: float, y: float, z: float) -> FloatArray:
    """(3, 3) rotation of a quaternion w + xi + yj + zk of any non-zero length."""
    norm = math.sqrt(w * w + x * x + y * y + z * z)
    w, x, y, z = w / norm, x / norm, y / norm, z / norm
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def rotation_from_normal_and_travel(normal: ArrayLike, travel: ArrayLike) -> FloatArray:
    """Reference orientation from the outward surface normal and the travel direction.

    z points into the surface (against the normal), y along the travel (made square to z),
    x = y x z. Both vectors must be non-zero and not parallel.
    """
    z = -np.asarray(normal, dtype=np.float64)
    z = z / np.linalg.norm(z)
    y = np.asarray(travel, dtype=np.float64)
    y = y - (y @ z) * z
    y = y / np.linalg.norm(y)
    return np.column_stack([np.cross(y, z), y, z])


def rotation_angle(rotation: NDArray[Any]) -> float:
    """Angle of a (3, 3) rotation [rad], accurate for small angles too."""
    skew = np.array(
        [
            rotation[2, 1] - rotation[1, 2],
            rotation[0, 2] - rotation[2, 0],
            rotation[1, 0] - rotation[0, 1],
        ]
    )
    return math.atan2(float(np.linalg.norm(skew)), float(np.trace(rotation)) - 1.0)


def rotation_vector(rotation: FloatArray) -> FloatArray:
    """(3,) axis times angle [rad] of a (3, 3) rotation; at half a turn either sign of the axis."""
    angle = rotation_angle(rotation)
    skew = np.array(
        [
            rotation[2, 1] - rotation[1, 2],
            rotation[0, 2] - rotation[2, 0],
            rotation[1, 0] - rotation[0, 1],
        ]
    )
    if angle < np.pi - 1e-4:
        # sin(angle) / angle, also for a vanishing angle.
        vector: FloatArray = skew / (2.0 * np.sinc(angle / np.pi))
        return vector
    outer = (rotation + rotation.T) / 2.0 - np.cos(angle) * np.eye(3)
    column = outer[:, int(np.argmax(np.diag(outer)))]
    axis = column / np.linalg.norm(column)
    along: FloatArray = angle * (axis if float(axis @ skew) >= 0.0 else -axis)
    return along


def rotations_about(vector: FloatArray, share: FloatArray) -> FloatArray:
    """(m, 3, 3) rotations by `share` (m,) of the rotation vector (3,) [rad] (Rodrigues)."""
    angle = float(np.linalg.norm(vector))
    if angle == 0.0:
        return np.broadcast_to(np.eye(3), (len(share), 3, 3)).copy()
    x, y, z = vector / angle
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    turn = (angle * np.asarray(share, dtype=np.float64))[:, None, None]
    rotations: FloatArray = np.eye(3) + np.sin(turn) * cross + (1.0 - np.cos(turn)) * cross @ cross
    return rotations
