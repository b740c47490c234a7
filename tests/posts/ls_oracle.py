"""An M-20iA and a writer of .LS positions that share no code with the product.

D-H table and limits: FANUC manual B-82874EN/06 as published with the ROS-Industrial M-20iA
description. CONFIG: the rules that 21 measured strings of a controller follow.
"""

from __future__ import annotations

import math

import numpy as np

A1, A2, A3, D4, FLANGE = 150.0, 790.0, 250.0, 835.0, 100.0
LIMITS = np.array([[-170, 170], [-100, 160], [-185, 273.12], [-200, 200], [-140, 140], [-270, 270]])
ELBOW = (-90.0, 190.0)


def turn(axis: int, degrees: float) -> np.ndarray:
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    first, second = [(1, 2), (2, 0), (0, 1)][axis]
    matrix = np.eye(4)
    matrix[first, first] = matrix[second, second] = c
    matrix[second, first], matrix[first, second] = s, -s
    return matrix


def shift(x: float, y: float, z: float) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


def flange(joints: np.ndarray) -> np.ndarray:
    """World pose of the flange [mm] by turning about the real axes, outward along the arm."""
    j1, j2, j3, j4, j5, j6 = joints
    pose = turn(2, j1) @ shift(A1, 0, 0) @ turn(1, j2) @ shift(0, 0, A2)
    # The forearm's angle above the horizontal is J3 whatever J2 is.
    pose = pose @ turn(1, -(j2 + j3)) @ shift(0, 0, A3)
    pose = pose @ turn(0, -j4) @ shift(D4, 0, 0) @ turn(1, -j5) @ turn(0, -j6)
    # The flange's z points forward and its x up.
    forward = np.eye(4)
    forward[:3, :3] = np.array([[0, 0, 1], [0, -1, 0], [1, 0, 0]], dtype=float)
    return pose @ shift(FLANGE, 0, 0) @ forward


def pose_of(xyzwpr: np.ndarray) -> np.ndarray:
    x, y, z, w, p, r = xyzwpr
    return shift(x, y, z) @ turn(2, r) @ turn(1, p) @ turn(0, w)


def xyzwpr_of(pose: np.ndarray) -> np.ndarray:
    w = math.atan2(pose[2, 1], pose[2, 2])
    p = math.asin(min(1.0, max(-1.0, -pose[2, 0])))
    r = math.atan2(pose[1, 0], pose[0, 0])
    return np.array([*pose[:3, 3], *np.degrees([w, p, r])])


def config(joints: np.ndarray) -> str:
    _, j2, j3, _, j5, _ = np.radians(joints)
    bend = (joints[1] + joints[2] + 180.0) % 360.0 - 180.0
    limit = math.degrees(math.atan2(D4, A3))
    radius = A1 + A2 * math.sin(j2) + D4 * math.cos(j3) - A3 * math.sin(j3)
    turns = [
        int(math.copysign(1, joints[i])) * math.floor((abs(joints[i]) + 180) / 360)
        for i in (0, 3, 5)
    ]
    letters = f"{'F' if j5 > 0 else 'N'} {'U' if limit - 180 < bend < limit else 'D'}"
    return f"{letters} {'T' if radius > 0 else 'B'}, " + ", ".join(map(str, turns))


def difference(one: np.ndarray, other: np.ndarray) -> tuple[float, float]:
    """Distance [mm] and angle [deg] between two poses."""
    rotation = one[:3, :3].T @ other[:3, :3]
    skew = np.array([rotation[2, 1], rotation[0, 2], rotation[1, 0]]) - np.array(
        [rotation[1, 2], rotation[2, 0], rotation[0, 1]]
    )
    angle = math.degrees(math.atan2(float(np.linalg.norm(skew)), float(np.trace(rotation)) - 1.0))
    return float(np.linalg.norm(one[:3, 3] - other[:3, 3])), angle


def joint_point(number: int, degrees: np.ndarray, uframe: int = 0, utool: int = 1) -> str:
    values = [f"J{axis}={value:10.3f} deg" for axis, value in enumerate(degrees, start=1)]
    return _point(number, f"\tUF : {uframe}, UT : {utool},\t\n", values)


def cartesian_point(
    number: int, xyzwpr: np.ndarray, letters: str, uframe: int = 0, utool: int = 1
) -> str:
    units = ["mm"] * 3 + ["deg"] * 3
    values = [
        f"{name} ={value:10.3f} {unit:>3}"
        for name, value, unit in zip("XYZWPR", xyzwpr, units, strict=True)
    ]
    return _point(number, f"\tUF : {uframe}, UT : {utool},\t\tCONFIG : '{letters}',\n", values)


def _point(number: int, head: str, values: list[str]) -> str:
    rows = [",".join(f"\t{value}" for value in row) for row in (values[:3], values[3:])]
    return f"P[{number}]{{\n   GP1:\n{head}{rows[0]},\n{rows[1]}\n}};\n"


def text(instructions: str, positions: str = "", name: str = "TEST") -> str:
    """A program of instructions, one a line, with all that the format needs around them."""
    # A line that begins with blanks and a colon goes on with the one before.
    ends = instructions.strip("\n").replace("\n    :", "\0    :").split("\n")
    lines = [f"{one:<40};\n".replace("\0", "\n") for one in ends]
    return (
        f'/PROG  {name}\n/ATTR\nCOMMENT\t\t= "by hand";\n'
        "CREATE\t\t= DATE 26-11-21  TIME 10:00:00;\nDEFAULT_GROUP\t= 1,*,*,*,*;\n/MN\n"
        f"{''.join(lines)}/POS\n{positions}/END\n"
    )


HOME = np.array([0.0, 0.0, 0.0, 0.0, -90.0, 0.0])


def random_joints(generator: np.random.Generator, count: int) -> np.ndarray:
    """Postures (count, 6) [deg] with three decimals inside the limits."""
    found: list[np.ndarray] = []
    while len(found) < count:
        joints = np.round(generator.uniform(LIMITS[:, 0], LIMITS[:, 1]), 3)
        if ELBOW[0] < joints[1] + joints[2] < ELBOW[1]:
            found.append(joints)
    return np.array(found)
