"""Bars at the waypoints, of which no high one is lost where there are more than pixels."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from pyqtgraph.Qt.internals import PrimitiveArray
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen, QTransform

from posopt_gui.viewmodels.line_thinning import grouped_ranges, tallest_of_groups
from posopt_gui.views.plot_painting import InView, view_key
from solver.transforms import FloatArray

LEAST_WIDTH = 1.0
"""Width from which on every bar is drawn [px]; below, bars of one column are drawn as one."""


class ColumnBars(InView):
    """Bars of one or more parts that stand on each other; it draws in pixels.

    Where bars are narrower than a pixel, those of a column are drawn as one: of stacked bars the
    tallest, of single ones all that they cover together.
    """

    def __init__(self, width: float, *, stacked: bool) -> None:
        super().__init__()
        self._width, self._stacked = width, stacked
        self._x: FloatArray = np.empty(0)
        self._edges: FloatArray = np.empty((0, 2))
        self._colours: tuple[QColor, ...] = ()
        self._outline = 0.0
        self._rects: list[Any] = []
        self._key: object = None

    @property
    def edges(self) -> FloatArray:
        """Lower edge, and upper edge of every part, (n, k + 1) as they were given."""
        return self._edges

    def set_bars(
        self, x: FloatArray, edges: FloatArray, colours: Sequence[QColor], outline: float = 0.0
    ) -> None:
        """Show bars in the middle of x (n,), rising; `edges` (n, k + 1) rise along each row."""
        self._x, self._edges, self._colours = x, edges, tuple(colours)
        self._outline = outline
        self._key = None
        self.update()

    def paint(self, painter: QPainter, *_: Any) -> None:
        """Draw the visible bars."""
        view = self.getViewBox()
        if view is None or not len(self._x):
            return
        transform, seen = painter.transform(), view.viewRect()
        key = view_key(transform, seen)
        if key != self._key:
            self._key = key
            self._rects = self._parts(transform, seen)
        painter.resetTransform()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
        for rects, colour in zip(self._rects, self._colours, strict=False):
            painter.setBrush(colour)
            painter.setPen(
                QPen(colour, self._outline) if self._outline else QPen(Qt.PenStyle.NoPen)
            )
            painter.drawRects(*rects.drawargs())
        painter.setTransform(transform)

    def shown(self, low: float, high: float, pixel: float) -> tuple[FloatArray, FloatArray, float]:
        """Middles, edges and width of what is drawn of low..high, a waypoint `pixel` wide [px]."""
        first = max(int(np.searchsorted(self._x, low)) - 1, 0)
        part = slice(first, int(np.searchsorted(self._x, high)) + 1)
        x, edges = self._x[part], self._edges[part]
        if pixel * self._width >= LEAST_WIDTH or not len(x):
            return x, edges, self._width
        each = math.ceil(LEAST_WIDTH / pixel)
        if self._stacked:
            kept, groups = tallest_of_groups(x, edges[:, -1], each)
            edges = edges[kept]
        else:
            groups, least, greatest = grouped_ranges(x, edges[:, 0], edges[:, -1], each)
            edges = np.column_stack([least, greatest])
        middles: FloatArray = each * (groups.astype(np.float64) + 0.5)
        return middles, edges, float(each)

    def _parts(self, transform: QTransform, seen: QRectF) -> list[Any]:
        """The rectangles of every part in pixels."""
        x, edges, width = self.shown(seen.left(), seen.right(), abs(transform.m11()))
        left = transform.m11() * (x - width / 2.0) + transform.dx()
        heights = transform.m22() * edges + transform.dy()
        made = []
        for part in range(edges.shape[1] - 1):
            rects = PrimitiveArray(QRectF, 4)
            rects.resize(len(x))
            memory = rects.ndarray()
            memory[:, 0], memory[:, 1] = left, heights[:, part + 1]
            memory[:, 2] = transform.m11() * width
            memory[:, 3] = heights[:, part] - heights[:, part + 1]
            made.append(rects)
        return made
