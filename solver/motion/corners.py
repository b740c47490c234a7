"""Rounded corners: what CNT cuts off, estimated, and the CNT that keeps the path's tolerance.

How far a controller cuts a corner is not published; the figures are measured on another robot
of the family.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from solver.kinematics.arm import forward
from solver.model.problem import PlanningProblem
from solver.model.program import Move
from solver.transforms import FloatArray
from solver.units import MM

_CUT_SPEEDS = (0.0, 0.2, 0.5, 1.0)
_CUTS = (0.0, 1.9 * MM, 4.9 * MM, 11.1 * MM)
"""Measured speeds [m/s] and what CNT50 cuts from a right-angled corner there [m]."""

ROUNDINGS = (100, 75, 50, 25, 10)
"""CNT values that are tried, the largest first; FINE where all of them cut too much."""

USED_SHARE = 0.8
"""Share of the path's tolerance that a corner may take: the motion between takes the rest."""


def corner_cut(angle: float, cnt: int, speed: float) -> float:
    """How far a rounded corner passes by its position [m].

    Measured on an M-20iD/25 at right angles: CNT50 cuts 1.9, 4.9 and 11.1 mm at 200, 500 and
    1000 mm/s, and CNT100 about 2.4 times that. Taken as proportional to CNT below 50, and to
    the sine of half the change of direction (`angle` [rad]); faster than measured, as the speed.
    """
    at_fifty = float(np.interp(speed, _CUT_SPEEDS, _CUTS))
    if speed > _CUT_SPEEDS[-1]:
        at_fifty *= speed / _CUT_SPEEDS[-1]
    share = float(np.interp(cnt, (0.0, 50.0, 100.0), (0.0, 1.0, 2.4)))
    return float(at_fifty * share * np.sin(angle / 2.0) / np.sin(np.pi / 4.0))


def turning(corner: FloatArray) -> float:
    """Change of direction [rad] at the middle one of three points (3, 3); 0 where two coincide."""
    before, after = np.diff(corner, axis=0)
    lengths = float(np.linalg.norm(before)), float(np.linalg.norm(after))
    if min(lengths) == 0.0:
        return 0.0
    return float(np.arccos(np.clip(float(before @ after) / (lengths[0] * lengths[1]), -1.0, 1.0)))


def with_roundings(problem: PlanningProblem, moves: tuple[Move, ...]) -> tuple[Move, ...]:
    """The moves with every CNT no larger than the path's tolerance allows.

    Rounded corners lie on passes and their leads alone, where the feed is the speed.
    """
    if not moves:
        return moves
    tcp = forward(problem.robot, np.array([one.joints for one in moves]), problem.tool.tcp)
    feeds = np.array([one.feed for one in problem.toolpath.passes])
    numbers = problem.toolpath.pass_index
    limit = USED_SHARE * problem.program.path_tolerance
    rounded = list(moves)
    for row in range(1, len(moves) - 1):
        move = moves[row]
        if not move.cnt or move.waypoint is None:
            continue
        angle = turning(tcp[row - 1 : row + 2, :3, 3])
        feed = float(feeds[numbers[move.waypoint]])
        fits = (one for one in ROUNDINGS if one <= move.cnt)
        cnt = next((one for one in fits if corner_cut(angle, one, feed) <= limit), None)
        rounded[row] = replace(move, cnt=cnt)
    return tuple(rounded)
