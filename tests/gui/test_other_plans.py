"""What is under way or looked at when another plan comes, whose waypoints and leans are others."""

import math
import time
from types import SimpleNamespace

import numpy as np
import pytest
from map_mouse import LEFT, RIGHT, Mouse
from PySide6.QtCore import QObject, QPoint
from PySide6.QtWidgets import QApplication

from posopt_gui.controllers.playback import PlaybackController
from posopt_gui.controllers.pose_facts import PoseExplainer
from posopt_gui.controllers.session import Hover, Session
from posopt_gui.controllers.session_jobs import planned_by
from posopt_gui.document.document import Document
from posopt_gui.document.project import state_of_cell
from posopt_gui.viewmodels.inspector_model import Pose
from posopt_gui.views import map_line_items, map_view, refresh, scene_ghost
from posopt_gui.views.inspector_view import InspectorView
from posopt_gui.views.map_interaction import Cell
from posopt_gui.views.map_view import MapView
from posopt_gui.views.results_view import ResultsView
from posopt_gui.views.scene_looked import Looked
from solver.model.wishes import Pin, Region
from solver.progress import SilentMonitor

POINTS, LEANS = "path.line.points", "settings.lean_deg"
FEW = 5
"""Waypoints of the shorter path."""


def wait(condition, seconds=120.0):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "it did not happen in time"
        QApplication.processEvents()


def settle(session):
    """Until nothing is planned, answered or shown any more."""
    wait(lambda: not (session.planning or session._wishes.busy or session.turns.waiting))


@pytest.fixture(scope="module")
def state():
    return state_of_cell("groove_paper")


@pytest.fixture(scope="module")
def kept_session(qapp, state):
    made = Session(Document(state))
    made.start()
    wait(lambda: made.result is not None)
    yield made
    assert made.close()


@pytest.fixture
def session(kept_session, state):
    """A session that has planned fifty waypoints."""
    if kept_session.document.state != state:
        kept_session.document.reset(state)
        kept_session.plan()
    settle(kept_session)
    wait(lambda: not kept_session.stale and kept_session.waypoints == 50)
    kept_session.set_hover(None)
    kept_session.keep(None)
    kept_session.set_cursor(0)
    return kept_session


@pytest.fixture
def view(qtbot, session):
    made = MapView(session)
    qtbot.addWidget(made)
    made.resize(1000, 420)
    made.show()
    qtbot.waitExposed(made)
    yield made
    made.leave()
    made.extras.close()


@pytest.fixture
def mouse(qapp, view):
    return Mouse(qapp, view)


def line_at(session, waypoint):
    return math.degrees(session.sequence.angles[waypoint, 0])


def take_hold(mouse, session, waypoint, other):
    """Drag the line at a waypoint to another lean, and wait for what that would cost."""
    lean = line_at(session, waypoint)
    mouse.move(waypoint, lean)
    mouse.press(waypoint, lean)
    mouse.move(waypoint, other)
    wait(lambda: session.previewing and session.answer is not None)
    settle(session)


def change(session, **changed):
    """Change the inputs, given by the last part of their key; nothing is planned yet."""
    for key, value in changed.items():
        session.document.set_value({"points": POINTS, "leans": LEANS}[key], value)


def arrive(session):
    """The plan of the inputs comes now."""
    session._planned(planned_by(session.document.state, session.compared, SilentMonitor()))


def test_a_drag_is_given_up_when_another_plan_comes(view, mouse, session):
    take_hold(mouse, session, 45, 5.0)
    arrive(session)
    assert session.hover is None
    assert not session.previewing
    assert not view.wishes.price.isVisible()
    assert not view.wishes.busy
    settle(session)
    assert session.answer is None
    mouse.move(2, 5.0)
    mouse.release(2, 5.0)
    assert session.document.state.pins == ()


def test_a_drag_is_given_up_when_the_inputs_change_and_pins_nothing(view, mouse, session):
    """The line of a plan that is out of date pinned waypoint 46 of a path of five."""
    take_hold(mouse, session, 45, 5.0)
    session.document.set_value(POINTS, FEW)
    assert not view.wishes.busy
    settle(session)
    assert session.answer is None
    mouse.release(45, 5.0)
    assert session.document.state.pins == ()
    assert not session.previewing


def test_a_region_that_is_being_drawn_is_not_forbidden_in_another_plan(view, mouse, session):
    change(session, points=FEW)
    mouse.press(44, 5.0, RIGHT)
    mouse.move(47, -5.0)
    assert view.wishes.busy
    arrive(session)
    settle(session)
    mouse.move(3, 5.0)
    mouse.release(3, 5.0, RIGHT)
    assert session.document.state.regions == ()


