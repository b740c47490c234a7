"""The map as a person uses it: pointing, dragging the line, pinning, forbidding, taking back."""

import math
import time
from dataclasses import replace

import numpy as np
import pytest
from map_mouse import Mouse
from PySide6.QtCore import QEvent, QPoint, Qt
from PySide6.QtGui import QColor

from posopt_gui.controllers.session import Hover, Session
from posopt_gui.document.document import Document
from posopt_gui.viewmodels.map_colours import CellClass, Layer
from posopt_gui.viewmodels.map_model import MapModel
from posopt_gui.views.map_interaction import Cell
from posopt_gui.views.map_view import MANY_NODES, MapView
from solver.candidates.generate import CandidateSet, Nodes, orientations
from solver.model.settings import Scheme
from solver.model.toolpath import Pass, Toolpath
from solver.model.wishes import Pin, Region

LEFT, RIGHT, PLAIN = Qt.MouseButton.LeftButton, Qt.MouseButton.RightButton, Qt.KeyboardModifier(0)


def wait(qapp, condition, seconds=60.0):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "it did not happen in time"
        qapp.processEvents()


@pytest.fixture(scope="module")
def shared(qapp, planned_state):
    """One planned session for all tests here; each gives it back without wishes."""
    made = Session(Document(planned_state))
    made.start()
    wait(qapp, lambda: made.result is not None)
    yield made
    assert made.close()


@pytest.fixture
def view(qapp, qtbot, shared):
    made = MapView(shared)
    qtbot.addWidget(made)
    made.resize(1000, 420)
    made.show()
    qtbot.waitExposed(made)
    wait(qapp, lambda: made.pointing.explains)
    yield made
    made.leave()
    made.extras.close()
    shared.document.reset(shared.document.state)
    if shared.document.state.pins or shared.document.state.regions:
        shared.clear_wishes()
        wait(qapp, lambda: shared.answer is None)
    shared.set_cursor(0)
    shared.look.set_theme("light")
    shared.look.set_language("en")
    shared.turns.finish()


@pytest.fixture
def mouse(qapp, view):
    return Mouse(qapp, view)


def lean_at(session, waypoint):
    return math.degrees(session.sequence.angles[waypoint, 0])


def test_a_click_looks_at_the_waypoint_and_pointing_hovers_the_pose(view, mouse, shared):
    mouse.move(20, 5.0)
    hover = shared.hover
    assert hover.waypoint == 20
    assert math.degrees(shared.result.candidates.orientations[hover.orientation, 0]) == (
        pytest.approx(5.0)
    )
    mouse.click(20, 5.0)
    assert shared.cursor == 20


def test_the_card_tells_all_margins_and_the_nearest_bodies(view, mouse, shared):
    mouse.move(25, -15.0)
    assert view.pointing.card.isVisible()
    text = view.pointing.card.text
    assert "Waypoint 26" in text
    assert "collision" in text
    assert "spindle against lower flange" in text
    mouse.move(25, 5.0)
    assert "feasible" in view.pointing.card.text
    assert "Extra cost" in view.pointing.card.text


def test_leaving_the_map_hides_the_card_and_the_hover(view, mouse, shared, qapp):
    mouse.move(25, 5.0)
    qapp.processEvents()
    assert shared.hover is not None
    qapp.sendEvent(view.canvas, QEvent(QEvent.Type.Leave))
    assert shared.hover is None
    assert not view.pointing.card.isVisible()


