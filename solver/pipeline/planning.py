"""From a problem to its pose sequence: the explicit list of stages.

problem -> candidates (solved and filtered) -> layered graph -> search -> result. The command
line, the window, the studies and the tests all come through :func:`plan`.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from solver.analysis.diagnosis import no_sequence
from solver.analysis.result import PlanningResult, Sequence, sequence_of
from solver.candidates.generate import CandidateSet, generate, touch_numbers
from solver.candidates.postures import check_postures
from solver.collision.kernels_scene import FREE
from solver.costs.nodes import node_terms
from solver.costs.penalty import safety_penalty
from solver.costs.steps import gap_times, gaps
from solver.model.problem import PlanningProblem
from solver.model.settings import EdgeCost, Scheme
from solver.progress import Monitor, SilentMonitor
from solver.search import paper
from solver.search.bottleneck import best_minimum_clearance
from solver.search.exact import ExactResult, exact
from solver.search.graph import LayeredGraph
from solver.transforms import FloatArray, IntArray


def plan(
    problem: PlanningProblem,
    monitor: Monitor | None = None,
    *,
    compare: Iterable[Scheme] = (),
) -> PlanningResult:
    """Plan the problem with the scheme of its settings.

    Parameters
    ----------
    problem : PlanningProblem
        Everything that the plan depends on.
    monitor : Monitor, optional
        Learns the progress and may cancel; none is silent.
    compare : iterable of Scheme
        Further schemes to search the same graph with.

    Returns
    -------
    PlanningResult
        With `clearance_met` False where the safety distance cannot be kept by any sequence:
        then the exact sequence keeps the best reachable minimum.

    Raises
    ------
    InfeasiblePathError
        When no sequence exists at all; it says where and why.
    Cancelled
        When the monitor asks for it.
    """
    monitor = monitor or SilentMonitor()
    candidates = generate(problem, monitor)
    graph = free = layered_graph(candidates)
    if np.any(np.diff(graph.offsets) == 0):
        raise no_sequence(candidates, graph)
    schemes = list(dict.fromkeys([problem.settings.scheme, *compare]))
    sequences: dict[Scheme, Sequence] = {}
    hard, met = problem.settings.safety_distance, True
    extra = np.full(len(candidates.nodes), np.nan)
    for scheme in schemes:
        if scheme is Scheme.EXACT:
            sequences[scheme], extra, hard = exact_sequence(candidates, graph, monitor)
            if changes_branch(sequences[scheme], problem):
                # Only then is the bound worth its time: without a change it would not bind.
                graph = layered_graph(candidates, one_branch=True)
                sequences[scheme], extra, hard = exact_sequence(candidates, graph, monitor)
            met = hard >= problem.settings.safety_distance
        else:
            sequences[scheme] = paper_sequence(candidates, free, scheme, monitor)
    if Scheme.EXACT not in sequences:
        met = sequences[problem.settings.scheme].least_clearance >= hard
    extra.setflags(write=False)
    return PlanningResult(
        problem, candidates, graph, problem.settings.scheme, sequences, hard, met, extra
    )


BRANCH_APART = 100.0
"""What keeps the leans of two branches apart [rad], so that one bound holds both together."""


def layered_graph(candidates: CandidateSet, *, one_branch: bool = False) -> LayeredGraph:
    """The graph of the feasible candidates with the costs of the exact scheme.

    With `one_branch` the branch may change on links alone: within a pass the leans of two
    branches are farther apart than any bound.
    """
    problem, nodes = candidates.problem, candidates.nodes
    rules = gaps(problem)
    lean, lean_limits, bounded = candidates.lean, rules.lean, rules.bounded
    if one_branch:
        lean = lean + BRANCH_APART * candidates.branches[nodes.candidate[:, 2]]
        within = ~np.isnan(gap_times(problem))
        lean_limits = np.where(within, np.minimum(lean_limits, BRANCH_APART / 2.0), np.inf)
        bounded = True
    cost = node_terms(
        problem,
        nodes.candidate[:, 0].astype(np.int64),
        candidates.orientations[nodes.candidate[:, 1]],
        nodes.clearance,
    )
    return LayeredGraph(
        offsets=nodes.offsets,
        joints=nodes.model,
        ranges=problem.robot.cost_ranges,
        node_cost=cost,
        gap_weight=rules.weight,
        steps=nodes.pendant if bounded else None,
        step_limits=rules.steps if bounded else None,
        lean=lean if bounded else None,
        lean_limits=lean_limits if bounded else None,
        squared=problem.settings.edge_cost is EdgeCost.SQUARED,
    )


def changes_branch(sequence: Sequence, problem: PlanningProblem) -> bool:
    """Whether the posture's branch changes within a pass."""
    within = ~np.isnan(gap_times(problem))
    return bool((within & (np.diff(sequence.branch) != 0)).any())


