import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt

from posopt_gui.views.curves_view import CurvesView


@pytest.fixture
def view(qtbot, planned):
    made = CurvesView(planned)
    qtbot.addWidget(made)
    made.resize(900, 420)
    with qtbot.waitExposed(made):
        made.show()
    qtbot.waitUntil(lambda: len(made.comparison.tracks) == 3, timeout=60_000)
    return made


def line_of(plot, name):
    return plot._curves[name].points


def test_each_joint_is_drawn_in_pendant_degrees_over_the_waypoint_numbers(view, planned):
    for joint, plot in enumerate(view.joint_plots):
        x, y = line_of(plot, "PLAN")
        assert x.tolist() == list(range(1, 51))
        np.testing.assert_allclose(y, np.rad2deg(planned.sequence.pendant[:, joint]))


def test_references_are_drawn_when_they_are_chosen(view):
    view.legend.set_shown(["CONSTANT"])
    assert view.joint_plots[0].shown_curves == {"PLAN", "CONSTANT"}
    view.legend.set_shown(["NOMINAL", "RANDOM"])
    assert view.joint_plots[0].shown_curves == {"PLAN", "NOMINAL", "RANDOM"}


def test_one_cursor_runs_through_all_plots_and_can_be_dragged(view, planned):
    planned.set_place(16.25)
    assert {plot._cursor.value() for plot in view.plots} == {17.25}
    view.clearance_plot._cursor.setValue(30.0)
    view.clearance_plot._cursor.sigDragged.emit(view.clearance_plot._cursor)
    assert planned.cursor == 29
    assert {plot._cursor.value() for plot in view.plots} == {30.0}


def test_a_click_into_a_plot_selects_the_waypoint_there(view, planned, qtbot):
    plot = view.joint_plots[2]
    box = plot.getPlotItem().getViewBox()
    scene = box.mapViewToScene(QPointF(30.0, box.viewRect().center().y()))
    planned.set_cursor(0)
    place = plot.mapFromScene(scene)
    qtbot.mouseClick(
        plot.viewport(), Qt.MouseButton.LeftButton, pos=QPoint(int(place.x()), int(place.y()))
    )
    qtbot.waitUntil(lambda: planned.cursor == 29, timeout=5_000)


def test_zooming_one_plot_zooms_all_and_tells_the_map(view, qtbot):
    with qtbot.waitSignal(view.x_range_changed) as told:
        box = view.joint_plots[0].getPlotItem().getViewBox()
        box.setXRange(10.0, 20.0, padding=0.0)
        box.sigRangeChangedManually.emit([True, False])
    assert told.args == pytest.approx([10.0, 20.0])
    for item in view.plot_items:
        assert item.getViewBox().viewRange()[0] == pytest.approx([10.0, 20.0])
    with qtbot.assertNotEmitted(view.x_range_changed):
        view.set_x_range(5.0, 15.0)
    assert view.joint_plots[3].getPlotItem().getViewBox().viewRange()[0] == pytest.approx([5, 15])


def test_limits_are_bands_that_the_whole_axes_show(view, planned):
    limits = np.rad2deg(planned.problem.joint_limits)
    for joint, plot in enumerate(view.joint_plots):
        lower, upper = plot._bands
        assert lower.getRegion()[1] == pytest.approx(limits[joint, 0])
        assert upper.getRegion()[0] == pytest.approx(limits[joint, 1])
    view.legend.set_whole_limits(True)
    for joint, plot in enumerate(view.joint_plots):
        low, high = plot.getPlotItem().getViewBox().viewRange()[1]
        assert low < limits[joint, 0]
        assert high > limits[joint, 1]


def test_one_joint_alone_takes_all_the_room_and_the_last_stays(view):
    for action in view.legend._joints[:5]:
        action.trigger()
    assert [plot.isVisible() for plot in view.joint_plots] == [False] * 5 + [True]
    view.legend._joints[5].trigger()
    assert view.joint_plots[5].isVisible()
    view.legend._all.trigger()
    assert all(plot.isVisible() for plot in view.joint_plots)


def test_a_narrow_view_keeps_its_toggles_and_drops_their_words(view, qtbot):
    beside = Qt.ToolButtonStyle.ToolButtonTextBesideIcon
    view.resize(1200, 420)
    qtbot.waitUntil(lambda: view.legend._references["RANDOM"].toolButtonStyle() == beside)
    view.resize(560, 420)
    qtbot.waitUntil(lambda: view.legend._references["RANDOM"].toolButtonStyle() != beside)
    assert all(button.isVisible() for button in view.legend._references.values())


def test_the_clearance_is_drawn_with_the_safety_distance(view, planned):
    view.tabs.setCurrentWidget(view.clearance_plot)
    _, y = line_of(view.clearance_plot, "PLAN")
    np.testing.assert_allclose(y, 1000.0 * planned.sequence.clearance)
    assert view.clearance_plot._level.value() == pytest.approx(50.0)


def test_the_feed_follows_the_check_of_the_program(view, planned, qtbot):
    view.tabs.setCurrentWidget(view.feed)
    qtbot.waitUntil(lambda: view.feed.curve is not None, timeout=120_000)
    curve = view.feed.curve
    assert curve.waypoint.tolist() == list(range(2, 51))
    np.testing.assert_allclose(curve.asked, 20.0)
    assert np.all(curve.slowest <= curve.fastest)


def test_bars_and_table_show_the_cumulative_change(view, planned):
    change = np.rad2deg(np.abs(np.diff(planned.sequence.pendant, axis=0)).sum(axis=0))
    view.legend.set_shown([])
    view.tabs.setCurrentWidget(view.bars)
    np.testing.assert_allclose(view.bars._bars[0].opts["height"], change)
    view.tabs.setCurrentWidget(view.table)
    shown = [float(view.table.item(1, column).text()) for column in range(6)]
    np.testing.assert_allclose(shown, change, atol=0.0051)


def test_a_wish_moves_the_drawn_line(view, planned, qtbot):
    before = line_of(view.joint_plots[3], "PLAN")[1].copy()
    with qtbot.waitSignal(planned.result_changed, timeout=60_000):
        planned.pin(20, 0.0)
    planned.turns.finish()
    after = line_of(view.joint_plots[3], "PLAN")[1]
    assert not np.allclose(before, after)
    np.testing.assert_allclose(after, np.rad2deg(planned.sequence.pendant[:, 3]))


def test_language_and_theme_are_switched_in_place(view, planned):
    planned.look.set_language("zh_CN")
    planned.look.set_theme("dark")
    planned.turns.finish()
    assert view.tabs.tabText(1) == "间隙"
    assert view.backgroundRole() is not None
    planned.look.set_language("en")
    planned.turns.finish()
    assert view.tabs.tabText(1) == "Clearance"


def test_before_the_first_plan_the_view_is_empty_and_sound(qtbot, session):
    made = CurvesView(session)
    qtbot.addWidget(made)
    with qtbot.waitExposed(made):
        made.show()
    for index in range(made.tabs.count()):
        made.tabs.setCurrentIndex(index)
    assert made.joint_plots[0].shown_curves == set()
    assert made.feed.curve is None
