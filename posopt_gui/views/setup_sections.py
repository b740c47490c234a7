"""A section of the setup panel that opens and closes; its rows are made when it first opens."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QMouseEvent, QResizeEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QToolButton, QVBoxLayout, QWidget

from posopt_gui.viewmodels.form_types import Cell, Field, Section
from posopt_gui.views.field_widgets import FieldRow, Translate, note_text, structure

Extra = Callable[[], QWidget]


class _Header(QFrame):
    """Head of a section: arrow, title and what is chosen; a click opens and closes."""

    clicked = Signal()

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setObjectName("header")
        self.button = QToolButton(self)
        self.button.setObjectName("title")
        self.button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.button.clicked.connect(self.clicked)
        self._summary = QLabel(self)
        self._summary.setObjectName("summary")
        self._summary.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self._summary.setMinimumWidth(0)
        self._text = ""
        layout = QHBoxLayout(self)
        layout.setContentsMargins(6, 2, 6, 2)
        layout.setSpacing(6)
        layout.addWidget(self.button)
        layout.addWidget(self._summary, 1)

    def show_state(self, title: str, summary: str, opened: bool) -> None:
        """Show title, summary and which way the section is."""
        arrow = Qt.ArrowType.DownArrow if opened else Qt.ArrowType.RightArrow
        self.button.setArrowType(arrow)
        self.button.setText(title)
        self._text = summary
        self._elide()

    def mark(self, wrong: bool) -> None:
        """Mark that a value inside is wrong."""
        self.setProperty("wrong", wrong)
        self.style().unpolish(self)
        self.style().polish(self)

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 - Qt's name
        """Open or close."""
        if event.button() == Qt.MouseButton.LeftButton:
            self.clicked.emit()

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        """Cut the summary to the width that is left."""
        super().resizeEvent(event)
        self._elide()

    def _elide(self) -> None:
        room = self.width() - self.button.sizeHint().width() - 26
        shown = self._summary.fontMetrics().elidedText(
            self._text, Qt.TextElideMode.ElideRight, max(room, 0)
        )
        self._summary.setText(shown)
        self._summary.setToolTip(self._text if shown != self._text else "")


class SectionBox(QWidget):
    """A section: header, rows, notes, and an extra widget at its place among them.

    Signals: `edited(field, value)`, `focused(row)`, `toggled(opened)`, `file_wanted(key)`.
    """

    edited = Signal(object, object)
    file_wanted = Signal(str)
    focused = Signal(object)
    toggled = Signal(bool)

    def __init__(
        self, section: Section, translate: Translate, extra: Extra | None, parent: QWidget
    ) -> None:
        super().__init__(parent)
        self._section, self._tr = section, translate
        self._make_extra = extra
        self._extra: QWidget | None = None
        self._cell: Cell = {}
        self._open = self._wrong = False
        self._error = ""
        self.rows: dict[tuple[object, ...], FieldRow] = {}
        self._header = _Header(self)
        self._header.clicked.connect(lambda: self.set_open(not self._open))
        self._body = QWidget(self)
        self._body.setObjectName("setupBody")
        self._fields = QVBoxLayout(self._body)
        self._fields.setContentsMargins(10, 8, 10, 12)
        self._fields.setSpacing(7)
        self._sentence = QLabel(self._body)
        self._sentence.setObjectName("sentence")
        self._sentence.setWordWrap(True)
        self._sentence.hide()
        self._fields.addWidget(self._sentence)
        self._notes: list[QLabel] = []
        self._body.hide()
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(self._header)
        layout.addWidget(self._body)
        self._show_header()

    @property
    def name(self) -> str:
        """Name of the section."""
        return self._section.name

    @property
    def opened(self) -> bool:
        """Whether the section is open."""
        return self._open

    @property
    def extra(self) -> QWidget | None:
        """The extra widget, once it was made."""
        return self._extra

    def set_open(self, opened: bool) -> None:
        """Open or close the section."""
        if opened == self._open:
            return
        self._open = opened
        if opened:
            self._arrange()
        self._body.setVisible(opened)
        self._show_header()
        self.toggled.emit(opened)

    def show_section(self, section: Section, cell: Cell) -> None:
        """Follow the cell: other fields, other values."""
        self._section, self._cell = section, cell
        self._show_header()
        if self._open:
            self._arrange()

    def row(self, key: str) -> FieldRow | None:
        """The row of a field; the section must be open."""
        return next((row for row in self.rows.values() if row.field.key == key), None)

    def set_error(self, key: str, sentence: str) -> None:
        """Show a sentence at a field ('' for the section itself); '' as sentence clears all."""
        self._wrong = bool(sentence)
        self._error = "" if key else sentence
        for row in self.rows.values():
            row.set_error(sentence if key and row.field.key == key else "")
        if sentence and key and self._open and self.row(key) is None:
            self._error = sentence
        self._sentence.setText(self._error)
        self._sentence.setVisible(bool(self._error))
        self._mark()

    def _mark(self) -> None:
        refused = any(row.refusal is not None for row in self.rows.values())
        self._header.mark(self._wrong or refused)

    def retranslate(self) -> None:
        """Set every text again."""
        self._show_header()
        for row in self.rows.values():
            row.retranslate()
        self._show_notes()

    def focus_header(self) -> None:
        """Put the keyboard onto the title."""
        self._header.button.setFocus(Qt.FocusReason.OtherFocusReason)

    def _show_header(self) -> None:
        section = self._section
        summary = self._tr(section.summary) if section.said else section.summary
        self._header.show_state(self._tr(self._section.title), summary, self._open)

    def _arrange(self) -> None:
        """Make, reuse and remove rows, so that they are those of the section, in its order."""
        wanted = {structure(field): field for field in self._section.fields}
        for key in [key for key in self.rows if key not in wanted]:
            row = self.rows.pop(key)
            self._fields.removeWidget(row)
            row.hide()
            row.deleteLater()
        if self._extra is None and self._section.extra and self._make_extra is not None:
            self._extra = self._make_extra()
            self._extra.setParent(self._body)
        if self._extra is not None:
            self._fields.removeWidget(self._extra)
            self._extra.setVisible(bool(self._section.extra))
        place = 1
        for key, field in wanted.items():
            if self._extra is not None and self._section.before == field.key:
                place = self._put(self._extra, place)
            place = self._put(self._shown_row(key, field), place)
        if self._extra is not None and not self._section.before:
            self._put(self._extra, place)
        self._order_tabs([self.rows[key] for key in wanted])
        self._show_notes()

    def _order_tabs(self, rows: list[FieldRow]) -> None:
        """Let the tabulator go through the editors as they stand."""
        editors = [self._header.button, *(one for row in rows for one in row.editors)]
        for before, after in pairwise(editors):
            QWidget.setTabOrder(before, after)

    def _put(self, widget: QWidget, place: int) -> int:
        if self._fields.indexOf(widget) != place:
            self._fields.removeWidget(widget)
            self._fields.insertWidget(place, widget)
        return place + 1

    def _shown_row(self, key: tuple[object, ...], field: Field) -> FieldRow:
        row = self.rows.get(key)
        if row is None:
            row = FieldRow(field, self._tr, self._body)
            row.edited.connect(lambda value, row=row: self._on_edited(row, value))
            row.focused.connect(lambda row=row: self.focused.emit(row))
            row.refused_changed.connect(self._mark)
            row.file_wanted.connect(lambda row=row: self.file_wanted.emit(row.field.key))
            self.rows[key] = row
        elif row.field != field:
            row.set_field(field)
        else:
            row.field = field  # its functions may be others
        row.show_value(field.value(self._cell))
        return row

    def _on_edited(self, row: FieldRow, value: Any) -> None:
        self.edited.emit(row.field, value)

    def _show_notes(self) -> None:
        for label in self._notes:
            self._fields.removeWidget(label)
            label.deleteLater()
        self._notes = []
        if not self._open:
            return
        for note in self._section.notes:
            label = QLabel(note_text(self._tr, note), self._body)
            label.setObjectName("muted")
            label.setWordWrap(True)
            label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
            self._fields.addWidget(label)
            self._notes.append(label)
