"""Bars of the six pendant joints within their limits."""

from __future__ import annotations

from collections.abc import Sequence as Rows

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import QSizePolicy, QWidget

from posopt_gui.theme import LIGHT, Theme
from posopt_gui.viewmodels.inspector_model import JointBar
from posopt_gui.viewmodels.number_words import decimal
from posopt_gui.views.result_tables import tabular

ROW = 20
"""Height of a bar's row [px]."""

TRACK = 6.0
"""Height of a bar [px]."""


class JointBars(QWidget):
    """One row a joint: name, bar from limit to limit with the angle on it, the angle."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._theme: Theme = LIGHT
        self._bars: tuple[JointBar, ...] = ()
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)

    @property
    def bars(self) -> tuple[JointBar, ...]:
        """What is shown."""
        return self._bars

    def sizeHint(self) -> QSize:  # noqa: N802 - Qt's name
        """Six rows."""
        return QSize(220, 6 * ROW)

    def set_theme(self, theme: Theme) -> None:
        """Set all colours."""
        self._theme = theme
        self.update()

    def set_bars(self, bars: Rows[JointBar]) -> None:
        """Show joints; none where the pose is out of reach."""
        self._bars = tuple(bars)
        self.setAccessibleDescription(", ".join(f"{one.name} {one.words}" for one in self._bars))
        self.setToolTip(
            "\n".join(
                f"{one.name}: {decimal(one.low, 2)}° … {decimal(one.high, 2)}°"
                for one in self._bars
            )
        )
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 - Qt's name
        """Paint all rows."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setFont(tabular(self.font()))
        for row, bar in enumerate(self._bars):
            self._paint(painter, bar, row * ROW)

    def _paint(self, painter: QPainter, bar: JointBar, top: float) -> None:
        theme = self._theme
        metrics = painter.fontMetrics()
        names = metrics.horizontalAdvance("J6") + 8.0
        values = metrics.horizontalAdvance("−000.00°") + 8.0
        middle = top + ROW / 2.0
        colour = {"good": theme.accent, "near": theme.warning, "bad": theme.error}[bar.state]
        left, right = Qt.AlignmentFlag.AlignLeft, Qt.AlignmentFlag.AlignRight
        centre = Qt.AlignmentFlag.AlignVCenter
        painter.setPen(QColor(theme.muted))
        painter.drawText(QRectF(0.0, top, names, ROW), left | centre, bar.name)
        painter.setPen(QColor(theme.text if bar.state == "good" else colour))
        area = QRectF(self.width() - values, top, values, ROW)
        painter.drawText(area, right | centre, bar.words)
        wide = max(self.width() - names - values - 4.0, 10.0)
        track = QRectF(names, middle - TRACK / 2.0, wide, TRACK)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(theme.raised))
        painter.drawRoundedRect(track, TRACK / 2.0, TRACK / 2.0)
        zero = (0.0 - bar.low) / (bar.high - bar.low)
        if 0.0 < zero < 1.0:
            painter.setBrush(QColor(theme.border))
            painter.drawRect(QRectF(names + zero * wide - 0.5, middle - 6.0, 1.0, 12.0))
        painter.setBrush(QColor(colour))
        place = names + bar.share * wide
        start = names + min(max(zero, 0.0), 1.0) * wide
        painter.drawRect(QRectF(min(start, place), middle - 1.5, abs(place - start), 3.0))
        painter.drawEllipse(QRectF(place - 4.5, middle - 4.5, 9.0, 9.0))
