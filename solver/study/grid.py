"""What the grid itself decides: the lean step, and the branches that are looked at."""

from __future__ import annotations

from solver.model.settings import BRANCHES, Scheme, Sweep, Turns
from solver.study.context import ALL_SCHEMES, Study, lean_range
from solver.study.sections import Column, Section, StudyTable, Value, counted, percent
from solver.study.variants import planned, symmetric, with_settings
from solver.units import DEG_PER_RAD, MM_PER_M


def lean_step(study: Study) -> Section:
    """The same cell with coarser and finer lean steps, on its own range and on a wider one."""
    title = "The lean step"
    own = study.problem.settings.lean
    if own.upper <= own.lower:
        return Section("lean_step", title, reason="the lean of this cell is fixed")
    ranges = {_range_name(own): own}
    if study.parameters.wider_lean:
        wide = symmetric(study.parameters.wider_lean[0], own.step)
        ranges[_range_name(wide)] = wide
    rows: list[tuple[Value, ...]] = []
    for sweep in ranges.values():
        rows += [row for step in study.parameters.lean_steps if (row := _row(study, sweep, step))]
    table = StudyTable(
        "lean_step",
        "Lean steps",
        (
            Column("lean range", "deg"),
            Column("step", "deg", 2),
            Column("nodes"),
            Column("f1 least clearance", "mm"),
            Column("f1 joint cost", "", 5),
            Column("f1 lean", "deg"),
            Column("exact least clearance", "mm"),
            Column("exact joint cost", "", 5),
        ),
        tuple(rows),
    )
    numbers = {}
    text = []
    for name in ranges:
        part = [row for row in rows if row[0] == name]
        if len(part) > 1:
            least = [float(row[3]) for row in part if isinstance(row[3], float)]
            numbers[name] = {"f1_least_clearance_mm": [min(least), max(least)]}
            text.append(
                f"Lean {name} deg: from a step of {part[0][1]:g} to {part[-1][1]:g} deg the least "
                f"clearance of f1 lies between {min(least):.2f} and {max(least):.2f} mm, the exact "
                f"joint cost falls from {part[0][7]:.5f} to {part[-1][7]:.5f}."
            )
    text.append(
        "A search for joint motion alone has no reason to keep away from anything: it goes to the "
        "edge of the lean range or to the last node before a collision. Its clearance is what the "
        "grid happens to leave there, and no measure of the cell. Under a hard minimum only the "
        "cost changes with the step."
    )
    return Section("lean_step", title, tuple(text), (table,), numbers=numbers)


def _range_name(sweep: Sweep) -> str:
    return f"{sweep.lower * DEG_PER_RAD:g} to {sweep.upper * DEG_PER_RAD:g}"


def _row(study: Study, sweep: Sweep, step: float) -> tuple[Value, ...] | None:
    orientations = (sweep.upper - sweep.lower) / step
    waypoints, branches = len(study.problem.toolpath), len(study.problem.settings.branches)
    if orientations * waypoints * branches > study.parameters.refine_nodes:
        return None
    lean = Sweep(sweep.lower, sweep.upper, step)
    problem = with_settings(study.problem, lean=lean, scheme=Scheme.F1)
    result = planned(problem, study.monitor, (Scheme.EXACT,))
    if isinstance(result, str):
        return None
    f1, best = result.sequences[Scheme.F1], result.sequences[Scheme.EXACT]
    return (
        _range_name(sweep),
        step * DEG_PER_RAD,
        len(result.candidates.nodes),
        f1.least_clearance * MM_PER_M,
        f1.joint_cost,
        lean_range(f1),
        best.least_clearance * MM_PER_M,
        best.joint_cost,
    )


def branches(study: Study) -> Section:
    """The cell's branches, all branches, and all branches with every turn."""
    own = study.problem.settings
    every = tuple(range(BRANCHES))
    count = counted(len(own.branches), "branch", "branches")
    kinds = {
        f"the cell's: {count}, {own.turns.value} turns": (own.branches, own.turns),
        f"all branches, {Turns.PRINCIPAL.value} turns": (every, Turns.PRINCIPAL),
        f"all branches, {Turns.ALL.value} turns": (every, Turns.ALL),
    }
    rows: list[tuple[Value, ...]] = []
    for name, (chosen, turns) in kinds.items():
        problem = with_settings(study.problem, branches=chosen, turns=turns)
        result = planned(problem, study.monitor, ALL_SCHEMES)
        if isinstance(result, str):
            continue
        for scheme in ALL_SCHEMES:
            one = result.sequences[scheme]
            rows.append(
                (
                    name,
                    scheme.value,
                    len(result.candidates.nodes),
                    one.expanded,
                    one.joint_cost,
                    one.least_clearance * MM_PER_M,
                    ", ".join(map(str, sorted(set(one.branch.tolist())))),
                )
            )
    table = StudyTable(
        "branches",
        "Branches of the inverse kinematics",
        (
            Column("candidates"),
            Column("scheme"),
            Column("nodes"),
            Column("expanded"),
            Column("joint cost", "", 5),
            Column("least clearance", "mm"),
            Column("branches used"),
        ),
        tuple(rows),
    )
    costs = {(str(row[0]), str(row[1])): float(row[4] or 0.0) for row in rows}
    names = list(dict.fromkeys(str(row[0]) for row in rows))
    gain = costs[names[-1], Scheme.EXACT.value] / costs[names[0], Scheme.EXACT.value] - 1.0
    verdict = (
        "The cell's own choice of branches loses nothing against all of them."
        if abs(gain) < 1e-9
        else f"All branches change the exact joint cost by {percent(gain)} against the cell's own."
    )
    text = (
        f"{verdict} All of them cost more nodes for the searches; only looking at all of them "
        "shows whether a chosen one was the right one.",
    )
    return Section("branches", "All branches", text, (table,), numbers={"exact_cost_change": gain})
