"""An estimate of a program's cycle time, with accelerations that are assumptions."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from solver.model.program import Move
from solver.model.robot import Robot
from solver.model.toolpath import EventKind, Role
from solver.motion.feed import FeedPrediction
from solver.transforms import FloatArray, frozen


@dataclass(frozen=True, slots=True, eq=False)
class CycleTime:
    """An estimate [s]: contact moves, all other moves, and dwells.

    `accelerations` (6,) [rad/s^2] are those of the joints that it assumes. What programs that
    the program calls take is not known and left out.
    """

    grinding: float
    linking: float
    waiting: float
    accelerations: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "accelerations", frozen(self.accelerations, (6,)))

    @property
    def total(self) -> float:
        """The whole cycle [s]."""
        return self.grinding + self.linking + self.waiting


def cycle_time(robot: Robot, moves: Sequence[Move], feeds: Sequence[FeedPrediction]) -> CycleTime:
    """Estimate the time of moves whose speeds are predicted, from standstill to standstill.

    Notes
    -----
    The robot stops at FINE positions, at dwells and at the end, and runs from one move into the
    next everywhere else, at whatever corner. The pace of a move, 1 where it runs as predicted,
    changes by no more than the joints' accelerations allow at the move's joint speeds; a single
    move between stops is the trapezoid (or triangle) of its slowest joint.
    """
    sums = {True: 0.0, False: 0.0}
    first = 0
    for index, move in enumerate(moves):
        if _stops(move) or index == len(moves) - 1:
            run = slice(first, index + 1)
            times = _run_times(robot.accelerations, feeds[run])
            for one, time in zip(moves[run], times, strict=True):
                sums[one.role is Role.CONTACT] += time
            first = index + 1
    waiting = math.fsum(_dwell(move) for move in moves)
    return CycleTime(sums[True], sums[False], waiting, robot.accelerations)


def _stops(move: Move) -> bool:
    return move.cnt is None or _dwell(move) > 0.0


def _dwell(move: Move) -> float:
    return math.fsum(one.value for one in move.events if one.kind is EventKind.DWELL)


def _run_times(accelerations: FloatArray, feeds: Sequence[FeedPrediction]) -> list[float]:
    """Time of each move of a run that starts and ends at rest [s].

    The squared pace w changes within a move of nominal time T by at most 2 R T, with R the rate
    at which the pace may change [1/s].
    """
    rates = [_pace_rate(accelerations, feed.joint_speeds) for feed in feeds]
    gains = [
        2.0 * rate * feed.duration if feed.duration else 0.0
        for rate, feed in zip(rates, feeds, strict=True)
    ]
    pace = np.ones(len(feeds) + 1)
    pace[0] = pace[-1] = 0.0
    for index, gain in enumerate(gains):
        pace[index + 1] = min(pace[index + 1], pace[index] + gain)
    for index in reversed(range(len(gains))):
        pace[index] = min(pace[index], pace[index + 1] + gains[index])
    return [
        _ramped_time(feed.duration, rate, float(pace[index]), float(pace[index + 1]))
        for index, (feed, rate) in enumerate(zip(feeds, rates, strict=True))
    ]


def _pace_rate(accelerations: FloatArray, joint_speeds: FloatArray) -> float:
    """How fast the pace of a move may change [1/s]; inf where no joint moves."""
    moving = joint_speeds > 0.0
    return float((accelerations[moving] / joint_speeds[moving]).min(initial=np.inf))


def _ramped_time(duration: float, rate: float, before: float, after: float) -> float:
    """Time of a move of nominal `duration` between the squared paces at its ends [s]."""
    if duration == 0.0 or math.isinf(rate):
        return duration
    top = min(1.0, (before + after) / 2.0 + rate * duration)
    peak = math.sqrt(top)
    ramps = 2.0 * peak - math.sqrt(before) - math.sqrt(after)
    covered = (2.0 * top - before - after) / (2.0 * rate)
    return ramps / rate + max(duration - covered, 0.0) / peak
