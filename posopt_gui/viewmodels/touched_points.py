"""Placement of a beam from three points that were touched with the tool's tip."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from solver.errors import InputError
from solver.model.workpiece import BeamSection
from solver.transforms import FloatArray, rigid
from solver.units import MM, MM_PER_M

LEAST_DISTANCE: Final = 20.0 * MM
"""Points closer than this determine no direction [m]."""

OVERHANG: Final = 5.0 * MM
"""How far a touched point may lie outside the beam before it is taken for a mistake [m]."""

ENDS: Final = ("-x", "+x")
FLANGES: Final = ("top", "bottom")
SIDES: Final = ("left", "right")


@dataclass(frozen=True, slots=True)
class TouchedCorner:
    """The corner of the beam that the first point is: of which end, flange and side.

    Left is +y, top is +z of the beam. The second point lies on the edge along the beam that
    begins there, the third on the outer face of that flange.
    """

    end: str = "-x"
    flange: str = "top"
    side: str = "left"

    @property
    def signs(self) -> FloatArray:
        """(3,) signs of the corner's coordinates."""
        return np.array(
            [
                1.0 if self.end == "+x" else -1.0,
                1.0 if self.side == "left" else -1.0,
                1.0 if self.flange == "top" else -1.0,
            ]
        )


def placement_from_points(
    points: ArrayLike, corner: TouchedCorner, section: BeamSection, length: float
) -> FloatArray:
    """(4, 4) placement of the beam in the frame of three touched points.

    Parameters
    ----------
    points : (3, 3) array
        Rows: the corner, a point on its edge along the beam, a point on the flange's outer
        face [m].
    corner : TouchedCorner
        Which corner was touched.
    section, length
        Of the beam [m].

    Raises
    ------
    InputError
        If the points determine no placement, or cannot lie on this beam.
    """
    first, second, third = np.asarray(points, dtype=np.float64).reshape(3, 3)
    if not np.isfinite([first, second, third]).all():
        raise InputError("a coordinate is not finite, expected three points in mm")
    along = second - first
    distance = float(np.linalg.norm(along))
    if distance < LEAST_DISTANCE:
        raise InputError(
            f"the second point lies {distance * MM_PER_M:.1f} mm from the first, expected "
            f"{LEAST_DISTANCE * MM_PER_M:g} mm or more along the beam"
        )
    along = along / distance
    across = third - first
    across = across - (across @ along) * along
    breadth = float(np.linalg.norm(across))
    if breadth < LEAST_DISTANCE:
        raise InputError(
            f"the third point lies {breadth * MM_PER_M:.1f} mm beside the line of the other two, "
            f"expected {LEAST_DISTANCE * MM_PER_M:g} mm or more across the flange"
        )
    _check_on_beam(distance, breadth, section, length)
    signs = corner.signs
    # From the corner both directions run into the beam, against the signs of its coordinates.
    x = -signs[0] * along
    y = -signs[1] * across / breadth
    rotation = np.column_stack([x, y, np.cross(x, y)])
    corner_in_beam = signs * np.array([length, section.width, section.height]) / 2.0
    return rigid(rotation, first - rotation @ corner_in_beam)


def _check_on_beam(distance: float, breadth: float, section: BeamSection, length: float) -> None:
    for name, found, extent, what in (
        ("second", distance, length, "long"),
        ("third", breadth, section.width, "wide"),
    ):
        if found > extent + OVERHANG:
            raise InputError(
                f"the {name} point lies {found * MM_PER_M:.1f} mm from the corner, but the beam "
                f"is only {extent * MM_PER_M:g} mm {what}"
            )


def points_on_beam(corner: TouchedCorner, section: BeamSection, length: float) -> FloatArray:
    """(3, 3) points in the beam frame that may be touched for a corner, for a sketch [m]."""
    half = np.array([length, section.width, section.height]) / 2.0
    first = corner.signs * half
    second = first * (-0.5, 1.0, 1.0)
    third = first * (0.45, -0.8, 1.0)
    return np.vstack([first, second, third])
