"""What the robot comes close to on a sampled way, and what is certain between the samples."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from solver.candidates.explain import collision_margins
from solver.candidates.postures import check_exact_postures
from solver.collision.kernels_scene import FREE, HIT
from solver.collision.scene import CollisionScene
from solver.model.problem import PlanningProblem
from solver.motion.trajectory import Way
from solver.transforms import FloatArray, IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Sweep:
    """A sampled way, checked at every sample.

    Attributes
    ----------
    clearance : (m,) array
        Clearance d [m]; nan where a near, contact or self pair is too close.
    status : (m,) array
        FREE, HIT, MARGIN_BROKEN or SELF_BROKEN of `kernels_scene`.
    bodies : tuple of m pairs of names
        The nearest two bodies of the clearance.
    points : (m, 2, 3) array
        Their nearest points in fanuc_world [m].
    least : float
        What the clearance is at least, on the whole way between the samples too [m]; -inf when
        a sample is broken, inf when no pair counts. Near, contact and self pairs are checked
        at the samples only.
    at : int
        The sample nearest to a body, or the first broken one.
    nearest : pair of names
        The two bodies there: of a broken sample those that are too close.
    broken : int or None
        The first sample that is not free.
    """

    clearance: FloatArray
    status: IntArray
    bodies: tuple[tuple[str, str], ...]
    points: FloatArray
    least: float
    at: int
    nearest: tuple[str, str]
    broken: int | None

    @property
    def free(self) -> bool:
        """Whether every sample is free."""
        return self.broken is None


def sweep(
    problem: PlanningProblem,
    scene: CollisionScene,
    way: Way,
    touch: int | NDArray[np.int64],
) -> Sweep:
    """Check every sample of a way, at its exact joints.

    `touch` is the number of the workpiece group that contact bodies may enter, -1 for none, of
    the whole way or of every sample (m,).

    Notes
    -----
    A clearance changes by no more than the moving bodies travel. Between neighbours with
    clearances d1, d2 that travel t apart it is at least (d1 + d2 - t) / 2.
    """
    groups = np.broadcast_to(np.asarray(touch, dtype=np.int64), len(way)).copy()
    found = check_exact_postures(problem.robot, scene, way.joints, groups)
    broken = np.flatnonzero(found.status != FREE)
    if len(broken):
        at, least = int(broken[0]), -np.inf
        nearest = found.bodies[at]
        if found.status[at] != HIT or not nearest[0]:
            nearest = _too_close(problem, scene, way.joints[at], int(groups[at]))
    else:
        at = int(np.argmin(found.clearance))
        least = float((found.clearance[1:] + found.clearance[:-1] - way.travel).min() / 2.0)
        nearest = found.bodies[at]
    known = (found.status == FREE) | (found.status == HIT)
    return Sweep(
        np.where(known, found.clearance, np.nan),
        found.status,
        found.bodies,
        found.points,
        least,
        at,
        nearest,
        int(broken[0]) if len(broken) else None,
    )


def _too_close(
    problem: PlanningProblem, scene: CollisionScene, joints: FloatArray, touch: int
) -> tuple[str, str]:
    """Names of the pair of bodies that breaks its margin by most, of any kind."""
    model = problem.robot.model_from_pendant @ joints
    _, rows = collision_margins(scene, np.array(problem.robot.arm_lengths), model, touch)
    worst = min(rows, key=lambda row: row.margin)
    one, _, other = worst.subject.partition(" and ")
    return one, other
