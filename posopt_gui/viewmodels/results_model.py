"""Totals, schemes side by side and messages of a plan, as rows of text."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from posopt_gui.viewmodels.check_figures import check_figure, figures
from posopt_gui.viewmodels.check_sentences import sentence
from posopt_gui.viewmodels.curves_model import Track, kind_label
from posopt_gui.viewmodels.export_model import waypoint_of
from posopt_gui.viewmodels.number_words import (
    NOTHING,
    clearance_mm,
    decimal,
    signed,
    typeset,
)
from posopt_gui.viewmodels.trouble_model import Trouble
from posopt_gui.viewmodels.verdicts import Note
from solver.analysis.check import Check
from solver.analysis.metrics import lean_edge_share
from solver.candidates.outcomes import Outcome
from solver.kinematics.configuration import config_string
from solver.transforms import FloatArray, IntArray
from solver.units import DEG_PER_RAD, MM_PER_M

if TYPE_CHECKING:
    from solver.analysis.result import PlanningResult, Sequence
    from solver.model.problem import PlanningProblem
    from solver.pipeline.program_check import ProgramReport
    from solver.pipeline.replanning import Replanned

Translate = Callable[..., str]

PERCENT = 100.0

WISHES = "wishes"
"""Name of the sequence under pins and regions among the compared ones."""


@dataclass(frozen=True, slots=True)
class Total:
    """One number of the plan; `state` is 'good', 'near', 'bad' or ''."""

    label: str
    value: str
    state: str = ""
    waypoint: int | None = None


@dataclass(frozen=True, slots=True)
class SchemeTable:
    """Sequences side by side: `heads` name the columns, `rows` are label and texts.

    `best` holds (row, column) of the best value of each row that can be compared.
    """

    heads: tuple[str, ...]
    rows: tuple[tuple[str, tuple[str, ...]], ...]
    best: frozenset[tuple[int, int]]


def totals(
    result: PlanningResult,
    sequence: Sequence,
    answer: Replanned | None,
    report: ProgramReport | None,
    translate: Translate,
) -> tuple[Total, ...]:
    """The numbers of the shown sequence."""
    problem = result.problem
    nearest = int(np.argmin(sequence.clearance))
    kept = sequence.least_clearance >= problem.settings.safety_distance
    rows = [
        Total(translate("Joint cost"), decimal(sequence.joint_cost, 5)),
        Total(
            translate("Least clearance"),
            f"{clearance_mm(sequence.least_clearance)} mm",
            "good" if kept else "near",
            nearest,
        ),
        Total(translate("Mean clearance"), f"{clearance_mm(sequence.mean_clearance)} mm"),
        Total(translate("Lean"), _lean_range(sequence.angles[:, 0] * DEG_PER_RAD)),
        Total(translate("Cumulative change"), f"{decimal(_change(sequence), 1)}°"),
        Total(translate("Branch"), _branches(problem, sequence.branch, sequence.pendant)),
    ]
    if answer is not None and answer.sequence is not None:
        rows.insert(1, Total(translate("Price of your pins and regions"), _price(result, answer)))
    if report is not None and report.cycle is not None:
        total = f"{decimal(report.cycle.total, 1)} s"
        rows.append(Total(translate("Cycle with links, estimated"), total))
    return tuple(rows)


def candidate_counts(result: PlanningResult, translate: Translate) -> str:
    """How many candidates there are, and what became of them."""
    counts = result.candidates.counts()
    feasible = counts[Outcome.FEASIBLE]
    return translate(
        "{all} candidates, {feasible} of them feasible ({nodes} nodes with their turns)",
        all=f"{sum(counts.values()):,}", feasible=f"{feasible:,}",
        nodes=f"{len(result.candidates.nodes):,}",
    )  # fmt: skip


def _price(result: PlanningResult, answer: Replanned) -> str:
    cost = result.sequence.cost
    share = f" ({signed(PERCENT * answer.price / cost, 1)} %)" if cost > 0.0 else ""
    return signed(answer.price, 5) + share


def _lean_range(lean: FloatArray) -> str:
    """Leans (n,) [deg] from the least to the largest."""
    low, high = decimal(float(lean.min()), 2), decimal(float(lean.max()), 2)
    return f"{low}°" if low == high else f"{low}° … {high}°"


def _change(sequence: Sequence) -> float:
    return float(np.abs(np.diff(sequence.pendant, axis=0)).sum()) * DEG_PER_RAD


def _branches(problem: PlanningProblem, branch: IntArray, pendant: FloatArray) -> str:
    """Each branch that (n,) waypoints pass, with the letters of its CONFIG."""
    numbers, first = np.unique(branch, return_index=True)
    words = (config_string(problem.robot, pendant[one]).split(",")[0] for one in first)
    return ", ".join(f"{number} ({word})" for number, word in zip(numbers, words, strict=True))


def scheme_table(
    result: PlanningResult,
    answer: Replanned | None,
    compared: Iterable[Track],
    translate: Translate,
) -> SchemeTable:
    """Every scheme that was searched, the sequence under the wishes, and the references."""
    found = {scheme.value: one for scheme, one in result.sequences.items()}
    if answer is not None and answer.sequence is not None:
        found[WISHES] = answer.sequence
    references = list(compared)
    heads = [translate("with your wishes" if one == WISHES else one) for one in found]
    heads += [kind_label(translate, one.name) for one in references]
    chosen = list(found.values())
    nothing = [NOTHING for _ in references]
    ranges = result.problem.robot.cost_ranges
    costs = [one.joint_cost for one in chosen]
    costs += [_reference_cost(result.problem, one, ranges) for one in references]
    least = [one.least_clearance for one in chosen]
    least += [float(one.clearance.min()) / MM_PER_M for one in references]
    mean = [one.mean_clearance for one in chosen]
    mean += [float(one.clearance.mean()) / MM_PER_M for one in references]
    change = [_change(one) for one in chosen]
    change += [float(one.motion.variation.sum()) * DEG_PER_RAD for one in references]
    rows: list[tuple[str, list[str]]] = [
        (translate("Joint cost"), [decimal(one, 5) for one in costs]),
        (translate("Against the best"), _against_best(costs)),
        (translate("Objective"), [*(decimal(one.cost, 5) for one in chosen), *nothing]),
        (translate("Least clearance, mm"), [clearance_mm(one) for one in least]),
        (translate("Mean clearance, mm"), [clearance_mm(one) for one in mean]),
        (translate("Cumulative change, °"), [decimal(one, 1) for one in change]),
        (translate("Lean"), _leans(chosen, references)),
        (translate("Branch"), _all_branches(result.problem, chosen, references)),
        (
            translate("Expanded nodes"),
            [*(f"{one.expanded:,}" if one.expanded else NOTHING for one in chosen), *nothing],
        ),
    ]
    first = {0: int(np.nanargmin(costs)), 3: int(np.nanargmax(least))}
    first |= {4: int(np.nanargmax(mean)), 5: int(np.nanargmin(change))}
    # What reads the same is as good.
    best = {
        (row, column)
        for row, winner in first.items()
        for column, text in enumerate(rows[row][1])
        if text == rows[row][1][winner]
    }
    shown = tuple((label, tuple(texts)) for label, texts in rows)
    return SchemeTable(tuple(heads), shown, frozenset(best))


def _leans(chosen: Iterable[Sequence], references: Iterable[Track]) -> list[str]:
    own = [one.angles[:, 0] * DEG_PER_RAD for one in chosen]
    return [_lean_range(one) for one in [*own, *(one.lean for one in references)]]


def _all_branches(
    problem: PlanningProblem, chosen: Iterable[Sequence], references: Iterable[Track]
) -> list[str]:
    own = [_branches(problem, one.branch, one.pendant) for one in chosen]
    return own + [_branches(problem, one.branch, one.joints / DEG_PER_RAD) for one in references]


def _reference_cost(problem: PlanningProblem, track: Track, ranges: np.ndarray) -> float:
    """Joint cost of a reference, in model angles as the plan's."""
    model = (track.joints / DEG_PER_RAD) @ problem.robot.model_from_pendant.T
    return float((np.abs(np.diff(model, axis=0)) / ranges).sum())


