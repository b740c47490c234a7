"""Looking at a pose that the plan does not pass: map, 3D panel and inspector hold on to it."""

import math
import time

import numpy as np
import pytest
from map_mouse import Mouse
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QColor, QWheelEvent
from PySide6.QtWidgets import QApplication

from posopt_gui.controllers.session import Hover, Session
from posopt_gui.document.document import Document
from posopt_gui.theme import THEMES
from posopt_gui.viewmodels.scene_model import ghost_at
from posopt_gui.views.inspector_view import InspectorView
from posopt_gui.views.map_view import MapView
from posopt_gui.views.scene_tools import TRAILS
from posopt_gui.views.scene_view import SceneView
from solver.candidates.outcomes import Outcome
from solver.model.wishes import Pin, Region

LEFT = Qt.MouseButton.LeftButton
REJECTED = (25, -15.0)
"""Waypoint (from 0) and lean [deg] of a pose that collides."""


def wait(condition, seconds=60.0):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "it did not happen in time"
        QApplication.processEvents()


@pytest.fixture(scope="module")
def shared(qapp, planned_state):
    made = Session(Document(planned_state))
    made.start()
    wait(lambda: made.result is not None)
    yield made
    assert made.close()


@pytest.fixture(scope="module")
def scene(qapp, shared):
    made = SceneView(shared)
    made.resize(700, 420)
    made.show()
    wait(lambda: made.drawn and made.report is not None)
    yield made
    made.close()
    made.deleteLater()
    qapp.processEvents()


@pytest.fixture
def view(qtbot, shared):
    made = MapView(shared)
    qtbot.addWidget(made)
    made.resize(1000, 420)
    made.show()
    qtbot.waitExposed(made)
    wait(lambda: made.pointing.explains)
    yield made
    made.leave()
    made.extras.close()
    if shared.document.state.pins or shared.document.state.regions:
        shared.clear_wishes()
    wait(lambda: shared.answer is None)
    shared.set_hover(None)
    shared.keep(None)
    shared.set_cursor(0)


@pytest.fixture
def mouse(qapp, view):
    return Mouse(qapp, view)


@pytest.fixture
def inspector(qtbot, shared):
    made = InspectorView(shared)
    qtbot.addWidget(made)
    return made


def candidate(shared, waypoint, lean):
    leans = np.degrees(shared.result.candidates.orientations[:, 0])
    return waypoint, int(np.abs(leans - lean).argmin())


def lean_at(session, waypoint):
    return math.degrees(session.sequence.angles[waypoint, 0])


def test_a_click_off_the_line_stays_looked_at_until_the_cursor_moves(
    view, mouse, shared, scene, inspector
):
    mouse.move(*REJECTED)
    mouse.click(*REJECTED)
    assert shared.cursor == 25
    kept = shared.kept
    assert (kept.waypoint, kept.orientation) == candidate(shared, *REJECTED)
    shared.set_hover(None)
    pose = ghost_at(shared.result, kept.waypoint, kept.orientation, kept.branch)
    np.testing.assert_allclose(scene.canvas._joints, pose.joints)
    assert "Candidate at waypoint 26" in scene._note.text()
    assert scene.report.clearance <= 0.0
    assert inspector.subtitle.text() == "Chosen candidate, not on the plan"
    assert inspector.verdict.text() == "collision"
    shared.set_cursor(26)
    assert shared.kept is None
    np.testing.assert_allclose(scene.canvas._joints, shared.sequence.pendant[26])
    assert "Candidate" not in scene._note.text()
    assert inspector.subtitle.text().startswith("On the plan")


def test_a_click_on_the_line_looks_at_the_plan(view, mouse, shared):
    mouse.click(12, lean_at(shared, 12))
    assert shared.cursor == 12
    assert shared.kept is None


def test_escape_goes_back_to_the_plan(view, mouse, shared, qtbot):
    mouse.click(*REJECTED)
    assert shared.kept is not None
    qtbot.keyClick(view, Qt.Key.Key_Escape)
    assert shared.kept is None
    assert shared.cursor == 25


def test_a_pinned_pose_is_of_the_plan_and_no_longer_a_candidate(view, mouse, shared):
    mouse.double_click(10, 5.0)
    assert shared.kept is None
    assert [one.waypoint for one in shared.document.state.pins] == [10]


def test_another_plan_forgets_the_chosen_candidate(view, mouse, shared):
    mouse.click(*REJECTED)
    before = shared.result
    shared.plan()
    wait(lambda: shared.result is not before)
    assert shared.kept is None


