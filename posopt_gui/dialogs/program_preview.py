"""The text of a program in a fixed-width font, with line numbers."""

from __future__ import annotations

from PySide6.QtCore import QRect, QSize, Qt
from PySide6.QtGui import (
    QColor,
    QFontDatabase,
    QPainter,
    QPaintEvent,
    QResizeEvent,
    QTextCharFormat,
    QTextCursor,
    QTextFormat,
)
from PySide6.QtWidgets import QPlainTextEdit, QTextEdit, QWidget

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
        self._marked = 0
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
        self._marked = 0
        self.setPlainText(text)
        self._mark()
        self.verticalScrollBar().setValue(place)

    def show_line(self, number: int) -> None:
        """Scroll to a line (from 1) and mark it; a number beyond the text marks none."""
        block = self.document().findBlockByNumber(number - 1)
        self._marked = number if block.isValid() else 0
        self._mark()
        if block.isValid():
            self.setTextCursor(QTextCursor(block))
            self.centerCursor()

    @property
    def marked(self) -> int:
        """The marked line, from 1; 0 for none."""
        return self._marked

    def _mark(self) -> None:
        block = self.document().findBlockByNumber(self._marked - 1)
        if not self._marked or not block.isValid():
            self.setExtraSelections([])
            return
        theme, mark = self._look.theme, QTextEdit.ExtraSelection()
        form = QTextCharFormat()
        form.setBackground(QColor(theme.selection))
        form.setForeground(QColor(theme.text))
        form.setProperty(QTextFormat.Property.FullWidthSelection, True)
        mark.format, mark.cursor = form, QTextCursor(block)
        self.setExtraSelections([mark])
        self._gutter.update()

    def retranslate(self) -> None:
        """Set the accessible name."""
        self.setAccessibleName(self._look.tr("Text of the program"))

    def retheme(self) -> None:
        """Paint the numbers and the mark in the theme's colours."""
        self._gutter.update()
        self._mark()

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
                marked = block.blockNumber() + 1 == self._marked
                painter.setPen(QColor(theme.accent if marked else theme.muted))
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
