"""The session: inputs become a problem, a plan, an answer to wishes, and checks."""

import pytest

from posopt_gui.document.project import state_of_cell
from solver.model.settings import Scheme
from solver.model.wishes import Region
from solver.units import DEG


def test_the_default_cell_is_planned_and_checked(planned, qtbot):
    qtbot.waitUntil(lambda: planned.report is not None, timeout=60_000)
    assert planned.problem is not None
    assert planned.result.clearance_met
    assert not planned.report.failed
    assert not planned.stale


def test_a_pin_changes_the_sequence_and_undo_takes_it_back(planned, qtbot):
    free = planned.sequence
    with qtbot.waitSignal(planned.result_changed):
        planned.pin(20, 5.0 * DEG)
    assert planned.sequence.angles[20, 0] == pytest.approx(5.0 * DEG)
    assert planned.answer.price > 0.0
    with qtbot.waitSignal(planned.result_changed):
        planned.document.undo()
    assert planned.answer is None
    assert planned.sequence is free


def test_a_preview_leaves_no_step_behind(planned, qtbot):
    with qtbot.waitSignal(planned.result_changed):
        planned.preview_pin(20, 5.0 * DEG)
    assert planned.answer.price > 0.0
    assert not planned.document.can_undo
    with qtbot.waitSignal(planned.result_changed):
        planned.end_preview()
    assert planned.answer is None


def test_a_region_over_a_whole_layer_is_answered_with_that_layer(planned, qtbot):
    with qtbot.waitSignal(planned.result_changed):
        planned.forbid(Region(5, 6, -30.0 * DEG, 30.0 * DEG))
    assert planned.answer.sequence is None
    assert planned.answer.layer == 5
    assert planned.sequence is planned.result.sequence


def test_changed_inputs_make_the_plan_stale_until_it_is_planned_again(planned, qtbot):
    with qtbot.waitSignal(planned.problem_changed):
        planned.document.set_value("settings.safety_distance_mm", 45.0)
    assert planned.stale
    with qtbot.waitSignal(planned.result_changed, timeout=60_000):
        planned.plan()
    assert not planned.stale
    assert planned.result.problem.settings.safety_distance == pytest.approx(0.045)


def test_a_wrong_value_is_an_error_with_its_key_and_keeps_the_plan(planned, qtbot):
    result = planned.result
    with qtbot.waitSignal(planned.problem_changed):
        planned.document.set_value("settings.manipulability_m3", -1.0)
    assert "manipulability" in str(planned.problem_error)
    assert planned.problem is None
    assert planned.result is result


def test_an_infeasible_cell_says_why(session, qtbot):
    session.open(state_of_cell("groove_hw300").with_value("settings.lean_deg", [88.0, 89.0, 1.0]))
    with qtbot.waitSignal(session.message, timeout=180_000) as told:
        session.start()
    assert told.args[0].severity == "error"
    assert "waypoint" in told.args[0].text
    assert session.result is None
    assert session.plan_error is not None


def test_stop_cancels_and_the_next_plan_answers(session, qtbot):
    session.set_compared((Scheme.EXACT, Scheme.F, Scheme.F1, Scheme.F2))
    session.start()
    session.stop()
    assert not session.planning
    with qtbot.waitSignal(session.result_changed, timeout=180_000):
        session.plan()
    assert set(session.result.sequences) == set(Scheme)


def test_the_place_stays_on_the_path_and_the_cursor_follows(planned, qtbot):
    seen = []
    planned.cursor_changed.connect(seen.append)
    planned.set_place(3.4)
    planned.set_place(3.6)
    planned.set_place(1e9)
    planned.set_place(-5.0)
    assert seen == [3, 4, 49, 0]
    assert planned.place == 0.0


def test_closing_while_planning_waits_and_says_nothing_more(qtbot, planned_state):
    from posopt_gui.controllers.session import Session
    from posopt_gui.document.document import Document

    session = Session(Document(planned_state))
    told = []
    session.result_changed.connect(lambda: told.append(1))
    session.start()
    assert session.close()
    assert not told