def test_a_button_that_is_held_down_while_another_plan_comes_does_nothing_later(
    view, mouse, session
):
    lean = line_at(session, 45)
    mouse.press(45, lean)
    arrive(session)
    settle(session)
    mouse.move(45, 9.0)
    mouse.release(45, 9.0)
    assert session.document.state.pins == ()
    assert session.cursor == 0
    mouse.click(2, line_at(session, 2), LEFT)
    assert session.cursor == 2


def test_what_is_pointed_at_is_forgotten_with_its_plan(view, mouse, session, qtbot):
    inspector = InspectorView(session)
    qtbot.addWidget(inspector)
    change(session, points=FEW, leans=[-5.0, 25.0, 1.0])
    session.set_hover(Hover(48, 50, 0))
    told = []
    session.hover_changed.connect(told.append)
    arrive(session)
    session.hover_changed.disconnect(told.append)
    assert session.hover is None
    assert told == [None]
    settle(session)
    assert inspector.title.text() == f"Waypoint 1/{FEW}"


def test_what_is_pointed_at_is_forgotten_when_a_plan_fails(session):
    change(session, leans=[80.0, 85.0, 1.0])
    session.set_hover(Hover(48, 50, 0))
    session.plan()
    wait(lambda: session.plan_error is not None)
    assert session.hover is None
    assert session.kept is None


@pytest.mark.parametrize("beyond", [Hover(60, 0, 0), Hover(3, 51, 0), Hover(3, 0, 1)])
def test_a_candidate_that_the_plan_does_not_have_is_shown_nowhere(view, session, qtbot, beyond):
    """An orientation or branch of a larger plan was an index beyond the arrays."""
    inspector = InspectorView(session)
    qtbot.addWidget(inspector)
    looked = Looked(session)
    looked.ghost, looked.ghost_report = beyond, SimpleNamespace(points=None, patches=())
    for tell in (session.set_hover, session.keep):
        tell(beyond)
        assert inspector.subtitle.text().startswith("On the plan")
        assert view.canvas.outlined is None
        assert looked.pose_of(beyond) is None
        assert not any("Candidate" in one for one in looked.notes(None))
        tell(None)


def test_a_waypoint_that_the_plan_does_not_have_is_not_explained(qapp, session):
    explainer = PoseExplainer()
    explainer.ask(session.result, Pose(50, 0.0, 0.0, 0.0, 0, 0))
    assert not explainer._timer.isActive()
    explainer.ask(session.result, Pose(49, 0.0, 0.0, 0.0, 0, 0))
    assert explainer._timer.isActive()
    explainer.forget()


def test_no_pose_is_measured_in_the_scene_of_another_plan(session):
    """A waypoint beyond the probe's plan was read beyond the end of its array."""
    asked = []
    probe = SimpleNamespace(
        quick=True, problem=object(), measure=lambda *given: asked.append(given) or "measured"
    )
    cell = SimpleNamespace(rest=np.zeros(6))
    looked = Looked(session)
    nodes = session.result.candidates.nodes
    looked.ghost = Hover(3, int(nodes.candidate[session.sequence.nodes[3], 1]), 0)
    looked.measure(cell, probe)
    looked.measure_ghost(probe)
    assert looked.report is None
    assert looked.ghost_report is None
    assert asked == []
    probe.problem = session.result.problem
    looked.measure(cell, probe)
    assert looked.report == "measured"


def test_an_open_menu_closes_when_another_plan_comes(view, session):
    change(session, points=FEW)
    view.wishes._show_menu(Cell(45, 20), QPoint(5, 5))
    menu = view.wishes._menu
    wait(menu.isVisible)
    hidden = []
    menu.aboutToHide.connect(lambda: hidden.append(1))
    arrive(session)
    assert hidden
    assert view.wishes._menu is None
    settle(session)


def test_an_entry_of_a_menu_means_the_lean_that_it_names_in_another_plan(view, session):
    row = view.shown.model.row_of(line_at(session, 3))
    cell, lean = Cell(3, row), math.radians(view.shown.model.leans[row])
    menu = view.wishes.menu(cell)
    entries = {one.text(): one for one in menu.actions()}
    change(session, leans=[-5.0, 25.0, 1.0])
    arrive(session)
    settle(session)
    next(one for text, one in entries.items() if "any branch" in text).trigger()
    assert session.document.state.pins == (Pin(3, pytest.approx(lean)),)
    entries["Forbid this pose"].trigger()
    (region,) = session.document.state.regions
    assert region.low < lean < region.high
    assert region.high - region.low < math.radians(0.5)
    settle(session)


