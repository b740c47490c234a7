from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QRect, Qt

from posopt_gui.dialogs.check_table import CheckTable
from posopt_gui.look import Look
from posopt_gui.viewmodels.check_figures import check_figure, figures, number
from posopt_gui.viewmodels.export_model import ExportForm, Situation, check_rows, export_view
from posopt_gui.views.curve_legend import ALL_JOINTS, CurveLegend
from posopt_gui.views.curves_view import CurvesView
from posopt_gui.views.inspector_view import InspectorView
from posopt_gui.views.map_widgets import Chip, LegendStrip, Notice
from posopt_gui.views.totals_strip import TotalsStrip
from solver.analysis.check import Check
from solver.pipeline.program_check import ProgramReport

NAMES = (
    "program name", "cell digest", "hash", "stated frames", "reach", "program flow",
    "path position", "joint limits", "clearance", "path between positions (sampled)",
    "between positions (sampled)", "net margin", "feed", "joint speed",
    "manipulability along a long and winding way",
)  # fmt: skip
LONG = "manipulability at waypoint 56 of a program with a long name (GROOVE.LS:99)"


def plain(text, **values):
    return text.format(**values) if values else text


def checks(*failed):
    return tuple(Check(name, name not in failed, 1.0, 2.0, "mm", LONG) for name in NAMES)


class Draft:
    def __init__(self, found):
        self.report, self.files = ProgramReport(tuple(found)), ()


def situation(found, **more):
    return Situation(
        form=ExportForm(path="/tmp/GROOVE.LS"), planned=True, current=True, draft=Draft(found),
        order_fault="", **more,
    )  # fmt: skip


@pytest.fixture
def table(qtbot):
    made = CheckTable(Look())
    qtbot.addWidget(made)
    made.resize(700, 200)
    made.retranslate()
    with qtbot.waitExposed(made):
        made.show()
    return made


def chosen(table):
    return [table.item(index.row(), 1).text() for index in table.selectionModel().selectedRows()]


def test_checks_begin_with_clearance_positions_path_and_feed_and_end_with_the_file():
    names = [row.name for row in check_rows(checks("hash"), plain)]
    assert names[0] == "hash"
    assert names[1:6] == [
        "clearance", "net margin", "between positions (sampled)", "path position",
        "path between positions (sampled)",
    ]  # fmt: skip
    assert names[6:8] == ["feed", "joint speed"]
    assert set(names[-4:]) == {"program name", "cell digest", "stated frames", "program flow"}


def test_small_figures_cubes_and_assumptions_are_said_for_people():
    assert check_figure(figures(6.9e-4, 0.01)[0], "deg outside", plain) == "<0.001° outside"
    assert check_figure("0.6663", "m^3", plain) == "0.6663 m³"
    assert number(-6.9e-4) == "-6.9e-04"
    assert len(set(figures(6.9e-4, 5.0e-4))) == 2
    one = Check("elbow bound", True, 60.0, 0.0, "deg inside", "J2+J3", assumed=True)
    flow = Check("program flow", True, 0, 0, "unknown", "assumed not to move: A", assumed=True)
    shown = {row.name: row for row in check_rows((one, flow), plain)}
    assert shown["elbow bound"].limit == "0° inside"
    assert shown["elbow bound"].detail == "J2+J3 (rests on an assumption)"
    assert shown["program flow"].limit == "0 unknown"
    assert "rests" not in shown["program flow"].detail


def test_the_banner_names_the_check_that_failed():
    assert "'feed'" in export_view(situation(checks("feed")), plain).headline
    several = export_view(situation(checks("feed", "hash")), plain).headline
    assert several.startswith("2 of")
    assert "first 'feed'" in several


def test_another_clearance_than_the_plans_is_explained_by_the_rounding_alone():
    found = (Check("clearance", True, 51.3, 50.0, "mm", ""),)
    assert "51.4 mm" in export_view(situation(found, least=0.05142), plain).explanation
    assert export_view(situation(found, least=0.05132), plain).explanation == ""
    assert export_view(situation(found, least=0.060), plain).explanation == ""


def test_new_rows_bring_the_first_failed_check_into_sight_and_choose_it(table, qtbot):
    table.show_rows(check_rows(checks(), plain), old=False)
    qtbot.waitUntil(lambda: table.verticalScrollBar().maximum() > 0)
    table.verticalScrollBar().setValue(table.verticalScrollBar().maximum())
    assert table.verticalScrollBar().value() > 0
    table.selectRow(9)
    table.show_rows(check_rows(checks("joint speed"), plain), old=False)
    assert chosen(table) == ["joint speed"]
    assert table.verticalScrollBar().value() == 0
    qtbot.wait(20)
    assert table.rowAt(5) == 0


def test_a_chosen_check_stays_chosen_by_its_name(table):
    table.show_rows(check_rows(checks(), plain), old=False)
    names = [row.name for row in check_rows(checks(), plain)]
    table.selectRow(names.index("reach"))
    fewer = check_rows([one for one in checks() if one.name != "clearance"], plain)
    table.show_rows(fewer, old=False)
    assert chosen(table) == ["reach"]
    table.show_rows(check_rows([one for one in checks() if one.name != "reach"], plain), old=False)
    assert chosen(table) == []


