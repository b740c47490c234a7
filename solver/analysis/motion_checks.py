"""Named checks of what happens between a program's positions: sampled, and they say so."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from solver.analysis.check import Check, down_mm, unfinished, worst
from solver.analysis.corner_checks import corner_checks
from solver.analysis.lift_checks import lift_check
from solver.analysis.position_checks import angle_near, angle_ranges, at, outside
from solver.analysis.trace import ProgramTrace
from solver.kinematics.configuration import configuration
from solver.model.program import MotionKind, Move
from solver.model.robot import Robot
from solver.motion.feed import FeedPrediction
from solver.units import DEG, DEG_PER_RAD, MM_PER_M

BETWEEN_ANGLE_TOLERANCE = 1.0 * DEG
"""How far an angle of the tool may leave its range between two positions."""

HALF_TURN = 180.0 * DEG


def motion_checks(trace: ProgramTrace, predicted: tuple[FeedPrediction, ...]) -> list[Check]:
    """All checks of the motion between the positions."""
    checks = [
        _deviation_check(trace),
        *corner_checks(trace, predicted),
        _angle_check(trace),
        _between_check(trace, "between positions (sampled)", trace.contact, 0.0),
    ]
    links = trace.problem.program.links
    if (~trace.contact).any():
        limit = links.clearance if links is not None else 0.0
        checks.append(_between_check(trace, "links (sampled)", ~trace.contact, limit))
    checks += [
        linear_check(trace.problem.robot, trace.program.moves),
        _branch_check(trace),
        lift_check(trace),
    ]
    return checks


def net_check(trace: ProgramTrace, position_clearance: float) -> Check:
    """What is left of every clearance when robot, workpiece and TCP are off as declared."""
    accuracy = trace.problem.accuracy
    if np.isnan(position_clearance) or any(not one.free for one in trace.sweeps):
        return unfinished("net margin", "mm", "a motion comes too close, see the checks above")
    least = min([position_clearance, *(one.least for one in trace.sweeps)])
    if accuracy is None:
        detail = "NO ACCURACY DECLARED by the cell, so nothing is taken off"
        return Check("net margin", least > 0.0, down_mm(least), 0.0, "mm", detail, assumed=True)
    robot, workpiece, tcp = (f"{part * MM_PER_M:g}" for part in accuracy.parts)
    net = least - accuracy.total
    return Check(
        "net margin",
        net > 0.0,
        down_mm(net),
        0.0,
        "mm",
        f"{down_mm(least):.1f} mm less robot {robot}, workpiece {workpiece} and TCP {tcp} mm as "
        "declared",
        assumed=True,
    )


def _deviation_check(trace: ProgramTrace) -> Check:
    """How far the moved TCP leaves the path, and how far it passes by a waypoint."""
    limit = trace.problem.program.path_tolerance
    found, move = 0.0, None
    for number, piece in trace.pieces.items():
        away = max(worst(piece.away)[0], piece.missed)
        if not away <= found:
            found, move = away, number
    where = "" if move is None else f"on the way to {at(trace, move + 1)}"
    return Check(
        "path between positions (sampled)",
        found <= limit,
        found * MM_PER_M,
        limit * MM_PER_M,
        "mm",
        where,
        None if move is None else trace.waypoint_of(move + 1),
    )


def _angle_check(trace: ProgramTrace) -> Check:
    found, detail, move = 0.0, "lean, lead and spin stay in their ranges", None
    for number, piece in trace.pieces.items():
        for column, (name, sweep) in enumerate(angle_ranges(trace)):
            beyond, row = worst(outside(angle_near(piece.angles[:, column], sweep), sweep))
            if not beyond <= found:
                angle = piece.angles[row, column] * DEG_PER_RAD
                detail = f"{name} {angle:.3f} deg on the way to {at(trace, number + 1)}"
                found, move = beyond, number
    return Check(
        "tool angles between positions (sampled)",
        found <= BETWEEN_ANGLE_TOLERANCE,
        found * DEG_PER_RAD,
        BETWEEN_ANGLE_TOLERANCE * DEG_PER_RAD,
        "deg outside",
        detail,
        None if move is None else trace.waypoint_of(move + 1),
    )


def _between_check(
    trace: ProgramTrace, name: str, which: np.ndarray[tuple[int], np.dtype[np.bool_]], limit: float
) -> Check:
    """Clearance along moves, and the margins of all other pairs."""
    least, move = np.inf, None
    for number in np.flatnonzero(which):
        swept = trace.sweeps[number]
        if swept.broken is not None:
            one, other = swept.nearest
            detail = f"{one} and {other} come too close on the way to {at(trace, int(number) + 1)}"
            waypoint = trace.waypoint_of(int(number) + 1)
            return Check(name, False, 0.0, limit * MM_PER_M, "mm", detail, waypoint)
        if not swept.least >= least:
            least, move = swept.least, int(number)
    if move is None:
        return Check(name, True, np.inf, limit * MM_PER_M, "mm", "no such move")
    one, other = trace.sweeps[move].nearest
    return Check(
        name,
        least > 0.0 and least >= limit,
        down_mm(least),
        limit * MM_PER_M,
        "mm",
        f"{one} against {other} on the way to {at(trace, move + 1)}",
        trace.waypoint_of(move + 1),
    )


def linear_check(robot: Robot, moves: Sequence[Move]) -> Check:
    """Neighbours of L moves: the same CONFIG letters, and J4 and J6 turn less than 180 deg.

    A linear move to a joint position goes the shortest joint way, whatever the joints say. The
    check needs no sampled motion: it also names the line of a program that cannot be followed.
    """
    worst_turn, where, broken = 0.0, "", False
    for number in range(1, len(moves)):
        if moves[number].kind is not MotionKind.LINEAR:
            continue
        one, other = moves[number - 1].joints, moves[number].joints
        before, after = configuration(robot, one), configuration(robot, other)
        same = (before.flip, before.up, before.front) == (after.flip, after.up, after.front)
        turn = float(np.abs(other - one)[[3, 5]].max())
        fault = not same or turn >= HALF_TURN
        # A broken line counts before any sound one, among those the one that turns most.
        if (fault, turn) > (broken, worst_turn):
            worst_turn, broken = turn, fault
            where = moves[number].source or f"position {number + 1}"
            if not same:
                where = f"CONFIG {before} before {after} at {where}"
    return Check(
        "linear moves",
        not broken,
        worst_turn * DEG_PER_RAD,
        180.0,
        "deg of J4 or J6",
        where or "no L moves",
    )


def _branch_check(trace: ProgramTrace) -> Check:
    """The posture's branch changes on links alone."""
    robot = trace.problem.robot
    changes, where = 0, "one CONFIG along each pass"
    for move in np.flatnonzero(trace.contact):
        joints = [trace.program.moves[move + step].joints for step in (0, 1)]
        one, other = (configuration(robot, row) for row in joints)
        if (one.flip, one.up, one.front) != (other.flip, other.up, other.front):
            changes += 1
            where = f"from {one} to {other} at {at(trace, int(move) + 1)}"
    return Check("branch along passes", not changes, changes, 0, "changes", where)
