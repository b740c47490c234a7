"""An existing FANUC .LS program as a path: its taught positions in the order of its moves."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from solver.errors import InputError, Place
from solver.io.importers.assembly import (
    Form,
    Part,
    PassRecord,
    PointRecord,
    agreed_frame,
    assemble,
    check_feed,
    check_row_limit,
)
from solver.io.importers.naming import shown
from solver.io.importers.options import ImportOptions
from solver.io.importers.source import Source
from solver.io.importers.words import read_event
from solver.io.ls_program import Motion, Position, ProgramFile
from solver.io.ls_reader import read_program
from solver.model.toolpath import Event, Frame, Role, Toolpath
from solver.transforms import FloatArray, rotation_from_wpr
from solver.units import MM

_SPEEDS: Final = {"mm/sec": MM, "cm/min": 10.0 * MM / 60.0, "inch/min": 25.4 * MM / 60.0}
"""Units of speeds along a line -> [m/s]."""

_JUMPS: Final = re.compile(r"(?:JMP|IF|SELECT|FOR|ENDFOR|ELSE)\b|.*\bJMP\b")
_DISPLACED: Final = re.compile(r"(?:V?OFFSET|TOOL_?OFFSET|INC|Q?SKIP)\b", re.IGNORECASE)
_EVENTS: Final[tuple[tuple[re.Pattern[str], str], ...]] = (
    (re.compile(r"DO[ \t]*\[[ \t]*([0-9]+)(?::[^\]]*)?\][ \t]*=[ \t]*(ON|OFF)"), "do:{0}={1}"),
    (re.compile(r"WAIT[ \t]+([0-9.]+)[ \t]*\(?sec\)?"), "dwell:{0}"),
    (re.compile(r"CALL[ \t]+SPINDLE_(ON|OFF)"), "spindle-{0}"),
    (re.compile(r"CALL[ \t]+([A-Z][A-Z0-9_]*)"), "call:{0}"),
)
"""Instructions that are events of a waypoint, and how they are written in a table."""


def import_ls(source: Source, options: ImportOptions) -> Toolpath:
    """Read the positions of an .LS program as a toolpath.

    Joint positions become TCP poses in fanuc_world through `options.robot` and `options.tool`.
    Cartesian positions are taken as they are: in fanuc_world for user frame 0; for another one
    `options.frame` must say which frame it is. A pass ends where the speed of the linear moves
    changes. Waypoints reached by joint moves are links where the program has linear moves too.

    Raises
    ------
    InputError
        With the line and column of the move, also for what makes the order of the moves
        uncertain (jumps, loops) or their targets unknown (registers, offsets, arcs).
    """
    program = read_program(source.data, source.file)
    stops = _stops(program)
    if not stops:
        raise InputError("the program has no moves, expected two or more", Place(source.file))
    frame = _frame(program, stops, options)
    return assemble(_passes(program, stops, options), frame, source.file, options)


@dataclass(slots=True)
class _Stop:
    """A position that a move reaches, and what happens there."""

    motion: Motion
    position: Position
    events: list[Event]

    def place(self, part: Part) -> Place:
        """Return the place of the move."""
        del part
        return self.motion.place


def _stops(program: ProgramFile) -> list[_Stop]:
    stops: list[_Stop] = []
    early: list[Event] = []
    for instruction in program.instructions:
        motion, text = instruction.motion, instruction.text
        if motion is not None:
            _check_motion(motion)
            events, early = early, []
            stops.append(_Stop(motion, program.positions[motion.positions[0]], events))
        elif _JUMPS.match(text):
            raise InputError(
                f"{shown(text)} changes the order of the moves, expected a program without jumps",
                instruction.place,
            )
        else:
            (stops[-1].events if stops else early).extend(_events(text, instruction.place))
    return stops


def _check_motion(motion: Motion) -> None:
    if motion.letter not in {"J", "L"}:
        raise InputError(
            f"a {motion.letter} move runs along a curve, expected J and L moves", motion.place
        )
    if not motion.positions:
        raise InputError(
            f"the move goes to {shown(' '.join(motion.targets))}, expected a position of the file",
            motion.place,
        )
    for option in motion.options:
        if _DISPLACED.match(option):
            raise InputError(
                f"the move may end elsewhere by {shown(option)}, expected the taught position",
                motion.place,
            )


def _events(text: str, place: Place) -> Iterator[Event]:
    for pattern, form in _EVENTS:
        found = pattern.fullmatch(text)
        if found:
            try:
                yield read_event(form.format(*found.groups()))
            except ValueError as error:
                raise InputError(f"the instruction {error}", place) from error
            return


def _frame(program: ProgramFile, stops: list[_Stop], options: ImportOptions) -> Frame:
    """Return the frame of all positions; user frames are known only by the import's word."""
    world = [_is_world(stop, program) for stop in stops]
    first = stops[0].motion.place
    if all(world):
        return agreed_frame(Frame.FANUC_WORLD, first, options)
    if any(world):
        other = stops[world.index(not world[0])]
        raise InputError(
            f"P[{other.position.number}] is in another frame than the positions before it, "
            f"expected one frame for the whole program",
            other.motion.place,
        )
    if options.frame is None:
        raise InputError(
            f"P[{stops[0].position.number}] is taught in a user frame other than 0, expected the "
            f"import to state which frame that is",
            first,
        )
    return options.frame


