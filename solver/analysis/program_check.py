"""Named checks of a program's joint positions against its problem, on the nominal model.

Nothing of the plan is trusted: positions come from the program alone, and path, limits and
clearances are computed from them again. A check that cannot be completed has failed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solver.candidates.generate import touch_numbers
from solver.candidates.postures import PostureChecks, check_postures
from solver.collision.kernels_scene import FREE, HIT, MARGIN_BROKEN, SELF_BROKEN
from solver.collision.scene import build_scene
from solver.kinematics.arm import forward
from solver.kinematics.jacobian import posture_manipulability
from solver.model.problem import PlanningProblem
from solver.model.settings import Sweep
from solver.transforms import FloatArray
from solver.units import DEG, DEG_PER_RAD, MM, MM_PER_M, TURN

POSITION_TOLERANCE = 0.05 * MM
"""How far a rounded position may lie from its waypoint: 3 decimals of a degree at 2 m reach."""

ANGLE_TOLERANCE = 0.01 * DEG
"""How far an angle of the tool may lie outside its range: six joints' rounding."""

LIMIT_TOLERANCE = 0.00051 * DEG
"""How far rounding may push a joint over its limit."""


@dataclass(frozen=True, slots=True)
class Check:
    """One verdict: `value` against `limit` in `unit`; `assumed` marks limits that are assumptions.

    `waypoint` is the number (from 0) of the worst position, where there is one.
    """

    name: str
    passed: bool
    value: float
    limit: float
    unit: str
    detail: str = ""
    waypoint: int | None = None
    assumed: bool = False

    def __str__(self) -> str:
        """The check as a line for people."""
        word = "ok    " if self.passed else "FAILED"
        limit = f"{self.limit:.4g}, assumed" if self.assumed else f"{self.limit:.4g}"
        text = f"{word} {self.name}: {self.value:.4g} {self.unit} (limit {limit})"
        return f"{text}, {self.detail}" if self.detail else text


def check_positions(
    problem: PlanningProblem, pendant: FloatArray, least_clearance: float
) -> tuple[Check, ...]:
    """All checks of a program's pendant joints (n, 6) [rad], one position per waypoint.

    `least_clearance` [m] is what every position has to keep: the safety distance, or what
    was accepted instead.
    """
    count = len(problem.toolpath)
    number = Check(
        "position count",
        len(pendant) == count,
        len(pendant),
        count,
        "positions",
        "one per waypoint of the cell's path, or of that given with --path",
    )
    if not number.passed:
        return (number,)
    return (
        number,
        *_path_checks(problem, pendant),
        *_joint_checks(problem, pendant),
        *_collision_checks(problem, pendant, least_clearance),
    )


def _worst(values: FloatArray) -> tuple[float, int]:
    """Largest value and its index; a value that is not a number is the worst."""
    index = int(np.argmax(np.where(np.isnan(values), np.inf, values)))
    return float(values[index]), index


def _path_checks(problem: PlanningProblem, pendant: FloatArray) -> list[Check]:
    poses = forward(problem.robot, pendant, problem.tool.tcp)
    wanted = problem.waypoint_poses
    away, at = _worst(np.linalg.norm(poses[:, :3, 3] - wanted[:, :3, 3], axis=1))
    checks = [
        Check(
            "path position",
            away <= POSITION_TOLERANCE,
            away * MM_PER_M,
            POSITION_TOLERANCE * MM_PER_M,
            "mm",
            f"at waypoint {at + 1}",
            at,
        )
    ]
    relative = np.swapaxes(wanted[:, :3, :3], 1, 2) @ poses[:, :3, :3]
    lead = np.arcsin(np.clip(-relative[:, 1, 2], -1.0, 1.0))
    lean = np.arctan2(relative[:, 0, 2], relative[:, 2, 2])
    spin = np.arctan2(relative[:, 1, 0], relative[:, 1, 1])
    settings = problem.settings
    for name, angle, sweep in (
        ("lean", lean, settings.lean),
        ("lead", lead, settings.lead),
        ("spin", spin, settings.spin),
    ):
        middle = (sweep.lower + sweep.upper) / 2.0
        angle = middle + np.remainder(angle - middle + np.pi, TURN) - np.pi  # noqa: PLW2901
        beyond, at = _worst(_outside(angle, sweep))
        checks.append(
            Check(
                f"{name} range",
                beyond <= ANGLE_TOLERANCE,
                beyond * DEG_PER_RAD,
                ANGLE_TOLERANCE * DEG_PER_RAD,
                "deg outside",
                f"{angle[at] * DEG_PER_RAD:.3f} deg at waypoint {at + 1}",
                at,
            )
        )
    return checks