def test_a_ghost_that_collides_shows_its_own_clearance_and_goes_with_it(view, shared, scene):
    waypoint, orientation = candidate(shared, *REJECTED)
    wait(lambda: scene.report is not None)
    own = scene.report
    shared.set_hover(Hover(waypoint, orientation, 0))
    wait(lambda: scene.ghost_report is not None)
    assert scene.ghost_report.clearance <= 0.0
    assert scene.report is own
    assert "Candidate at waypoint 26, lean −15°: collision" in scene._note.text()
    shared.set_hover(None)
    assert scene.ghost_report is None
    assert "Candidate" not in scene._note.text()


def test_a_ghost_that_is_there_before_what_measures_it_is_measured_then(view, shared, scene):
    waypoint, orientation = candidate(shared, *REJECTED)
    wait(lambda: scene.report is not None)
    probe, scene._probe = scene._probe, None
    shared.set_hover(Hover(waypoint, orientation, 0))
    scene._ghost.catch_up()
    assert scene.ghost_report is None
    scene._probe_built(probe)
    assert scene.ghost_report.clearance <= 0.0
    shared.set_hover(None)


def test_a_ghost_of_a_pose_out_of_reach_is_not_measured(view, shared, scene):
    outcome = shared.result.candidates.outcome
    nowhere = np.argwhere(outcome == Outcome.UNREACHABLE)
    if not len(nowhere):
        nowhere = np.array([[10_000, 0, 0]])
    waypoint, orientation, slot = map(int, nowhere[0])
    scene._ghost._session.set_hover(Hover(waypoint, orientation, slot))
    assert scene._looked.ghost is None
    scene.measure_ghost()
    assert scene.ghost_report is None
    shared.set_hover(None)


def test_while_the_line_is_dragged_all_views_look_at_the_held_pose(view, mouse, shared, inspector):
    before = lean_at(shared, 24)
    mouse.press(24, before)
    mouse.move(24, before - 3.0)
    mouse.move(24, before - 6.0)
    wait(lambda: shared.answer is not None and not shared.turns.waiting)
    assert shared.cursor == 24
    assert (shared.hover.waypoint, shared.hover.orientation) == candidate(shared, 24, before - 6.0)
    assert inspector.title.text() == "Waypoint 25/50"
    mouse.move(24, -16.0)
    wait(lambda: shared.answer.sequence is None and not shared.turns.waiting)
    assert (shared.hover.waypoint, shared.hover.orientation) == candidate(shared, 24, -16.0)
    assert inspector.verdict.text() == "collision"
    mouse.release(24, before)
    assert shared.hover is None


def test_the_price_card_says_why_there_is_no_sequence(view, mouse, shared):
    mouse.press(24, lean_at(shared, 24))
    mouse.move(24, 0.0)
    mouse.move(24, -16.0)
    wait(lambda: shared.answer is not None and shared.answer.sequence is None)
    text = view.wishes.price.text
    assert "no sequence" in text
    assert "is rejected" in text
    assert "collision" in text
    view.leave()
    wait(lambda: shared.answer is None)


def test_the_notice_lies_in_the_legends_row_and_takes_the_pin_back(view, shared, qtbot):
    shared.pin(24, shared.result.candidates.orientations[9, 0])
    wait(lambda: shared.answer is not None)
    notice = view.overlays.notice
    assert notice.isVisible()
    assert notice.parent() is view.legend
    assert view.legend.rect().contains(notice.geometry())
    assert notice.button.text() == "Unpin waypoint 25"
    qtbot.mouseClick(notice.button, LEFT)
    assert shared.document.state.pins == ()
    wait(lambda: shared.answer is None)
    assert not notice.isVisible()


def test_wishes_beyond_the_path_are_listed_and_taken_away_in_one_step(view, shared, qtbot):
    state = shared.document.state
    shared.document.set_pins((Pin(3, float(shared.sequence.angles[3, 0])), Pin(60, 0.0)), "Pin")
    shared.forbid(Region(70, 72, -0.1, 0.1))
    wait(lambda: shared.answer is not None and shared.answer.sequence is None)
    notice = view.overlays.notice
    assert "61, 71–73" in notice.text
    assert notice.button.text() == "Take them away"
    qtbot.mouseClick(notice.button, LEFT)
    assert [one.waypoint for one in shared.document.state.pins] == [3]
    assert shared.document.state.regions == state.regions
    wait(lambda: shared.answer is not None and shared.answer.sequence is not None)
    assert not notice.isVisible()
    shared.document.undo()
    assert len(shared.document.state.pins) == 2


def turn_wheel(view, keys):
    port = view.canvas.viewport()
    place = QPointF(port.rect().center())
    event = QWheelEvent(
        place, QPointF(port.mapToGlobal(place)), QPoint(), QPoint(0, 240),
        Qt.MouseButton.NoButton, keys, Qt.ScrollPhase.NoScrollPhase, False,
    )  # fmt: skip
    QApplication.sendEvent(port, event)