def test_dragging_the_line_plans_again_at_once_and_letting_go_pins(view, mouse, shared, qapp):
    before = lean_at(shared, 24)
    mouse.press(24, before)
    mouse.move(24, before - 4.0)
    mouse.move(24, before - 8.0)
    wait(qapp, lambda: shared.answer is not None and lean_at(shared, 24) < before - 7.5)
    assert shared.document.state.pins == ()
    assert "cost +" in view.wishes.price.text
    mouse.release(24, before - 8.0)
    (pin,) = shared.document.state.pins
    assert (pin.waypoint, pin.branch) == (24, None)
    assert math.degrees(pin.lean) == pytest.approx(before - 8.0)
    assert not view.wishes.price.isVisible()
    wait(qapp, lambda: lean_at(shared, 24) == pytest.approx(before - 8.0))
    assert shared.answer.price > 0.0
    shared.document.undo()
    wait(qapp, lambda: shared.answer is None)
    assert lean_at(shared, 24) == pytest.approx(before)
    shared.document.redo()
    wait(qapp, lambda: shared.answer is not None)
    assert lean_at(shared, 24) == pytest.approx(before - 8.0)


def test_escape_leaves_a_drag_without_a_pin(view, mouse, shared, qapp, qtbot):
    before = lean_at(shared, 24)
    history = shared.document.can_undo
    mouse.press(24, before)
    mouse.move(24, before - 3.0)
    mouse.move(24, before - 6.0)
    wait(qapp, lambda: shared.answer is not None)
    qtbot.keyClick(view, Qt.Key.Key_Escape)
    wait(qapp, lambda: shared.answer is None)
    mouse.release(24, before - 6.0)
    assert shared.document.state.pins == ()
    assert shared.document.can_undo == history
    assert lean_at(shared, 24) == pytest.approx(before)
    assert not view.wishes.price.isVisible()


def test_a_drag_to_where_nothing_passes_shows_the_layer_and_the_reason(view, mouse, shared, qapp):
    before = lean_at(shared, 24)
    mouse.press(24, before)
    mouse.move(24, 0.0)
    mouse.move(24, -22.0)
    wait(qapp, lambda: shared.answer is not None and shared.answer.sequence is None)
    assert "no sequence" in view.wishes.price.text
    assert view.overlays.notice.isVisible()
    assert "aypoint 25" in view.overlays.notice.text
    view.leave()
    wait(qapp, lambda: shared.answer is None)
    assert not view.overlays.notice.isVisible()


def test_a_press_beside_the_line_pans_instead(view, mouse, shared):
    view.canvas.getViewBox().setXRange(10.0, 30.0, padding=0.0)
    low, high = view.canvas.getViewBox().viewRange()[0]
    mouse.press(20, -10.0)
    mouse.move(18, -10.0)
    mouse.move(15, -10.0)
    mouse.release(15, -10.0)
    now = view.canvas.getViewBox().viewRange()[0]
    assert now[0] > low + 1.0
    assert now[1] - now[0] == pytest.approx(high - low)
    assert shared.document.state.pins == ()
    assert shared.cursor == 0


def test_a_double_click_and_the_key_pin_the_pose_and_delete_takes_it_back(
    view, mouse, shared, qapp, qtbot
):
    mouse.double_click(10, 5.0)
    (pin,) = shared.document.state.pins
    assert pin.waypoint == 10
    assert pin.branch is not None
    mouse.move(30, 4.0)
    view.actions_for_menu[0].trigger()
    assert [one.waypoint for one in shared.document.state.pins] == [10, 30]
    mouse.move(10, 0.0)
    view.actions_for_menu[1].trigger()
    assert [one.waypoint for one in shared.document.state.pins] == [30]
    wait(qapp, lambda: shared.answer is not None and lean_at(shared, 30) == pytest.approx(4.0))


def test_a_pose_that_is_not_feasible_is_not_pinned_but_explained(view, mouse, shared, qtbot):
    with qtbot.waitSignal(shared.message) as told:
        mouse.double_click(25, -20.0)
    assert shared.document.state.pins == ()
    assert "collision" in told.args[0].text
    assert told.args[0].waypoint == 25


