"""From what an importer has read to a toolpath: the checks that all formats share."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path
from typing import Final, Protocol

import numpy as np

from solver.errors import InputError, Place
from solver.io.importers.naming import shown
from solver.io.importers.options import MAX_FEED, MAX_NOMINAL, ImportOptions
from solver.io.importers.orientation import (
    PointError,
    rotations_from_normals_and_travels,
    rotations_from_quaternions,
    rotations_from_wpr_degrees,
    unit_normals,
)
from solver.model.toolpath import Event, Frame, Pass, Role, Toolpath
from solver.transforms import FloatArray
from solver.units import DEG_PER_RAD, MM_PER_M

MAX_COORDINATE: Final = 100.0
"""Positions farther out along an axis are taken for a mistake of unit [m]."""

SAME_POINT: Final = 1e-6
"""Neighbouring points of a pass closer than this are one point [m]."""


class Part(Enum):
    """A part of a waypoint that errors can point at."""

    POSITION = "position"
    ORIENTATION = "orientation"
    TRAVEL = "travel"


class Form(Enum):
    """How the orientation of a waypoint is given, and how many numbers that takes."""

    STATED = 0
    """Not in the file: the orientation that the import states."""

    NORMAL = 3
    """Outward normal alone; the travel direction comes from the neighbouring points."""

    QUATERNION = 4
    """w, x, y, z."""

    NORMAL_TRAVEL = 6
    """Outward normal, then travel direction."""

    WPR = -3
    """FANUC's W, P, R [deg]."""

    MATRIX = 9
    """A rotation, row by row, already checked."""


class Places(Protocol):
    """Knows where the parts of one waypoint stand in their file."""

    def place(self, part: Part) -> Place:
        """Return the place of a part."""


@dataclass(slots=True)
class PointRecord:
    """A waypoint as read: position [m], and the numbers of its orientation's form."""

    places: Places
    position: tuple[float, ...]
    form: Form
    orientation: tuple[float, ...] = ()
    role: Role = Role.CONTACT
    events: tuple[Event, ...] = ()


@dataclass(slots=True)
class PassRecord:
    """A pass as read: feed in [m/s], nominal lean and lead in [rad]."""

    place: Place
    name: str
    feed: float
    touches: str
    lean: float
    lead: float
    points: list[PointRecord] = field(default_factory=list)


def check_feed(feed: float) -> None:
    """Raise ValueError for a feed [m/s] that is not positive or absurd."""
    if not 0.0 < feed <= MAX_FEED:
        raise ValueError(f"is {feed * MM_PER_M:g} mm/s, expected above 0 and up to 10000 mm/s")


def check_nominal(angle: float) -> None:
    """Raise ValueError for a nominal lean or lead [rad] beyond a right angle."""
    if not abs(angle) <= MAX_NOMINAL:
        raise ValueError(f"is {angle * DEG_PER_RAD:g} deg, expected -90 to 90 deg")


def check_row_limit(count: int, place: Place, options: ImportOptions) -> None:
    """Refuse the waypoint number `count` when it is beyond the limit."""
    if count > options.row_limit:
        raise InputError(
            f"there are more than {options.row_limit:,} waypoints, expected at most that many",
            place,
        )


def agreed_frame(stated: Frame | None, place: Place, options: ImportOptions) -> Frame:
    """Return the frame that the file (at `place`) and the options agree on."""
    if stated is None and options.frame is None:
        raise InputError(
            "the frame of the poses is not stated, expected beam, floor or fanuc_world "
            "in the file or with the import",
            Place(place.file),
        )
    if stated is None or options.frame is None or stated is options.frame:
        return stated or options.frame or Frame.BEAM
    raise InputError(
        f"the file states the frame {stated.value}, but the import expected {options.frame.value}",
        place,
    )


def agreed_unit(stated: str | None, place: Place, options: ImportOptions) -> str:
    """Return the length unit that the file (at `place`) and the options agree on, else mm."""
    if stated is None or options.unit is None or stated == options.unit:
        return stated or options.unit or "mm"
    raise InputError(
        f"the file states the unit {stated}, but the import expected {options.unit}", place
    )


def assemble(
    passes: Iterable[PassRecord], frame: Frame, file: str, options: ImportOptions
) -> Toolpath:
    """Build the toolpath after the checks that concern whole points and passes.

    Raises
    ------
    InputError
        For too few points, a point out of range or repeated, a pass name that reappears, or an
        orientation that cannot be found; it names the place of the point.
    """
    records = list(passes)
    _check_names(records)
    total = sum(len(one.points) for one in records)
    if total < 2:
        place = records[-1].place if records else Place(file)
        count = "1 point" if total else "no point"
        raise InputError(f"the path has {count}, expected two or more", place)
    return Toolpath(
        tuple(_finished(one, options) for one in records), frame, source=Path(file).name
    )


