import numpy as np
import pytest
from search_oracles import StoppingMonitor, random_graph

from solver.errors import Cancelled, ModelError, PlanningError
from solver.search.graph import LayeredGraph
from solver.search.heuristic_weight import sample_heuristic_weight


def sampled_by_numpy(graph, pairs, seed, order):
    """The same draws, each distance by dynamic programming over matrices."""
    random, points = np.random.default_rng(seed), graph.joints / graph.ranges
    ratios = []
    while len(ratios) < pairs:
        start, goal = sorted(random.integers(graph.node_count, size=2).tolist())
        first, last = graph.layer_of([start, goal])
        if first == last:
            continue
        reached, nodes = np.zeros(1), points[[start]]
        for layer in range(first + 1, last + 1):
            below = points[graph.layer(layer)]
            apart = np.linalg.norm(below[:, None] - nodes[None], ord=order, axis=2)
            reached, nodes = (apart + reached[None]).min(1), below
        distance = reached[goal - graph.offsets[last]]
        ratios.append(distance / np.linalg.norm(points[goal] - points[start]))
    return min(ratios), max(ratios)


@pytest.mark.parametrize(("edge", "order"), [("l2", 2), ("l1", 1)])
@pytest.mark.parametrize("seed", range(5))
def test_the_sampled_ratios_equal_those_of_numpy(edge, order, seed):
    graph = random_graph(seed)
    sample = sample_heuristic_weight(graph, 20, seed, edge)
    least, most = sampled_by_numpy(graph, 20, seed, order)
    assert sample.ratio_min == pytest.approx(least, rel=1e-12)
    assert sample.ratio_max == pytest.approx(most, rel=1e-12)
    assert sample.weight == pytest.approx(min(0.9 * least, 1.0), rel=1e-12)


def test_l2_distances_are_never_shorter_than_the_direct_one():
    sample = sample_heuristic_weight(random_graph(7), 100)
    assert 1.0 - 1e-12 <= sample.ratio_min <= sample.ratio_max


def test_nodes_on_a_line_give_the_papers_weight():
    joints = np.outer(np.arange(12.0), np.ones(6))
    graph = LayeredGraph(np.arange(13), joints, np.ones(6), np.zeros(12), np.ones(11))
    sample = sample_heuristic_weight(graph)
    assert sample.ratio_min == pytest.approx(1.0, rel=1e-12)
    assert sample.ratio_max == pytest.approx(1.0, rel=1e-12)
    assert sample.weight == pytest.approx(0.9, rel=1e-12)


def test_the_same_seed_gives_the_same_sample():
    graph = random_graph(2)
    assert sample_heuristic_weight(graph, seed=4) == sample_heuristic_weight(graph, seed=4)
    assert sample_heuristic_weight(graph, seed=4) != sample_heuristic_weight(graph, seed=5)


def test_a_graph_without_connected_pairs_is_an_error():
    joints = np.zeros((2, 6))
    joints[1] = 1.0
    cut = LayeredGraph(
        [0, 1, 2], joints, np.ones(6), np.zeros(2), [1.0], joints, np.full((1, 6), 0.1)
    )
    with pytest.raises(PlanningError, match="0 of 50"):
        sample_heuristic_weight(cut)
    with pytest.raises(PlanningError, match="fewer than two layers"):
        sample_heuristic_weight(LayeredGraph([0, 1], joints[:1], np.ones(6), [0.0], []))
    with pytest.raises(ModelError):
        sample_heuristic_weight(random_graph(0), 0)


def test_it_can_be_cancelled():
    with pytest.raises(Cancelled):
        sample_heuristic_weight(random_graph(0), monitor=StoppingMonitor(3))
