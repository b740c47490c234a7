"""What the setup panel shows besides its fields: the path file's place and the fixtures."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QDragEnterEvent, QDragLeaveEvent, QDropEvent
from PySide6.QtWidgets import (
    QFrame,
    QHBoxLayout,
    QLabel,
    QListWidget,
    QMenu,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from posopt_gui.viewmodels.path_preview import SUFFIXES
from posopt_gui.views.field_widgets import Translate
from posopt_gui.views.setup_fixtures import MESH
from solver.catalog.bodies import SHAPES

LIST_ROWS = 4
"""Fixtures that are seen without scrolling."""


def dropped_path_file(event: QDropEvent) -> str:
    """The one local file of a drop whose name ends like a path file; '' for anything else."""
    urls = event.mimeData().urls() if event.mimeData().hasUrls() else []
    files = [url.toLocalFile() for url in urls if url.isLocalFile()]
    if len(files) == 1 and files[0].casefold().endswith(SUFFIXES):
        return files[0]
    return ""


class PathFileBox(QFrame):
    """Where the path file is dropped or opened, and what it holds.

    Signals: `dropped(file)`, `open_wanted()`, `columns_wanted()`.
    """

    dropped = Signal(str)
    open_wanted = Signal()
    columns_wanted = Signal()

    def __init__(self, translate: Translate, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("drop")
        self.setAcceptDrops(True)
        self._tr = translate
        self._file, self._content = "", ""
        self._name = QLabel(self)
        self._name.setTextFormat(Qt.TextFormat.PlainText)
        self._content_label = QLabel(self)
        self._content_label.setObjectName("muted")
        self._content_label.setWordWrap(True)
        self.open_button = QPushButton(self)
        self.open_button.clicked.connect(self.open_wanted)
        self.columns_button = QPushButton(self)
        self.columns_button.clicked.connect(self.columns_wanted)
        self._sentence = QLabel(self)
        self._sentence.setObjectName("sentence")
        self._sentence.setWordWrap(True)
        self._sentence.hide()
        buttons = QHBoxLayout()
        buttons.setSpacing(6)
        buttons.addWidget(self.open_button)
        buttons.addWidget(self.columns_button)
        buttons.addStretch(1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(10, 8, 10, 8)
        layout.setSpacing(5)
        for widget in (self._name, self._content_label):
            layout.addWidget(widget)
        layout.addLayout(buttons)
        layout.addWidget(self._sentence)
        self.retranslate()

    @property
    def sentence(self) -> str:
        """Why the last file was not taken; '' where it was."""
        return self._sentence.text()

    def show_file(self, file: str, content: str) -> None:
        """Show the file's name and what it holds."""
        self._file, self._content = file, content
        self.retranslate()

    def show_sentence(self, sentence: str) -> None:
        """Show why a file was not taken; '' clears."""
        self._sentence.setText(sentence)
        self._sentence.setVisible(bool(sentence))

    def set_over(self, over: bool) -> None:
        """Show that a file hangs above."""
        self.setProperty("over", over)
        self.style().unpolish(self)
        self.style().polish(self)

    def retranslate(self) -> None:
        """Set every text again."""
        tr = self._tr
        self._name.setText(self._file or tr("No file yet"))
        self._content_label.setText(self._content or tr("Drop a path file here: CSV, JSON or LS."))
        self.open_button.setText(tr("Open…"))
        self.open_button.setToolTip(tr("Load the path from a CSV, JSON or LS file."))
        self.columns_button.setText(tr("Preview…"))
        self.columns_button.setToolTip(tr("See the first rows and say which column is what."))
        self.columns_button.setEnabled(bool(self._file))

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:  # noqa: N802 - Qt's name
        """Take path files."""
        if dropped_path_file(event):
            self.set_over(True)
            event.acceptProposedAction()

    def dragLeaveEvent(self, event: QDragLeaveEvent) -> None:  # noqa: N802 - Qt's name
        """Forget the file that hung above."""
        self.set_over(False)

    def dropEvent(self, event: QDropEvent) -> None:  # noqa: N802 - Qt's name
        """Load the file."""
        self.set_over(False)
        file = dropped_path_file(event)
        if file:
            event.acceptProposedAction()
            self.dropped.emit(file)


class FixtureList(QWidget):
    """The fixtures, one of them chosen, with buttons to add and remove.

    Signals: `chosen(index)`, `add_wanted(shape)`, `remove_wanted(index)`.
    """

    chosen = Signal(int)
    add_wanted = Signal(str)
    remove_wanted = Signal(int)

    def __init__(self, translate: Translate, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._tr = translate
        self.list = QListWidget(self)
        self.list.currentRowChanged.connect(self._on_row)
        self.add_button = QPushButton(self)
        menu = QMenu(self.add_button)
        for shape in (*SHAPES, MESH):
            action = menu.addAction("")
            action.setData(shape)
        menu.triggered.connect(lambda action: self.add_wanted.emit(action.data()))
        self.add_button.setMenu(menu)
        self.remove_button = QPushButton(self)
        self.remove_button.clicked.connect(lambda: self.remove_wanted.emit(self.list.currentRow()))
        buttons = QHBoxLayout()
        buttons.setSpacing(6)
        buttons.addWidget(self.add_button)
        buttons.addWidget(self.remove_button)
        buttons.addStretch(1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(6)
        layout.addWidget(self.list)
        layout.addLayout(buttons)
        height = self.list.fontMetrics().height() + 6
        self.list.setFixedHeight(LIST_ROWS * height + 4)
        self.retranslate()

    def show_fixtures(self, names: list[str], chosen: int) -> None:
        """Show the names and which one is chosen."""
        self.list.blockSignals(True)
        self.list.clear()
        self.list.addItems(names)
        self.list.setCurrentRow(chosen if chosen < len(names) else -1)
        self.list.blockSignals(False)
        self.remove_button.setEnabled(0 <= chosen < len(names))

    def retranslate(self) -> None:
        """Set every text again."""
        tr = self._tr
        self.list.setAccessibleName(tr("Fixtures"))
        self.add_button.setText(tr("Add"))
        self.add_button.setToolTip(tr("Add what stands still: a trestle, a wall, a fence."))
        for action in self.add_button.menu().actions():
            shape = action.data()
            words = "a mesh from a file…" if shape == MESH else shape
            action.setText(tr(words))
        self.remove_button.setText(tr("Remove"))
        self.remove_button.setToolTip(tr("Remove the chosen fixture."))

    def _on_row(self, row: int) -> None:
        if row >= 0:
            self.chosen.emit(row)
