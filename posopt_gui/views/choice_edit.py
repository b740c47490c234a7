"""A choice of several values; long lists are searched by typing."""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import QEvent, QObject, Qt, QTimer, Signal
from PySide6.QtGui import QFocusEvent, QWheelEvent
from PySide6.QtWidgets import QComboBox, QCompleter, QLineEdit, QWidget

from posopt_gui.style import style_popup
from posopt_gui.views.quiet_editors import QuietCombo
from posopt_gui.views.text_edit import EscapeLeaves

LABEL_LENGTH = 6
"""Least width of the closed list [characters]; it grows with the panel."""


class ChoiceEdit(QuietCombo):
    """A list to choose from, and with `searchable` a text that finds in it.

    Signals: `chosen(value)` when a person has chosen another value, `focused()`.
    """

    chosen = Signal(object)
    focused = Signal()

    def __init__(self, searchable: bool = False, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.setMinimumContentsLength(LABEL_LENGTH)
        self._searchable = searchable
        self._values: list[Any] = []
        self._value: Any = None
        self._clicked_into = False
        if searchable:
            self.setEditable(True)
            self.setInsertPolicy(QComboBox.InsertPolicy.NoInsert)
            completer = QCompleter(self.model(), self)
            completer.setFilterMode(Qt.MatchFlag.MatchContains)
            completer.setCaseSensitivity(Qt.CaseSensitivity.CaseInsensitive)
            completer.setCompletionMode(QCompleter.CompletionMode.PopupCompletion)
            self._line().textEdited.connect(lambda _: style_popup(completer.popup()))
            self.setCompleter(completer)
            self._line().editingFinished.connect(self._take_text)
            self._line().installEventFilter(self)
        self.activated.connect(self._take_index)
        leaving = EscapeLeaves(self, lambda: self.show_value(self._value))
        leaving.focused.connect(self.focused)

    @property
    def value(self) -> Any:
        """The value that is shown."""
        return self._value

    def set_choices(self, choices: list[tuple[Any, str, str]]) -> None:
        """Offer values with their labels and a tool tip each."""
        self.blockSignals(True)
        self.clear()
        self._values = [value for value, _, _ in choices]
        for row, (_, label, detail) in enumerate(choices):
            self.addItem(label)
            if detail:
                self.setItemData(row, detail, Qt.ItemDataRole.ToolTipRole)
        self.blockSignals(False)
        self.show_value(self._value)

    def show_value(self, value: Any) -> None:
        """Show a value without saying that it was chosen."""
        self._value = value
        self.blockSignals(True)
        if value in self._values:
            self.setCurrentIndex(self._values.index(value))
        elif self._searchable:
            self.setCurrentIndex(-1)
            self.setEditText("" if value is None else str(value))
        else:
            # A value that is none of them is shown as it is: its sentence says what is expected.
            self.setCurrentIndex(-1)
            self.setPlaceholderText("" if value is None else str(value))
        if self._searchable:
            self._line().setCursorPosition(0)
        self.blockSignals(False)

    def wheelEvent(self, event: QWheelEvent) -> None:  # noqa: N802 - Qt's name
        """Leave a list that is searched alone; else as any quiet choice."""
        if self._searchable:
            event.ignore()
        else:
            super().wheelEvent(event)

    def focusInEvent(self, event: QFocusEvent) -> None:  # noqa: N802 - Qt's name
        """Note that a click has brought the keyboard."""
        self._clicked_into = event.reason() == Qt.FocusReason.MouseFocusReason
        super().focusInEvent(event)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 - Qt's name
        """Let the first click into the text select it all and open the list.

        What is typed then takes the place of the text, and the list shows what it finds.
        """
        if event.type() == QEvent.Type.MouseButtonRelease and self._clicked_into:
            self._clicked_into = False
            QTimer.singleShot(0, self, self._offer_all)
        return super().eventFilter(watched, event)

    def _offer_all(self) -> None:
        completer = self.completer()
        if completer is None:
            return
        style_popup(completer.popup())
        completer.setCompletionPrefix("")
        completer.complete()
        self._line().selectAll()

    def commit(self) -> None:
        """Apply a text that was typed, as Enter does."""
        if self._searchable:
            self._take_text()

    def _line(self) -> QLineEdit:
        line = self.lineEdit()
        if line is None:
            raise RuntimeError("a list without search has no text to edit")
        return line

    def _take_index(self, row: int) -> None:
        if 0 <= row < len(self._values):
            self._take(self._values[row])

    def _take_text(self) -> None:
        text = self._line().text().strip()
        labels = [self.itemText(row) for row in range(self.count())]
        folded = [label.casefold().replace(" ", "") for label in labels]
        wanted = text.casefold().replace(" ", "")
        if wanted in folded:
            self._take(self._values[folded.index(wanted)])
        elif text:
            near = [row for row, label in enumerate(folded) if wanted in label]
            self._take(self._values[near[0]] if len(near) == 1 else text)
        else:
            self.show_value(self._value)

    def _take(self, value: Any) -> None:
        before = self._value
        self.show_value(value)
        if value != before:
            self.chosen.emit(value)
