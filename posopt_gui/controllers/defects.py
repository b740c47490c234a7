"""Defects of the window's own: a sentence for the person, the traceback into a log file."""

from __future__ import annotations

import contextlib
import logging
import sys
from logging.handlers import RotatingFileHandler
from pathlib import Path
from types import TracebackType
from typing import Final

from PySide6.QtCore import QStandardPaths

from posopt_gui.controllers.session import Message, Session
from posopt_gui.workers.jobs import LOG

LOG_SIZE: Final = 1_000_000
"""Largest log file [bytes]; one older one is kept."""

LONGEST: Final = 300
"""Most characters of an exception's own words in a sentence."""


def log_file() -> Path:
    """Where tracebacks are written, for this person on this machine."""
    place = QStandardPaths.StandardLocation.AppLocalDataLocation
    return Path(QStandardPaths.writableLocation(place)) / "posopt.log"


class DefectHook:
    """Takes the place of `sys.excepthook` while a window is open.

    An exception that nobody caught costs the step that it broke off, not the window: the person
    is told once, in a sentence, and the traceback is in the log.
    """

    def __init__(self, session: Session, file: Path | None = None) -> None:
        self._session = session
        self.file = file or log_file()
        self._told: set[str] = set()
        self._handler: logging.Handler | None = None
        self._before = sys.excepthook

    def install(self) -> None:
        """Begin; where no log can be written, tracebacks go to the standard error stream."""
        self._before = sys.excepthook
        try:
            self.file.parent.mkdir(parents=True, exist_ok=True)
            self._handler = RotatingFileHandler(
                self.file, maxBytes=LOG_SIZE, backupCount=1, encoding="utf-8", delay=True
            )
        except OSError:
            self._handler = logging.StreamHandler()
        self._handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(message)s"))
        LOG.addHandler(self._handler)
        sys.excepthook = self

    def remove(self) -> None:
        """Give back what was there before."""
        sys.excepthook = self._before
        if self._handler is not None:
            LOG.removeHandler(self._handler)
            self._handler.close()
            self._handler = None

    def __call__(
        self, kind: type[BaseException], error: BaseException, trace: TracebackType | None
    ) -> None:
        """Log an exception and tell it."""
        if not issubclass(kind, Exception):
            self._before(kind, error, trace)
            return
        LOG.error("an exception that nobody caught", exc_info=(kind, error, trace))
        text = " ".join(f"{kind.__name__}: {error}".split())[:LONGEST]
        if text in self._told:
            # A defect in drawing comes back with every frame.
            return
        self._told.add(text)
        words = (
            "posopt met a defect of its own and kept your work; please report it, with the file "
            "{file}: {text}"
        )
        # A window that is just being destroyed can show nothing any more.
        with contextlib.suppress(RuntimeError):
            tr = self._session.look.tr
            self._session.say(Message("error", tr(words, file=self.file, text=text)))
