"""FANUC's CONFIG string 'F U T, 0, 0, 0': which of several postures reaches a pose."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from solver.errors import InputError, Place
from solver.model.robot import Robot
from solver.transforms import FloatArray
from solver.units import DEG_PER_RAD

TURN_JOINTS = (0, 3, 5)
"""Joints whose turns a CONFIG counts: J1, J4 and J6."""

HALF_TURN_TOLERANCE = 1e-9
"""How far from +-180 deg an angle still counts as +-180 [deg]; it covers rounding."""

_CONFIG = re.compile(
    r"\s*([FN])\s*([UD])\s*([TB])\s*,\s*([+-]?[0-9]{1,2})\s*,\s*([+-]?[0-9]{1,2})"
    r"\s*,\s*([+-]?[0-9]{1,2})\s*"
)


@dataclass(frozen=True, slots=True)
class Configuration:
    """A CONFIG as the controller keeps it.

    Attributes
    ----------
    flip : bool
        F (J5 > 0) rather than N.
    up : bool
        U (elbow up) rather than D.
    front : bool
        T (wrist in front of the J1 axis) rather than B.
    turns : tuple of three ints
        Turn numbers of J1, J4 and J6; 0 means within (-180, 180) deg.
    """

    flip: bool
    up: bool
    front: bool
    turns: tuple[int, int, int]

    def __str__(self) -> str:
        letters = f"{'F' if self.flip else 'N'} {'U' if self.up else 'D'} "
        return letters + ", ".join(["T" if self.front else "B", *map(str, self.turns)])


def turn_number(angle: float) -> int:
    """Count the turns of `angle` [rad] as the controller does.

    sign(a) floor((|a| + 180) / 360) in degrees: 0 within +-180 deg, and +-1 from there on.
    """
    degrees = abs(angle) * DEG_PER_RAD
    count = math.floor((degrees + 180.0 + HALF_TURN_TOLERANCE) / 360.0)
    return count if angle > 0.0 else -count


def configuration(robot: Robot, joints: ArrayLike) -> Configuration:
    """CONFIG of pendant joints (6,) [rad].

    Notes
    -----
    The elbow is up while the wrist centre has not passed the line through shoulder and elbow:
    for the M-20iA, -106.67 deg < J2 + J3 < 73.33 deg, the boundary being atan2(d4, a3). On a
    boundary (J5 = 0, stretched arm, wrist centre on the J1 axis) the letters are N, U and T.
    """
    pendant = np.asarray(joints, dtype=np.float64)
    shoulder, elbow = _wrist_measures(robot, pendant)
    one, four, six = (turn_number(float(pendant[joint])) for joint in TURN_JOINTS)
    return Configuration(
        flip=bool(pendant[4] > 0.0),
        up=elbow >= 0.0,
        front=shoulder >= 0.0,
        turns=(one, four, six),
    )


def config_string(robot: Robot, joints: ArrayLike) -> str:
    """CONFIG string of pendant joints (6,) [rad], such as 'N U T, 0, 0, 0'."""
    return str(configuration(robot, joints))


def parse_configuration(text: str, place: Place | None = None) -> Configuration:
    """Read a CONFIG string.

    Raises
    ------
    InputError
        The text is not three letters F/N, U/D, T/B and three turn numbers.
    """
    match = _CONFIG.fullmatch(text)
    if match is None:
        raise InputError(
            f"{text!r} is not a CONFIG: expected F or N, U or D, T or B and the turn numbers of "
            "J1, J4 and J6, such as 'N U T, 0, 0, 0'",
            place,
        )
    flip, up, front = match[1] == "F", match[2] == "U", match[3] == "T"
    return Configuration(flip, up, front, (int(match[4]), int(match[5]), int(match[6])))


def branch_of(robot: Robot, joints: ArrayLike) -> int:
    """Branch number 0 to 7 of pendant joints (6,) [rad], as the inverse kinematics counts."""
    pendant = np.asarray(joints, dtype=np.float64)
    shoulder, elbow = _wrist_measures(robot, pendant)
    theta5 = float(robot.model_from_pendant[4] @ pendant)
    return 4 * (shoulder < 0.0) + 2 * (elbow < 0.0) + (math.sin(theta5) < 0.0)


def choose(robot: Robot, candidates: Iterable[ArrayLike], wanted: Configuration) -> FloatArray:
    """First of several pendant joint vectors (6,) [rad] that has the wanted CONFIG.

    Within limits whose bound on J2 + J3 is narrower than a turn no two solutions of one pose
    share a CONFIG, except on a singularity.

    Raises
    ------
    InputError
        None has it; the sentence lists those that there are.
    """
    seen: list[str] = []
    for candidate in candidates:
        joints = np.array(candidate, dtype=np.float64)
        found = configuration(robot, joints)
        if found == wanted:
            return joints
        seen.append(f"'{found}'")
    there_are = "the pose has " + "; ".join(seen) if seen else "the pose has no solution"
    raise InputError(f"no solution has CONFIG '{wanted}' ({there_are})")


def _wrist_measures(robot: Robot, pendant: FloatArray) -> tuple[float, float]:
    """Signed distances of the wrist centre [m].

    First from the J1 axis (negative: behind it), then from the line through shoulder and
    elbow (negative: past it).
    """
    a1, a2, a3, d4 = robot.arm_lengths
    theta2, theta3 = (float(row @ pendant) for row in robot.model_from_pendant[1:3])
    theta23 = theta2 + theta3
    radius = a1 + a2 * math.sin(theta2) + a3 * math.sin(theta23) + d4 * math.cos(theta23)
    return radius, a3 * math.sin(theta3) + d4 * math.cos(theta3)
