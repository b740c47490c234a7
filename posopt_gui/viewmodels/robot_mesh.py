"""The robot's links as closed surfaces, lofted from the outlines of a silhouette file.

A silhouette file states, for stations along the long axis of each link, how far the
cross-section reaches in 16 directions. The polygons that these half-planes bound are joined
from station to station. The surfaces are for looks only and never decide on clearance.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from posopt_gui.viewmodels.body_mesh import body_surface, closed_rings
from posopt_gui.viewmodels.surface_mesh import (
    Colour,
    ShadedMesh,
    Surface,
    coloured,
    merged,
    moved,
    outward,
    shaded,
)
from solver.catalog.names import resource_folder
from solver.errors import InputError, Place
from solver.model.robot import JOINTS, Robot
from solver.model.shapes import Cylinder
from solver.transforms import FloatArray, inverse, rigid, rotation_x, rotation_y
from solver.units import MM

DIRECTIONS = 16
YELLOW: Colour = (247, 198, 0, 255)
DARK: Colour = (62, 66, 71, 255)
BLACK: Colour = (58, 62, 67, 255)
GREY: Colour = (120, 127, 134, 255)

LINK_COLOURS: Mapping[int, Colour] = {0: BLACK, 5: GREY, 6: DARK}
"""Links that are not yellow."""

DARK_BELOW: Mapping[int, float] = {1: -0.19, 3: -0.05}
"""Stations [m] below which a yellow link is dark: the turret's ring and the rear motors."""


@dataclass(frozen=True, slots=True, eq=False)
class Outline:
    """Cross-sections of a link in its link frame.

    Attributes
    ----------
    link : int
        0 is the base, 6 the flange.
    axis : int
        The long axis: 0 for x, 1 for y, 2 for z.
    stations : (k,) array
        Ascending places along it [m].
    reach : (k, 16) array
        Farthest reach in the directions 0, 22.5, ... deg [m], from the first to the second of
        the two other axes.
    """

    link: int
    axis: int
    stations: FloatArray
    reach: FloatArray


def silhouette_file(robot: Robot) -> Path:
    """Where the silhouette of a robot is, if there is one."""
    return resource_folder() / "robots" / f"{robot.name}_silhouette.csv"


def read_outlines(file: Path) -> tuple[Outline, ...]:
    """Read a silhouette file [mm], links ascending.

    Raises
    ------
    InputError
        The file cannot be read, or a line of it; the sentence names the line.
    """
    try:
        lines = file.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeError) as error:
        raise InputError(f"the silhouette cannot be read ({error})", Place(str(file))) from error
    rows: dict[tuple[int, int], list[list[float]]] = {}
    numbered = [(i, x) for i, x in enumerate(lines, start=1) if x and not x.startswith("#")]
    for number, line in numbered[1:]:
        cells = next(csv.reader([line]))
        try:
            name, axis, values = cells[0], "xyz".index(cells[1]), [float(x) for x in cells[2:]]
            link = 0 if name == "base_link" else int(name.removeprefix("link_"))
        except (ValueError, IndexError) as error:
            raise InputError(
                "expected a link, an axis and numbers", Place(str(file), number)
            ) from error
        sound = len(values) == DIRECTIONS + 1 and np.isfinite(values).all()
        if not sound or not 0 <= link <= JOINTS:
            raise InputError(
                f"expected a link from 0 to {JOINTS}, a station and {DIRECTIONS} finite reaches",
                Place(str(file), number),
            )
        rows.setdefault((link, axis), []).append(values)
    return tuple(_outline(link, axis, values) for (link, axis), values in sorted(rows.items()))


def _outline(link: int, axis: int, rows: list[list[float]]) -> Outline:
    table = np.array(sorted(rows)) * MM
    return Outline(link, axis, table[:, 0], table[:, 1:])


