"""Named checks of rounded corners: what CNT cuts off leaves the motion that was checked.

How far a controller cuts a corner is not published; the figures are measured on another robot
of the family, so that these checks are estimates.
"""

from __future__ import annotations

import numpy as np

from solver.analysis.check import Check
from solver.analysis.position_checks import at
from solver.analysis.trace import NO_SPAN, ProgramTrace
from solver.motion.corners import corner_cut, turning
from solver.motion.feed import FeedPrediction
from solver.units import MM_PER_M


def corner_checks(trace: ProgramTrace, predicted: tuple[FeedPrediction, ...]) -> tuple[Check, ...]:
    """Corners of contact positions against the path's tolerance, all others against clearance."""
    count = len(trace.program.moves)
    cuts = [cut_at(trace, predicted, number) for number in range(count)]
    on_path = [n for n in range(count) if trace.span_of[n] != NO_SPAN]
    off_path = [n for n in range(1, count - 1) if trace.span_of[n] == NO_SPAN]
    path = _check("path at rounded corners (estimated)", trace, cuts, on_path)
    return (path, _check("links at rounded corners (estimated)", trace, cuts, off_path))


def _check(name: str, trace: ProgramTrace, cuts: list[float], which: list[int]) -> Check:
    """The corner that takes the largest share of what it may cut."""
    worst, share = None, 0.0
    for number in which:
        allowed = _allowed(trace, number)
        used = np.inf if allowed <= 0.0 < cuts[number] else cuts[number] / max(allowed, 1e-9)
        if used > share:
            worst, share = number, used
    if worst is None:
        limit = trace.problem.program.path_tolerance
        return Check(name, True, 0.0, limit * MM_PER_M, "mm", "no corner is rounded", assumed=True)
    allowed = max(_allowed(trace, worst), 0.0)
    return Check(
        name,
        share <= 1.0,
        cuts[worst] * MM_PER_M,
        allowed * MM_PER_M,
        "mm",
        f"at {at(trace, worst)}",
        trace.waypoint_of(worst),
        assumed=True,
    )


def _allowed(trace: ProgramTrace, number: int) -> float:
    """What a corner may cut [m]: on the path and beside the face its tolerance, else the clearance.

    The clearance is the least of the two moves that meet in it, less the declared accuracy.
    """
    moves = [one for one in (number - 1, number) if 0 <= one < len(trace.ways)]
    if trace.span_of[number] != NO_SPAN or any(trace.touch[one] >= 0 for one in moves):
        return trace.problem.program.path_tolerance
    accuracy = trace.problem.accuracy.total if trace.problem.accuracy is not None else 0.0
    return min(trace.sweeps[one].least for one in moves) - accuracy


def cut_at(trace: ProgramTrace, predicted: tuple[FeedPrediction, ...], number: int) -> float:
    """How far the corner at a position is cut [m], 0 where the robot stops."""
    cnt = trace.program.moves[number].cnt
    if cnt is None or not 0 < number < len(trace.program.moves) - 1:
        return 0.0
    angle = turning(trace.poses[number - 1 : number + 2, :3, 3])
    speed = max(predicted[number - 1].fastest, predicted[number].fastest)
    return corner_cut(angle, cnt, speed)
