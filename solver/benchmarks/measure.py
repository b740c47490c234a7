"""What `posopt bench` measures: planning end to end, its stages, and the search against a peer."""

from __future__ import annotations

import itertools
import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from solver.benchmarks.plain_astar import plain_astar
from solver.candidates.generate import CandidateSet, generate
from solver.candidates.outcomes import Outcome
from solver.costs.penalty import safety_penalty
from solver.io.importers import resample
from solver.model.problem import PlanningProblem
from solver.model.settings import BRANCHES, Scheme
from solver.pipeline.planning import exact_sequence, layered_graph, paper_sequence, plan
from solver.progress import SilentMonitor


@dataclass(frozen=True, slots=True)
class PlanTiming:
    """Medians of one cell [s] and what they were spent on."""

    cell: str
    waypoints: int
    candidates: int
    feasible_share: float
    nodes: int
    body_pairs: int
    total: float
    candidate_stage: float
    exact_search: float
    f2_search: float


@dataclass(frozen=True, slots=True)
class PeerTiming:
    """The search f2 against a plain Python A* of the paper on the same graph [s]."""

    cell: str
    ours: float
    exact: float
    plain: float
    same_cost: bool


def median_time(action: Callable[[], object], repeats: int) -> float:
    """Median wall time of `repeats` runs after one that is not counted [s]."""
    action()
    times = []
    for _ in range(repeats):
        started = time.perf_counter()
        action()
        times.append(time.perf_counter() - started)
    return statistics.median(times)


def all_branches(problem: PlanningProblem) -> PlanningProblem:
    """The problem with all eight branches."""
    settings = replace(problem.settings, branches=tuple(range(BRANCHES)))
    return replace(problem, settings=settings)


def lengthened(problem: PlanningProblem, waypoints: int) -> PlanningProblem:
    """The problem with its path resampled to about this many waypoints."""
    positions = problem.toolpath.poses[:, :3, 3]
    length = float(np.linalg.norm(np.diff(positions, axis=0), axis=1).sum())
    toolpath = resample(problem.toolpath, length / (waypoints - 1) * (1.0 + 1e-12))
    return replace(problem, toolpath=toolpath)


def time_plan(problem: PlanningProblem, repeats: int) -> PlanTiming:
    """Time planning from the problem to its sequence, and its stages."""
    monitor = SilentMonitor()
    candidates = generate(problem)
    graph = layered_graph(candidates)
    shape = candidates.outcome.shape
    return PlanTiming(
        cell=problem.name,
        waypoints=shape[0],
        candidates=candidates.outcome.size,
        feasible_share=candidates.counts()[Outcome.FEASIBLE] / candidates.outcome.size,
        nodes=len(candidates.nodes),
        body_pairs=candidates.scene.pair_count,
        total=median_time(lambda: plan(problem), repeats),
        candidate_stage=median_time(lambda: generate(problem), repeats),
        exact_search=median_time(lambda: exact_sequence(candidates, graph, monitor), repeats),
        f2_search=median_time(
            lambda: paper_sequence(candidates, graph, Scheme.F2, monitor), repeats
        ),
    )


def time_peer(problem: PlanningProblem, repeats: int) -> PeerTiming:
    """Time f2 and exact against the plain Python A* on one graph."""
    candidates = generate(problem)
    graph = layered_graph(candidates)
    monitor = SilentMonitor()
    ours = paper_sequence(candidates, graph, Scheme.F2, monitor)
    found: list[float] = []
    plain = median_time(lambda: found.append(_plain_cost(candidates)), max(1, repeats // 4))
    return PeerTiming(
        cell=problem.name,
        ours=median_time(lambda: paper_sequence(candidates, graph, Scheme.F2, monitor), repeats),
        exact=median_time(lambda: exact_sequence(candidates, graph, monitor), repeats),
        plain=plain,
        same_cost=abs(found[-1] - ours.cost) <= 1e-9,
    )


def _plain_cost(candidates: CandidateSet) -> float:
    nodes, problem = candidates.nodes, candidates.problem
    penalty = safety_penalty(nodes.clearance, problem.settings.safety_distance)
    layers, costs = [], []
    for first, last in itertools.pairwise(nodes.offsets):
        layers.append(nodes.model[first:last].tolist())
        costs.append(penalty[first:last].tolist())
    ranges = problem.robot.cost_ranges.tolist()
    return plain_astar(layers, costs, ranges, problem.settings.heuristic_weight).cost
