"""Convex bodies as triangles: polyhedra that contain the body and exceed it by a stated length.

A sphere is a point and a capsule a segment, each with a radius around it; the radius stays a
number and only the core becomes a (tiny) polyhedron. A cylinder becomes a prism around it, a
box and a hull are polyhedra already.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from solver.collision.convex_hull import hull_triangles
from solver.errors import ModelError
from solver.model.shapes import Box, Capsule, ConvexShape, Cylinder, Hull, Sphere
from solver.transforms import FloatArray, IntArray, frozen
from solver.units import MM, MM_PER_M

DEFAULT_TOLERANCE: Final = 0.2 * MM
TOLERANCES: Final = (1e-6, 10.0 * MM)
CORE: Final = 1e-7
"""Half the width [m] of the polyhedron that stands for a point or a segment."""


def bvh_model(vertices: FloatArray, faces: IntArray) -> Any:
    """Bounding-volume hierarchy of python-fcl over triangles."""
    import fcl  # noqa: PLC0415 - loaded with the first mesh, not with the solver

    model = fcl.BVHModel()
    model.beginModel(len(vertices), len(faces))
    model.addSubModel(vertices, faces)
    model.endModel()
    return model


@dataclass(frozen=True, slots=True, eq=False)
class ConvexProxy:
    """A polyhedron plus a radius that together contain a convex `shape`.

    The union of balls of `radius` [m] about the polyhedron contains the shape and exceeds it
    by at most `excess` <= `tolerance` [m]. `vertices` (k, 3), `faces` (m, 3), the planes
    `normals` (m, 3) and `offsets` (m,), and `centre` (3,) belong to the polyhedron in the body
    frame, `span` is the diagonal of its box; `low` and `high` (3,) bound polyhedron and radius.
    `model` is fcl's model of the polyhedron, `centre_model` that of the centre.
    """

    shape: ConvexShape
    tolerance: float = DEFAULT_TOLERANCE
    vertices: FloatArray = field(init=False)
    faces: IntArray = field(init=False, repr=False)
    normals: FloatArray = field(init=False, repr=False)
    offsets: FloatArray = field(init=False, repr=False)
    centre: FloatArray = field(init=False, repr=False)
    low: FloatArray = field(init=False, repr=False)
    high: FloatArray = field(init=False, repr=False)
    span: float = field(init=False, repr=False)
    radius: float = field(init=False)
    excess: float = field(init=False)
    model: Any = field(init=False, repr=False)
    centre_model: Any = field(init=False, repr=False)

    def __post_init__(self) -> None:
        if not TOLERANCES[0] <= self.tolerance <= TOLERANCES[1]:
            raise ModelError(
                f"the tolerance of a body against meshes must be {TOLERANCES[0] * MM_PER_M:g} "
                f"to {TOLERANCES[1] * MM_PER_M:g} mm, got {self.tolerance * MM_PER_M:g} mm"
            )
        vertices, faces, radius, excess = _polyhedron(self.shape, self.tolerance)
        if excess > self.tolerance:
            raise ModelError(
                f"the convex hull would grow by {excess * MM_PER_M:g} mm where at most "
                f"{self.tolerance * MM_PER_M:g} mm is allowed: its vertices are all but flat"
            )
        corners = vertices[faces]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        offsets = (vertices @ normals.T).max(axis=0)
        centre = vertices.mean(axis=0)
        settle = object.__setattr__
        settle(self, "vertices", frozen(vertices))
        settle(self, "faces", faces)
        settle(self, "normals", frozen(normals))
        settle(self, "offsets", frozen(offsets))
        settle(self, "centre", frozen(centre))
        settle(self, "low", frozen(vertices.min(axis=0) - radius))
        settle(self, "high", frozen(vertices.max(axis=0) + radius))
        settle(self, "span", float(np.linalg.norm(np.ptp(vertices, axis=0))))
        settle(self, "radius", radius)
        settle(self, "excess", excess)
        settle(self, "model", bvh_model(vertices, faces))
        point, point_faces = _tetrahedron()
        settle(self, "centre_model", bvh_model(point + centre, point_faces))

    def contains(self, points: FloatArray) -> bool:
        """Whether the polyhedron (without its radius) holds one of the points (k, 3)."""
        return bool(((points @ self.normals.T) < self.offsets).all(axis=1).any())


def _polyhedron(shape: ConvexShape, tolerance: float) -> tuple[FloatArray, IntArray, float, float]:
    """Vertices (k, 3) and faces (m, 3) of the containing polyhedron, radius and excess [m]."""
    match shape:
        case Sphere(radius):
            return *_tetrahedron(), radius, math.sqrt(3.0) * CORE
        case Capsule(radius, length):
            return *_prism(CORE, 3, 0.5 * length), radius, 2.0 * CORE
        case Cylinder(radius, length):
            sides = max(8, math.ceil(math.pi / math.acos(radius / (radius + tolerance))))
            excess = radius / math.cos(math.pi / sides) - radius
            return *_prism(radius, sides, 0.5 * length), 0.0, excess
        case Box(size):
            return *box_triangles(size), 0.0, 0.0
        case Hull(vertices):
            faces, grown = hull_triangles(vertices)
            return grown, faces, 0.0, float(np.linalg.norm(grown - vertices, axis=1).max())
    raise ModelError(f"a {type(shape).__name__.lower()} is no convex body")


def box_triangles(size: FloatArray) -> tuple[FloatArray, IntArray]:
    """Vertices (8, 3) and faces (12, 3) of a box about the origin, `size` (3,) [m]."""
    vertices, faces = _prism(1.0, 4, 1.0)
    return np.sign(vertices) * 0.5 * size, faces


def _tetrahedron() -> tuple[FloatArray, IntArray]:
    """Return the tetrahedron that stands for a point."""
    corners = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], dtype=np.float64)
    return CORE * corners, np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])


def _prism(apothem: float, sides: int, half: float) -> tuple[FloatArray, IntArray]:
    """Return a regular prism about z whose side faces touch a cylinder of radius `apothem`."""
    angle = math.pi * (2.0 * np.arange(sides) + 1.0) / sides
    corner = apothem / math.cos(math.pi / sides)
    ring = corner * np.column_stack([np.cos(angle), np.sin(angle)])
    vertices = np.vstack([np.column_stack([ring, np.full(sides, z)]) for z in (-half, half)])
    row = np.arange(sides)
    following = np.roll(row, -1)
    fan = np.column_stack([np.zeros(sides - 2, dtype=np.int64), row[1:-1], row[2:]])
    faces = [
        fan[:, ::-1],
        fan + sides,
        np.column_stack([row, following, following + sides]),
        np.column_stack([row, following + sides, row + sides]),
    ]
    return vertices, np.vstack(faces)
