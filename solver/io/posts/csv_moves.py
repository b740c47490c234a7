"""A table of all moves for people and spreadsheets: CSV in UTF-8 with a header row."""

from __future__ import annotations

import csv
import io
import math
from decimal import Decimal
from typing import Final

from solver.errors import ModelError
from solver.io.posts.fanuc_text import program_name, whole_number
from solver.io.posts.joint_values import joint_degrees
from solver.io.posts.post import FileForm, Post, PostOptions, Rendered, RenderedFile
from solver.model.program import JointProgram, Move, Speed, SpeedUnit
from solver.model.robot import Robot
from solver.model.toolpath import Event, EventKind

SUFFIX: Final = ".csv"
LONGEST_NAME: Final = 36
LONGEST_DWELL: Final = 3_600.0

HEADER: Final = (
    "number", "role", "waypoint", "motion", "speed", "unit", "termination",
    "J1_deg", "J2_deg", "J3_deg", "J4_deg", "J5_deg", "J6_deg",
    "X_mm", "Y_mm", "Z_mm", "W_deg", "P_deg", "R_deg", "config", "events",
)  # fmt: skip

_UNITS: Final = {
    SpeedUnit.PERCENT: ("%", 1),
    SpeedUnit.LINEAR: ("mm/s", 1000),
    SpeedUnit.DURATION: ("s", 1),
}


def render_csv(program: JointProgram, options: PostOptions, robot: Robot) -> Rendered:
    """Return one row per move: speed, joints, pose in the user frame, CONFIG and events.

    Numbers are plain decimals with a point; waypoints count from 1; events are written as in
    path files, separated by '|'.

    Raises
    ------
    ModelError
        When the program asks for an offset, for which a row has no place, or a value cannot be
        written so that it is read back the same.
    """
    from solver.io.posts.frame_poses import frame_poses  # noqa: PLC0415 - compiles on first use

    del options  # no controller reads the table
    if not program.moves:
        raise ModelError(f"program {program.name[:50]!r} has no moves")
    if program.offset is not None:
        raise ModelError(
            f"program {program.name[:50]!r} asks for the offset PR[{program.offset}], which a "
            "table of moves does not hold; choose the post 'fanuc-cartesian' or 'json'"
        )
    stream = io.StringIO(newline="")
    writer = csv.writer(stream, lineterminator="\r\n")
    writer.writerow(HEADER)
    poses = frame_poses(program, robot)
    for number, (move, pose) in enumerate(zip(program.moves, poses, strict=True), start=1):
        try:
            head = _head(number, move)
            events = "|".join(map(_event, move.events))
        except ModelError as error:
            raise ModelError(f"move {number}: {error.message}") from error
        joints = [f"{value:.3f}" for value in joint_degrees(move)]
        writer.writerow([*head, *joints, *map(_leading_zero, pose.texts), pose.config, events])
    return (RenderedFile(f"{program.name}{SUFFIX}", stream.getvalue()),)


def _head(number: int, move: Move) -> list[str]:
    value, unit = _speed(move.speed)
    termination = "FINE" if move.cnt is None else f"CNT{whole_number('CNT', move.cnt, 0, 100)}"
    waypoint = "" if move.waypoint is None else str(move.waypoint + 1)
    return [str(number), move.role.value, waypoint, move.kind.value, value, unit, termination]


def _speed(speed: Speed) -> tuple[str, str]:
    unit, factor = _UNITS[speed.unit]
    return _plain(Decimal(repr(float(speed.value))) * factor), unit


def _plain(number: Decimal) -> str:
    text = f"{number:f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def _leading_zero(text: str) -> str:
    sign, digits = ("-", text[1:]) if text.startswith("-") else ("", text)
    return f"{sign}0{digits}" if digits.startswith(".") else text


def _event(event: Event) -> str:
    match event.kind:
        case EventKind.DWELL:
            if not (math.isfinite(event.value) and 0.0 < event.value <= LONGEST_DWELL):
                raise ModelError(f"a dwell is above 0 and up to 3600 s, got {event.value:g} s")
            return f"dwell:{_plain(Decimal(repr(float(event.value))))}"
        case EventKind.DIGITAL_OUTPUT:
            digits = event.target.isascii() and event.target.isdecimal() and len(event.target) <= 5
            if not digits or event.target.startswith("0") or event.value not in {0, 1}:
                raise ModelError(
                    f"a digital output has a number and 0 or 1, got {event.target[:50]!r} and "
                    f"{event.value:g}"
                )
            return f"do:{event.target}={event.value:.0f}"
        case EventKind.CALL:
            return f"call:{program_name(event.target, LONGEST_NAME)}"
        case EventKind.SPINDLE_ON:
            return "spindle-on"
        case EventKind.SPINDLE_OFF:
            return "spindle-off"


CSV_MOVES: Final = Post(
    name="csv",
    title="CSV table of all moves",
    suffix=SUFFIX,
    form=FileForm.CSV,
    render=render_csv,
)
