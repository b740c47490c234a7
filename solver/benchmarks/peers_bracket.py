"""Bounds that hold the distance of two convex bodies between them, by plain numpy.

Two parallel planes that part the bodies bound the distance from below, a point of each body from
above (weak duality of the convex programme that the distance is). Both only need points to start
from, whoever found them, and share no code with any solver that is compared.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from solver.collision.convex_hull import hull_triangles
from solver.collision.kernels_shapes import BOX, CAPSULE, CYLINDER, HULL, SPHERE
from solver.transforms import FloatArray

HULL_SLACK = 20.0
"""A point so many times nearer to a hull's faces than to the hull: edges as sharp as 6 deg."""


class PosedBody(NamedTuple):
    """A convex body as the kernels take it, with its pose; `faces` (m, 4) bound a hull."""

    kind: int
    size: FloatArray
    vertices: FloatArray
    rotation: FloatArray
    position: FloatArray
    faces: FloatArray


class Bracket(NamedTuple):
    """The distance lies between `low` and `high` [m]."""

    low: float
    high: float


def hull_faces(vertices: FloatArray) -> FloatArray:
    """(m, 4) planes of a hull: outward unit normal and offset [m]."""
    rows, grown = hull_triangles(vertices)
    corners = grown[rows]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    offsets = (normals[:, None, :] @ vertices.T[None]).max(axis=(1, 2))
    return np.column_stack([normals, offsets])


def bracket(a: PosedBody, b: PosedBody, points: list[tuple[FloatArray, FloatArray]]) -> Bracket:
    """Bound the distance by the best of some pairs of points, one near each body.

    `low` is 0 where no plane that was tried parts the bodies.
    """
    low, high = 0.0, np.inf
    for point_a, point_b in points:
        apart = point_a - point_b
        length = float(np.linalg.norm(apart))
        if not np.isfinite(length):
            continue
        high = min(high, length + outside(a, point_a) + outside(b, point_b))
        if length > 0.0:
            direction = apart / length
            low = max(low, -reach(a, -direction) - reach(b, direction))
    return Bracket(low, max(low, high))


def reach(body: PosedBody, direction: FloatArray) -> float:
    """Largest value of direction . x over a body [m]."""
    local = direction @ body.rotation
    offset = float(direction @ body.position)
    size = body.size
    match body.kind:
        case k if k == SPHERE:
            return offset + float(size[0] * np.linalg.norm(local))
        case k if k == CAPSULE:
            return offset + float(size[0] * abs(local[2]) + size[1] * np.linalg.norm(local))
        case k if k == CYLINDER:
            across = np.hypot(local[0], local[1])
            return offset + float(size[0] * abs(local[2]) + size[1] * across)
        case k if k == BOX:
            return offset + float(size @ np.abs(local))
    return offset + float((body.vertices @ local).max())


def outside(body: PosedBody, point: FloatArray) -> float:
    """Upper bound of a point's distance from a body, 0 inside [m]."""
    local = (point - body.position) @ body.rotation
    size = body.size
    across = float(np.hypot(local[0], local[1]))
    match body.kind:
        case k if k == SPHERE:
            return max(0.0, float(np.linalg.norm(local) - size[0]))
        case k if k == CAPSULE:
            beyond = max(0.0, abs(float(local[2])) - float(size[0]))
            return max(0.0, float(np.hypot(across, beyond) - size[1]))
        case k if k == CYLINDER:
            beyond = max(0.0, abs(float(local[2])) - float(size[0]))
            return float(np.hypot(max(0.0, across - float(size[1])), beyond))
        case k if k == BOX:
            return float(np.linalg.norm(np.maximum(np.abs(local) - size, 0.0)))
    beyond = float((body.faces[:, :3] @ local - body.faces[:, 3]).max())
    return HULL_SLACK * max(0.0, beyond)


def posed(
    kind: int, size: FloatArray, vertices: FloatArray, rotation: FloatArray, position: FloatArray
) -> PosedBody:
    """Pose a body; the faces of a hull are found here."""
    faces = hull_faces(vertices) if kind == HULL else np.empty((0, 4))
    return PosedBody(int(kind), size, vertices, rotation, position, faces)
