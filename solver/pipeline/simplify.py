"""Fewer positions: a contact move may skip waypoints while everything that is asked still holds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solver.analysis.motion_checks import BETWEEN_ANGLE_TOLERANCE
from solver.analysis.position_checks import ANGLE_TOLERANCE, angle_near, outside
from solver.analysis.trace import Piece, follow
from solver.candidates.postures import check_exact_postures
from solver.collision.kernels_scene import FREE
from solver.collision.scene import CollisionScene, build_scene
from solver.costs.steps import gap_times
from solver.kinematics.arm import forward
from solver.kinematics.jacobian import posture_manipulability
from solver.model.problem import PlanningProblem
from solver.model.program import Move
from solver.model.program_settings import ContactMotion
from solver.model.toolpath import Pass
from solver.motion.corners import corner_cut
from solver.motion.feed import predict
from solver.motion.sweep import sweep
from solver.motion.trajectory import MotionError, Way, body_reach, sampled_way
from solver.pipeline.program_building import with_feed
from solver.progress import Monitor, SilentMonitor, checkpoint
from solver.transforms import FloatArray
from solver.units import MM

CORNER_SLACK = 0.01 * MM
"""What the decimals of a file may add to a rounded corner [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class _Context:
    """What every trial needs; `tolerance` [m] is how far the TCP may leave the path."""

    problem: PlanningProblem
    scene: CollisionScene
    reach: FloatArray
    tolerance: float
    clearance: float


def simplified(
    problem: PlanningProblem,
    passes: tuple[tuple[Move, ...], ...],
    tolerance: float,
    clearance: float,
    monitor: Monitor | None = None,
) -> tuple[tuple[Move, ...], ...]:
    """Drop positions of each pass that its motion does not need.

    `passes` holds the contact moves of each pass, one for each waypoint; `tolerance` [m] is how
    far the moved TCP may leave the path and pass by a waypoint, `clearance` [m] what every
    waypoint must keep, also one that is only passed. A passed waypoint also keeps what the
    nearest position does, which the program states as its least clearance.

    Notes
    -----
    From each kept position the farthest next one is sought by doubling and halving the number
    of skipped waypoints, each trial being followed as the checks follow it. Positions with
    events and the ends of a pass always stay, and no position is moved.
    """
    scene = build_scene(problem)
    kept_clearance = max(clearance, _least_clearance(problem, scene, passes))
    context = _Context(problem, scene, body_reach(problem, scene), tolerance, kept_clearance)
    times = np.nan_to_num(gap_times(problem))
    kept = []
    first = 0
    for one, moves in zip(problem.toolpath.passes, passes, strict=True):
        own = times[first : first + len(one) - 1]
        kept.append(_simplified_pass(context, one, first, moves, own, monitor or SilentMonitor()))
        first += len(one)
    return tuple(kept)


def _least_clearance(
    problem: PlanningProblem, scene: CollisionScene, passes: tuple[tuple[Move, ...], ...]
) -> float:
    """Least clearance of the positions that are free [m], -inf where none is."""
    joints = np.array([move.joints for moves in passes for move in moves])
    groups = [scene.touch_number(one.touches) for one in problem.toolpath.passes]
    touch = np.repeat(np.array(groups, dtype=np.int64), [len(moves) for moves in passes])
    found = check_exact_postures(problem.robot, scene, joints, touch)
    free = found.clearance[found.status == FREE]
    return float(free.min()) if len(free) else -np.inf


def _simplified_pass(
    context: _Context,
    which: Pass,
    first: int,
    moves: tuple[Move, ...],
    times: FloatArray,
    monitor: Monitor,
) -> tuple[Move, ...]:
    path = context.problem.waypoint_poses[first : first + len(which)]
    joints = np.array([move.joints for move in moves])
    tcp = forward(context.problem.robot, joints, context.problem.tool.tcp)[:, :3, 3]
    stops = [row for row in range(1, len(moves)) if row == len(moves) - 1 or moves[row].events]
    linear = context.problem.program.contact is ContactMotion.LINEAR
    kept = [moves[0]]
    before, at = 0, 0
    while at < len(moves) - 1:
        checkpoint(monitor, "simplify", first + at, len(context.problem.toolpath))
        limit = next(row for row in stops if row > at)

        def merged(row: int, at: int = at) -> Move:
            seconds = float(times[at:row].sum())
            return with_feed(moves[row], seconds, which.feed, linear=linear)

        def holds(row: int, at: int = at, before: int = before) -> bool:
            return _corners_hold(context.problem, which.feed, moves, tcp, before, at, row) and (
                _holds(context, which, path, moves[at].joints, at, row, merged(row))
            )

        best, step = at + 1, 2
        while best < limit and holds(min(at + step, limit)):
            best = min(at + step, limit)
            step *= 2
        low, high = best, min(at + step, limit + 1)
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (middle, high) if holds(middle) else (low, middle)
        kept.append(merged(low) if low > at + 1 else moves[low])
        before, at = at, low
    return tuple(kept)


def _corners_hold(
    problem: PlanningProblem,
    feed: float,
    moves: tuple[Move, ...],
    tcp: FloatArray,
    before: int,
    at: int,
    row: int,
) -> bool:
    """Whether the corners at both ends of a move from `at` to `row` may be rounded as they are.

    `before` is where the move ahead of it starts. What follows can still be the single move to
    the next waypoint; every longer one is tried against this one.
    """
    limit = problem.program.path_tolerance - CORNER_SLACK
    for start, corner, end in ((before, at, row), (at, row, row + 1)):
        cnt = moves[corner].cnt
        if cnt is None or start == corner or end == len(moves):
            continue
        one, other = tcp[corner] - tcp[start], tcp[end] - tcp[corner]
        lengths = np.linalg.norm(one) * np.linalg.norm(other)
        if lengths == 0.0:
            continue
        angle = float(np.arccos(np.clip(one @ other / lengths, -1.0, 1.0)))
        if corner_cut(angle, cnt, feed) > limit:
            return False
    return True


def _holds(
    context: _Context,
    which: Pass,
    path: FloatArray,
    start: FloatArray,
    low: int,
    high: int,
    move: Move,
) -> bool:
    """Whether one move may replace those from waypoint `low` to `high` of the pass."""
    problem = context.problem
    try:
        way = sampled_way(
            problem.robot, problem.tool.tcp, context.reach, move.kind, start, move.joints
        )
    except MotionError:
        return False
    piece = follow(problem, path, float(low), float(high), way)
    if max(float(piece.away.max()), piece.missed) > context.tolerance:
        return False
    return (
        _angles_hold(problem, piece)
        and _steps_hold(problem, piece, start, move)
        and _feed_holds(context, which, start, move, way)
        and _is_free(context, context.scene.touch_number(which.touches), piece, way)
    )


def _feed_holds(context: _Context, which: Pass, start: FloatArray, move: Move, way: Way) -> bool:
    problem = context.problem
    prediction = predict(problem.robot, problem.tool.tcp, context.reach, start, move, way=way)
    off = max(which.feed - prediction.slowest, prediction.fastest - which.feed)
    return prediction.holds and off <= problem.program.feed_tolerance * which.feed


def _is_free(context: _Context, touch: int, piece: Piece, way: Way) -> bool:
    """Clearance along the way and at the passed waypoints, and no singularity."""
    problem = context.problem
    if posture_manipulability(problem.robot, way.joints).min() <= problem.settings.manipulability:
        return False
    swept = sweep(problem, context.scene, way, touch)
    accuracy = problem.accuracy.total if problem.accuracy is not None else 0.0
    if not swept.free or swept.least <= accuracy:
        return False
    groups = np.full(len(piece.passing), touch, dtype=np.int64)
    passed = check_exact_postures(problem.robot, context.scene, piece.passing, groups)
    return bool((passed.status == FREE).all() and (passed.clearance >= context.clearance).all())


def _angles_hold(problem: PlanningProblem, piece: Piece) -> bool:
    settings = problem.settings
    ranges = (settings.lean, settings.lead, settings.spin)
    beyond = [outside(angle_near(piece.angles[:, i], one), one) for i, one in enumerate(ranges)]
    # The dropped waypoints keep their ranges as positions would, within what the motion allows.
    return max(float(one.max()) for one in beyond) <= BETWEEN_ANGLE_TOLERANCE - ANGLE_TOLERANCE


def _steps_hold(problem: PlanningProblem, piece: Piece, start: FloatArray, move: Move) -> bool:
    rules = problem.settings.steps
    lean = abs(float(piece.angles[-1, 0] - piece.angles[0, 0]))
    return bool(np.all(np.abs(move.joints - start) <= rules.joints)) and lean <= rules.lean