def _outside(angle: FloatArray, sweep: Sweep) -> FloatArray:
    beyond: FloatArray = np.maximum(np.maximum(sweep.lower - angle, angle - sweep.upper), 0.0)
    return beyond


def _joint_checks(problem: PlanningProblem, pendant: FloatArray) -> list[Check]:
    limits = problem.joint_limits
    slack = np.minimum(pendant - limits[:, 0], limits[:, 1] - pendant)
    at, joint = np.unravel_index(int(np.argmin(slack)), slack.shape)
    least = float(slack[at, joint])
    low, high = problem.robot.elbow_limits
    sums = pendant[:, 1] + pendant[:, 2]
    elbow = np.minimum(sums - low, high - sums)
    bent = int(np.argmin(elbow))
    measure = posture_manipulability(problem.robot, pendant)
    flat = int(np.argmin(measure))
    eta = problem.settings.manipulability
    return [
        Check(
            "joint limits",
            least >= -LIMIT_TOLERANCE,
            least * DEG_PER_RAD,
            0.0,
            "deg inside",
            f"J{joint + 1} at waypoint {at + 1}",
            int(at),
        ),
        Check(
            "elbow bound",
            bool(elbow[bent] >= -LIMIT_TOLERANCE),
            float(elbow[bent]) * DEG_PER_RAD,
            0.0,
            "deg inside",
            f"J2+J3 at waypoint {bent + 1}",
            bent,
            assumed=True,
        ),
        Check(
            "singularity",
            bool(measure[flat] > eta),
            float(measure[flat]),
            eta,
            "m^3",
            f"manipulability at waypoint {flat + 1}",
            flat,
        ),
    ]


def _collision_checks(
    problem: PlanningProblem, pendant: FloatArray, least_clearance: float
) -> list[Check]:
    scene = build_scene(problem)
    found = check_postures(problem.robot, scene, pendant, touch_numbers(problem, scene))
    names = {
        MARGIN_BROKEN: "near and contact bodies",
        SELF_BROKEN: "robot against itself",
    }
    checks = [_clearance_check(found, least_clearance)]
    for status, name in names.items():
        broken = np.flatnonzero(found.status == status)
        detail = f"first at waypoint {broken[0] + 1}" if len(broken) else "every margin kept"
        if status == SELF_BROKEN and problem.settings.self_margin is None:
            detail = "NOT CHECKED, the cell leaves these pairs out"
        first = int(broken[0]) if len(broken) else None
        checks.append(
            Check(name, not len(broken), len(broken), 0, "positions too close", detail, first)
        )
    return checks


def _clearance_check(found: PostureChecks, least_clearance: float) -> Check:
    known = np.isin(found.status, (FREE, HIT)) & ~np.isnan(found.clearance)
    clearance = np.where(known, found.clearance, np.inf)
    at = int(np.argmin(clearance))
    least = float(clearance[at])
    sound = bool(known.all()) and least >= least_clearance and least > 0.0
    one, other = found.bodies[at]
    return Check(
        "clearance",
        sound,
        # Rounded down, so that what people read is never more than what was checked.
        float(np.floor(least * MM_PER_M * 10.0) / 10.0) if np.isfinite(least) else least,
        least_clearance * MM_PER_M,
        "mm",
        f"{one} against {other} at waypoint {at + 1}" if one else "no pair counts",
        at,
    )
