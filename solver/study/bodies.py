"""Capsules against cylinders: what the rounded ends of the bodies cost."""

from __future__ import annotations

import numpy as np

from solver.candidates.generate import touch_numbers
from solver.candidates.postures import check_exact_postures
from solver.collision.kernels_scene import FREE
from solver.collision.scene import build_scene
from solver.model.problem import PlanningProblem
from solver.model.settings import Scheme
from solver.study.context import ALL_SCHEMES, Study
from solver.study.sections import Column, Section, StudyTable, Value
from solver.study.variants import planned, with_cylinders
from solver.units import MM_PER_M


def bodies(study: Study) -> Section:
    """The cell with its capsules, and with cylinders of the same axes and radii."""
    title = "Capsules against cylinders"
    flat, count = with_cylinders(study.problem)
    if not count:
        return Section("bodies", title, reason="no body of this robot and tool is a capsule")
    result = planned(flat, study.monitor, ALL_SCHEMES)
    if isinstance(result, str):
        return Section("bodies", title, reason=result)
    round_ = study.result
    rows: list[tuple[Value, ...]] = []
    for kind, one in (("capsules", round_), ("cylinders", result)):
        for scheme in ALL_SCHEMES:
            sequence = one.sequences[scheme]
            rows.append(
                (
                    kind,
                    scheme.value,
                    len(one.candidates.nodes),
                    sequence.joint_cost,
                    sequence.least_clearance * MM_PER_M,
                    sequence.mean_clearance * MM_PER_M,
                )
            )
    table = StudyTable(
        "bodies",
        "The same cell with capsules and with cylinders",
        (
            Column("bodies"),
            Column("scheme"),
            Column("nodes"),
            Column("joint cost", "", 5),
            Column("least clearance", "mm"),
            Column("mean clearance", "mm"),
        ),
        tuple(rows),
    )
    extra = _understated(study, flat)
    gained = len(result.candidates.nodes) - len(round_.candidates.nodes)
    exact = [one.sequences[Scheme.EXACT].joint_cost for one in (round_, result)]
    text = (
        f"On the {len(extra):,} feasible poses a capsule states {extra.mean() * MM_PER_M:.1f} mm "
        f"less clearance than the cylinder inside it on average, and up to "
        f"{extra.max() * MM_PER_M:.1f} mm. {gained:,} poses that collide with capsules are free "
        f"with cylinders, and the exact joint cost is {exact[1]:.5f} instead of {exact[0]:.5f}.",
        "Capsules err on the safe side and their distance is a closed form; cylinders need an "
        "iteration that is closed by a lower bound, which is what is computed here."
        + _published_words(study, result.sequences[Scheme.F].least_clearance),
    )
    numbers = {
        "mean_understated_mm": float(extra.mean()) * MM_PER_M,
        "largest_understated_mm": float(extra.max()) * MM_PER_M,
        "nodes_gained": gained,
    }
    return Section("bodies", title, text, (table,), numbers=numbers)


def _published_words(study: Study, with_cylinders: float) -> str:
    """Which bodies come closer to what is published of f; '' where nothing is."""
    known = study.published_run(Scheme.F).least_clearance
    if known is None:
        return ""
    away = [abs(one - known) for one in (study.sequence(Scheme.F).least_clearance, with_cylinders)]
    word = "farther from" if away[1] > away[0] else "nearer to"
    return (
        " The paper speaks of cylinders; with them f would pass at "
        f"{with_cylinders * MM_PER_M:.1f} mm, {word} the published "
        f"{known * MM_PER_M:.1f} mm than with capsules. Which cell the paper had cannot be told "
        "from that."
    )


def _understated(study: Study, flat: PlanningProblem) -> np.ndarray:
    """(k,) clearance with cylinders minus that with capsules, of the feasible poses [m]."""
    candidates, problem = study.result.candidates, study.problem
    nodes = candidates.nodes
    scene = build_scene(flat)
    touch = touch_numbers(problem, scene)[nodes.candidate[:, 0]]
    checked = check_exact_postures(problem.robot, scene, nodes.pendant, touch)
    free = (checked.status == FREE) & np.isfinite(checked.clearance)
    extra: np.ndarray = checked.clearance[free] - nodes.clearance[free]
    return extra
