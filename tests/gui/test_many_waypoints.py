"""Plots and the map's cells over 5,000 waypoints: painted once, and nothing high is left out."""

import numpy as np
import pyqtgraph as pg
import pytest
from PySide6.QtCore import QEvent, QObject, QRectF
from PySide6.QtGui import QColor, QImage

from posopt_gui.theme import LIGHT
from posopt_gui.viewmodels.map_columns import worst_of_columns
from posopt_gui.views.column_bars import ColumnBars
from posopt_gui.views.curve_plots import WaypointPlot
from posopt_gui.views.map_interaction import MapPlot
from posopt_gui.views.map_items import CellsItem, image_of
from posopt_gui.views.map_line_items import LinesItem, Stroke

COUNT = 5_000
RED, GREEN = (255, 0, 0, 255), (0, 255, 0, 255)


@pytest.fixture
def plot(qtbot):
    made = WaypointPlot()
    qtbot.addWidget(made)
    made.set_theme(LIGHT)
    made.resize(700, 200)
    made.set_count(COUNT)
    made.set_x_range(0.5, COUNT + 0.5)
    made.setYRange(0.0, 100.0, padding=0.0)
    with qtbot.waitExposed(made):
        made.show()
    return made


def pixels(image):
    """(h, w, 3) red, green and blue."""
    image = image.convertToFormat(QImage.Format.Format_RGB32)
    flat = np.frombuffer(image.constBits(), np.uint8)
    return flat.reshape(image.height(), image.width(), 4)[..., 2::-1].astype(int)


def painted(view):
    """The plot without its axes, painted alone."""
    box = view.getPlotItem().getViewBox()
    rect = box.sceneBoundingRect().toRect()
    return pixels(view.grab(rect).toImage())


def like(picture, colour, slack=60):
    return np.abs(picture - np.array(QColor(colour).getRgb()[:3])).max(axis=2) < slack


class Paints(QObject):
    def __init__(self, widget):
        super().__init__(widget)
        self.count = 0
        widget.installEventFilter(self)

    def eventFilter(self, _watched, event):  # noqa: N802 - Qt's name
        self.count += event.type() == QEvent.Type.Paint
        return False


@pytest.mark.parametrize("kind", [WaypointPlot, MapPlot])
def test_a_step_of_a_pan_is_painted_once(kind, qtbot, qapp):
    view = kind()
    qtbot.addWidget(view)
    view.resize(500, 200)
    with qtbot.waitExposed(view):
        view.show()
    view.getPlotItem().getViewBox().setRange(QRectF(0.0, 0.0, 100.0, 10.0), padding=0.0)
    for _ in range(20):
        qapp.processEvents()
    paints = Paints(view.viewport())
    view.setXRange(10.0, 110.0, padding=0.0)
    for _ in range(20):
        qapp.processEvents()
    assert paints.count == 1


def test_one_waypoint_of_five_thousand_that_stands_out_is_seen_on_its_curve(plot):
    values = np.full(COUNT, 80.0)
    values[3210] = 10.0
    plot.set_curves({"PLAN": values}, (), LIGHT)
    seen = like(painted(plot), LIGHT.line)
    deep = np.flatnonzero(seen[120:].any(axis=0))
    wanted = seen.shape[1] * 3210 / COUNT
    assert len(deep)
    assert np.abs(deep - wanted).max() <= 3


def test_zoomed_in_the_curve_passes_every_waypoint(plot):
    values = 50.0 + 40.0 * np.random.default_rng(1).uniform(-1.0, 1.0, COUNT)
    plot.set_curves({"PLAN": values}, (), LIGHT)
    plot.set_x_range(2000.0, 2040.0)
    seen = like(painted(plot), LIGHT.line, 90)
    box = plot.getPlotItem().getViewBox()
    for waypoint in range(2001, 2040):
        place = box.mapFromView(pg.Point(waypoint, values[waypoint - 1]))
        x, y = round(place.x()), round(place.y())
        assert seen[max(y - 2, 0) : y + 3, x - 2 : x + 3].any(), waypoint


def test_the_curve_of_another_plan_replaces_the_one_before(plot):
    plot.set_curves({"PLAN": np.full(COUNT, 20.0)}, (), LIGHT)
    painted(plot)
    plot.set_curves({"PLAN": np.full(COUNT, 80.0)}, (), LIGHT)
    seen = like(painted(plot), LIGHT.line).any(axis=1)
    rows = np.flatnonzero(seen) / len(seen)
    assert rows.max() < 0.3


def test_the_tallest_of_five_thousand_stacked_bars_is_drawn_from_end_to_end(plot):
    steps = np.full((COUNT, 2), 5.0)
    steps[4321] = (40.0, 30.0)
    plot.set_stack(steps, ("#00ff00", "#ff0000"))
    picture = painted(plot)
    column = round(picture.shape[1] * 4321 / COUNT)
    near = picture[:, column - 2 : column + 3]
    height = len(picture)
    # Its own 30 % above, and the 5 % of its neighbours.
    assert like(near, "#ff0000").any(axis=1).sum() / height == pytest.approx(0.35, abs=0.03)
    assert like(near, "#00ff00").any(axis=1).sum() / height == pytest.approx(0.4, abs=0.03)
    # No gap between neighbouring columns; the cursor stands in the first ones.
    assert like(picture[-3:-1, 3:], "#00ff00").all()


