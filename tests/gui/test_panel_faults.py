"""Panels as an acceptance test found them wanting: each fault has its test."""

import os
from pathlib import Path

import pytest
from PySide6.QtCore import QEvent, QPoint, QPointF, QSettings, QStandardPaths, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtWidgets import QApplication, QMainWindow

from posopt_gui import start
from posopt_gui.controllers import folders
from posopt_gui.controllers.playback import PlaybackController
from posopt_gui.dialogs.export_dialog import ExportDialog
from posopt_gui.views.curve_plots import GAUGE, LEFT_AXIS
from posopt_gui.views.curves_view import CurvesView
from posopt_gui.views.map_interaction import Cell
from posopt_gui.views.place_slider import STEPS
from posopt_gui.views.results_view import ResultsView
from posopt_gui.views.status_line import StatusLine
from posopt_gui.views.timeline_view import TimelineView


@pytest.fixture
def shown(qtbot):
    def show(made, width, height):
        qtbot.addWidget(made)
        made.resize(width, height)
        with qtbot.waitExposed(made):
            made.show()
        return made

    return show


def replan(qtbot, session, key, value):
    session.document.set_value(key, value, "Change")
    with qtbot.waitSignal(session.result_changed, timeout=60_000):
        session.plan()


def test_a_safety_distance_that_is_not_kept_is_said_in_the_tone_of_a_warning(planned, qtbot):
    window = QMainWindow()
    qtbot.addWidget(window)
    line = StatusLine(planned, window.statusBar())
    replan(qtbot, planned, "settings.safety_distance_mm", 95.0)
    qtbot.waitUntil(lambda: not planned.planning, timeout=60_000)
    assert line.words.text().startswith("Planned, but least clearance ")
    assert "is less than the 95.0 mm asked (waypoint " in line.words.text()
    assert planned.look.theme.warning in line.words.styleSheet()


def test_the_verdict_of_the_program_stands_in_the_status_bar_and_a_click_asks_for_the_list(
    planned, qtbot
):
    window = QMainWindow()
    qtbot.addWidget(window)
    line = StatusLine(planned, window.statusBar())
    qtbot.waitUntil(lambda: planned.report is not None, timeout=120_000)
    count = len(planned.report.checks)
    assert not line.gate.isHidden()
    assert line.gate.text() == f"✓ Program: {count} checks passed"
    assert planned.look.theme.good in line.gate.styleSheet()
    with qtbot.waitSignal(line.checks_wanted):
        line.gate.click()
    planned.document.set_value("beam.section", "HW250", "Section")
    qtbot.waitUntil(lambda: planned.stale)
    assert line.gate.isHidden()


@pytest.mark.parametrize("there", [True, False])
def test_a_folder_of_documents_that_does_not_exist_is_not_proposed(tmp_path, monkeypatch, there):
    documents = tmp_path / "Documents"
    if there:
        documents.mkdir()
    monkeypatch.setattr(QStandardPaths, "writableLocation", lambda _: str(documents))
    assert folders.first_folder() == (documents if there else Path.home())


def test_no_head_of_a_scheme_is_cut_off(planned, qtbot, shown):
    view = shown(ResultsView(planned), 640, 300)
    view.tabs.setCurrentIndex(1)
    qtbot.waitUntil(lambda: view.schemes.columnCount() == 5, timeout=60_000)
    for width in (640, 1100, 660):
        view.resize(width, 300)
        QApplication.processEvents()
        header = view.schemes.horizontalHeader()
        for column in range(5):
            assert header.sectionSize(column) >= header.sectionSizeHint(column)


def test_the_references_keep_their_names_in_a_narrow_window(planned, qtbot, shown):
    view = shown(CurvesView(planned), 655, 250)
    buttons = view.legend._references.values()
    only = Qt.ToolButtonStyle.ToolButtonIconOnly
    assert all(one.toolButtonStyle() != only and one.isVisible() for one in buttons)
    assert view.legend.width() >= view.legend.sizeHint().width()
    bar = view.tabs.tabBar()
    last = bar.mapTo(view, bar.tabRect(bar.count() - 1).topRight()).x()
    assert last <= view.legend.mapTo(view, QPoint(0, 0)).x()


@pytest.mark.parametrize("height", [180, 205, 260])
def test_the_last_joint_is_never_cut(planned, qtbot, shown, height):
    view = shown(CurvesView(planned), 700, 500)
    view.resize(700, height)
    whole = view._scroll.viewport()
    last = view.joint_plots[5]

    def fits():
        bottom = last.mapTo(view._rows, QPoint(0, last.height())).y()
        return bottom <= whole.height() + view._scroll.verticalScrollBar().maximum() and (
            view._scroll.verticalScrollBar().maximum() == 0
        )

    qtbot.waitUntil(fits, timeout=5_000)


def test_without_a_plan_the_curves_keep_the_maps_axis(planned, qtbot, shown):
    view = shown(CurvesView(planned), 800, 400)
    before = [plot.width() for plot in view.joint_plots]
    planned.open(planned.document.state)
    qtbot.waitUntil(lambda: view._plan is None, timeout=5_000)
    QApplication.processEvents()
    assert all(gauge.isVisible() for gauge in view.gauges)
    assert [plot.width() for plot in view.joint_plots] == before


