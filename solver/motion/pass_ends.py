"""Where the tool comes onto the face and leaves it: lead point and withdrawn point of a pass end.

Both ends of a pass are the same thing seen in two directions: from the contact posture the TCP
goes outward over the lead point (the start of the lead-in, the end of the lead-out) to the
withdrawn point (the approach or retract position).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from solver.collision.scene import NO_TOUCH
from solver.errors import RefusedError
from solver.kinematics.arm import all_branches, forward
from solver.kinematics.configuration import branch_of
from solver.model.problem import PlanningProblem
from solver.model.program import MotionKind, rounded_joints
from solver.model.toolpath import Pass
from solver.motion.link_checks import MoveChecker
from solver.motion.withdrawal import withdrawal_direction
from solver.transforms import FloatArray, inverse
from solver.units import MM, MM_PER_M, TURN

LEAST_APPROACH = 10.0 * MM
"""Shortest distance between the lead point and the withdrawn point that is tried [m]."""

APPROACH_TRIES = 6
LEAD_TRIES = 5

SAME_POINT = 1e-6
"""Distance below which two contact positions give no direction of travel [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class PassEnd:
    """Pendant joints (6,) [rad] of a pass end; `lead` is None where there is no ramp."""

    withdrawn: FloatArray
    lead: FloatArray | None


@dataclass(frozen=True, slots=True, eq=False)
class EndGeometry:
    """One end of one pass.

    Attributes
    ----------
    number : int
        Of the pass, from 0; `arriving` tells its first end from its last.
    contact : (6,) array
        Pendant joints of the contact posture [rad]; `pose` (4, 4) is its fanuc_world_from_tcp.
    outward, away : (3,) arrays
        Unit vectors in fanuc_world: along the path away from the pass, and off the face.
    lead, height, approach : float
        Lengths of the link settings [m].
    """

    number: int
    name: str
    arriving: bool
    contact: FloatArray
    pose: FloatArray
    outward: FloatArray
    away: FloatArray
    lead: float
    height: float
    approach: float
    touch: int

    @property
    def title(self) -> str:
        """Words for the pass."""
        return f"pass {self.number + 1}" + (f" ({self.name})" if self.name else "")

    @property
    def words(self) -> tuple[str, str, str]:
        """Words for the lead point, the withdrawn point and the waypoint."""
        if self.arriving:
            return "lead-in start", "approach position", "first waypoint"
        return "lead-out end", "retract position", "last waypoint"


def end_geometry(
    checker: MoveChecker, number: int, contact: FloatArray, *, arriving: bool
) -> EndGeometry:
    """Geometry of an end of pass `number` with contact joints (k, 6) [rad]."""
    problem = checker.problem
    settings = problem.program.links
    if settings is None:
        raise ValueError("the cell states no links")
    one = problem.toolpath.passes[number]
    poses = forward(problem.robot, contact, problem.tool.tcp)
    if not arriving:
        poses, contact = poses[::-1], contact[::-1]
    return EndGeometry(
        number=number,
        name=one.name,
        arriving=arriving,
        contact=contact[0],
        pose=poses[0],
        outward=_outward(poses, arriving=arriving),
        away=withdrawal_direction(problem, one, settings.withdrawal, poses[0]),
        lead=settings.lead_in if arriving else settings.lead_out,
        height=settings.lead_in_height if arriving else settings.lead_out_height,
        approach=settings.approach,
        touch=_touch(checker, one),
    )


def _outward(poses: FloatArray, *, arriving: bool) -> FloatArray:
    """Direction from the end of a pass away from it, along its outermost segment."""
    away = poses[0, :3, 3] - poses[1:, :3, 3]
    lengths = np.linalg.norm(away, axis=1)
    apart = np.flatnonzero(lengths > SAME_POINT)
    if len(apart):
        outward: FloatArray = away[apart[0]] / lengths[apart[0]]
        return outward
    # A pass of one point: the tool's y axis is along the travel.
    travel: FloatArray = poses[0, :3, 1]
    return -travel if arriving else travel


def _touch(checker: MoveChecker, one: Pass) -> int:
    return checker.scene.touch_number(one.touches)


def find_end(checker: MoveChecker, geometry: EndGeometry) -> PassEnd:
    """The lead point and the withdrawn point of a pass end, free along all moves.

    The stated distances come first; then shorter approaches, then shorter leads.

    Raises
    ------
    RefusedError
        None of them is in reach and free; the sentence tells what stops the stated ones.
    """
    first: str | None = None
    for lead in _leads(geometry):
        try:
            return _end_with(checker, geometry, lead)
        except RefusedError as error:
            first = first or str(error)
    raise RefusedError(
        f"{geometry.title}: {first}; nor is a shorter approach or lead free. Try another "
        "withdrawal, lead or approach, less clearance on links, or another place for the path"
    )


def _leads(geometry: EndGeometry) -> Iterator[float]:
    """Lengths of the lead from the stated one down to 0; its height stays."""
    yield geometry.lead
    if geometry.lead > 0.0:
        yield from (geometry.lead * float(share) for share in np.linspace(1.0, 0.0, LEAD_TRIES)[1:])


def _approaches(geometry: EndGeometry) -> Iterator[float]:
    """Distances of approach from the stated one down to `LEAST_APPROACH`."""
    yield geometry.approach
    step = (geometry.approach - LEAST_APPROACH) / (APPROACH_TRIES - 1)
    if step > 0.0:
        yield from (geometry.approach - part * step for part in range(1, APPROACH_TRIES))


def _end_with(checker: MoveChecker, geometry: EndGeometry, lead: float) -> PassEnd:
    """The end with a lead of a given length and the longest approach that is free."""
    lead_word, withdrawn_word, waypoint = geometry.words
    pose, joints, inner = geometry.pose, geometry.contact, geometry.touch
    ramp = None
    if lead > 0.0 or geometry.height > 0.0:
        pose = _moved(pose, lead * geometry.outward + geometry.height * geometry.away)
        joints = ramp = posture_at(checker, pose, joints, lead_word)
        ends = f"between the {lead_word} and the {waypoint}"
        _refuse(checker, geometry, geometry.contact, ramp, inner, ends)
        inner = NO_TOUCH
    first: RefusedError | None = None
    for approach in _approaches(geometry):
        distance = f"{withdrawn_word}, withdrawn by {approach * MM_PER_M:g} mm,"
        try:
            target = _moved(pose, approach * geometry.away)
            withdrawn = posture_at(checker, target, joints, distance)
            ends = f"between the {distance} and the {waypoint if ramp is None else lead_word}"
            _refuse(checker, geometry, joints, withdrawn, inner, ends)
        except RefusedError as error:
            first = first or error
        else:
            return PassEnd(withdrawn, ramp)
    raise first or RefusedError(f"the {withdrawn_word} cannot be reached")


def _moved(pose: FloatArray, by: FloatArray) -> FloatArray:
    moved = pose.copy()
    moved[:3, 3] += by
    return moved


def _refuse(
    checker: MoveChecker,
    geometry: EndGeometry,
    inner: FloatArray,
    outer: FloatArray,
    touch: int,
    ends: str,
) -> None:
    """Raise RefusedError when the linear move between two joints of a pass end is not free."""
    start, end = (outer, inner) if geometry.arriving else (inner, outer)
    found = checker.obstruction(start, end, MotionKind.LINEAR, touch)
    if found is not None:
        raise RefusedError(f"{ends} {found.reason}")


def posture_at(checker: MoveChecker, pose: FloatArray, near: FloatArray, what: str) -> FloatArray:
    """Rounded joints (6,) at a TCP pose, in the branch and turns of the joints `near` it.

    Raises
    ------
    RefusedError
        Out of reach or outside the limits, and by how much.
    """
    robot, tcp = checker.problem.robot, checker.problem.tool.tcp
    branches = all_branches(robot, pose, tcp)
    branch = branch_of(robot, near)
    if not branches.found[branch]:
        beyond = beyond_reach(checker.problem, pose, branch)
        raise RefusedError(f"the {what} is out of reach by {beyond * MM_PER_M:.1f} mm")
    joints = branches.joints[branch]
    joints = rounded_joints(joints + TURN * np.round((near - joints) / TURN))
    if beyond_limit := checker.beyond_limits(joints[None]):
        raise RefusedError(f"at the {what} {beyond_limit}")
    return joints


def beyond_reach(problem: PlanningProblem, pose: FloatArray, branch: int) -> float:
    """How far the wrist centre of a TCP pose lies outside the shell that the arm reaches [m]."""
    a1, a2, a3, d4 = problem.robot.arm_lengths
    wrist = (pose @ inverse(problem.robot.flange @ problem.tool.tcp))[:3, 3]
    radius = float(np.hypot(wrist[0], wrist[1]))
    horizontal = (radius if branch < 4 else -radius) - a1
    distance = float(np.hypot(horizontal, wrist[2]))
    forearm = float(np.hypot(a3, d4))
    return max(abs(a2 - forearm) - distance, distance - a2 - forearm)
