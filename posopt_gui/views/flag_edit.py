"""A check box whose frame and mark follow the palette, so that it is seen on dark surfaces too."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPalette, QPen, QPolygonF
from PySide6.QtWidgets import QCheckBox

SIDE = 14.0
GAP = 7.0


class FlagEdit(QCheckBox):
    """A check box drawn in the colours of the palette."""

    def sizeHint(self) -> QSize:  # noqa: N802 - Qt's name
        """Return the size of mark and text."""
        metrics = self.fontMetrics()
        width = int(SIDE + GAP + metrics.horizontalAdvance(self.text()) + 6)
        return QSize(width, max(int(SIDE) + 6, metrics.height() + 4))

    def minimumSizeHint(self) -> QSize:  # noqa: N802 - Qt's name
        """Return the size of the mark: a long text is cut, not the panel widened."""
        return QSize(int(SIDE + GAP), self.sizeHint().height())

    def hitButton(self, position: QPoint) -> bool:  # noqa: N802 - Qt's name
        """Let mark and text be clicked."""
        return self.rect().contains(position)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 - Qt's name
        """Draw frame, mark and text."""
        palette = self.palette()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        top = (self.height() - SIDE) / 2.0
        box = QRectF(0.5, top + 0.5, SIDE - 1.0, SIDE - 1.0)
        checked, enabled = self.isChecked(), self.isEnabled()
        accent = palette.color(QPalette.ColorRole.Highlight)
        frame = palette.color(QPalette.ColorRole.PlaceholderText)
        surface = palette.color(QPalette.ColorRole.Base)
        filled = checked and enabled
        painter.setPen(QPen(accent if filled else frame, 1.0))
        painter.setBrush(accent if filled else surface)
        painter.drawRoundedRect(box, 2.5, 2.5)
        if checked:
            mark = palette.color(QPalette.ColorRole.HighlightedText) if enabled else frame
            painter.setPen(QPen(mark, 1.8))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            corners = ((3.2, 7.2), (6.0, 10.0), (10.8, 4.2))
            painter.drawPolyline(QPolygonF([QPointF(x, top + y) for x, y in corners]))
        painter.setPen(self._text_colour())
        text = QRectF(SIDE + GAP, 0.0, self.width() - SIDE - GAP, self.height())
        shown = self.fontMetrics().elidedText(
            self.text(), Qt.TextElideMode.ElideRight, int(text.width())
        )
        painter.drawText(text, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, shown)
        if self.hasFocus():
            pen = QPen(palette.color(QPalette.ColorRole.WindowText), 1.0)
            painter.setPen(pen)
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRoundedRect(box, 2.5, 2.5)
        painter.end()

    def _text_colour(self) -> QColor:
        group = QPalette.ColorGroup.Normal if self.isEnabled() else QPalette.ColorGroup.Disabled
        return self.palette().color(group, QPalette.ColorRole.WindowText)
