"""Beating f2 on the same cell and metrics: what else one search can give, exactly."""

from __future__ import annotations

import numpy as np

from solver.analysis.result import PlanningResult, Sequence
from solver.errors import PosoptError
from solver.model.problem import PlanningProblem
from solver.model.settings import EdgeCost, Scheme
from solver.search.bottleneck import best_minimum_clearance
from solver.study.context import Study, lean_range, second_difference, second_differences, sentence
from solver.study.lower_bound import LowerBound, lower_bounds, obstacle
from solver.study.pareto import optimum_above
from solver.study.refinement import Refined, refine
from solver.study.schemes import MOTION_COLUMNS, motion_cells
from solver.study.sections import Column, Section, StudyTable, Value, percent
from solver.study.variants import planned, symmetric, with_settings
from solver.units import DEG_PER_RAD, MM_PER_M

REFINED = "lean grid refined"
SQUARED = "squared edges"
SQUARED_REFINED = "squared edges, lean grid refined"
BOTH = ", squared edges, refined"
MAX_MIN = "largest minimum, then cost"


def refined(study: Study) -> Section:
    """The refined plan, its rounds, and how far below it any choice of leans could come."""
    found = study.refined
    f2 = study.sequence(Scheme.F2)
    rows: list[tuple[Value, ...]] = [
        (
            number,
            one.step * DEG_PER_RAD,
            one.nodes,
            *motion_cells(one.sequence, study.problem),
            None if np.isnan(one.gain) else 100.0 * one.gain,
        )
        for number, one in enumerate(found.rounds)
    ]
    table = StudyTable(
        "refined",
        "Rounds of refinement",
        (
            Column("halvings"),
            Column("lean step", "deg", 5),
            Column("nodes"),
            *MOTION_COLUMNS,
            Column("gain", "%", 3),
        ),
        tuple(rows),
    )
    best = found.sequence
    uneven = [second_difference(one, study.problem) * DEG_PER_RAD for one in (best, f2)]
    text = [
        f"Halving the steps around what is nearly optimal ends after "
        f"{len(found.rounds) - 1} rounds ({found.ended}) at a joint cost of {best.joint_cost:.5f}, "
        f"{percent(best.joint_cost / f2.joint_cost - 1.0)} against f2, with a largest second "
        f"difference of {uneven[0]:.2f} instead of {uneven[1]:.2f} deg and "
        f"{best.least_clearance * MM_PER_M:.2f} mm least clearance. Every filter and limit of the "
        "cell holds, and the joints keep the hard minimum as a program writes them, rounded.",
    ]
    words, numbers = _bound(study, found)
    text.append(words)
    numbers |= {
        "joint_cost": best.joint_cost,
        "f2_joint_cost": f2.joint_cost,
        "least_clearance_mm": best.least_clearance * MM_PER_M,
        "largest_second_difference_deg": uneven[0],
        "f2_largest_second_difference_deg": uneven[1],
        "hard_minimum_mm": found.hard_minimum * MM_PER_M,
    }
    return Section("refined", "The refined plan", tuple(text), (table,), numbers=numbers)


def _bound(study: Study, found: Refined) -> tuple[str, dict[str, object]]:
    why = obstacle(found.problem)
    if why:
        return f"No lower bound over all leans is computed: {why}.", {"lower_bound": None}
    bounds = lower_bounds(found.problem, found.sequence, study.parameters, study.monitor)
    own = [one for one in bounds if (found.sequence.branch == one.branch).all()]
    words = [_gap_words(one) for one in own]
    open_ = [one for one in bounds if one not in own and one.gap > study.parameters.bound_gap]
    if len(bounds) > len(own):
        shut = len(bounds) - len(own) - len(open_)
        words.append(
            f"Of the other branches, {shut} are shown to hold nothing cheaper than this; "
            + (f"for {', '.join(str(one.branch) for one in open_)} it is left open." if open_
               else "none is left open.")
        )  # fmt: skip
    words.append(
        "The bound takes the path's positions, one branch within a pass and the clearance at the "
        "waypoints for granted, and assumes that within an interval no joint leaves the box of its "
        "ends widened by what it bends there, and no body moves farther than to the ends plus the "
        "difference of both ways; it leaves aside the filters that can only make a plan dearer "
        "(manipulability, margins of near, contact and self pairs, steps)."
    )
    numbers: dict[str, object] = {
        "branches": [
            {"branch": one.branch, "lower_bound": one.value, "gap": one.gap} for one in bounds
        ],
        "lower_bound": own[0].value if own else None,
        "gap": own[0].gap if own else None,
    }
    return " ".join(words), numbers


def _gap_words(one: LowerBound) -> str:
    if one.pairs == 0:
        return f"A lower bound on branch {one.branch} would take too many pairs of intervals."
    return (
        f"Whatever the leans, on the plan's branch {one.branch} no sequence costs less than "
        f"{one.value:.5f}: at most {100.0 * one.gap:.2f} % could still be gained (intervals of "
        f"{one.step * DEG_PER_RAD:.4f} deg)."
    )


