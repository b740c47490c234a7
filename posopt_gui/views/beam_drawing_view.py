"""The dimensioned drawing of the chosen section."""

from __future__ import annotations

import math

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from posopt_gui.theme import Theme
from posopt_gui.viewmodels.beam_drawing import OUTSIDE, Dimension, Drawing, beam_drawing
from solver.model.workpiece import BeamSection

HEIGHT = 190
ARROW = 7.0
ARROW_ANGLE = math.radians(14.0)


class BeamDrawingView(QWidget):
    """Draws a section with H, B, tw, tf and r."""

    def __init__(self, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._theme = theme
        self._section: BeamSection | None = None
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setFixedHeight(HEIGHT)

    @property
    def section(self) -> BeamSection | None:
        """The section that is drawn."""
        return self._section

    def set_theme(self, theme: Theme) -> None:
        """Draw in other colours."""
        self._theme = theme
        self.update()

    def show_section(self, section: BeamSection | None, description: str) -> None:
        """Draw a section; None where the cell states none that is possible."""
        self._section = section
        self.setAccessibleName(description)
        self.update()

    def sizeHint(self) -> QSize:  # noqa: N802 - Qt's name
        """Return the size that the panel gives it."""
        return QSize(260, HEIGHT)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 - Qt's name
        """Draw outline, centre lines and dimensions, or the words where there is no section."""
        painter = QPainter(self)
        if self._section is None:
            painter.setPen(QColor(self._theme.muted))
            painter.drawText(self.rect(), Qt.AlignmentFlag.AlignCenter, self.accessibleName())
            painter.end()
            return
        drawing = beam_drawing(self._section, self.width(), self.height())
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self._draw_section(painter, drawing)
        for one in drawing.dimensions:
            self._draw_dimension(painter, one)
        painter.end()

    def _draw_section(self, painter: QPainter, drawing: Drawing) -> None:
        theme = self._theme
        painter.setPen(QPen(QColor(theme.line), 1.4))
        painter.setBrush(QColor(theme.feasible))
        painter.drawPolygon(QPolygonF([QPointF(float(x), float(y)) for x, y in drawing.outline]))
        pen = QPen(QColor(theme.muted), 0.8)
        pen.setDashPattern([10.0, 3.0, 2.0, 3.0])
        painter.setPen(pen)
        for start, end in drawing.centre_lines:
            painter.drawLine(QPointF(*start), QPointF(*end))

    def _draw_dimension(self, painter: QPainter, one: Dimension) -> None:
        theme = self._theme
        painter.setPen(QPen(QColor(theme.muted), 0.8))
        for first, second in one.extensions:
            painter.drawLine(QPointF(*first), QPointF(*second))
        painter.setPen(QPen(QColor(theme.text), 1.0))
        painter.setBrush(QColor(theme.text))
        start, end = QPointF(*one.start), QPointF(*one.end)
        away = end - start
        length = math.hypot(away.x(), away.y()) or 1.0
        unit = away / length
        if one.inward:
            painter.drawLine(start - unit * OUTSIDE, start)
            painter.drawLine(end, end + unit * OUTSIDE * 0.6)
            _arrow(painter, start, unit)
            _arrow(painter, end, -unit)
        else:
            painter.drawLine(start, end)
            _arrow(painter, start, -unit)
            if one.arrows > 1:
                _arrow(painter, end, unit)
        self._draw_text(painter, one)

    def _draw_text(self, painter: QPainter, one: Dimension) -> None:
        text = f"{one.text} {one.value}"
        metrics = QFontMetricsF(painter.font())
        width, height = metrics.horizontalAdvance(text) + 2.0, metrics.height()
        x, y = one.anchor
        corner = {
            "left": QPointF(x - width - 2.0, y - height / 2.0),
            "right": QPointF(x + 2.0, y - height / 2.0),
            "above": QPointF(x - width / 2.0, y - height - 1.0),
        }[one.side]
        # A text never leaves the sheet.
        left = min(max(corner.x(), 0.0), max(self.width() - width, 0.0))
        top = min(max(corner.y(), 0.0), max(self.height() - height, 0.0))
        painter.drawText(QRectF(left, top, width, height), Qt.AlignmentFlag.AlignCenter, text)


def _arrow(painter: QPainter, tip: QPointF, direction: QPointF) -> None:
    """Draw a filled arrow head whose tip points along a unit direction."""
    angle = math.atan2(direction.y(), direction.x())
    corners = [tip]
    for side in (-1.0, 1.0):
        turned = angle + math.pi + side * ARROW_ANGLE
        corners.append(tip + QPointF(math.cos(turned), math.sin(turned)) * ARROW)
    pen = painter.pen()
    painter.setPen(Qt.PenStyle.NoPen)
    painter.drawPolygon(QPolygonF(corners))
    painter.setPen(pen)
