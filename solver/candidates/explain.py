"""Why a candidate is kept or rejected: every filter with its signed margin and its bodies."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from solver.candidates.generate import reference_from_wrist, touch_numbers
from solver.candidates.margins import FilterMargin, pair_margin
from solver.candidates.meshes import MeshChecker
from solver.candidates.outcomes import Outcome
from solver.collision.kernels_scene import all_distances, pair_threshold
from solver.collision.scene import CLEARANCE, CollisionScene, build_scene
from solver.errors import InputError
from solver.kinematics.arm import representative_capacity
from solver.kinematics.kernels_arm import (
    forward_frames,
    inverse_branches,
    manipulability,
)
from solver.kinematics.kernels_arm import representatives as representatives_kernel
from solver.model.problem import PlanningProblem
from solver.model.settings import BRANCHES, Turns
from solver.transforms import FloatArray
from solver.units import DEG_PER_RAD, MM_PER_M, TURN


@dataclass(frozen=True, slots=True, eq=False)
class Explanation:
    """Every filter of one candidate; `joints` (6,) pendant [rad], None when out of reach."""

    waypoint: int
    lean: float
    lead: float
    spin: float
    branch: int
    turn: int
    outcome: Outcome
    joints: FloatArray | None
    clearance: float
    filters: tuple[FilterMargin, ...]


def explain(
    problem: PlanningProblem,
    waypoint: int,
    lean: float,
    branch: int,
    *,
    lead: float = 0.0,
    spin: float = 0.0,
    turn: int = 0,
    scene: CollisionScene | None = None,
) -> Explanation:
    """Check one candidate completely, without stopping at the first filter that rejects it.

    Angles in [rad], on the grid or between. `turn` counts the representatives inside the
    limits; where there are none, the one nearest to the limits is explained.
    """
    if not 0 <= waypoint < len(problem.toolpath):
        raise InputError(f"waypoint {waypoint} is not in 0..{len(problem.toolpath) - 1}")
    if not 0 <= branch < BRANCHES:
        raise InputError(f"branch {branch} is not in 0..{BRANCHES - 1}")
    scene = scene or build_scene(problem)
    local = reference_from_wrist(problem, np.array([[lean, lead, spin]]))[0]
    wrist = problem.waypoint_poses[waypoint] @ np.vstack([local, [0.0, 0.0, 0.0, 1.0]])
    arm = np.array(problem.robot.arm_lengths)
    solved, found = np.empty((BRANCHES, 6)), np.empty(BRANCHES, np.bool_)
    inverse_branches(arm, np.ascontiguousarray(wrist[:3]), solved, found)
    filters = [_reach(problem, wrist[:3, 3], branch, bool(found[branch]))]
    joints = None
    clearance = math.nan
    if found[branch]:
        joints, turn = _representative(problem, solved[branch], turn)
        filters += [*_limits(problem, joints), _singularity(problem, arm, solved[branch])]
        touch = int(touch_numbers(problem, scene)[waypoint])
        clearance, collisions = collision_margins(scene, arm, solved[branch], touch)
        filters += collisions
    failed = [one.filter for one in filters if not one.passed]
    outcome = min(failed) if failed else Outcome.FEASIBLE
    return Explanation(
        waypoint, lean, lead, spin, branch, turn, outcome, joints, clearance, tuple(filters)
    )


def _reach(problem: PlanningProblem, wrist: FloatArray, branch: int, found: bool) -> FilterMargin:
    """How far the wrist centre is inside the shell that shoulder and forearm can reach [mm]."""
    a1, a2, a3, d4 = problem.robot.arm_lengths
    radius = math.hypot(wrist[0], wrist[1])
    horizontal = (radius if branch < BRANCHES // 2 else -radius) - a1
    distance = math.hypot(horizontal, wrist[2])
    forearm = math.hypot(a3, d4)
    margin = min(distance - abs(a2 - forearm), a2 + forearm - distance)
    return FilterMargin(Outcome.UNREACHABLE, found, margin * MM_PER_M, "mm", "wrist centre")


def _representative(
    problem: PlanningProblem, model: FloatArray, turn: int
) -> tuple[FloatArray, int]:
    robot = problem.robot
    principal = robot.pendant_from_model @ model
    principal = principal - TURN * np.ceil((principal - np.pi) / TURN)
    limits = np.ascontiguousarray(problem.joint_limits)
    space = np.empty((representative_capacity(problem.joint_limits), 6))
    only = problem.settings.turns is Turns.PRINCIPAL
    count = representatives_kernel(principal, limits, only, space)
    low, high = robot.elbow_limits
    kept = [row for row in space[:count] if low <= row[1] + row[2] <= high]
    if kept:
        turn = min(turn, len(kept) - 1)
        return kept[turn].copy(), turn
    shifts = principal + TURN * np.arange(-1, 2)[:, None]
    slack = np.minimum(shifts - limits[:, 0], limits[:, 1] - shifts)
    return shifts[np.argmax(slack, axis=0), np.arange(6)], 0


def _limits(problem: PlanningProblem, joints: FloatArray) -> list[FilterMargin]:
    limits = problem.joint_limits
    slack = np.minimum(joints - limits[:, 0], limits[:, 1] - joints)
    worst = int(np.argmin(slack))
    low, high = problem.robot.elbow_limits
    angle = float(joints[1] + joints[2])
    elbow = min(angle - low, high - angle)
    smallest = float(slack[worst])
    return [
        _angle_margin(smallest, f"J{worst + 1}"),
        _angle_margin(float(elbow), "J2+J3 (elbow)"),
    ]


def _angle_margin(slack: float, subject: str) -> FilterMargin:
    return FilterMargin(Outcome.JOINT_LIMIT, slack >= -1e-12, slack * DEG_PER_RAD, "deg", subject)


def _singularity(problem: PlanningProblem, arm: FloatArray, model: FloatArray) -> FilterMargin:
    margin = float(manipulability(arm, model)) - problem.settings.manipulability
    return FilterMargin(Outcome.SINGULAR, margin > 0.0, margin, "m^3", "manipulability")


def collision_margins(
    scene: CollisionScene, arm: FloatArray, model: FloatArray, touch: int
) -> tuple[float, list[FilterMargin]]:
    """Clearance d [m] and the tightest pair of each kind: clearance, margin, self.

    Margins in [mm]: the clearance itself, and for margin and self pairs the distance beyond
    what they must keep.
    """
    packed = scene.packed
    bodies, pairs = len(scene.moving), len(packed.self_pairs)
    fixed = np.full(packed.rule.shape, np.inf)
    among = np.full(pairs, np.inf)
    fixed_points = np.full((*packed.rule.shape, 2, 3), np.nan)
    among_points = np.full((pairs, 2, 3), np.nan)
    frames = np.empty((7, 3, 4))
    forward_frames(arm, model, frames)
    rotations, positions = np.empty((bodies, 3, 3)), np.empty((bodies, 3))
    all_distances(packed, frames, rotations, positions, fixed, among, fixed_points, among_points)
    rows = []
    counted = np.where(packed.rule == CLEARANCE, fixed, np.inf)
    near = np.full(fixed.shape, np.inf)
    for m, f in zip(*np.nonzero(packed.rule > CLEARANCE), strict=True):
        near[m, f] = fixed[m, f] - pair_threshold(packed, m, f, touch)
    for outcome, table in ((Outcome.COLLISION, counted), (Outcome.MARGIN, near)):
        if table.size and np.isfinite(table).any():
            m, f = np.unravel_index(int(np.argmin(table)), table.shape)
            subject = f"{scene.moving[m]} and {scene.fixed[f]}"
            rows.append(pair_margin(outcome, float(table[m, f]), subject, fixed_points[m, f]))
    clearance = float(counted.min()) if counted.size else math.inf
    if pairs:
        p = int(np.argmin(among))
        a, b = packed.self_pairs[p]
        subject = f"{scene.moving[a]} and {scene.moving[b]}"
        margin = float(among[p]) - packed.self_margin
        rows.append(pair_margin(Outcome.SELF_COLLISION, margin, subject, among_points[p]))
    if scene.meshes:
        clearance, rows = MeshChecker(scene).merge_margins(arm, model, touch, clearance, rows)
    return clearance, rows
