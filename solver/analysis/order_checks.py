"""Named checks of what stands around the moves: events in their order, and the payload."""

from __future__ import annotations

import math
from dataclasses import dataclass
from decimal import ROUND_CEILING, Decimal

from solver.analysis.check import Check
from solver.analysis.spans import Span
from solver.analysis.trace import ProgramTrace
from solver.model.program_settings import ProgramSettings
from solver.model.toolpath import Event, EventKind, Role


def order_checks(trace: ProgramTrace, start_events: tuple[Event, ...]) -> list[Check]:
    """Events along the program and the payload; `start_events` come before the first move."""
    return [_event_check(trace, start_events), _payload_check(trace)]


def posted(event: Event, program: ProgramSettings) -> Event:
    """An event as a program file can say it: spindle events are calls, dwells hundredths."""
    match event.kind:
        case EventKind.SPINDLE_ON:
            return Event(EventKind.CALL, program.spindle_on)
        case EventKind.SPINDLE_OFF:
            return Event(EventKind.CALL, program.spindle_off)
        case EventKind.DWELL:
            exact = Decimal(repr(float(event.value)))
            return Event(EventKind.DWELL, "", float(exact.quantize(Decimal("0.01"), ROUND_CEILING)))
        case EventKind.DIGITAL_OUTPUT:
            return Event(event.kind, str(int(event.target)), float(bool(event.value)))
        case EventKind.CALL:
            return Event(event.kind, event.target)


def event_words(event: Event) -> str:
    """An event for people."""
    match event.kind:
        case EventKind.CALL:
            return f"CALL {event.target}"
        case EventKind.DWELL:
            return f"WAIT {event.value:g} s"
        case EventKind.DIGITAL_OUTPUT:
            return f"DO[{event.target}]={'ON' if event.value else 'OFF'}"
        case _:
            return str(event.kind.value)


def _event_check(trace: ProgramTrace, start_events: tuple[Event, ...]) -> Check:
    """Between the passes and at each waypoint exactly the events that the cell asks for."""
    wrong = 0
    detail = "spindle, outputs, dwells and calls as the cell asks"
    for move in trace.program.moves:
        if move.events and move.cnt is not None:
            wrong += 1
            detail = f"{move.source or 'a move'}: what happens there needs FINE, not CNT{move.cnt}"
            break
    for where, expected, found in _event_places(trace, start_events):
        if expected == found:
            continue
        wrong += 1
        if wrong == 1:
            detail = f"{where}: {_listed(found)} instead of {_listed(expected)}"
    return Check("events", not wrong, wrong, 0, "places", detail)


def _listed(events: list[Event]) -> str:
    return ", ".join(map(event_words, events)) or "no event"


def _event_places(
    trace: ProgramTrace, start_events: tuple[Event, ...]
) -> list[tuple[str, list[Event], list[Event]]]:
    """Where events belong: words, the expected ones, and those found."""
    program = trace.problem.program
    moves = trace.program.moves
    places = []
    found = list(start_events)
    expected: list[Event] = []
    position = 0
    for span in trace.spans:
        before, after = _around(span, program)
        for move in moves[position : span.first]:
            found += move.events
        if not before.own:
            expected += before.events
        places.append((f"before pass {span.number + 1}", expected, found))
        for index in range(span.first, span.last + 1):
            asked = _asked(span, index - span.first)
            if before.own and index == span.first:
                asked = [*before.events, *asked]
            if after.own and index == span.last:
                asked = [*asked, *after.events]
            places.append((trace.place(index), asked, list(moves[index].events)))
        expected = [] if after.own else list(after.events)
        found = []
        position = span.last + 1
    for move in moves[position:]:
        found += move.events
    places.append(("after the last pass", expected, found))
    return [
        (where, [posted(one, program) for one in asked], [posted(one, program) for one in stated])
        for where, asked, stated in places
    ]


@dataclass(frozen=True, slots=True)
class _Around:
    """Events of the links at one end of a pass; `own` where they happen at its own waypoint."""

    events: tuple[Event, ...]
    own: bool


def _around(span: Span, program: ProgramSettings) -> tuple[_Around, _Around]:
    """What happens before and after a pass: above the face, which its own ends may be."""
    roles, links = span.which.roles, program.links
    before = links.before if links is not None else ()
    after = links.after if links is not None else ()
    return (
        _Around(before, roles[0] is not Role.CONTACT),
        _Around(after, roles[-1] is not Role.CONTACT),
    )


def _asked(span: Span, row: int) -> list[Event]:
    """Events that the path asks for at a position, with those of the waypoints passed before."""
    events = span.which.events
    low = math.ceil(float(span.arc[row]) - 1e-9)
    asked = list(events.get(low, ())) if span.share[row] == 0.0 else []
    if row:
        skipped = range(math.floor(float(span.arc[row - 1])) + 1, low)
        asked = [one for node in skipped for one in events.get(node, ())] + asked
    return asked


def _payload_check(trace: ProgramTrace) -> Check:
    """The tool against the robot's payload, and the schedule that the cell asks for."""
    problem = trace.problem
    stated, asked = trace.program.payload, problem.program.payload
    detail = f"tool {problem.tool.name}"
    if asked is not None or stated is not None:
        detail += f", PAYLOAD[{stated if stated is not None else 'none'}]"
    if stated != asked:
        detail += f" instead of [{asked if asked is not None else 'none'}]"
    return Check(
        "payload",
        problem.tool.mass <= problem.robot.payload and stated == asked,
        problem.tool.mass,
        problem.robot.payload,
        "kg",
        detail,
        assumed=True,
    )
