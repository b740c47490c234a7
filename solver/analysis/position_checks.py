"""Named checks of a program's positions: path, angles, limits, clearance, on the nominal model.

Nothing of the plan is trusted: positions come from the program alone, and path, limits and
clearances are computed from them again.
"""

from __future__ import annotations

import math

import numpy as np

from solver.analysis.check import Check, down_mm, worst
from solver.analysis.trace import ProgramTrace, tool_angles
from solver.candidates.postures import PostureChecks, check_exact_postures
from solver.collision.kernels_scene import FREE, HIT, MARGIN_BROKEN, SELF_BROKEN
from solver.kinematics.arm import all_branches
from solver.kinematics.configuration import branch_of
from solver.kinematics.jacobian import posture_manipulability
from solver.model.settings import Sweep
from solver.transforms import FloatArray, IntArray
from solver.units import DEG, DEG_PER_RAD, MM, MM_PER_M, TURN

POSITION_TOLERANCE = 0.05 * MM
"""How far a rounded position may lie from its waypoint: 3 decimals of a degree at 2 m reach."""

ANGLE_TOLERANCE = 0.01 * DEG
"""How far an angle of the tool may lie outside its range: six joints' rounding."""

LIMIT_TOLERANCE = 0.00051 * DEG
"""How far rounding may push a joint over its limit."""

ROUND_TRIP_TOLERANCE = 1e-3 * DEG
"""How far a position may come back after forward and inverse kinematics."""


def position_checks(trace: ProgramTrace, least_clearance: float) -> list[Check]:
    """All checks of the positions; `least_clearance` [m] is what contact positions must keep."""
    return [
        *_path_checks(trace),
        *_joint_checks(trace),
        _round_trip_check(trace),
        *_collision_checks(trace, least_clearance),
    ]


def contact_postures(trace: ProgramTrace) -> tuple[FloatArray, IntArray, list[str]]:
    """Joints (k, 6) [rad] of every contact position and passed waypoint, touch groups, places."""
    joints: list[FloatArray] = []
    touch: list[int] = []
    places: list[str] = []
    for span in trace.spans:
        group = trace.scene.touch_number(span.which.touches)
        for position in range(span.first, span.last + 1):
            joints.append(trace.program.moves[position].joints)
            touch.append(group)
            places.append(at(trace, position))
            passing = trace.pieces[position].passing if position in trace.pieces else ()
            for row in passing:
                joints.append(row)
                touch.append(group)
                places.append(f"a waypoint after {at(trace, position)}")
    return np.array(joints).reshape(-1, 6), np.array(touch, dtype=np.int64), places


def at(trace: ProgramTrace, position: int) -> str:
    """Words for a position: its waypoint where it has one, and its line."""
    waypoint = trace.waypoint_of(position)
    place = trace.place(position)
    return f"waypoint {waypoint + 1} ({place})" if waypoint is not None else place


def _path_checks(trace: ProgramTrace) -> list[Check]:
    distance = np.concatenate([span.distance for span in trace.spans])
    index = np.concatenate([np.arange(span.first, span.last + 1) for span in trace.spans])
    away, row = worst(distance)
    found = int(index[row])
    checks = [
        Check(
            "path position",
            away <= POSITION_TOLERANCE,
            away * MM_PER_M,
            POSITION_TOLERANCE * MM_PER_M,
            "mm",
            f"at {at(trace, found)}",
            trace.waypoint_of(found),
        )
    ]
    angles = np.concatenate([_position_angles(trace, number) for number in range(len(trace.spans))])
    for column, (name, sweep) in enumerate(angle_ranges(trace)):
        centred = angle_near(angles[:, column], sweep)
        beyond, row = worst(outside(centred, sweep))
        checks.append(
            Check(
                f"{name} range",
                beyond <= ANGLE_TOLERANCE,
                beyond * DEG_PER_RAD,
                ANGLE_TOLERANCE * DEG_PER_RAD,
                "deg outside",
                f"{centred[row] * DEG_PER_RAD:.3f} deg at {at(trace, int(index[row]))}",
                trace.waypoint_of(int(index[row])),
            )
        )
    return checks


def _position_angles(trace: ProgramTrace, number: int) -> FloatArray:
    """(k, 3) lean, lead, spin of the positions of one pass, against the waypoint they stand for."""
    span = trace.spans[number]
    reference = trace.problem.waypoint_poses[span.waypoint + span.segment, :3, :3]
    angles = tool_angles(reference, trace.poses[span.first : span.last + 1, :3, :3])
    for row in np.flatnonzero(span.share > 0.0):
        # Between waypoints the reference turns along; the samples of the move already know it.
        position = span.first + int(row)
        angles[row] = trace.pieces[position].angles[0]
    return angles


def angle_ranges(trace: ProgramTrace) -> tuple[tuple[str, Sweep], ...]:
    """The three angles of the tool with the ranges that the cell allows."""
    settings = trace.problem.settings
    return ("lean", settings.lean), ("lead", settings.lead), ("spin", settings.spin)


def angle_near(angle: FloatArray, sweep: Sweep) -> FloatArray:
    """Angles moved by whole turns as near to the middle of a range as possible [rad]."""
    middle = (sweep.lower + sweep.upper) / 2.0
    near: FloatArray = middle + np.remainder(angle - middle + np.pi, TURN) - np.pi
    return near