def _check_names(records: list[PassRecord]) -> None:
    seen: set[str] = set()
    for one in records:
        if one.name in seen:
            raise InputError(
                f"pass {shown(one.name)} appears again, expected the points of a pass to follow "
                f"one another and every pass to have its own name",
                one.place,
            )
        seen.add(one.name)


def _finished(record: PassRecord, options: ImportOptions) -> Pass:
    points = record.points
    if not points:
        raise InputError(f"pass {shown(record.name)} has no waypoints, expected some", record.place)
    positions = np.array([point.position for point in points])
    _check_positions(points, positions)
    poses = np.zeros((len(points), 4, 4))
    poses[:, :3, :3] = _rotations(points, positions, options)
    poses[:, :3, 3] = positions
    poses[:, 3, 3] = 1.0
    return Pass(
        poses=poses + 0.0,
        roles=tuple(point.role for point in points),
        feed=record.feed,
        events={index: point.events for index, point in enumerate(points) if point.events},
        lean=record.lean,
        lead=record.lead,
        touches=record.touches,
        name=record.name,
    )


def _check_positions(points: list[PointRecord], positions: FloatArray) -> None:
    farthest = np.abs(positions).max(axis=1)
    for index in np.flatnonzero(~(farthest <= MAX_COORDINATE)):
        raise InputError(
            f"the point has a coordinate of {farthest[index]:g} m, expected 100 m or less "
            f"(is the unit right?)",
            points[index].places.place(Part.POSITION),
        )
    gaps = np.linalg.norm(np.diff(positions, axis=0), axis=1)
    for index in np.flatnonzero(gaps < SAME_POINT):
        raise InputError(
            f"the point repeats the one before it (they are {gaps[index]:.3g} m apart), "
            f"expected 1e-06 m or more",
            points[index + 1].places.place(Part.POSITION),
        )


def _rotations(
    points: list[PointRecord], positions: FloatArray, options: ImportOptions
) -> FloatArray:
    """Rotations (n, 3, 3) of the points of a pass, form by form."""
    forms = np.array([point.form.value for point in points])
    rotations = np.empty((len(points), 3, 3))
    for form in Form:
        chosen = np.flatnonzero(forms == form.value)
        if not len(chosen):
            continue
        values = np.array([points[index].orientation for index in chosen])
        try:
            rotations[chosen] = _of_form(form, values, positions, chosen, options)
        except _PartError as fault:
            place = points[chosen[fault.index]].places.place(fault.part)
            raise InputError(str(fault), place) from fault
    return rotations


def _of_form(
    form: Form,
    values: FloatArray,
    positions: FloatArray,
    chosen: np.ndarray,
    options: ImportOptions,
) -> FloatArray:
    part = Part.ORIENTATION
    try:
        if form is Form.QUATERNION:
            return rotations_from_quaternions(values)
        if form is Form.WPR:
            return rotations_from_wpr_degrees(values)
        if form is Form.MATRIX:
            return values.reshape(-1, 3, 3)
        if form is Form.STATED:
            return _stated(len(chosen), options)
        normals = unit_normals(values[:, :3])
        part = Part.TRAVEL
        travels = values[:, 3:] if form is Form.NORMAL_TRAVEL else _travels(positions)[chosen]
        return rotations_from_normals_and_travels(normals, travels, options.convention)
    except PointError as fault:
        hint = " (travel taken from the neighbouring points)" if form is Form.NORMAL else ""
        hint = hint if part is Part.TRAVEL else ""
        raise _PartError(fault.index, part, f"{fault}{hint}") from fault


class _PartError(PointError):
    """A fault with the part of the waypoint that it lies in."""

    def __init__(self, index: int, part: Part, message: str) -> None:
        self.part = part
        super().__init__(index, message)


def _stated(count: int, options: ImportOptions) -> FloatArray:
    if options.orientation is None:
        raise PointError(
            0,
            "the point has no orientation, expected a quaternion, W P R or a normal in the "
            "file, or an orientation stated with the import",
        )
    return np.tile(options.orientation, (count, 1, 1))


def _travels(positions: FloatArray) -> FloatArray:
    """Travel directions (n, 3): from each point's previous to its next, one-sided at the ends."""
    padded = np.concatenate([positions[:1], positions, positions[-1:]])
    travels: FloatArray = padded[2:] - padded[:-2]
    return travels
