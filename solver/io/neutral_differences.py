"""What a CSV table or a JSON document that was read back says otherwise than its program."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from solver.io.csv_moves_reader import MoveRow
from solver.io.posts.post import ANGLE_TOLERANCE, POSITION_TOLERANCE
from solver.kinematics.arm import forward
from solver.kinematics.configuration import config_string
from solver.model.program import JOINT_DECIMALS, JointProgram, Move, NumberedPose
from solver.model.robot import Robot
from solver.transforms import inverse, rotation_angle
from solver.units import DEG_PER_RAD, MM_PER_M

RELATIVE_SLACK = 1e-12
"""What metres written in millimetres and read again may cost."""


def program_differences(program: JointProgram, found: JointProgram) -> Iterator[str]:
    """Yield one sentence for every difference between two neutral programs."""
    for what, value, expected in (
        ("its name", found.name, program.name),
        ("its comment", found.comment, program.comment),
        ("its remarks", found.remarks, program.remarks),
        ("its date", found.date, program.date),
        ("its time", found.time, program.time),
        ("its payload schedule", found.payload, program.payload),
        ("its offset register", found.offset, program.offset),
    ):
        if value != expected:
            yield f"{what} reads {value!r} instead of {expected!r}"
    yield from _pose_differences("the user frame", found.frame, program.frame)
    yield from _pose_differences("the tool", found.tool, program.tool)
    if len(found.moves) != len(program.moves):
        yield f"it has {len(found.moves)} moves instead of {len(program.moves)}"
        return
    pairs = zip(program.moves, found.moves, strict=True)
    for number, (asked, move) in enumerate(pairs, start=1):
        yield from move_differences(number, asked, move)


def row_differences(program: JointProgram, rows: Sequence[MoveRow], robot: Robot) -> Iterator[str]:
    """Yield one sentence for every difference between a program and the rows of a table."""
    if len(rows) != len(program.moves):
        yield f"it has {len(rows)} moves instead of {len(program.moves)}"
        return
    frame_from_world = inverse(program.frame.pose)
    poses = frame_from_world @ forward(robot, program.joints, program.tool.pose)
    for number, (asked, row) in enumerate(zip(program.moves, rows, strict=True), start=1):
        yield from move_differences(number, asked, row.move)
        pose = poses[number - 1]
        off = float(np.linalg.norm(row.pose[:3, 3] - pose[:3, 3]))
        turned = rotation_angle(row.pose[:3, :3].T @ pose[:3, :3])
        if not (off <= POSITION_TOLERANCE and turned <= ANGLE_TOLERANCE):
            yield (
                f"move {number}: its pose is {off * MM_PER_M:.4f} mm and "
                f"{turned * DEG_PER_RAD:.4f} deg from where the joints put the TCP"
            )
        config = config_string(robot, asked.joints)
        if row.config != config:
            yield f"move {number}: CONFIG reads {row.config!r} instead of {config!r}"


def move_differences(number: int, asked: Move, found: Move) -> Iterator[str]:
    """Yield one sentence for every difference between two moves; the source is none."""
    for what, value, expected in (
        ("motion", found.kind.value, asked.kind.value),
        ("CNT", found.cnt, asked.cnt),
        ("role", found.role.value, asked.role.value),
        ("waypoint", found.waypoint, asked.waypoint),
        ("events", found.events, asked.events),
        ("unit of the speed", found.speed.unit.value, asked.speed.unit.value),
    ):
        if value != expected:
            yield f"move {number}: its {what} reads {value!r} instead of {expected!r}"
    if abs(found.speed.value - asked.speed.value) > RELATIVE_SLACK * asked.speed.value:
        yield f"move {number}: its speed reads {found.speed} instead of {asked.speed}"
    degrees = np.round(found.joints * DEG_PER_RAD, 9)
    wanted = np.round(asked.joints * DEG_PER_RAD, JOINT_DECIMALS)
    for joint in np.flatnonzero(degrees != wanted):
        yield (
            f"move {number}: J{joint + 1} reads {degrees[joint]:.6f} deg instead of "
            f"{wanted[joint]:.6f} deg"
        )


def _pose_differences(what: str, found: NumberedPose, asked: NumberedPose) -> Iterator[str]:
    if (found.number, found.measured) != (asked.number, asked.measured):
        yield (
            f"{what} reads {found.number}, measured {found.measured}, instead of {asked.number}, "
            f"measured {asked.measured}"
        )
    off = np.abs(found.pose - asked.pose)
    if np.any(off > RELATIVE_SLACK * np.maximum(1.0, np.abs(asked.pose))):
        yield f"{what} reads another pose (off by {off.max():.2g})"