def press(slider, x, kind=QEvent.Type.MouseButtonPress):
    button = Qt.MouseButton.LeftButton
    held = Qt.MouseButton.NoButton if kind is QEvent.Type.MouseButtonRelease else button
    place = QPointF(x, slider.height() / 2.0)
    event = QMouseEvent(
        kind, place, slider.mapToGlobal(place), button, held, Qt.KeyboardModifier.NoModifier
    )
    QApplication.sendEvent(slider, event)


@pytest.mark.parametrize("width", [520, 660, 1100])
def test_a_waypoint_of_the_slider_stands_below_its_column_of_the_plots(planned, shown, width):
    view = shown(TimelineView(planned), width, 70)
    first, way = view._slider.way()
    left = view._slider.x() + first
    # A style that another test has set may want more room than was asked for.
    plot = view.width() - LEFT_AXIS - GAUGE
    for number in (1, 17, 50):
        wanted = LEFT_AXIS + plot * (number - 0.5) / 50
        assert left + way * (number - 1) / 49 == pytest.approx(wanted, abs=1.5)


def test_a_click_on_the_slider_goes_there(planned, shown):
    view = shown(TimelineView(planned), 800, 70)
    first, way = view._slider.way()
    press(view._slider, first + 0.75 * way)
    press(view._slider, first + 0.75 * way, QEvent.Type.MouseButtonRelease)
    assert planned.cursor == round(0.75 * 49)


def test_let_go_between_two_waypoints_the_slider_goes_to_the_nearer_one(planned, shown):
    view = shown(TimelineView(planned), 800, 70)
    first, way = view._slider.way()
    press(view._slider, first)
    press(view._slider, first + way * 8.35 / 49, QEvent.Type.MouseMove)
    assert planned.place == pytest.approx(8.35, abs=0.1)
    assert planned.place != round(planned.place)
    press(view._slider, first + way * 8.35 / 49, QEvent.Type.MouseButtonRelease)
    assert planned.place == 8.0
    assert view._slider.value() == 8 * STEPS


def test_a_pause_ends_at_a_waypoint(planned):
    playback = PlaybackController(planned)
    playback.play()
    playback.advance(float(playback.times[8:10].mean()) + 0.1)
    assert planned.place != round(planned.place)
    playback.pause()
    assert planned.place == round(planned.place)
    assert playback.time == pytest.approx(playback.times[planned.cursor])


def test_a_cursor_that_is_dragged_and_let_go_ends_at_a_waypoint(planned, shown):
    view = shown(CurvesView(planned), 800, 400)
    line = view.clearance_plot._cursor
    line.setValue(9.65)
    line.sigDragged.emit(line)
    assert planned.place == pytest.approx(8.65)
    line.sigPositionChangeFinished.emit(line)
    assert planned.place == 9.0


def test_the_clock_says_that_it_counts_the_contact(planned, shown):
    view = shown(TimelineView(planned), 800, 70)
    assert view._clock.text() == f"Contact 0.0 / {view.playback.duration:.1f} s"


def test_a_click_on_a_check_marks_the_line_that_it_names(planned, qtbot, tmp_path):
    dialog = ExportDialog(planned)
    qtbot.addWidget(dialog)
    dialog.exporter.set_folder(tmp_path)
    dialog.show()
    qtbot.waitUntil(lambda: bool(dialog.checks._rows) and bool(dialog._files), timeout=60_000)
    number, row = next(
        (number, row)
        for number, row in enumerate(dialog.checks._rows)
        if row.line is not None and row.waypoint is not None
    )
    dialog.checks.clicked.emit(dialog.checks.model().index(number, 1))
    assert planned.cursor == row.waypoint
    assert dialog.preview.marked == row.line
    (mark,) = dialog.preview.extraSelections()
    assert mark.cursor.blockNumber() == row.line - 1
    area = dialog.preview.cursorRect(mark.cursor)
    assert dialog.preview.viewport().rect().intersects(area)
    assert dialog.shut_down()


@pytest.fixture
def whole(tmp_path, monkeypatch, qtbot):
    """The whole window at its smaller size, with a plan."""
    monkeypatch.setitem(os.environ, "XDG_DATA_HOME", str(tmp_path))
    settings = QSettings(str(tmp_path / "kept.ini"), QSettings.Format.IniFormat)
    window = start.make_window("groove_paper", "en", "light", settings)
    window.resize(1280, 800)
    qtbot.addWidget(window)
    window.show()
    window.load_views()
    with qtbot.waitSignal(window.session.result_changed, timeout=120_000):
        window.session.start()
    yield window
    window.close()


def test_the_first_hint_leaves_the_3d_view_free(whole, qtbot):
    qtbot.waitUntil(lambda: whole.hints.shown == "beam", timeout=10_000)
    scene = whole.scene.mapTo(whole, QPoint(0, 0)).x()
    assert whole.hints.bubble.geometry().right() < scene


def test_in_the_window_the_slider_stands_below_the_columns_of_the_map(whole, qtbot):
    slider, canvas = whole.timeline._slider, whole.map.canvas
    start_x, way = slider.way()

    def aligned():
        left = slider.mapTo(whole, QPoint(0, 0)).x() + start_x
        return all(
            canvas.mapTo(whole, canvas.place_of(Cell(waypoint, 5))).x()
            == pytest.approx(left + way * waypoint / 49, abs=3.0)
            for waypoint in (0, 20, 49)
        )

    qtbot.waitUntil(aligned, timeout=10_000)