def exact_sequence(
    candidates: CandidateSet, graph: LayeredGraph, monitor: Monitor
) -> tuple[Sequence, FloatArray, float]:
    """Optimal sequence under the hard minimum clearance, extra costs of nodes, the minimum [m].

    Joints are exported rounded; a node whose rounded joints fall under the safety distance is
    left out, and the search repeated, until the rounded sequence keeps it.
    """
    clearance = candidates.nodes.clearance
    hard = candidates.problem.settings.safety_distance
    kept = optimum_among(candidates, graph, clearance >= hard, hard, monitor)
    if kept is not None:
        return *kept, hard
    hard = best_minimum_clearance(graph, clearance, monitor)
    found = _search_allowed(graph, clearance >= hard, monitor) if hard > -np.inf else None
    if found is None:
        raise no_sequence(candidates, graph)
    outcome, nodes, extra = found
    return sequence_of(candidates, Scheme.EXACT, nodes, outcome.cost), extra, float(hard)


def optimum_among(
    candidates: CandidateSet,
    graph: LayeredGraph,
    allowed: NDArray[np.bool_],
    least: float,
    monitor: Monitor,
) -> tuple[Sequence, FloatArray] | None:
    """The cheapest sequence of allowed nodes (k,) and the extra costs of all; None without one.

    Joints are exported rounded: nodes whose rounded joints fall under the clearance `least` [m]
    are left out too.
    """
    allowed = allowed.copy()
    known = np.zeros(len(allowed), dtype=np.bool_)
    while True:
        found = _search_allowed(graph, allowed, monitor)
        if found is None:
            return None
        outcome, nodes, extra = found
        # Most nodes are those of the sequence before, which keep their clearance rounded too.
        asked = nodes[~known[nodes]]
        low = asked[rounded_clearance(candidates, asked) < least] if len(asked) else asked
        if not len(low):
            return sequence_of(candidates, Scheme.EXACT, nodes, outcome.cost), extra
        known[asked] = True
        allowed[low] = False


def _search_allowed(
    graph: LayeredGraph, allowed: NDArray[np.bool_], monitor: Monitor
) -> tuple[ExactResult, IntArray, FloatArray] | None:
    """Exact search among the allowed nodes, in the numbers of the whole graph."""
    reduced, parent = graph.subgraph(allowed)
    if np.any(np.diff(reduced.offsets) == 0):
        return None
    outcome = exact(reduced, monitor)
    if not outcome.found:
        return None
    extra = np.full(len(allowed), np.inf)
    extra[parent] = outcome.extra_cost
    return outcome, parent[outcome.path], extra


def rounded_clearance(candidates: CandidateSet, nodes: IntArray) -> FloatArray:
    """Clearance of nodes at their exported joints [m]; -inf where a filter rejects them."""
    problem, scene = candidates.problem, candidates.scene
    touch = touch_numbers(problem, scene)[candidates.nodes.candidate[nodes, 0]]
    checked = check_postures(problem.robot, scene, candidates.nodes.pendant[nodes], touch)
    return np.where(checked.status == FREE, checked.clearance, -np.inf)


def paper_sequence(
    candidates: CandidateSet, graph: LayeredGraph, scheme: Scheme, monitor: Monitor
) -> Sequence:
    """Sequence of one of the paper's schemes f, f1, f2 on the joint cost alone."""
    settings = candidates.problem.settings
    clearance = candidates.nodes.clearance
    plain = replace(graph, node_cost=np.zeros(len(clearance)), squared=False)
    weight = settings.heuristic_weight
    if scheme is Scheme.F:
        found = paper.f(plain, weight, monitor)
    elif scheme is Scheme.F1:
        found = paper.f1(plain, weight, monitor)
    else:
        penalty = safety_penalty(clearance, settings.safety_distance)
        found = paper.f2(plain, penalty, weight, monitor)
    if not found.found:
        raise no_sequence(candidates, graph)
    return sequence_of(candidates, scheme, found.path, found.cost, found.expanded)
