"""What FANUC files that were read back say otherwise than the program they were made from.

It shares no code with the posts: it states on its own what a file has to mean.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import PurePath
from typing import Final

import numpy as np

from solver.errors import InputError
from solver.io.ls_program import Motion, Position, ProgramFile
from solver.io.posts.post import (
    ANGLE_TOLERANCE,
    JOINT_TOLERANCE,
    POSITION_TOLERANCE,
    FileForm,
    PostOptions,
)
from solver.kinematics.arm import forward, inverse
from solver.kinematics.configuration import (
    branch_of,
    choose,
    config_string,
    parse_configuration,
)
from solver.model.program import JOINT_DECIMALS, JointProgram, Move, SpeedUnit
from solver.model.robot import Robot
from solver.model.toolpath import Event, EventKind, Role
from solver.transforms import FloatArray, rigid, rotation_angle, rotation_from_wpr
from solver.units import DEG_PER_RAD, MM_PER_M

_PART: Final = re.compile(r"PART ([1-9][0-9]*) OF ([1-9][0-9]*)")
_OWNER: Final = "MAIN "

WAIT_STEP: Final = Fraction(1, 100)
"""Unit in which a controller waits [s]."""

MOTION_STEP: Final = Fraction(1, 1000)
"""Unit in which a motion time is posted [s]."""

SPEED_STEP: Final = Fraction(1, 10)
"""Unit in which a TCP speed is posted [mm/s]."""

SPEED_SLACK: Final = Fraction(1, 10**9)
"""What a speed in binary metres per second may miss its decimal by [mm/s]."""

Meaning = tuple[object, ...]

_MEANINGS: Final[tuple[tuple[re.Pattern[str], Callable[[re.Match[str]], Meaning]], ...]] = (
    (re.compile(r"!.*"), lambda _: ("remark",)),
    (re.compile(r"WAIT +([0-9]*\.[0-9]+)\(sec\)"), lambda one: ("wait", Fraction(one[1]))),
    (re.compile(r"DO\[([0-9]+)\]=(ON|OFF)"), lambda one: ("output", int(one[1]), one[2] == "ON")),
    (re.compile(r"CALL ([A-Z][A-Z0-9_]*)"), lambda one: ("call", one[1])),
    (re.compile(r"PAYLOAD\[([0-9]+)\]"), lambda one: ("payload", int(one[1]))),
    (re.compile(r"UFRAME_NUM=([0-9]+)"), lambda one: ("uframe", int(one[1]))),
    (re.compile(r"UTOOL_NUM=([0-9]+)"), lambda one: ("utool", int(one[1]))),
)


@dataclass(frozen=True, slots=True)
class PartMark:
    """Which part of which program a file says it is; `lines` remarks at its head say so."""

    number: int
    count: int
    owner: str
    lines: int


def part_mark(remarks: Sequence[str]) -> PartMark | None:
    """What the first remarks of a file say about the program that it is a part of, or None."""
    owner = ""
    for index, remark in enumerate(remarks):
        if remark.startswith(_OWNER):
            owner += remark.removeprefix(_OWNER)
            continue
        found = _PART.fullmatch(remark)
        if found is None or not owner:
            return None
        return PartMark(int(found[1]), int(found[2]), owner, index + 1)
    return None


def ls_differences(
    program: JointProgram,
    files: Sequence[ProgramFile],
    options: PostOptions,
    robot: Robot,
    form: FileForm = FileForm.FANUC_JOINT,
) -> Iterator[str]:
    """Yield one sentence for every difference between a program and what its files say.

    `files` are the single file of a program, or its main program and the parts in the order in
    which it calls them.
    """
    if not files:
        yield "there is no file"
        return
    parts = files if len(files) == 1 else files[1:]
    if len(files) > 1:
        yield from _main_differences(program, files)
    start = 0
    for index, part in enumerate(parts, start=1):
        # Where a program is split is the post's choice; the last part has to hold the rest.
        end = len(program.moves) if index == len(parts) else start + len(part.moves)
        moves = program.moves[start:end]
        start = end
        where = f"{part.name}: " if len(files) > 1 else ""
        mark = (index, len(parts)) if len(files) > 1 else None
        for difference in _PartComparison(program, moves, part, options, robot, form, mark).run():
            yield where + difference


def _main_differences(program: JointProgram, files: Sequence[ProgramFile]) -> Iterator[str]:
    main, parts = files[0], files[1:]
    yield from _header_differences(program, main, program.name, program.remarks)
    names = [part.name for part in parts]
    if len(set(names)) != len(names) or program.name in names:
        yield f"its parts {', '.join(names)} do not have names of their own"
    expected: list[Meaning] = [("remark",) for _ in program.remarks]
    expected += [("call", name) for name in names]
    yield from _order_differences(expected, main)
    if main.positions:
        yield f"it has {len(main.positions)} positions, although it only calls its parts"


@dataclass(frozen=True, slots=True)
class _PartComparison:
    """One file against its share of the moves; `mark` is its number and the count of parts."""

    program: JointProgram
    moves: Sequence[Move]
    found: ProgramFile
    options: PostOptions
    robot: Robot
    form: FileForm
    mark: tuple[int, int] | None

    def run(self) -> Iterator[str]:
        program, found = self.program, self.found
        remarks = program.remarks
        name = program.name
        if self.mark is not None:
            name = found.name
            mark = part_mark(found.remarks)
            stated = None if mark is None else (mark.number, mark.count, mark.owner)
            if stated != (*self.mark, program.name):
                number, count = self.mark
                yield f"its remarks do not say PART {number} OF {count} of {program.name}"
            remarks = (*found.remarks[: 0 if mark is None else mark.lines], *remarks)
        yield from _header_differences(program, found, name, remarks)
        for what, value, expected in (
            ("UFRAME_NUM", found.uframe, program.frame.number),
            ("UTOOL_NUM", found.utool, program.tool.number),
        ):
            if value != expected:
                yield f"{what} reads {value!r} instead of {expected!r}"
        yield from _order_differences(self._expected(len(remarks)), found)
        if len(found.moves) != len(self.moves):
            yield f"it has {len(found.moves)} moves instead of {len(self.moves)}"
            return
        if list(found.positions) != list(range(1, len(self.moves) + 1)):
            yield f"its positions are not numbered 1 to {len(self.moves)}"
            return
        yield from self._move_differences()

    def _expected(self, remarks: int) -> list[Meaning]:
        """The instructions, motions being represented by their kind alone."""
        program = self.program
        expected: list[Meaning] = [("remark",) for _ in range(remarks)]
        expected += [("uframe", program.frame.number), ("utool", program.tool.number)]
        if program.payload is not None:
            expected.append(("payload", program.payload))
        for move in self.moves:
            expected.append(("move",))
            expected.extend(_event_meaning(event, self.options) for event in move.events)
        return expected

    def _move_differences(self) -> Iterator[str]:
        pairs = zip(self.moves, self.found.moves, strict=True)
        for number, (move, motion) in enumerate(pairs, start=1):
            for difference in self._motion_differences(number, move, motion):
                yield f"line {motion.place.line} {difference}"
            position = self.found.positions[number]
            for difference in self._position_differences(move, position):
                yield f"P[{number}] {difference}"

    def _motion_differences(self, number: int, move: Move, motion: Motion) -> Iterator[str]:
        program = self.program
        options: tuple[str, ...] = ()
        if program.offset is not None and move.role is Role.CONTACT:
            options = (f"Offset,PR[{program.offset}]",)
        facts: tuple[tuple[str, object, object], ...] = (
            ("moves with", motion.letter, move.kind.value),
            ("moves to", motion.positions, (number,)),
            ("ends with", motion.termination, "FINE" if move.cnt is None else "CNT"),
            ("rounds with CNT", motion.cnt, move.cnt),
            ("has the options", motion.options, options),
            ("runs in user frame", motion.uframe, program.frame.number),
            ("runs with tool", motion.utool, program.tool.number),
        )
        for what, value, expected in facts:
            if value != expected:
                yield f"{what} {value!r} instead of {expected!r}"
        yield from _speed_differences(move, motion)

    def _position_differences(self, move: Move, position: Position) -> Iterator[str]:
        group = position.first
        for what, value, expected in (
            ("has motion groups", tuple(one.group for one in position.groups), (1,)),
            ("has the user frame", group.uframe, self.program.frame.number),
            ("has the tool", group.utool, self.program.tool.number),
            ("has external axes", group.extra, ()),
            ("has the name", position.label, ""),
        ):
            if value != expected:
                yield f"{what} {value!r} instead of {expected!r}"
        if self.form is FileForm.FANUC_CARTESIAN:
            yield from self._pose_differences(move, position)
        else:
            yield from _joint_differences(move, position)

    def _pose_differences(self, move: Move, position: Position) -> Iterator[str]:
        """Solve a Cartesian position as a controller does and compare where the arm comes to."""
        robot, tool = self.robot, self.program.tool.pose
        try:
            joints = solve_position(robot, self.program, position)
        except InputError as error:
            yield f"has no joints ({error.message})"
            return
        off, turned = _apart(forward(robot, joints, tool), forward(robot, move.joints, tool))
        if not (off <= POSITION_TOLERANCE and turned <= ANGLE_TOLERANCE):
            yield (
                f"is {off * MM_PER_M:.4f} mm and {turned * DEG_PER_RAD:.4f} deg from where the "
                "TCP should be"
            )
        asked_config = config_string(robot, move.joints)
        if (config := config_string(robot, joints)) != asked_config:
            yield f"has CONFIG {config!r} instead of {asked_config!r}"
        if branch_of(robot, joints) != branch_of(robot, move.joints):
            yield "is reached in another branch"
        apart = np.abs(joints - move.joints)
        joint = int(np.argmax(apart))
        if apart[joint] > JOINT_TOLERANCE:
            yield f"puts J{joint + 1} {apart[joint] * DEG_PER_RAD:.3f} deg from where it should be"


def solve_position(robot: Robot, program: JointProgram, position: Position) -> FloatArray:
    """Pendant joints (6,) [rad] of a Cartesian position in the program's frame and tool.

    Raises
    ------
    InputError
        When it is no Cartesian position, is untaught, or no solution has its CONFIG.
    """
    place, angles = position.cartesian
    pose = program.frame.pose @ rigid(rotation_from_wpr(*angles), place)
    widened = np.array([-JOINT_TOLERANCE, JOINT_TOLERANCE])
    solutions = inverse(
        robot,
        pose,
        program.tool.pose,
        limits=robot.limits + widened,
        elbow_limits=robot.elbow_limits + widened,
    )
    config = parse_configuration(position.first.config or "", position.place)
    return choose(robot, solutions.joints, config)


def _apart(one: FloatArray, other: FloatArray) -> tuple[float, float]:
    """Distance [m] and angle [rad] between two poses."""
    distance = float(np.linalg.norm(one[:3, 3] - other[:3, 3]))
    return distance, rotation_angle(one[:3, :3].T @ other[:3, :3])


def _header_differences(
    program: JointProgram, found: ProgramFile, name: str, remarks: tuple[str, ...]
) -> Iterator[str]:
    count = str(len(found.instructions))
    stamp = f"DATE {program.date}  TIME {program.time}"
    for what, value, expected in (
        ("its name", found.name, name),
        ("its file", PurePath(found.file).stem.upper(), name),
        ("its kind", found.kind, ""),
        ("its comment", found.comment, program.comment),
        ("its remarks", found.remarks, remarks),
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


def _order_differences(expected: Sequence[Meaning], found: ProgramFile) -> Iterator[str]:
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


def _same(actual: Meaning, expected: Meaning) -> bool:
    if actual[0] == expected[0] == "wait":
        posted, asked = actual[1], expected[1]
        return (
            isinstance(posted, Fraction)
            and isinstance(asked, Fraction)
            and 0 <= posted - asked < WAIT_STEP
        )
    return actual == expected


def _event_meaning(event: Event, options: PostOptions) -> Meaning:
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


def _meaning(text: str) -> Meaning:
    for pattern, meaning in _MEANINGS:
        if found := pattern.fullmatch(text):
            return meaning(found)
    return ("something else",)


def _speed_differences(move: Move, motion: Motion) -> Iterator[str]:
    posted, asked = motion.speed, move.speed
    unit, how = {
        SpeedUnit.PERCENT: ("%", ""),
        SpeedUnit.LINEAR: ("mm/sec", ", rounded down to 0.1 mm/s"),
        SpeedUnit.DURATION: ("msec", ", rounded up to a millisecond"),
    }[asked.unit]
    if posted.value is not None and posted.unit == unit:
        value, wanted = _exact(posted.value), _exact(asked.value)
        match asked.unit:
            case SpeedUnit.PERCENT:
                same = value == wanted
            case SpeedUnit.LINEAR:
                short = wanted * 1000 - value
                same = -SPEED_SLACK <= short < SPEED_STEP - SPEED_SLACK
            case SpeedUnit.DURATION:
                same = 0 <= value * MOTION_STEP - wanted < MOTION_STEP
        if same:
            return
    yield f"has the speed {posted.text} instead of {asked}{how}"


def _joint_differences(move: Move, position: Position) -> Iterator[str]:
    try:
        read = position.joints_deg
    except InputError as error:
        yield f"has no joints ({error.message})"
        return
    asked = np.round(move.joints * DEG_PER_RAD, JOINT_DECIMALS)
    for joint, (degrees, wanted) in enumerate(zip(read, asked.tolist(), strict=True), start=1):
        if degrees != wanted:
            yield f"has J{joint} = {degrees:.6f} deg instead of {wanted:.6f} deg"