def _against_best(costs: list[float]) -> list[str]:
    least = min(costs)
    if least <= 0.0:
        return [NOTHING for _ in costs]
    return [f"{signed(PERCENT * (one / least - 1.0), 1)} %" for one in costs]


def notes(
    result: PlanningResult | None,
    sequence: Sequence | None,
    report: ProgramReport | None,
    trouble: Trouble | None,
    translate: Translate,
) -> tuple[Note, ...]:
    """What has to be said about the plan, the worst first."""
    found: list[Note] = []
    if trouble is not None:
        found += [Note("error", f"{trouble.headline} {one.text}", one.waypoint)
                  for one in trouble.causes]  # fmt: skip
    if report is not None:
        found += [
            Note("error", check_words(one, translate), waypoint_of(one)) for one in report.failed
        ]
    if result is not None and sequence is not None:
        found += _plan_notes(result, sequence, translate)
        problem = result.problem
        found += [
            Note("info", typeset(translate(one)))
            for one in (*problem.assumptions, *problem.robot.assumptions)
        ]
    return tuple(found)


def _plan_notes(result: PlanningResult, sequence: Sequence, translate: Translate) -> list[Note]:
    found, settings = [], result.problem.settings
    nearest = int(np.argmin(sequence.clearance))
    if sequence.least_clearance < settings.safety_distance:
        text = translate(
            "The safety distance of {safety} mm is not kept: {least} mm at waypoint {number}.",
            safety=decimal(settings.safety_distance * MM_PER_M, 1),
            least=clearance_mm(sequence.least_clearance), number=nearest + 1,
        )  # fmt: skip
        found.append(Note("warning", text, nearest))
    lean = sequence.angles[:, 0]
    share = lean_edge_share(lean, settings.lean.lower, settings.lean.upper)
    if share > 0.0:
        edge = np.isclose(lean, settings.lean.lower) | np.isclose(lean, settings.lean.upper)
        text = translate(
            "{share} % of the waypoints lie at the edge of the lean range; a wider range may give "
            "a better plan.",
            share=decimal(PERCENT * share, 0),
        )
        found.append(Note("info", text, int(np.argmax(edge))))
    return found


def check_words(check: Check, translate: Translate) -> str:
    """A check of the program in a sentence: its name, value, limit and place."""
    value, bound = figures(check.value, check.limit)
    limit = translate(
        "{name}: {value}, limit {limit}",
        name=translate(check.name),
        value=check_figure(value, check.unit, translate),
        limit=bound,
    )
    return f"{limit} · {sentence(check.detail, translate)}" if check.detail else limit
