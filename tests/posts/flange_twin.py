"""Forward kinematics of the M-20iA in a form of its own: a chain of elbows, in mm and degrees.

Nothing of the product is used. The figures are those of manual B-82874EN/06.
"""

from __future__ import annotations

import math

import numpy as np


def turn(axis: str, degrees: float):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return np.array(
        {
            "x": [[1, 0, 0], [0, c, -s], [0, s, c]],
            "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]],
            "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]],
        }[axis]
    )


def wpr(w: float, p: float, r: float):
    return turn("z", r) @ turn("y", p) @ turn("x", w)


def flange(j1, j2, j3, j4, j5, j6):
    """Position [mm] and rotation of the flange; J3 is the forearm's angle above the horizontal."""
    column = turn("z", j1)
    forearm = column @ turn("y", -j3)
    wrist = column @ np.array([150, 0, 0]) + column @ turn("y", j2) @ np.array([0, 0, 790])
    wrist = wrist + forearm @ np.array([835, 0, 250])
    hand = forearm @ turn("x", -j4) @ turn("y", -j5) @ turn("x", -j6)
    out = np.array([[0, 0, 1], [0, -1, 0], [1, 0, 0]])
    return wrist + hand @ np.array([100, 0, 0]), hand @ out


def angle_between(one, other) -> float:
    """Angle between two rotations [deg]."""
    return math.degrees(2 * math.asin(min(1.0, np.linalg.norm(one - other) / math.sqrt(8))))
