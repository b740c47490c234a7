"""Cameras of the 3D panel: directions, fitting and picking, as plain arithmetic."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from solver.transforms import FloatArray

if TYPE_CHECKING:
    from posopt_gui.viewmodels.scene_model import CellModel

FIELD_OF_VIEW = 34.0
"""Horizontal angle that the camera sees [deg]."""

MARGIN = np.array([1.08, 1.06])
"""Room around what is fitted, across and upward."""

PICK_RADIUS = 14.0
"""How far from a point a click still means it [pixels]."""

PRESETS: Mapping[str, tuple[float, float]] = {
    "Overview": (-52.0, 24.0),
    "Front view": (0.0, 8.0),
    "Left view": (90.0, 8.0),
    "Right view": (-90.0, 8.0),
    "Top view": (-90.0, 89.9),
}
"""Azimuth and elevation [deg] of the camera, seen from the centre."""

CLOSE_UP = "Close-up"
"""The preset that looks at the tool from near; its direction depends on the pose."""

CLOSE_DISTANCE = 1.25
"""Distance of the close-up [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Camera:
    """Centre (3,) [m], distance [m], azimuth, elevation and horizontal field of view [deg]."""

    centre: FloatArray
    distance: float
    azimuth: float
    elevation: float
    field: float = FIELD_OF_VIEW

    @property
    def axes(self) -> FloatArray:
        """(3, 3) rows: to the right, up, and from the centre to the camera."""
        azimuth, elevation = math.radians(self.azimuth), math.radians(self.elevation)
        back = (
            math.cos(elevation) * math.cos(azimuth),
            math.cos(elevation) * math.sin(azimuth),
            math.sin(elevation),
        )
        right = (-math.sin(azimuth), math.cos(azimuth), 0.0)
        return np.array([right, np.cross(back, right), back])

    @property
    def position(self) -> FloatArray:
        """(3,) where the camera is."""
        place: FloatArray = self.centre + self.distance * self.axes[2]
        return place

    def same_as(self, other: Camera) -> bool:
        """Whether both see the same."""
        mine = (self.distance, self.azimuth, self.elevation, self.field)
        others = (other.distance, other.azimuth, other.elevation, other.field)
        return mine == others and bool(np.allclose(self.centre, other.centre, atol=1e-9))

    def ray(self, x: float, y: float, width: float, height: float) -> tuple[FloatArray, FloatArray]:
        """Origin and unit direction of the ray through a pixel of a picture of this size."""
        half = math.tan(math.radians(self.field) / 2.0)
        across = (2.0 * x / width - 1.0) * half
        upward = (1.0 - 2.0 * y / height) * half * height / width
        right, up, back = self.axes
        direction = across * right + upward * up - back
        return self.position, direction / np.linalg.norm(direction)


def fitted(
    points: FloatArray,
    azimuth: float,
    elevation: float,
    aspect: float,
    field: float,
    above: float = 0.0,
) -> Camera:
    """The nearest camera in a direction that sees all points (k, 3).

    `aspect` is width over height; the share `above` of the height stays free at the top, for the
    bar that lies over the picture.
    """
    camera = Camera(np.zeros(3), 1.0, azimuth, elevation, field)
    # One row for each axis: reducing long rows is several times as fast as reducing columns.
    local = np.ascontiguousarray((points @ camera.axes.T).T)
    half = math.tan(math.radians(field) / 2.0)
    middle = (local.min(axis=1) + local.max(axis=1)) / 2.0
    upward = half / aspect * (1.0 - above)
    for _ in range(8):
        rest = local - middle[:, None]
        needed = [
            np.abs(rest[0]) * MARGIN[0] / half + rest[2],
            np.abs(rest[1]) * MARGIN[1] / upward + rest[2],
        ]
        distance = float(np.max(needed))
        # Nearer points look larger: move the centre until left and right, top and bottom agree.
        seen = rest[:2] / (distance - rest[2])
        middle[:2] += (seen.min(axis=1) + seen.max(axis=1)) / 2.0 * distance
    middle[1] += above * half / aspect * distance
    return Camera(middle @ camera.axes, max(distance, 0.05), azimuth, elevation, field)


def close_up(tcp: FloatArray, along: FloatArray, field: float) -> Camera:
    """A camera near the TCP (4, 4), beside the tool and looking along `along` (3,)."""
    back = along / max(float(np.linalg.norm(along)), 1e-12)
    # From where the path comes or from where it goes: whichever looks at the robot's front.
    if back @ tcp[:3, 3] < 0.0:
        back = -back
    direction = back - 0.42 * tcp[:3, 2] + (0.0, 0.0, 0.12)
    direction /= np.linalg.norm(direction)
    azimuth = math.degrees(math.atan2(direction[1], direction[0]))
    elevation = math.degrees(math.asin(direction[2]))
    centre = tcp[:3, 3] - 0.10 * tcp[:3, 2]
    return Camera(centre, CLOSE_DISTANCE, azimuth, elevation, field)


def close_up_of(cell: CellModel, joints: FloatArray, *, planned: bool) -> Camera:
    """The close-up of a pose (6,) [rad]; without a plan of where the path has its middle."""
    from solver.kinematics.arm import forward  # noqa: PLC0415 - loads the kernels

    tcp = forward(cell.problem.robot, joints, cell.problem.tool.tcp)
    points = cell.path.points
    if not planned:
        tcp[:3, 3] = points[len(points) // 2]
    return close_up(tcp, points[-1] - points[0], FIELD_OF_VIEW)


def picked(
    points: FloatArray, origin: FloatArray, direction: FloatArray, pixel: float
) -> int | None:
    """The point (of (k, 3)) nearest to a ray, None where all are further than a click reaches.

    `pixel` is the angle of a pixel [rad].
    """
    if len(points) == 0:
        return None
    away = points - origin
    along = away @ direction
    off = np.linalg.norm(away - along[:, None] * direction, axis=1)
    angle = np.where(along > 0.0, np.arctan2(off, np.maximum(along, 1e-12)), np.inf)
    best = int(np.argmin(angle))
    return best if angle[best] <= PICK_RADIUS * pixel else None
