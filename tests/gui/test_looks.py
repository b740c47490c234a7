"""What was seen to be wrong in pictures of the window, each as a test of its own."""

from pathlib import Path

import numpy as np
import pytest
from PySide6.QtGui import QColor, QPalette
from PySide6.QtWidgets import QStyleOptionViewItem

from posopt_gui.dialogs.check_table import CheckTable
from posopt_gui.look import Look
from posopt_gui.viewmodels.export_model import CheckRow
from posopt_gui.viewmodels.map_colours import CellClass, Layer
from posopt_gui.viewmodels.results_model import Total
from posopt_gui.views.curves_view import CurvesView
from posopt_gui.views.guide_window import GuideWindow
from posopt_gui.views.map_view import MapView
from posopt_gui.views.scene_items import SEE_THROUGH, SOLID
from posopt_gui.views.totals_strip import TotalsStrip

ROOT = Path(__file__).parents[2]


@pytest.fixture
def curves(qtbot, planned):
    made = CurvesView(planned)
    qtbot.addWidget(made)
    made.resize(658, 251)
    with qtbot.waitExposed(made):
        made.show()
    qtbot.waitUntil(lambda: len(made.comparison.tracks) == 3, timeout=60_000)
    return made


def readouts_inside(curves):
    return [
        0.0 <= plot._readout.pos().y() <= plot.getPlotItem().getViewBox().height() + 1.0
        for plot in curves.joint_plots
    ]


def test_words_of_the_joints_stay_inside_when_the_window_becomes_lower(curves, qtbot):
    curves.resize(1758, 677)
    qtbot.waitUntil(lambda: curves.joint_plots[0].height() > 90)
    qtbot.waitUntil(lambda: curves.joint_plots[5]._readout.pos().y() > 60.0)
    curves.resize(1758, 310)
    qtbot.waitUntil(lambda: curves.joint_plots[0].height() < 50)
    qtbot.waitUntil(lambda: all(readouts_inside(curves)), timeout=5_000)


def test_all_joints_are_named_in_the_smallest_window(curves):
    assert curves.legend._menu_button.text() == "J1–J6"


def test_the_feed_has_no_toggles_that_change_nothing(curves):
    curves.tabs.setCurrentWidget(curves.feed)
    assert curves.legend.isHidden()
    curves.tabs.setCurrentWidget(curves.step_plot)
    assert not curves.legend.isHidden()


def test_curves_without_a_plan_say_so(curves):
    curves._plan = None
    curves._on_place(0.0)
    assert "There is no plan." in curves.clearance_plot._readout.toPlainText()
    assert "There is no plan." in curves.joint_plots[0]._readout.toPlainText()
    assert not curves.joint_plots[1]._readout.toPlainText()


def test_each_broad_outcome_has_its_letter_on_the_lowest_map(qtbot, planned):
    view = MapView(planned)
    qtbot.addWidget(view)
    view.resize(658, 229)
    with qtbot.waitExposed(view):
        view.show()
    broad = {CellClass.NEAR, CellClass.COLLISION}
    qtbot.waitUntil(lambda: broad <= {one[0] for one in view.canvas._letters._letters})


def test_the_map_has_a_true_minus_at_its_leans(qtbot, planned):
    view = MapView(planned)
    qtbot.addWidget(view)
    axis = view.plot_item.getAxis("left")
    assert axis.tickStrings([-20.0, 0.0, 20.0], 1.0, 20.0) == ["−20", "0", "20"]


def test_the_legend_of_extra_cost_needs_one_row_and_keeps_one_for_a_notice(qtbot, planned):
    view = MapView(planned)
    qtbot.addWidget(view)
    view.resize(658, 229)
    with qtbot.waitExposed(view):
        view.show()
    place = view.header.layer_box.findData(Layer.EXTRA_COST)
    view.header.layer_box.setCurrentIndex(place)
    legend = view.legend
    assert {place.y() for place in legend._places()} == {0.0}
    assert legend.free_row().y() > 0.0
    assert legend.free_row().width() > 600.0


def test_totals_keep_no_gap_when_numbers_are_added(qtbot):
    strip = TotalsStrip()
    qtbot.addWidget(strip)
    strip.resize(1700, 60)
    strip.set_totals(())
    strip.set_totals([Total("one", "1"), Total("two", "2"), Total("three", "3")])
    with qtbot.waitExposed(strip):
        strip.show()
    gaps = np.diff([name.x() for name in strip._names])
    assert max(gaps) < 120


def test_a_failed_check_stays_red_when_it_is_chosen(qtbot):
    look = Look()
    table = CheckTable(look)
    qtbot.addWidget(table)
    row = CheckRow(False, "FAILED", "clearance", "71.4 mm", "90.0 mm", "", None)
    table.show_rows((row,), old=False)
    index = table.model().index(0, 0)
    assert table.selectionModel().isSelected(index)
    option = QStyleOptionViewItem()
    table.itemDelegateForColumn(0).initStyleOption(option, index)
    colour = option.palette.color(QPalette.ColorRole.HighlightedText)
    assert colour == QColor(look.theme.error)


def test_the_guide_has_no_bar_below_it_and_nothing_beside_the_page(qtbot):
    window = GuideWindow(Look())
    qtbot.addWidget(window)
    window.open(ROOT / "docs/window.md")
    with qtbot.waitExposed(window):
        window.show()
    page = window.page
    qtbot.waitUntil(lambda: page.verticalScrollBar().maximum() > 0)
    assert not page.horizontalScrollBar().isVisible()
    assert page.document().idealWidth() <= page.width()


def test_bodies_lie_before_solids_with_the_same_face_and_behind_their_edges():
    back, middle = SOLID["glPolygonOffset"], SEE_THROUGH["glPolygonOffset"]
    assert back > middle > (0.0, 0.0)
