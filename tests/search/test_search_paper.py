import heapq

import numpy as np
import pytest
from hypothesis import given, settings
from search_oracles import (
    INF,
    StoppingMonitor,
    all_sequences,
    edge_matrix,
    layers_of,
    numpy_values,
    random_graph,
    small_graphs,
)

from solver.benchmarks import plain_astar
from solver.errors import Cancelled, ModelError
from solver.search import paper
from solver.search.exact import exact
from solver.search.graph import LayeredGraph
from solver.search.paper import f, f1, f2, heuristic_values

SCHEMES = [f, f1, lambda graph, **given: f2(graph, np.zeros(graph.node_count), **given)]


@pytest.mark.parametrize("scheme", SCHEMES, ids=["f", "f1", "f2"])
@settings(max_examples=120, deadline=None)
@given(graph=small_graphs(squared=False))
def test_every_scheme_equals_exhaustive_enumeration(scheme, graph):
    sequences, result = all_sequences(graph), scheme(graph)
    if not sequences:
        assert not result.found
        assert result.cost == INF
        assert result.path.size == 0
        return
    least = min(cost for _, cost in sequences)
    assert result.cost == pytest.approx(least, rel=1e-12, abs=1e-12)
    assert graph.path_cost(result.path) == pytest.approx(least, rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("seed", range(100))
def test_every_scheme_equals_dynamic_programming(seed):
    check_against_dynamic_programming(seed, widest=14)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(100, 1100))
def test_every_scheme_equals_dynamic_programming_on_a_thousand_graphs(seed):
    check_against_dynamic_programming(seed, widest=40)


def check_against_dynamic_programming(seed, widest):
    graph = random_graph(seed, widest=widest, limits=seed % 2 == 0, penalty=seed % 3 == 0)
    so_far, _ = numpy_values(graph)
    least = so_far[list(layers_of(graph)[-1])].min()
    for scheme in SCHEMES:
        for weight in (0.0, 0.9, 1.0):
            result = scheme(graph, weight=weight)
            assert result.cost == pytest.approx(least, rel=1e-12, abs=1e-12)
            assert result.expanded == len(result.order) == len(set(result.order.tolist()))
            if result.found:
                assert graph.path_cost(result.path) == pytest.approx(least, rel=1e-12, abs=1e-12)


def astar_without_pushing_again(graph):
    """The defect: an open node that is improved keeps its old place in the heap."""
    layers, best, parent, closed = layers_of(graph), {}, {}, set()
    matrices = [edge_matrix(graph, gap) for gap in range(graph.layer_count - 1)]
    heap = []
    for node in layers[0]:
        best[node] = graph.node_cost[node]
        heapq.heappush(heap, (best[node], node))
    while heap:
        _, node = heapq.heappop(heap)
        closed.add(node)
        gap = int(graph.layer_of(node))
        if gap == graph.layer_count - 1:
            cost = graph.node_cost[node]
            while node in parent:
                before, layer = parent[node], int(graph.layer_of(node))
                row, column = before - layers[layer - 1][0], node - layers[layer][0]
                cost += matrices[layer - 1][row, column] + graph.node_cost[before]
                node = before
            return cost
        for column, target in enumerate(layers[gap + 1]):
            row = node - layers[gap][0]
            reached = best[node] + matrices[gap][row, column] + graph.node_cost[target]
            if target in closed or reached >= best.get(target, INF):
                continue
            if target not in best:
                heapq.heappush(heap, (reached, target))
            best[target], parent[target] = reached, node
    return INF


def test_an_improved_open_node_is_pushed_again():
    wrong = 0
    for seed in range(40):
        graph = random_graph(seed, penalty=True)
        least = exact(graph).cost
        wrong += astar_without_pushing_again(graph) > least * (1 + 1e-9)
        for weight in (0.0, 0.9):
            assert f1(graph, weight).cost == pytest.approx(least, rel=1e-12)
    # The graphs must be such that the defect would show.
    assert wrong >= 5


