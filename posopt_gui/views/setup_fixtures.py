"""How fixtures come into the cell and leave it: shapes, meshes of files, and which one is shown."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import QObject, Qt, Signal
from PySide6.QtWidgets import QFileDialog, QWidget

from posopt_gui.controllers.mesh_loader import NEW, MeshLoader
from posopt_gui.controllers.session import Session
from posopt_gui.viewmodels.fixture_edits import with_new_fixture, without_fixture
from posopt_gui.viewmodels.form_types import rows_of
from posopt_gui.viewmodels.project_files import MESH_SUFFIXES, kept_files

MESH = "mesh"
"""What is wanted where a new fixture is not one of the shapes."""


class SetupFixtures(QObject):
    """Adds and removes fixtures for a panel, and takes mesh files into the project.

    Signals: `chosen_changed()` where another fixture is to be shown; `refused(key, sentence)` why
    a mesh file was not taken, with the key that should name it ('' for a new fixture).
    """

    chosen_changed = Signal()
    refused = Signal(str, str)

    def __init__(self, session: Session, panel: QWidget) -> None:
        super().__init__(panel)
        self._session, self._panel = session, panel
        self._key = NEW
        self.chosen = 0
        self.loader = MeshLoader(session, self)
        self.loader.taken.connect(self._on_taken)
        self.loader.refused.connect(lambda sentence: self.refused.emit(self._key, sentence))

    def bound(self, count: int) -> None:
        """Keep the chosen one among those that there are."""
        self.chosen = min(self.chosen, max(count - 1, 0))

    def choose(self, index: int) -> None:
        """Show the fields of another fixture."""
        self.chosen = index
        self.chosen_changed.emit()

    def add(self, shape: str) -> None:
        """Add a fixture of a shape, or ask for a mesh file."""
        if shape == MESH:
            self.ask_mesh(NEW)
            return
        document = self._session.document
        cell, self.chosen = with_new_fixture(document.state.cell, shape)
        document.edit("Add fixture", replace(document.state, cell=cell))

    def remove(self, index: int) -> None:
        """Remove a fixture, and its mesh from the project."""
        document = self._session.document
        state = document.state
        if 0 <= index < len(rows_of(state.cell, "fixtures")):
            cell = without_fixture(state.cell, index)
            files = kept_files(cell, state.files)
            document.edit("Remove fixture", replace(state, cell=cell, files=files))

    def load_mesh(self, file: str, key: str = NEW) -> None:
        """Read a mesh file for a key of the cell, or as a new fixture."""
        self._key = key
        self.refused.emit(key, "")
        self.loader.open(file, key)

    def ask_mesh(self, key: str) -> None:
        """Ask for a mesh file and load it."""
        tr = self._session.look.tr
        names = " ".join(f"*{suffix} *{suffix.upper()}" for suffix in MESH_SUFFIXES)
        dialog = QFileDialog(self._panel, tr("Open mesh"), self._session.document.state.folder)
        dialog.setNameFilters([tr("Mesh files ({names})", names=names), tr("All files (*)")])
        dialog.setFileMode(QFileDialog.FileMode.ExistingFile)
        dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        dialog.fileSelected.connect(lambda file: self.load_mesh(file, key))
        dialog.open()

    def _on_taken(self, index: int) -> None:
        if index >= 0:
            self.choose(index)
