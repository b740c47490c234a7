"""Named checks of speed: the feed that the joints allow, against the one that was asked."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from solver.analysis.check import Check
from solver.analysis.position_checks import at
from solver.analysis.trace import ProgramTrace
from solver.model.program import MotionKind, Move, SpeedUnit
from solver.model.toolpath import Role
from solver.motion.cycle_time import CycleTime, cycle_time
from solver.motion.feed import FeedPrediction, predict
from solver.units import DEG_PER_RAD, MM, MM_PER_M


@dataclass(frozen=True, slots=True)
class LineFeed:
    """The predicted TCP speed of one contact move, beside the asked feed [m/s].

    `move` is the number of the move's start and `place` where it stands; `held` says whether
    the prediction keeps the feed within the cell's tolerance.
    """

    move: int
    place: str
    asked: float
    prediction: FeedPrediction
    held: bool
    in_percent: bool


CLOSE = 2.0 * MM
"""Length of a move below which whole milliseconds and rounded joints change its speed [m]."""

_FEWER = "fewer positions help (--simplify TOL, or a coarser path)"


def predictions(trace: ProgramTrace) -> tuple[FeedPrediction, ...]:
    """Prediction for every move, the first one left out: nobody knows where it begins."""
    problem = trace.problem
    joints = trace.program.joints
    return tuple(
        predict(problem.robot, problem.tool.tcp, trace.reach, joints[number], move, way=way)
        for number, (move, way) in enumerate(zip(trace.program.moves[1:], trace.ways, strict=True))
    )


def line_feeds(trace: ProgramTrace, predicted: tuple[FeedPrediction, ...]) -> tuple[LineFeed, ...]:
    """Predicted against asked feed of every contact move."""
    tolerance = trace.problem.program.feed_tolerance
    lines = []
    for number in map(int, np.flatnonzero(trace.contact)):
        asked = trace.spans[trace.span_of[number]].which.feed
        prediction = predicted[number]
        off = max(asked - prediction.slowest, prediction.fastest - asked)
        unit = trace.program.moves[number + 1].speed.unit
        held = prediction.holds and off <= tolerance * asked
        place = at(trace, number + 1)
        lines.append(LineFeed(number, place, asked, prediction, held, unit is SpeedUnit.PERCENT))
    return tuple(lines)


def cycle_of(trace: ProgramTrace, predicted: tuple[FeedPrediction, ...]) -> CycleTime:
    """Estimated time from the first position to the last, dwells included."""
    contact = [False, *map(bool, trace.contact)]
    moves = [
        replace(move, role=Role.CONTACT if follows else Role.LINK)
        for move, follows in zip(trace.program.moves, contact, strict=True)
    ]
    return cycle_time(trace.problem.robot, moves[1:], predicted)


def feed_checks(trace: ProgramTrace, predicted: tuple[FeedPrediction, ...]) -> list[Check]:
    """Feed along the passes, joint speeds of all moves, and the cell's bounds of steps."""
    return [
        _feed_check(trace, line_feeds(trace, predicted)),
        _lead_check(trace, predicted),
        _link_speed_check(trace),
        _speed_check(trace, predicted),
        *_step_checks(trace),
    ]


def _feed_check(trace: ProgramTrace, lines: tuple[LineFeed, ...]) -> Check:
    limit = 100.0 * trace.problem.program.feed_tolerance
    unit = "% beside the asked feed"
    if not lines:
        return Check("feed", True, 0.0, limit, unit, "no contact moves")
    slowest = min(line.prediction.slowest for line in lines) * MM_PER_M
    fastest = max(line.prediction.fastest for line in lines) * MM_PER_M
    worst = max(lines, key=_feed_error)
    percent = [line for line in lines if line.in_percent]
    missed = [line for line in lines if not line.held]
    detail = f"predicted {slowest:.1f} to {fastest:.1f} mm/s, asked {_asked(lines)} mm/s"
    if percent:
        place = trace.place(percent[0].move + 1)
        detail += f"; {len(percent)} contact moves in % of the joint speed, first {place}"
    elif missed:
        detail += f"; {len(missed)} lines cannot hold it, first {_words(trace, missed[0])}"
    stops = [
        n
        for n in np.flatnonzero(trace.contact[:-1] & trace.contact[1:]) + 1
        if trace.program.moves[n].cnt is None and not trace.program.moves[n].events
    ]
    if stops:
        detail += f"; it stops {len(stops)} times on the way, first at {at(trace, int(stops[0]))}"
    value = 100.0 * _feed_error(worst)
    waypoint = trace.waypoint_of(worst.move + 1)
    return Check("feed", not missed and not percent, value, limit, unit, detail, waypoint)


