"""Checks of the motion between a program's positions: speed of the joints, and a sampled sweep.

The controller interpolates J moves linearly in the joints. The sweep is sampled, and says so:
between two samples no point of the robot or the tool moves farther than `SAMPLE_STEP`.
"""

from __future__ import annotations

import numpy as np

from solver.analysis.program_check import Check
from solver.candidates.generate import touch_numbers
from solver.candidates.postures import check_exact_postures
from solver.collision.kernels_scene import FREE
from solver.collision.scene import CollisionScene, build_scene
from solver.costs.steps import gap_times
from solver.model.problem import PlanningProblem
from solver.transforms import FloatArray
from solver.units import MM, MM_PER_M

SAMPLE_STEP = 2.0 * MM
"""Farthest that any point moves between two samples [m]."""

SAMPLE_LIMIT = 20_000
"""Samples of one move above which its sweep counts as not checked, and so as failed."""

SPEED_TOLERANCE = 1e-6

TIME_TOLERANCE = 1.001e-3
"""How far the time of a move may be from distance / feed: times are whole milliseconds [s]."""


def check_motion(
    problem: PlanningProblem, pendant: FloatArray, durations: FloatArray
) -> tuple[Check, ...]:
    """Check the moves between pendant joints (n, 6) [rad].

    `durations` (n,) [s] is the time of the move to each position, nan where the program gives
    a share of the joint speed instead.
    """
    return (
        _feed_check(problem, durations),
        _speed_check(problem, pendant, durations),
        _sweep_check(problem, pendant),
    )


def _feed_check(problem: PlanningProblem, durations: FloatArray) -> Check:
    """Every move within a pass takes the time of its distance at the feed, to a millisecond."""
    expected = gap_times(problem)
    off = np.where(np.isnan(expected), 0.0, np.abs(durations[1:] - expected))
    if not off.size:
        return Check("feed", True, 0.0, TIME_TOLERANCE * 1e3, "ms")
    at = int(np.argmax(np.where(np.isnan(off), np.inf, off)))
    timed = not np.isnan(off[at])
    return Check(
        "feed",
        timed and bool(off[at] <= TIME_TOLERANCE),
        float(off[at]) * 1e3,
        TIME_TOLERANCE * 1e3,
        "ms beside distance / feed",
        f"at waypoint {at + 2}" if timed else f"no time is given for the move to waypoint {at + 2}",
        at + 1,
    )


def _speed_check(problem: PlanningProblem, pendant: FloatArray, durations: FloatArray) -> Check:
    if not np.isfinite(pendant).all():
        return Check("joint speed", False, float("nan"), 100.0, "%", "a joint is not a number")
    speed = np.abs(np.diff(pendant, axis=0)) / durations[1:, None]
    share = np.where(np.isnan(speed), 0.0, speed / problem.robot.speeds)
    if not share.size:
        return Check("joint speed", True, 0.0, 100.0, "% of the joint's speed")
    at, joint = np.unravel_index(int(np.argmax(share)), share.shape)
    worst = float(share[at, joint])
    advice = "" if worst <= 1.0 + SPEED_TOLERANCE else "; a lower feed or closer poses help"
    return Check(
        "joint speed",
        worst <= 1.0 + SPEED_TOLERANCE,
        100.0 * worst,
        100.0,
        "% of the joint's speed",
        f"J{joint + 1} on the way to waypoint {at + 2}{advice}",
        int(at) + 1,
    )


def body_reach(problem: PlanningProblem, scene: CollisionScene) -> FloatArray:
    """(6,) how far any point of a moving body can be from each joint's axis [m], rounded up."""
    a1, a2, a3, d4 = problem.robot.arm_lengths
    forearm = float(np.hypot(a3, d4))
    packed = scene.packed
    extent = np.linalg.norm(packed.moving.position, axis=1) + packed.radius
    carried = [float(extent[packed.frame >= link].max(initial=0.0)) for link in range(1, 7)]
    wrist = max(carried[3:])
    return np.array(
        [
            a1 + a2 + forearm + max(carried),
            a2 + forearm + max(carried[1:]),
            forearm + max(carried[2:]),
            wrist,
            wrist,
            wrist,
        ]
    )


def _sweep_check(problem: PlanningProblem, pendant: FloatArray) -> Check:
    name, unit = "between positions (sampled)", "mm"
    scene = build_scene(problem)
    reach = body_reach(problem, scene)
    touch = touch_numbers(problem, scene)
    if not np.isfinite(pendant).all():
        return Check(name, False, float("nan"), 0.0, unit, "a joint is not a number")
    moved = np.abs(np.diff(pendant, axis=0)) @ reach
    counts = np.maximum(np.ceil(moved / SAMPLE_STEP), 1.0).astype(np.int64)
    least, at, bodies = np.inf, 0, ("", "")
    for move, count in enumerate(counts):
        if count > SAMPLE_LIMIT:
            detail = f"the move to waypoint {move + 2} is too long to be checked"
            return Check(name, False, float("nan"), 0.0, unit, detail, move + 1)
        share = np.arange(count + 1) / count
        way = pendant[move] + share[:, None] * (pendant[move + 1] - pendant[move])
        groups = np.where(share < 0.5, touch[move], touch[move + 1]).astype(np.int64)
        found = check_exact_postures(problem.robot, scene, way, groups)
        broken = np.flatnonzero(found.status != FREE)
        if len(broken):
            one, other = found.bodies[broken[0]]
            what = f"{one} and {other}" if one else "a near, contact or self pair"
            detail = f"{what} come too close on the way to waypoint {move + 2}"
            return Check(name, False, 0.0, 0.0, unit, detail, move + 1)
        row = int(np.argmin(found.clearance))
        if found.clearance[row] < least:
            least, at, bodies = float(found.clearance[row]), move + 1, found.bodies[row]
    # Between two samples a point can be nearer by half of what it moves from one to the next.
    least -= SAMPLE_STEP / 2.0
    shown = float(np.floor(least * MM_PER_M * 10.0) / 10.0) if np.isfinite(least) else least
    detail = f"{bodies[0]} against {bodies[1]} before waypoint {at + 1}" if bodies[0] else ""
    return Check(name, least > 0.0, shown, 0.0, unit, detail, at)
