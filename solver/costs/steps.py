"""What may change between neighbouring waypoints, and how a link between passes is weighed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solver.model.problem import PlanningProblem
from solver.transforms import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Gaps:
    """Rules of the n - 1 gaps between neighbouring waypoints.

    `weight` (n-1,) multiplies the joint cost, `steps` (n-1, 6) bounds the pendant's joints
    [rad], `lean` (n-1,) the lean [rad]; infinite where there is no bound.
    """

    weight: FloatArray
    steps: FloatArray
    lean: FloatArray

    @property
    def bounded(self) -> bool:
        """Whether any gap has a bound."""
        return bool(np.isfinite(self.steps).any() or np.isfinite(self.lean).any())


def gap_times(problem: PlanningProblem) -> FloatArray:
    """(n-1,) time from waypoint to waypoint at the asked feed [s]; nan over links."""
    toolpath = problem.toolpath
    number = toolpath.pass_index
    positions = toolpath.poses[:, :3, 3]
    distance = np.linalg.norm(np.diff(positions, axis=0), axis=1)
    feed = np.array([one.feed for one in toolpath.passes])[number[1:]]
    return np.where(number[1:] == number[:-1], distance / feed, np.nan)


def gaps(problem: PlanningProblem) -> Gaps:
    """Weights and bounds of all gaps of a problem."""
    rules = problem.settings.steps
    time = gap_times(problem)
    link = np.isnan(time)
    steps = np.where(link[:, None], rules.link_joints, rules.joints)
    if rules.at_feed:
        reachable = problem.robot.speeds * np.where(link, np.inf, time)[:, None]
        steps = np.minimum(steps, reachable)
    return Gaps(
        np.where(link, problem.settings.weights.link, 1.0),
        steps,
        np.where(link, np.inf, rules.lean),
    )
