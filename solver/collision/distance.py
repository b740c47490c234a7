"""Distance of two convex shapes, for people and scripts; the planner calls the kernel itself."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from solver.collision.kernels_distance import convex_distance
from solver.collision.kernels_shapes import BOX, CAPSULE, CYLINDER, HULL, SPHERE
from solver.errors import ModelError
from solver.model.shapes import Box, Capsule, ConvexShape, Cylinder, Hull, Sphere
from solver.transforms import FloatArray, frozen


class PackedShape(NamedTuple):
    """A convex shape as the kernels take it.

    `size` (3,) [m]: sphere (radius, 0, 0); capsule and cylinder (half length, radius, 0) about z;
    box half extents; hull (bounding radius about its origin, 0, 0). `vertices` (k, 3) [m] are
    a hull's, in its body frame, and empty for every other kind.
    """

    kind: int
    size: FloatArray
    vertices: FloatArray


class DistanceResult(NamedTuple):
    """Signed distance [m] and the nearest points (3,) of both shapes in the common frame [m].

    A positive `distance` is never over-stated and at most 1e-6 m under the true one. One that
    is not positive says that the shapes touch or overlap; its size is then an estimate of the
    depth, and the points are those deepest inside the other shape.
    """

    distance: float
    point_a: FloatArray
    point_b: FloatArray


def pack_shape(shape: ConvexShape) -> PackedShape:
    """Turn a convex shape into the numbers that the kernels take."""
    vertices = np.zeros((0, 3))
    match shape:
        case Sphere():
            kind, size = SPHERE, (shape.radius, 0.0, 0.0)
        case Capsule():
            kind, size = CAPSULE, (shape.length / 2.0, shape.radius, 0.0)
        case Cylinder():
            kind, size = CYLINDER, (shape.length / 2.0, shape.radius, 0.0)
        case Box():
            x, y, z = (float(extent) / 2.0 for extent in shape.size)
            kind, size = BOX, (x, y, z)
        case Hull():
            vertices = np.array(shape.vertices)
            kind, size = HULL, (float(np.linalg.norm(vertices, axis=1).max()), 0.0, 0.0)
        case _:
            raise TypeError(f"{type(shape).__name__} is not a convex shape")
    return PackedShape(kind, np.array(size), vertices)


def _rigid_pose(which: str, pose: FloatArray) -> FloatArray:
    pose = frozen(pose, (4, 4))
    rotation = pose[:3, :3]
    if not (
        np.isfinite(pose).all()
        and np.allclose(pose[3], (0.0, 0.0, 0.0, 1.0), rtol=0.0, atol=1e-9)
        and np.allclose(rotation @ rotation.T, np.eye(3), rtol=0.0, atol=1e-9)
        and np.linalg.det(rotation) > 0.0
    ):
        raise ModelError(f"the pose of the {which} shape is not a finite rotation and position")
    return pose


def distance(
    shape_a: ConvexShape, pose_a: FloatArray, shape_b: ConvexShape, pose_b: FloatArray
) -> DistanceResult:
    """Signed distance of two posed convex shapes.

    Parameters
    ----------
    shape_a : ConvexShape
        The first shape.
    pose_a : (4, 4) array
        Its world_from_body [m], in any frame common to both.
    shape_b : ConvexShape
        The second shape.
    pose_b : (4, 4) array
        Its pose in the same frame [m].

    Returns
    -------
    DistanceResult
        Certified distance and nearest points in that frame.

    Raises
    ------
    ModelError
        A pose is not a rigid transform.
    """
    a, b = pack_shape(shape_a), pack_shape(shape_b)
    pose_a, pose_b = _rigid_pose("first", pose_a), _rigid_pose("second", pose_b)
    witness = np.zeros((2, 3))
    gap = convex_distance(
        a.kind,
        a.size,
        a.vertices,
        np.ascontiguousarray(pose_a[:3, :3]),
        np.ascontiguousarray(pose_a[:3, 3]),
        b.kind,
        b.size,
        b.vertices,
        np.ascontiguousarray(pose_b[:3, :3]),
        np.ascontiguousarray(pose_b[:3, 3]),
        witness,
    )
    return DistanceResult(float(gap), witness[0].copy(), witness[1].copy())
