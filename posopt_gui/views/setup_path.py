"""How a path file comes into the project: opened, dropped, examined, asked about, taken."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QObject, Qt, Signal
from PySide6.QtWidgets import QFileDialog, QWidget

from posopt_gui.controllers.folders import first_folder
from posopt_gui.controllers.path_loader import PathLoader
from posopt_gui.controllers.session import Message, Session
from posopt_gui.viewmodels.error_words import error_words
from posopt_gui.viewmodels.form_types import at
from posopt_gui.viewmodels.path_preview import SUFFIXES, PathPreview
from solver.catalog.names import resource_folder
from solver.io.importers import Source


class SetupPath(QObject):
    """Loads path files for a panel.

    Signals: `questions(preview)` where a file needs answers or a person wants to see its
    columns; `refused(sentence)` why a file was not taken, '' where it was;
    `loaded()` when the path of another file is there.
    """

    questions = Signal(object)
    refused = Signal(str)
    loaded = Signal()

    def __init__(self, session: Session, panel: QWidget) -> None:
        super().__init__(panel)
        self._session, self._panel = session, panel
        self._asked = False
        self._folder = ""
        self._shown = self._path_file()
        self.loader = PathLoader(session, self)
        session.problem_changed.connect(self._on_problem)
        self.loader.examined.connect(self._on_examined)
        self.loader.refused.connect(self.refused)

    def load(self, file: str) -> None:
        """Load a file; where it needs answers, `questions` is emitted."""
        self._asked = False
        self._folder = str(Path(file).parent)
        self.loader.open(file)

    @property
    def folder(self) -> str:
        """Where a path file is looked for: where the last one was, else beside the project."""
        own = self._session.document.state.folder
        if self._folder or not own:
            return self._folder or str(first_folder())
        # Nobody keeps files among those of the installation.
        return str(first_folder()) if Path(own).is_relative_to(resource_folder()) else own

    def choose(self) -> None:
        """Ask for a file and load it."""
        tr = self._session.look.tr
        names = " ".join(f"*{suffix} *{suffix.upper()}" for suffix in SUFFIXES)
        dialog = QFileDialog(self._panel, tr("Open path"), self.folder)
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

    def _path_file(self) -> tuple[str, bytes | None]:
        state = self._session.document.state
        name = str(at(state.cell, "path.file", ""))
        return name, state.files.get(name)

    def _on_problem(self) -> None:
        """Say what a path file holds once it is the path of an edited project."""
        found, problem = self._path_file(), self._session.problem
        if problem is None or found == self._shown:
            return
        self._shown = found
        if not found[0] or not self._session.document.can_undo:
            return
        tr, path = self._session.look.tr, problem.toolpath
        words = {"file": Path(found[0]).name, "count": len(path), "frame": path.frame.value}
        if len(path.passes) == 1:
            text = tr("{file}: {count} waypoints, 1 pass, frame {frame}", **words)
        else:
            count = len(path.passes)
            text = tr(
                "{file}: {count} waypoints, {passes} passes, frame {frame}", **words, passes=count
            )
        self._session.say(Message("info", text))
        self.loaded.emit()

    def _on_examined(self, preview: PathPreview) -> None:
        error = preview.error
        tr = self._session.look.tr
        self.refused.emit(error_words(error, tr) if error is not None else "")
        if self._asked or preview.askable:
            self.questions.emit(preview)
        elif preview.error is None:
            self.loader.take(preview)
        self._asked = False
