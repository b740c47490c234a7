"""Mesh files read and examined off the window's thread, and taken into the project in one step."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

from PySide6.QtCore import Signal

from posopt_gui.controllers.file_loader import FileLoader
from posopt_gui.viewmodels.cell_form import put
from posopt_gui.viewmodels.fixture_edits import with_new_mesh
from posopt_gui.viewmodels.form_types import at
from posopt_gui.viewmodels.project_files import free_name, kept_files

NEW = ""
"""Key of a mesh that becomes a fixture of its own."""


@dataclass(frozen=True, slots=True)
class MeshFile:
    """A mesh that was read: the key of the cell that is to name it, its name and its bytes."""

    key: str
    name: str
    data: bytes


class MeshLoader(FileLoader):
    """Reads one mesh at a time; what cannot be a body of the cell is refused.

    Signal `taken(index)`: a mesh became the fixture of that index (-1: it took another's place).
    """

    taken = Signal(int)

    def open(self, file: str | Path, key: str = NEW) -> None:
        """Read a file of the disk, for a key of the cell or as a new fixture."""
        cell = self._session.document.state.cell
        unit = at(cell, f"{key.rpartition('.')[0]}.unit") if key else None
        self.submit(lambda _: _examined(Path(file), key, "m" if unit == "m" else "mm"))

    def _on_done(self, found: MeshFile) -> None:
        document = self._session.document
        state = document.state
        name = free_name(state.files, found.name, found.data)
        files = {**state.files, name: found.data}
        if found.key:
            if at(state.cell, found.key.rpartition(".")[0]) is None:
                return
            cell, index = put(state.cell, found.key, name), -1
        else:
            cell, index = with_new_mesh(state.cell, name)
        document.edit("Load mesh", replace(state, cell=cell, files=kept_files(cell, files)))
        self.taken.emit(index)


def _examined(path: Path, key: str, unit: Literal["mm", "m"]) -> MeshFile:
    """Read a file and hold it against what a mesh of a cell must be."""
    # The library that reads meshes takes half a second to load.
    from solver.collision.mesh_files import whole_file  # noqa: PLC0415
    from solver.collision.meshes import load_mesh  # noqa: PLC0415

    name, data = whole_file(path)
    load_mesh(name, unit, data)
    return MeshFile(key, name, data)
