"""A* with a given heuristic finds the optimum that enumeration finds."""

import itertools

import numpy as np
import pytest

from solver.search.exact import exact
from solver.search.graph import LayeredGraph
from solver.search.paper import f1, heuristic_values
from solver.study.astar import astar
from solver.study.heuristic import least_edges, least_to_go, nearest_goal


def random_graph(seed, layers=5, width=4):
    random = np.random.default_rng(seed)
    sizes = random.integers(1, width + 1, layers)
    count = int(sizes.sum())
    return LayeredGraph(
        offsets=np.concatenate([[0], np.cumsum(sizes)]),
        joints=random.uniform(-2.0, 2.0, (count, 6)),
        ranges=random.uniform(1.0, 4.0, 6),
        node_cost=random.uniform(0.0, 0.5, count) * random.integers(0, 2),
        gap_weight=random.choice([0.5, 1.0, 2.0], layers - 1),
    )


def enumerated(graph):
    layers = [range(a, b) for a, b in itertools.pairwise(graph.offsets.tolist())]
    return min(graph.path_cost(path) for path in itertools.product(*layers))


@pytest.mark.parametrize("seed", range(25))
def test_every_heuristic_is_admissible_and_finds_the_optimum(seed):
    graph = random_graph(seed)
    best = enumerated(graph)
    to_go = exact(graph).cost_to_go
    for values in (
        np.zeros(graph.node_count),
        nearest_goal(graph),
        least_edges(graph),
        least_to_go(graph, to_go),
        to_go,
    ):
        assert np.all(values <= to_go + 1e-12)
        found = astar(graph, values)
        assert found.cost == pytest.approx(best)
        assert graph.path_cost(found.path) == pytest.approx(best)


@pytest.mark.parametrize("seed", range(10))
def test_with_the_papers_heuristic_it_expands_what_the_scheme_expands(seed):
    graph = random_graph(seed, layers=12, width=9)
    found, scheme = astar(graph, heuristic_values(graph, 0.9)), f1(graph, 0.9)
    assert found.cost == pytest.approx(scheme.cost)
    assert found.expanded == scheme.expanded


def test_a_graph_that_is_cut_has_no_sequence():
    graph = random_graph(1)
    cut = LayeredGraph(
        graph.offsets,
        graph.joints,
        graph.ranges,
        graph.node_cost,
        graph.gap_weight,
        steps=graph.joints,
        step_limits=np.full((graph.layer_count - 1, 6), 1e-9),
    )
    found = astar(cut, np.zeros(cut.node_count))
    assert found.cost == np.inf
    assert len(found.path) == 0
