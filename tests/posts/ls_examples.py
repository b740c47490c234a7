"""Programs and .LS texts that the tests of the post and the reader share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from solver.model.program import (
    JointProgram,
    MotionKind,
    Move,
    NumberedPose,
    Speed,
    rounded_joints,
)
from solver.model.toolpath import Event, EventKind

GOLDEN = Path(__file__).parent.parent / "golden" / "groove_3.LS"


def move(
    degrees: Sequence[float],
    percent: float | None = None,
    duration: float | None = None,
    linear: float | None = None,
    **what: Any,
) -> Move:
    """A move to joints [deg], at 10 % where no time [s] and no TCP speed [m/s] is given."""
    joints = rounded_joints(np.radians(np.array(degrees, dtype=float)))
    if linear is not None:
        return Move(joints, Speed.linear(linear), MotionKind.LINEAR, **what)
    if duration is not None:
        return Move(joints, Speed.duration(duration), **what)
    return Move(joints, Speed.percent(10 if percent is None else percent), **what)


def program(*moves: Move, uframe: int = 0, utool: int = 1, **what: Any) -> JointProgram:
    plain = JointProgram(
        name="PROGRAM",
        comment="",
        remarks=(),
        frame=NumberedPose(uframe, np.eye(4)),
        tool=NumberedPose(utool, np.eye(4)),
        moves=moves or (move([0, 0, 0, 0, -90, 0]),),
        date="26-11-21",
        time="10:00:00",
    )
    return replace(plain, **what)


def golden_program() -> JointProgram:
    """The program whose file was written down by hand as groove_3.LS."""
    return program(
        move(
            [0, -30, 30, -0.0004, -90, 0.0002],
            percent=10,
            events=(Event(EventKind.SPINDLE_ON), Event(EventKind.DWELL, value=0.5)),
        ),
        move(
            [0.582, -0.398, -0.0, 179.9996, -120.25, 360],
            duration=0.25,
            cnt=100,
            events=(Event(EventKind.DIGITAL_OUTPUT, "3", 1.0),),
        ),
        move(
            [-170, -99.9994, 9.9999, -200, 0.0006, -0.001],
            duration=1.2341,
            cnt=0,
            events=(
                Event(EventKind.DIGITAL_OUTPUT, "3", 0.0),
                Event(EventKind.DWELL, value=12.341),
                Event(EventKind.DWELL, value=120.0),
            ),
        ),
        move(
            [1, -1, 0.999, -0.999, 9.999, 12.345],
            percent=100,
            events=(Event(EventKind.SPINDLE_OFF), Event(EventKind.CALL, "PART2")),
        ),
        name="GROOVE_3",
        comment="three moves",
        remarks=("CELL groove_hw300", "remark of exactly thirty-two cha"),
    )


POINT = """P[1]{
   GP1:
\tUF : 0, UT : 1,\t
\tJ1=     0.000 deg,\tJ2=   -30.000 deg,\tJ3=    30.000 deg,
\tJ4=     0.000 deg,\tJ5=   -90.000 deg,\tJ6=     0.000 deg
};
"""


def source(instructions: str = "   1:J P[1] 20% FINE    ;\n", positions: str = POINT) -> str:
    """A small file as other people write it: LF ends and hardly a header."""
    return (
        "/PROG  SMALL\n/ATTR\nDEFAULT_GROUP\t= 1,*,*,*,*;\n/MN\n"
        f"{instructions}/POS\n{positions}/END\n"
    )
