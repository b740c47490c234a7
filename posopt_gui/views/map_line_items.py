"""Lines over the waypoints, and their names at their ends."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pyqtgraph as pg
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPainterPath, QPen, QTransform

from posopt_gui.viewmodels.label_places import label_places
from posopt_gui.viewmodels.line_thinning import drawn_points
from posopt_gui.views.map_items import qcolour
from posopt_gui.views.plot_painting import SMOOTHED, InView, view_key
from solver.transforms import FloatArray

FAINT = 95
"""Opacity of a line where it runs on another page than the shown one."""


BREAK_SIZE = 6.5
"""Radius of the mark where the branch changes within a pass [px]."""

NO_BREAKS: FloatArray = np.empty(0)


@dataclass(frozen=True, slots=True, eq=False)
class Stroke:
    """A line over the waypoints: full where `shown` (n,), faint elsewhere.

    `shift` moves it down [px], off a line that it would cover; `breaks` (k,) are the places, in
    waypoints, where the arm changes its branch though it may not.
    """

    waypoint: FloatArray
    lean: FloatArray
    shown: NDArray[np.bool_]
    pen: QPen
    shift: float = 0.0
    breaks: FloatArray = field(default_factory=lambda: NO_BREAKS)


class LinesItem(InView):
    """Lines with a casing, so that they stand out from any colour below."""

    def __init__(self) -> None:
        super().__init__()
        self._strokes: tuple[Stroke, ...] = ()
        self._drawn: tuple[object, list[_Drawn]] = (None, [])
        self._casing, self._warning = QColor(), QColor()

    def set_strokes(self, strokes: Sequence[Stroke], casing: QColor, warning: QColor) -> None:
        """Show other lines, the last one on top; `warning` marks their breaks."""
        self._strokes, self._casing, self._warning = tuple(strokes), casing, warning
        self._drawn = (None, [])
        self.update()

    def paint(self, painter: QPainter, *_: Any) -> None:
        """Draw the visible parts."""
        view = self.getViewBox()
        if view is None or not self._strokes:
            return
        seen, transform = view.viewRect(), painter.transform()
        painter.resetTransform()
        painter.setBrush(Qt.BrushStyle.NoBrush)
        key = view_key(transform, seen)
        if key != self._drawn[0]:
            self._drawn = key, [_drawn(one, transform, seen) for one in self._strokes]
        for stroke, drawn in zip(self._strokes, self._drawn[1], strict=True):
            painter.setRenderHint(QPainter.RenderHint.Antialiasing, drawn.smooth)
            self._draw(painter, stroke, drawn)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)
        for stroke in self._strokes:
            for place in stroke.breaks:
                lean = float(np.interp(place, stroke.waypoint, stroke.lean))
                point = transform.map(QPointF(float(place), lean))
                self._draw_break(painter, point + QPointF(0.0, stroke.shift))
        painter.setTransform(transform)

    def _draw(self, painter: QPainter, stroke: Stroke, drawn: _Drawn) -> None:
        if drawn.faint is not None:
            pen = QPen(stroke.pen)
            pen.setColor(qcolour(pen.color().name(), FAINT))
            painter.setPen(pen)
            painter.drawPath(drawn.faint)
        for pen in (QPen(self._casing, stroke.pen.widthF() + 2.5), stroke.pen):
            painter.setPen(pen)
            painter.drawPath(drawn.full)

    def _draw_break(self, painter: QPainter, place: QPointF) -> None:
        """A disc with '!': the arm cannot do this while it grinds."""
        painter.setPen(QPen(self._casing, 1.5))
        painter.setBrush(self._warning)
        painter.drawEllipse(place, BREAK_SIZE, BREAK_SIZE)
        font = QFont(painter.font())
        font.setPixelSize(11)
        font.setBold(True)
        painter.setFont(font)
        painter.setPen(QPen(QColor(self._casing.name())))
        box = QRectF(place.x() - 8.0, place.y() - 8.0, 16.0, 16.0)
        painter.drawText(box, Qt.AlignmentFlag.AlignCenter, "!")
        painter.setBrush(Qt.BrushStyle.NoBrush)


@dataclass(frozen=True, slots=True, eq=False)
class _Drawn:
    """A line in pixels: where it is full, and all of it where it is faint somewhere."""

    full: QPainterPath
    faint: QPainterPath | None
    smooth: bool


def _drawn(stroke: Stroke, transform: QTransform, seen: QRectF) -> _Drawn:
    """The visible part of a line, of the points that can be told apart."""
    first = max(int(seen.left() - stroke.waypoint[0]) - 1, 0)
    last = min(int(seen.right() - stroke.waypoint[0]) + 3, len(stroke.waypoint))
    part = slice(first, max(last, first))
    shown = stroke.shown[part]
    x = transform.m11() * stroke.waypoint[part] + transform.dx()
    y = transform.m22() * stroke.lean[part] + transform.dy() + stroke.shift
    kept = drawn_points(x, y, np.flatnonzero(shown[1:] != shown[:-1]) + 1)
    x, y, shown = x[kept], y[kept], shown[kept]
    joined = np.zeros(len(kept), dtype=np.int32)
    joined[:-1] = shown[:-1] & shown[1:]
    full = pg.arrayToQPath(x, y, connect=joined)
    faint = None if shown.all() else pg.arrayToQPath(x, y)
    return _Drawn(full, faint, len(kept) <= SMOOTHED)


@dataclass(frozen=True, slots=True, eq=False)
class LineName:
    """What a line is called, where it ends, and the pen it is drawn with."""

    text: str
    waypoint: FloatArray
    lean: FloatArray
    pen: QPen


class LineNamesItem(InView):
    """Names of the lines at their visible ends, with a piece of the line before each."""

    SAMPLE = 22.0
    HEIGHT = 16.0

    def __init__(self) -> None:
        super().__init__()
        self._names: tuple[LineName, ...] = ()
        self._ground = QColor()
        self._text = QColor()
        self._placed: tuple[object, list[tuple[float, float]]] = (None, [])

    def set_names(self, names: Sequence[LineName], ground: QColor, text: QColor) -> None:
        """Show other names."""
        self._names, self._ground, self._text = tuple(names), ground, text
        self._placed = (None, [])
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
        widths = [metrics.horizontalAdvance(one.text) + self.SAMPLE + 14.0 for one in self._names]
        for name, width, place in zip(
            self._names, widths, self._places(transform, frame, widths), strict=True
        ):
            self._draw_name(painter, name, QRectF(*place, width, self.HEIGHT))
        painter.setTransform(transform)

    def _places(
        self, transform: QTransform, frame: QRectF, widths: list[float]
    ) -> list[tuple[float, float]]:
        """Where the names stand; most paintings are of the same lines in the same view."""
        scale, shift = (transform.m11(), transform.m22()), (transform.dx(), transform.dy())
        room = (frame.left(), frame.top(), frame.right(), frame.bottom())
        key = (scale, shift, room, *widths)
        if key != self._placed[0]:
            curves = [
                (scale[0] * one.waypoint + shift[0], scale[1] * one.lean + shift[1])
                for one in self._names
            ]
            self._placed = key, label_places(curves, widths, self.HEIGHT, room)
        return self._placed[1]

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
