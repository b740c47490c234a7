"""A plot over the waypoints: theme, pass borders, the shared cursor, lines and bars by name."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QPointF, QSignalBlocker, Qt, Signal
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QWidget

from posopt_gui.theme import Theme
from posopt_gui.viewmodels.curves_model import (
    PLAN,
    axis_place,
    axis_ticks,
    broken,
    free_side,
    joint_range,
    waypoint_axis,
)
from posopt_gui.views.column_bars import ColumnBars
from posopt_gui.views.plot_painting import CurveLine, follow_at_once
from solver.transforms import FloatArray

LEFT_AXIS = 56
"""Width of the left axis [px]: the same everywhere, so that waypoints stand in one column."""

GAUGE = 12
"""Width right of the plots [px] that the gauges of the joints take."""

HEADROOM = 19
"""Height of the words in a plot's upper left corner [px]."""

LOW_ROW = 48
"""A lower row keeps no room for its words [px]."""

BOTTOM_AXIS = 20
"""Height of the numbers below the last row [px]."""

TICK_ROOM = 18
"""Height that a number at an axis takes [px]."""

LIMIT_COLOUR = "#E69F00"
"""Beyond a joint limit, as on the map."""

FAR = 1e5
"""Beyond every axis."""

DASHES = {
    PLAN: Qt.PenStyle.SolidLine,
    "NOMINAL": Qt.PenStyle.DashLine,
    "CONSTANT": Qt.PenStyle.DashDotLine,
    "RANDOM": Qt.PenStyle.DotLine,
}

JOINT_COLOURS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00")
"""J1 to J6 where they share a plot (Okabe and Ito)."""


class PlotStock:
    """Plots that are made before they are needed, one in each turn of the event loop."""

    def __init__(self, theme: Theme) -> None:
        self._theme = theme
        self._made: dict[bool, list[WaypointPlot]] = {True: [], False: []}

    def make(self, *, gauged: bool) -> None:
        """Make one more."""
        plot = WaypointPlot(gauged=gauged)
        plot.set_theme(self._theme)
        self._made[gauged].append(plot)

    def take(self, *, gauged: bool) -> WaypointPlot:
        """One that was made, or a new one."""
        return self._made[gauged].pop() if self._made[gauged] else WaypointPlot(gauged=gauged)


def line_colour(name: str, theme: Theme) -> str:
    """Colour of a curve by its name."""
    light, dark = {
        "NOMINAL": ("#00795A", "#2FC79B"),
        "CONSTANT": ("#A8540A", "#F0A35E"),
        "RANDOM": ("#A0527F", "#E0A3C8"),
    }.get(name, (theme.line, theme.line))
    return dark if theme.dark else light


def line_pen(name: str, theme: Theme) -> pg.QtGui.QPen:
    """Pen of a curve: the plan is full and 2 px, each reference has a dash of its own."""
    width = 2.0 if name == PLAN else 1.4
    return pg.mkPen(QColor(line_colour(name, theme)), width=width, style=DASHES[name])


