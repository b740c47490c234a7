"""The tab 'Front': worked out when looked at, and a click takes a plan that undo gives back."""

import threading

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from window_helpers import opened, plan, press, settle, wait

from posopt_gui.controllers import front as controller
from posopt_gui.controllers.front import Front, front_key
from posopt_gui.views.front_view import FrontView
from solver.errors import Cancelled
from solver.model.wishes import Region
from solver.units import DEG

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def view(qtbot, planned):
    made = FrontView(planned)
    qtbot.addWidget(made)
    made.resize(800, 320)
    with qtbot.waitExposed(made):
        made.show()
    qtbot.waitUntil(lambda: made.front.model is not None, timeout=120_000)
    yield made
    made.front.close()


def place_of(view, index):
    model = view.front.model
    box = view.plot.getPlotItem().getViewBox()
    spot = box.mapViewToScene(QPointF(model.clearance[index], model.cost[index]))
    place = view.plot.mapFromScene(spot)
    return QPoint(round(place.x()), round(place.y()))


def planned_point(qtbot, session, model, index):
    """Wait until the session's plan is a point of the front."""
    qtbot.waitUntil(
        lambda: (
            not session.stale
            and not session.planning
            and session.sequence.cost == pytest.approx(model.cost[index], rel=1e-12)
        ),
        timeout=60_000,
    )


def test_a_click_plans_the_clearance_and_the_cost_of_that_very_point(view, planned, qtbot):
    model = view.front.model
    # A point that stands alone, so that the mouse means no other.
    gaps = np.minimum(np.diff(model.clearance)[:-1], np.diff(model.clearance)[1:])
    index = int(gaps.argmax()) + 1
    qtbot.mouseClick(view.plot.viewport(), LEFT, pos=place_of(view, index))
    planned_point(qtbot, planned, model, index)
    assert planned.result.clearance_met
    assert 1000.0 * planned.sequence.least_clearance == pytest.approx(
        model.clearance[index], abs=0.02
    )
    settings = planned.problem.settings
    assert 1000.0 * settings.safety_distance == pytest.approx(model.minimum[index])
    assert view.front.model is model
    assert not view.front.stale
    assert model.at(view.front.present) == index


def test_undo_gives_the_old_plan_back_and_redo_the_taken_one(view, planned, qtbot):
    model, before = view.front.model, planned.sequence
    state = planned.document.state
    assert view.front.take(len(model) - 1)
    planned_point(qtbot, planned, model, len(model) - 1)
    planned.document.undo()
    assert planned.document.state == state
    qtbot.waitUntil(lambda: not planned.stale and not planned.planning, timeout=60_000)
    np.testing.assert_array_equal(planned.sequence.nodes, before.nodes)
    planned.document.redo()
    planned_point(qtbot, planned, model, len(model) - 1)


def test_undo_before_the_taken_plan_is_there_still_ends_at_the_old_plan(view, planned, qtbot):
    before = planned.sequence
    view.front.take(0)
    planned.document.undo()
    qtbot.waitUntil(lambda: not planned.stale and not planned.planning, timeout=60_000)
    np.testing.assert_array_equal(planned.sequence.nodes, before.nodes)


def test_taking_a_plan_takes_wishes_away_in_the_same_step(view, planned, qtbot):
    with qtbot.waitSignal(planned.result_changed):
        planned.pin(20, 5.0 * DEG)
    planned.forbid(Region(30, 31, 20.0 * DEG, 25.0 * DEG))
    wished = planned.document.state
    model, told = view.front.model, []
    planned.message.connect(lambda one: told.append(one.text))
    view.front.take(3)
    planned_point(qtbot, planned, model, 3)
    assert planned.answer is None
    assert "Pins and forbidden regions were taken away." in told[0]
    planned.document.undo()
    assert planned.document.state == wished
    qtbot.waitUntil(lambda: planned.answer is not None, timeout=60_000)


def test_the_knee_can_be_taken_with_its_button(view, planned, qtbot):
    model = view.front.model
    view.knee_button.click()
    planned_point(qtbot, planned, model, model.knee)


