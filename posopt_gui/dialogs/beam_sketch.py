"""A sketch of a beam in space with the three points that are touched on it."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QWidget

from posopt_gui.theme import Theme
from posopt_gui.viewmodels.beam_drawing import section_outline
from posopt_gui.viewmodels.touched_points import TouchedCorner, points_on_beam
from solver.model.workpiece import BeamSection
from solver.transforms import FloatArray
from solver.units import MM

HEIGHT = 190
SHOWN_LENGTH = 2.2
"""Length of the sketched beam, in heights of its section."""

# Seen from the front, above and the right: x runs to the right and back, z up.
_VIEW = np.array([[0.86, -0.42, 0.0], [-0.22, -0.30, -0.92]])
_MARK = 10.0


class BeamSketch(QWidget):
    """Draws the beam and the points 1, 2, 3 of a chosen corner."""

    def __init__(self, theme: Theme, section: BeamSection, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._theme, self._section = theme, section
        self._corner = TouchedCorner()
        self.setFixedHeight(HEIGHT)

    def show_corner(self, corner: TouchedCorner) -> None:
        """Draw the points of another corner."""
        self._corner = corner
        self.update()

    def set_theme(self, theme: Theme) -> None:
        """Draw in other colours."""
        self._theme = theme
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 - Qt's name
        """Draw the far end, the edges, the near end and the points."""
        theme, section = self._theme, self._section
        length = SHOWN_LENGTH * section.height
        outline = section_outline(section) * MM
        ends = [
            np.column_stack([np.full(len(outline), x), outline])
            for x in (length / 2.0, -length / 2.0)
        ]
        points = points_on_beam(self._corner, section, length)
        flat = self._fitted(np.vstack([*ends, points]))
        count = len(outline)
        far, near, marks = flat[:count], flat[count : 2 * count], flat[2 * count :]
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(QColor(theme.muted), 1.0))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawPolygon(_polygon(far))
        for corner in _sharp_corners(outline):
            painter.drawLine(QPointF(*far[corner]), QPointF(*near[corner]))
        painter.setPen(QPen(QColor(theme.line), 1.3))
        painter.setBrush(QColor(theme.feasible))
        painter.drawPolygon(_polygon(near))
        self._draw_marks(painter, marks)
        painter.end()

    def _fitted(self, points: FloatArray) -> FloatArray:
        """(n, 2) pixels of (n, 3) points, filling the widget."""
        flat = points @ _VIEW.T
        low, high = flat.min(axis=0), flat.max(axis=0)
        room = np.array([self.width() - 4 * _MARK, self.height() - 4 * _MARK])
        scale = float(np.min(room / (high - low)))
        middle = np.array([self.width(), self.height()]) / 2.0
        fitted: FloatArray = middle + (flat - (low + high) / 2.0) * scale
        return fitted

    def _draw_marks(self, painter: QPainter, marks: FloatArray) -> None:
        theme = self._theme
        pen = QPen(QColor(theme.accent), 1.2, Qt.PenStyle.DashLine)
        painter.setPen(pen)
        for other in marks[1:]:
            painter.drawLine(QPointF(*marks[0]), QPointF(*other))
        font = painter.font()
        font.setBold(True)
        painter.setFont(font)
        for number, (x, y) in enumerate(marks, start=1):
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(QColor(theme.accent))
            painter.drawEllipse(QPointF(x, y), _MARK, _MARK)
            painter.setPen(QColor(theme.accent_text))
            box = QRectF(x - _MARK, y - _MARK, 2.0 * _MARK, 2.0 * _MARK)
            painter.drawText(box, Qt.AlignmentFlag.AlignCenter, str(number))


def _polygon(points: FloatArray) -> QPolygonF:
    return QPolygonF([QPointF(float(x), float(y)) for x, y in points])


def _sharp_corners(outline: FloatArray) -> list[int]:
    """Indices of the flanges' corners: the points farthest out across the beam."""
    outermost = np.abs(outline[:, 0]).max()
    return [int(one) for one in np.flatnonzero(np.abs(outline[:, 0]) > 0.999 * outermost)]
