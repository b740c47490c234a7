"""Path files read and examined off the window's thread, and taken into the project in one step."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from PySide6.QtCore import QObject, QThreadPool, Signal

from posopt_gui.controllers.session import Message, Session
from posopt_gui.viewmodels.path_preview import (
    PathPreview,
    examine,
    path_table,
    sentence_of,
    taken_source,
)
from posopt_gui.workers.jobs import JobLine
from solver.errors import InputError, PosoptError
from solver.io.importers import Source, path_source


class PathLoader(QObject):
    """Examines one path file at a time; a newer one takes the place of an older one.

    Signals: `examined(preview)`; `refused(sentence)` where a file cannot even be opened.
    """

    examined = Signal(object)
    refused = Signal(str)

    def __init__(self, session: Session, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._pool = QThreadPool(self)
        self._pool.setMaxThreadCount(1)
        self._line = JobLine(self._pool, self)
        self._line.done.connect(self.examined)
        self._line.failed.connect(self._on_failed)

    def open(self, file: str | Path) -> None:
        """Read and examine a file of the disk."""
        state = self._session.document.state
        cell, folder = state.cell, state.folder
        self._line.submit(lambda _: examine(path_source(file), cell, folder=folder))

    def examine(
        self,
        source: Source,
        path: Mapping[str, Any] | None = None,
        mapping: Mapping[str, int] | None = None,
        header: bool | None = None,
    ) -> None:
        """Examine bytes under a table `path` and a mapping of columns."""
        state = self._session.document.state
        cell, folder = state.cell, state.folder
        self._line.submit(
            lambda _: examine(
                source, cell, folder=folder, path=path, mapping=mapping, header=header
            )
        )

    def take(self, preview: PathPreview, path: Mapping[str, Any] | None = None) -> None:
        """Make a file the project's path, in one step that can be undone."""
        document = self._session.document
        source = taken_source(preview)
        table = path_table(document.state.cell, source.file) if path is None else dict(path)
        cell = {**document.state.cell, "path": {**table, "file": source.file}}
        files = {source.file: source.data}
        document.edit("Load path", replace(document.state, cell=cell, files=files))

    def close(self) -> None:
        """Forget what is being examined and wait for it."""
        self._line.close()
        self._pool.waitForDone()

    def _on_failed(self, error: object) -> None:
        if isinstance(error, InputError):
            self.refused.emit(sentence_of(error))
        elif isinstance(error, PosoptError):
            self.refused.emit(str(error))
        else:
            words = "posopt met a defect of its own and kept your work; please report it: {text}"
            text = f"{type(error).__name__}: {error}"
            self._session.say(Message("error", self._session.look.tr(words).format(text=text)))
