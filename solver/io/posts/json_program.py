"""The neutral program as JSON: everything that it holds, and nothing that a maker adds.

docs/schemas/program.schema.json describes the document.
"""

from __future__ import annotations

import json
import math
from typing import Any, Final

from solver.errors import ModelError
from solver.io.posts.joint_values import joint_degrees
from solver.io.posts.post import FileForm, Post, PostOptions, Rendered, RenderedFile
from solver.model.program import JointProgram, Move, NumberedPose, SpeedUnit
from solver.model.robot import Robot
from solver.model.toolpath import Event
from solver.units import MM_PER_M

SUFFIX: Final = ".json"
FORMAT: Final = "posopt-program"
VERSION: Final = 1

_UNITS: Final = {SpeedUnit.PERCENT: "%", SpeedUnit.LINEAR: "mm/s", SpeedUnit.DURATION: "s"}


def render_json(program: JointProgram, options: PostOptions, robot: Robot) -> Rendered:
    """Return the program as one JSON document: ASCII, one move per line.

    Raises
    ------
    ModelError
        When a number is not finite, the joints were not rounded, or a text holds half a
        character (a lone surrogate).
    """
    del options, robot  # no controller reads it; joints and frames say all
    if not program.moves:
        raise ModelError(f"program {program.name[:50]!r} has no moves")
    head = {
        "format": FORMAT,
        "version": VERSION,
        "name": program.name,
        "comment": program.comment,
        "remarks": list(program.remarks),
        "date": program.date,
        "time": program.time,
        "user_frame": _pose("fanuc_world_from_uframe", program.frame),
        "tool": _pose("flange_from_tcp", program.tool),
        "payload": program.payload,
        "offset_register": program.offset,
    }
    lines = ["{"]
    lines += [f" {json.dumps(key)}: {_text(value)}," for key, value in head.items()]
    moves = ",\n".join(
        f"  {_text(_move(number, one))}" for number, one in enumerate(program.moves, 1)
    )
    lines += [' "moves": [', moves, " ]", "}"]
    return (RenderedFile(f"{program.name}{SUFFIX}", "\n".join(lines) + "\n"),)


def _text(value: Any) -> str:
    try:
        text = json.dumps(value, allow_nan=False)
    except ValueError as error:
        raise ModelError("a program with a number that is not finite has no JSON form") from error
    try:
        json.dumps(value, ensure_ascii=False).encode("utf-8")
    except UnicodeEncodeError as error:
        raise ModelError(f"a text of the program holds half a character: {text[:50]!r}") from error
    return text


def _pose(transform: str, numbered: NumberedPose) -> dict[str, Any]:
    return {
        "number": numbered.number,
        "measured": numbered.measured,
        "transform": transform,
        "rotation": numbered.pose[:3, :3].tolist(),
        "position_mm": (numbered.pose[:3, 3] * MM_PER_M).tolist(),
    }


def _move(number: int, move: Move) -> dict[str, Any]:
    try:
        joints = joint_degrees(move)
        events = [_event(event) for event in move.events]
    except ModelError as error:
        raise ModelError(f"position {number}: {error.message}") from error
    factor = MM_PER_M if move.speed.unit is SpeedUnit.LINEAR else 1.0
    return {
        "motion": move.kind.value,
        "speed": move.speed.value * factor,
        "unit": _UNITS[move.speed.unit],
        "cnt": move.cnt,
        "role": move.role.value,
        "waypoint": None if move.waypoint is None else move.waypoint + 1,
        "joints_deg": joints,
        "events": events,
    }


def _event(event: Event) -> dict[str, Any]:
    if not math.isfinite(event.value):
        raise ModelError(f"the event {event.kind.value} holds the value {event.value:g}")
    return {"kind": event.kind.value, "target": event.target, "value": float(event.value)}


JSON_PROGRAM: Final = Post(
    name="json",
    title="JSON, the neutral program",
    suffix=SUFFIX,
    form=FileForm.JSON,
    render=render_json,
)