def beating(study: Study) -> Section:
    """All other ways beside f2, each with the same metrics."""
    rows: list[tuple[Value, ...]] = []
    plans: dict[str, Sequence] = {}
    notes: list[str] = []
    base = study.sequence(Scheme.F2)

    def add(name: str, sequence: Sequence | str) -> None:
        if isinstance(sequence, str):
            notes.append(f"{name}: {sequence}")
            return
        plans[name] = sequence
        rows.append(
            (
                name,
                *motion_cells(sequence, study.problem),
                lean_range(sequence, 1),
                _mean_square(sequence, study.problem) * DEG_PER_RAD,
                100.0 * (sequence.joint_cost / base.joint_cost - 1.0),
            )
        )

    add("f2", base)
    add("exact with a hard minimum", study.sequence(Scheme.EXACT))
    add(REFINED, study.refined.sequence)
    squared = with_settings(study.problem, edge_cost=EdgeCost.SQUARED, scheme=Scheme.EXACT)
    add(SQUARED, _exact(squared, study))
    add(SQUARED_REFINED, _refined(squared, study))
    for limit in study.parameters.wider_lean:
        lean = symmetric(limit, study.problem.settings.lean.step)
        wide = with_settings(study.problem, lean=lean, scheme=Scheme.EXACT)
        add(f"lean ±{limit * DEG_PER_RAD:g} deg", _exact(wide, study))
    lead = symmetric(study.parameters.lead_range, study.parameters.lead_step)
    two = with_settings(study.problem, lead=lead, scheme=Scheme.EXACT)
    name = f"lead ±{study.parameters.lead_range * DEG_PER_RAD:g} deg as a second angle"
    add(name, _exact(two, study))
    add(f"{name}{BOTH}", _refined(_squared(two), study))
    add(MAX_MIN, _largest_minimum(study.result, study))
    table = StudyTable(
        "beating",
        "The same cell, other objectives and grids",
        (
            Column("plan"),
            *MOTION_COLUMNS,
            Column("lead", "deg"),
            Column("root mean square of second differences", "deg", 3),
            Column("joint cost against f2", "%", 2),
        ),
        tuple(rows),
        " ".join(notes),
    )
    numbers = {
        name: {
            "joint_cost": one.joint_cost,
            "least_clearance_mm": one.least_clearance * MM_PER_M,
            "largest_second_difference_deg": second_difference(one, study.problem) * DEG_PER_RAD,
        }
        for name, one in plans.items()
    }
    return Section("beating", "Beating it", _words(plans, study), (table,), numbers=numbers)


def _squared(problem: PlanningProblem) -> PlanningProblem:
    return with_settings(problem, edge_cost=EdgeCost.SQUARED)


def _exact(problem: PlanningProblem, study: Study) -> Sequence | str:
    settings = problem.settings
    count = len(settings.lean.angles()) * len(settings.lead.angles()) * len(settings.spin.angles())
    if count * len(problem.toolpath) * len(settings.branches) > study.parameters.refine_nodes:
        return "the grid would hold too many orientations"
    found = planned(problem, study.monitor)
    return found if isinstance(found, str) else found.sequence


def _refined(problem: PlanningProblem, study: Study) -> Sequence | str:
    try:
        return refine(problem, study.parameters, study.monitor).sequence
    except PosoptError as error:
        return sentence(error)


def _largest_minimum(result: PlanningResult, study: Study) -> Sequence | str:
    """The cheapest of the sequences with the largest minimum that any can keep."""
    best = best_minimum_clearance(result.graph, result.candidates.nodes.clearance, study.monitor)
    found = optimum_above(result, best)
    return "no sequence exists" if found is None else found


def _mean_square(sequence: Sequence, problem: PlanningProblem) -> float:
    change = second_differences(sequence, problem)
    return float(np.sqrt((change**2).mean())) if change.size else float("nan")


def _words(plans: dict[str, Sequence], study: Study) -> tuple[str, ...]:
    f2, text = plans["f2"], []
    if SQUARED_REFINED in plans:
        one = plans[SQUARED_REFINED]
        ratio = second_difference(f2, study.problem) / second_difference(one, study.problem)
        text.append(
            "A squared edge term spreads the motion evenly: on the refined grid the largest second "
            f"difference is {ratio:.1f} times smaller than that of f2, at "
            f"{percent(one.joint_cost / f2.joint_cost - 1.0)} joint cost."
        )
    for name, one in plans.items():
        if name.endswith(BOTH):
            text.append(
                f"With the lead as a second angle: {percent(one.joint_cost / f2.joint_cost - 1)} "
                f"joint cost at {one.least_clearance * MM_PER_M:.2f} mm, with a largest second "
                f"difference of {second_difference(one, study.problem) * DEG_PER_RAD:.2f} deg. "
                "Whether the process allows that lead is not judged here."
            )
    if MAX_MIN in plans:
        one = plans[MAX_MIN]
        gain = (one.least_clearance - f2.least_clearance) * MM_PER_M
        text.append(
            f"In the same decision space the least clearance can be raised by {gain:.2f} mm at "
            f"most, to {one.least_clearance * MM_PER_M:.2f} mm, for "
            f"{percent(one.joint_cost / f2.joint_cost - 1.0)} joint cost."
        )
    return tuple(text)
