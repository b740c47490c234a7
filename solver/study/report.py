"""A study as a whole: its experiments in order, run one after the other."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from types import MappingProxyType
from typing import Any

from solver.errors import InputError, PosoptError
from solver.progress import checkpoint
from solver.study.beams import beams
from solver.study.beating import beating, refined
from solver.study.bodies import bodies
from solver.study.constant import constant_lean
from solver.study.context import Study, sentence
from solver.study.front import front
from solver.study.graph_figures import graph_figures
from solver.study.grid import branches, lean_step
from solver.study.heuristic import heuristic
from solver.study.joints import joints
from solver.study.motion_figures import motion_figures
from solver.study.penalty import penalty
from solver.study.placement import placement
from solver.study.scene_figure import scene_figure
from solver.study.schemes import schemes
from solver.study.sections import Section
from solver.study.weight import weight
from solver.units import MM_PER_M

Experiment = Callable[[Study], Section]

EXPERIMENTS: Mapping[str, tuple[str, Experiment]] = MappingProxyType(
    {
        "schemes": ("Schemes", schemes),
        "beams": ("Beams", beams),
        "joints": ("Joint statistics", joints),
        "weight": ("Weight of the heuristic", weight),
        "graph": ("Graph and search", graph_figures),
        "motion": ("Along the path", motion_figures),
        "scene": ("The scene at the minimum", scene_figure),
        "penalty": ("The penalty is a hard filter", penalty),
        "heuristic": ("The heuristic is loose", heuristic),
        "lean_step": ("The lean step", lean_step),
        "constant": ("Constant lean", constant_lean),
        "branches": ("All branches", branches),
        "bodies": ("Capsules against cylinders", bodies),
        "placement": ("Placement error", placement),
        "refined": ("The refined plan", refined),
        "beating": ("Beating it", beating),
        "front": ("Clearance against joint motion", front),
    }
)
"""Every experiment under its key, with its title."""


@dataclass(frozen=True, slots=True, eq=False)
class StudyReport:
    """What a study found."""

    study: str
    title: str
    cell: str
    cell_title: str
    workpiece: str
    introduction: tuple[str, ...]
    assumptions: tuple[str, ...]
    parameters: Mapping[str, Any]
    sections: tuple[Section, ...]

    def section(self, key: str) -> Section:
        """The section of an experiment."""
        return next(one for one in self.sections if one.key == key)

    def document(self) -> dict[str, Any]:
        """The study as JSON (docs/study.md)."""
        return {
            "format": "posopt-study",
            "version": 1,
            "study": self.study,
            "title": self.title,
            "cell": self.cell,
            "workpiece": self.workpiece,
            "introduction": list(self.introduction),
            "assumptions": list(self.assumptions),
            "parameters": dict(self.parameters),
            "sections": [one.document() for one in self.sections],
        }


def run_study(study: Study, only: Sequence[str] = ()) -> StudyReport:
    """Run all experiments, or some by their keys, in the order of the report.

    An experiment that cannot be made on this cell is a section that says why.

    Raises
    ------
    InputError
        A key names no experiment.
    PlanningError
        The cell itself has no sequence.
    Cancelled
        When the monitor asks for it.
    """
    for key in only:
        if key not in EXPERIMENTS:
            known = ", ".join(EXPERIMENTS)
            raise InputError(f"no experiment is called {key!r} (known: {known})")
    chosen = [key for key in EXPERIMENTS if not only or key in only]
    problem = study.result.problem
    sections = []
    for number, key in enumerate(chosen):
        checkpoint(study.monitor, "study", number, len(chosen))
        sections.append(run_experiment(study, key))
    return StudyReport(
        study.data.name,
        study.data.title,
        problem.name,
        problem.title or problem.name,
        problem.workpiece.name,
        _introduction(study),
        (*problem.assumptions, *problem.tool.assumptions, *problem.robot.assumptions),
        asdict(study.parameters),
        tuple(sections),
    )


def run_experiment(study: Study, key: str) -> Section:
    """One experiment; where the cell does not allow it, a section that says why."""
    title, experiment = EXPERIMENTS[key]
    try:
        return experiment(study)
    except PosoptError as error:
        return Section(key, title, reason=sentence(error))


def _introduction(study: Study) -> tuple[str, ...]:
    problem, source = study.problem, study.published.source
    waypoints = len(problem.toolpath)
    if study.is_published_cell:
        first = (
            f"The cell of the paper is not published. {problem.name} is a reconstruction that "
            "comes close to its results; its assumptions follow. Published values are shown beside "
            f"the computed ones and come from: {source}."
        )
    else:
        first = (
            f"{problem.name} is not the paper's cell, so no published value stands beside these. "
            f"The method is that of: {source}."
        )
    second = (
        f"{waypoints} waypoints on {problem.workpiece.name}, robot {problem.robot.title} (bodies "
        f"{problem.bodies}), tool {problem.tool.title}, safety distance "
        f"{problem.settings.safety_distance * MM_PER_M:g} mm. All schemes minimise the paper's "
        "joint cost; weights of the cell's own are left aside. Clearances are lower bounds on the "
        "nominal model, at the waypoints."
    )
    return first, second