def test_arrow_keys_go_from_point_to_point_and_enter_takes_one(view, planned, qtbot):
    model = view.front.model
    view.plot.setFocus()
    start = model.at(view.front.present)
    qtbot.keyClick(view.plot, Qt.Key.Key_Right)
    assert view.plot.index == start
    qtbot.keyClick(view.plot, Qt.Key.Key_Right)
    qtbot.keyClick(view.plot, Qt.Key.Key_Right)
    assert view.plot.index == start + 2
    assert view.words.text().startswith(f"{np.floor(model.clearance[start + 2] * 100) / 100:.2f}")
    assert view.words.text() in view.plot.accessibleDescription()
    qtbot.keyClick(view.plot, Qt.Key.Key_Home)
    assert view.plot.index == 0
    qtbot.keyClick(view.plot, Qt.Key.Key_Return)
    planned_point(qtbot, planned, model, 0)


def test_the_mouse_over_a_point_tells_its_values_and_elsewhere_nothing(view, qtbot):
    model = view.front.model
    index = len(model) // 2
    view.plot._on_move(view.plot.mapToScene(place_of(view, index)))
    assert abs(view.plot.index - index) <= 1
    assert "joint cost" in view.words.text()
    assert view.plot._card.isVisible()
    corner = view.plot.getPlotItem().getViewBox().sceneBoundingRect().topLeft() + QPointF(3, 3)
    view.plot._on_move(corner)
    assert view.plot.index is None
    assert view.words.text().startswith(f"All {len(model)} points")


def test_every_point_the_knee_and_the_plan_are_drawn(view, planned):
    model, plot = view.front.model, view.plot
    assert len(plot._points.data) == len(model) > 100
    assert plot._knee.data["x"].tolist() == [model.clearance[model.knee]]
    assert plot._knee_name.toPlainText() == "knee"
    assert plot._plan.data["x"] == pytest.approx([1000.0 * planned.sequence.least_clearance])
    assert plot._plan_name.toPlainText().startswith("plan")
    assert plot._safety.value() == pytest.approx(50.0)


def test_changed_inputs_dim_it_refuse_a_click_and_a_new_plan_works_it_out_again(
    view, planned, qtbot
):
    old = view.front.model
    x, y = planned.document.value("beam.position_xy_mm")
    planned.document.set_value("beam.position_xy_mm", [x + 40.0, y])
    assert view.front.stale
    assert view.words.text() == "Inputs changed. Plan to update."
    assert view.plot.getPlotItem().opacity() < 1.0
    state = planned.document.state
    assert not view.front.take(0)
    assert planned.document.state is state
    planned.plan()
    qtbot.waitUntil(lambda: not view.front.stale and not view.front.busy, timeout=60_000)
    assert view.front.model is not old
    assert view.plot.getPlotItem().opacity() == 1.0


def test_the_front_does_not_depend_on_the_safety_distance_and_the_scheme(view, planned):
    old = view.front.model
    planned.document.set_value("settings.safety_distance_mm", 44.0)
    planned.document.set_value("settings.scheme", "f2")
    assert not view.front.stale
    planned.document.set_value("settings.lean_deg", [-20.0, 20.0, 1.0])
    assert view.front.stale
    planned.document.undo()
    assert not view.front.stale
    assert view.front.model is old


def test_language_and_theme_are_switched_in_place(view, planned):
    planned.look.set_language("zh_CN")
    planned.look.set_theme("dark")
    planned.turns.finish()
    assert view.plot._knee_name.toPlainText() == "拐点"
    assert view.plot.accessibleName() == "间隙与关节运动的权衡曲线"
    planned.look.set_language("en")
    planned.turns.finish()
    assert view.knee_button.text() == "Take the knee"


@pytest.fixture
def endless(monkeypatch):
    """A front that is never done; it tells when it begins and when it sees that it is cancelled."""
    begun, cancelled = threading.Semaphore(0), threading.Semaphore(0)

    def work(_result, monitor):
        begun.release()
        while not monitor.cancelled():
            pass
        cancelled.release()
        raise Cancelled

    monkeypatch.setattr(controller, "front_model", work)
    return begun, cancelled


