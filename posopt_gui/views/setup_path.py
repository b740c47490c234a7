"""How a path file comes into the project: opened, dropped, examined, asked about, taken."""

from __future__ import annotations

from PySide6.QtCore import QObject, Qt, Signal
from PySide6.QtWidgets import QFileDialog, QWidget

from posopt_gui.controllers.path_loader import PathLoader
from posopt_gui.controllers.session import Session
from posopt_gui.viewmodels.error_words import error_words
from posopt_gui.viewmodels.form_types import at
from posopt_gui.viewmodels.path_preview import SUFFIXES, PathPreview
from solver.io.importers import Source


class SetupPath(QObject):
    """Loads path files for a panel.

    Signals: `questions(preview)` where a file needs answers or a person wants to see its
    columns; `refused(sentence)` why a file was not taken, '' where it was.
    """

    questions = Signal(object)
    refused = Signal(str)

    def __init__(self, session: Session, panel: QWidget) -> None:
        super().__init__(panel)
        self._session, self._panel = session, panel
        self._asked = False
        self.loader = PathLoader(session, self)
        self.loader.examined.connect(self._on_examined)
        self.loader.refused.connect(self.refused)

    def load(self, file: str) -> None:
        """Load a file; where it needs answers, `questions` is emitted."""
        self._asked = False
        self.loader.open(file)

    def choose(self) -> None:
        """Ask for a file and load it."""
        tr = self._session.look.tr
        names = " ".join(f"*{suffix} *{suffix.upper()}" for suffix in SUFFIXES)
        folder = self._session.document.state.folder
        dialog = QFileDialog(self._panel, tr("Open path"), folder)
        dialog.setNameFilters([tr("Path files ({names})", names=names), tr("All files (*)")])
        dialog.setFileMode(QFileDialog.FileMode.ExistingFile)
        dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        dialog.fileSelected.connect(self.load)
        dialog.open()

    def ask(self) -> None:
        """Show the columns of the project's own file."""
        state = self._session.document.state
        name = str(at(state.cell, "path.file", ""))
        data = state.files.get(name)
        if data is not None:
            self._asked = True
            self.loader.examine(Source(name, data), path=at(state.cell, "path", {}))

    def _on_examined(self, preview: PathPreview) -> None:
        error = preview.error
        tr = self._session.look.tr
        self.refused.emit(error_words(error, tr) if error is not None else "")
        if self._asked or preview.askable:
            self.questions.emit(preview)
        elif preview.error is None:
            self.loader.take(preview)
        self._asked = False
