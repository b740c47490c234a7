"""Shapes and bodies: what collision checking sees of robots, tools, workpieces and fixtures."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

import numpy as np

from solver.errors import ModelError
from solver.transforms import FloatArray, IntArray, frozen


def _positive(what: str, value: float) -> None:
    if not (math.isfinite(value) and value > 0.0):
        raise ModelError(f"{what} must be a positive length, got {value:g} m")


@dataclass(frozen=True, slots=True)
class Sphere:
    """A ball about the origin of its body frame, `radius` [m]."""

    radius: float

    def __post_init__(self) -> None:
        _positive("sphere radius", self.radius)


@dataclass(frozen=True, slots=True)
class Capsule:
    """All points within `radius` [m] of a segment of `length` [m] on z, centred on the origin."""

    radius: float
    length: float

    def __post_init__(self) -> None:
        _positive("capsule radius", self.radius)
        _positive("capsule length", self.length)


@dataclass(frozen=True, slots=True)
class Cylinder:
    """A cylinder with flat ends about z, `radius` and `length` [m], centred on the origin."""

    radius: float
    length: float

    def __post_init__(self) -> None:
        _positive("cylinder radius", self.radius)
        _positive("cylinder length", self.length)


@dataclass(frozen=True, slots=True, eq=False)
class Box:
    """A box centred on the origin; `size` (3,) is its full extent along x, y, z [m]."""

    size: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "size", frozen(self.size, (3,)))
        for axis, value in zip("xyz", self.size, strict=True):
            _positive(f"box size {axis}", float(value))


@dataclass(frozen=True, slots=True, eq=False)
class Hull:
    """The convex hull of `vertices` (k, 3) [m], k >= 4 and not all in one plane."""

    vertices: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "vertices", frozen(self.vertices, (-1, 3)))
        spread = self.vertices - self.vertices.mean(axis=0)
        if len(self.vertices) < 4 or np.linalg.matrix_rank(spread, tol=1e-9) < 3:
            raise ModelError("a convex hull needs four or more vertices that span a volume")


@dataclass(frozen=True, slots=True, eq=False)
class Mesh:
    """A watertight triangle mesh: `vertices` (k, 3) [m] and `faces` (m, 3), outward winding."""

    vertices: FloatArray
    faces: IntArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "vertices", frozen(self.vertices, (-1, 3)))
        faces = np.array(self.faces, dtype=np.int64)
        faces.setflags(write=False)
        object.__setattr__(self, "faces", faces)


ConvexShape = Sphere | Capsule | Cylinder | Box | Hull
Shape = ConvexShape | Mesh


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """A named shape; `pose` is parent_from_body (4, 4), the parent being stated by the owner.

    Several bodies may share a `group` (the slices of one fillet, the boxes of a forked
    forearm); people read and name groups.
    """

    name: str
    shape: Shape
    pose: FloatArray
    group: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "pose", frozen(self.pose, (4, 4)))
        if not self.group:
            object.__setattr__(self, "group", self.name)


class ToolRole(Enum):
    """How a body of the tool is checked."""

    CLEARANCE = "clearance"
    """Counts in the clearance d of a pose."""

    NEAR = "near"
    """Checked against everything with a margin of its own, but not part of d."""

    CONTACT = "contact"
    """May enter the workpiece body that its pass names, to a stated depth."""