def _lead_check(trace: ProgramTrace, predicted: tuple[FeedPrediction, ...]) -> Check:
    """The tool comes onto the face no faster than the feed, within the tolerance."""
    limit = 100.0 * (1.0 + trace.problem.program.feed_tolerance)
    largest, where, waypoint = 0.0, "no move leads onto a face", None
    for span in trace.spans:
        # A path that brings its own approach begins off the face.
        if span.first == 0 or span.which.roles[0] is not Role.CONTACT:
            continue
        share = 100.0 * predicted[span.first - 1].fastest / span.which.feed
        if share > largest:
            largest, where = share, f"on the way to {at(trace, span.first)}"
            waypoint = span.waypoint
    return Check(
        "lead speed", largest <= limit + 1e-6, largest, limit, "% of the feed", where, waypoint
    )


def _link_speed_check(trace: ProgramTrace) -> Check:
    """Off the face no line asks for more than the cell's speeds, and the first motion is joint.

    Nobody knows where the first motion begins, so that only a slow joint move is accepted.
    """
    settings = trace.problem.program
    percent = settings.approach_percent if settings.links is None else settings.links.percent
    linear = None if settings.links is None else settings.links.speed
    largest, where = 0.0, "no line"
    for number, move in enumerate(trace.program.moves):
        if number and trace.contact[number - 1]:
            continue
        allowed = linear
        if linear is not None and number and trace.touch[number - 1] >= 0:
            # The ramps of a lead go at the feed, however fast it is.
            beside = max(int(trace.span_of[number - 1]), int(trace.span_of[number]))
            allowed = max(linear, trace.spans[beside].which.feed)
        share = _link_share(move, percent, allowed, first=number == 0)
        if share > largest:
            largest, where = share, at(trace, number)
    detail = f"at {where}; the way to the first position is not checked"
    limit = 100.0
    return Check(
        "link speed", largest <= limit + 1e-6, largest, limit, "% of the cell's", detail,
    )  # fmt: skip


def _link_share(move: Move, percent: int, linear: float | None, *, first: bool) -> float:
    """What a line asks for, as a share [%] of what the cell allows off the face."""
    unit, value = move.speed.unit, move.speed.value
    if first and (move.kind is not MotionKind.JOINT or unit is not SpeedUnit.PERCENT):
        return np.inf
    if unit is SpeedUnit.PERCENT:
        return 100.0 * value / percent
    if unit is SpeedUnit.LINEAR and linear is not None:
        return 100.0 * value / linear
    # A time, or a speed where the cell states none: the check of joint speeds has it.
    return 0.0


def _feed_error(line: LineFeed) -> float:
    prediction = line.prediction
    off = max(line.asked - prediction.slowest, prediction.fastest - line.asked, 0.0)
    return off / line.asked


def _asked(lines: tuple[LineFeed, ...]) -> str:
    feeds = sorted({line.asked * MM_PER_M for line in lines})
    return " to ".join(f"{feed:g}" for feed in dict.fromkeys((feeds[0], feeds[-1])))


def _words(trace: ProgramTrace, line: LineFeed) -> str:
    place = at(trace, line.move + 1)
    if line.prediction.holds:
        close = line.prediction.length < CLOSE
        return f"{place}: so close together, roundings change it; {_FEWER}" if close else place
    return (
        f"{place}: J{line.prediction.joint + 1} allows at most "
        f"{np.floor(line.prediction.best * MM_PER_M * 10.0) / 10.0:.1f} mm/s"
    )


def _speed_check(trace: ProgramTrace, predicted: tuple[FeedPrediction, ...]) -> Check:
    """Every line can be driven as it says, without a joint faster than its limit."""
    share, where = 0.0, "every line as it says"
    for move, prediction in enumerate(predicted):
        if prediction.load > share:
            share = prediction.load
            where = f"J{prediction.joint + 1} on the way to {at(trace, move + 1)}"
            if share > 1.0:
                where += "; a lower feed or closer poses help"
    return Check("joint speed", share <= 1.0 + 1e-6, 100.0 * share, 100.0, "% of its limit", where)


def _step_checks(trace: ProgramTrace) -> list[Check]:
    """The cell's bounds on steps, where it has any."""
    rules = trace.problem.settings.steps
    joints = trace.program.joints
    share, where = 0.0, ""
    for move in np.flatnonzero(trace.contact):
        number = int(move)
        row = np.abs(joints[number + 1] - joints[number]) / rules.joints
        lean = trace.pieces[number].angles[:, 0]
        largest = max(float(row.max()), abs(float(lean[-1] - lean[0])) / rules.lean)
        if largest > share:
            share, where = largest, f"J{int(row.argmax()) + 1} or lean to {at(trace, number + 1)}"
    for before, after in pairwise(trace.spans):
        row = np.abs(joints[after.first] - joints[before.last]) / rules.link_joints
        if float(row.max()) > share:
            share = float(row.max())
            where = f"J{int(row.argmax()) + 1} over the link to {at(trace, after.first)}"
    bounded = bool(np.isfinite(rules.joints).any() or np.isfinite(rules.link_joints).any())
    if not (bounded or np.isfinite(rules.lean)):
        return []
    limit = 100.0 + 1e-3 * DEG_PER_RAD
    return [Check("steps", 100.0 * share <= limit, 100.0 * share, 100.0, "% of the bound", where)]
