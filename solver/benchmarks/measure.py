"""What `posopt bench` measures: planning end to end, its stages, and the search against a peer."""

from __future__ import annotations

import itertools
import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from solver.benchmarks.plain_astar import plain_astar, plain_f
from solver.candidates.generate import generate
from solver.candidates.outcomes import Outcome
from solver.costs.penalty import safety_penalty
from solver.io.importers import resample
from solver.model.problem import PlanningProblem
from solver.model.settings import BRANCHES, Scheme
from solver.pipeline.planning import exact_sequence, layered_graph, paper_sequence, plan
from solver.progress import SilentMonitor
from solver.search.exact import cheapest

LEAST_TIME = 0.2
"""How long the runs of one measurement last in all, at least [s]."""


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
    """Searches of one graph against a plain Python A* of the paper [s]."""

    cell: str
    nodes: int
    exact: float
    f: float
    f2: float
    plain_f: float
    plain_f2: float
    same_costs: bool


def median_time(action: Callable[[], object], repeats: int) -> float:
    """Median wall time of runs after one that is not counted [s].

    At least `repeats` runs, and more of a short action until they have taken `LEAST_TIME`.
    """
    action()
    times: list[float] = []
    while len(times) < repeats or (sum(times) < LEAST_TIME and len(times) < 100 * repeats):
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
    """Time exact, f and f2 against the plain Python A* on one graph.

    The exact search finds the optimum of the joint cost alone, as f does, on the whole graph.
    """
    candidates = generate(problem)
    graph = layered_graph(candidates)
    free = replace(graph, node_cost=np.zeros(graph.node_count), squared=False)
    monitor = SilentMonitor()
    nodes, settings = candidates.nodes, problem.settings
    penalty = safety_penalty(nodes.clearance, settings.safety_distance)
    layers = [nodes.model[a:b].tolist() for a, b in itertools.pairwise(nodes.offsets)]
    penalties = [penalty[a:b].tolist() for a, b in itertools.pairwise(nodes.offsets)]
    ranges = problem.robot.cost_ranges.tolist()
    weight = settings.heuristic_weight
    peer_f, _ = plain_f(layers, ranges, weight)
    peer_f2 = plain_astar(layers, penalties, ranges, weight)
    ours_f = paper_sequence(candidates, graph, Scheme.F, monitor)
    ours_f2 = paper_sequence(candidates, graph, Scheme.F2, monitor)
    same = abs(peer_f.cost - ours_f.cost) < 1e-9 and abs(peer_f2.cost - ours_f2.cost) < 1e-9
    same = same and abs(cheapest(free)[1] - peer_f.cost) < 1e-9
    few = max(1, repeats // 4)
    return PeerTiming(
        cell=problem.name,
        nodes=len(nodes),
        exact=median_time(lambda: cheapest(free), repeats),
        f=median_time(lambda: paper_sequence(candidates, graph, Scheme.F, monitor), repeats),
        f2=median_time(lambda: paper_sequence(candidates, graph, Scheme.F2, monitor), repeats),
        plain_f=median_time(lambda: plain_f(layers, ranges, weight), few),
        plain_f2=median_time(lambda: plain_astar(layers, penalties, ranges, weight), few),
        same_costs=same,
    )