@pytest.mark.parametrize("by_key", [True, False])
def test_a_drawn_rectangle_is_forbidden_and_the_sequence_goes_around(
    view, mouse, shared, qapp, by_key
):
    button = LEFT if by_key else RIGHT
    if by_key:
        view.actions_for_menu[2].trigger()
    mouse.press(10, 18.0, button)
    mouse.move(12, 12.0)
    mouse.move(14, 10.0)
    mouse.release(14, 10.0, button)
    (region,) = shared.document.state.regions
    assert (region.first, region.last, region.branch) == (10, 14, None)
    assert math.degrees(region.low) == pytest.approx(10.0, abs=0.01)
    assert math.degrees(region.high) == pytest.approx(18.0, abs=0.01)
    assert not view.header.forbid_button.isChecked()
    wait(qapp, lambda: shared.answer is not None)
    leans = np.degrees(shared.sequence.angles[10:15, 0])
    assert ((leans < 9.99) | (leans > 18.01)).all()
    shared.document.undo()
    wait(qapp, lambda: shared.answer is None)


def test_escape_leaves_forbidding(view, mouse, shared, qtbot):
    view.forbid()
    qtbot.keyClick(view, Qt.Key.Key_Escape)
    assert not view.header.forbid_button.isChecked()
    mouse.press(10, -5.0)
    mouse.move(14, -9.0)
    mouse.release(14, -9.0)
    assert shared.document.state.regions == ()


def test_on_a_page_only_its_branch_is_pinned_and_forbidden(view, mouse, shared, qapp):
    page = next(one for one in view.canvas.model.pages if one.branch == 1 and one.turn == 1)
    view.header.set_page(page.slot, page.turn)
    mouse.press(5, -2.0, RIGHT)
    mouse.move(7, 2.0)
    mouse.release(7, 2.0, RIGHT)
    assert shared.document.state.regions[0].branch == 1
    mouse.double_click(20, 6.0)
    pin = shared.document.state.pins[0]
    assert (pin.branch, pin.turn) == (1, 1)
    wait(qapp, lambda: shared.answer is not None and shared.answer.sequence is not None)
    assert shared.sequence.branch[20] == 1


def actions_of(menu):
    return {action.text(): action for action in menu.actions() if action.text()}


def test_the_menu_of_a_cell_pins_forbids_and_takes_back(view, mouse, shared, qapp):
    cell = Cell(12, view.canvas.model.row_of(6.0))
    offered = actions_of(view.wishes.menu(cell))
    assert "Unpin waypoint 13" not in offered
    offered["Pin lean 6°, any branch"].trigger()
    assert shared.document.state.pins == (
        Pin(12, float(shared.result.candidates.orientations[cell.row, 0])),
    )
    actions_of(view.wishes.menu(cell))["Unpin waypoint 13"].trigger()
    assert shared.document.state.pins == ()
    actions_of(view.wishes.menu(cell))["Forbid this pose"].trigger()
    assert len(shared.document.state.regions) == 1
    beside = actions_of(view.wishes.menu(Cell(13, cell.row)))
    assert "Allow this region again" not in beside
    actions_of(view.wishes.menu(cell))["Allow this region again"].trigger()
    assert shared.document.state.regions == ()
    offered["Go to waypoint 13"].trigger()
    assert shared.cursor == 12
    rejected = Cell(25, view.canvas.model.row_of(-20.0))
    assert not actions_of(view.wishes.menu(rejected))["Pin this pose"].isEnabled()


def test_a_blocked_layer_is_told_and_a_click_on_the_sentence_goes_there(view, shared, qapp, qtbot):
    shared.forbid(Region(30, 30, -1.0, 1.0))
    wait(qapp, lambda: shared.answer is not None)
    notice = view.overlays.notice
    assert "aypoint 31" in notice.text
    qtbot.mouseClick(notice, LEFT)
    assert shared.cursor == 30


def colour_at(view, place):
    return view.canvas.grab().toImage().pixelColor(place)