@pytest.mark.parametrize(
    ("keys", "waypoints", "leans"),
    [
        (Qt.KeyboardModifier.NoModifier, True, False),
        (Qt.KeyboardModifier.ShiftModifier, False, True),
        (Qt.KeyboardModifier.ControlModifier, True, True),
    ],
)
def test_the_wheel_zooms_waypoints_with_shift_leans_and_with_control_both(
    view, keys, waypoints, leans
):
    box = view.canvas.getViewBox()
    before = np.diff(box.viewRange(), axis=1).ravel()
    turn_wheel(view, keys)
    after = np.diff(box.viewRange(), axis=1).ravel()
    assert (after[0] < 0.99 * before[0]) == waypoints
    assert (after[1] < 0.99 * before[1]) == leans
    assert "Shift" in view.header.fit_button.toolTip()


def test_a_page_that_changes_under_a_resting_mouse_is_told_anew(view, mouse, shared):
    mouse.move(20, 6.0)
    before = shared.hover
    page = next(one for one in view.canvas.model.pages if one.branch == 1 and one.turn == 1)
    view.header.set_page(page.slot, page.turn)
    assert view.pointing.card.isVisible()
    assert shared.hover != before
    assert shared.hover.branch == page.slot
    assert "branch 1" in view.pointing.card.text


def test_a_line_at_the_last_lean_has_room_to_the_frame(view):
    box, frame = view.canvas.getViewBox(), view.canvas.frame()
    low, high = box.viewRange()[1]
    pixel = box.viewPixelSize()[1]
    last = float(view.canvas.model.leans[-1])
    assert (high - last) / pixel > 4.0
    assert low < frame.top()


def test_a_pin_whose_waypoint_is_elsewhere_after_a_change_of_the_path_is_told_once(
    qtbot, planned_state
):
    session = Session(Document(planned_state))
    said = []
    session.message.connect(lambda message: said.append(message.text))
    session.start()
    wait(lambda: session.result is not None)
    session.pin(10, float(session.sequence.angles[10, 0]))
    wait(lambda: session.answer is not None)
    before = session.result
    session.document.set_value("path.resample_mm", 19.0)
    wait(lambda: session.problem is not None and session.problem is not before.problem)
    session.plan()
    wait(lambda: session.result is not before)
    words = "Waypoint 11 is at another place of the path now; its pin holds the number."
    assert said == [words]
    again = session.result
    session.plan()
    wait(lambda: session.result is not again)
    assert said == [words]
    assert session.close()


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_path_and_trail_have_colours_that_are_told_apart(theme):
    colours = THEMES[theme]
    line, trail = QColor(colours.line), QColor(TRAILS[colours.dark])
    apart = [abs(a - b) for a, b in zip(line.getRgb()[:3], trail.getRgb()[:3], strict=True)]
    assert max(apart) > 75
    near = abs(trail.hue() - QColor(colours.accent).hue())
    assert near > 40


def test_fitting_comes_near_to_robot_beam_and_path_and_leaves_the_floors_grid_out(scene, shared):
    scene.look_from("Overview")
    seen = scene.canvas.camera
    corners = scene._cell.points_at(shared.sequence.pendant[shared.cursor])
    local = (corners - seen.position) @ seen.axes.T
    half = math.tan(math.radians(seen.field) / 2.0)
    across, upward = (local[:, k] / -local[:, 2] / half for k in (0, 1))
    upward = upward * scene.canvas.aspect
    assert np.abs(across).max() <= 1.0
    assert np.abs(upward).max() <= 1.0
    # One direction is filled; above, the bar with the tools keeps its room.
    assert max(np.ptp(across) / 2.0, np.ptp(upward) / 2.0) > 0.75


def test_a_line_let_go_where_it_was_answered_is_checked_and_its_pin_offered_back(
    view, mouse, shared
):
    mouse.press(24, lean_at(shared, 24))
    mouse.move(24, 12.0)
    mouse.move(24, 10.0)
    wait(lambda: shared.answer is not None and lean_at(shared, 24) == pytest.approx(10.0))
    wait(lambda: not shared._wishes.busy)
    assert shared.report is None
    mouse.release(24, 10.0)
    wait(lambda: shared.report is not None)
    mouse.press(24, 10.0)
    mouse.move(24, 0.0)
    mouse.move(24, -16.0)
    wait(lambda: shared.answer.sequence is None and not shared._wishes.busy)
    assert not view.overlays.notice.button.isVisible()
    mouse.release(24, -16.0)
    wait(view.overlays.notice.button.isVisible)
    assert view.overlays.notice.button.text() == "Unpin waypoint 25"
