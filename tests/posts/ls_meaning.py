"""A program of a few lines, and what the interpreter makes of it."""

from __future__ import annotations

import numpy as np
from ls_oracle import HOME, joint_point, text

from solver.io.ls_findings import FindingKind
from solver.io.ls_interpreter import Interpretation, interpret
from solver.io.ls_reader import read_program
from solver.model.program import NumberedPose
from solver.model.robot import Robot

FRAMES = "UFRAME_NUM=0\nUTOOL_NUM=1\n"


def numbered(number: int, pose: np.ndarray | None = None) -> NumberedPose:
    """A frame or tool whose pose is given in millimetres."""
    if pose is None:
        return NumberedPose(number, np.eye(4))
    metres = np.array(pose)
    metres[:3, 3] /= 1000.0
    return NumberedPose(number, metres)


def meant(
    robot: Robot,
    source: str | bytes,
    frame: NumberedPose | None = None,
    tool: NumberedPose | None = None,
    offset: int | None = None,
) -> Interpretation:
    file = read_program(source, "folder/TEST.LS")
    return interpret(robot, frame or numbered(0), tool or numbered(1), file, offset=offset)


def of_lines(
    robot: Robot, lines: str, points: str | None = None, offset: int | None = None
) -> Interpretation:
    """What lines of a program mean when frames are selected above them."""
    if points is None:
        points = joint_point(1, HOME) + joint_point(2, HOME + 1)
    return meant(robot, text(FRAMES + lines, points), offset=offset)


def kinds(found: Interpretation) -> list[FindingKind]:
    return [one.kind for one in found.findings]


def with_group_two(point: str) -> str:
    return point.replace("};", "   GP2:\n\tUF : 0, UT : 4,\t\n\tJ1=     6.378 deg\n};")
