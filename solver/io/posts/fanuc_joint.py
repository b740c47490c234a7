"""FANUC .LS with joint positions, in the layout in which controllers write it.

The layout is explained line by line in docs/fanuc_ls.md. Nothing here reads a clock, a file
or a setting of the machine: the same program always gives the same bytes.
"""

from __future__ import annotations

import datetime
import re
from collections.abc import Iterator
from typing import Final

import numpy as np

from solver.errors import ModelError
from solver.io.posts import fanuc_text as fanuc
from solver.io.posts.post import DEFAULT_OPTIONS, Post, PostOptions
from solver.model.program import JOINT_DECIMALS, JointProgram, Move
from solver.model.toolpath import Event, EventKind
from solver.units import DEG_PER_RAD

ROUNDING_SLACK: Final = 1e-9
"""How far a joint may lie from its rounded value [deg]: what radians cost, and no more."""

_DATE: Final = re.compile(r"[0-9]{2}-[0-9]{2}-[0-9]{2}", re.ASCII)
_TIME: Final = re.compile(r"([01][0-9]|2[0-3]):[0-5][0-9]:[0-5][0-9]", re.ASCII)


def render_fanuc_joint(program: JointProgram, options: PostOptions = DEFAULT_OPTIONS) -> str:
    """Return the text of a FANUC .LS file: ASCII, CRLF line ends, joint positions.

    Parameters
    ----------
    program : JointProgram
        Its joints must already be rounded to the file's decimals of a degree: what was
        checked is then exactly what stands in the file.
    options : PostOptions
        What the controller accepts.

    Raises
    ------
    ModelError
        When a name, text, number or length does not fit the format; nothing is cut or
        replaced silently.
    """
    instructions = list(_instructions(program, options))
    if len(instructions) > options.line_limit:
        raise ModelError(
            f"the program has {len(instructions)} lines, one file takes {options.line_limit}; "
            "plan fewer waypoints or split the path"
        )
    lines = [
        *_header(program, options, len(instructions)),
        "/MN",
        *(f"{number:4d}:{text};" for number, text in enumerate(instructions, start=1)),
        "/POS",
        *_positions(program),
        "/END",
    ]
    return "".join(f"{line}\r\n" for line in lines)


def _header(program: JointProgram, options: PostOptions, line_count: int) -> list[str]:
    name = fanuc.program_name(program.name, options.name_length)
    comment = fanuc.plain_text("the program comment", program.comment, fanuc.COMMENT_LENGTH)
    stamp = f"DATE {_date(program.date)}  TIME {_time(program.time)}"
    return [
        f"/PROG  {name}",
        "/ATTR",
        "OWNER\t\t= MNEDITOR;",
        f'COMMENT\t\t= "{comment}";',
        "PROG_SIZE\t= 0;",
        f"CREATE\t\t= {stamp};",
        f"MODIFIED\t= {stamp};",
        "FILE_NAME\t= ;",
        "VERSION\t\t= 0;",
        f"LINE_COUNT\t= {line_count};",
        "MEMORY_SIZE\t= 0;",
        "PROTECT\t\t= READ_WRITE;",
        "TCD:  STACK_SIZE\t= 0,",
        "      TASK_PRIORITY\t= 50,",
        "      TIME_SLICE\t= 0,",
        "      BUSY_LAMP_OFF\t= 0,",
        "      ABORT_REQUEST\t= 0,",
        "      PAUSE_REQUEST\t= 0;",
        "DEFAULT_GROUP\t= 1,*,*,*,*;",
        "CONTROL_CODE\t= 00000000 00000000;",
    ]


def _date(text: str) -> str:
    if _DATE.fullmatch(text):
        try:
            datetime.date.fromisoformat(f"20{text}")
        except ValueError:
            pass
        else:
            return text
    raise ModelError(f"the date of a program reads YY-MM-DD, got {text[:50]!r}")


def _time(text: str) -> str:
    if _TIME.fullmatch(text):
        return text
    raise ModelError(f"the time of a program reads HH:MM:SS, got {text[:50]!r}")