def outside(angle: FloatArray, sweep: Sweep) -> FloatArray:
    """How far angles lie outside a range [rad], 0 inside."""
    beyond: FloatArray = np.maximum(np.maximum(sweep.lower - angle, angle - sweep.upper), 0.0)
    return beyond


def _joint_checks(trace: ProgramTrace) -> list[Check]:
    """Limits at every position; between two of them J moves cannot leave what both keep."""
    problem = trace.problem
    joints = np.concatenate([trace.program.joints, *(way.joints for way in trace.ways)])
    index = np.concatenate(
        [
            np.arange(len(trace.program.moves)),
            *(np.full(len(way.joints), move + 1) for move, way in enumerate(trace.ways)),
        ]
    ).astype(np.int64)
    limits = problem.joint_limits
    slack = np.minimum(joints - limits[:, 0], limits[:, 1] - joints)
    row, joint = (int(one) for one in np.unravel_index(int(np.argmin(slack)), slack.shape))
    low, high = problem.robot.elbow_limits
    sums = joints[:, 1] + joints[:, 2]
    elbow = np.minimum(sums - low, high - sums)
    bent = int(np.argmin(elbow))
    return [
        Check(
            "joint limits",
            bool(slack[row, joint] >= -LIMIT_TOLERANCE),
            float(slack[row, joint]) * DEG_PER_RAD,
            0.0,
            "deg inside",
            f"J{joint + 1} at {at(trace, int(index[row]))}",
            trace.waypoint_of(int(index[row])),
        ),
        Check(
            "elbow bound",
            bool(elbow[bent] >= -LIMIT_TOLERANCE),
            float(elbow[bent]) * DEG_PER_RAD,
            0.0,
            "deg inside",
            f"J2+J3 at {at(trace, int(index[bent]))}",
            trace.waypoint_of(int(index[bent])),
            assumed=True,
        ),
        _singularity_check(trace),
    ]


def _singularity_check(trace: ProgramTrace) -> Check:
    """Manipulability while grinding: at contact positions and at the samples between them."""
    joints, _, places = contact_postures(trace)
    ways = [(trace.ways[move].joints, move) for move in np.flatnonzero(trace.contact)]
    measure = posture_manipulability(trace.problem.robot, joints)
    row = int(np.argmin(measure))
    least, where = float(measure[row]), places[row]
    for way, move in ways:
        between = posture_manipulability(trace.problem.robot, way)
        if float(between.min()) < least - 1e-12:
            least, where = float(between.min()), f"the move to {at(trace, int(move) + 1)}"
    eta = trace.problem.settings.manipulability
    at_positions = float(measure[row])
    return Check(
        "singularity",
        at_positions > eta and least > 0.99 * eta,
        least,
        eta,
        "m^3",
        f"manipulability at {where}",
    )


def _round_trip_check(trace: ProgramTrace) -> Check:
    """Every position comes back from its own pose through the inverse kinematics."""
    joints = trace.program.joints
    branches = all_branches(trace.problem.robot, trace.poses, trace.problem.tool.tcp)
    off = np.empty(len(joints))
    for row, own in enumerate(joints):
        branch = branch_of(trace.problem.robot, own)
        difference = branches.joints[row, branch] - own
        turned = np.abs(np.remainder(difference + math.pi, TURN) - math.pi)
        off[row] = turned.max() if branches.found[row, branch] else np.nan
    away, row = worst(off)
    return Check(
        "round trip",
        away <= ROUND_TRIP_TOLERANCE,
        away * DEG_PER_RAD,
        ROUND_TRIP_TOLERANCE * DEG_PER_RAD,
        "deg",
        f"forward and back at {at(trace, row)}",
        trace.waypoint_of(row),
    )


def _collision_checks(trace: ProgramTrace, least_clearance: float) -> list[Check]:
    joints, touch, places = contact_postures(trace)
    found = check_exact_postures(trace.problem.robot, trace.scene, joints, touch)
    names = {
        MARGIN_BROKEN: "near and contact bodies",
        SELF_BROKEN: "robot against itself",
    }
    checks = [_clearance_check(found, least_clearance, places)]
    for status, name in names.items():
        broken = np.flatnonzero(found.status == status)
        detail = f"first at {places[broken[0]]}" if len(broken) else "every margin kept"
        if status == SELF_BROKEN and trace.problem.settings.self_margin is None:
            detail = "NOT CHECKED, the cell leaves these pairs out"
        checks.append(Check(name, not len(broken), len(broken), 0, "positions too close", detail))
    return checks


def _clearance_check(found: PostureChecks, least_clearance: float, places: list[str]) -> Check:
    known = np.isin(found.status, (FREE, HIT)) & ~np.isnan(found.clearance)
    clearance = np.where(known, found.clearance, np.inf)
    row = int(np.argmin(clearance))
    least = float(clearance[row])
    one, other = found.bodies[row]
    detail = f"{one} against {other} at {places[row]}" if one else "no pair counts"
    if not known.all() and least >= least_clearance:
        # What is known would read as if it held for all positions.
        least = np.nan
        detail = f"not known where other pairs are too close, first at {places[np.argmin(known)]}"
    return Check(
        "clearance",
        bool(known.all()) and least >= least_clearance and least > 0.0,
        down_mm(least),
        least_clearance * MM_PER_M,
        "mm",
        detail,
    )
