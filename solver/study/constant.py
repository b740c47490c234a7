"""The best constant lean: what a programmer without a search would choose, and its price."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from solver.analysis.result import PlanningResult, Sequence, sequence_of
from solver.model.settings import Scheme
from solver.search.exact import cheapest
from solver.study.context import Study, second_difference
from solver.study.sections import Column, Section, StudyTable, counted, percent
from solver.units import DEG_PER_RAD, MM_PER_M

ANGLE_SLACK = 1e-9
COST_SLACK = 1e-9


def constant_sequences(result: PlanningResult) -> list[Sequence]:
    """The cheapest sequence of every constant orientation that is feasible all along."""
    number = result.candidates.nodes.candidate[:, 1]
    found = [_cheapest_of(result, number == one) for one in np.unique(number)]
    return [one for one in found if one is not None]


def best_constant(result: PlanningResult, least: float = -np.inf) -> Sequence | None:
    """The cheapest constant orientation whose clearance is at least `least` [m]."""
    fits = [one for one in constant_sequences(result) if one.least_clearance >= least]
    return min(fits, key=lambda one: one.joint_cost, default=None)


def nominal_sequence(result: PlanningResult) -> Sequence | None:
    """The cheapest sequence that holds the orientation nearest to each pass's nominal one."""
    nodes, toolpath = result.candidates.nodes, result.problem.toolpath
    angles = result.candidates.orientations
    chosen = np.zeros(len(nodes), dtype=np.bool_)
    for number, one in enumerate(toolpath.passes):
        away = np.abs(angles - (one.lean, one.lead, 0.0)).sum(axis=1)
        own = toolpath.pass_index[nodes.candidate[:, 0]] == number
        chosen |= own & (nodes.candidate[:, 1] == int(away.argmin()))
    return _cheapest_of(result, chosen)


def _cheapest_of(result: PlanningResult, chosen: NDArray[np.bool_]) -> Sequence | None:
    graph, parent = result.graph.subgraph(chosen)
    if np.any(np.diff(graph.offsets) == 0):
        return None
    path, cost = cheapest(graph)
    if not len(path):
        return None
    return sequence_of(result.candidates, Scheme.EXACT, parent[path], cost)


def edge_run(sequence: Sequence, result: PlanningResult) -> int:
    """Waypoints from the first one on at which the lean stays on the same edge of its range."""
    lean, sweep = sequence.angles[:, 0], result.problem.settings.lean
    angles = sweep.angles()
    if len(angles) < 2 or np.abs(lean[0] - angles[[0, -1]]).min() > ANGLE_SLACK:
        return 0
    away = np.flatnonzero(np.abs(lean - lean[0]) > ANGLE_SLACK)
    return int(away[0]) if len(away) else len(lean)


def constant_lean(study: Study) -> Section:
    """Every constant lean beside f1, and how long f2 stays on the best one."""
    result = study.result
    found = constant_sequences(result)
    title = "Constant lean"
    if not found:
        return Section(
            "constant", title, reason="no constant orientation is feasible along this path"
        )
    table = StudyTable(
        "constant",
        "Constant orientations that are feasible all along",
        (
            Column("lean", "deg", 2),
            Column("lead", "deg", 2),
            Column("joint cost", "", 5),
            Column("least clearance", "mm"),
            Column("mean clearance", "mm"),
            Column("largest second difference", "deg", 3),
        ),
        tuple(
            (
                float(one.angles[0, 0]) * DEG_PER_RAD,
                float(one.angles[0, 1]) * DEG_PER_RAD,
                one.joint_cost,
                one.least_clearance * MM_PER_M,
                one.mean_clearance * MM_PER_M,
                second_difference(one, study.problem) * DEG_PER_RAD,
            )
            for one in found
        ),
    )
    best, f1, f2 = best_constant(result), study.sequence(Scheme.F1), study.sequence(Scheme.F2)
    cheapest_one = best if best is not None else found[0]
    angle = float(cheapest_one.angles[0, 0]) * DEG_PER_RAD
    run = edge_run(f2, result)
    same = abs(cheapest_one.joint_cost - f1.joint_cost) <= COST_SLACK
    first = (
        f"The best constant lean, {angle:g} deg, costs {cheapest_one.joint_cost:.5f}, which is "
        "exactly what f1 finds: there the search gains nothing that a programmer would not have "
        "found by trying constant leans."
        if same
        else f"The best constant lean, {angle:g} deg, costs {cheapest_one.joint_cost:.5f}; f1 "
        f"saves {percent(1.0 - f1.joint_cost / cheapest_one.joint_cost)} of it."
    )
    safe = best_constant(result, result.problem.settings.safety_distance)
    second = (
        "No constant lean keeps the safety distance, so f2 is needed to keep it."
        if safe is None
        else f"Constant {float(safe.angles[0, 0]) * DEG_PER_RAD:g} deg keeps the safety distance "
        f"at a joint cost of {safe.joint_cost:.5f}; f2 costs {f2.joint_cost:.5f}."
    )
    third = (
        f"f2 stays on the edge of the lean range for its first {counted(run, 'waypoint')}: "
        "a wider range may serve it."
        if run
        else "f2 does not begin on the edge of the lean range."
    )
    numbers = {
        "best_lean_deg": angle,
        "best_joint_cost": cheapest_one.joint_cost,
        "f1_joint_cost": f1.joint_cost,
        "equals_f1": same,
        "keeps_safety_distance": safe is not None,
        "waypoints_of_f2_on_the_edge": run,
    }
    return Section("constant", title, (first, second, third), (table,), numbers=numbers)
