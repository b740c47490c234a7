from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from search_oracles import INF, all_sequences, cost_of, edge, layers_of, random_graph, small_graphs

from solver.errors import ModelError
from solver.search.graph import LayeredGraph

GOOD = {
    "offsets": [0, 2, 3],
    "joints": np.zeros((3, 6)),
    "ranges": np.ones(6),
    "node_cost": np.zeros(3),
    "gap_weight": [1.0],
    "steps": np.zeros((3, 6)),
    "step_limits": np.ones((1, 6)),
    "lean": np.zeros(3),
    "lean_limits": [0.1],
}


@settings(max_examples=60, deadline=None)
@given(small_graphs())
def test_edges_and_sequences_cost_what_the_definition_says(graph):
    layers = layers_of(graph)
    for gap in range(graph.layer_count - 1):
        for source in layers[gap]:
            for target in layers[gap + 1]:
                expected = edge(graph, gap, source, target)
                actual = float(graph.edge_costs(gap, source, target))
                assert actual == pytest.approx(expected, rel=1e-12, abs=1e-13)
    for path, cost in all_sequences(graph)[:20]:
        assert graph.path_cost(path) == pytest.approx(cost, rel=1e-12, abs=1e-13)


def test_a_sequence_over_a_forbidden_edge_costs_infinity():
    joints = np.zeros((2, 6))
    joints[1, 2] = 1.0
    graph = LayeredGraph(
        [0, 1, 2], joints, np.ones(6), np.zeros(2), [1.0], joints, np.full((1, 6), 0.5)
    )
    assert graph.path_cost([0, 1]) == INF


@pytest.mark.parametrize("path", [[0], [0, 1], [2, 2], [0, 3], [-1, 2], [[0, 2]]])
def test_a_sequence_that_skips_or_mixes_layers_is_refused(path):
    with pytest.raises(ModelError, match="one node of each"):
        LayeredGraph(**GOOD).path_cost(path)


@settings(max_examples=60, deadline=None)
@given(small_graphs(), st.integers(0, 2**32 - 1))
def test_a_subgraph_keeps_exactly_the_sequences_of_its_nodes(graph, seed):
    mask = np.random.default_rng(seed).random(graph.node_count) < 0.7
    part, nodes = graph.subgraph(mask)
    assert nodes.tolist() == np.flatnonzero(mask).tolist()
    expected = {path for path, _ in all_sequences(graph) if mask[list(path)].all()}
    actual = {tuple(nodes[list(path)]) for path, _ in all_sequences(part)}
    assert actual == expected
    for path, cost in all_sequences(part):
        assert cost == pytest.approx(cost_of(graph, nodes[list(path)]), rel=1e-12)


def test_layers_of_nodes_skip_empty_layers():
    graph = LayeredGraph([0, 0, 2, 2, 3], np.zeros((3, 6)), np.ones(6), np.zeros(3), np.ones(3))
    assert graph.layer_of([0, 1, 2]).tolist() == [1, 1, 3]
    assert graph.layer_sizes.tolist() == [0, 2, 0, 1]
    assert graph.edge_count == 0


def test_arrays_are_copied_and_read_only_and_read_only_ones_are_shared():
    joints = np.zeros((3, 6))
    graph = LayeredGraph(**{**GOOD, "joints": joints})
    joints[:] = 1.0
    assert np.all(graph.joints == 0.0)
    with pytest.raises(ValueError, match="read-only"):
        graph.joints[0, 0] = 1.0
    assert replace(graph, node_cost=np.ones(3)).joints is graph.joints


@pytest.mark.parametrize(
    ("name", "value", "says"),
    [
        ("offsets", [0, 3], "shape"),
        ("offsets", [1, 2, 3], "offsets"),
        ("offsets", [0, 4, 3], "offsets"),
        ("offsets", [0], "offsets"),
        ("joints", np.zeros((3, 5)), "joints"),
        ("joints", np.full((3, 6), np.nan), "joints"),
        ("ranges", np.zeros(6), "ranges"),
        ("ranges", np.ones(5), "ranges"),
        ("node_cost", [0.0, 0.0, -1e-9], "node costs"),
        ("node_cost", [0.0, 0.0, INF], "node_cost"),
        ("node_cost", [0.0, 0.0], "node_cost"),
        ("gap_weight", [-1.0], "gap weights"),
        ("gap_weight", [1.0, 1.0], "gap_weight"),
        ("steps", None, "together"),
        ("steps", np.full((3, 6), INF), "steps"),
        ("step_limits", None, "together"),
        ("step_limits", np.zeros((1, 6)), "step_limits"),
        ("step_limits", np.full((1, 6), np.nan), "step_limits"),
        ("lean", None, "together"),
        ("lean_limits", [0.0], "lean_limits"),
        ("lean_limits", None, "together"),
    ],
)
def test_a_graph_that_contradicts_itself_is_refused_by_name(name, value, says):
    LayeredGraph(**GOOD)
    with pytest.raises(ModelError, match=says):
        LayeredGraph(**{**GOOD, name: value})


def test_memory_grows_with_the_nodes_and_not_with_the_edges():
    graph = random_graph(0, layers=5, widest=300)
    arrays = [getattr(graph, name) for name in graph.__dataclass_fields__]
    held = sum(array.nbytes for array in arrays if isinstance(array, np.ndarray))
    assert held < 100 * graph.node_count + 1000
