"""What .LS files make the robot do, as a neutral program.

Calls are followed in order, positions become joints, and everything that cannot be followed or
stops a controller becomes a finding: a program with findings is not the whole truth.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from solver.errors import InputError, Place
from solver.io.ls_findings import Finding, FindingKind, FindingLog
from solver.io.ls_instructions import Call, Payload, Selection, Unfollowed, meaning
from solver.io.ls_moves import WIDEST_CNT, Manner, manner
from solver.io.ls_position_use import PositionUse, position_use
from solver.io.ls_posture import posture
from solver.io.ls_program import GroupPosition, Instruction, Motion, Position, ProgramFile
from solver.io.ls_program_set import ProgramSet, program_set
from solver.model.program import JointProgram, Move, NumberedPose
from solver.model.robot import Robot
from solver.model.toolpath import Event, EventKind
from solver.transforms import FloatArray, rigid

MOVE_LIMIT: Final = 200_000
STEP_LIMIT: Final = 1_000_000
"""Most moves and instructions that are followed, calls included."""

_STAMP: Final = re.compile(
    r"[^\W\d]+ +([0-9]{2}-[0-9]{2}-[0-9]{2}) +[^\W\d]+ +([0-9]{2}:[0-9]{2}:[0-9]{2})"
)
_FRAME: Final = "UFRAME_NUM"
_TOOL: Final = "UTOOL_NUM"


@dataclass(frozen=True, slots=True, eq=False)
class Interpretation:
    """What a set of .LS files does.

    Attributes
    ----------
    program : JointProgram
        Every move that can be followed, calls flattened; joints as written, or solved from a
        Cartesian position, and in no case rounded. Its moves have neither roles nor waypoints.
    start_events : tuple of Event
        What happens before the first move.
    findings : tuple of Finding
        Everything that the program does not show. Without findings it shows all.
    unresolved : tuple of str
        Programs that are called and not at hand. They are taken for events: that they move the
        robot cannot be excluded by reading.
    position_use : tuple of PositionUse
        One for each file that holds positions.
    in_joints : tuple of bool
        For each move, whether its position is given in joints.
    offset_moves : tuple of int
        Indices of the moves that add the program's offset.
    frames : tuple of pairs
        The different pairs of user frame and tool number in which moves run or positions that
        they use were taught; None where no number is known.
    """

    program: JointProgram
    start_events: tuple[Event, ...]
    findings: tuple[Finding, ...]
    unresolved: tuple[str, ...]
    position_use: tuple[PositionUse, ...]
    in_joints: tuple[bool, ...]
    offset_moves: tuple[int, ...]
    frames: tuple[tuple[int | None, int | None], ...]


def interpret(
    robot: Robot,
    frame: NumberedPose,
    tool: NumberedPose,
    programs: ProgramSet | ProgramFile,
    *,
    offset: int | None = None,
) -> Interpretation:
    """Follow a program and the programs that it calls.

    Parameters
    ----------
    robot : Robot
        For positions in X Y Z W P R.
    frame, tool : NumberedPose
        What the user frame and tool of these numbers hold at the cell; other numbers than 0
        are not known.
    programs : ProgramSet or ProgramFile
        A file alone is taken as a set of its own.
    offset : int, optional
        Position register whose offset moves may add; its nominal value is zero. Any other
        offset is a finding.

    Raises
    ------
    InputError
        With file and line: a position is out of reach or has no CONFIG, or there are more than
        `MOVE_LIMIT` moves.
    """
    files = programs if isinstance(programs, ProgramSet) else program_set((programs,))
    walk = _Walk(robot, frame, tool, files, offset)
    walk.check_files()
    walk.follow(files.main)
    return walk.result()


class _Walk:
    """State of a program while its lines are followed."""

    def __init__(
        self,
        robot: Robot,
        frame: NumberedPose,
        tool: NumberedPose,
        files: ProgramSet,
        offset: int | None,
    ) -> None:
        self._robot = robot
        self._expected = {_FRAME: frame, _TOOL: tool}
        self._files = files
        self._offset = offset
        self._log = FindingLog()
        self._moves: list[Move] = []
        self._events: list[list[Event]] = [[]]
        self._in_joints: list[bool] = []
        self._offset_moves: list[int] = []
        self._payloads: dict[int, None] = {}
        self._selected: dict[str, tuple[int | None, Place]] = {}
        self._solved: dict[tuple[str, int, bool, bool], tuple[FloatArray, str]] = {}
        self._frames: dict[tuple[int | None, int | None], None] = {}
        self._steps = 0

    def check_files(self) -> None:
        for name, file in self._files.programs.items():
            place = Place(file.file)
            if file.name.upper() != name:
                self._log.add(
                    FindingKind.NAME, f"called as {name}, but it holds program {file.name}", place
                )
            for line in file.application:
                self._log.add(
                    FindingKind.FLOW,
                    f"/APPL says {line[:40]!r}, which can change the motion",
                    place,
                )
            first, *groups = file.attributes.get("DEFAULT_GROUP", "1").split(",")
            if file.moves and first.strip() != "1":
                self._log.add(
                    FindingKind.GROUPS, "DEFAULT_GROUP leaves out the arm, which moves", place
                )
            if any(one.strip() not in {"*", ""} for one in groups):
                self._log.add(
                    FindingKind.GROUPS, "DEFAULT_GROUP names more motion groups than the arm", place
                )

    def follow(self, file: ProgramFile) -> None:
        for line in file.instructions:
            self._steps += 1
            if self._steps > STEP_LIMIT or len(self._moves) > MOVE_LIMIT:
                raise InputError(
                    f"more than {MOVE_LIMIT} moves or {STEP_LIMIT} lines, calls included",
                    line.place,
                )
            if line.motion is not None:
                self._motion(file, line.motion)
            else:
                self._instruction(line)

    def result(self) -> Interpretation:
        main = self._files.main
        if not self._moves:
            self._log.add(FindingKind.EMPTY, "no move is left to check", Place(main.file))
        date, time = _creation(main.attributes)
        start, *after = (tuple(events) for events in self._events)
        program = JointProgram(
            name=main.name,
            comment=main.comment,
            remarks=main.remarks,
            frame=self._expected[_FRAME],
            tool=self._expected[_TOOL],
            moves=tuple(
                replace(move, events=events)
                for move, events in zip(self._moves, after, strict=True)
            ),
            date=date,
            time=time,
            payload=next(iter(self._payloads), None),
            offset=self._offset if self._offset_moves else None,
        )
        return Interpretation(
            program=program,
            start_events=start,
            findings=self._log.findings(),
            unresolved=self._files.unresolved,
            position_use=position_use(self._files.programs.values()),
            in_joints=tuple(self._in_joints),
            offset_moves=tuple(self._offset_moves),
            frames=tuple(self._frames),
        )

    def _instruction(self, line: Instruction) -> None:
        match meaning(line.text):
            case None:
                pass
            case Event() as event:
                self._events[-1].append(event)
            case Call(name=name, arguments=arguments):
                if name in self._files.programs:
                    self.follow(self._files.programs[name])
                else:
                    self._events[-1].append(Event(EventKind.CALL, name + arguments))
            case Selection(what=what, number=number):
                self._selected[what] = (number, line.place)
            case Payload(number=number):
                if self._moves and not self._payloads:
                    sentence = "a payload is selected after the first motion"
                    self._log.add(FindingKind.PAYLOAD, sentence, line.place)
                self._payloads[number] = None
                if len(self._payloads) > 1:
                    numbers = ", ".join(map(str, self._payloads))
                    self._log.add(
                        FindingKind.PAYLOAD, f"several payloads are selected: {numbers}", line.place
                    )
            case Unfollowed(kind=kind, sentence=sentence):
                self._log.add(kind, sentence, line.place)

    def _motion(self, file: ProgramFile, motion: Motion) -> None:
        how = manner(motion, self._offset)
        for kind, sentence in how.problems:
            self._log.add(kind, sentence, motion.place)
        known = self._check_selection(motion.place)
        for index, number in enumerate(motion.positions):
            position = file.positions[number]
            arm = self._check_position(position, motion.place)
            if arm is None or how.displaced:
                continue
            joints = self._joints(position, arm, motion.place, known)
            if joints is not None:
                # Nothing stops at the point on the way of a C motion.
                on_the_way = index < len(motion.positions) - 1
                self._add(how, joints, motion.place, on_the_way)
                self._in_joints.append(arm.is_joint)

    def _add(self, how: Manner, joints: FloatArray, place: Place, on_the_way: bool) -> None:
        if how.offset:
            self._offset_moves.append(len(self._moves))
        self._moves.append(
            Move(
                joints=joints,
                speed=how.speed,
                kind=how.kind,
                cnt=WIDEST_CNT if on_the_way else how.cnt,
                source=f"{Path(place.file).name}:{place.line}",
            )
        )
        self._events.append([])

    def _check_selection(self, place: Place) -> bool:
        """Note frames and tools in force that are not the expected ones; tell if all are known."""
        known = True
        self._frames[self._selection(_FRAME), self._selection(_TOOL)] = None
        for what, expected in self._expected.items():
            if what not in self._selected:
                self._log.add(
                    FindingKind.FRAME_SELECTION,
                    f"no {what} stands before the first move, so that what is selected on the "
                    f"controller applies instead of {expected.number}",
                    place,
                    key=f"no {what}",
                )
                continue
            number, selected_at = self._selected[what]
            if number is None:
                known = False
                sentence = f"{what} comes from a register, {expected.number} was expected"
            elif number != expected.number:
                known = known and number == 0
                sentence = f"{what}={number} applies to moves, {expected.number} was expected"
            else:
                continue
            self._log.add(FindingKind.FRAME_SELECTION, sentence, selected_at)
        return known

    def _selection(self, what: str) -> int | None:
        """Return the number in force, None where there is none or a register gives it."""
        return self._selected[what][0] if what in self._selected else None

    def _check_position(self, position: Position, place: Place) -> GroupPosition | None:
        """Note what keeps a position from being used; return its GP1 where that can be used."""
        number, arm = position.number, position.arm
        others = [f"GP{one.group}" for one in position.groups if one.group != 1]
        if others:
            self._log.add(
                FindingKind.GROUPS,
                f"P[{number}] moves {', '.join(others)}, which is not checked",
                place,
                key=", ".join(others),
            )
        if arm is None:
            return None
        if arm.extra:
            names = ", ".join(axis.name for axis in arm.extra)
            self._log.add(
                FindingKind.EXTERNAL_AXES,
                f"P[{number}] moves {names}, which is not checked",
                place,
                key=names,
            )
        self._check_frames(position, arm, place)
        if any(axis.value is None for axis in arm.axes):
            self._log.add(
                FindingKind.UNTAUGHT,
                f"P[{number}] was never taught (********): the controller stops there",
                place,
            )
            return None
        return arm

    def _check_frames(self, position: Position, arm: GroupPosition, place: Place) -> None:
        uframe, utool = self._selection(_FRAME), self._selection(_TOOL)
        self._frames[
            uframe if arm.uframe is None else arm.uframe, utool if arm.utool is None else arm.utool
        ] = None
        for name, taught, number in (("UF", arm.uframe, uframe), ("UT", arm.utool, utool)):
            if taught is not None and number is not None and taught != number:
                self._log.add(
                    FindingKind.FRAME_CONFLICT,
                    f"P[{position.number}] was taught in {name} {taught}, but {number} is "
                    "selected: the controller stops there (INTP-251, INTP-253)",
                    place,
                )

    def _joints(
        self, position: Position, arm: GroupPosition, place: Place, known: bool
    ) -> FloatArray | None:
        """Joints of a taught position [rad]; None where the frames that it needs are not known."""
        if arm.is_joint:
            return position.joints
        frame = self._pose(_FRAME, arm.uframe)
        tool = self._pose(_TOOL, arm.utool)
        if frame is None or tool is None or not known:
            self._log.add(
                FindingKind.FRAME_SELECTION,
                f"where P[{position.number}] lies is not known: only user frame "
                f"{self._expected[_FRAME].number} and tool {self._expected[_TOOL].number} are",
                place,
                key="unknown position",
            )
            return None
        frame_pose, frame_is_expected = frame
        tool_pose, tool_is_expected = tool
        key = (place.file, position.number, frame_is_expected, tool_is_expected)
        if key not in self._solved:
            found = posture(self._robot, frame_pose, tool_pose, position, place)
            self._solved[key] = (found.joints, found.doubt)
        joints, doubt = self._solved[key]
        if doubt:
            self._log.add(
                FindingKind.CONFIGURATION, f"P[{position.number}] is not certain: {doubt}", place
            )
        return joints

    def _pose(self, what: str, taught: int | None) -> tuple[FloatArray, bool] | None:
        """Pose in which a position counts and whether it is the expected one; None: not known."""
        expected = self._expected[what]
        number = taught
        if number is None:
            number = self._selection(what) if what in self._selected else expected.number
        if number == expected.number:
            return expected.pose, True
        # Frame 0 is the robot's own and tool 0 the flange.
        return (rigid(), False) if number == 0 else None


def _creation(attributes: Mapping[str, str]) -> tuple[str, str]:
    """Date and time of the CREATE entry, under whatever name, or two empty texts."""
    for value in (attributes.get("CREATE", ""), *attributes.values()):
        found = _STAMP.fullmatch(value)
        if found is not None:
            return found[1], found[2]
    return "", ""
