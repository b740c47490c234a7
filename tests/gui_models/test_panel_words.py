"""What panels say about a plan: its worth, its program, its branches, its limits."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import solver
from posopt_gui.viewmodels.curves_model import (
    compared_tracks,
    feed_curve,
    feed_words,
    joint_range,
    sequence_track,
    step_range,
)
from posopt_gui.viewmodels.export_model import check_rows
from posopt_gui.viewmodels.results_model import notes, scheme_table, totals
from posopt_gui.viewmodels.verdicts import gate_words, plan_note
from solver.analysis.check import Check
from solver.model.settings import Sweep
from solver.pipeline.programming import ProgramOrder, draft_program

DEG = np.pi / 180.0


def english(text, **values):
    return text.format(**values)


@pytest.fixture(scope="module")
def result():
    problem = solver.load_cell("groove_hw300")
    lean = Sweep(-25.0 * DEG, 25.0 * DEG, 5.0 * DEG)
    settings = replace(problem.settings, lean=lean, safety_distance=0.04)
    return solver.plan(replace(problem, settings=settings))


def asking(result, safety):
    settings = replace(result.problem.settings, safety_distance=safety)
    return replace(result, problem=replace(result.problem, settings=settings))


def test_a_plan_that_keeps_less_than_was_asked_is_a_warning_with_both_numbers_and_the_place(result):
    sequence = result.sequence
    said = plan_note(asking(result, 0.5), sequence, english)
    at = int(np.argmin(sequence.clearance))
    least = np.floor(1e4 * sequence.least_clearance) / 10.0
    assert said.severity == "warning"
    assert said.waypoint == at
    assert said.text == (
        f"Planned, but least clearance {least:.1f} mm is less than the 500.0 mm asked "
        f"(waypoint {at + 1})."
    )


def test_a_plan_that_keeps_what_was_asked_is_no_warning(result):
    kept = asking(result, result.sequence.least_clearance)
    assert plan_note(kept, result.sequence, english).severity == "info"


def check(passed, detail="", waypoint=None):
    return Check("clearance", passed, 12.0, 40.0, "mm", detail, waypoint)


def test_the_gate_is_one_line_with_how_many_checks_failed():
    good = SimpleNamespace(checks=(check(True),) * 3, failed=())
    assert gate_words(good, english) == ("Program: 3 checks passed", "good")
    bad = SimpleNamespace(checks=(check(True), check(False)), failed=(check(False),))
    assert gate_words(bad, english) == ("Program: 1 of 2 checks failed", "bad")


def test_a_failed_check_selects_the_waypoint_that_only_its_sentence_names():
    failed = check(False, "nose against flange_top at waypoint 48 (GROOVE.LS:91)")
    report = SimpleNamespace(failed=(failed,))
    (note,) = notes(None, None, report, None, english)
    assert note.waypoint == 47


def test_a_line_of_a_check_knows_the_line_of_the_program_that_it_names():
    checks = (
        check(False, "at waypoint 48 (GROOVE_2.LS:91)"),
        check(True, "J5 at GROOVE.LS:39"),
        check(True, "at waypoint 8 (position 11)"),
        check(True, "as in the cell"),
    )
    rows = check_rows(checks, english)
    assert [(row.file, row.line) for row in rows] == [
        ("GROOVE_2.LS", 91), ("GROOVE.LS", 39), ("", None), ("", None),
    ]  # fmt: skip


def test_the_named_line_of_the_program_holds_the_move_to_that_waypoint(result):
    draft = draft_program(asking(result, 0.03), ProgramOrder(), "GROOVE")
    texts = dict(draft.files)
    rows = [
        row
        for row in check_rows(draft.report.checks, english)
        if row.line is not None and row.waypoint is not None
    ]
    assert len({row.line for row in rows}) > 3
    # One pass: one line after the other for one waypoint after the other.
    assert len({row.line - row.waypoint for row in rows}) == 1
    for row in rows:
        # Home and approach stand before the first waypoint.
        assert f" P[{row.waypoint + 3}] " in f" {texts[row.file].splitlines()[row.line - 1][5:]}"


def test_the_cycle_is_told_apart_from_the_time_in_contact(result):
    report = SimpleNamespace(cycle=SimpleNamespace(total=35.2))
    shown = {one.label: one.value for one in totals(result, result.sequence, None, report, english)}
    assert shown["Cycle with links, estimated"] == "35.2 s"
    assert not any(label.startswith("Time") for label in shown)


def test_branches_are_named_with_their_letters(result):
    shown = {one.label: one.value for one in totals(result, result.sequence, None, None, english)}
    assert shown["Branch"] == "0 (N U T)"


def test_references_state_their_lean_and_branch_among_the_schemes(result):
    table = dict(scheme_table(result, None, compared_tracks(result), english).rows)
    heads = scheme_table(result, None, compared_tracks(result), english).heads
    constant = heads.index("best constant lean")
    (reference,) = [one for one in solver.references(result) if one.kind.name == "CONSTANT"]
    assert table["Lean"][constant] == f"{np.rad2deg(reference.lean):.2f}°".replace("-", "−")
    assert table["Branch"][constant] == "0 (N U T)"
    assert all(text for texts in table.values() for text in texts)


def test_a_limit_is_on_the_axis_where_a_curve_comes_near_to_it():
    limits = np.array([-100.0, 100.0])
    low, high = joint_range([np.array([70.0, 85.0])], limits, whole=False)
    assert high > 100.0
    assert low > -100.0
    low, high = joint_range([np.array([-81.0, -60.0])], limits, whole=False)
    assert low < -100.0
    assert high < 100.0
    low, high = joint_range([np.array([-60.0, 60.0])], limits, whole=False)
    assert low > -100.0
    assert high < 100.0


def track(result, name, factor):
    own = sequence_track(result.problem, result.sequence)
    return replace(own, name=name, steps=own.steps * factor)


def test_steps_are_scaled_by_the_plan_and_what_is_far_beyond_is_told(result):
    plan, random = track(result, "PLAN", 1.0), track(result, "RANDOM", 40.0)
    own = float(np.nanmax(plan.steps.sum(axis=1)))
    top, beyond = step_range([plan, random])
    assert top == pytest.approx(own)
    assert beyond == [("RANDOM", pytest.approx(40.0 * own))]
    near = track(result, "NOMINAL", 2.0)
    assert step_range([plan, near]) == (pytest.approx(2.0 * own), [])


def feed(held):
    prediction = SimpleNamespace(slowest=0.019, fastest=0.021, joint=0)
    one = SimpleNamespace(
        place="waypoint 4 (GROOVE.LS:47)", move=5, asked=0.02, held=held, prediction=prediction
    )
    return feed_curve(SimpleNamespace(feeds=(one,)))


def test_a_joint_is_named_only_where_it_keeps_the_feed_from_being_held():
    assert "limits" not in feed_words(english, feed(True), 0)
    assert feed_words(english, feed(False), 0).endswith("asked 20.0 mm/s, J1 limits")
