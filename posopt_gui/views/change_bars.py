"""Bar chart of the cumulative change of each joint, for the plan and its references."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np
import pyqtgraph as pg
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QWidget

from posopt_gui.theme import Theme
from posopt_gui.viewmodels.curves_model import Track
from posopt_gui.views.curve_plots import LEFT_AXIS, line_colour
from solver.transforms import FloatArray
from solver.units import DEG_PER_RAD

GROUP = 0.8
"""Share of a joint's place that its bars take."""

BROKEN = 3.0
"""A bar this many times as high as the highest of the others is cut, with its value on it."""


class ChangeBars(pg.PlotWidget):
    """Groups of bars, one group a joint, in the colours of the curves."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        plot = self.getPlotItem()
        plot.hideButtons()
        plot.setMenuEnabled(False)
        plot.getViewBox().setMouseEnabled(x=False, y=False)
        plot.getAxis("left").setWidth(LEFT_AXIS)
        plot.getAxis("left").enableAutoSIPrefix(False)
        plot.getAxis("bottom").setTicks([[(j, f"J{j}") for j in range(1, 7)]])
        plot.getAxis("bottom").setStyle(tickLength=0)
        self.setMinimumHeight(110)
        self._bars: list[pg.BarGraphItem] = []
        self._labels: list[pg.TextItem] = []

    def set_theme(self, theme: Theme) -> None:
        """Set all colours."""
        self.setBackground(QColor(theme.plot))
        for name in ("left", "bottom"):
            axis = self.getPlotItem().getAxis(name)
            axis.setPen(pg.mkPen(QColor(theme.border)))
            axis.setTextPen(pg.mkPen(QColor(theme.muted)))
        self.getPlotItem().showGrid(y=True, alpha=0.15)

    def set_tracks(
        self, tracks: Iterable[Track], theme: Theme, translate: Callable[..., str]
    ) -> None:
        """Draw the cumulative change of every track."""
        shown = list(tracks)
        self.setLabel("left", translate("change, °"))
        labels: list[tuple[float, float, str]] = []
        if shown:
            values = np.array([one.motion.variation * DEG_PER_RAD for one in shown])
            top = _top(values)
            for row, one in enumerate(shown):
                x = self._bar(row, len(shown), one, np.minimum(values[row], top), theme)
                for joint, value in enumerate(values[row]):
                    # Four numbers side by side have no room: then only the plan's are named,
                    # and those that are cut.
                    if len(shown) <= 3 or row == 0 or value > top:
                        words = f"{value:.0f}↑" if value > top else f"{value:.1f}"
                        labels.append((float(x[joint]), float(min(value, top)), words))
            self.setXRange(0.5, 6.5, padding=0.0)
            self.setYRange(0.0, 1.22 * top, padding=0.0)
        for row, bar in enumerate(self._bars):
            bar.setVisible(row < len(shown))
        self._set_labels(labels, theme)

    def _bar(
        self, row: int, count: int, track: Track, height: FloatArray, theme: Theme
    ) -> FloatArray:
        """Draw one track's bars and return where they stand."""
        width = GROUP / count
        x = np.arange(1.0, 7.0) - GROUP / 2.0 + (row + 0.5) * width
        colour = QColor(line_colour(track.name, theme))
        shape = {
            "x": x, "height": height, "width": 0.9 * width, "brush": colour, "pen": pg.mkPen(None),
        }  # fmt: skip
        if row < len(self._bars):
            self._bars[row].setOpts(**shape)
        else:
            self._bars.append(pg.BarGraphItem(**shape))
            self.addItem(self._bars[-1])
        return x

    def _set_labels(self, labels: list[tuple[float, float, str]], theme: Theme) -> None:
        while len(self._labels) < len(labels):
            text = pg.TextItem(anchor=(0.5, 1.0))
            font = text.textItem.font()
            font.setPointSizeF(0.85 * font.pointSizeF())
            text.setFont(font)
            self.addItem(text)
            self._labels.append(text)
        for number, text in enumerate(self._labels):
            text.setVisible(number < len(labels))
            if number < len(labels):
                x, y, words = labels[number]
                text.setText(words, QColor(theme.text))
                text.setPos(x, y)


def _top(values: np.ndarray) -> float:
    """Height of the axis: the highest bar, or that of the others where one dwarfs them all."""
    rows = np.sort(values.max(axis=1))
    if len(rows) > 1 and rows[-1] > BROKEN * rows[-2] > 0.0:
        return float(1.3 * rows[-2])
    return float(max(rows[-1], 1e-3))
