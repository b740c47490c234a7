"""Small cells and parameters, so that a whole study takes seconds."""

from dataclasses import replace
from pathlib import Path

from solver.catalog.names import resource_folder
from solver.study.context import Study
from solver.study.published import load_study
from solver.study.sections import shown
from solver.units import DEG

QUICK = {
    "time_repeats": 1,
    "weight_seeds": (1, 2),
    "weight_pairs": 10,
    "random_draws": 5,
    "lean_steps": (5.0 * DEG, 2.5 * DEG),
    "wider_lean": (35.0 * DEG,),
    "lead_step": 5.0 * DEG,
    "placement_draws": 10,
    "refine_halvings": 2,
    "bound_pairs": 200_000,
}


def quick_data():
    data = load_study("paper")
    return replace(data, parameters=replace(data.parameters, **QUICK))


POINTS = "points = 50"
LEANS = "lean_deg = [-25.0, 25.0, 1.0]"
SAFETY = "safety_distance_mm = 50.0"
SEED = "seed = 1"

OTHER = {
    'bodies = "paper"': 'bodies = "full"',
    POINTS: "points = 10",
    LEANS: "lean_deg = [-25.0, 25.0, 2.5]",
    "branches = [0]": "branches = [0, 1, 2, 3]",
    'turns = "principal"': 'turns = "all"',
    SAFETY: "safety_distance_mm = 30.0",
}
"""All bodies of the robot, four branches, every turn and a coarse grid."""


def other_cell(folder: Path, changes=OTHER) -> Path:
    """The paper's cell under another name with some lines changed."""
    text = (resource_folder() / "cells" / "groove_paper.toml").read_text("utf-8")
    for before, after in {'name = "groove_paper"': 'name = "other"', **changes}.items():
        assert before in text
        text = text.replace(before, after)
    path = folder / "other.toml"
    path.write_text(text, "utf-8")
    return path


def quick_study(cell: str = "") -> Study:
    return Study(quick_data(), str(cell))


def shortened(problem, every):
    """The problem with every so-manieth waypoint of its first pass."""
    one = problem.toolpath.passes[0]
    part = replace(one, poses=one.poses[::every], roles=one.roles[::every], events={})
    return replace(problem, toolpath=problem.toolpath.with_passes((part,)))


def markdown(table):
    """A table as it stands in the documentation, without measured times."""
    kept = [(at, one) for at, one in enumerate(table.columns) if not one.timing]
    head = "| " + " | ".join(one.head for _, one in kept) + " |"
    rows = ["| " + " | ".join(shown(row[at], one) for at, one in kept) + " |" for row in table.rows]
    return "\n".join([head, "|" + "---|" * len(kept), *rows])
