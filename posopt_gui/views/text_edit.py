"""Texts that Enter applies; and what Escape and the focus do in every editor of a form."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QEvent, QObject, Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QLineEdit, QWidget


class EscapeLeaves(QObject):
    """Lets Escape show an editor's old value again and leave it.

    Signal `focused()`: the editor is being edited.
    """

    focused = Signal()

    def __init__(self, editor: QWidget, restore: Callable[[], None]) -> None:
        super().__init__(editor)
        self._editor, self._restore = editor, restore
        editor.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 - Qt's name
        """Take Escape, and tell of the focus."""
        if event.type() == QEvent.Type.FocusIn:
            self.focused.emit()
        escape = isinstance(event, QKeyEvent) and event.key() == Qt.Key.Key_Escape
        if escape and event.type() == QEvent.Type.KeyPress:
            self._restore()
            self._editor.clearFocus()
            event.accept()
            return True
        return super().eventFilter(watched, event)


class TextEdit(QLineEdit):
    """A text: Enter or leaving applies, Escape shows the old one again."""

    entered = Signal(str)
    focused = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._text = ""
        self.editingFinished.connect(self.commit)
        EscapeLeaves(self, lambda: self.setText(self._text)).focused.connect(self.focused)

    def show_text(self, text: str) -> None:
        """Show a text without saying that it was entered."""
        self._text = text
        if self.text() != text:
            self.setText(text)
            self.setCursorPosition(0)

    def commit(self) -> None:
        """Apply what was typed, as Enter does."""
        text = self.text().strip()
        if text != self._text:
            self._text = text
            self.entered.emit(text)