def _instructions(program: JointProgram, options: PostOptions) -> Iterator[str]:
    """Yield what stands between the colon and the semicolon of every program line.

    Controllers write four spaces before the semicolon after motions and calls, one elsewhere.
    """
    if not program.moves:
        raise ModelError(f"program {program.name[:50]!r} has no moves")
    for remark in program.remarks:
        yield f"  !{fanuc.plain_text('a remark', remark, fanuc.REMARK_LENGTH)} "
    uframe = fanuc.whole_number("the user frame", program.uframe, 0, options.uframe_limit)
    utool = fanuc.whole_number("the tool number", program.utool, 0, options.utool_limit)
    yield f"  UFRAME_NUM={uframe} "
    yield f"  UTOOL_NUM={utool} "
    for number, move in enumerate(program.moves, start=1):
        try:
            yield f"J P[{number}] {_speed(move)} {_termination(move)}    "
            for event in move.events:
                yield _event(event, program.name, options)
        except ModelError as error:
            raise ModelError(f"move {number}: {error.message}") from error


def _speed(move: Move) -> str:
    if move.duration is not None:
        return f"{fanuc.milliseconds(move.duration)}msec"
    return f"{fanuc.whole_number('a joint speed in percent', move.percent, 1, 100)}%"


def _termination(move: Move) -> str:
    if move.cnt is None:
        return "FINE"
    return f"CNT{fanuc.whole_number('CNT', move.cnt, 0, 100)}"


def _event(event: Event, caller: str, options: PostOptions) -> str:
    match event.kind:
        case EventKind.DWELL:
            return f"  WAIT {fanuc.dwell_text(event.value):>6}(sec) "
        case EventKind.DIGITAL_OUTPUT:
            if not re.fullmatch(r"[0-9]{1,5}", event.target, re.ASCII):
                raise ModelError(
                    f"a digital output is named by its number, got {event.target[:50]!r}"
                )
            output = fanuc.whole_number("a digital output", int(event.target), 1, 9_999)
            if event.value not in {0, 1}:
                raise ModelError(f"a digital output is set to 0 or 1, got {event.value:g}")
            return f"  DO[{output}]={'ON' if event.value else 'OFF'} "
        case EventKind.CALL:
            return _call(event.target, caller, options)
        case EventKind.SPINDLE_ON:
            return _call(options.spindle_on, caller, options)
        case EventKind.SPINDLE_OFF:
            return _call(options.spindle_off, caller, options)


def _call(target: str, caller: str, options: PostOptions) -> str:
    if target == caller:
        raise ModelError(f"program {caller[:50]!r} would call itself")
    return f"  CALL {fanuc.program_name(target, options.name_length)}    "


def _positions(program: JointProgram) -> Iterator[str]:
    for number, move in enumerate(program.moves, start=1):
        values = _joint_texts(move, number)
        first, second = (
            ",".join(f"\tJ{joint}={values[joint - 1]:>10} deg" for joint in row)
            for row in ((1, 2, 3), (4, 5, 6))
        )
        yield f"P[{number}]{{"
        yield "   GP1:"
        yield f"\tUF : {program.uframe:d}, UT : {program.utool:d},\t"
        yield f"{first},"
        yield second
        yield "};"


def _joint_texts(move: Move, number: int) -> list[str]:
    degrees = move.joints * DEG_PER_RAD
    if not np.isfinite(degrees).all():
        raise ModelError(f"position {number} holds a joint that is not finite")
    off = np.abs(degrees - np.round(degrees, JOINT_DECIMALS))
    if np.any(off > ROUNDING_SLACK):
        joint = int(np.argmax(off))
        raise ModelError(
            f"position {number}: J{joint + 1} is {degrees[joint]:.9f} deg and was not rounded to "
            f"{JOINT_DECIMALS} decimals before it was checked"
        )
    return [fanuc.angle_text(float(value)) for value in degrees]


FANUC_JOINT: Final = Post(
    name="fanuc-joint",
    title="FANUC .LS, joint positions",
    suffix=".LS",
    render=render_fanuc_joint,
)
