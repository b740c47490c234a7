"""The way of the robot from one position to the next, as the controller interpolates it.

A joint move is linear in the joints. A linear move carries the TCP along a straight line while
the tool turns about one constant axis, in the posture (branch) that it starts in. Ways are
sampled so finely that no moving body travels farther than a step from one sample to the next.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from solver.collision.scene import CollisionScene
from solver.errors import RefusedError
from solver.kinematics.arm import all_branches, forward
from solver.kinematics.configuration import branch_of, config_string
from solver.model.problem import PlanningProblem
from solver.model.program import MotionKind
from solver.model.robot import Robot
from solver.transforms import FloatArray, rotation_vector, rotations_about
from solver.units import DEG, DEG_PER_RAD, MM, TURN

SAMPLE_STEP = 2.0 * MM
"""Farthest that any point of a moving body travels between two samples [m]."""

SAMPLE_LIMIT = 20_000
"""Samples of one move above which it cannot be followed."""

ARRIVAL_TOLERANCE = 1e-3 * DEG
"""How far the joints that a linear move arrives at may be from the stated ones [rad]."""

JUMP_SHARE = 1e-7
"""Share of a linear move within which a body that still travels a step has jumped."""

HALF_TURN = 179.9 * DEG
"""Turn of the tool from which the axis of a linear move is not determined [rad]."""


class MotionError(RefusedError):
    """A move that the robot cannot make as stated; `share` (0 to 1) is where, if it is known."""

    def __init__(self, move: str, why: str, share: float | None = None) -> None:
        self.move, self.why, self.share = move, why, share
        super().__init__(f"{move} {why}")


@dataclass(frozen=True, slots=True, eq=False)
class Way:
    """A sampled move.

    Attributes
    ----------
    kind : MotionKind
    share : (m,) array
        Ascending from 0 to 1: of the joint motion, or of the straight line.
    joints : (m, 6) array
        Pendant joints [rad]; the first and the last row are those of the move.
    travel : (m - 1,) array
        What no point of a moving body exceeds from each sample to the next: the length of its
        way [m].
    """

    kind: MotionKind
    share: FloatArray
    joints: FloatArray
    travel: FloatArray

    def __len__(self) -> int:
        return len(self.share)

    def poses(self, robot: Robot, tcp: FloatArray) -> FloatArray:
        """(m, 4, 4) fanuc_world_from_tcp of every sample; `tcp` (4, 4) is flange_from_tcp."""
        return forward(robot, self.joints, tcp)


def sampled_way(
    robot: Robot,
    tcp: FloatArray,
    reach: FloatArray,
    kind: MotionKind,
    start: FloatArray,
    end: FloatArray,
    step: float = SAMPLE_STEP,
    *,
    move: str = "the move",
) -> Way:
    """Follow one move.

    Parameters
    ----------
    robot : Robot
        Whose geometry and pendant convention; limits are not looked at.
    tcp : (4, 4) array
        flange_from_tcp.
    reach : (6,) array
        From `body_reach` [m].
    kind : MotionKind
        How the controller interpolates.
    start, end : (6,) arrays
        Pendant joints [rad].
    step : float
        Farthest that a point of a moving body may travel between two samples [m].
    move : str
        Subject of the sentence of an error, such as 'the move to waypoint 7'.

    Raises
    ------
    MotionError
        A joint is not a number; the move needs more than `SAMPLE_LIMIT` samples; a linear move
        leaves the reach of its posture, passes a singularity, turns the tool by half a turn, or
        arrives in another posture or turn than stated.

    Notes
    -----
    A controller converts a linear move to a position in joints to Cartesian form and takes the
    shortest joint way, so what it arrives at follows from continuity and not from the joints
    that the position states.
    """
    ends = np.array([start, end], dtype=np.float64)
    if not np.isfinite(ends).all():
        raise MotionError(move, "has a joint that is not a number")
    if kind is MotionKind.JOINT or np.array_equal(ends[0], ends[1]):
        return _joint_way(kind, reach, ends, step, move)
    return _LinearMove(robot, tcp, ends, move).way(reach, step)


def _joint_way(
    kind: MotionKind, reach: FloatArray, ends: FloatArray, step: float, move: str
) -> Way:
    start, end = ends
    travel = float(np.abs(end - start) @ reach)
    if travel > step * (SAMPLE_LIMIT - 1):
        raise _too_long(move)
    count = max(1, int(np.ceil(travel / step)))
    share = np.arange(count + 1) / count
    joints = start + share[:, None] * (end - start)
    joints[-1] = end
    return Way(kind, share, joints, np.full(count, travel / count))


def _too_long(move: str) -> MotionError:
    return MotionError(move, f"is too long to be followed in {SAMPLE_LIMIT:,} samples")


class _LinearMove:
    """The straight line between two positions and the postures along it."""

    def __init__(self, robot: Robot, tcp: FloatArray, ends: FloatArray, move: str) -> None:
        self.robot, self.tcp, self.ends, self.move = robot, tcp, ends, move
        self.origin, self.target = forward(robot, ends, tcp)
        self.branch = branch_of(robot, ends[0])
        self.turn = rotation_vector(self.origin[:3, :3].T @ self.target[:3, :3])
        angle = float(np.linalg.norm(self.turn))
        if angle > HALF_TURN:
            turned = f"turns the tool by {angle * DEG_PER_RAD:.1f} deg"
            raise MotionError(move, f"{turned}, which leaves open about which axis")

    def poses(self, share: FloatArray) -> FloatArray:
        """(m, 4, 4) fanuc_world_from_tcp at shares (m,) of the line."""
        poses = np.tile(self.origin, (len(share), 1, 1))
        poses[:, :3, :3] = self.origin[:3, :3] @ rotations_about(self.turn, share)
        poses[:, :3, 3] += share[:, None] * (self.target[:3, 3] - self.origin[:3, 3])
        return poses

    def solved(self, share: FloatArray) -> FloatArray:
        """(m, 6) joints of the move's branch at shares (m,), each up to whole turns."""
        branches = all_branches(self.robot, self.poses(share), self.tcp)
        found: NDArray[np.bool_] = branches.found[:, self.branch]
        if not found.all():
            at = float(share[int(np.argmin(found))])
            why = f"leaves the reach of its posture {at:.0%} of the way"
            raise MotionError(self.move, why, at)
        joints: FloatArray = branches.joints[:, self.branch].copy()
        joints[share == 0.0] = self.ends[0]
        return joints

    def way(self, reach: FloatArray, step: float) -> Way:
        """Halve the intervals that are too wide until none is.

        A joint that turns back between two samples travels farther than their difference. For
        a curve that is a parabola over the interval that was halved, the excess in each half
        is at most half of what its middle differs from the mean of its ends.
        """
        length = float(np.linalg.norm(self.target[:3, 3] - self.origin[:3, 3]))
        span = max(length, float(np.abs(_wrapped(self.ends[1] - self.ends[0])) @ reach))
        count = int(np.clip(np.ceil(span / (4.0 * step)), 1, SAMPLE_LIMIT // 8))
        share = np.arange(count + 1) / count
        solved = self.solved(share)
        excess = np.zeros((count, 6))
        travel = np.full(count, np.inf)
        while (wide := travel > step).any():
            share, solved, excess = self._halved(share, solved, excess, wide)
            joints = np.unwrap(solved, axis=0)
            travel = (np.abs(np.diff(joints, axis=0)) + excess) @ reach
            self._refuse_jumps(share, joints, travel, step)
        self._check_arrival(joints[-1])
        joints[-1] = self.ends[1]
        return Way(MotionKind.LINEAR, share, joints, travel)

    def _halved(
        self, share: FloatArray, solved: FloatArray, excess: FloatArray, wide: NDArray[np.bool_]
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        if len(share) + np.count_nonzero(wide) > SAMPLE_LIMIT:
            raise _too_long(self.move)
        at = np.flatnonzero(wide)
        middle = (share[at] + share[at + 1]) / 2.0
        between = self.solved(middle)
        bend = (_wrapped(between - solved[at]) - _wrapped(solved[at + 1] - between)) / 2.0
        excess = excess.copy()
        excess[at] = np.abs(bend) / 2.0
        return (
            np.insert(share, at + 1, middle),
            np.insert(solved, at + 1, between, axis=0),
            np.repeat(excess, np.where(wide, 2, 1), axis=0),
        )

    def _refuse_jumps(
        self, share: FloatArray, joints: FloatArray, travel: FloatArray, step: float
    ) -> None:
        jump = (travel > step) & (np.diff(share) < JUMP_SHARE)
        if not jump.any():
            return
        at = int(np.argmax(jump))
        change = np.abs(joints[at + 1] - joints[at])
        joint = int(np.argmax(change))
        raise MotionError(
            self.move,
            f"passes a singularity {share[at]:.0%} of the way: J{joint + 1} would turn by "
            f"{change[joint] * DEG_PER_RAD:.1f} deg at once",
            float(share[at]),
        )

    def _check_arrival(self, reached: FloatArray) -> None:
        off = np.abs(reached - self.ends[1])
        if np.all(off <= ARRIVAL_TOLERANCE):
            return
        joint = int(np.argmax(off))
        stated, found = self.ends[1][joint] * DEG_PER_RAD, reached[joint] * DEG_PER_RAD
        letters = [config_string(self.robot, row) for row in (self.ends[1], reached)]
        raise MotionError(
            self.move,
            f"arrives at J{joint + 1} = {found:.3f} deg ({letters[1]}) by the shortest joint way, "
            f"not at the stated {stated:.3f} deg ({letters[0]})",
            1.0,
        )


def _wrapped(angle: FloatArray) -> FloatArray:
    """Differences of angles up to whole turns, to [-pi, pi]."""
    wrapped: FloatArray = angle - TURN * np.round(angle / TURN)
    return wrapped


def body_reach(problem: PlanningProblem, scene: CollisionScene) -> FloatArray:
    """(6,) how far any point of a moving body travels per turn of each joint [m/rad], rounded up.

    For pendant joints that change by dJ while no joint turns back, no point of a moving body of
    robot or tool, the TCP included, travels more than ``|dJ| @ body_reach``.

    Notes
    -----
    A turn of theta_i moves a point by at most its distance from the axis. J2 and J3 have
    parallel axes: what the forearm carries moves with d theta2 about the elbow's circle and
    turns by d(theta2 + theta3), which the pendant's coupled J3 keeps at zero when J2 moves.
    """
    packed = scene.packed
    local = np.vstack([packed.moving.position, (problem.robot.flange @ problem.tool.tcp)[:3, 3]])
    frame = np.append(packed.frame, 6)
    radius = np.append(packed.radius, 0.0)
    a1, a2, a3, d4 = problem.robot.arm_lengths

    def farthest(distance: FloatArray, carrier: NDArray[np.bool_]) -> float:
        return float((distance + radius)[carrier].max(initial=0.0))

    origin = np.linalg.norm(local, axis=1)
    axis = np.hypot(local[:, 0], local[:, 1])
    # From the J3 axis: a3 square to the J4 axis and d4 along it, then the point itself.
    forearm = max(
        farthest(np.hypot(a3 + axis, d4 + local[:, 2]), frame == 4),
        farthest(np.hypot(a3, d4) + origin, frame >= 5),
    )
    elbow = max(farthest(origin, frame == 3), forearm)
    of_model = np.array(
        [
            max(
                farthest(axis, frame == 1),
                a1 + farthest(origin, frame == 2),
                a1 + a2 + elbow,
            ),
            max(farthest(axis, frame == 2), a2),
            max(farthest(axis, frame == 3), forearm),
            max(farthest(axis, frame == 4), farthest(origin, frame >= 5)),
            farthest(origin, frame >= 5),
            farthest(axis, frame == 6),
        ]
    )
    turns = np.array(problem.robot.model_from_pendant)
    turns[2] += turns[1]
    reach: FloatArray = np.abs(turns).T @ of_model * (1.0 + 1e-9)
    return reach
