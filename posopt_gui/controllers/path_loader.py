"""Path files read and examined off the window's thread, and taken into the project in one step."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from PySide6.QtCore import Signal

from posopt_gui.controllers.file_loader import FileLoader
from posopt_gui.viewmodels.path_preview import (
    PathPreview,
    examine,
    path_table,
    taken_source,
)
from posopt_gui.viewmodels.project_files import beside_the_path
from solver.io.importers import Source, path_source


class PathLoader(FileLoader):
    """Examines one path file at a time; a newer one takes the place of an older one.

    Signal `examined(preview)`; `refused` tells why a file cannot even be opened.
    """

    examined = Signal(object)

    def open(self, file: str | Path) -> None:
        """Read and examine a file of the disk."""
        state = self._session.document.state
        cell, folder, files = state.cell, state.folder, state.files
        self.submit(lambda _: examine(path_source(file), cell, folder=folder, files=files))

    def examine(
        self,
        source: Source,
        path: Mapping[str, Any] | None = None,
        mapping: Mapping[str, int] | None = None,
        header: bool | None = None,
    ) -> None:
        """Examine bytes under a table `path` and a mapping of columns."""
        state = self._session.document.state
        cell, folder, files = state.cell, state.folder, state.files
        self.submit(
            lambda _: examine(
                source, cell, folder=folder, files=files, path=path, mapping=mapping, header=header
            )
        )

    def take(self, preview: PathPreview, path: Mapping[str, Any] | None = None) -> None:
        """Make a file the project's path, in one step that can be undone."""
        document = self._session.document
        source = taken_source(preview)
        table = path_table(document.state.cell, source.file) if path is None else dict(path)
        cell = {**document.state.cell, "path": {**table, "file": source.file}}
        files = {**beside_the_path(document.state.files), source.file: source.data}
        document.edit("Load path", replace(document.state, cell=cell, files=files))

    def _on_done(self, found: PathPreview) -> None:
        self.examined.emit(found)