def section_polygon(reach: FloatArray) -> FloatArray:
    """(16, 2) corners, counter-clockwise, of the polygon with the reaches (16,) [m].

    Corner i lies between directions i and i + 1; corners coincide where a direction touches the
    polygon in a corner only.
    """
    step = 2.0 * math.pi / DIRECTIONS
    tight = reach.copy()
    # Rounding can leave a half-plane just outside the corner of its neighbours.
    for _ in range(DIRECTIONS):
        tight = np.minimum(tight, (np.roll(tight, 1) + np.roll(tight, -1)) / 2.0 / math.cos(step))
    angle = np.arange(DIRECTIONS) * step
    normal = np.column_stack([np.cos(angle), np.sin(angle)])
    tangent = np.column_stack([-np.sin(angle), np.cos(angle)])
    along = (np.roll(tight, -1) - tight * math.cos(step)) / math.sin(step)
    corners: FloatArray = tight[:, None] * normal + along[:, None] * tangent
    return corners


def lofted(outline: Outline) -> Surface:
    """The closed surface through all cross-sections, with flat caps, in the link frame."""
    others = [axis for axis in range(3) if axis != outline.axis]
    rings = np.empty((len(outline.stations), DIRECTIONS, 3))
    for station, ring, reach in zip(outline.stations, rings, outline.reach, strict=True):
        ring[:, outline.axis] = station
        ring[:, others] = section_polygon(reach)
    poles = rings[[0, -1]].mean(axis=1)
    vertices = np.concatenate([rings.reshape(-1, 3), poles])
    faces = outward(vertices, closed_rings(len(rings), DIRECTIONS))
    surface = coloured(vertices, faces, LINK_COLOURS.get(outline.link, YELLOW))
    if outline.link in DARK_BELOW:
        # The lower end of each face is the same for both halves of a quadrilateral.
        lower = vertices[faces][:, :, outline.axis].min(axis=1)
        surface.colours[lower < DARK_BELOW[outline.link]] = DARK
    return surface


def _disc(centre: tuple[float, float, float], axis: str, radius: float, length: float) -> Surface:
    """A round cover [m] about the axis x, y or z."""
    turn = {"x": rotation_y(math.pi / 2), "y": rotation_x(math.pi / 2), "z": np.eye(3)}[axis]
    return moved(body_surface(Cylinder(radius, length), DARK), rigid(turn, centre))


def _covers(link: int) -> list[Surface]:
    """Dark covers of the joints' axes, which let the eye see where a link turns."""
    places: Mapping[int, list[tuple[tuple[float, float, float], str, float, float]]] = {
        1: [((0.150, 0.2445, 0.0), "y", 0.078, 0.030)],
        2: [
            ((0.0, -0.2310, 0.0), "y", 0.072, 0.030),
            ((0.0, -0.2150, 0.790), "y", 0.060, 0.030),
        ],
        4: [((0.835, -0.1150, 0.0), "y", 0.046, 0.016)],
    }
    return [_disc(*place) for place in places.get(link, [])]


def _outline_origin(robot: Robot, link: int) -> FloatArray:
    """(3,) origin of an outline's frame in the link frame: of the sixth it is the flange's face."""
    if link != JOINTS:
        return np.zeros(3)
    from solver.kinematics.arm import link_offsets  # noqa: PLC0415 - numba

    offset = link_offsets(robot)[JOINTS]
    origin: FloatArray = (inverse(offset) @ robot.flange)[:3, 3]
    return origin


def link_meshes(robot: Robot, bodies: str) -> Mapping[int, ShadedMesh]:
    """Meshes of the links in their link frames; the bodies themselves where no silhouette is.

    Parameters
    ----------
    robot : Robot
        The robot.
    bodies : str
        Name of the body set to draw for a robot without a silhouette.
    """
    file = silhouette_file(robot)
    parts: dict[int, list[Surface]] = {}
    if file.is_file():
        for outline in read_outlines(file):
            surface = moved(lofted(outline), rigid(position=_outline_origin(robot, outline.link)))
            parts[outline.link] = [surface, *_covers(outline.link)]
    else:
        for one in robot.body_sets[bodies]:
            colour = LINK_COLOURS.get(one.link, YELLOW)
            surface = moved(body_surface(one.body.shape, colour), one.body.pose)
            parts.setdefault(one.link, []).append(surface)
    return {link: shaded(merged(surfaces)) for link, surfaces in parts.items()}
