"""Lines over the waypoints, and their names at their ends."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pyqtgraph as pg
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPen, QPolygonF

from posopt_gui.viewmodels.map_lines import spread
from posopt_gui.views.map_items import qcolour
from solver.transforms import FloatArray

FAINT = 95
"""Opacity of a line where it runs on another page than the shown one."""


@dataclass(frozen=True, slots=True, eq=False)
class Stroke:
    """A line over the waypoints: full where `shown` (n,), faint elsewhere."""

    waypoint: FloatArray
    lean: FloatArray
    shown: NDArray[np.bool_]
    pen: QPen


class _InView(pg.GraphicsObject):
    """An item that draws in pixels and is asked only for what can be seen."""

    def boundingRect(self) -> QRectF:  # noqa: N802 - Qt's name
        """The visible part of the plot."""
        view = self.getViewBox()
        return view.viewRect() if view is not None else QRectF()

    def viewTransformChanged(self) -> None:  # noqa: N802 - pyqtgraph's name
        """What can be seen is another part now."""
        self.prepareGeometryChange()


class LinesItem(_InView):
    """Lines with a casing, so that they stand out from any colour below."""

    def __init__(self) -> None:
        super().__init__()
        self._strokes: tuple[Stroke, ...] = ()
        self._casing = QColor()

    def set_strokes(self, strokes: Sequence[Stroke], casing: QColor) -> None:
        """Show other lines, the last one on top."""
        self._strokes, self._casing = tuple(strokes), casing
        self.update()

    def paint(self, painter: QPainter, *_: Any) -> None:
        """Draw the visible parts."""
        view = self.getViewBox()
        if view is None or not self._strokes:
            return
        seen, transform = view.viewRect(), painter.transform()
        painter.resetTransform()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        width = transform.mapRect(seen).width()
        for stroke in self._strokes:
            first = max(int(seen.left() - stroke.waypoint[0]) - 1, 0)
            last = min(int(seen.right() - stroke.waypoint[0]) + 3, len(stroke.waypoint))
            # Two points a pixel are all that can be told apart.
            step = max(1, int((last - first) / max(2.0 * width, 1.0)))
            part = slice(first, last, step)
            x = transform.m11() * stroke.waypoint[part] + transform.dx()
            y = transform.m22() * stroke.lean[part] + transform.dy()
            self._draw(painter, stroke, x, y, stroke.shown[part])
        painter.setTransform(transform)

    def _draw(
        self,
        painter: QPainter,
        stroke: Stroke,
        x: FloatArray,
        y: FloatArray,
        shown: NDArray[np.bool_],
    ) -> None:
        points = [QPointF(a, b) for a, b in zip(x.tolist(), y.tolist(), strict=True)]
        if not shown.all():
            pen = QPen(stroke.pen)
            pen.setColor(qcolour(pen.color().name(), FAINT))
            painter.setPen(pen)
            painter.drawPolyline(QPolygonF(points))
        edges = np.flatnonzero(np.diff(np.concatenate([[0], shown.astype(np.int8), [0]])))
        for begin, end in edges.reshape(-1, 2):
            run = QPolygonF(points[begin:end])
            for pen in (QPen(self._casing, stroke.pen.widthF() + 2.5), stroke.pen):
                painter.setPen(pen)
                painter.drawPolyline(run)


@dataclass(frozen=True, slots=True, eq=False)
class LineName:
    """What a line is called, where it ends, and the pen it is drawn with."""

    text: str
    waypoint: FloatArray
    lean: FloatArray
    pen: QPen


class LineNamesItem(_InView):
    """Names of the lines at their visible ends, with a piece of the line before each."""

    SAMPLE = 22.0
    HEIGHT = 16.0

    def __init__(self) -> None:
        super().__init__()
        self._names: tuple[LineName, ...] = ()
        self._ground = QColor()
        self._text = QColor()

    def set_names(self, names: Sequence[LineName], ground: QColor, text: QColor) -> None:
        """Show other names."""
        self._names, self._ground, self._text = tuple(names), ground, text
        self.update()

    def paint(self, painter: QPainter, *_: Any) -> None:
        """Draw the names, parted from each other."""
        view = self.getViewBox()
        if view is None or not self._names:
            return
        seen = view.viewRect()
        transform = painter.transform()
        frame = transform.mapRect(seen)
        painter.resetTransform()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)
        font = QFont(painter.font())
        font.setPixelSize(11)
        painter.setFont(font)
        metrics = QFontMetricsF(font)
        boxes = [metrics.horizontalAdvance(one.text) + self.SAMPLE + 14.0 for one in self._names]
        ends, wanted = [], []
        for name, width in zip(self._names, boxes, strict=True):
            end = _end_in_view(name, seen.left(), seen.right())
            place = transform.map(QPointF(*end))
            back = end[0] - width / abs(transform.m11())
            before = float(np.interp(back, name.waypoint, name.lean))
            # On the side of the line that it does not come from.
            side = 0.85 if before > end[1] else -0.85
            ends.append(place.x())
            wanted.append(place.y() + side * self.HEIGHT)
        low, high = frame.top() + self.HEIGHT, frame.bottom() - self.HEIGHT
        places = spread(np.array(wanted), self.HEIGHT + 2.0, low, high)
        for name, width, end_x, y in zip(self._names, boxes, ends, places, strict=True):
            right = min(end_x, frame.right()) - 6.0
            box = QRectF(right - width, float(y) - self.HEIGHT / 2.0, width, self.HEIGHT)
            self._draw_name(painter, name, box)
        painter.setTransform(transform)

    def _draw_name(self, painter: QPainter, name: LineName, box: QRectF) -> None:
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(self._ground)
        painter.drawRoundedRect(box, 3.0, 3.0)
        painter.setPen(name.pen)
        middle = box.center().y()
        painter.drawLine(
            QPointF(box.left() + 5.0, middle), QPointF(box.left() + 5.0 + self.SAMPLE, middle)
        )
        painter.setPen(self._text)
        words = box.adjusted(self.SAMPLE + 9.0, 0.0, 0.0, 0.0)
        painter.drawText(words, Qt.AlignmentFlag.AlignVCenter, name.text)


def _end_in_view(name: LineName, left: float, right: float) -> tuple[float, float]:
    x = float(np.clip(right, name.waypoint[0], name.waypoint[-1]))
    x = max(x, left) if x < left else x
    return x, float(np.interp(x, name.waypoint, name.lean))
