"""The files of a window: new, open, save, recent ones, and what is dropped on it."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Final

from PySide6.QtCore import QObject, QSettings, Signal

from posopt_gui.controllers.file_mark import mark_of
from posopt_gui.controllers.folders import first_folder
from posopt_gui.controllers.guide import guide_file
from posopt_gui.controllers.path_import import (
    PATH_SUFFIXES,
    PathError,
    is_path_file,
    path_for,
    state_with_path,
)
from posopt_gui.controllers.questions import Choice, Clash, NoQuestions, Questions
from posopt_gui.controllers.report import picture_bytes, report_of
from posopt_gui.controllers.session import CLOSING_TIME, Message, Session
from posopt_gui.document.project import ProjectState, state_of_cell
from posopt_gui.document.project_file import SUFFIX, load_project, project_bytes
from posopt_gui.viewmodels.check_sentences import sentence
from posopt_gui.viewmodels.error_words import file_words
from posopt_gui.workers.jobs import JobLine
from posopt_gui.workers.threads import JobThreads
from solver.errors import InputError, Place, PosoptError
from solver.io.atomic import write_atomically

if TYPE_CHECKING:
    from PySide6.QtGui import QImage

    from posopt_gui.viewmodels.export_model import ExportForm

DEFAULT_CELL: Final = "groove_hw300"
CELL_SUFFIX: Final = ".toml"
RECENT_KEY: Final = "files/recent"
FOLDER_KEY: Final = "files/folder"
RECENT_LIMIT: Final = 10


def state_of_argument(file: str | None) -> tuple[ProjectState, Path | None]:
    """The inputs that a window begins with, and the project file that they came from.

    A path file begins with the default cell, into which it is taken once the window is there.

    Raises
    ------
    InputError
        When the file, or the shipped cell of that name, cannot be read.
    """
    if file is not None and is_path_file(file):
        from solver.io.importers import path_source  # noqa: PLC0415 - loaded when it is needed

        path_source(file)
        file = None
    if file is not None and Path(file).suffix.lower() == SUFFIX:
        path = Path(file).absolute()
        return load_project(path), path
    return state_of_cell(file if file is not None else DEFAULT_CELL), None


class Files(QObject):
    """Knows which file the document is, and asks before unsaved work would be lost.

    `title_changed` tells that the name or the mark of changes is another one; `recent_changed`
    that the list is. `path_taken` tells that a path file was taken into the project;
    `path_refused` carries one that could not be read and the error, for a preview of its columns.
    `typed_wanted` comes before the inputs are saved or left: what is still being typed is to be
    applied; `begun` where they are another project's from here on.
    """

    title_changed = Signal()
    recent_changed = Signal()
    path_taken = Signal()
    path_refused = Signal(object, object)
    report_saved = Signal(object)
    typed_wanted = Signal()
    begun = Signal()

    def __init__(
        self,
        session: Session,
        settings: QSettings,
        ask: Questions | None = None,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(parent or session)
        self._session, self._settings = session, settings
        self.ask: Questions = ask or NoQuestions()
        self._path: Path | None = None
        self._mark: bytes | None = None
        self._pool = JobThreads(2, self)
        self._imports = JobLine(self._pool, self)
        self._imports.done.connect(self._imported)
        self._imports.failed.connect(self._import_failed)
        self._reports = JobLine(self._pool, self)
        self._reports.done.connect(self._reported)
        self._reports.failed.connect(self._failed)
        session.document.history_changed.connect(self.title_changed)

    @property
    def path(self) -> Path | None:
        """The project file, None for one that was never saved."""
        return self._path

    @property
    def name(self) -> str:
        """The project's name for the title."""
        if self._path is not None:
            return self._path.stem
        cell = self._session.document.value("cell.name")
        return str(cell) if cell else self._session.look.tr("Untitled")

    @property
    def modified(self) -> bool:
        """Whether there is work that no file holds."""
        return self._session.document.modified

    @property
    def folder(self) -> Path:
        """Where a person last opened or saved something."""
        kept = self._settings.value(FOLDER_KEY, "", type=str)
        if isinstance(kept, str) and kept and Path(kept).is_dir():
            return Path(kept)
        return first_folder()

    @property
    def recent(self) -> tuple[Path, ...]:
        """Files that were opened or saved, the last one first."""
        text = self._settings.value(RECENT_KEY, "[]", type=str)
        try:
            found = json.loads(str(text))
        except ValueError:
            return ()
        if not isinstance(found, list):
            return ()
        return tuple(Path(one) for one in found if isinstance(one, str))[:RECENT_LIMIT]

    def clear_recent(self) -> None:
        """Forget the list."""
        self._settings.setValue(RECENT_KEY, "[]")
        self.recent_changed.emit()

    def opened(self, path: Path | None, mark: bytes | None = None) -> None:
        """Take note of the file that the document was read from, and of its mark before that."""
        self._path = path
        if path is not None:
            self._mark = mark_of(path) if mark is None else mark
            self._note(path)
        self.title_changed.emit()

    def new(self) -> bool:
        """Begin with the default cell; False where the person keeps the old one."""
        if not self._may_leave():
            return False
        self._begin(state_of_cell(DEFAULT_CELL), None)
        return True

    def open(self) -> bool:
        """Ask for a project, a cell or a path, and open it."""
        name = self.ask.open_name(str(self.folder))
        return bool(name) and self.open_file(Path(name))

    def open_file(self, path: Path) -> bool:
        """Open a project or a cell, or take a path file into the project.

        False where it cannot be read or the old project is kept. A path file is read off the
        window's thread; `path_taken` or `path_refused` says what came of it.
        """
        path = Path(path).absolute()
        suffix = path.suffix.lower()
        if suffix in PATH_SUFFIXES:
            self.import_path(path)
            return True
        if suffix not in {SUFFIX, CELL_SUFFIX}:
            words = "is no project ({project}), cell ({cell}) or path ({paths})"
            known = ", ".join(PATH_SUFFIXES)
            text = self._session.look.tr(words, project=SUFFIX, cell=CELL_SUFFIX, paths=known)
            self._say(InputError(text, Place(path.name)))
            return False
        return self._open(path, project=suffix == SUFFIX)

    def _open(self, path: Path, *, project: bool) -> bool:
        # Before it is read: what is written meanwhile is another one's, too.
        mark = mark_of(path) if project else None
        try:
            state = load_project(path) if project else state_of_cell(path)
        except PosoptError as error:
            self._say(error)
            self._forget(path)
            return False
        if not self._may_leave():
            return False
        self._begin(state, path if project else None, mark)
        self._note(path)
        return True

    def save(self) -> bool:
        """Save under the name that the project has, or ask for one."""
        self.typed_wanted.emit()
        if self._path is None:
            return self.save_as()
        mark = mark_of(self._path)
        if mark is not None and mark != self._mark:
            match self.ask.written_meanwhile(self._path.name):
                case Clash.OTHER_NAME:
                    return self.save_as()
                case Clash.CANCEL:
                    return False
        return self._save(self._path)

    def save_as(self) -> bool:
        """Ask for a name and save under it."""
        self.typed_wanted.emit()
        proposal = self._path or self.folder / f"{self.name}{SUFFIX}"
        name = self.ask.save_name(str(proposal), SUFFIX)
        return bool(name) and self._save(with_suffix(Path(name), SUFFIX))

    def drop(self, file: str | Path) -> bool:
        """Open what was dropped on the window."""
        return self.open_file(Path(file))

    def import_path(self, path: Path) -> None:
        """Make a path file the project's path, once it was read and found to be of use."""
        state = self._session.document.state
        self._imports.submit(lambda _: path_for(state, path))

    def may_close(self) -> bool:
        """Whether nothing would be lost; asks the person where something would."""
        return self._may_leave()

    def ended(self) -> bool:
        """Stop what still runs; False where it has not ended in time."""
        self._imports.close()
        self._reports.close()
        return self._pool.wait(CLOSING_TIME)

    def guide(self) -> str:
        """Where the user guide is; '' and a sentence where it is not there."""
        found = guide_file()
        if found is not None:
            return str(found)
        words = self._session.look.tr("The guide is missing; install posopt again.")
        self._session.say(Message("warning", words))
        return ""

    def save_report(self, pictures: Mapping[str, QImage], form: ExportForm | None = None) -> bool:
        """Ask for a name, and write the HTML report of the shown sequence.

        False where no name was given, and where the sequence is not that of the inputs, pins and
        regions as they are now.
        """
        result = self._session.settled_result
        if result is None:
            words = (
                "No report is saved: there is no sequence for the inputs, pins and forbidden "
                "regions as they are now."
            )
            self._session.say(Message("warning", self._session.look.tr(words)))
            return False
        proposal = self.folder / f"{result.problem.program.name}_report.html"
        name = self.ask.save_name(str(proposal), ".html")
        if not name:
            return False
        path = with_suffix(Path(name), ".html")
        self._settings.setValue(FOLDER_KEY, str(path.parent))
        found = {key: picture_bytes(image) for key, image in pictures.items()}
        language = self._session.look.language
        self._reports.submit(
            lambda monitor: report_of(result, path, found, language, form, monitor)
        )
        return True

    def _may_leave(self) -> bool:
        self.typed_wanted.emit()
        if not self.modified:
            return True
        match self.ask.unsaved(self.name):
            case Choice.SAVE:
                return self.save()
            case Choice.DISCARD:
                return True
            case _:
                return False

    def _begin(self, state: ProjectState, path: Path | None, mark: bytes | None = None) -> None:
        self._imports.stop()
        self.begun.emit()
        self._path, self._mark = path, mark
        self._session.open(state)
        self._session.start()
        self.title_changed.emit()

    def _save(self, path: Path) -> bool:
        path = path.absolute()
        try:
            data = project_bytes(self._session.document.state)
            write_atomically(path, data)
        except (PosoptError, ValueError, TypeError) as error:
            self._failed(error)
            return False
        self._path, self._mark = path, hashlib.sha256(data).digest()
        self._session.document.mark_saved()
        self._note(path)
        self.title_changed.emit()
        words = self._session.look.tr("{name} was saved.", name=path.name)
        self._session.say(Message("info", words))
        return True

    def _note(self, path: Path) -> None:
        rest = [one for one in self.recent if one != path]
        self._set_recent([path, *rest][:RECENT_LIMIT])
        self._settings.setValue(FOLDER_KEY, str(path.parent))

    def _forget(self, path: Path) -> None:
        if path in self.recent and not path.exists():
            self._set_recent([one for one in self.recent if one != path])

    def _set_recent(self, paths: list[Path]) -> None:
        self._settings.setValue(RECENT_KEY, json.dumps([str(one) for one in paths]))
        self.recent_changed.emit()

    def _imported(self, found: tuple[str, bytes]) -> None:
        name, data = found
        document = self._session.document
        document.edit("Path", state_with_path(document.state, name, data))
        words = self._session.look.tr("The path is now that of {name}.", name=name)
        self._session.say(Message("info", words))
        self.path_taken.emit()

    def _import_failed(self, failure: object) -> None:
        if isinstance(failure, PathError):
            self._say(failure.error)
            self.path_refused.emit(failure.path, failure.error)
        else:
            self._failed(failure)

    def _reported(self, path: Path) -> None:
        words = self._session.look.tr("{name} was saved.", name=path.name)
        self._session.say(Message("info", words))
        self.report_saved.emit(path)

    def _failed(self, error: object) -> None:
        if isinstance(error, PosoptError):
            self._say(error)
            return
        words = "posopt met a defect of its own and kept your work; please report it: {error}"
        text = self._session.look.tr(words, error=f"{type(error).__name__}: {error}")
        self._session.say(Message("error", text))

    def _say(self, error: PosoptError) -> None:
        self._session.say(Message("error", self._words_of(error)))

    def _words_of(self, error: PosoptError) -> str:
        """An error as a sentence that names its file, or the field of the form."""
        tr = self._session.look.tr
        place = error.place if isinstance(error, InputError) else None
        if not isinstance(error, InputError) or place is None:
            return sentence(str(error), tr)
        # The form takes a moment to load, which only an error costs.
        from posopt_gui.viewmodels.input_words import input_words  # noqa: PLC0415
        from posopt_gui.viewmodels.project_files import PROJECT  # noqa: PLC0415

        if place.file == PROJECT:
            return input_words(error, self._session.document.state.cell, tr)
        return sentence(f"{file_words(place, tr)}: {error.message}", tr)


def with_suffix(path: Path, suffix: str) -> Path:
    """The path with a suffix, unless it has it already."""
    return path if path.suffix.lower() == suffix else path.with_name(path.name + suffix)
