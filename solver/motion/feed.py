"""The speed of the TCP that joint speeds allow on a move, predicted against what its line asks.

Accelerations, the controller's own filters and rounded corners are left out; see `cycle_time`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solver.model.program import Move, SpeedUnit
from solver.model.robot import Robot
from solver.motion.trajectory import Way, sampled_way
from solver.transforms import FloatArray

SPEED_TOLERANCE = 1e-6
"""Share by which a joint may exceed its speed before a line counts as not held."""


@dataclass(frozen=True, slots=True, eq=False)
class FeedPrediction:
    """How fast a move runs.

    Attributes
    ----------
    slowest, fastest : float
        TCP speed along the move [m/s]; both 0 where the TCP rests.
    duration : float
        Time of the move without starting and stopping [s].
    joint : int
        The joint (0 to 5) that comes nearest to its largest speed.
    best : float
        The highest TCP speed that the joints allow [m/s]: the mean of a joint move at full
        joint speed, the constant one of a linear move; inf where nothing moves.
    holds : bool
        Whether the line's speed or time is reached with no joint above its largest speed.
    length : float
        Length of the TCP's way [m].
    load : float
        Share of its largest speed that the limiting joint would need for what the line says.
    joint_speeds : (6,) array
        Largest speed of each joint on the way [rad/s].
    """

    slowest: float
    fastest: float
    duration: float
    joint: int
    best: float
    holds: bool
    length: float
    load: float
    joint_speeds: FloatArray

    @property
    def mean(self) -> float:
        """Mean speed of the TCP [m/s]; 0 where nothing moves."""
        return self.length / self.duration if self.duration > 0.0 else 0.0


def predict(
    robot: Robot,
    tcp: FloatArray,
    reach: FloatArray,
    start: FloatArray,
    move: Move,
    *,
    way: Way | None = None,
    title: str = "the move",
) -> FeedPrediction:
    """Predict the speed of one move.

    Parameters
    ----------
    robot : Robot
        Whose geometry and joint speeds.
    tcp : (4, 4) array
        flange_from_tcp.
    reach : (6,) array
        From `body_reach` [m/rad].
    start : (6,) array
        Pendant joints where the move begins [rad].
    move : Move
        A speed in percent is the share of its largest speed that the joint with the longest
        time runs at; a time is kept unless a joint would have to be faster than it can; a
        linear move keeps its TCP speed except where a joint would have to be faster, and is
        slowed there. One that only turns the tool on the spot cannot keep a TCP speed.
    way : Way, optional
        The sampled move, where it is known already.
    title : str
        Subject of the sentence of an error.

    Raises
    ------
    MotionError
        The robot cannot make the move; see `sampled_way`.
    """
    if way is None:
        way = sampled_way(robot, tcp, reach, move.kind, start, move.joints, move=title)
    positions = way.poses(robot, tcp)[:, :3, 3]
    chords = np.linalg.norm(np.diff(positions, axis=0), axis=1)
    turns = np.abs(np.diff(way.joints, axis=0))
    part = np.diff(way.share)
    length = float(chords.sum())
    # What each interval takes at least, and what the whole takes at a constant pace.
    needed = turns / robot.speeds
    pace = needed / part[:, None]
    joint = int(np.argmax(pace.max(axis=0)))
    shortest = float(pace.max())
    asked = _asked_time(move, length, shortest)
    times = np.maximum(asked * part, needed.max(axis=1))
    moving = times > 0.0
    speeds = np.divide(chords, times, out=np.zeros_like(chords), where=moving)
    joint_speeds = np.divide(
        turns, times[:, None], out=np.zeros_like(turns), where=moving[:, None]
    ).max(axis=0)
    return FeedPrediction(
        slowest=float(speeds.min()),
        fastest=float(speeds.max()),
        duration=float(times.sum()),
        joint=joint,
        best=length / shortest if shortest > 0.0 else np.inf,
        holds=bool(shortest <= asked * (1.0 + SPEED_TOLERANCE)),
        length=length,
        load=shortest / asked if asked > 0.0 else 0.0,
        joint_speeds=joint_speeds,
    )


def _asked_time(move: Move, length: float, shortest: float) -> float:
    """Time that the line asks for [s]; `shortest` is that of full joint speed."""
    value = move.speed.value
    match move.speed.unit:
        case SpeedUnit.PERCENT:
            return 100.0 * shortest / value
        case SpeedUnit.LINEAR:
            return length / value
        case SpeedUnit.DURATION:
            return value