def test_every_line_of_a_detail_has_room_in_its_row(table, qtbot):
    table.show_rows(check_rows(checks("hash"), plain), old=False)
    for width in (900, 520, 760):
        table.resize(width, 240)
        qtbot.wait(50)
        wanted = [table.sizeHintForRow(row) for row in range(table.rowCount())]
        assert [table.rowHeight(row) for row in range(table.rowCount())] == wanted


def test_a_stale_inspector_says_so_at_its_top_and_is_pale(qtbot, planned):
    view = InspectorView(planned)
    qtbot.addWidget(view)
    view.resize(300, 500)
    with qtbot.waitExposed(view):
        view.show()
    assert not view.stale.isVisible()
    assert not view.body.graphicsEffect().isEnabled()
    cell = dict(planned.document.state.cell)
    cell["settings"] = {**cell["settings"], "safety_distance_mm": 41.0}
    planned.document.edit("x", replace(planned.document.state, cell=cell))
    qtbot.waitUntil(lambda: planned.stale and view.stale.isVisible(), timeout=20_000)
    assert view.stale.text() == "Inputs changed. Plan to update."
    assert view.stale.mapTo(view, QPoint(0, 0)).y() < 30
    assert view.body.graphicsEffect().isEnabled()
    assert view.body.graphicsEffect().opacity() < 0.6
    planned.document.undo()
    qtbot.waitUntil(lambda: not view.stale.isVisible(), timeout=20_000)
    assert not view.body.graphicsEffect().isEnabled()


@pytest.mark.parametrize("height", [150, 260, 420])
def test_no_curve_runs_behind_the_words_of_the_clearance_plot(qtbot, planned, height):
    view = CurvesView(planned)
    qtbot.addWidget(view)
    view.resize(800, height)
    with qtbot.waitExposed(view):
        view.show()
    view.tabs.setCurrentIndex(1)
    plot = view.clearance_plot
    qtbot.waitUntil(lambda: "PLAN" in plot.shown_curves, timeout=20_000)
    qtbot.wait(100)
    box = plot.getPlotItem().getViewBox()
    low, high = box.viewRange()[1]
    top = max(1e3 * np.max(planned.sequence.clearance), 50.0)
    above = box.height() * (high - top) / (high - low)
    assert above >= plot._readout.boundingRect().height() - 6.0


@pytest.mark.parametrize("width", [520, 640, 805, 1100, 1600])
@pytest.mark.parametrize("count", [0, 1, 4, 7])
def test_the_notice_covers_no_word_of_the_legend(qtbot, width, count):
    look = Look()
    strip = LegendStrip()
    qtbot.addWidget(strip)
    notice = Notice(strip)
    notice.set_theme(look.theme)
    strip.resize(width, 30)
    with qtbot.waitExposed(strip):
        strip.show()
    colour = strip.palette().text().color()
    chips = [Chip(colour, "C", colour, f"under the safety distance {n}") for n in range(count)]
    before = None
    for words in ("", "Inputs have changed; plan to update (F5)", "Planned, but " * 20):
        strip.set_legend(None, chips, look.theme)
        strip.resize(width, strip.minimumHeight())
        if words:
            notice.tell("warning", words, "Unpin waypoint 25")
            assert strip.rect().contains(notice.geometry())
            for chip, place in zip(strip._chips, strip._places(), strict=True):
                drawn = QRect(int(place.x()), int(place.y()) + 4, int(strip._chip_width(chip)), 14)
                assert not drawn.intersects(notice.geometry())
        assert before in {None, strip.minimumHeight()}
        before = strip.minimumHeight()


def test_the_joints_button_keeps_its_full_name_while_the_names_go_below_their_samples(qtbot):
    legend = CurveLegend(plain)
    qtbot.addWidget(legend)
    legend.retranslate()
    legend.show()
    seen = set()
    for room in range(500, 100, -4):
        legend.fit(room)
        style = legend._references["NOMINAL"].toolButtonStyle()
        seen.add((style, legend._menu_button.text()))
    assert (Qt.ToolButtonStyle.ToolButtonTextUnderIcon, ALL_JOINTS) in seen


def test_stale_words_of_the_results_are_never_cut(qtbot, planned):
    from posopt_gui.viewmodels.results_model import totals

    strip = TotalsStrip()
    qtbot.addWidget(strip)
    found = totals(planned.result, planned.sequence, planned.answer, None, plain)
    strip.set_totals(found, waypoint="waypoint {number}")
    strip.set_stale(True, "Inputs changed. Plan to update.")
    for width in range(420, 1100, 40):
        strip.resize(width, 50)
        with qtbot.waitExposed(strip):
            strip.show()
        qtbot.wait(5)
        stale = strip._stale
        assert stale.geometry().right() <= strip.width()
        assert stale.width() >= stale.sizeHint().width()
    assert strip._theme.good not in strip._values[1].styleSheet()
