"""The text of a program in a fixed-width font, with line numbers."""

from __future__ import annotations

from PySide6.QtCore import QRect, QSize, Qt
from PySide6.QtGui import QColor, QFontDatabase, QPainter, QPaintEvent, QResizeEvent
from PySide6.QtWidgets import QPlainTextEdit, QWidget

from posopt_gui.look import Look

MARGIN = 8


class _Gutter(QWidget):
    """The strip of line numbers; the editor paints it."""

    def __init__(self, owner: ProgramPreview) -> None:
        super().__init__(owner)
        self._owner = owner

    def sizeHint(self) -> QSize:  # noqa: N802 - Qt's name
        return QSize(self._owner.gutter_width(), 0)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 - Qt's name
        self._owner.paint_gutter(event)


class ProgramPreview(QPlainTextEdit):
    """Shows a text that can be read and copied, not changed."""

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._look = look
        self._gutter = _Gutter(self)
        self.setReadOnly(True)
        self.setTabChangesFocus(True)
        self.setLineWrapMode(QPlainTextEdit.LineWrapMode.NoWrap)
        self.setFont(QFontDatabase.systemFont(QFontDatabase.SystemFont.FixedFont))
        self.setTextInteractionFlags(
            Qt.TextInteractionFlag.TextSelectableByMouse
            | Qt.TextInteractionFlag.TextSelectableByKeyboard
        )
        self.blockCountChanged.connect(self._fit_gutter)
        self.updateRequest.connect(self._scroll_gutter)
        self._fit_gutter()

    def show_text(self, text: str) -> None:
        """Show a text; the place that is looked at stays where lines stay."""
        if text == self.toPlainText():
            return
        place = self.verticalScrollBar().value()
        self.setPlainText(text)
        self.verticalScrollBar().setValue(place)

    def retranslate(self) -> None:
        """Set the accessible name."""
        self.setAccessibleName(self._look.tr("Text of the program"))

    def retheme(self) -> None:
        """Paint the numbers in the theme's colours."""
        self._gutter.update()

    def gutter_width(self) -> int:
        """Room for the largest line number."""
        digits = max(len(str(self.blockCount())), 3)
        return 2 * MARGIN + self.fontMetrics().horizontalAdvance("9") * digits

    def paint_gutter(self, event: QPaintEvent) -> None:
        """Draw the numbers of the lines that are seen."""
        theme = self._look.theme
        painter = QPainter(self._gutter)
        painter.fillRect(event.rect(), QColor(theme.raised))
        painter.setPen(QColor(theme.muted))
        painter.setFont(self.font())
        block = self.firstVisibleBlock()
        area = self.blockBoundingGeometry(block).translated(self.contentOffset())
        top, height = area.top(), self.fontMetrics().height()
        width = self._gutter.width() - MARGIN
        while block.isValid() and top <= event.rect().bottom():
            if top + area.height() >= event.rect().top():
                spot = QRect(0, round(top), width, height)
                text = str(block.blockNumber() + 1)
                painter.drawText(spot, Qt.AlignmentFlag.AlignRight, text)
            block = block.next()
            top += area.height()
            area = self.blockBoundingRect(block)
        painter.end()

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        """Keep the strip as high as the text."""
        super().resizeEvent(event)
        inside = self.contentsRect()
        self._gutter.setGeometry(inside.left(), inside.top(), self.gutter_width(), inside.height())

    def _fit_gutter(self) -> None:
        self.setViewportMargins(self.gutter_width(), 0, 0, 0)

    def _scroll_gutter(self, area: QRect, down: int) -> None:
        if down:
            self._gutter.scroll(0, down)
        else:
            self._gutter.update(0, area.y(), self._gutter.width(), area.height())