def near(one, other, slack=12):
    return all(
        abs(a - b) <= slack
        for a, b in zip(one.getRgb()[:3], QColor(*other).getRgb()[:3], strict=True)
    )


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_cells_have_the_colours_of_their_outcomes_on_the_screen(view, mouse, shared, theme):
    shared.look.set_theme(theme)
    shared.turns.finish()
    view.header.set_lines([])
    shared.set_cursor(49)
    classes = view.shown.colours.classes
    found = set()
    for waypoint in (2, 12, 30, 44):
        for lean in (-22.5, -11.5, -3.5, 8.5, 23.5):
            row = view.canvas.model.row_of(lean)
            kind = CellClass(int(view.shown.cells.kind[waypoint, row]))
            place = view.canvas.place_of(Cell(waypoint, row))
            if near(colour_at(view, place + QPoint(3, 1)), classes[kind]):
                found.add(kind)
    assert {CellClass.SAFE, CellClass.NEAR, CellClass.COLLISION} <= found


def test_another_layer_shows_a_bar_and_other_colours(view, shared, qapp):
    before = view.grab_image()
    view.header.set_layer(Layer.EXTRA_COST)
    assert view.shown.scale.unit == "%"
    after = view.grab_image()
    assert (after.width(), after.height()) == (before.width(), before.height())
    assert after != before
    assert "Extra cost of passing here" in view.legend.accessibleDescription()


def test_the_order_of_expansion_comes_when_it_is_worked_out(view, shared, qapp):
    view.header.set_layer(Layer.EXPANDED_F1)
    wait(qapp, lambda: Scheme.F1 in view.extras.known.orders)
    order = view.extras.known.orders[Scheme.F1]
    wait(qapp, lambda: np.isfinite(view.shown.cells.values).any())
    node = view.shown.cells.node
    held = node >= 0
    shown = view.shown.cells.values[held]
    assert np.array_equal(shown, order[node[held]], equal_nan=True)


def test_lines_to_compare_are_worked_out_and_named(view, shared, qapp):
    view.header.set_lines(["f", "constant"])
    wait(qapp, lambda: view.extras.known.constant and Scheme.F in view.extras.known.paths)
    names = [name for line in view.overlays.lines for name in line.names]
    assert {"f", "constant lean"} <= set(names)


def test_what_another_view_points_at_is_outlined(view, shared):
    shared.set_hover(Hover(7, 30, 0, 0))
    assert view.canvas.outlined == Cell(7, 30)
    shared.set_hover(None)
    assert view.canvas.outlined is None


def test_the_x_range_is_told_and_taken_without_an_echo(view, shared, qtbot):
    with qtbot.waitSignal(view.x_range_changed) as told:
        view.canvas.getViewBox().setXRange(10.0, 20.0, padding=0.0)
    assert told.args == pytest.approx([10.0, 20.0])
    with qtbot.assertNotEmitted(view.x_range_changed):
        view.set_x_range(5.0, 25.0)
    assert view.plot_item.getViewBox().viewRange()[0] == pytest.approx([5.0, 25.0])


def test_changed_inputs_dim_the_map_and_keep_the_line_in_place(view, mouse, shared, qapp):
    shared.document.set_value("settings.safety_distance_mm", 40.0)
    assert shared.stale
    assert "plan to update" in view.overlays.notice.text
    assert view.canvas.line_at(mouse.place(24, lean_at(shared, 24))) is None
    shared.document.undo()
    assert not shared.stale
    assert not view.overlays.notice.isVisible()
    assert view.canvas.line_at(mouse.place(24, lean_at(shared, 24))) == 24


def test_texts_follow_the_language(view, shared):
    shared.look.set_language("zh_CN")
    shared.turns.finish()
    assert view.header.layer_box.currentText() == "筛选结果"
    assert "构型" in view.header.page_box.itemText(1)
    shared.look.set_language("en")
    shared.turns.finish()
    assert view.header.layer_box.currentText() == "Outcome"
    assert view.header.page_box.itemText(0) == "Best of all branches"


@pytest.mark.parametrize("name", ["layer_box", "page_box", "lead_box", "spin_box"])
def test_every_choice_has_a_name_for_screen_readers(view, name):
    assert getattr(view.header, name).accessibleName()