def test_a_menu_allows_the_region_that_it_was_opened_on(view, session):
    """It kept the number of the region, which is another one's once one before it is gone."""
    one, other = (Region(k, k, -0.01, 0.01, None) for k in (10, 12))
    session.document.set_regions((one, other), "Forbid")
    settle(session)
    menu = view.wishes.menu(Cell(12, view.shown.model.row_of(0.0)))
    entry = next(act for act in menu.actions() if act.text().startswith("Allow"))
    session.allow(0)
    entry.trigger()
    assert session.document.state.regions == ()
    entry.trigger()
    assert session.document.state.regions == ()
    settle(session)


def test_nothing_is_pointed_at_while_many_candidates_are_prepared(
    view, mouse, session, monkeypatch
):
    """A region drawn meanwhile was forbidden at lean 0."""
    monkeypatch.setattr(map_view, "MANY_NODES", 0)
    monkeypatch.setattr(view.extras, "prepare", lambda _: None)
    place = mouse.place(20, 5.0)
    assert view.canvas.cell_at(place) == Cell(20, 30)
    view.show_candidates(session.result.candidates)
    assert view.canvas.cell_at(place) is None
    assert view.canvas.line_at(place) is None
    view.wishes._drop(Cell(20, 30))
    view.wishes._draw_area(Cell(20, 30), Cell(22, 31), True)
    view.wishes._drag(Cell(20, 30), place)
    assert session.document.state.pins == session.document.state.regions == ()
    assert not view.wishes.price.isVisible()
    settle(session)


def test_the_map_stands_at_the_first_waypoint_of_another_project(view, session, state):
    """The line of the waypoint stayed where it was in the project before."""
    session.set_cursor(30)
    assert view.canvas._cursor.value() == 31.0
    session.open(state)
    assert view.canvas._cursor.value() == 1.0
    session.plan()
    wait(lambda: session.result is not None)
    settle(session)


def test_playback_goes_on_at_the_last_waypoint_of_a_shorter_plan(session):
    playback = PlaybackController(session)
    change(session, points=FEW)
    session.set_place(40.5)
    playback.play()
    arrive(session)
    assert session.place == FEW - 1
    assert playback.time == pytest.approx(playback.duration)
    playback.advance(1.0)
    assert session.place == FEW - 1
    assert not playback.playing
    settle(session)


def test_a_row_or_link_of_a_longer_plan_leads_to_no_waypoint_beyond_the_path(session, qtbot):
    """Tables, messages, checks of the program and the 3D picture all go this way."""
    results = ResultsView(session)
    qtbot.addWidget(results)
    results.resize(900, 400)
    results.show()
    settle(session)
    results.table.selectRow(48)
    old = results.sorted.index(48, 0)
    change(session, points=FEW)
    arrive(session)
    results._on_row(old)
    assert session.cursor == FEW - 1
    session.set_cursor(48)
    assert session.cursor == FEW - 1
    settle(session)
    assert results.sorted.rowCount() == FEW
    assert not results.table.selectionModel().hasSelection()


class SlowScene(QObject):
    """A 3D picture that takes a second."""

    def __init__(self):
        super().__init__()
        self.canvas = SimpleNamespace(seconds=1.0, show_ghost=lambda *_: None)

    def measure_ghost(self):
        pass


def test_a_slow_3d_picture_is_not_drawn_at_every_step_of_a_drag(qapp, session):
    """It held up the line, which then came later than the next step, and so at every step."""
    scene = SlowScene()
    ghost = scene_ghost.SceneGhost(session, scene, Looked(session))
    session.set_hover(Hover(3, 30, 0))
    assert ghost._rest.isActive()
    assert ghost._rest.interval() == scene_ghost.REST
    session.preview_pin(3, 0.0)
    session.set_hover(Hover(3, 31, 0))
    assert ghost._rest.interval() == refresh.REST
    session.end_preview()
    session.set_hover(Hover(3, 30, 0))
    assert ghost._rest.interval() == scene_ghost.REST
    session.set_hover(None)
    assert not ghost._rest.isActive()
    settle(session)
    scene.deleteLater()


def test_names_of_lines_are_placed_once_for_a_view(view, session, monkeypatch):
    """A hover, a step of the playback or of a drag paints the same lines in the same view."""
    placed = []

    def counted(*given):
        placed.append(1)
        return place(*given)

    place = map_line_items.label_places
    monkeypatch.setattr(map_line_items, "label_places", counted)
    settle(session)
    view.overlays.show_lines()
    port = view.canvas.viewport()
    for _ in range(3):
        port.repaint()
    assert len(placed) == 1
    view.canvas.setXRange(10.0, 20.0, padding=0.0)
    port.repaint()
    assert len(placed) == 2
    view.overlays.show_lines()
    port.repaint()
    assert len(placed) == 3
    view.canvas.fit()
