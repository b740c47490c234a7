"""From a planned sequence to a neutral program: speeds, terminations, events and links."""

from __future__ import annotations

import math
from dataclasses import replace

from solver.costs.steps import gap_times
from solver.model.problem import PlanningProblem
from solver.model.program import (
    JointProgram,
    MotionKind,
    Move,
    Speed,
)
from solver.model.program_settings import ContactMotion
from solver.pipeline.remarks import head_remarks
from solver.transforms import FloatArray

MILLISECOND = 1e-3


def program_with(
    problem: PlanningProblem,
    name: str,
    moves: tuple[Move, ...],
    clearance: float | None,
    **stamps: object,
) -> JointProgram:
    """A program of the cell with these moves; `clearance` [m] and `stamps` go to the remarks."""
    settings = problem.program
    return JointProgram(
        name=name,
        comment=settings.comment,
        remarks=head_remarks(problem, clearance, **stamps),  # type: ignore[arg-type]
        frame=problem.user_frame,
        tool=problem.user_tool,
        moves=moves,
        date=settings.date,
        time=settings.time,
        payload=settings.payload,
        offset=settings.offset,
    )


def contact_moves(problem: PlanningProblem, joints: FloatArray) -> tuple[tuple[Move, ...], ...]:
    """The moves of each pass: the arrival at its first waypoint, then contact moves."""
    times = gap_times(problem)
    linear = problem.program.contact is ContactMotion.LINEAR
    passes = []
    first = 0
    for one in problem.toolpath.passes:
        moves = []
        for row in range(len(one)):
            index = first + row
            events = one.events.get(row, ())
            # What happens at a waypoint happens there, not while its corner is being cut.
            fine = row in {0, len(one) - 1} or bool(events)
            move = Move(
                joints=joints[index],
                speed=Speed.percent(problem.program.approach_percent),
                cnt=None if fine else 100,
                role=one.roles[row],
                waypoint=index,
                events=events,
            )
            if row:
                move = with_feed(move, float(times[index - 1]), one.feed, linear=linear)
            moves.append(move)
        passes.append(tuple(moves))
        first += len(one)
    return tuple(passes)


def with_feed(move: Move, seconds: float, feed: float, *, linear: bool) -> Move:
    """The move at the feed: `L` at that speed, or `J` with its time, up to whole milliseconds."""
    if linear:
        return replace(move, kind=MotionKind.LINEAR, speed=Speed.linear(feed))
    whole = math.ceil(round(seconds / MILLISECOND, 6)) * MILLISECOND
    return replace(move, kind=MotionKind.JOINT, speed=Speed.duration(round(whole, 3)))
