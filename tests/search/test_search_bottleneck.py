import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from search_oracles import INF, StoppingMonitor, all_sequences, random_graph, small_graphs

from solver.errors import Cancelled, ModelError
from solver.search.bottleneck import best_minimum_clearance
from solver.search.exact import exact


@settings(max_examples=150, deadline=None)
@given(small_graphs(), st.integers(0, 2**32 - 1))
def test_the_best_minimum_equals_exhaustive_enumeration(graph, seed):
    clearance = np.random.default_rng(seed).integers(-2, 6, graph.node_count) / 100.0
    expected = max((min(clearance[list(p)]) for p, _ in all_sequences(graph)), default=-INF)
    assert best_minimum_clearance(graph, clearance) == expected


@pytest.mark.parametrize("seed", range(20))
def test_the_nodes_at_the_best_minimum_hold_a_sequence_and_those_above_none(seed):
    graph = random_graph(seed, limits=seed % 2 == 0)
    clearance = np.random.default_rng(seed).normal(0.05, 0.03, graph.node_count)
    best = best_minimum_clearance(graph, clearance)
    if best == -INF:
        assert not exact(graph).found
    else:
        assert exact(graph.subgraph(clearance >= best).graph).found
        assert not exact(graph.subgraph(clearance > best).graph).found


def test_nodes_with_nothing_near_have_an_infinite_best_minimum():
    graph = random_graph(0)
    assert best_minimum_clearance(graph, np.full(graph.node_count, INF)) == INF


def test_a_clearance_that_is_no_number_is_refused():
    graph = random_graph(0)
    with pytest.raises(ModelError):
        best_minimum_clearance(graph, np.full(graph.node_count, np.nan))
    with pytest.raises(ModelError):
        best_minimum_clearance(graph, np.zeros(3))


def test_it_can_be_cancelled():
    graph = random_graph(0)
    with pytest.raises(Cancelled):
        best_minimum_clearance(graph, np.zeros(graph.node_count), StoppingMonitor(1))
