"""Whether a generated move is free: limits, clearance and margins along all of it, sampled."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from solver.candidates.explain import collision_margins
from solver.candidates.outcomes import Outcome
from solver.candidates.postures import check_exact_postures
from solver.collision.kernels_scene import FREE
from solver.collision.scene import NO_TOUCH, CollisionScene, build_scene
from solver.errors import Cancelled, RefusedError
from solver.model.problem import PlanningProblem
from solver.model.program import MotionKind
from solver.motion.sweep import sweep
from solver.motion.trajectory import SAMPLE_STEP, MotionError, Way, body_reach, sampled_way
from solver.progress import Monitor, SilentMonitor
from solver.transforms import FloatArray
from solver.units import DEG_PER_RAD, MM, MM_PER_M

COARSE_STEP = 20.0 * MM
"""Step of the first look at a move, which rejects but never accepts [m]."""

LIMIT_TOLERANCE = 1e-9
"""How far a joint may be outside its limits, for rounding [rad]."""


@dataclass(frozen=True, slots=True)
class Obstruction:
    """Why a move is not free: `reason` is a clause, `bodies` the two bodies or ''."""

    reason: str
    bodies: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class MoveChecker:
    """Checks generated moves of one problem against its scene.

    `clearance` [m] is what clearance bodies keep; `reach` (6,) comes from `body_reach`;
    the `monitor` is asked about cancelling before every move.
    """

    problem: PlanningProblem
    scene: CollisionScene
    reach: FloatArray
    clearance: float
    monitor: Monitor = field(default_factory=SilentMonitor)

    @classmethod
    def of(
        cls, problem: PlanningProblem, clearance: float, monitor: Monitor | None = None
    ) -> MoveChecker:
        """Build the scene of a problem and check moves in it."""
        scene = build_scene(problem)
        reach = body_reach(problem, scene)
        return cls(problem, scene, reach, clearance, monitor or SilentMonitor())

    def obstruction(
        self, start: FloatArray, end: FloatArray, kind: MotionKind, touch: int = NO_TOUCH
    ) -> Obstruction | None:
        """Why the move between pendant joints (6,) [rad] is not free, None when it is.

        `touch` numbers the workpiece group that contact bodies may touch. A coarse look comes
        first; a move is free only when its samples of 2 mm are.
        """
        self.refuse_cancelled()
        if beyond := self.beyond_limits(np.array([start, end])):
            return Obstruction(beyond)
        try:
            if kind is MotionKind.JOINT:
                coarse = self._way(start, end, kind, COARSE_STEP)
                if (found := self._first_block(coarse.joints, touch)) is not None:
                    return found
            return self._swept(self._way(start, end, kind, SAMPLE_STEP), touch)
        except MotionError as error:
            return Obstruction(str(error))

    def _way(self, start: FloatArray, end: FloatArray, kind: MotionKind, step: float) -> Way:
        robot, tcp = self.problem.robot, self.problem.tool.tcp
        return sampled_way(robot, tcp, self.reach, kind, start, end, step)

    def _swept(self, way: Way, touch: int) -> Obstruction | None:
        """Why a finely sampled way is not free."""
        if beyond := self.beyond_limits(way.joints):
            return Obstruction(beyond)
        swept = sweep(self.problem, self.scene, way, touch)
        if swept.broken is not None:
            return self.nearest_pair(way.joints[swept.broken], touch)
        if not swept.least >= self.clearance:
            return self._too_near(" and ".join(swept.nearest), swept.least)
        return None

    def refuse_cancelled(self) -> None:
        """Raise Cancelled when the monitor wants to stop."""
        if self.monitor.cancelled():
            raise Cancelled

    def free_postures(self, joints: FloatArray, spare: float = 0.0) -> NDArray[np.bool_]:
        """(k,) whether postures (k, 6) away from any face keep every distance.

        `spare` [m] is asked of clearances on top.
        """
        touch = np.full(len(joints), NO_TOUCH, np.int64)
        found = check_exact_postures(self.problem.robot, self.scene, joints, touch)
        enough = found.clearance >= self.clearance + spare
        free: NDArray[np.bool_] = (found.status == FREE) & enough
        return free

    def beyond_limits(self, joints: FloatArray) -> str:
        """What postures (k, 6) exceed, in words; '' when they are inside every limit."""
        limits = self.problem.joint_limits
        slack = np.minimum(joints - limits[:, 0], limits[:, 1] - joints)
        low, high = self.problem.robot.elbow_limits
        bend = joints[:, 1] + joints[:, 2]
        slack = np.column_stack([slack, np.minimum(bend - low, high - bend)])
        row, column = np.unravel_index(int(np.argmin(slack)), slack.shape)
        worst = float(slack[row, column])
        if worst >= -LIMIT_TOLERANCE:
            return ""
        name = f"J{column + 1}" if column < 6 else "J2+J3 (elbow)"
        return f"{name} exceeds its limit by {-worst * DEG_PER_RAD:.1f} deg"

    def nearest_pair(self, joints: FloatArray, touch: int) -> Obstruction:
        """The pair that lacks most of what it must keep in a posture (6,)."""
        robot = self.problem.robot
        model = robot.model_from_pendant @ joints
        _, margins = collision_margins(self.scene, np.array(robot.arm_lengths), model, touch)
        asked = self.clearance * MM_PER_M
        one = min(margins, key=lambda m: m.margin - asked * (m.filter is Outcome.COLLISION))
        if one.filter is Outcome.COLLISION:
            return self._too_near(one.subject, one.margin * MM)
        lack = f"{one.subject} lack {-one.margin:.1f} mm of their margin"
        return Obstruction(lack, one.subject)

    def _too_near(self, subject: str, gap: float) -> Obstruction:
        """Two clearance bodies, both named in `subject`, that come within `gap` [m]."""
        if gap <= 0.0:
            return Obstruction(f"{subject} collide", subject)
        shown = math.floor(gap * MM_PER_M * 10.0) / 10.0
        asked = f"{self.clearance * MM_PER_M:g} mm asked"
        return Obstruction(f"{subject} come within {shown:.1f} mm of each other ({asked})", subject)

    def refuse_posture(self, what: str, joints: FloatArray) -> None:
        """Raise RefusedError when a posture (6,) from which a link starts or ends is not free."""
        if beyond := self.beyond_limits(joints[None]):
            raise RefusedError(f"{what}: {beyond}")
        if not self.free_postures(joints[None])[0]:
            raise RefusedError(f"{what}: {self.nearest_pair(joints, NO_TOUCH).reason}")

    def _first_block(self, joints: FloatArray, touch: int) -> Obstruction | None:
        """The first of coarse samples (k, 6) that is not free."""
        numbers = np.full(len(joints), touch, np.int64)
        found = check_exact_postures(self.problem.robot, self.scene, joints, numbers)
        blocked = (found.status != FREE) | ~(found.clearance >= self.clearance)
        if not blocked.any():
            return None
        return self.nearest_pair(joints[int(np.argmax(blocked))], touch)
