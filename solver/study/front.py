"""The front of clearance against joint motion as an experiment: table, knee and drawing."""

from __future__ import annotations

from typing import Any

from solver.model.settings import Scheme
from solver.study.context import Study, second_difference
from solver.study.pareto import front_points, knee
from solver.study.schemes import MOTION_COLUMNS, motion_cells
from solver.study.sections import Column, Drawing, Section, StudyTable, counted
from solver.units import DEG_PER_RAD, MM_PER_M


def front(study: Study) -> Section:
    """Exact optima for all hard minima on the cell's grid."""
    found = study.front
    points = front_points(found)
    at = knee(points)
    table = StudyTable(
        "front",
        "Exact optima by rising hard minimum",
        (Column("number"), *MOTION_COLUMNS, Column("knee")),
        tuple(
            (number, *motion_cells(one, study.problem), number - 1 == at)
            for number, one in enumerate(found, 1)
        ),
    )
    text = [
        f"{counted(len(found), 'point')} from {points[0, 0] * MM_PER_M:.2f} mm at a joint cost of "
        f"{points[0, 1]:.5f} to {points[-1, 0] * MM_PER_M:.2f} mm at {points[-1, 1]:.5f}; each is "
        "the proven optimum of this grid for its minimum, and none dominates another.",
    ]
    if at is not None:
        text.append(
            f"The knee, farthest below the line between both ends, is point {at + 1}: "
            f"{points[at, 0] * MM_PER_M:.2f} mm for {points[at, 1]:.5f}. Beyond it clearance "
            "becomes dearer."
        )
    numbers: dict[str, Any] = {
        "points": [
            {
                "least_clearance_mm": one.least_clearance * MM_PER_M,
                "joint_cost": one.joint_cost,
                "largest_second_difference_deg": second_difference(one, study.problem)
                * DEG_PER_RAD,
                "nodes": [int(node) for node in one.nodes],
            }
            for one in found
        ],
        "knee": at,
    }
    return Section(
        "front",
        "Clearance against joint motion",
        tuple(text),
        (table,),
        (Drawing("front", "The front with its knee and the schemes", _draw(study)),),
        numbers,
    )


def _draw(study: Study) -> Any:
    points = front_points(study.front)
    at = knee(points)
    marks = [(one.value, study.sequence(one)) for one in (Scheme.F, Scheme.F1, Scheme.F2)]

    def draw(figure: Any) -> None:
        axes = figure.add_subplot()
        axes.step(points[:, 0] * MM_PER_M, points[:, 1], where="pre", color="0.6", lw=1.0)
        axes.plot(points[:, 0] * MM_PER_M, points[:, 1], ".", label="exact")
        if at is not None:
            knee_at = (points[at, 0] * MM_PER_M, points[at, 1])
            axes.plot(*knee_at, "o", mfc="none", ms=11, color="#D55E00", label="knee")
        for (name, one), shape in zip(marks, "^sv", strict=True):
            axes.plot(
                one.least_clearance * MM_PER_M, one.joint_cost, shape, ms=6, mfc="none",
                color="black", label=name,
            )  # fmt: skip
        refined = study.refined.sequence
        axes.plot(
            refined.least_clearance * MM_PER_M, refined.joint_cost, "*", ms=10,
            color="#009E73", label="refined grid",
        )  # fmt: skip
        axes.set_xlabel("least clearance [mm]")
        axes.set_ylabel("joint cost")
        axes.legend(fontsize="small")
        axes.grid(alpha=0.3)

    return draw
