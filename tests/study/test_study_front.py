"""The front of clearance against joint motion, against every sequence there is."""

import itertools
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from study_cells import shortened

from solver.catalog import load_cell
from solver.model.settings import Sweep
from solver.pipeline.planning import plan
from solver.progress import SilentMonitor
from solver.search.bottleneck import best_minimum_clearance
from solver.study.context import Study
from solver.study.pareto import front_of, front_points, knee
from solver.study.published import load_study
from solver.units import DEG


@pytest.fixture(scope="module")
def small():
    problem = shortened(load_cell("groove_paper"), 12)
    lean = Sweep(-25.0 * DEG, 25.0 * DEG, 4.0 * DEG)
    return plan(replace(problem, settings=replace(problem.settings, lean=lean)))


def every_sequence(result):
    """(least clearance, joint cost) of all sequences, by enumeration."""
    nodes, ranges = result.candidates.nodes, result.problem.robot.cost_ranges
    layers = [range(a, b) for a, b in itertools.pairwise(nodes.offsets.tolist())]
    rows = np.array(list(itertools.product(*layers)))
    cost = (np.abs(np.diff(nodes.model[rows], axis=1)) / ranges).sum(axis=(1, 2))
    return nodes.clearance[rows].min(axis=1), cost


def test_the_front_is_that_of_all_sequences(small):
    clearance, cost = every_sequence(small)
    order = np.lexsort((cost, -clearance))
    cheapest = np.inf
    wanted = []
    for row in order:
        if cost[row] < cheapest - 1e-12:
            cheapest = cost[row]
            wanted.append((clearance[row], cost[row]))
    found = front_points(front_of(small, 0.0, SilentMonitor()))
    assert len(clearance) > 1000
    assert np.allclose(found, np.array(wanted[::-1]), atol=1e-12)


def test_points_of_the_papers_front_do_not_dominate_each_other():
    study = Study(load_study("paper"))
    points = front_points(study.front)
    assert len(points) > 50
    assert np.all(np.diff(points[:, 0]) > 0.0)
    assert np.all(np.diff(points[:, 1]) > 0.0)
    clearance = study.result.candidates.nodes.clearance
    assert points[-1, 0] == best_minimum_clearance(study.result.graph, clearance)
    assert points[0, 1] == pytest.approx(0.32758, abs=5e-6)


def test_a_step_thins_the_front_and_keeps_its_ends(small):
    whole = front_points(front_of(small, 0.0, SilentMonitor()))
    thin = front_points(front_of(small, 0.015, SilentMonitor()))
    assert 2 <= len(thin) < len(whole)
    assert np.array_equal(thin[[0, -1]], whole[[0, -1]])
    assert set(map(tuple, thin)) <= set(map(tuple, whole))


def test_the_knee_of_a_bent_line_is_its_bend():
    points = np.array([[0.0, 0.0], [1.0, 0.1], [2.0, 0.2], [3.0, 2.0], [4.0, 4.0]])
    assert knee(points) == 2
    assert knee(np.column_stack([points[:, 0], points[:, 0]])) is None
    assert knee(points[:2]) is None


def test_a_graph_of_one_sequence_has_a_front_of_one_point(small):
    best = small.sequence.nodes
    graph, parent = small.graph.subgraph(np.isin(np.arange(small.graph.node_count), best))
    nodes = SimpleNamespace(
        clearance=small.candidates.nodes.clearance[parent],
        candidate=small.candidates.nodes.candidate[parent],
        model=small.candidates.nodes.model[parent],
        pendant=small.candidates.nodes.pendant[parent],
    )
    candidates = SimpleNamespace(
        nodes=nodes,
        problem=small.problem,
        orientations=small.candidates.orientations,
        branches=small.candidates.branches,
    )
    only = SimpleNamespace(graph=graph, candidates=candidates)
    assert len(front_of(only, 0.0, SilentMonitor())) == 1