def test_it_is_worked_out_only_while_it_is_wanted(planned, endless):
    begun, cancelled = endless
    front = Front(planned)
    assert not front.busy
    assert not begun.acquire(timeout=0.05)
    front.want(True)
    assert front.busy
    assert begun.acquire(timeout=10.0)
    front.want(False)
    assert not front.busy
    assert cancelled.acquire(timeout=10.0)
    front.close()


def test_changed_inputs_cancel_it_and_it_waits_for_the_next_plan(planned, endless, qtbot):
    begun, cancelled = endless
    front = Front(planned)
    front.want(True)
    assert begun.acquire(timeout=10.0)
    planned.document.set_value("settings.manipulability_m3", 0.011)
    assert cancelled.acquire(timeout=10.0)
    assert not front.busy
    with qtbot.waitSignal(planned.result_changed, timeout=60_000):
        planned.plan()
    assert front.busy
    assert begun.acquire(timeout=10.0)
    front.close()


def test_stop_gives_it_up_until_it_is_asked_for(planned, endless):
    begun, cancelled = endless
    front = Front(planned)
    front.want(True)
    assert begun.acquire(timeout=10.0)
    front.stop()
    assert cancelled.acquire(timeout=10.0)
    assert front.stopped
    assert not front.busy
    front.want(True)
    assert not front.busy
    front.ask()
    assert front.busy
    front.close()


def test_a_late_answer_is_dropped(planned, monkeypatch, qtbot):
    free = threading.Event()
    answers = []

    def work(_result, _monitor):
        assert free.wait(10.0)
        answers.append(1)
        return "late"

    monkeypatch.setattr(controller, "front_model", work)
    front = Front(planned)
    front.want(True)
    front.want(False)
    free.set()
    qtbot.waitUntil(lambda: bool(answers), timeout=10_000)
    front.close()
    qtbot.wait(1)
    assert front.model is None


def test_a_defect_is_told_and_leaves_it_stopped(planned, monkeypatch, qtbot):
    def work(_result, _monitor):
        raise ZeroDivisionError("of our own")

    monkeypatch.setattr(controller, "front_model", work)
    front, told = Front(planned), []
    planned.message.connect(lambda one: told.append(one.text))
    front.want(True)
    qtbot.waitUntil(lambda: front.stopped, timeout=10_000)
    assert "ZeroDivisionError: of our own" in told[0]
    front.close()


def test_keys_are_alike_where_the_front_is(planned_state):
    same = planned_state.with_value("settings.safety_distance_mm", 12.5)
    assert front_key(same) == front_key(planned_state.with_value("settings.scheme", "f1"))
    other = planned_state.with_value("settings.lean_deg", [-20.0, 20.0, 1.0])
    assert front_key(other) != front_key(planned_state)


def test_before_the_first_plan_there_is_a_sentence(qtbot, session):
    made = FrontView(session)
    qtbot.addWidget(made)
    with qtbot.waitExposed(made):
        made.show()
    assert made._sentence.text() == "There is no plan."
    assert not made.again_button.isVisible()
    assert not made.knee_button.isVisible()
    made.front.close()


def test_in_the_window_the_tab_begins_it_and_arrow_keys_stay_with_it(qapp, tmp_path):
    with opened(tmp_path) as window:
        plan(window)
        assert window.tabs.tabText(2) == "Front"
        assert window.front.front.model is None
        window.tabs.setCurrentWidget(window.front)
        wait(lambda: window.front.front.model is not None)
        window.session.set_cursor(10)
        window.front.plot.setFocus()
        wait(window.front.plot.hasFocus)
        press(window.front.plot, "Right")
        press(window.front.plot, "Right")
        assert window.session.cursor == 10
        assert window.front.plot.index is not None
        press(window.front.plot, "Return")
        settle(window)
        wait(lambda: not window.session.stale and not window.session.planning)
        assert window.session.document.undo_label == "Plan from the front"
        settle(window)
