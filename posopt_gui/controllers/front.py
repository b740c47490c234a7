"""The front of clearance against joint motion: worked out when it is looked at, and taken from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

from PySide6.QtCore import QObject, Signal

from posopt_gui.controllers.session import Message
from posopt_gui.viewmodels.error_words import error_words
from posopt_gui.viewmodels.front_model import FrontModel, Mark, front_model, present_mark
from posopt_gui.workers.jobs import JobLine
from posopt_gui.workers.threads import JobThreads
from solver.errors import PosoptError
from solver.model.scheme import Scheme

if TYPE_CHECKING:
    from posopt_gui.controllers.session import Session
    from posopt_gui.document.project import ProjectState

SAFETY_KEY: Final = "settings.safety_distance_mm"
SCHEME_KEY: Final = "settings.scheme"

WITHOUT_EFFECT: Final = frozenset({"safety_distance_mm", "scheme", "heuristic_weight", "seed"})
"""Settings on which the front does not depend: it holds the plans of all safety distances."""

TAKES: Final = 200
"""Most states at either end of a taken plan that are remembered."""


class Front(QObject):
    """The front of the session's plan; it knows no widgets.

    `changed` tells of another front, of inputs that have changed since, and of a stop;
    `progress(done, total)` of the work.
    """

    changed = Signal()
    progress = Signal(int, int)

    def __init__(self, session: Session, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._pool = JobThreads(1, self)
        self._line = JobLine(self._pool, self)
        self._line.done.connect(self._on_done)
        self._line.failed.connect(self._on_failed)
        self._line.progress.connect(lambda _, done, total: self.progress.emit(done, total))
        self._line.busy_changed.connect(self.changed)
        self._model: FrontModel | None = None
        self._key: object = None
        self._asked: object = None
        self._wanted = self._stopped = False
        self._ends: list[ProjectState] = []
        self._planned_for: ProjectState | None = None
        session.result_changed.connect(self._on_result)
        # After the session, so that it knows already whether its plan is stale.
        session.document.changed.connect(self._on_document)
        session.stale_changed.connect(self._plan_again)

    @property
    def model(self) -> FrontModel | None:
        """The front, None while there is none."""
        return self._model

    @property
    def busy(self) -> bool:
        """Whether it is being worked out."""
        return self._line.busy

    @property
    def stale(self) -> bool:
        """Whether what is shown is the front of other inputs."""
        return self._model is not None and self._key != front_key(self._session.document.state)

    @property
    def stopped(self) -> bool:
        """Whether a person has stopped it."""
        return self._stopped

    @property
    def present(self) -> Mark | None:
        """Where the shown plan stands beside the front."""
        if self._model is None:
            return None
        return present_mark(self._model, self._session.sequence)

    def want(self, wanted: bool) -> None:
        """Work it out from now on whenever there is a new plan, or do not."""
        self._wanted = wanted
        if wanted:
            self._begin()
        else:
            self._line.stop()

    def ask(self) -> None:
        """Work it out although it was stopped."""
        self._stopped = False
        self._begin()

    def stop(self) -> None:
        """Give up working it out, until it is asked for or there is another plan."""
        if self._line.busy:
            self._stopped = True
            self._line.stop()

    def take(self, index: int) -> bool:
        """Change the document so that it plans a point; False where that cannot be."""
        model, document = self._model, self._session.document
        if model is None or self.stale or not 0 <= index < len(model):
            return False
        before = document.state
        minimum = float(model.minimum[index])
        after = before.with_value(SAFETY_KEY, minimum)
        after = after.with_value(SCHEME_KEY, Scheme.EXACT.value)
        after = replace(after, pins=(), regions=())
        if after == before and not self._session.stale:
            return True
        self._ends = [*self._ends, before, after][-TAKES:]
        document.edit("Plan from the front", after)
        self._tell(minimum, wishes=bool(before.pins or before.regions))
        return True

    def close(self) -> None:
        """Cancel what is being worked out and wait for it."""
        self._line.close()
        self._pool.wait()

    def _tell(self, minimum: float, *, wishes: bool) -> None:
        tr = self._session.look.tr
        words = tr("Taken from the front: safety distance {value} mm.", value=f"{minimum:g}")
        if wishes:
            words += " " + tr("Pins and forbidden regions were taken away.")
        self._session.say(Message("info", words))

    def _begin(self) -> None:
        session = self._session
        result, key = session.result, front_key(session.document.state)
        if not self._wanted or self._stopped or result is None or session.stale:
            return
        if key == self._key or (self._line.busy and key == self._asked):
            return
        self._asked = key
        self._line.submit(lambda monitor: (key, front_model(result, monitor)))
        self.changed.emit()

    def _on_result(self) -> None:
        if self._session.result is None:
            self._line.stop()
            self._model, self._key = None, None
        elif front_key(self._session.document.state) != self._asked:
            self._stopped = False
        self._begin()
        self.changed.emit()

    def _on_document(self) -> None:
        if self._line.busy and front_key(self._session.document.state) != self._asked:
            self._line.stop()
        self._plan_again()
        self._begin()
        self.changed.emit()

    def _plan_again(self, *_: object) -> None:
        """Plan what was taken, and plan again what undo and redo of that bring back."""
        session = self._session
        state = session.document.state
        if not session.stale or state not in self._ends:
            return
        if session.planning and self._planned_for is state:
            return
        self._planned_for = state
        session.plan()

    def _on_done(self, answer: tuple[object, FrontModel | None]) -> None:
        self._key, self._model = answer
        self.changed.emit()

    def _on_failed(self, error: object) -> None:
        tr = self._session.look.tr
        if isinstance(error, PosoptError):
            self._session.say(Message("warning", error_words(error, tr)))
        else:
            words = "posopt met a defect of its own and kept your work; please report it: {text}"
            text = f"{type(error).__name__}: {error}"
            self._session.say(Message("error", tr(words, text=text)))
        self._stopped = True
        self.changed.emit()


def front_key(state: ProjectState) -> object:
    """What the front of a project depends on; alike keys have the same front."""
    cell: Mapping[str, Any] = state.cell
    settings = cell.get("settings")
    if isinstance(settings, Mapping):
        kept = {name: one for name, one in settings.items() if name not in WITHOUT_EFFECT}
        cell = {**cell, "settings": kept}
    return cell, state.files, state.folder
