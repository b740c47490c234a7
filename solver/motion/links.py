"""The moves of a whole program: what is generated before, between and behind the passes.

Every generated position is rounded like the ones of the path, ends FINE so that the robot runs
the very polyline that was checked, and is reached by a move that keeps the clearance of the
link settings in samples of 2 mm.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from solver.errors import InputError, RefusedError
from solver.kinematics.arm import forward
from solver.model.problem import PlanningProblem
from solver.model.program import MotionKind, Move, Speed, rounded_joints
from solver.model.program_settings import LinkSettings
from solver.model.toolpath import Event, Role
from solver.motion.link_checks import MoveChecker
from solver.motion.link_planner import plan_link
from solver.motion.pass_ends import PassEnd, end_geometry, find_end, posture_at
from solver.progress import Monitor, SilentMonitor, checkpoint
from solver.transforms import FloatArray

LIFTS = (
    (1.0, 1.0),
    (0.5, 0.5),
    (1.0, 0.0),
    (0.0, 1.0),
    (0.5, 0.0),
    (0.0, 0.5),
    (1.0, 0.5),
    (0.5, 1.0),
)
"""Shares of the link height by which both ends of a link are lifted, in the order of trying."""

PASSING = 100
"""CNT of positions that the tool passes without stopping."""


@dataclass(frozen=True, slots=True, eq=False)
class Leg:
    """One move of a link, to pendant joints (6,) [rad]."""

    joints: FloatArray
    kind: MotionKind = MotionKind.JOINT


def linked_moves(
    problem: PlanningProblem,
    contact: Sequence[tuple[Move, ...]],
    monitor: Monitor | None = None,
) -> tuple[Move, ...]:
    """All moves of a program: home, links, approaches, ramps, the contact moves, and back.

    Parameters
    ----------
    problem : PlanningProblem
        With link settings.
    contact : sequence of tuples of Move
        The moves of each pass in order, in rounded joints. Speed, kind and termination of the
        first one and the termination of the last one are decided here. A pass whose first or
        last move has another role than contact brings its own way onto the face or off it.
    monitor : Monitor, optional
        Learns the progress and may cancel.

    Returns
    -------
    tuple of Move
        From home to home, or without a home from the first approach to the last retract.

    Raises
    ------
    InputError
        The problem has no link settings.
    RefusedError
        A generated position is out of reach, or a move is not free; the sentence names it.
    """
    settings = problem.program.links
    if settings is None:
        raise InputError(f"cell {problem.name} states no links")
    if len(contact) != len(problem.toolpath.passes) or not all(contact):
        raise ValueError("every pass needs its contact moves")
    monitor = monitor or SilentMonitor()
    checker = MoveChecker.of(problem, settings.clearance, monitor)
    program = _Program(problem, settings, checker)
    program.start()
    for number, moves in enumerate(contact):
        checkpoint(monitor, "links", number, len(contact))
        program.add_pass(number, moves)
    program.finish()
    return tuple(program.moves)


class _Program:
    """The moves so far, and the posture and the place where they end."""

    def __init__(
        self, problem: PlanningProblem, settings: LinkSettings, checker: MoveChecker
    ) -> None:
        self.problem, self.settings, self.checker = problem, settings, checker
        self.moves: list[Move] = []
        self.place = ""
        self.links = 0

    def start(self) -> None:
        """Begin at home, if there is one."""
        if self.settings.home is None:
            return
        home = rounded_joints(self.settings.home)
        self.checker.refuse_posture("the home position", home)
        self.moves.append(self._move(Leg(home), Role.LINK))
        self.place = "home"

    def add_pass(self, number: int, contact: tuple[Move, ...]) -> None:
        """Link to a pass, come onto the face, run the contact moves and leave the face."""
        joints = np.array([move.joints for move in contact])
        entry = exit_ = None
        if contact[0].role is Role.CONTACT:
            entry = find_end(
                self.checker, end_geometry(self.checker, number, joints, arriving=True)
            )
        if contact[-1].role is Role.CONTACT:
            exit_ = find_end(
                self.checker, end_geometry(self.checker, number, joints, arriving=False)
            )
        name = f"pass {number + 1}"
        if entry is None:
            self._link_to_own_start(contact[0], f"the first waypoint of {name}")
        else:
            self._link(
                entry.withdrawn,
                f"the approach position of {name}",
                Role.APPROACH,
                self.settings.before,
            )
        self.moves += self._on_face(number, contact, entry, exit_)
        self.place = f"the {'last waypoint' if exit_ is None else 'retract position'} of {name}"

    def finish(self) -> None:
        """Go home, if there is one."""
        if self.settings.home is not None:
            self._link(rounded_joints(self.settings.home), "home", Role.LINK, ())

    def _link_to_own_start(self, first: Move, name: str) -> None:
        """Link to a waypoint with which a pass itself approaches the face."""
        self._link(first.joints, name, first.role, (*self.settings.before, *first.events))
        self.moves[-1] = replace(self.moves[-1], waypoint=first.waypoint, source=first.source)

    def _link(self, target: FloatArray, name: str, role: Role, events: tuple[Event, ...]) -> None:
        """Append a link whose last move reaches `target` in a role and with events."""
        if not self.moves:
            self.checker.refuse_posture(name, target)
            legs: tuple[Leg, ...] = (Leg(target),)
        else:
            start = self.moves[-1].joints
            words = f"from {self.place} to {name}"
            self.checker.refuse_posture(self.place, start)
            self.checker.refuse_posture(name, target)
            seed = (self.problem.settings.seed, self.links)
            legs = find_link(self.checker, self.settings, start, target, words, seed)
        self.links += 1
        self.moves += [self._move(leg, Role.LINK) for leg in legs[:-1]]
        self.moves.append(self._move(legs[-1], role, events))

    def _on_face(
        self,
        number: int,
        contact: tuple[Move, ...],
        entry: PassEnd | None,
        exit_: PassEnd | None,
    ) -> list[Move]:
        """The moves from the approach position to the retract position, the former left out."""
        feed = Speed.linear(self.problem.toolpath.passes[number].feed)
        slow = Speed.linear(self.settings.speed)
        moves = list(contact)
        before: list[Move] = []
        if entry is None:
            # Its first move is the end of the link; a pass of one waypoint has no other.
            del moves[0]
        elif entry.lead is None:
            moves[0] = replace(moves[0], kind=MotionKind.LINEAR, speed=feed, cnt=None)
        else:
            before = [Move(entry.lead, slow, MotionKind.LINEAR, None, Role.LEAD_IN)]
            moves[0] = replace(moves[0], kind=MotionKind.LINEAR, speed=feed, cnt=_passing(moves[0]))
        if exit_ is None:
            if moves:
                events = (*moves[-1].events, *self.settings.after)
                moves[-1] = replace(moves[-1], cnt=None, events=events)
            else:
                self._add_events(self.settings.after)
            return before + moves
        after = []
        if exit_.lead is None:
            moves[-1] = replace(moves[-1], cnt=None)
        else:
            if moves:
                moves[-1] = replace(moves[-1], cnt=_passing(moves[-1]))
            after = [Move(exit_.lead, feed, MotionKind.LINEAR, None, Role.LEAD_OUT)]
        events = self.settings.after
        retract = Move(exit_.withdrawn, slow, MotionKind.LINEAR, None, Role.LEAD_OUT, events=events)
        return [*before, *moves, *after, retract]

    def _add_events(self, events: tuple[Event, ...]) -> None:
        last = self.moves[-1]
        self.moves[-1] = replace(last, events=(*last.events, *events))

    def _move(self, leg: Leg, role: Role, events: tuple[Event, ...] = ()) -> Move:
        """A move of a link; linear ones at the speed of approaches."""
        linear = leg.kind is MotionKind.LINEAR
        percent = Speed.percent(float(self.settings.percent))
        speed = Speed.linear(self.settings.speed) if linear else percent
        return Move(leg.joints, speed, leg.kind, None, role, events=events)


def _passing(move: Move) -> int | None:
    """CNT of a position that is passed; what happens at a waypoint happens there, so FINE."""
    return None if move.events else PASSING


def find_link(
    checker: MoveChecker,
    settings: LinkSettings,
    start: FloatArray,
    end: FloatArray,
    words: str,
    seed: tuple[int, ...],
) -> tuple[Leg, ...]:
    """Free moves between two postures away from the face.

    Tried in order: one joint move; straight up, across and down again; the planner.

    Parameters
    ----------
    checker : MoveChecker
        Says what is free.
    settings : LinkSettings
        For the link height.
    start, end : (6,) arrays
        Pendant joints [rad], rounded, free and inside the limits.
    words : str
        'from .. to ..', for the sentence of an error.
    seed : tuple of ints
        Of the planner.

    Raises
    ------
    RefusedError
        Nothing is free; the sentence names the two bodies that stop the direct link.
    """
    direct = checker.obstruction(start, end, MotionKind.JOINT)
    if direct is None:
        return (Leg(end),)
    if (legs := _lifted(checker, settings.height, start, end)) is not None:
        return legs
    if (way := plan_link(checker, start, end, seed)) is not None:
        return tuple(Leg(joints) for joints in way)
    home = "another home position" if settings.home is not None else "a home position"
    raise RefusedError(
        f"no free link was found {words}: on the direct way {direct.reason}; try {home}, "
        "a larger link height, a longer approach or less clearance on links"
    )


def _lifted(
    checker: MoveChecker, height: float, start: FloatArray, end: FloatArray
) -> tuple[Leg, ...] | None:
    """Straight up from the start, across by a joint move, and straight down to the end."""
    if height == 0.0:
        return None
    shares = sorted({share for pair in LIFTS for share in pair})
    above_start = {share: _raised(checker, start, share * height, up=True) for share in shares}
    above_end = {share: _raised(checker, end, share * height, up=False) for share in shares}
    for rise, fall in LIFTS:
        one, other = above_start[rise], above_end[fall]
        if one is None or other is None:
            continue
        if checker.obstruction(one.joints, other.joints, MotionKind.JOINT) is not None:
            continue
        legs = [one] if rise else []
        legs.append(Leg(other.joints))
        # The leg above the end tells how to come down from there.
        return (*legs, Leg(end, other.kind)) if fall else tuple(legs)
    return None


def _raised(checker: MoveChecker, joints: FloatArray, height: float, *, up: bool) -> Leg | None:
    """The posture that holds the tool higher [m], and the kind of the free move there or back."""
    if height == 0.0:
        return Leg(joints)
    pose = forward(checker.problem.robot, joints, checker.problem.tool.tcp)
    pose[2, 3] += height
    try:
        raised = posture_at(checker, pose, joints, "lifted position")
    except RefusedError:
        return None
    ends = (joints, raised) if up else (raised, joints)
    for kind in (MotionKind.LINEAR, MotionKind.JOINT):
        if checker.obstruction(*ends, kind) is None:
            return Leg(raised, kind)
    return None