class WaypointPlot(pg.PlotWidget):
    """A plot with the waypoint as x; emits where the cursor is dragged or clicked to."""

    place_wanted = Signal(float)
    x_range_changed = Signal(float, float)

    def __init__(self, parent: QWidget | None = None, *, gauged: bool = False) -> None:
        # Without the menus: making them takes a quarter of the plot's own time.
        super().__init__(parent, enableMenu=False)
        plot = self.getPlotItem()
        plot.hideButtons()
        plot.getViewBox().setMouseEnabled(x=True, y=False)
        plot.getAxis("left").setWidth(LEFT_AXIS)
        plot.getAxis("left").setStyle(maxTickLevel=0)
        for name in ("left", "bottom"):
            plot.getAxis(name).enableAutoSIPrefix(False)
        plot.setContentsMargins(0.0, 0.0, 0.0 if gauged else float(GAUGE), 0.0)
        self.setMinimumHeight(16 if gauged else 110)
        self._theme: Theme | None = None
        self._curves: dict[str, CurveLine] = {}
        self._bars: ColumnBars | None = None
        self._borders: list[pg.InfiniteLine] = []
        self._bands: list[pg.LinearRegionItem] = []
        self._count = -1
        self._starts: tuple[int, ...] = ()
        self._limits: tuple[tuple[float, float], str] | None = None
        self._shown_level: tuple[float | None, str, str] = (None, "", "")
        self._level: pg.InfiniteLine | None = None
        self._cursor = pg.InfiniteLine(1.0, angle=90, movable=True)
        self._cursor.setZValue(50)
        self._readout = pg.TextItem(anchor=(0, 0))
        self._readout.setParentItem(plot.getViewBox())
        self._readout.setZValue(60)
        self._readout.setPos(QPointF(3, 0))
        self._level_words = pg.TextItem("", anchor=(1, 0))
        self._level_words.hide()
        self._level_words.setParentItem(plot.getViewBox())
        self._level_words.setZValue(60)
        plot.getViewBox().sigResized.connect(self._put_level_words)
        self._highest: float | None = None
        plot.getViewBox().sigResized.connect(self._keep_headroom)
        plot.addItem(self._cursor, ignoreBounds=True)
        self._cursor.sigDragged.connect(lambda line: self.place_wanted.emit(line.value()))
        # Let go between two waypoints it goes to the nearer one, which all numbers are about.
        self._cursor.sigPositionChangeFinished.connect(
            lambda line: self.place_wanted.emit(round(line.value()))
        )
        self.scene().sigMouseClicked.connect(self._on_click)
        box = plot.getViewBox()
        follow_at_once(box)
        box.disableAutoRange()
        # Only what a person does is told; else views that are linked would answer one another.
        box.sigRangeChangedManually.connect(
            lambda _: self.x_range_changed.emit(*box.viewRange()[0])
        )

    def _on_click(self, event: object) -> None:
        box = self.getPlotItem().getViewBox()
        if event.button() != Qt.MouseButton.LeftButton:  # type: ignore[attr-defined]
            return
        position = event.scenePos()  # type: ignore[attr-defined]
        if box.sceneBoundingRect().contains(position):
            self.place_wanted.emit(round(box.mapSceneToView(position).x()))

    def set_x_range(self, low: float, high: float) -> None:
        """Show these waypoints, without telling anybody."""
        self.setXRange(low, high, padding=0.0)

    def set_theme(self, theme: Theme) -> None:
        """Set all colours."""
        if theme is self._theme:
            return
        self._theme = theme
        self.setBackground(QColor(theme.plot))
        for name in ("left", "bottom"):
            axis = self.getPlotItem().getAxis(name)
            axis.setPen(pg.mkPen(QColor(theme.border)))
            axis.setTextPen(pg.mkPen(QColor(theme.muted)))
        self.getPlotItem().showGrid(x=True, y=True, alpha=0.12 if theme.dark else 0.18)
        self._cursor.setPen(pg.mkPen(QColor(theme.accent), width=1.4))
        self._cursor.setHoverPen(pg.mkPen(QColor(theme.accent), width=3.0))
        fill = QColor(theme.plot)
        fill.setAlpha(215)
        self._readout.fill = self._level_words.fill = pg.mkBrush(fill)
        self._readout.setColor(QColor(theme.text))
        for line in self._borders:
            line.setPen(pg.mkPen(QColor(theme.border), width=1.0))
        for name, curve in self._curves.items():
            curve.set_pen(line_pen(name, theme))

    def set_place(self, place: float) -> None:
        """Move the cursor line, without telling anybody."""
        with QSignalBlocker(self._cursor):
            self._cursor.setValue(axis_place(place))

    def set_count(self, count: int) -> None:
        """Keep the cursor and the view within this many waypoints."""
        if count == self._count:
            return
        self._count = count
        self._cursor.setBounds((1.0, max(count, 1.0)))
        self.getPlotItem().getViewBox().setLimits(
            xMin=0.5 - 0.02 * count, xMax=count + 0.5 + 0.02 * count, minXRange=2.0
        )

    def fit_from_zero(self, curves: Iterable[FloatArray], level: float | None) -> None:
        """Choose the axis from zero to beyond all curves and a level."""
        highs = [float(np.max(one[np.isfinite(one)], initial=0.0)) for one in curves]
        self._highest = max([level or 0.0, *highs, 1e-6])
        self._keep_headroom()

    def _keep_headroom(self, *_: object) -> None:
        """Leave the words in the upper corners a strip that no curve runs through."""
        if self._highest is not None:
            share = 1.0 - self.headroom
            self.setYRange(0.0, self._highest * max(1.15, 1.03 / share), padding=0.0)

    def set_ticks(self, values: Iterable[float]) -> None:
        """Name these values at the left axis, and no others."""
        ticks = [(value, f"{value:g}".replace("-", "−")) for value in values]
        self.getPlotItem().getAxis("left").setTicks([ticks])

    @property
    def shown_curves(self) -> set[str]:
        """Names of the curves that are drawn."""
        return {name for name, curve in self._curves.items() if curve.isVisible()}

    @property
    def headroom(self) -> float:
        """Share of the height that the words take."""
        return float(min(HEADROOM / max(self.getPlotItem().getViewBox().height(), 1.0), 0.6))

    def set_readout(self, html: str) -> None:
        """Show words in the left corner."""
        self._readout.setHtml(html)

    def put_readout(self, side: str) -> None:
        """Put the words to the 'top' or the 'bottom'."""
        low = side == "bottom"
        height = self.getPlotItem().getViewBox().height()
        self._readout.setAnchor((0, 1) if low else (0, 0))
        self._readout.setPos(QPointF(3, height if low else 0))

    def set_borders(self, starts: Iterable[int], theme: Theme) -> None:
        """Draw a border before the first waypoint (from 0) of each pass."""
        places = tuple(starts)
        if places == self._starts:
            return
        self._starts = places
        for line in self._borders:
            self.removeItem(line)
        self._borders = []
        for start in places:
            line = pg.InfiniteLine(start + 0.5, angle=90, pen=pg.mkPen(QColor(theme.border)))
            line.setZValue(-5)
            self.addItem(line, ignoreBounds=True)
            self._borders.append(line)

    def set_curves(
        self, curves: dict[str, FloatArray], starts: Iterable[int], theme: Theme
    ) -> None:
        """Draw one line over the waypoints for each name, interrupted between passes."""
        places = list(starts)
        # A reference is gone while the next plan is compared: to make its curve anew would take
        # longer than all else.
        for name, curve in self._curves.items():
            curve.setVisible(name in curves)
        for name, values in curves.items():
            if name not in self._curves:
                curve = self._curves[name] = CurveLine()
                curve.setZValue(20 if name == PLAN else 10)
                curve.set_pen(line_pen(name, theme))
                self.addItem(curve, ignoreBounds=True)
            self._curves[name].set_points(*broken(values, places))

    def set_stack(self, values: FloatArray, colours: Iterable[str]) -> None:
        """Draw (n, k) values as stacked bars at the waypoints."""
        height = np.nan_to_num(values)
        if self._bars is None:
            self._bars = ColumnBars(0.72, stacked=True)
            self.addItem(self._bars, ignoreBounds=True)
        edges = np.column_stack([np.zeros(len(height)), np.cumsum(height, axis=1)])
        self._bars.set_bars(waypoint_axis(len(values)), edges, [QColor(one) for one in colours])

    def set_bands(self, limits: tuple[float, float], colour: str) -> None:
        """Hatch what lies beyond two limits, and draw the limits themselves."""
        if self._limits == (limits, colour):
            return
        self._limits = (limits, colour)
        for band in self._bands:
            self.removeItem(band)
        self._bands = []
        low, high = limits
        for values in ((-FAR, low), (high, FAR)):
            shade = QColor(colour)
            shade.setAlpha(70)
            band = pg.LinearRegionItem(
                values, "horizontal", pg.mkBrush(shade), movable=False,
                pen=pg.mkPen(QColor(colour), width=1.2),
            )  # fmt: skip
            band.setZValue(-10)
            self.addItem(band, ignoreBounds=True)
            self._bands.append(band)

    def set_level(self, value: float | None, colour: str, label: str = "") -> None:
        """Draw a level with its name: the safety distance, the least manipulability."""
        wanted = (value, colour, label)
        if wanted == self._shown_level:
            return
        self._shown_level = wanted
        if self._level is not None:
            self.removeItem(self._level)
            self._level = None
            self._level_words.setText("")
            self._level_words.hide()
        if value is None or not np.isfinite(value):
            return
        pen = pg.mkPen(QColor(colour), width=1.4, style=Qt.PenStyle.DashLine)
        self._level = pg.InfiniteLine(value, angle=0, pen=pen)
        self.addItem(self._level, ignoreBounds=True)
        self._level_words.setText(f"– – {label}", QColor(colour))
        self._level_words.show()
        self._put_level_words()

    def set_beyond(self, words: str, colour: str) -> None:
        """Name in the right corner what reaches beyond the axis, in plots without a level."""
        self._level_words.setText(words, QColor(colour))
        # Without words its ground would still hide the end of the curves.
        self._level_words.setVisible(bool(words))
        self._put_level_words()

    def _put_level_words(self, *_: object) -> None:
        self._level_words.setPos(QPointF(self.getPlotItem().getViewBox().width() - 3.0, 0.0))


