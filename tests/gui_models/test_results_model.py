import csv
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import solver
from posopt_gui.viewmodels.curves_model import compared_tracks
from posopt_gui.viewmodels.number_words import (
    body_words,
    clearance_mm,
    decimal,
    signed,
    typeset,
)
from posopt_gui.viewmodels.results_model import check_words, notes, scheme_table, totals
from posopt_gui.viewmodels.trouble_model import Cause, Trouble
from posopt_gui.viewmodels.waypoint_table import WaypointTable
from solver.analysis.check import Check
from solver.kinematics.configuration import configuration, parse_configuration
from solver.model.settings import Scheme, Sweep
from solver.pipeline.replanning import Pin, replan

DEG = np.pi / 180.0


def english(text, **values):
    return text.format(**values)


@pytest.fixture(scope="module")
def result():
    problem = solver.load_cell("groove_hw300")
    settings = replace(problem.settings, lean=Sweep(-25.0 * DEG, 25.0 * DEG, 5.0 * DEG))
    return solver.plan(
        replace(problem, settings=replace(settings, safety_distance=0.04)),
        compare=(Scheme.F, Scheme.F2),
    )


def number(text):
    return float(text.replace("−", "-").rstrip("°").split()[0])


@given(st.floats(-0.5, 2.0))
def test_a_clearance_is_never_shown_larger_than_it_is(clearance):
    shown = number(clearance_mm(clearance))
    assert shown <= 1000.0 * clearance + 1e-6
    assert shown > 1000.0 * clearance - 0.1001


@given(st.floats(-1e4, 1e4), st.integers(0, 4))
def test_shown_numbers_read_back_within_half_a_digit(value, decimals):
    assert number(decimal(value, decimals)) == pytest.approx(value, abs=0.51 * 10**-decimals)
    assert number(signed(value, decimals)) == number(decimal(value, decimals))


def test_zero_has_no_sign_and_what_is_not_a_number_is_a_dash():
    assert decimal(-0.001, 1) == "0.0"
    assert signed(-0.001, 1) == "0.0"
    assert decimal(float("nan"), 1) == signed(float("inf"), 1) == "–"


def test_bodies_are_called_by_their_part():
    assert body_words("forearm (forearm_hub)", english) == "forearm hub"
    assert body_words("fillet_top_left (fillet_top_left_3)", english) == "upper left fillet 3"
    assert body_words("web", english) == "web"


def test_totals_are_those_of_the_shown_sequence(result):
    sequence = result.sequence
    shown = {one.label: one for one in totals(result, sequence, None, None, english)}
    assert number(shown["Joint cost"].value) == pytest.approx(sequence.joint_cost, abs=1e-5)
    least = shown["Least clearance"]
    assert least.waypoint == int(np.argmin(sequence.clearance))
    assert least.state == "good"
    change = np.abs(np.diff(np.rad2deg(sequence.pendant), axis=0)).sum()
    assert number(shown["Cumulative change"].value) == pytest.approx(change, abs=0.06)
    assert "Price of your pins and regions" not in shown


def test_a_wish_shows_its_price(result):
    node = result.candidates.nodes
    own = result.candidates.lean[node.offsets[20] : node.offsets[21]]
    clear = node.clearance[node.offsets[20] : node.offsets[21]] >= result.hard_minimum
    planned = result.sequence.angles[20, 0]
    other = next(lean for lean in own[clear] if abs(lean - planned) > 1e-6)
    answer = replan(result, [Pin(20, float(other))])
    shown = {one.label: one for one in totals(result, answer.sequence, answer, None, english)}
    price = shown["Price of your pins and regions"].value
    assert number(price) == pytest.approx(answer.price, abs=1e-5)
    share = 100.0 * (answer.sequence.cost / result.sequence.cost - 1.0)
    assert f"({signed(share, 1)} %)" in price


def test_schemes_stand_side_by_side_with_the_best_marked(result):
    table = scheme_table(result, None, compared_tracks(result), english)
    assert table.heads[:3] == ("exact", "f", "f2")
    costs = [number(text) for text in table.rows[0][1]]
    marked = {column for row, column in table.best if row == 0}
    assert {costs[column] for column in marked} == {min(costs)}
    assert costs[1] == pytest.approx(result.sequences[Scheme.F].joint_cost, abs=1e-5)
    by_name = {one.kind.name: one for one in solver.references(result)}
    for column, track in enumerate(compared_tracks(result), start=3):
        if track.name != "RANDOM":
            assert costs[column] == pytest.approx(by_name[track.name].joint_cost, abs=1e-5)
    assert all(len(texts) == len(table.heads) for _, texts in table.rows)


