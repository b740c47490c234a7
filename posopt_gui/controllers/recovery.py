"""Autosave of what is not saved, and its recovery after a run that did not end properly.

Every window writes a file of its own and holds a lock beside it. A file whose lock nobody holds
was left behind by a run that was killed or that crashed.
"""

from __future__ import annotations

import contextlib
import json
import secrets
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from PySide6.QtCore import QObject, QStandardPaths, QTimer

from posopt_gui.controllers.file_lock import FileLock
from posopt_gui.controllers.files import Files
from posopt_gui.controllers.session import CLOSING_TIME, Message, Session
from posopt_gui.document.project import ProjectState
from posopt_gui.document.project_file import project_bytes, read_project
from posopt_gui.viewmodels.check_sentences import sentence
from posopt_gui.workers.jobs import JobLine
from posopt_gui.workers.threads import JobThreads
from solver.errors import InputError, Place, PosoptError
from solver.io.atomic import write_atomically

FORMAT: Final = "posopt-recovery"
VERSION: Final = 1
SUFFIX: Final = ".recovery"
DAMAGED: Final = ".damaged"

INTERVAL: Final = 30_000
"""Longest time that a change stays unsaved [ms]."""

IDLE: Final = 2_000
"""A change is saved when nothing else was changed for this long [ms]."""


@dataclass(frozen=True, slots=True)
class Recovered:
    """Work that a run left behind: its inputs, and the project file that it was, if any."""

    state: ProjectState
    path: Path | None


def recovery_folder() -> Path:
    """Where autosaved work lies, for this person on this machine."""
    place = QStandardPaths.StandardLocation.AppLocalDataLocation
    return Path(QStandardPaths.writableLocation(place)) / "recovery"


