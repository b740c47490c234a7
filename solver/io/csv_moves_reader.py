"""Reader of a CSV table of moves; it shares no code with the post that writes it."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from decimal import Decimal
from typing import Final

import numpy as np

from solver.errors import InputError, Place
from solver.io.importers.naming import shown
from solver.io.importers.strict_numbers import read_number
from solver.io.importers.words import read_events, read_role
from solver.model.program import MotionKind, Move, Speed, SpeedUnit
from solver.transforms import FloatArray, rigid, rotation_from_wpr
from solver.units import DEG, MM

_JOINTS: Final = tuple(f"J{joint}_deg" for joint in range(1, 7))
_PLACE: Final = ("X_mm", "Y_mm", "Z_mm")
_ANGLES: Final = ("W_deg", "P_deg", "R_deg")
_COLUMNS: Final = (
    "number", "role", "waypoint", "motion", "speed", "unit", "termination",
    *_JOINTS, *_PLACE, *_ANGLES, "config", "events",
)  # fmt: skip
_UNITS: Final = {
    "%": (SpeedUnit.PERCENT, 1),
    "mm/s": (SpeedUnit.LINEAR, 1000),
    "s": (SpeedUnit.DURATION, 1),
}
_WHOLE: Final = re.compile(r"[1-9][0-9]{0,8}", re.ASCII)
_TERMINATION: Final = re.compile(r"FINE|CNT(0|[1-9][0-9]?|100)", re.ASCII)


@dataclass(frozen=True, slots=True, eq=False)
class MoveRow:
    """One row: the move, uframe_from_tcp (4, 4) as the row states it, and its CONFIG."""

    move: Move
    pose: FloatArray
    config: str


def read_csv_moves(data: bytes, file: str) -> tuple[MoveRow, ...]:
    """Read a table of moves; `file` is its name for errors.

    Raises
    ------
    InputError
        With the line and the column's name, for anything that is no whole table.
    """
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        raise InputError(f"{file}: byte {error.start + 1} is no UTF-8") from error
    if not text.endswith("\r\n"):
        raise InputError("does not end with a line: the file is cut", Place(file))
    lines = _lines(text, file)
    place, header = next(lines, (Place(file), ()))
    if tuple(header) != _COLUMNS:
        raise InputError("the header is not the one of a table of moves", place)
    rows = []
    for expected, (place, cells) in enumerate(lines, start=1):
        if len(cells) != len(_COLUMNS):
            raise InputError(f"has {len(cells)} cells instead of {len(_COLUMNS)}", place)
        rows.append(_row(dict(zip(_COLUMNS, cells, strict=True)), expected, place))
    return tuple(rows)


def _lines(text: str, file: str) -> Iterator[tuple[Place, list[str]]]:
    reader = csv.reader(io.StringIO(text, newline=""), strict=True)
    try:
        for cells in reader:
            yield Place(file, reader.line_num), cells
    except csv.Error as error:
        raise InputError(f"is no CSV ({error})", Place(file, reader.line_num)) from error


def _row(cells: Mapping[str, str], expected: int, place: Place) -> MoveRow:
    def number(column: str) -> float:
        try:
            return read_number(cells[column])
        except ValueError as error:
            raise InputError(str(error), Place(place.file, place.line, key=column)) from error

    def fault(column: str) -> InputError:
        return InputError(
            f"{shown(cells[column])} was not expected",
            Place(place.file, place.line, key=column),
        )

    if cells["number"] != str(expected):
        raise fault("number")
    if cells["waypoint"] and not _WHOLE.fullmatch(cells["waypoint"]):
        raise fault("waypoint")
    if cells["unit"] not in _UNITS:
        raise fault("unit")
    if cells["motion"] not in {"J", "L"}:
        raise fault("motion")
    termination = _TERMINATION.fullmatch(cells["termination"])
    if termination is None:
        raise fault("termination")
    number("speed")
    unit, factor = _UNITS[cells["unit"]]
    try:
        move = Move(
            joints=np.array([number(column) for column in _JOINTS]) * DEG,
            speed=Speed(float(Decimal(cells["speed"]) / factor), unit),
            kind=MotionKind(cells["motion"]),
            cnt=None if termination[1] is None else int(termination[1]),
            role=read_role(cells["role"] or "?"),
            waypoint=int(cells["waypoint"]) - 1 if cells["waypoint"] else None,
            events=read_events(cells["events"]),
        )
    except (ValueError, InputError) as error:
        raise InputError(str(error), place) from error
    angles = [number(column) * DEG for column in _ANGLES]
    pose = rigid(rotation_from_wpr(*angles), [number(column) * MM for column in _PLACE])
    return MoveRow(move, pose, cells["config"])
