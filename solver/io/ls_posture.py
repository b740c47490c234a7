"""Joints of a Cartesian position of an .LS file: its pose, CONFIG letters and turn numbers."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import product
from typing import Final

import numpy as np

from solver.errors import InputError, Place
from solver.io.ls_program import Position
from solver.kinematics.arm import all_branches
from solver.kinematics.configuration import (
    TURN_JOINTS,
    Configuration,
    configuration,
    parse_configuration,
    turn_number,
)
from solver.kinematics.jacobian import jacobian
from solver.model.robot import JOINTS, Robot
from solver.transforms import FloatArray, inverse, rigid, rotation_from_wpr
from solver.units import DEG, MM, MM_PER_M, TURN

DECIMAL_STEP: Final = 0.001
"""Last decimal of a position in a file [mm or deg]."""

_LENGTH_DOUBT: Final = math.sqrt(3.0) * DECIMAL_STEP / 2.0 * MM
_ANGLE_DOUBT: Final = 3.0 * DECIMAL_STEP / 2.0 * DEG
"""How far rounded X Y Z may be off [m], and rounded W P R, whose axes may all agree [rad]."""

REACH_MARGIN: Final = 1e-9
"""How far inside the reach a wrist centre is put that rounding left outside [m]."""

LARGEST_DOUBT: Final = math.pi / 2.0
"""Bound of how far the decimals can move a joint [rad]; more means that it is not determined."""


@dataclass(frozen=True, slots=True, eq=False)
class Posture:
    """Joints (6,) of a position [rad], and why they are not certain ('' where they are)."""

    joints: FloatArray
    doubt: str


def posture(
    robot: Robot, frame: FloatArray, tool: FloatArray, position: Position, place: Place
) -> Posture:
    """Solve a Cartesian position.

    Parameters
    ----------
    robot : Robot
        Whose limits have no say: a joint beyond them is returned as the file means it.
    frame, tool : (4, 4) arrays
        fanuc_world_from_uframe and flange_from_tcp.
    position : Position
        Its group 1 must be Cartesian and taught.
    place : Place
        Of the motion that goes there, for errors.

    Raises
    ------
    InputError
        The CONFIG is none, or the arm cannot reach the position with it.

    Notes
    -----
    The letters F/N, U/D and T/B name one of the eight branches; the turn numbers choose among
    the representatives of J1, J4 and J6. J2, J3 and J5 have no turn number: J2 is the
    representative nearest to the middle of its limits, J3 that whose sum with J2 is nearest to
    the middle of the elbow's, J5 lies in (-180, 180] deg.
    """
    arm = position.arm
    wanted = parse_configuration((arm.config if arm else None) or "", position.place)
    place_in_frame, angles = position.cartesian
    pose = frame @ rigid(rotation_from_wpr(*angles.tolist()), place_in_frame)
    branch = 4 * (not wanted.front) + 2 * (not wanted.up) + wanted.flip
    branches = all_branches(robot, pose, tool)
    if not branches.found[branch]:
        branches = all_branches(robot, _reached(robot, pose, tool, position, wanted, place), tool)
    joints = branches.joints[branch].copy()
    doubt = joint_doubt(robot, joints, tool)
    joints[1] = _nearest(joints[1], float(robot.limits[1].mean()))
    joints[2] = _nearest(joints[2], float(robot.elbow_limits.mean()) - joints[1])
    for joint, turns in zip(TURN_JOINTS, wanted.turns, strict=True):
        joints[joint] = _turned(joints[joint], turns, doubt[joint])
    return Posture(joints, _doubt(robot, joints, doubt, wanted))


def joint_doubt(robot: Robot, joints: FloatArray, tool: FloatArray) -> FloatArray:
    """How far the rounding of a position's decimals can move each joint (6,) [rad], linearised."""
    try:
        joints_from_twist = np.linalg.inv(jacobian(robot, joints, tool))
    except np.linalg.LinAlgError:
        return np.full(JOINTS, LARGEST_DOUBT)
    of_lengths = np.linalg.norm(joints_from_twist[:, :3], axis=1) * _LENGTH_DOUBT
    of_angles = np.linalg.norm(joints_from_twist[:, 3:], axis=1) * _ANGLE_DOUBT
    doubt: FloatArray = np.minimum(of_lengths + of_angles, LARGEST_DOUBT)
    return doubt


def _nearest(angle: float, middle: float) -> float:
    return angle + TURN * round((middle - angle) / TURN)


def _turned(principal: float, turns: int, doubt: float) -> float:
    """Return the representative with that turn number, the smallest where the doubt leaves two."""
    around = [principal + TURN * (turns + off) for off in (-1, 0, 1)]
    meant = [
        angle
        for angle in around
        if turn_number(angle) == turns
        or turns in {turn_number(angle - doubt), turn_number(angle + doubt)}
    ]
    return min(meant, key=abs)


def _doubt(robot: Robot, joints: FloatArray, doubt: FloatArray, wanted: Configuration) -> str:
    """Say which other CONFIG the joints have within the doubt."""
    for signs in product((-1.0, 1.0), repeat=3):
        moved = joints + doubt * np.array([signs[0], signs[0], signs[1], *([signs[2]] * 3)])
        found = configuration(robot, moved)
        if found != wanted:
            return (
                f"rounding to {DECIMAL_STEP:g} mm and deg may turn its CONFIG '{wanted}' into "
                f"'{found}'"
            )
    return ""


def _reached(
    robot: Robot,
    pose: FloatArray,
    tool: FloatArray,
    position: Position,
    wanted: Configuration,
    place: Place,
) -> FloatArray:
    """Return the nearest pose in reach where rounding alone put it out of reach, or raise."""
    wrist_from_tcp = robot.flange @ tool
    wrist = (pose @ inverse(wrist_from_tcp))[:3, 3]
    a1, a2, a3, d4 = robot.arm_lengths
    forearm = math.hypot(a3, d4)
    shortest, longest = abs(a2 - forearm), a2 + forearm
    heading = math.atan2(wrist[1], wrist[0])
    radius = a1 if wanted.front else -a1
    shoulder = np.array([radius * math.cos(heading), radius * math.sin(heading), 0.0])
    distance = float(np.linalg.norm(wrist - shoulder))
    lever = float(np.linalg.norm(wrist_from_tcp[:3, 3]))
    if not shortest <= distance - _LENGTH_DOUBT - lever * _ANGLE_DOUBT <= longest:
        raise InputError(
            f"P[{position.number}] cannot be reached with CONFIG '{wanted}': the wrist centre is "
            f"{distance * MM_PER_M:.3f} mm from the J2 axis, the arm reaches "
            f"{shortest * MM_PER_M:.3f} to {longest * MM_PER_M:.3f} mm",
            place,
        )
    inside = longest - REACH_MARGIN
    return rigid(position=(wrist - shoulder) * (inside / distance - 1.0)) @ pose