@pytest.mark.parametrize("seed", range(12))
def test_every_scheme_expands_as_the_plain_python_search_does(seed):
    random = np.random.default_rng(seed)
    count = 8 * 12
    graph = LayeredGraph(
        np.arange(9) * 12,
        random.uniform(-2, 2, (count, 6)),
        np.full(6, 5.0),
        np.zeros(count),
        np.ones(7),
    )
    penalty = random.exponential(0.1, count) * (random.random(count) < 0.5)
    layers = [graph.joints[graph.layer(i)].tolist() for i in range(8)]
    for result, costs in ((f1(graph), np.zeros(count)), (f2(graph, penalty), penalty)):
        node_costs = [costs[graph.layer(i)].tolist() for i in range(8)]
        plain = plain_astar.plain_astar(layers, node_costs, graph.ranges.tolist())
        assert result.path.tolist() == plain.path
        assert result.cost == pytest.approx(plain.cost, rel=1e-12)
        assert result.expanded == plain.expanded
    result = f(graph)
    plain, dijkstra_expanded = plain_astar.plain_f(layers, graph.ranges.tolist())
    assert result.path.tolist() == plain.path
    assert (result.expanded, result.dijkstra_expanded) == (plain.expanded, dijkstra_expanded)


@settings(max_examples=60, deadline=None)
@given(small_graphs(squared=False))
def test_f_runs_from_the_start_of_dijkstra_to_its_goal(graph):
    result = f(graph)
    if result.found:
        assert result.order[0] == result.path[0]
        assert result.order[-1] == result.path[-1]
        first, last = graph.layer(0), graph.layer(graph.layer_count - 1)
        starts = [node for node in result.order if first.start <= node < first.stop]
        goals = [node for node in result.order if last.start <= node < last.stop]
        assert starts == [result.path[0]]
        if graph.layer_count > 1:
            assert result.path[-1] in goals
        assert result.dijkstra_expanded >= graph.layer_count
    else:
        assert result.expanded == 0


@pytest.mark.parametrize("seed", range(30))
def test_the_heuristic_is_admissible_and_consistent(seed):
    graph = random_graph(seed, limits=seed % 2 == 0)
    heuristic = heuristic_values(graph, 1.0)
    _, to_go = numpy_values(graph)
    assert np.all(heuristic <= to_go + 1e-12)
    for gap in range(graph.layer_count - 1):
        source, target = graph.layer(gap), graph.layer(gap + 1)
        bound = edge_matrix(graph, gap) + heuristic[target][None]
        assert np.all(heuristic[source][:, None] <= bound + 1e-12)


def test_the_heuristic_is_lambda_times_the_distance_to_the_nearest_goal():
    graph = LayeredGraph(
        [0, 1, 3],
        np.array([[0.0] * 6, [3, 4, 0, 0, 0, 0], [0, 0, 0, 0, 0, 6.0]]),
        np.full(6, 2.0),
        np.zeros(3),
        [1.0],
    )
    assert heuristic_values(graph, 0.9).tolist() == [0.9 * 2.5, 0.0, 0.0]


def test_of_equal_keys_the_lowest_node_is_expanded_first():
    graph = LayeredGraph([0, 3, 6, 9], np.zeros((9, 6)), np.ones(6), np.zeros(9), [1.0, 1.0])
    assert f1(graph).order.tolist() == [0, 1, 2, 3, 4, 5, 6]
    assert f1(graph).path.tolist() == [0, 3, 6]


def test_stale_entries_are_not_counted():
    for seed in range(10):
        graph = random_graph(seed, penalty=True)
        result = f1(graph, 0.0)
        reachable = np.count_nonzero(exact(graph).cost_so_far <= result.cost)
        assert result.expanded <= reachable


def test_squared_edges_and_a_weight_above_one_are_refused():
    with pytest.raises(ModelError, match="squared"):
        f1(random_graph(0, squared=True))
    with pytest.raises(ModelError, match=r"0\.\.1"):
        f(random_graph(0), 1.01)


@pytest.mark.parametrize("scheme", SCHEMES, ids=["f", "f1", "f2"])
def test_searching_in_pieces_changes_nothing_and_can_be_cancelled(scheme, monkeypatch):
    graph = random_graph(5, widest=40, penalty=True)
    whole = scheme(graph)
    monkeypatch.setattr(paper, "PIECE_WORK", 1)
    monitor = StoppingMonitor()
    part = scheme(graph, monitor=monitor)
    assert part.order.tobytes() == whole.order.tobytes()
    assert part.path.tobytes() == whole.path.tobytes()
    assert monitor.asked >= part.expanded
    for question in (1, 2, 30):
        with pytest.raises(Cancelled):
            scheme(graph, monitor=StoppingMonitor(question))


def test_a_heap_that_grows_keeps_its_order():
    random = np.random.default_rng(0)
    count = 3 * 1500
    graph = LayeredGraph(
        np.arange(4) * 1500,
        random.uniform(-1, 1, (count, 6)),
        np.ones(6),
        random.random(count) * 3,
        np.ones(2),
    )
    assert f1(graph).cost == pytest.approx(exact(graph).cost, rel=1e-12)
