"""How plots over many waypoints are painted: once, and only what can be told apart."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QPainter, QPainterPath, QPen, QTransform

from posopt_gui.viewmodels.line_thinning import drawn_points
from solver.transforms import FloatArray

SMOOTHED = 1_000
"""A line of more points than these is drawn without smoothing."""


def follow_at_once(box: pg.ViewBox) -> None:
    """Have what is in a view follow its range before the painting that shows it.

    A ViewBox of pyqtgraph moves its items when it is painted. The items that have moved then ask
    for another painting: each step of a pan or a zoom was painted twice.
    """
    box.sigRangeChanged.connect(lambda *_: box.updateMatrix())


class InView(pg.GraphicsObject):
    """An item that draws in pixels and is asked only for what can be seen."""

    def boundingRect(self) -> QRectF:  # noqa: N802 - Qt's name
        """The visible part of the plot."""
        view = self.getViewBox()
        return view.viewRect() if view is not None else QRectF()

    def viewTransformChanged(self) -> None:  # noqa: N802 - pyqtgraph's name
        """What can be seen is another part now."""
        self.prepareGeometryChange()


def view_key(transform: QTransform, seen: QRectF) -> tuple[float, ...]:
    """What a line on the screen depends on besides its points."""
    place = (transform.m11(), transform.m22(), transform.dx(), transform.dy())
    return (*place, seen.left(), seen.right())


class CurveLine(InView):
    """A line over rising x; nan interrupts it. It is thinned to what the pixels can show."""

    def __init__(self) -> None:
        super().__init__()
        self._x: FloatArray = np.empty(0)
        self._y: FloatArray = np.empty(0)
        self._pen = QPen()
        self._path = QPainterPath()
        self._key: object = None
        self._smooth = True

    @property
    def points(self) -> tuple[FloatArray, FloatArray]:
        """Both coordinates (n,) as they were given."""
        return self._x, self._y

    def set_pen(self, pen: QPen) -> None:
        """Draw with another pen."""
        self._pen = pen
        self.update()

    def set_points(self, x: FloatArray, y: FloatArray) -> None:
        """Show other points."""
        if np.array_equal(x, self._x) and np.array_equal(y, self._y, equal_nan=True):
            return
        self._x, self._y = np.array(x, dtype=np.float64), np.array(y, dtype=np.float64)
        self._key = None
        self.update()

    def paint(self, painter: QPainter, *_: Any) -> None:
        """Draw the visible part."""
        view = self.getViewBox()
        if view is None or not len(self._x):
            return
        transform = painter.transform()
        self._follow(transform, view.viewRect())
        painter.resetTransform()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, self._smooth)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(self._pen)
        painter.drawPath(self._path)
        painter.setTransform(transform)

    def _follow(self, transform: QTransform, seen: QRectF) -> None:
        """Make the path of what is seen; most paintings are of the same line in the same view."""
        key = view_key(transform, seen)
        if key == self._key:
            return
        self._key = key
        first = max(int(np.searchsorted(self._x, seen.left())) - 2, 0)
        last = int(np.searchsorted(self._x, seen.right())) + 2
        x = transform.m11() * self._x[first:last] + transform.dx()
        y = transform.m22() * self._y[first:last] + transform.dy()
        shown = drawn_points(x, y)
        self._smooth = len(shown) <= SMOOTHED
        self._path = pg.arrayToQPath(x[shown], y[shown], connect="finite")
