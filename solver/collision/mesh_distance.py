"""Clearance between moving convex bodies and triangle meshes.

python-fcl's distance between *primitives* over-states the gap (see :mod:`fcl_checks`), its
distance between triangle models does not: over thousands of separated pairs it equals the
minimum over all pairs of triangles to 1e-13 m. So the convex body becomes a polyhedron that
contains it (:class:`ConvexProxy`), and the distance found is at most the true one and less by
at most the proxy's excess. Triangle models are surfaces: whether one lies inside the other is
decided apart.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Final, NamedTuple

import numpy as np

from solver.collision.mesh_proxy import ConvexProxy, bvh_model
from solver.collision.mesh_topology import (
    Bodies,
    TriangleField,
    closed_mesh,
    is_inside,
    triangle_field,
)
from solver.errors import ModelError
from solver.model.shapes import Mesh
from solver.transforms import FloatArray, frozen

CLEAR: Final = 1e-9
"""Way [m] beyond the depth at which two bodies count as parted."""


class MeshClearance(NamedTuple):
    """Signed `distance` [m] and the nearest points (3,), in the frame of the poses.

    Never over-stated; while positive, under-stated by at most the proxy's excess. Zero or
    negative means overlap; its size is then an estimate of the depth: for a sphere or capsule
    whose centre line is outside, how far the mesh reaches into it; else the length of some
    translation that parts the two.
    """

    distance: float
    point_on_body: FloatArray
    point_on_mesh: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class MeshObstacle:
    """A solid mesh at a `pose` (4, 4) parent_from_mesh, with its search structures.

    `low`, `high` (3,) bound it, `samples` (n, 3) holds one vertex of every separate body,
    `least_span` is the diagonal of the smallest body's box, and `surface` its triangles, all in
    the mesh frame [m]. `model` is fcl's.

    Raises
    ------
    InputError
        The mesh is no solid (see :func:`solver.collision.mesh_topology.closed_mesh`).
    """

    mesh: Mesh
    pose: FloatArray
    low: FloatArray = field(init=False, repr=False)
    high: FloatArray = field(init=False, repr=False)
    samples: FloatArray = field(init=False, repr=False)
    least_span: float = field(init=False, repr=False)
    surface: TriangleField = field(init=False, repr=False)
    model: Any = field(init=False, repr=False)

    def __post_init__(self) -> None:
        solid, bodies = closed_mesh(self.mesh.vertices, self.mesh.faces)
        _, first_face = np.unique(bodies.label, return_index=True)
        settle = object.__setattr__
        settle(self, "mesh", solid)
        settle(self, "pose", _checked_pose(self.pose))
        settle(self, "low", frozen(solid.vertices.min(axis=0)))
        settle(self, "high", frozen(solid.vertices.max(axis=0)))
        settle(self, "samples", frozen(solid.vertices[solid.faces[first_face, 0]]))
        surface = triangle_field(solid.vertices[solid.faces])
        settle(self, "surface", surface)
        settle(self, "least_span", _least_span(surface, bodies))
        settle(self, "model", bvh_model(solid.vertices, solid.faces))

    def contains(self, point: FloatArray) -> bool:
        """Whether the solid holds a point (3,) of the mesh frame that is not on its surface."""
        if (point < self.low).any() or (point > self.high).any():
            return False
        return is_inside(point, self.surface)


def mesh_clearance(
    proxy: ConvexProxy, proxy_pose: FloatArray, obstacle: MeshObstacle
) -> MeshClearance:
    """Signed distance of a convex body from a mesh.

    Parameters
    ----------
    proxy : ConvexProxy
        The body.
    proxy_pose : (4, 4) array
        Its pose in the frame of the obstacle's pose [m].
    obstacle : MeshObstacle
        The mesh.

    Returns
    -------
    MeshClearance
        With both points in the same frame.
    """
    gap, on_core, on_mesh = _surface_gap(proxy.model, proxy_pose, obstacle)
    if gap > 0.0 and not _nested(proxy, proxy_pose, obstacle):
        toward = (on_mesh - on_core) / gap
        return MeshClearance(gap - proxy.radius, on_core + proxy.radius * toward, on_mesh)
    return _overlap(proxy, proxy_pose, obstacle)


def _nested(proxy: ConvexProxy, pose: FloatArray, obstacle: MeshObstacle) -> bool:
    """Whether one lies inside the other, given that their surfaces do not meet."""
    centre = _moved(pose, proxy.centre)
    if obstacle.contains(_moved_back(obstacle.pose, centre)):
        return True
    if proxy.span < obstacle.least_span:
        return False
    return proxy.contains(_moved_back(pose, _moved(obstacle.pose, obstacle.samples)))


def _overlap(proxy: ConvexProxy, pose: FloatArray, obstacle: MeshObstacle) -> MeshClearance:
    """Depth as the length of a translation that parts the two, so never under-estimated.

    The way out is square to the surface where it is nearest to the body's centre; where that
    does not free the body (a groove, a corner) it is the shortest way out of the mesh's box.
    """
    centre = _moved(pose, proxy.centre)
    _, _, on_mesh = _surface_gap(proxy.centre_model, pose, obstacle)
    inside = obstacle.contains(_moved_back(obstacle.pose, centre))
    outward = (on_mesh - centre) if inside else (centre - on_mesh)
    length = float(np.linalg.norm(outward))
    outward = outward / length if length > 0.0 else obstacle.pose[:3, 2]
    corners = _moved(pose, proxy.vertices)
    depths = (on_mesh - corners) @ outward + proxy.radius
    deepest = int(np.argmax(depths))
    depth = max(0.0, float(depths[deepest]))
    freed = pose.copy()
    freed[:3, 3] += (depth + CLEAR) * outward
    gap, _, _ = _surface_gap(proxy.model, freed, obstacle)
    if gap < proxy.radius or gap <= 0.0 or _nested(proxy, freed, obstacle):
        middle, reach = _boxes(proxy, pose, obstacle)
        exits = np.concatenate([obstacle.high - middle + reach, middle + reach - obstacle.low])
        depth = max(depth, float(exits.min()))
    return MeshClearance(-depth, corners[deepest] - proxy.radius * outward, on_mesh)


def lower_bounds(proxy: ConvexProxy, poses: FloatArray, obstacle: MeshObstacle) -> FloatArray:
    """Return certified lower bounds of the clearance from bounding boxes alone.

    Parameters
    ----------
    proxy : ConvexProxy
        The body.
    poses : (..., 4, 4) array
        Its poses in the frame of the obstacle's pose [m].
    obstacle : MeshObstacle
        The mesh.

    Returns
    -------
    (...) array
        Distances of the boxes [m]; minus infinity where they meet, since nothing is known.
    """
    centre, reach = _boxes(proxy, poses, obstacle)
    apart = np.abs(centre - 0.5 * (obstacle.low + obstacle.high))
    apart = apart - reach - 0.5 * (obstacle.high - obstacle.low)
    bounds = np.sqrt((np.maximum(apart, 0.0) ** 2).sum(axis=-1))
    return np.where(bounds > 0.0, bounds, -math.inf)


def _boxes(
    proxy: ConvexProxy, poses: FloatArray, obstacle: MeshObstacle
) -> tuple[FloatArray, FloatArray]:
    """Centres and half extents (..., 3) [m] of the body's boxes along the mesh's axes."""
    turn = obstacle.pose[:3, :3].T @ poses[..., :3, :3]
    shift = (poses[..., :3, 3] - obstacle.pose[:3, 3]) @ obstacle.pose[:3, :3]
    centre = turn @ (0.5 * (proxy.high + proxy.low)) + shift
    return centre, np.abs(turn) @ (0.5 * (proxy.high - proxy.low))


def clearances(
    proxy: ConvexProxy, poses: FloatArray, obstacle: MeshObstacle, cutoff: float = math.inf
) -> FloatArray:
    """Signed distances (k,) [m] of a body at many poses (k, 4, 4).

    Where boxes alone show more than `cutoff` [m] the entry is that lower bound: still never
    over-stated, and above the cutoff.
    """
    found = lower_bounds(proxy, poses, obstacle)
    for row in np.flatnonzero(found <= cutoff):
        found[row] = mesh_clearance(proxy, poses[row], obstacle).distance
    return found


def _surface_gap(
    model: Any, pose: FloatArray, obstacle: MeshObstacle
) -> tuple[float, FloatArray, FloatArray]:
    """Distance [m] of a triangle model's surface from the obstacle's, and the nearest points."""
    import fcl  # noqa: PLC0415 - loaded with the first mesh, not with the solver

    request = fcl.DistanceRequest(enable_nearest_points=True)
    result = fcl.DistanceResult()
    moving = fcl.CollisionObject(model, fcl.Transform(pose[:3, :3], pose[:3, 3]))
    fixed = fcl.CollisionObject(
        obstacle.model, fcl.Transform(obstacle.pose[:3, :3], obstacle.pose[:3, 3])
    )
    gap = float(fcl.distance(moving, fixed, request, result))
    if not math.isfinite(gap):
        raise ModelError("the distance of a body from a mesh could not be computed")
    on_body, on_mesh = (np.array(point, dtype=np.float64) for point in result.nearest_points)
    return gap, on_body, on_mesh


def _least_span(surface: TriangleField, bodies: Bodies) -> float:
    """Diagonal [m] of the smallest box around one of the separate bodies."""
    low = np.full((len(bodies.volume), 3), math.inf)
    high = -low
    np.minimum.at(low, bodies.label, surface.low)
    np.maximum.at(high, bodies.label, surface.high)
    return float(np.linalg.norm(high - low, axis=1).min())


def _moved(target_from_source: FloatArray, points: FloatArray) -> FloatArray:
    return points @ target_from_source[:3, :3].T + target_from_source[:3, 3]


def _moved_back(target_from_source: FloatArray, points: FloatArray) -> FloatArray:
    return (points - target_from_source[:3, 3]) @ target_from_source[:3, :3]


def _checked_pose(pose: FloatArray) -> FloatArray:
    pose = frozen(pose, (4, 4))
    rotation = pose[:3, :3]
    if not (np.isfinite(pose).all() and np.abs(rotation @ rotation.T - np.eye(3)).max() < 1e-6):
        raise ModelError("the pose of a mesh is no finite rotation and translation")
    return pose
