"""The pose that is looked at, in words and numbers: joints, clearance, every filter."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from posopt_gui.viewmodels.number_words import (
    clearance_mm,
    decimal,
    signed,
    subject_words,
)
from solver.candidates.outcomes import Outcome
from solver.kinematics.configuration import config_string
from solver.transforms import FloatArray
from solver.units import DEG, DEG_PER_RAD, MM_PER_M

if TYPE_CHECKING:
    from solver.analysis.result import PlanningResult, Sequence
    from solver.candidates.explain import Explanation
    from solver.candidates.margins import FilterMargin
    from solver.model.problem import PlanningProblem

Translate = Callable[..., str]

NEAR_LIMIT = 10.0 * DEG
"""A joint that is nearer to its limit than this is marked [rad]."""

UNDER_SAFETY = "under the safety distance"

VERDICTS = {
    Outcome.FEASIBLE: "feasible",
    Outcome.UNREACHABLE: "out of reach",
    Outcome.JOINT_LIMIT: "joint limit",
    Outcome.SINGULAR: "singular",
    Outcome.COLLISION: "collision",
    Outcome.MARGIN: "tool too close",
    Outcome.SELF_COLLISION: "own bodies too close",
}
"""What became of a candidate, in a few words."""


@dataclass(frozen=True, slots=True)
class Pose:
    """Which candidate is looked at: angles in [rad]."""

    waypoint: int
    lean: float
    lead: float
    spin: float
    branch: int
    turn: int


@dataclass(frozen=True, slots=True)
class JointBar:
    """A pendant joint [deg] within its limits; `share` is its place between them, 0 to 1."""

    name: str
    value: float
    low: float
    high: float
    share: float
    state: str

    @property
    def words(self) -> str:
        """The angle as it is shown."""
        return decimal(self.value, 2) + "°"


@dataclass(frozen=True, slots=True)
class FilterRow:
    """One filter: `state` is 'good', 'near' (kept, but under the safety distance) or 'bad'."""

    name: str
    subject: str
    value: str
    margin: str
    state: str


@dataclass(frozen=True, slots=True)
class Sheet:
    """What the inspector shows of one pose; `outcome` and `near` colour the verdict."""

    title: str
    subtitle: str
    verdict: str
    outcome: Outcome
    near: bool
    facts: tuple[tuple[str, str], ...]
    joints: tuple[JointBar, ...]


def sequence_pose(sequence: Sequence, waypoint: int) -> Pose:
    """The pose of the sequence at a waypoint."""
    lean, lead, spin = map(float, sequence.angles[waypoint])
    branch, turn = int(sequence.branch[waypoint]), int(sequence.turn[waypoint])
    return Pose(waypoint, lean, lead, spin, branch, turn)


def candidate_pose(
    result: PlanningResult, waypoint: int, orientation: int, slot: int, turn: int | None
) -> Pose:
    """The pose of a cell of the map."""
    lean, lead, spin = map(float, result.candidates.orientations[orientation])
    return Pose(waypoint, lean, lead, spin, int(result.candidates.branches[slot]), turn or 0)


def sequence_sheet(
    result: PlanningResult,
    sequence: Sequence,
    waypoint: int,
    translate: Translate,
    *,
    unfulfilled: bool = False,
) -> Sheet:
    """The shown sequence at a waypoint; `unfulfilled`: it is the one without the wishes."""
    pose = sequence_pose(sequence, waypoint)
    clearance = float(sequence.clearance[waypoint])
    near = clearance < result.problem.settings.safety_distance
    verdict = UNDER_SAFETY if near else VERDICTS[Outcome.FEASIBLE]
    facts = _facts(result.problem, pose, sequence.pendant[waypoint], translate)
    return Sheet(
        _title(result, waypoint, translate),
        _pass_words(result.problem, waypoint, translate, unfulfilled=unfulfilled),
        translate(verdict),
        Outcome.FEASIBLE,
        near,
        facts,
        joint_bars(result.problem, sequence.pendant[waypoint]),
    )


def candidate_sheet(
    result: PlanningResult,
    pose: Pose,
    orientation: int,
    slot: int,
    explanation: Explanation | None,
    translate: Translate,
    *,
    chosen: bool = False,
) -> Sheet:
    """A candidate under the mouse, or chosen by a click.

    Its joints are those of the explanation where it is known.
    """
    found = result.candidates
    outcome = Outcome(int(found.outcome[pose.waypoint, orientation, slot]))
    clearance = float(found.clearance[pose.waypoint, orientation, slot])
    joints = None
    if explanation is not None:
        joints = explanation.joints
    elif outcome is not Outcome.UNREACHABLE:
        model = found.joints[pose.waypoint, orientation, slot]
        joints = result.problem.robot.pendant_from_model @ model
    near = outcome is Outcome.FEASIBLE and clearance < result.problem.settings.safety_distance
    return Sheet(
        _title(result, pose.waypoint, translate),
        translate("Chosen candidate, not on the plan" if chosen else "Candidate under the mouse"),
        translate(UNDER_SAFETY if near else VERDICTS[outcome]),
        outcome,
        near,
        _facts(result.problem, pose, joints, translate),
        joint_bars(result.problem, joints) if joints is not None else (),
    )


def _title(result: PlanningResult, waypoint: int, translate: Translate) -> str:
    count = len(result.problem.toolpath)
    return translate("Waypoint {number}/{count}", number=waypoint + 1, count=count)


def _pass_words(
    problem: PlanningProblem, waypoint: int, translate: Translate, *, unfulfilled: bool
) -> str:
    index = int(problem.toolpath.pass_index[waypoint])
    name = problem.toolpath.passes[index].name or str(index + 1)
    if unfulfilled:
        return translate("On the plan without your wishes")
    return translate("On the plan, pass {name}", name=translate(name.replace("_", " ")))


def _facts(
    problem: PlanningProblem, pose: Pose, joints: FloatArray | None, translate: Translate
) -> tuple[tuple[str, str], ...]:
    settings = problem.settings
    facts = [(translate("Lean"), decimal(pose.lean * DEG_PER_RAD, 2) + "°")]
    for label, value, sweep in (
        (translate("Lead"), pose.lead, settings.lead),
        (translate("Spin"), pose.spin, settings.spin),
    ):
        if len(sweep.angles()) > 1 or abs(value) > 1e-9:
            facts.append((label, decimal(value * DEG_PER_RAD, 2) + "°"))
    branch = translate("{branch}, turn {turn}", branch=pose.branch, turn=pose.turn + 1)
    facts.append((translate("Branch"), branch))
    if joints is not None:
        facts.append((translate("CONFIG"), config_string(problem.robot, joints)))
    return tuple(facts)


def joint_bars(problem: PlanningProblem, joints: FloatArray) -> tuple[JointBar, ...]:
    """Pendant joints (6,) [rad] within their limits."""
    bars = []
    for number, (value, (low, high)) in enumerate(
        zip(joints, problem.joint_limits, strict=True), start=1
    ):
        left = min(value - low, high - value)
        state = "bad" if left < -1e-9 else "near" if left < NEAR_LIMIT else "good"
        share = float(np.clip((value - low) / (high - low), 0.0, 1.0))
        bars.append(
            JointBar(
                f"J{number}",
                float(value) * DEG_PER_RAD,
                float(low) * DEG_PER_RAD,
                float(high) * DEG_PER_RAD,
                share,
                state,
            )
        )
    return tuple(bars)


@dataclass(frozen=True, slots=True)
class ClearanceWords:
    """The clearance of a pose: its number, who against whom, and the safety distance."""

    value: str
    bodies: str
    beyond: str
    state: str


def clearance_words(
    problem: PlanningProblem, explanation: Explanation | None, translate: Translate
) -> ClearanceWords | None:
    """Who comes nearest to whom; None where there is nothing to come near to."""
    if explanation is None:
        return None
    rows = [one for one in explanation.filters if one.filter is Outcome.COLLISION]
    if not rows or not np.isfinite(explanation.clearance):
        return None
    safety = problem.settings.safety_distance
    beyond = (explanation.clearance - safety) * MM_PER_M
    state = "bad" if explanation.clearance <= 0.0 else "near" if beyond < 0.0 else "good"
    words = translate(
        "{beyond} mm to the safety distance of {safety} mm",
        beyond=signed(float(np.floor(beyond * 10.0 + 1e-7) / 10.0), 1),
        safety=decimal(safety * MM_PER_M, 1),
    )
    return ClearanceWords(
        clearance_mm(explanation.clearance) + " mm",
        subject_words(rows[0].subject, translate),
        words,
        state,
    )


def filter_rows(
    problem: PlanningProblem, explanation: Explanation | None, translate: Translate
) -> tuple[FilterRow, ...]:
    """Every filter with its value and its signed margin."""
    if explanation is None:
        return ()
    return tuple(_filter_row(problem, explanation, one, translate) for one in explanation.filters)


def _filter_row(
    problem: PlanningProblem,
    explanation: Explanation,
    one: FilterMargin,
    translate: Translate,
) -> FilterRow:
    name = translate(_name_of(one))
    state = "good" if one.passed else "bad"
    value, subject = "", subject_words(one.subject, translate)
    margin = f"{signed(one.margin, 1)} {one.unit}"
    if one.filter is Outcome.JOINT_LIMIT:
        margin, value = f"{signed(one.margin, 2)}°", _limited_angle(explanation, one.subject)
    elif one.filter is Outcome.SINGULAR:
        margin = f"{signed(one.margin, 4)} m³"
        value = f"{decimal(one.margin + problem.settings.manipulability, 4)} m³"
        subject = ""
    elif one.filter is Outcome.COLLISION:
        safety = problem.settings.safety_distance * MM_PER_M
        beyond = float(np.floor((one.margin - safety) * 10.0 + 1e-7) / 10.0)
        value, margin = f"{clearance_mm(one.margin / MM_PER_M)} mm", f"{signed(beyond, 1)} mm"
        if one.passed and beyond < 0.0:
            state = "near"
    elif one.unit == "mm":
        margin = f"{signed(float(np.floor(one.margin * 10.0 + 1e-7) / 10.0), 1)} mm"
    return FilterRow(name, subject, value, margin, state)


def _name_of(one: FilterMargin) -> str:
    if one.filter is Outcome.JOINT_LIMIT and one.subject.startswith("J2+J3"):
        return "Elbow"
    return {
        Outcome.UNREACHABLE: "Reach",
        Outcome.JOINT_LIMIT: "Joint limits",
        Outcome.SINGULAR: "Manipulability",
        Outcome.COLLISION: "Clearance",
        Outcome.MARGIN: "Tool's margin",
        Outcome.SELF_COLLISION: "Own bodies",
    }.get(one.filter, one.filter.label)


def _limited_angle(explanation: Explanation, subject: str) -> str:
    joints = explanation.joints
    if joints is None:
        return ""
    if subject.startswith("J2+J3"):
        angle = float(joints[1] + joints[2])
    else:
        angle = float(joints[int(subject[1]) - 1])
    return decimal(angle * DEG_PER_RAD, 2) + "°"
