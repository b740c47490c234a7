"""A slim gauge: a joint's whole range, what the plan uses of it, and where it is now."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import QWidget

from posopt_gui.theme import LIGHT, Theme
from posopt_gui.views.curve_plots import GAUGE
from solver.transforms import FloatArray

ROOM = 3.0
"""Above and below the gauge [px]."""


class LimitGauge(QWidget):
    """Drawn from the lower limit at the bottom to the upper one at the top."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._theme: Theme = LIGHT
        self._limits = (-1.0, 1.0)
        self._used: tuple[float, float] | None = None
        self._value: float | None = None
        self._below = 0.0
        self.setFixedWidth(GAUGE)

    def sizeHint(self) -> QSize:  # noqa: N802 - Qt's name
        """Slim."""
        return QSize(GAUGE, 40)

    def set_theme(self, theme: Theme) -> None:
        """Set all colours."""
        self._theme = theme
        self.update()

    def clear(self) -> None:
        """Show nothing, in the same width."""
        self._used = self._value = None
        self.setToolTip("")
        self.update()

    def set_used(self, limits: FloatArray, values: FloatArray) -> None:
        """The limits, and the angles that the plan passes."""
        self._limits = (float(limits[0]), float(limits[1]))
        self._used = (float(np.min(values)), float(np.max(values)))
        self.update()

    def set_below(self, height: float) -> None:
        """Keep this height free below [px], beside the numbers of an axis."""
        self._below = height
        self.update()

    def set_value(self, value: float) -> None:
        """The angle at the cursor."""
        self._value = float(value)
        self.update()

    def _height_of(self, value: float) -> float:
        low, high = self._limits
        share = (value - low) / (high - low)
        return ROOM + (1.0 - share) * (self.height() - self._below - 2.0 * ROOM)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 - Qt's name
        """Paint the gauge."""
        painter = QPainter(self)
        painter.fillRect(self.rect(), QColor(self._theme.plot))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(self._theme.raised))
        painter.drawRoundedRect(QRectF(3, ROOM, 6, self.height() - self._below - 2 * ROOM), 3, 3)
        if self._used is not None:
            top, bottom = self._height_of(self._used[1]), self._height_of(self._used[0])
            painter.setBrush(QColor(self._theme.feasible))
            painter.drawRect(QRectF(3, top, 6, max(bottom - top, 2.0)))
        if self._value is not None:
            painter.setBrush(QColor(self._theme.accent))
            painter.drawRect(QRectF(1, self._height_of(self._value) - 1.0, 10, 2.0))
