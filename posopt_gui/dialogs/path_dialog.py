"""A path file before it is taken: its first rows, which column is what, and what it leaves open."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from PySide6.QtCore import Qt, QTimer
from PySide6.QtWidgets import (
    QAbstractItemView,
    QDialog,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QPushButton,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from posopt_gui.controllers.path_loader import PathLoader
from posopt_gui.controllers.session import Session
from posopt_gui.viewmodels.cell_facts import Catalogue, facts_of
from posopt_gui.viewmodels.cell_form import put
from posopt_gui.viewmodels.error_words import error_words
from posopt_gui.viewmodels.form_fields_path import common_fields, orientation_fields, source_fields
from posopt_gui.viewmodels.form_types import Cell, Field, at
from posopt_gui.viewmodels.path_preview import PathPreview, path_table
from posopt_gui.viewmodels.path_words import path_words
from posopt_gui.views.choice_edit import ChoiceEdit
from posopt_gui.views.field_widgets import FieldRow, structure
from posopt_gui.views.flag_edit import FlagEdit
from posopt_gui.views.refresh import Refresh
from posopt_gui.views.setup_style import setup_style
from solver.io.importers.columns import FIELDS

SIZE = (1040, 560)
IGNORED = ""
EXAMINE_DELAY = 60
"""How long the dialog waits for further answers before it reads the file again [ms]."""

COLUMN_WIDTH = 96


class PathDialog(QDialog):
    """Shows a path file and asks what it does not say; 'Use this path' takes it in one step."""

    def __init__(
        self, session: Session, preview: PathPreview, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.resize(*SIZE)
        self._session = session
        self._tr = session.look.tr
        self._preview = preview
        state = session.document.state
        self._cell: Cell = {**state.cell, "path": path_table(state.cell, preview.source.file)}
        self._facts = facts_of(state.cell, Catalogue(), state.folder, state.files)
        self._header = preview.header
        self._mapping: dict[str, int] | None = None
        if preview.mappable and not preview.understood:
            self._mapping = dict(preview.mapping)
        self._loader = PathLoader(session, self)
        self._loader.examined.connect(self.show_preview)
        self._loader.refused.connect(self._show_sentence)
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setInterval(EXAMINE_DELAY)
        self._timer.timeout.connect(self._examine)
        self._rows: dict[tuple[object, ...], FieldRow] = {}
        self._columns: list[ChoiceEdit] = []
        self._lay_out()
        session.look.language_changed.connect(Refresh(session, self.retranslate, self).next_turn)
        session.look.theme_changed.connect(Refresh(session, self.retheme, self).next_turn)
        self.retheme()
        self._show_fields()
        self.show_preview(preview)
        self.retranslate()

    @property
    def preview(self) -> PathPreview:
        """What is known of the file under the answers so far."""
        return self._preview

    @property
    def mapping(self) -> Mapping[str, int] | None:
        """Which column is what, as answered; None where the importer's own reading holds."""
        return self._mapping

    def column(self, index: int) -> ChoiceEdit:
        """The choice above a column of the table."""
        return self._columns[index]

    def row(self, key: str) -> FieldRow | None:
        """The row of a field."""
        return next((row for row in self._rows.values() if row.field.key == key), None)

    def set_column(self, index: int, field: str) -> None:
        """Say what a column is; '' ignores it. A field is one column only."""
        mapping = dict(self._preview.mapping if self._mapping is None else self._mapping)
        mapping = {name: one for name, one in mapping.items() if one != index and name != field}
        if field:
            mapping[field] = index
        self._mapping = mapping
        self._show_mapping()
        self._timer.start()

    def show_preview(self, preview: PathPreview) -> None:
        """Show a file as it was examined."""
        self._preview = preview
        self._show_table()
        self._show_sentence(self._error_sentence())
        self.accept_button.setEnabled(preview.toolpath is not None)

    def accept(self) -> None:
        """Take the file as the project's path."""
        if self._preview.toolpath is None or self._timer.isActive():
            return
        self._loader.take(self._preview, at(self._cell, "path"))
        super().accept()

    def done(self, result: int) -> None:
        """Forget what is still being examined."""
        self._timer.stop()
        self._loader.close()
        super().done(result)

    def retranslate(self) -> None:
        """Set every text again."""
        tr = self._tr
        self.setWindowTitle(tr("Path file") + f": {self._preview.name}")
        self.accept_button.setText(tr("Use this path"))
        self.cancel_button.setText(tr("Cancel"))
        self._titles_button.setText(tr("First row holds titles"))
        self.table.setAccessibleName(tr("First rows of the file"))
        for row in self._rows.values():
            row.retranslate()
        self._show_mapping()
        self._show_sentence(self._error_sentence())

    def _error_sentence(self) -> str:
        error = self._preview.error
        return error_words(error, self._tr) if error is not None else ""

    def retheme(self) -> None:
        """Set every colour again."""
        theme = self._session.look.theme
        good = f"QLabel#good {{ color: {theme.good}; }}"
        self.setStyleSheet(setup_style(theme) + good)

    def _lay_out(self) -> None:
        self._sentence = QLabel(self)
        self._sentence.setWordWrap(True)
        self._sentence.setMinimumHeight(2 * self._sentence.fontMetrics().height() + 4)
        self._sentence.setAlignment(Qt.AlignmentFlag.AlignTop | Qt.AlignmentFlag.AlignLeft)
        self.table = QTableWidget(self)
        self.table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.table.setSelectionMode(QAbstractItemView.SelectionMode.NoSelection)
        self.table.setTabKeyNavigation(False)
        self.table.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.Interactive)
        self._titles_button = FlagEdit(self)
        self._titles_button.setChecked(self._header)
        self._titles_button.clicked.connect(self._set_header)
        self._form = QVBoxLayout()
        self._form.setSpacing(7)
        form = QWidget(self)
        form.setFixedWidth(300)
        column = QVBoxLayout(form)
        column.setContentsMargins(0, 0, 0, 0)
        column.addLayout(self._form)
        column.addStretch(1)
        self.accept_button = QPushButton(self)
        self.accept_button.setObjectName("primary")
        self.accept_button.setDefault(True)
        self.accept_button.clicked.connect(self.accept)
        self.cancel_button = QPushButton(self)
        self.cancel_button.setAutoDefault(False)
        self.cancel_button.clicked.connect(self.reject)
        left = QVBoxLayout()
        left.setSpacing(8)
        left.addWidget(self.table, 1)
        left.addWidget(self._titles_button, 0, Qt.AlignmentFlag.AlignLeft)
        middle = QHBoxLayout()
        middle.setSpacing(16)
        middle.addLayout(left, 1)
        middle.addWidget(form)
        buttons = QHBoxLayout()
        buttons.addStretch(1)
        buttons.addWidget(self.cancel_button)
        buttons.addWidget(self.accept_button)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(16, 14, 16, 14)
        layout.setSpacing(12)
        layout.addWidget(self._sentence)
        layout.addLayout(middle, 1)
        layout.addLayout(buttons)

    def _fields(self) -> tuple[Field, ...]:
        fields = [*source_fields(self._cell, self._facts), *orientation_fields(self._cell)]
        shown = ("path.feed_mm_s", "path.convention")
        return (*fields, *(one for one in common_fields() if one.key in shown))

    def _show_fields(self) -> None:
        wanted = {structure(field): field for field in self._fields()}
        for key in [key for key in self._rows if key not in wanted]:
            row = self._rows.pop(key)
            self._form.removeWidget(row)
            row.hide()
            row.deleteLater()
        for place, (key, field) in enumerate(wanted.items()):
            if key not in self._rows:
                row = FieldRow(field, self._tr, self)
                row.edited.connect(lambda value, row=row: self._on_edited(row.field, value))
                self._rows[key] = row
                self._form.insertWidget(place, row)
            self._rows[key].field = field
            self._rows[key].show_value(field.value(self._cell))

    def _on_edited(self, field: Field, value: Any) -> None:
        written = field.written(value)
        if field.apply is not None:
            self._cell = field.apply(self._cell, written)
        else:
            self._cell = put(self._cell, field.key, written)
        self._show_fields()
        self._timer.start()

    def _set_header(self, header: bool) -> None:
        self._header = header
        self._mapping = None
        self._timer.start()

    def _examine(self) -> None:
        header = self._header if self._preview.mappable else None
        self._loader.examine(self._preview.source, at(self._cell, "path"), self._mapping, header)

    def _show_sentence(self, sentence: str) -> None:
        path = self._preview.toolpath
        self._sentence.setObjectName("sentence" if sentence else "good")
        if sentence:
            self._sentence.setText(sentence)
        elif path is not None:
            self._sentence.setText(path_words(path, self._tr))
            if not self._preview.frame_said:
                note = self._tr("The file does not state its frame: is it this one?")
                self._sentence.setText(f"{self._sentence.text()}\n{note}")
        self._sentence.style().unpolish(self._sentence)
        self._sentence.style().polish(self._sentence)

    def _show_table(self) -> None:
        preview = self._preview
        self.table.setVisible(preview.mappable)
        self._titles_button.setVisible(preview.mappable)
        count = len(preview.titles)
        if len(self._columns) != count:
            self._make_columns(count)
        self._titles_button.setChecked(preview.header)
        titles = preview.titles if preview.header else ()
        for column, title in enumerate(titles):
            item = QTableWidgetItem(title)
            font = item.font()
            font.setBold(True)
            item.setFont(font)
            self.table.setItem(1, column, item)
        first = 2 if preview.header else 1
        self.table.setRowCount(first + len(preview.rows))
        for number, cells in enumerate(preview.rows):
            for column, cell in enumerate(cells[:count]):
                self.table.setItem(first + number, column, QTableWidgetItem(cell))
        self._show_mapping()

    def _make_columns(self, count: int) -> None:
        self.table.clear()
        self.table.setColumnCount(count)
        self.table.setRowCount(2)
        self.table.setHorizontalHeaderLabels([str(number + 1) for number in range(count)])
        self.table.verticalHeader().hide()
        self._columns = []
        for column in range(count):
            choice = ChoiceEdit(parent=self.table)
            choice.chosen.connect(lambda field, at=column: self.set_column(at, field))
            self.table.setCellWidget(0, column, choice)
            self.table.setColumnWidth(column, COLUMN_WIDTH)
            self._columns.append(choice)

    def _show_mapping(self) -> None:
        mapping = self._preview.mapping if self._mapping is None else self._mapping
        by_column = {column: field for field, column in mapping.items()}
        choices = [(IGNORED, self._tr("ignored"), "")]
        choices += [(field, field, "") for field in FIELDS]
        for column, choice in enumerate(self._columns):
            choice.setAccessibleName(self._tr("Column {number}", number=column + 1))
            choice.set_choices(choices)
            choice.show_value(by_column.get(column, IGNORED))