def fit_joint(
    plot: WaypointPlot, curves: list[FloatArray], limits: FloatArray, *, whole: bool
) -> None:
    """Choose a joint's axis so that the words and the curves do not meet."""
    # In a low row the words hide the beginning of a curve rather than take half of the row.
    headroom = 0.0 if plot.height() < LOW_ROW else plot.headroom
    low, high = joint_range(curves, limits, whole=whole)
    side = free_side(curves, low, high, height=plot.headroom)
    top = high
    if not side:
        low, high = joint_range(curves, limits, whole=whole, headroom=headroom)
        top = high - headroom * (high - low)
    plot.put_readout(side or "top")
    plot.setYRange(low, high, padding=0.0)
    room = plot.getPlotItem().getViewBox().height() * (top - low) / (high - low)
    plot.set_ticks(axis_ticks(low, top, max(int(room / TICK_ROOM), 1)))


def step_words(steps: FloatArray) -> str:
    """How far each joint moves, with the colour of its bar."""
    if not np.isfinite(steps).all():
        return "–"
    parts = (
        f'<span style="color:{colour}">■</span> J{joint} {value:.2f}°'
        for joint, (value, colour) in enumerate(zip(steps, JOINT_COLOURS, strict=True), start=1)
    )
    return " ".join(parts)