class Recovery(QObject):
    """Keeps a copy of unsaved work on disk while its window is open."""

    def __init__(
        self,
        session: Session,
        files: Files,
        folder: Path | None = None,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(parent or session)
        self._session, self._files = session, files
        self._folder = folder or recovery_folder()
        self._file = self._folder / f"{secrets.token_hex(8)}{SUFFIX}"
        self._lock: FileLock | None = None
        self._left_behind: list[tuple[Path, FileLock]] = []
        self._saved: ProjectState | None = None
        self._warned = False
        self._pool = JobThreads(2, self)
        self._writes = JobLine(self._pool, self)
        self._writes.done.connect(self._written)
        self._writes.failed.connect(self._failed)
        self._interval = QTimer(self)
        self._interval.setInterval(INTERVAL)
        self._interval.timeout.connect(self.save)
        self._idle = QTimer(self)
        self._idle.setSingleShot(True)
        self._idle.setInterval(IDLE)
        self._idle.timeout.connect(self.save)
        session.document.changed.connect(self._idle.start)
        session.document.history_changed.connect(self._on_history)
        self._interval.start()

    @property
    def file(self) -> Path:
        """The window's own file; it exists while there is unsaved work."""
        return self._file

    def restore(self, only: Path | None = None) -> bool:
        """Open the newest work that was left behind, of the project `only` where one is named.

        False where there is none. Other work stays for the next window.
        """
        for file in _newest_first(self._folder):
            lock = _lock_of(file)
            if not _taken(lock):
                continue
            found = self._read(file)
            if found is None or (only is not None and found.path != only.absolute()):
                lock.give_back()
                continue
            # It stays, and stays ours, until this window has written a copy of its own.
            self._left_behind.append((file, lock))
            self._session.open(found.state, saved=False)
            self._files.opened(found.path)
            self.save()
            name = self._files.name
            words = self._session.look.tr("Unsaved work of {name} was recovered.", name=name)
            self._session.say(Message("warning", words))
            return True
        return False

    def tell_kept(self) -> bool:
        """Say which work was left behind and stays so; False where there is none."""
        for file in _newest_first(self._folder):
            lock = _lock_of(file)
            if not _taken(lock):
                continue
            found = self._read(file)
            lock.give_back()
            if found is None:
                continue
            words = "Unsaved work of {name} is kept; start posopt without a file to recover it."
            text = self._session.look.tr(words, name=_name_of(found))
            self._session.say(Message("warning", text))
            return True
        return False

    def save(self) -> None:
        """Write a copy where something changed since the last one; take it away when saved."""
        document = self._session.document
        if not document.modified:
            self._discard()
            return
        state, path = document.state, self._files.path
        if state is self._saved or not self._hold_lock():
            return
        self._saved = state
        file = self._file
        self._writes.submit(lambda _: write_atomically(file, _bytes(state, path)))

    def end(self) -> bool:
        """End properly: nothing is left behind. False where a copy is still being written."""
        self._interval.stop()
        self._idle.stop()
        self._writes.close()
        done = self._pool.wait(CLOSING_TIME)
        self._drop_left_behind()
        _remove(self._file)
        if self._lock is not None:
            self._lock.give_back()
            self._lock = None
        return done

    def _on_history(self) -> None:
        if not self._session.document.modified:
            self._discard()

    def _discard(self) -> None:
        if self._saved is None:
            return
        self._saved = None
        file = self._file
        # In the same line of jobs, so that no copy is written after it.
        self._writes.submit(lambda _: _remove(file))

    def _hold_lock(self) -> bool:
        if self._lock is not None:
            return True
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            lock = _lock_of(self._file)
            held = lock.take()
        except OSError as error:
            self._warn(f"{self._folder}: {error.strerror or error}")
            return False
        self._lock = lock if held else None
        return held

    def _written(self, _answer: object) -> None:
        self._drop_left_behind()

    def _drop_left_behind(self) -> None:
        for file, lock in self._left_behind:
            _remove(file)
            lock.give_back()
        self._left_behind.clear()

    def _failed(self, error: object) -> None:
        self._saved = None
        self._warn(str(error))

    def _warn(self, reason: str) -> None:
        if not self._warned:
            self._warned = True
            words = "Your work cannot be kept for recovery, save it often: {reason}"
            tr = self._session.look.tr
            text = tr(words, reason=sentence(reason, tr))
            self._session.say(Message("warning", text))

    def _read(self, file: Path) -> Recovered | None:
        try:
            data = file.read_bytes()
        except OSError:
            # Its window has ended properly just now.
            return None
        try:
            return read_recovered(data, str(file))
        except PosoptError as error:
            # It is put aside, not thrown away: a person may still find something in it.
            with contextlib.suppress(OSError):
                file.replace(file.with_suffix(DAMAGED))
            words = "Work of an earlier run could not be recovered: {reason}"
            tr = self._session.look.tr
            text = tr(words, reason=sentence(str(error), tr))
            self._session.say(Message("warning", text))
            return None


def read_recovered(data: bytes, file: str) -> Recovered:
    """Read an autosaved copy.

    Raises
    ------
    InputError
        When it is no whole copy.
    """
    try:
        document: Any = json.loads(data)
        if document["format"] != FORMAT or document["version"] != VERSION:
            raise InputError("is no copy that this posopt can read", Place(file))
        project, path = document["project"], document["file"]
        state = read_project(project.encode(), file)
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise InputError("is no whole copy", Place(file)) from error
    return Recovered(state, Path(path) if isinstance(path, str) and path else None)


def _name_of(found: Recovered) -> str:
    if found.path is not None:
        return found.path.stem
    return str(found.state.value("cell.name") or "?")


def _bytes(state: ProjectState, path: Path | None) -> bytes:
    document = {
        "format": FORMAT,
        "version": VERSION,
        "file": str(path) if path is not None else "",
        "project": project_bytes(state).decode(),
    }
    return json.dumps(document).encode()


def _lock_of(file: Path) -> FileLock:
    return FileLock(file.with_name(file.name + ".lock"))


def _taken(lock: FileLock) -> bool:
    try:
        return lock.take()
    except OSError:
        return False


def _newest_first(folder: Path) -> list[Path]:
    dated = []
    for file in sorted(folder.glob(f"*{SUFFIX}")):
        with contextlib.suppress(OSError):
            dated.append((file.stat().st_mtime_ns, file))
    return [file for _, file in sorted(dated, reverse=True)]


def _remove(file: Path) -> None:
    with contextlib.suppress(OSError):
        file.unlink(missing_ok=True)
