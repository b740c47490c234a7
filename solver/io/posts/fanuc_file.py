"""The FANUC .LS file, in the layout in which controllers write it, whatever its positions hold.

The layout is explained line by line in docs/fanuc_ls.md. Nothing here reads a clock, a file
or a setting of the machine: the same program always gives the same bytes.
"""

from __future__ import annotations

import datetime
import re
from collections.abc import Callable, Iterable, Iterator
from typing import Final

from solver.errors import ModelError
from solver.io.posts import fanuc_text as fanuc
from solver.io.posts.parts import split_program
from solver.io.posts.post import PostOptions, Rendered, RenderedFile
from solver.model.program import JointProgram, Move, SpeedUnit
from solver.model.toolpath import Event, EventKind

SUFFIX: Final = ".LS"

PositionLines = Callable[[JointProgram], Iterable[tuple[str, ...]]]
"""Gives the lines of every position behind its `GP1:`, for the program of one file."""

MotionOptions = Callable[[JointProgram, Move], str]
"""Gives what stands behind the termination of a move, with a space before it, or ''."""

_DATE: Final = re.compile(r"[0-9]{2}-[0-9]{2}-[0-9]{2}", re.ASCII)
_TIME: Final = re.compile(r"([01][0-9]|2[0-3]):[0-5][0-9]:[0-5][0-9]", re.ASCII)


def render_files(
    program: JointProgram,
    options: PostOptions,
    positions: PositionLines,
    motion_options: MotionOptions,
) -> Rendered:
    """Return the file of a program, or its main program and the parts that it calls.

    The main program holds the remarks and the calls, no move and no position; like the parts it
    takes motion group 1, so that no other task moves the arm between two of them.

    Raises
    ------
    ModelError
        When a name, text, number or length does not fit the format; nothing is cut or
        replaced silently.
    """
    if not program.moves:
        raise ModelError(f"program {program.name[:50]!r} has no moves")
    parts = split_program(program, options)
    first_moves = [0]
    for part in parts:
        first_moves.append(first_moves[-1] + len(part.moves))
    files = [
        _file(
            part,
            options,
            (*_remarks(part), *_motions(part, options, motion_options, first)),
            positions(part),
        )
        for part, first in zip(parts, first_moves, strict=False)
    ]
    if len(parts) > 1:
        calls = (_call(part.name, program.name, options) for part in parts)
        files.insert(0, _file(program, options, (*_remarks(program), *calls), ()))
    return tuple(files)


def _file(
    program: JointProgram,
    options: PostOptions,
    instructions: tuple[str, ...],
    positions: Iterable[tuple[str, ...]],
) -> RenderedFile:
    lines = [
        *_header(program, options, len(instructions)),
        "/MN",
        *(f"{number:4d}:{text};" for number, text in enumerate(instructions, start=1)),
        "/POS",
        *_positions(positions),
        "/END",
    ]
    return RenderedFile(f"{program.name}{SUFFIX}", "".join(f"{line}\r\n" for line in lines))


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


def _remarks(program: JointProgram) -> Iterator[str]:
    for remark in program.remarks:
        yield f"  !{fanuc.plain_text('a remark', remark, fanuc.REMARK_LENGTH)} "


def _motions(
    program: JointProgram, options: PostOptions, motion_options: MotionOptions, first: int
) -> Iterator[str]:
    """Yield what stands between the colon and the semicolon, from the selections on.

    Controllers write four spaces before the semicolon after motions and calls, one elsewhere.
    `first` is the number of moves in the parts before this one.
    """
    uframe = fanuc.whole_number("the user frame", program.frame.number, 0, options.uframe_limit)
    utool = fanuc.whole_number("the tool number", program.tool.number, 0, options.utool_limit)
    yield f"  UFRAME_NUM={uframe} "
    yield f"  UTOOL_NUM={utool} "
    if program.payload is not None:
        payload = fanuc.whole_number(
            "the payload schedule", program.payload, 1, options.payload_limit
        )
        yield f"  PAYLOAD[{payload}] "
    for number, move in enumerate(program.moves, start=1):
        try:
            rest = f"{_speed(move)} {_termination(move)}{motion_options(program, move)}"
            yield f"{move.kind.value} P[{number}] {rest}    "
            for event in move.events:
                yield _event(event, program.name, options)
        except ModelError as error:
            raise ModelError(f"move {first + number}: {error.message}") from error


def _speed(move: Move) -> str:
    value = move.speed.value
    match move.speed.unit:
        case SpeedUnit.PERCENT:
            return f"{fanuc.percent_text(value)}%"
        case SpeedUnit.LINEAR:
            return f"{fanuc.speed_text(value)}mm/sec"
        case SpeedUnit.DURATION:
            return f"{fanuc.milliseconds(value)}msec"


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


def _positions(positions: Iterable[tuple[str, ...]]) -> Iterator[str]:
    for number, lines in enumerate(positions, start=1):
        yield f"P[{number}]{{"
        yield "   GP1:"
        yield from lines
        yield "};"
