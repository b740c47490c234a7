"""A robot program reaches its final name only after what is on disk was read back and checked."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from fractions import Fraction
from pathlib import Path
from typing import Final

import numpy as np

from solver.errors import InputError, Place, RefusedError
from solver.io.atomic import staged
from solver.io.ls_program import Motion, Position, ProgramFile
from solver.io.ls_reader import read_program
from solver.io.posts.fanuc_joint import FANUC_JOINT
from solver.io.posts.post import DEFAULT_OPTIONS, Post, PostOptions
from solver.model.program import JOINT_DECIMALS, JointProgram, Move
from solver.model.toolpath import Event, EventKind
from solver.units import DEG_PER_RAD

_WAIT: Final = re.compile(r"WAIT +([0-9]*\.[0-9]+)\(sec\)")
_OUTPUT: Final = re.compile(r"DO\[([0-9]+)\]=(ON|OFF)")
_CALL: Final = re.compile(r"CALL ([A-Z][A-Z0-9_]*)")

WAIT_STEP: Final = Fraction(1, 100)
"""Unit in which a controller waits [s]."""

MOTION_STEP: Final = Fraction(1, 1000)
"""Unit in which a motion time is posted [s]."""


def write_verified(
    program: JointProgram,
    path: Path,
    verify: Callable[[ProgramFile], None],
    options: PostOptions = DEFAULT_OPTIONS,
    post: Post = FANUC_JOINT,
) -> ProgramFile:
    """Write a FANUC program, read it back from disk, check it, and only then give it its name.

    Parameters
    ----------
    program : JointProgram
        What is to be written; its joints are rounded already.
    path : Path
        The final name; its stem must be the program's name, under which a controller loads it.
    verify : callable
        Gets the program as read back and raises when it is not fit to run (kinematics,
        clearances). Whatever it raises passes through, and nothing is written.

    options : PostOptions
        What the controller accepts.
    post : Post
        A post whose files are FANUC .LS.

    Returns
    -------
    ProgramFile
        What was read back.

    Raises
    ------
    RefusedError
        When what was read back differs from the program; it says what and where. A file that
        bore the final name before keeps its content.
    """
    path = Path(path)
    if path.stem.upper() != program.name or path.suffix.upper() != post.suffix:
        raise InputError(
            f"a controller loads program {program.name} from a file named "
            f"{program.name}{post.suffix}, not {path.name}",
            Place(str(path)),
        )
    data = post.render(program, options).encode("ascii")
    with staged(path, data) as temporary:
        found = _read_back(temporary, path, data)
        for difference in differences(program, found, options):
            raise RefusedError(f"{path.name} was not written: read back, {difference}")
        verify(found)
    return found


def _read_back(temporary: Path, path: Path, data: bytes) -> ProgramFile:
    try:
        on_disk = temporary.read_bytes()
        found = read_program(on_disk, path.name)
    except (OSError, InputError) as error:
        raise RefusedError(f"{path.name} was not written: read back, {error}") from error
    if on_disk != data:
        raise RefusedError(
            f"{path.name} was not written: read back, its {len(on_disk)} bytes differ from the "
            f"{len(data)} that were sent to the disk"
        )
    return found


def differences(
    program: JointProgram, found: ProgramFile, options: PostOptions = DEFAULT_OPTIONS
) -> Iterator[str]:
    """Yield one sentence for every difference between a program and what a file says."""
    yield from _header_differences(program, found)
    yield from _order_differences(program, found, options)
    if len(found.moves) != len(program.moves):
        yield f"it has {len(found.moves)} moves instead of {len(program.moves)}"
        return
    if list(found.positions) != list(range(1, len(program.moves) + 1)):
        yield f"its positions are not numbered 1 to {len(program.moves)}"
        return
    for number, (move, motion) in enumerate(zip(program.moves, found.moves, strict=True), start=1):
        for difference in _motion_differences(number, move, motion, program):
            yield f"line {motion.place.line} {difference}"
        position = found.positions[number]
        for difference in _position_differences(move, position, program):
            yield f"P[{number}] {difference}"


def _header_differences(program: JointProgram, found: ProgramFile) -> Iterator[str]:
    count = str(len(found.instructions))
    stamp = f"DATE {program.date}  TIME {program.time}"
    for what, value, expected in (
        ("its name", found.name, program.name),
        ("its kind", found.kind, ""),
        ("its comment", found.comment, program.comment),
        ("its remarks", found.remarks, program.remarks),
        ("UFRAME_NUM", found.uframe, program.uframe),
        ("UTOOL_NUM", found.utool, program.utool),
        ("its LINE_COUNT", found.attributes.get("LINE_COUNT"), count),
        ("its creation", found.attributes.get("CREATE"), stamp),
        ("its modification", found.attributes.get("MODIFIED"), stamp),
        ("its motion group", found.attributes.get("DEFAULT_GROUP"), "1,*,*,*,*"),
    ):
        if value != expected:
            yield f"{what} reads {value!r} instead of {expected!r}"
    for expected_number, one in enumerate(found.instructions, start=1):
        if one.number != expected_number:
            yield f"line {one.place.line} has number {one.number} instead of {expected_number}"


def _order_differences(
    program: JointProgram, found: ProgramFile, options: PostOptions
) -> Iterator[str]:
    """Compare the instructions, motions being represented by their kind alone."""
    expected: list[tuple[object, ...]] = [("remark",) for _ in program.remarks]
    expected += [("uframe", program.uframe), ("utool", program.utool)]
    for move in program.moves:
        expected.append(("move",))
        expected.extend(_event_meaning(event, options) for event in move.events)
    if len(expected) != len(found.instructions):
        yield f"it has {len(found.instructions)} instructions instead of {len(expected)}"
        return
    for meaning, one in zip(expected, found.instructions, strict=True):
        actual = ("move",) if one.motion is not None else _meaning(one.text)
        if not _same(actual, meaning):
            yield (
                f"line {one.place.line} reads {one.text[:50]!r} instead of "
                f"{' '.join(map(str, meaning))}"
            )


def _same(actual: tuple[object, ...], expected: tuple[object, ...]) -> bool:
    if actual[0] == expected[0] == "wait":
        posted, asked = actual[1], expected[1]
        return (
            isinstance(posted, Fraction)
            and isinstance(asked, Fraction)
            and 0 <= posted - asked < WAIT_STEP
        )
    return actual == expected


def _event_meaning(event: Event, options: PostOptions) -> tuple[object, ...]:
    match event.kind:
        case EventKind.DWELL:
            return ("wait", _exact(event.value))
        case EventKind.DIGITAL_OUTPUT:
            return ("output", int(event.target), event.value == 1.0)
        case EventKind.CALL:
            return ("call", event.target)
        case EventKind.SPINDLE_ON:
            return ("call", options.spindle_on)
        case EventKind.SPINDLE_OFF:
            return ("call", options.spindle_off)


def _exact(value: float) -> Fraction:
    """Return the shortest decimal that denotes `value`, which is what a person asked for."""
    return Fraction(repr(float(value)))


def _meaning(text: str) -> tuple[object, ...]:
    if text.startswith("!"):
        return ("remark",)
    if found := _WAIT.fullmatch(text):
        return ("wait", Fraction(found[1]))
    if found := _OUTPUT.fullmatch(text):
        return ("output", int(found[1]), found[2] == "ON")
    if found := _CALL.fullmatch(text):
        return ("call", found[1])
    what, separator, value = text.partition("=")
    if separator and value.isascii() and value.isdecimal() and what in {"UFRAME_NUM", "UTOOL_NUM"}:
        return (what.removesuffix("_NUM").lower(), int(value))
    return ("something else",)


def _motion_differences(
    number: int, move: Move, motion: Motion, program: JointProgram
) -> Iterator[str]:
    facts: tuple[tuple[str, object, object], ...] = (
        ("moves with", motion.letter, "J"),
        ("moves to", motion.positions, (number,)),
        ("ends with", motion.termination, "FINE" if move.cnt is None else "CNT"),
        ("rounds with CNT", motion.cnt, move.cnt),
        ("has the options", motion.options, ()),
        ("runs in user frame", motion.uframe, program.uframe),
        ("runs with tool", motion.utool, program.utool),
    )
    for what, value, expected in facts:
        if value != expected:
            yield f"{what} {value!r} instead of {expected!r}"
    speed = motion.speed
    if move.percent is not None:
        if (speed.value, speed.unit) != (move.percent, "%"):
            yield f"has the speed {speed.text} instead of {move.percent}%"
        return
    if move.duration is not None and (
        speed.value is None
        or speed.unit != "msec"
        or not 0 <= _exact(speed.value) * MOTION_STEP - _exact(move.duration) < MOTION_STEP
    ):
        yield (
            f"has the speed {speed.text} instead of {move.duration:g} s, rounded up to a "
            "millisecond"
        )


def _position_differences(move: Move, position: Position, program: JointProgram) -> Iterator[str]:
    group = position.first
    for what, value, expected in (
        ("has motion groups", tuple(one.group for one in position.groups), (1,)),
        ("has the user frame", group.uframe, program.uframe),
        ("has the tool", group.utool, program.utool),
        ("has external axes", group.extra, ()),
        ("has the name", position.label, ""),
    ):
        if value != expected:
            yield f"{what} {value!r} instead of {expected!r}"
    try:
        read = position.joints_deg
    except InputError as error:
        yield f"has no joints ({error.message})"
        return
    asked = np.round(move.joints * DEG_PER_RAD, JOINT_DECIMALS)
    for joint, (degrees, wanted) in enumerate(zip(read, asked.tolist(), strict=True), start=1):
        if degrees != wanted:
            yield f"has J{joint} = {degrees:.6f} deg instead of {wanted:.6f} deg"
