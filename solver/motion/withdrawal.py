"""Which way the tool leaves the face: along its own axis, or along the face's normal."""

from __future__ import annotations

import numpy as np

from solver.collision.convex_hull import hull_triangles
from solver.collision.distance import distance
from solver.errors import RefusedError
from solver.model.problem import PlanningProblem
from solver.model.program_settings import Withdrawal
from solver.model.shapes import Box, Hull, Sphere
from solver.model.toolpath import Pass
from solver.transforms import FloatArray, inverse, rigid

POINT = 1e-9
"""Radius of the ball that stands for a point [m]."""

FACING = 1e-6
"""Least cosine between a face's normal and the way back along the tool."""


def withdrawal_direction(
    problem: PlanningProblem, one: Pass, rule: Withdrawal, pose: FloatArray
) -> FloatArray:
    """Unit vector along which the tool is withdrawn from a contact pose.

    Parameters
    ----------
    problem : PlanningProblem
        Whose workpiece has the face.
    one : Pass
        The pass; it names the group of bodies that it touches.
    rule : Withdrawal
        Along the tool's -z, or along the outward normal of the nearest face of that group.
    pose : (4, 4) array
        fanuc_world_from_tcp of the contact [m].

    Returns
    -------
    (3,) array
        In fanuc_world.

    Raises
    ------
    RefusedError
        The group has no flat face that the tool looks at.
    """
    back: FloatArray = -pose[:3, 2]
    if rule is Withdrawal.TOOL:
        return back
    advice = 'set withdrawal = "tool"'
    if not one.touches:
        raise RefusedError(
            f"pass {one.name!r} names no body that it touches, so there is no normal to withdraw "
            f"along; {advice} or name the body"
        )
    world_from_piece = problem.fanuc_world_from_floor @ problem.workpiece.placement
    best, normal = np.inf, None
    for body in problem.workpiece.bodies:
        if body.group != one.touches:
            continue
        if not isinstance(body.shape, Box | Hull):
            raise RefusedError(
                f"workpiece body {body.name!r} ({type(body.shape).__name__.lower()}) has no flat "
                f"face whose normal the tool could be withdrawn along; {advice}"
            )
        world_from_body = world_from_piece @ body.pose
        point = rigid(position=pose[:3, 3])
        gap = distance(Sphere(POINT), point, body.shape, world_from_body).distance
        outward = _nearest_face(body.shape, world_from_body, pose[:3, 3], back)
        if outward is not None and gap < best:
            best, normal = gap, outward
    if normal is None:
        raise RefusedError(f"no face of {one.touches!r} looks at the tool; {advice}")
    return normal


def _nearest_face(
    shape: Box | Hull, world_from_body: FloatArray, point: FloatArray, back: FloatArray
) -> FloatArray | None:
    """Outward normal, in the world, of the face nearest to a point.

    Of a convex body the face nearest to a point in front of it is the one whose plane the point
    is farthest beyond; inside the body it is the one whose plane is least far away. Faces that
    the tool does not look at are left out: a ball that enters a thin web by its contact depth
    must not come out behind it.
    """
    local = inverse(world_from_body) @ np.append(point, 1.0)
    normals, offsets = _planes(shape)
    outward: FloatArray = normals @ world_from_body[:3, :3].T
    beyond = normals @ local[:3] - offsets
    facing = outward @ back > FACING
    if not facing.any():
        return None
    face: FloatArray = outward[int(np.argmax(np.where(facing, beyond, -np.inf)))]
    return face


def _planes(shape: Box | Hull) -> tuple[FloatArray, FloatArray]:
    """Outward normals (k, 3) and offsets (k,) [m] of a shape's faces, in its own frame."""
    if isinstance(shape, Box):
        half = shape.size / 2.0
        return np.vstack([np.eye(3), -np.eye(3)]), np.concatenate([half, half])
    triangles, vertices = hull_triangles(shape.vertices)
    corners = vertices[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    return normals, np.einsum("ij,ij->i", normals, corners[:, 0])
