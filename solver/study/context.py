"""What all experiments of one study share: the cell, its plans, and the shipped parameters."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property

import numpy as np

from solver.analysis.result import PlanningResult, Sequence
from solver.catalog import load_cell
from solver.errors import PosoptError
from solver.model.problem import PlanningProblem
from solver.model.settings import CostWeights, EdgeCost, Scheme
from solver.pipeline.planning import plan
from solver.progress import Monitor, SilentMonitor
from solver.search.graph import LayeredGraph
from solver.study.pareto import front_of
from solver.study.published import Parameters, Published, PublishedRun, StudyData
from solver.study.refinement import Refined, refine
from solver.transforms import FloatArray
from solver.units import DEG_PER_RAD

PAPER_SCHEMES = (Scheme.F, Scheme.F1, Scheme.F2)
ALL_SCHEMES = (*PAPER_SCHEMES, Scheme.EXACT)


class Study:
    """A cell under study; what several experiments need is computed once."""

    def __init__(self, data: StudyData, cell: str = "", monitor: Monitor | None = None) -> None:
        self.data = data
        self.cell = cell or data.cell
        self.monitor = monitor or SilentMonitor()
        self.problem = papers_objective(load_cell(self.cell))
        self._beams: dict[str, PlanningResult | str] = {}

    @property
    def parameters(self) -> Parameters:
        """Parameters of the experiments."""
        return self.data.parameters

    @property
    def published(self) -> Published:
        """Published figures."""
        return self.data.published

    @property
    def is_published_cell(self) -> bool:
        """Whether published figures stand for this cell."""
        return self.problem.name == self.data.cell

    def published_run(self, scheme: Scheme) -> PublishedRun:
        """What is published of a scheme on this very cell and beam."""
        own = self.is_published_cell and self.problem.workpiece.name == self.published.beam
        return self.published.schemes.get(scheme.value, _NOTHING) if own else _NOTHING

    @cached_property
    def result(self) -> PlanningResult:
        """The cell planned with every scheme; the chosen one is f2, which the paper proposes."""
        return plan(self.problem, self.monitor, compare=ALL_SCHEMES)

    def sequence(self, scheme: Scheme) -> Sequence:
        """The cell's sequence of a scheme."""
        return self.result.sequences[scheme]

    def on_beam(self, name: str) -> PlanningResult | str:
        """The cell with another section, or the sentence that says why there is no plan."""
        if name not in self._beams:
            try:
                if name == self.problem.workpiece.name:
                    self._beams[name] = self.result
                else:
                    problem = papers_objective(load_cell(self.cell, beam=name))
                    self._beams[name] = plan(problem, self.monitor, compare=ALL_SCHEMES)
            except PosoptError as error:
                self._beams[name] = sentence(error)
        return self._beams[name]

    @cached_property
    def refined(self) -> Refined:
        """The cell's grid refined around its optimum."""
        return refine(self.problem, self.parameters, self.monitor)

    @cached_property
    def front(self) -> tuple[Sequence, ...]:
        """Optima of all hard minima on the cell's own grid, by rising clearance."""
        return front_of(self.result, self.parameters.front_step, self.monitor)

    def timed(self, action: Callable[[], object]) -> float:
        """Median wall time of some runs [s]."""
        return median_time(action, self.parameters.time_repeats)


_NOTHING = PublishedRun("")


def sentence(error: PosoptError) -> str:
    """What an error says, without the file it speaks of and without its full stop."""
    return str(getattr(error, "message", error)).rstrip(".")


def papers_objective(problem: PlanningProblem) -> PlanningProblem:
    """The problem with the paper's joint cost and f2 as its scheme; weights of its own go."""
    settings = replace(
        problem.settings, scheme=Scheme.F2, edge_cost=EdgeCost.ABSOLUTE, weights=CostWeights()
    )
    return replace(problem, settings=settings)


def median_time(action: Callable[[], object], repeats: int) -> float:
    """Median wall time of some runs after one that is not counted [s]."""
    action()
    times = []
    for _ in range(repeats):
        started = time.perf_counter()
        action()
        times.append(time.perf_counter() - started)
    return statistics.median(times)


def plain_graph(graph: LayeredGraph) -> LayeredGraph:
    """The graph with the joint cost alone, as the schemes of the paper search it."""
    return replace(graph, node_cost=np.zeros(graph.node_count), squared=False)


def second_differences(sequence: Sequence, problem: PlanningProblem) -> FloatArray:
    """(k, 6) second differences of the pendant's joints within the passes [rad].

    They stand for the accelerations that the controller is asked for.
    """
    number = problem.toolpath.pass_index
    within = number[2:] == number[:-2]
    found: FloatArray = np.diff(sequence.pendant, n=2, axis=0)[within]
    return found


def second_difference(sequence: Sequence, problem: PlanningProblem) -> float:
    """Largest second difference of any joint [rad]; nan where no pass has three waypoints."""
    found = np.abs(second_differences(sequence, problem))
    return float(found.max()) if found.size else float("nan")


def lean_range(sequence: Sequence, angle: int = 0) -> str:
    """Least and largest lean in words; of the lead with `angle` 1."""
    angles = sequence.angles[:, angle] * DEG_PER_RAD + 0.0
    return f"{angles.min():.4g} to {angles.max():.4g}"