def test_notes_put_errors_first_and_name_their_waypoint(result):
    failed = Check("clearance", False, 12.0, 40.0, "mm", "web against spindle", 7)
    report = SimpleNamespace(failed=(failed,))
    trouble = Trouble("No sequence exists.", (Cause("Waypoint 3 is blocked.", 2),))
    found = notes(result, result.sequence, report, trouble, english)
    assert [one.severity for one in found[:2]] == ["error", "error"]
    assert [one.waypoint for one in found[:2]] == [2, 7]
    assumptions = [*result.problem.assumptions, *result.problem.robot.assumptions]
    assert [one.text for one in found[-len(assumptions) :]] == [typeset(one) for one in assumptions]


def test_an_unkept_safety_distance_is_a_warning_at_the_nearest_waypoint(result):
    settings = replace(result.problem.settings, safety_distance=0.5)
    stricter = replace(result, problem=replace(result.problem, settings=settings))
    found = notes(stricter, result.sequence, None, None, english)
    warning = next(one for one in found if one.severity == "warning")
    assert warning.waypoint == int(np.argmin(result.sequence.clearance))
    assert "500.0 mm" in warning.text
    calm = notes(result, result.sequence, None, None, english)
    assert not [one for one in calm if one.severity == "warning"]


def test_waypoints_at_the_edge_of_the_lean_range_are_noted(result):
    angles = result.sequence.angles.copy()
    angles[5:10, 0] = result.problem.settings.lean.upper
    found = notes(result, replace(result.sequence, angles=angles), None, None, english)
    note = next(one for one in found if "edge of the lean range" in one.text)
    edge = np.isclose(np.abs(angles[:, 0]), 25.0 * DEG)
    assert note.text.startswith(f"{100 * edge.mean():.0f} %")
    assert edge[note.waypoint]


def test_a_check_reads_as_a_sentence_with_value_and_limit():
    words = check_words(Check("feed", False, 31.25, 10.0, "%", "at waypoint 4"), english)
    assert words.startswith("feed: 31.25 %, limit 10")
    assert words.endswith("at waypoint 4")


@pytest.fixture(scope="module")
def table(result):
    pairs = [("spindle", "flange_top")] * len(result.problem.toolpath)
    return WaypointTable(result, result.sequence, pairs, english)


def column_of(table, key):
    return [one.key for one in table.columns].index(key)


def test_the_table_shows_each_waypoints_joints_and_config(result, table):
    assert len(table) == len(result.problem.toolpath)
    for row in (0, 23, len(table) - 1):
        pendant = result.sequence.pendant[row]
        shown = [number(table.text(row, column_of(table, f"J{j}"))) for j in range(1, 7)]
        np.testing.assert_allclose(shown, np.rad2deg(pendant), atol=0.0051)
        config = parse_configuration(table.text(row, column_of(table, "config")))
        assert config == configuration(result.problem.robot, pendant)
        assert table.text(row, column_of(table, "bodies")) == "spindle against upper flange"


def test_the_table_sorts_numbers_as_numbers(result, table):
    clearance = column_of(table, "clearance")
    keys = [table.key(row, clearance) for row in range(len(table))]
    assert np.argsort(keys).tolist() == np.argsort(1000.0 * result.sequence.clearance).tolist()
    first = table.key(0, column_of(table, "step"))
    assert first < min(table.key(row, column_of(table, "step")) for row in range(1, len(table)))


def test_angles_that_are_not_swept_have_no_column(result, table):
    keys = [one.key for one in table.columns]
    assert "lean" in keys
    assert "lead" not in keys
    assert "spin" not in keys
    settings = replace(result.problem.settings, lead=Sweep(-0.1, 0.1, 0.1))
    wider = replace(result, problem=replace(result.problem, settings=settings))
    assert "lead" in [one.key for one in WaypointTable(wider, result.sequence, (), english).columns]


def test_heads_of_number_columns_name_their_unit(table):
    rows = csv.reader([",".join(table.title(c) for c in range(len(table.columns)))])
    heads = next(rows)
    assert {"Lean °", "J1 °", "Clearance mm", "Manipulability m³"} <= set(heads)
