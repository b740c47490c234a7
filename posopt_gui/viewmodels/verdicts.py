"""What the plan and its program are worth, in a line each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from posopt_gui.viewmodels.number_words import clearance_mm, decimal
from solver.units import MM_PER_M

if TYPE_CHECKING:
    from solver.analysis.result import PlanningResult, Sequence
    from solver.pipeline.program_check import ProgramReport

Translate = Callable[..., str]


@dataclass(frozen=True, slots=True)
class Note:
    """A message: severity 'info', 'warning' or 'error', and the waypoint (from 0) it is about."""

    severity: str
    text: str
    waypoint: int | None = None


def plan_note(result: PlanningResult, sequence: Sequence, translate: Translate) -> Note:
    """What the shown sequence is worth; a warning where it keeps less than was asked.

    A branch that changes within a pass is the worse of two warnings, and is told first.
    """
    from posopt_gui.viewmodels.branch_breaks import branch_break  # noqa: PLC0415 - loads numpy

    broken = branch_break(result.problem, sequence, translate)
    worth = _worth(result, sequence, translate)
    if broken is None:
        return worth
    words = [broken.text, worth.text] if worth.severity == "warning" else [broken.text]
    return Note("warning", " ".join(words), broken.waypoint)


def _worth(result: PlanningResult, sequence: Sequence, translate: Translate) -> Note:
    clearance = clearance_mm(sequence.least_clearance)
    safety = result.problem.settings.safety_distance
    if sequence.least_clearance < safety:
        nearest = int(sequence.clearance.argmin())
        text = translate(
            "Planned, but least clearance {clearance} mm is less than the {safety} mm asked "
            "(waypoint {number}).",
            clearance=clearance, safety=decimal(safety * MM_PER_M, 1), number=nearest + 1,
        )  # fmt: skip
        return Note("warning", text, nearest)
    text = translate(
        "Planned: least clearance {clearance} mm, joint cost {cost}.",
        clearance=clearance, cost=f"{sequence.joint_cost:.4f}",
    )  # fmt: skip
    return Note("info", text)


def gate_words(report: ProgramReport | None, translate: Translate) -> tuple[str, str]:
    """Verdict of the program's checks in one line, and whether it is 'good' or 'bad'.

    Without a report they could not be completed, and so have failed.
    """
    if report is None:
        return translate("Program: the checks could not be completed"), "bad"
    failed, count = len(report.failed), len(report.checks)
    if not failed:
        return translate("Program: {count} checks passed", count=count), "good"
    words = translate("Program: {failed} of {count} checks failed", failed=failed, count=count)
    return words, "bad"
