"""`posopt bench --peers`: complete tables, JSON that keeps to its schema, and refusals."""

from __future__ import annotations

import itertools
import json
import sys
from pathlib import Path

import jsonschema
import pytest

from solver.benchmarks import peers, peers_child, peers_distance, peers_kinematics
from solver.benchmarks.peers_graphs import GraphSize, sized_problem
from solver.benchmarks.peers_process import Answer, Outcome
from solver.benchmarks.peers_search import SEARCHERS, installed
from solver.catalog import load_cell
from solver.cli.main import main

SCHEMA = Path(__file__).parents[2] / "docs" / "schemas" / "bench.schema.json"

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="bounds processes as Linux does")


@pytest.fixture
def in_this_process(monkeypatch):
    """Jobs run here without bounds; scipy's search is over the memory bound."""

    def run_here(job, bounds):
        if job.get("search") == "scipy Dijkstra":
            return Answer(Outcome.MEMORY, [], "")
        lines = []
        monkeypatch.setattr(peers_child, "say", lambda **values: lines.append(values))
        full = {**job, "seconds": bounds.seconds, "repeats": bounds.repeats}
        if job["job"] == "candidates":
            peers_child.measure_candidates(full)
        else:
            peers_child.measure_search(full)
        return Answer(Outcome.FINISHED, lines, "")

    monkeypatch.setattr(peers_child, "bound_time", lambda _: None)
    monkeypatch.setattr(peers_child, "LEAST_TIME", 0.0)
    monkeypatch.setattr(peers_kinematics, "LEAST_TIME", 0.0)
    monkeypatch.setattr(peers, "run_child", run_here)


def test_every_table_is_complete_and_the_json_keeps_to_its_schema(in_this_process, capsys):
    assert main(["bench", "--peers", "--small", "--repeats", "1", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    jsonschema.validate(found, json.loads(SCHEMA.read_text("utf-8")))
    assert len(found["graphs"]) == 2
    for graph in found["graphs"]:
        rows = {row["search"]: row for row in graph["searches"]}
        assert list(rows) == [one.name for one in SEARCHERS]
        assert rows["scipy Dijkstra"]["outcome"] == "over the memory bound"
        for one in SEARCHERS:
            if one.package != "scipy" and installed(one.package):
                assert rows[one.name]["outcome"] == "finished"
                assert abs(rows[one.name]["cost_difference"]) < 1e-12
                assert rows[one.name]["ratio"] > 0.0
    assert len(found["distances"]) == 1 + 3 * len(peers_distance.METERS)


def test_the_printed_tables_show_every_search_and_what_could_not_finish(
    in_this_process, monkeypatch, capsys
):
    monkeypatch.setattr(peers, "time_distances", _few_distances)
    monkeypatch.setattr(peers, "time_kinematics", _few_poses)
    assert main(["bench", "--peers", "--sizes", "3x3x1", "--repeats", "1"]) == 0
    lines = capsys.readouterr().out.splitlines()
    for one in SEARCHERS:
        assert sum(line.startswith(f"| {one.name} |") for line in lines) == 1
    assert any("scipy Dijkstra | over the memory bound |" in line for line in lines)
    assert any("groove_hw300, 3 x 3 x 1: 9 candidates" in line for line in lines)
    tables = [line for line in lines if line.startswith("|")]
    for head, row in itertools.pairwise(tables):
        if row.startswith("|---"):
            assert head.count("|") == row.count("|")


def test_any_other_cell_is_measured_the_same_way(in_this_process, monkeypatch, capsys):
    monkeypatch.setattr(peers, "time_distances", _few_distances)
    monkeypatch.setattr(peers, "time_kinematics", _few_poses)
    arguments = ["--cell", "groove_paper", "--sizes", "3x11x1", "--repeats", "1"]
    assert main(["bench", "--peers", *arguments]) == 0
    text = capsys.readouterr().out
    assert "groove_paper, 3 x 11 x 1: 33 candidates" in text
    assert "groove_hw300" not in text
    assert "exact search of every node in" in text


def test_a_path_of_several_passes_says_how_many_waypoints_it_has(
    in_this_process, monkeypatch, capsys
):
    monkeypatch.setattr(peers, "time_distances", _few_distances)
    monkeypatch.setattr(peers, "time_kinematics", _few_poses)
    arguments = ["--cell", "zigzag_hw250", "--sizes", "14x3x1", "--repeats", "1"]
    assert main(["bench", "--peers", *arguments]) == 0
    sized = sized_problem(load_cell("zigzag_hw250"), GraphSize(14, 3, 1, 1))
    assert f"zigzag_hw250, {len(sized.toolpath)} x 3 x 1: " in capsys.readouterr().out


def _few_poses(problem, repeats, *, small):
    return peers_kinematics.time_kinematics(problem, repeats, small=not small)


def _few_distances(*_, **__):
    return [
        peers_distance.DistanceTiming("pairs", "posopt", "", 3, 1e-9, 1e-6, 1.0, 0.0, 1e-9, 0),
        peers_distance.DistanceTiming("pairs", "coal", "not installed: pip install coal", 3, 1e-9),
    ]


def test_ratios_are_to_the_first_row_and_a_search_without_a_run_has_none():
    def row(name, build, solve, cost):
        return peers.SearchTiming(name, Outcome.FINISHED, "", 1, build, solve, 0, cost)

    late = peers.SearchTiming("late", Outcome.TIME, "", 0)
    rows = list(peers._compared([row("a", 0.0, 2.0, 5.0), row("b", 3.0, 5.0, 6.5), late]))
    assert [one.ratio for one in rows] == [1.0, 4.0, None]
    assert [one.cost_difference for one in rows] == [0.0, 1.5, None]


def test_runs_that_finished_count_though_a_later_one_met_a_bound():
    line = {"build": 1.0, "search": 2.0, "peak_bytes": 7, "cost": 3.0}
    row = peers._timing(SEARCHERS[0], Answer(Outcome.TIME, [line, {**line, "search": 4.0}], ""))
    assert (row.outcome, row.runs, row.solve) == (Outcome.FINISHED, 2, 3.0)


@pytest.mark.parametrize(
    "arguments",
    [
        ["--small"],
        ["--sizes", "50x51x8"],
        ["--cell", "groove_paper"],
        ["--peers", "--cell", "no_such_cell"],
        ["--peers", "--sizes", "50"],
        ["--peers", "--long"],
        ["--peers", "--time-limit", "0"],
        ["--peers", "--memory-limit", "much"],
        ["--peers", "--repeats", "0"],
    ],
    ids=" ".join,
)
def test_options_that_make_no_sense_are_one_sentence_and_exit_2(capsys, arguments):
    assert main(["bench", *arguments]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert len(err.strip().splitlines()) == 1
