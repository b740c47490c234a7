"""Files read off the window's thread, one at a time; what fails becomes a sentence."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide6.QtCore import QObject, Signal

from posopt_gui.controllers.session import Message, Session
from posopt_gui.viewmodels.error_words import error_words
from posopt_gui.workers.jobs import JobLine
from posopt_gui.workers.threads import JobThreads
from solver.errors import PosoptError


class FileLoader(QObject):
    """Runs one job at a time; a newer one takes the place of an older one.

    Signal `refused(sentence)`: why a file cannot be used.
    """

    refused = Signal(str)

    def __init__(self, session: Session, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._pool = JobThreads(1, self)
        self._line = JobLine(self._pool, self)
        self._line.done.connect(self._on_done)
        self._line.failed.connect(self._on_failed)

    def submit(self, work: Callable[[Any], object]) -> None:
        """Run a job; what it returns comes to `_on_done`."""
        self._line.submit(work)

    def close(self) -> None:
        """Forget what is being read and wait for it."""
        self._line.close()
        self._pool.wait()

    def _on_done(self, found: Any) -> None:
        """Take what a job has found."""

    def _on_failed(self, error: object) -> None:
        tr = self._session.look.tr
        if isinstance(error, PosoptError):
            self.refused.emit(error_words(error, tr))
            return
        words = "posopt met a defect of its own and kept your work; please report it: {text}"
        text = f"{type(error).__name__}: {error}"
        self._session.say(Message("error", tr(words, text=text)))