def _is_world(stop: _Stop, program: ProgramFile) -> bool:
    taught = stop.position.first
    frame = taught.uframe
    if frame is None:
        frame = stop.motion.uframe if stop.motion.uframe is not None else program.uframe
    return taught.is_joint or frame == 0


def _passes(
    program: ProgramFile, stops: list[_Stop], options: ImportOptions
) -> Iterator[PassRecord]:
    linear = any(stop.motion.letter == "L" for stop in stops)
    feeds = _feeds(stops, options)
    record: PassRecord | None = None
    pose_of = _pose_reader(options)
    for index, (stop, feed) in enumerate(zip(stops, feeds, strict=True)):
        check_row_limit(index + 1, stop.motion.place, options)
        if record is None or record.feed != feed:
            if record is not None:
                yield record
            number = 1 if record is None else int(record.name) + 1
            record = PassRecord(
                stop.motion.place, str(number), feed, options.touches, options.lean, options.lead
            )
        record.points.append(_point(stop, pose_of(stop), _role(stop, index, linear)))
    if record is not None:
        yield record


def _feeds(stops: list[_Stop], options: ImportOptions) -> list[float]:
    """Return the feed at every stop: a joint move takes that of the next linear move."""
    feeds: list[float] = []
    following: float | None = None
    for stop in reversed(stops):
        if stop.motion.letter == "L":
            following = _feed(stop, options)
        feeds.append(options.feed if following is None else following)
    feeds.reverse()
    linear = [index for index, stop in enumerate(stops) if stop.motion.letter == "L"]
    if linear:
        # Joint moves behind the last linear move stay in its pass.
        feeds[linear[-1] :] = [feeds[linear[-1]]] * (len(feeds) - linear[-1])
    return feeds


def _feed(stop: _Stop, options: ImportOptions) -> float:
    speed = stop.motion.speed
    if speed.value is None:
        return options.feed
    if speed.unit not in _SPEEDS:
        raise InputError(
            f"the linear move has the speed {shown(speed.text)}, expected mm/sec, cm/min or "
            f"inch/min",
            stop.motion.place,
        )
    feed = speed.value * _SPEEDS[speed.unit]
    try:
        check_feed(feed)
    except ValueError as error:
        raise InputError(f"the speed {error}", stop.motion.place) from error
    return feed


def _role(stop: _Stop, index: int, linear: bool) -> Role:
    if not linear or stop.motion.letter == "L":
        return Role.CONTACT
    return Role.LINK if index else Role.APPROACH


def _point(stop: _Stop, pose: FloatArray, role: Role) -> PointRecord:
    return PointRecord(
        places=stop,
        position=tuple(map(float, pose[:3, 3])),
        form=Form.MATRIX,
        orientation=tuple(map(float, pose[:3, :3].ravel())),
        role=role,
        events=tuple(stop.events),
    )


def _pose_reader(options: ImportOptions) -> Callable[[_Stop], FloatArray]:
    """Return a function that turns a taught position into the pose of the TCP."""

    def pose(stop: _Stop) -> FloatArray:
        position = stop.position
        for axis in position.first.extra:
            if axis.value != 0.0:
                raise InputError(
                    f"P[{position.number}] moves the external axis {axis.name}, expected 0",
                    position.place,
                )
        if position.first.is_joint:
            return _from_joints(position, options)
        transform = np.eye(4)
        transform[:3, 3], (w, p, r) = position.cartesian
        transform[:3, :3] = rotation_from_wpr(float(w), float(p), float(r))
        return transform

    return pose


def _from_joints(position: Position, options: ImportOptions) -> FloatArray:
    # Kinematics brings compiled kernels, which tables and Cartesian programs do without.
    from solver.kinematics.arm import forward  # noqa: PLC0415

    if options.robot is None or options.tool is None:
        raise InputError(
            f"P[{position.number}] is given in joints, expected the import to state the robot and "
            f"the tool",
            position.place,
        )
    return forward(options.robot, position.joints, options.tool.tcp)
