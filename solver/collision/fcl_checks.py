"""python-fcl as a second opinion: a self-test of distances, and collide() for cross-checks.

Its distance between primitives is wrong in cases as plain as two boxes side by side (fcl issue
508) and is used nowhere; its collide() decides overlap alone and serves in tests.
"""

from __future__ import annotations

import math
from typing import Any, Final, NamedTuple

import numpy as np

from solver.collision.convex_hull import hull_triangles
from solver.collision.mesh_distance import MeshObstacle, mesh_clearance
from solver.collision.mesh_proxy import ConvexProxy, box_triangles, bvh_model
from solver.errors import ModelError
from solver.model.shapes import Box, Capsule, ConvexShape, Cylinder, Hull, Mesh, Shape, Sphere
from solver.transforms import FloatArray, rigid

NOT_RELIED_ON: Final = "python-fcl primitive distance"
"""Beginning of the names of checks whose failure is known and not relied on."""

ALLOWED: Final = 1e-6
"""Error [m] up to which a distance counts as right."""


class DistanceCheck(NamedTuple):
    """One distance of the self-test: `expected` and `found` [m], and whether they agree."""

    name: str
    expected: float
    found: float
    ok: bool


def fcl_self_test() -> list[DistanceCheck]:
    """Distances with known answers, by every means that posopt has.

    Returns
    -------
    list of DistanceCheck
        Every check whose name does not begin with `NOT_RELIED_ON` must be ok; the others show
        what python-fcl's primitive distance says of the same pairs.
    """
    from solver.collision.distance import distance  # noqa: PLC0415 - compiles on first use

    unit = Box(np.ones(3))
    post = Cylinder(0.5, 1.0)
    cases: list[tuple[str, ConvexShape, ConvexShape, FloatArray, float]] = [
        ("unit boxes, centres 4 m apart in y", unit, unit, np.array([0.0, 4.0, 0.0]), 3.0),
        ("box and upright cylinder, 4 m apart in x", unit, post, np.array([4.0, 0.0, 0.0]), 3.0),
        ("box and upright cylinder, 3 m apart in z", unit, post, np.array([0.0, 0.0, 3.0]), 2.0),
    ]
    home = rigid()
    checks: list[DistanceCheck] = []
    for name, first, second, position, expected in cases:
        away = rigid(position=position)
        means = {
            "posopt kernels": distance(first, home, second, away).distance,
            "posopt mesh distance": _by_mesh(second, away, first, home),
            NOT_RELIED_ON: _fcl_distance(first, home, second, away),
        }
        checks += [
            DistanceCheck(
                f"{how}: {name}", expected, found, math.isclose(found, expected, abs_tol=ALLOWED)
            )
            for how, found in means.items()
        ]
    return checks


def _by_mesh(
    moving: ConvexShape, moving_pose: FloatArray, fixed: ConvexShape, fixed_pose: FloatArray
) -> float:
    if not isinstance(fixed, Box):
        raise ModelError("the self-test takes boxes as meshes only")
    obstacle = MeshObstacle(Mesh(*box_triangles(fixed.size)), fixed_pose)
    return mesh_clearance(ConvexProxy(moving, ALLOWED), moving_pose, obstacle).distance


def collides_fcl(shape_a: Shape, pose_a: FloatArray, shape_b: Shape, pose_b: FloatArray) -> bool:
    """Whether python-fcl's collide() finds that two posed shapes touch or overlap.

    Poses are (4, 4) [m] in one frame. Meshes are surfaces to fcl: one body wholly inside
    another is not found where either is a mesh.
    """
    import fcl  # noqa: PLC0415 - a second opinion, loaded when asked for

    result = fcl.CollisionResult()
    objects = [_fcl_object(shape_a, pose_a), _fcl_object(shape_b, pose_b)]
    return bool(fcl.collide(*objects, fcl.CollisionRequest(), result))


def _fcl_distance(shape_a: Shape, pose_a: FloatArray, shape_b: Shape, pose_b: FloatArray) -> float:
    import fcl  # noqa: PLC0415 - a second opinion, loaded when asked for

    objects = [_fcl_object(shape_a, pose_a), _fcl_object(shape_b, pose_b)]
    return float(fcl.distance(*objects, fcl.DistanceRequest(), fcl.DistanceResult()))


def _fcl_object(shape: Shape, pose: FloatArray) -> Any:
    import fcl  # noqa: PLC0415 - a second opinion, loaded when asked for

    return fcl.CollisionObject(_fcl_geometry(shape), fcl.Transform(pose[:3, :3], pose[:3, 3]))


def _fcl_geometry(shape: Shape) -> Any:
    import fcl  # noqa: PLC0415 - a second opinion, loaded when asked for

    match shape:
        case Sphere(radius):
            return fcl.Sphere(radius)
        case Capsule(radius, length):
            return fcl.Capsule(radius, length)
        case Cylinder(radius, length):
            return fcl.Cylinder(radius, length)
        case Box(size):
            return fcl.Box(*size)
        case Hull(vertices):
            faces, grown = hull_triangles(vertices)
            counted = np.column_stack([np.full(len(faces), 3), faces])
            return fcl.Convex(grown, len(faces), counted.ravel())
        case Mesh(vertices, faces):
            return bvh_model(vertices, faces)
    raise ModelError(f"a {type(shape).__name__} is no shape of posopt")
