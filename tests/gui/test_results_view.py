import csv
import io

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication

from posopt_gui.controllers.session import Message
from posopt_gui.views.results_view import ResultsView


@pytest.fixture
def view(qtbot, planned):
    made = ResultsView(planned)
    qtbot.addWidget(made)
    made.resize(1100, 400)
    with qtbot.waitExposed(made):
        made.show()
    return made


def column(view, key):
    return [one.key for one in view.model.table.columns].index(key)


def shown(view, key):
    where = column(view, key)
    return [view.sorted.index(row, where).data() for row in range(view.sorted.rowCount())]


def test_all_waypoints_are_listed_and_can_be_sorted_by_clearance(view, planned):
    assert shown(view, "number") == [str(number) for number in range(1, 51)]
    view.table.sortByColumn(column(view, "clearance"), Qt.SortOrder.AscendingOrder)
    order = [int(number) - 1 for number in shown(view, "number")]
    assert np.all(np.diff(planned.sequence.clearance[order]) >= 0.0)


def test_a_double_click_selects_the_waypoint_of_a_sorted_row(view, planned, qtbot):
    view.table.sortByColumn(column(view, "number"), Qt.SortOrder.DescendingOrder)
    view.table.doubleClicked.emit(view.sorted.index(2, 1))
    assert planned.cursor == 47


def test_the_copied_table_reads_back_as_the_joints(view, planned):
    view.copy_action.trigger()
    text = QGuiApplication.clipboard().text()
    rows = list(csv.DictReader(io.StringIO(text), delimiter="\t"))
    joints = [[float(row[f"J{joint} °"]) for joint in range(1, 7)] for row in rows]
    np.testing.assert_allclose(joints, np.rad2deg(planned.sequence.pendant), atol=0.0051)


def test_only_the_selected_rows_are_copied(view):
    view.table.selectRow(3)
    view.copy_action.trigger()
    lines = QGuiApplication.clipboard().text().splitlines()
    assert len(lines) == 2
    assert lines[1].split("\t")[0] == "4"


def test_nearest_bodies_are_found_behind_the_window(view, qtbot):
    qtbot.waitUntil(
        lambda: all(" against " in one for one in shown(view, "bodies")), timeout=30_000
    )


def test_schemes_stand_side_by_side_once_their_tab_is_open(view, planned, qtbot):
    view.tabs.setCurrentIndex(1)
    qtbot.waitUntil(lambda: view.schemes.columnCount() == 5, timeout=60_000)
    heads = [view.schemes.horizontalHeaderItem(c).text() for c in range(5)]
    assert heads == ["exact", "f2", "nominal lean", "best constant lean", "random lean"]
    assert view.schemes.item(0, 0).text() == f"{planned.sequence.joint_cost:.5f}"


def test_messages_select_their_waypoint(view, planned):
    planned.say(Message("error", "Something at waypoint 8.", 7))
    item = view.messages.item(0)
    assert item.text() == "Something at waypoint 8."
    view.messages.itemActivated.emit(item)
    assert planned.cursor == 7
    assert view.tabs.tabText(2) == "Messages (1)"


def test_totals_lead_to_the_nearest_waypoint(view, planned):
    least = int(np.argmin(planned.sequence.clearance))
    view.totals._values[1].linkActivated.emit(str(least))
    assert planned.cursor == least
    assert view.totals.texts["Joint cost"] == f"{planned.sequence.joint_cost:.5f}"


def test_a_wish_shows_its_price_and_its_column(view, planned, qtbot):
    view.tabs.setCurrentIndex(1)
    with qtbot.waitSignal(planned.result_changed, timeout=60_000):
        planned.pin(20, 0.0)
    planned.turns.finish()
    assert "Price of your pins and regions" in view.totals.texts
    heads = [view.schemes.horizontalHeaderItem(c).text() for c in range(3)]
    assert heads[2] == "with your wishes"


def test_changed_inputs_mark_the_numbers_as_old(view, planned):
    assert not view.totals._stale.isVisible()
    planned.document.set_value("settings.safety_distance_mm", 40.0)
    assert view.totals._stale.isVisible()


def test_nothing_is_listed_before_a_plan_and_languages_can_be_switched(qtbot, session):
    made = ResultsView(session)
    qtbot.addWidget(made)
    made.show()
    session.look.set_language("zh_CN")
    session.look.set_theme("dark")
    session.turns.finish()
    assert made.model.rowCount() == 0
    assert made.totals._empty.text() == "还没有规划结果。"
