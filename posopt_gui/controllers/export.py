"""The export: drafts and checks the program of the shown sequence, and writes it."""

from __future__ import annotations

import threading
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, QTimer, Signal

from posopt_gui.controllers.folders import first_folder
from posopt_gui.controllers.session import CLOSING_TIME, Message, Session
from posopt_gui.viewmodels.error_words import file_error_words
from posopt_gui.viewmodels.export_model import (
    ExportForm,
    ExportStage,
    Situation,
    format_of,
    override_target,
    with_suffix,
)
from posopt_gui.workers.jobs import JobLine
from posopt_gui.workers.threads import JobThreads
from solver.errors import PosoptError

if TYPE_CHECKING:
    from solver.analysis.result import PlanningResult
    from solver.pipeline.programming import ProgramDraft, WrittenProgram
    from solver.progress import Monitor

DRAFT_DELAY = 120
"""How long the export waits for further changes before it drafts the program again [ms]."""


class Exporter(QObject):
    """The program of the session's plan, as it would be written, and the writing of it.

    Nothing is drafted while nobody looks: see `set_active`. `changed` tells that `situation` is
    another one; `written` carries a WrittenProgram.
    """

    changed = Signal()
    progress = Signal(str, int, int)
    written = Signal(object)

    def __init__(self, session: Session, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._now = Situation()
        self._active = False
        self._named = False
        self._folder = first_folder()
        self._key: tuple[object, ...] | None = None
        self._written_of: tuple[object, ...] | None = None
        self._formed_for: tuple[object, object] | None = None
        self._stamped = ""
        self._pool = JobThreads(2, self)
        self._drafts = JobLine(self._pool, self, self._drafted, self._draft_failed)
        self._orders = JobLine(self._pool, self, self._order_checked, self._defect)
        self._writes = JobLine(self._pool, self, self._wrote, self._write_failed)
        self._drafts.progress.connect(self.progress)
        self._writes.progress.connect(self.progress)
        self._writes.busy_changed.connect(self._writing_ended)
        self._stop = threading.Event()
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setInterval(DRAFT_DELAY)
        self._timer.timeout.connect(self._submit)
        session.result_changed.connect(self.refresh)
        session.problem_changed.connect(self.refresh)
        session.stale_changed.connect(self.refresh)
        session.planning_changed.connect(self.refresh)
        session.answering_changed.connect(self.refresh)
        session.opened.connect(self._begin_anew)

    @property
    def situation(self) -> Situation:
        """Where the export stands."""
        return self._now

    @property
    def form(self) -> ExportForm:
        """What was chosen."""
        return self._now.form

    @property
    def form_of_plan(self) -> ExportForm | None:
        """What was chosen for the plan as it is shown now, None where it was for another one."""
        plan = (self._session.result, self._session.answer)
        return self.form if self._formed_for == plan else None

    @property
    def program(self) -> tuple[object, ...] | None:
        """What the shown program is made of and where it goes, to be compared; None without one."""
        key = self._wanted()
        return None if key is None else (*key, self.form.path, self.form.reason.strip())

    @property
    def folder(self) -> Path:
        """The folder in which programs are proposed."""
        return Path(self.form.path).parent if self.form.path else self._folder

    def set_folder(self, folder: Path) -> None:
        """Propose programs in another folder, unless a file was named already."""
        self._folder = folder
        if not self._named and self.form.path:
            path = str(folder / Path(self.form.path).name)
            self._set_form(replace(self.form, path=path))

    def set_active(self, active: bool) -> None:
        """Begin to draft, or stop while nobody looks."""
        self._active = active
        if active:
            self.refresh()
        else:
            self._timer.stop()
            self._drafts.stop()
            self._orders.stop()
            self._key = None

    def _begin_anew(self) -> None:
        """Nothing that was chosen for one project holds for another."""
        for line in (self._drafts, self._orders):
            line.stop()
        self._timer.stop()
        self._named, self._stamped = False, ""
        self._key = self._formed_for = None
        # What is being written goes on, and is told of as another program than the shown one.
        self._now = Situation(writing=self._now.writing)
        self.refresh()

    def set_post(self, post: str) -> None:
        """Choose the kind of file; the name keeps its stem."""
        path = with_suffix(self.form.path, post)
        self._set_form(replace(self.form, post=format_of(post).post, path=path))

    def set_path(self, path: str) -> None:
        """Name the file."""
        self._named = True
        self._set_form(replace(self.form, path=path))

    def set_simplify(self, tolerance: float | None) -> None:
        """Drop positions within a tolerance [m]; None keeps all."""
        self._set_form(replace(self.form, simplify=tolerance))

    def set_accepted(self, clearance: float | None) -> None:
        """Accept a clearance below the safety distance [m]."""
        self._set_form(replace(self.form, accepted=clearance))

    def set_reason(self, reason: str) -> None:
        """Type the reason for writing although checks fail."""
        self._set_form(replace(self.form, reason=reason))

    def _set_form(self, form: ExportForm) -> None:
        if form != self.form:
            self._set(form=form, order_fault=None, reason_fault="", write_fault="")
            self.refresh()

    def target(self, *, override: bool = False) -> Path:
        """The main file that an export writes."""
        return override_target(self.form.path) if override else Path(self.form.path)

    def refresh(self) -> None:
        """Compare with the session, and draft again where something differs."""
        if not self._active:
            return
        if self._now.writing:
            # What changed meanwhile is looked at when the writing has ended.
            return
        self._follow()
        key = self._wanted()
        if key is not None:
            self._formed_for = (self._session.result, self._session.answer)
        if key is None or key != self._key:
            # What is still being drafted or looked at belongs to another program.
            self._drafts.stop()
            self._orders.stop()
            self._timer.stop()
            self._key = key
            self._set(current=False, fault="")
            if key is not None:
                self._set(order_fault=None, write_fault="")
                self._timer.start()
        elif self._now.order_fault is None:
            self._check_order()
            self._stamp_reason()
        self._set(outdated=self.program != self._written_of)
        self.changed.emit()

    def _stamp_reason(self) -> None:
        """Draft again with the reason in it; the checks stay as they are."""
        draft = self._now.draft
        if draft is not None and draft.report.failed and self._reason != self._stamped:
            self._timer.start()

    @property
    def _reason(self) -> str:
        return self.form.reason.strip() if self.form.reason_given else ""

    def _follow(self) -> None:
        session = self._session
        result, answer = session.result, session.answer
        values: dict[str, Any] = {
            "planned": result is not None,
            "planning": session.planning,
            "stale": session.stale,
            "answering": session.answering,
            "blocked": answer.reason if answer is not None and answer.sequence is None else "",
        }
        if result is None:
            values["draft"] = None
        else:
            shown = session.sequence
            values["least"] = shown.least_clearance if shown is not None else 0.0
            values["required"] = result.problem.settings.safety_distance
            values["tolerance"] = result.problem.program.path_tolerance
            if not self._named:
                name = result.problem.program.name.upper() + format_of(self.form.post).suffix
                values["form"] = replace(self.form, path=str(self._folder / name))
        self._set(**values)

    def _wanted(self) -> tuple[object, ...] | None:
        """What a draft would be made of, None where none can be made."""
        session, form = self._session, self.form
        if session.planning or session.settled_result is None:
            return None
        parts = (form.post, form.simplify, form.accepted, Path(form.path).stem)
        return (session.result, session.answer, *parts)

    def _submit(self) -> None:
        result, form = self._session.settled_result, self.form
        if result is None or self._key is None or self._wanted() != self._key:
            return
        self._stamped = self._reason
        self._drafts.submit(lambda monitor: _draft(result, form, monitor))
        self._check_order()

    def _check_order(self) -> None:
        result, form = self._session.settled_result, self.form
        if result is not None:
            self._orders.submit(lambda _: _order_faults(result, form))

    def export(self, *, override: bool = False) -> None:
        """Write the program; with `override` although checks fail, for the typed reason.

        Nothing is written but what is shown: a plan or wishes that changed are drafted first.
        """
        self.refresh()
        wanted = ExportStage.REFUSED if override else ExportStage.PASSED
        result, form = self._session.settled_result, self.form
        if result is None or self._now.stage is not wanted or self._now.order_fault != "":
            return
        if self._key is None or self._wanted() != self._key:
            return
        self._stop = threading.Event()
        stop = self._stop
        self._written_of = self.program
        self._set(writing=True, written=None, write_fault="", outdated=False)
        self._writes.submit(
            lambda monitor: _write(result, form, _Stoppable(monitor, stop), override=override)
        )
        self.changed.emit()

    def stop(self) -> None:
        """Ask to give up the writing; it says so, or that it had ended already."""
        self._stop.set()

    def close(self) -> bool:
        """Cancel everything and wait for it; False where a job has not ended in time."""
        self._active = False
        self._timer.stop()
        for line in (self._drafts, self._orders, self._writes):
            line.close()
        return self._pool.wait(CLOSING_TIME)

    def _drafted(self, draft: ProgramDraft) -> None:
        self._set(draft=draft, current=True, fault="")
        self.changed.emit()

    def _draft_failed(self, error: object) -> None:
        if not isinstance(error, PosoptError):
            self._defect(error)
            return
        self._set(draft=None, current=True, fault=str(error))
        self.changed.emit()

    def _order_checked(self, faults: _OrderFaults) -> None:
        if faults.form == self.form:
            self._set(order_fault=faults.path, reason_fault=faults.reason)
            self.changed.emit()

    def _wrote(self, written: WrittenProgram) -> None:
        self._set(written=written, outdated=self.program != self._written_of)
        self.written.emit(written)
        self.changed.emit()

    def _write_failed(self, error: object) -> None:
        if isinstance(error, PosoptError):
            self._set(write_fault=str(error))
            self._session.say(Message("error", file_error_words(error, self._session.look.tr)))
            self.changed.emit()
        else:
            self._defect(error)

    def _writing_ended(self, busy: bool) -> None:
        if not busy:
            self._set(writing=False)
            self.refresh()

    def _defect(self, error: object) -> None:
        text = f"{type(error).__name__}: {error}"
        words = "posopt met a defect of its own and kept your work; please report it: {error}"
        text = self._session.look.tr(words, error=text)
        self._set(current=True, draft=None, fault=text)
        self._session.say(Message("error", text))
        self.changed.emit()

    def _set(self, **values: Any) -> None:
        self._now = replace(self._now, **values)


@dataclass(frozen=True, slots=True)
class _OrderFaults:
    """Why a file cannot be written as a form asks, and why its reason cannot be stamped."""

    form: ExportForm
    path: str
    reason: str


@dataclass(frozen=True, slots=True)
class _Stoppable:
    """A monitor that can be stopped without its answer being dropped."""

    monitor: Monitor
    event: threading.Event

    def report(self, stage: str, done: int, total: int) -> None:
        self.monitor.report(stage, done, total)

    def cancelled(self) -> bool:
        return self.event.is_set() or self.monitor.cancelled()


def _draft(result: PlanningResult, form: ExportForm, monitor: Monitor) -> ProgramDraft:
    from solver.pipeline.programming import draft_program  # noqa: PLC0415 - loads the kernels

    # What is wrong with name or reason is told beside its field; the checks are shown all the same.
    named = not _order_fault(result, form, override=False)
    stamped = named and form.reason_given and not _order_fault(result, form, override=True)
    name = Path(form.path).stem if named else None
    return draft_program(result, form.order(override=stamped), name, monitor)


def _order_faults(result: PlanningResult, form: ExportForm) -> _OrderFaults:
    path = _order_fault(result, form, override=False)
    reason = _order_fault(result, form, override=True) if form.reason_given and not path else ""
    return _OrderFaults(form, path, reason)


def _order_fault(result: PlanningResult, form: ExportForm, *, override: bool) -> str:
    from solver.pipeline.programming import check_order  # noqa: PLC0415 - loads the kernels

    try:
        check_order(result.problem, Path(form.path), form.order(override=override))
    except PosoptError as error:
        return str(error)
    except (OSError, ValueError) as error:
        return f"{form.path}: {error}"
    return ""


def _write(
    result: PlanningResult, form: ExportForm, monitor: Monitor, *, override: bool
) -> WrittenProgram:
    from solver.pipeline.programming import write_program  # noqa: PLC0415 - loads the kernels

    return write_program(result, Path(form.path), form.order(override=override), monitor)
