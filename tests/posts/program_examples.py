"""A small but complete program on a real robot, for the tests of all posts."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

from ls_examples import move, program

from solver.catalog import load_robot
from solver.model.program import JointProgram, NumberedPose
from solver.model.robot import Robot
from solver.model.toolpath import Event, EventKind, Role
from solver.transforms import rigid

GOLDEN_FOLDER = Path(__file__).parent.parent / "golden"

# Turned by atan2(3, 4), so that no platform's sine decides about a digit.
FRAME = NumberedPose(
    1, rigid([[0.8, -0.6, 0.0], [0.6, 0.8, 0.0], [0.0, 0.0, 1.0]], (0.8, -0.15, 0.05)), True
)
TOOL = NumberedPose(
    2, rigid([[0.8, 0.0, -0.6], [0.0, 1.0, 0.0], [0.6, 0.0, 0.8]], (0.06, 0.0, 0.22))
)

HOME = [0, -30, -20, 0, -60, 0]
SPINDLE_ON, SPINDLE_OFF = Event(EventKind.SPINDLE_ON), Event(EventKind.SPINDLE_OFF)


@cache
def m20ia() -> Robot:
    return load_robot("fanuc_m20ia")


def output(number: str, state: float) -> Event:
    return Event(EventKind.DIGITAL_OUTPUT, number, state)


def grind_program(**what: Any) -> JointProgram:
    """Home, approach, lead-in, four contact moves of both kinds, lead-out, retract and home."""
    approach = [-29.211, -11.615, -40.214, -48.764, -54.664, 130.972]
    lead_in = [-28.297, -11.701, -44.205, -51.348, -51.582, 134.253]
    first = [-27.978, -12.238, -44.462, -51.618, -51.243, 134.328]
    second = [-27.316, -13.767, -44.11, -51.622, -51.09, 133.597]
    third = [-26.62, -15.319, -43.713, -51.6, -50.944, 132.796]
    lead_out = [-26.259, -16.326, -43.066, -51.307, -51.142, 131.935]
    retract = [-26.259, -18.501, -38.458, -48.611, -54.108, 127.496]
    dwell = Event(EventKind.DWELL, value=0.5)
    plain = program(
        move(HOME, percent=20, role=Role.LINK),
        move(
            approach,
            percent=20,
            role=Role.APPROACH,
            events=(SPINDLE_ON, output("3", 1.0), dwell),
        ),
        move(lead_in, linear=0.1, cnt=50, role=Role.LEAD_IN),
        move(first, linear=0.0125, cnt=100, waypoint=0),
        move(second, duration=1.6, cnt=100, waypoint=1),
        move(third, linear=0.02, waypoint=2, events=(Event(EventKind.CALL, "GAUGE"),)),
        move(lead_out, duration=0.5602, cnt=0, role=Role.LEAD_OUT),
        move(
            retract,
            linear=0.1,
            role=Role.LINK,
            events=(output("3", 0.0), SPINDLE_OFF),
        ),
        move(HOME, percent=20, role=Role.LINK),
        name="GRIND",
        comment="one pass",
        remarks=("CELL example", "BEAM HW250", "UF1 X800 Y-150 Z50 R36.87", "verify in T1"),
        frame=FRAME,
        tool=TOOL,
        payload=3,
    )
    return replace(plain, **what)
