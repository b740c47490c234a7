"""Searches beside their peers: sizes, equal costs, and what becomes of one that cannot finish."""

from __future__ import annotations

import itertools
import sys

import numpy as np
import pytest

from solver.benchmarks import peers
from solver.benchmarks.peers_graphs import (
    STANDARD_SIZES,
    GraphSize,
    joint_cost_graph,
    load_graph,
    parse_size,
    save_graph,
    sized_problem,
    thinned,
)
from solver.benchmarks.peers_process import Bounds, Outcome, run_child
from solver.benchmarks.peers_search import SEARCHERS
from solver.candidates.generate import generate
from solver.catalog import load_cell
from solver.errors import InputError
from solver.search.graph import LayeredGraph
from solver.units import DEG

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="bounds processes as Linux does")


def graph_of(layers):
    """A graph of layers of joint vectors, ranges 1."""
    offsets = np.concatenate([[0], np.cumsum([len(one) for one in layers])])
    return LayeredGraph(
        offsets,
        np.concatenate(layers),
        np.ones(6),
        np.zeros(offsets[-1]),
        np.ones(len(layers) - 1),
    )


def random_graph(seed, sizes):
    random = np.random.default_rng(seed)
    return graph_of([random.normal(size=(size, 6)) for size in sizes])


def cheapest_of_all_sequences(graph):
    """The least cost by looking at every sequence there is."""
    layers = [graph.joints[a:b] for a, b in itertools.pairwise(graph.offsets)]
    return min(
        sum(float(np.abs(b - a).sum()) for a, b in itertools.pairwise(sequence))
        for sequence in itertools.product(*layers)
    )


@pytest.mark.parametrize("searcher", SEARCHERS, ids=lambda one: one.name)
def test_every_search_finds_the_least_cost_of_all_sequences(searcher):
    if searcher.package:
        pytest.importorskip(searcher.package)
    for seed in range(3):
        graph = random_graph(seed, [3, 4, 1, 5, 2])
        expected = cheapest_of_all_sequences(graph)
        assert searcher.prepare(graph)() == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("searcher", SEARCHERS, ids=lambda one: one.name)
def test_every_search_says_infinite_where_a_layer_is_empty(searcher):
    if searcher.package:
        pytest.importorskip(searcher.package)
    assert searcher.prepare(random_graph(1, [3, 0, 2]))() == np.inf


def test_sizes_are_read_with_one_angle_and_with_two():
    assert parse_size("50x51x1") == GraphSize(50, 51, 1, 1)
    assert parse_size("200x51x21x8") == STANDARD_SIZES[-1]
    assert STANDARD_SIZES[-1].candidates == 1_713_600
    assert str(STANDARD_SIZES[-1]) == "200 x (51 x 21) x 8"


@pytest.mark.parametrize(
    "text",
    ["50", "50x51", "1x51x8", "50x0x8", "50x51x9", "50x51x0", "9999x999x8", "5_0x1x1", "-5x1x1"],
)
def test_a_size_that_makes_no_sense_is_refused(text):
    with pytest.raises(InputError, match="--sizes"):
        parse_size(text)


def test_a_sized_problem_has_the_waypoints_angles_and_branches_that_were_asked_for():
    cell = load_cell("groove_hw300")
    problem = sized_problem(cell, GraphSize(7, 5, 3, 2))
    candidates = generate(problem)
    assert candidates.outcome.shape == (7, 15, 2)
    lean, lead = problem.settings.lean.angles(), problem.settings.lead.angles()
    np.testing.assert_allclose(lean / DEG, [-25.0, -12.5, 0.0, 12.5, 25.0], atol=1e-12)
    np.testing.assert_allclose(lead / DEG, [-10.0, 0.0, 10.0], atol=1e-12)
    ends = problem.waypoint_poses[[0, -1]]
    np.testing.assert_allclose(ends, cell.waypoint_poses[[0, -1]], atol=1e-12)


def test_the_standard_sizes_exist_on_the_path_of_the_cell():
    cell = load_cell("groove_hw300")
    for size in STANDARD_SIZES:
        problem = sized_problem(cell, size)
        assert len(problem.toolpath) == size.waypoints
        assert len(problem.settings.lean.angles()) == size.leans
        assert len(problem.settings.lead.angles()) == size.leads


def test_a_written_graph_is_read_again_as_it_was(tmp_path):
    graph = joint_cost_graph(
        generate(sized_problem(load_cell("groove_hw300"), GraphSize(5, 5, 1, 8)))
    )
    save_graph(graph, tmp_path / "graph.npz")
    again = load_graph(tmp_path / "graph.npz")
    for name in ("offsets", "joints", "ranges", "node_cost", "gap_weight"):
        np.testing.assert_array_equal(getattr(again, name), getattr(graph, name))


def test_a_thinned_graph_holds_the_first_nodes_of_the_first_layers():
    layers = [np.full((size, 6), float(size)) for size in (30, 5, 20, 9)]
    thin = thinned(graph_of(layers))
    assert thin.layer_sizes.tolist() == [16, 5, 16]
    assert thin.joints[:, 0].tolist() == [30.0] * 16 + [5.0] * 5 + [20.0] * 16


def child(tmp_path, name, graph, **bounds):
    save_graph(graph, tmp_path / "graph.npz")
    job = {"job": "search", "search": name, "graph": str(tmp_path / "graph.npz")}
    return run_child(job, Bounds(**bounds))


def test_a_search_in_a_process_of_its_own_tells_cost_times_and_memory(tmp_path):
    graph = random_graph(5, [4, 4, 4])
    answer = child(tmp_path, "plain Python A*", graph, repeats=2)
    assert answer.outcome is Outcome.FINISHED, answer.note
    assert answer.lines[0]["cost"] == pytest.approx(cheapest_of_all_sequences(graph), rel=1e-12)
    assert all(line["search"] > 0.0 and line["peak_bytes"] >= 0 for line in answer.lines)


def test_a_search_over_the_time_bound_is_ended_and_says_so(tmp_path):
    graph = random_graph(6, [700] * 40)
    answer = child(tmp_path, "plain Python A*", graph, seconds=1.0)
    assert answer.outcome is Outcome.TIME
    assert answer.lines == []


def test_a_search_over_the_memory_bound_is_ended_and_says_so(tmp_path):
    pytest.importorskip("scipy")
    graph = random_graph(7, [9000] * 3)  # 1.9 GB of edges
    answer = child(tmp_path, "scipy Dijkstra", graph, memory=1.2e9)
    assert answer.outcome is Outcome.MEMORY, answer.note
    assert answer.lines == []


def test_a_package_that_is_not_installed_has_a_row_that_says_so(tmp_path, monkeypatch):
    monkeypatch.setattr(peers, "installed", lambda package: package != "networkx")
    monkeypatch.setattr(peers, "run_child", lambda *_: peers.Answer(Outcome.TIME, [], ""))
    rows = list(peers._searches(tmp_path, GraphSize(2, 1, 1, 1), Bounds(), lambda _: None))
    outcomes = {row.search: row.outcome for row in rows}
    assert outcomes.pop("networkx Dijkstra") is Outcome.MISSING
    assert len(outcomes) == len(SEARCHERS) - 1
    assert set(outcomes.values()) == {Outcome.TIME}