def synthetic(problem, waypoints):
    """Candidates of a long path with 51 leans on 8 branches, made up."""
    one = problem.toolpath.passes[0]
    poses = np.repeat(one.poses[:1], waypoints, axis=0)
    path = Toolpath((Pass(poses, (one.roles[0],) * waypoints, one.feed),), problem.toolpath.frame)
    problem = replace(problem, toolpath=path)
    leans = orientations(problem.settings)
    shape = (waypoints, len(leans), 8)
    x, y, b = np.meshgrid(
        np.linspace(0.0, 40.0, waypoints), np.linspace(-1.0, 1.0, len(leans)), np.arange(8),
        indexing="ij",
    )  # fmt: skip
    field = 0.6 * np.sin(x + b) + 1.2 * y
    outcome = np.where(field > 0.8, 4, np.where(field < -0.9, 2, 0)).astype(np.uint8)
    clearance = np.where(outcome == 0, 0.05 + 0.05 * field, np.nan)
    place = np.argwhere(outcome == 0)
    candidate = np.column_stack([place, np.zeros(len(place))]).astype(np.int32)
    joints = np.zeros((len(place), 6))
    offsets = np.concatenate([[0], np.cumsum((outcome == 0).sum(axis=(1, 2)))])
    nodes = Nodes(candidate, joints, joints, clearance[outcome == 0], offsets)
    turns = (outcome == 0).astype(np.uint8)
    return CandidateSet(
        problem, None, leans, np.arange(8), np.zeros((*shape[:2], 8, 1)), outcome, turns,
        clearance, nodes,
    )  # fmt: skip


def test_two_million_candidates_are_shown_and_pan(view, shared, qapp):
    candidates = synthetic(shared.result.problem, 5000)
    assert candidates.outcome.size == 51 * 8 * 5000
    assert len(candidates.nodes) > MANY_NODES
    expected = MapModel(candidates).counts(view_cells(candidates).kind)
    view.shown.result = view.shown.extra_cost = None
    view.show_candidates(candidates)
    wait(qapp, lambda: view.shown.cells is not None)
    assert view.canvas.model.waypoints == 5000
    assert view.canvas.model.counts(view.shown.cells.kind) == expected
    box = view.canvas.getViewBox()
    for left in range(0, 4800, 160):
        box.setXRange(left + 0.5, left + 200.5, padding=0.0)
        view.canvas.viewport().repaint()
    assert box.viewRange()[0] == pytest.approx([4640.5, 4840.5])
    image = view.canvas.grab().toImage()
    drawn = {image.pixelColor(400, y).name() for y in range(10, image.height() - 60)}
    feasible = QColor(*view.shown.colours.classes[CellClass.SAFE]).name()
    near_ones = QColor(*view.shown.colours.classes[CellClass.NEAR]).name()
    assert {feasible, near_ones} <= drawn


def view_cells(candidates):
    from posopt_gui.viewmodels.map_model import BEST_OF_ALL

    return MapModel(candidates).cells(Layer.OUTCOME, BEST_OF_ALL)


def test_a_plan_that_fails_shows_its_candidates_and_its_empty_layers(qapp, qtbot, planned_state):
    moved = planned_state.with_value("beam.position_xy_mm", [2000.0, -200.0])
    session = Session(Document(moved))
    view = MapView(session)
    qtbot.addWidget(view)
    view.resize(900, 380)
    view.show()
    session.start()
    wait(qapp, lambda: session.plan_error is not None and view.canvas.model is not None)
    empty = view.canvas.model.empty_layers.tolist()
    assert len(empty) == 15
    assert [band.waypoint for band in view.overlays.bands] == empty
    assert view.overlays.notice.isVisible()
    qtbot.mouseClick(view.overlays.notice, LEFT)
    assert session.cursor == empty[0]
    view.extras.close()
    assert session.close()