def test_few_bars_stand_apart_as_wide_as_they_were_asked():
    bars = ColumnBars(0.5, stacked=True)
    x = np.arange(1.0, 11.0)
    edges = np.column_stack([np.zeros(10), x])
    bars.set_bars(x, edges, [QColor("red")])
    middles, shown, width = bars.shown(0.5, 10.5, 30.0)
    assert middles.tolist() == x.tolist()
    assert np.array_equal(shown, edges)
    assert width == 0.5


def test_ranges_of_the_feed_cover_all_moves_of_a_column():
    bars = ColumnBars(0.92, stacked=False)
    low = np.random.default_rng(2).uniform(10.0, 20.0, COUNT)
    x = np.arange(COUNT) + 0.5
    bars.set_bars(x, np.column_stack([low, low + 1.0]), [QColor("red")])
    middles, shown, width = bars.shown(0.0, COUNT, 0.14)
    assert width * 0.14 >= 1.0
    for middle, (least, greatest) in zip(middles, shown, strict=True):
        own = np.abs(x - middle) < width / 2.0
        assert least == low[own].min()
        assert greatest == low[own].max() + 1.0


class _Seen(pg.PlotWidget):
    """A plot of cells alone, without axes."""

    def __init__(self):
        super().__init__(enableMenu=False)
        for name in ("left", "bottom"):
            self.getPlotItem().hideAxis(name)
        self.hideButtons()


@pytest.fixture
def cells(qtbot):
    def show(indices, table):
        view = _Seen()
        qtbot.addWidget(view)
        view.resize(700, 200)
        item = CellsItem()
        view.addItem(item, ignoreBounds=True)
        rect = QRectF(0.5, 0.0, float(indices.shape[0]), float(indices.shape[1]))
        item.set_cells(
            image_of(indices, table), rect, QColor(0, 0, 0, 0),
            lambda each: image_of(worst_of_columns(indices, each, outcome=False), table),
        )  # fmt: skip
        view.getViewBox().setRange(rect, padding=0.0)
        with qtbot.waitExposed(view):
            view.show()
        return view

    return show


def table():
    made = np.zeros((256, 4), dtype=np.uint8)
    made[0], made[9] = RED, GREEN
    return made


@pytest.mark.parametrize("bad", [0, 1717, 4999])
def test_a_single_waypoint_that_is_cut_off_is_seen_on_the_whole_map(cells, bad):
    indices = np.full((COUNT, 10), 9, dtype=np.uint8)
    indices[bad] = 0
    picture = painted(cells(indices, table()))
    red = np.flatnonzero(like(picture, "#ff0000").any(axis=0))
    assert len(red)
    assert np.abs(red - picture.shape[1] * (bad + 0.5) / COUNT).max() <= 2.5
    assert like(picture[2:-2], "#00ff00").all(axis=0).sum() > 0.97 * picture.shape[1]


def test_zoomed_in_each_cell_of_the_map_has_its_own_colour(cells):
    indices = np.where(np.random.default_rng(4).random((COUNT, 5)) < 0.5, 0, 9).astype(np.uint8)
    view = cells(indices, table())
    view.setXRange(3000.5, 3020.5, padding=0.0)
    picture = painted(view)
    height, width = picture.shape[:2]
    for waypoint in range(20):
        for row in range(5):
            x = int(width * (waypoint + 0.5) / 20)
            y = int(height * (1.0 - (row + 0.5) / 5))
            wanted = "#ff0000" if indices[3000 + waypoint, row] == 0 else "#00ff00"
            assert like(picture[y : y + 1, x : x + 1], wanted).all()


def test_a_line_that_leaves_its_lean_at_one_waypoint_is_seen_on_the_whole_map(qtbot):
    view = _Seen()
    qtbot.addWidget(view)
    view.resize(700, 200)
    item = LinesItem()
    view.addItem(item, ignoreBounds=True)
    lean = np.full(COUNT, -10.0)
    lean[2345] = 20.0
    shown = np.ones(COUNT, dtype=np.bool_)
    shown[4000:] = False
    pen = pg.mkPen("#0000ff", width=2.0)
    stroke = Stroke(np.arange(1.0, COUNT + 1.0), lean, shown, pen)
    item.set_strokes([stroke], QColor(0, 0, 0, 0), QColor("red"))
    view.setBackground("w")
    view.getViewBox().setRange(QRectF(0.5, -25.0, COUNT, 50.0), padding=0.0)
    with qtbot.waitExposed(view):
        view.show()
    picture = painted(view)
    height, width = picture.shape[:2]
    blue = like(picture, "#0000ff", 150)
    top = np.flatnonzero(blue[: height // 3].any(axis=0))
    assert len(top)
    assert np.abs(top - width * 2345 / COUNT).max() <= 3
    # Beyond the shown part it is faint.
    assert not like(picture, "#0000ff", 40)[:, int(0.82 * width) :].any()
