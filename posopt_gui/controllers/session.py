"""The session: inputs, plan, wishes, selection. Views talk to it and to nothing else."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QThreadPool, QTimer, Signal, SignalInstance

from posopt_gui.controllers.session_jobs import Planned, answered_by, checked_by, planned_by
from posopt_gui.document.document import Document
from posopt_gui.document.project import ProjectState
from posopt_gui.look import Look
from posopt_gui.workers.jobs import JobLine
from solver.errors import PosoptError
from solver.model.settings import Scheme
from solver.model.wishes import Pin, Region

if TYPE_CHECKING:
    from solver.analysis.result import PlanningResult, Sequence
    from solver.model.problem import PlanningProblem
    from solver.pipeline.program_check import ProgramReport
    from solver.pipeline.replanning import Replanned

BUILD_DELAY = 30
"""How long the session waits for further changes before it reads the inputs [ms]."""

CLOSING_TIME = 10_000
"""How long closing waits for a running job to see that it was cancelled [ms]."""


@dataclass(frozen=True, slots=True)
class Hover:
    """A cell of the map: waypoint, orientation, branch slot, and turn where it is one."""

    waypoint: int
    orientation: int
    branch: int
    turn: int | None = None


@dataclass(frozen=True, slots=True)
class Message:
    """A sentence for the person: severity is 'info', 'warning' or 'error'."""

    severity: str
    text: str
    waypoint: int | None = None


class Session(QObject):
    """What is open, what was planned, and what is looked at."""

    state_changed = Signal()
    problem_changed = Signal()
    result_changed = Signal()
    stale_changed = Signal(bool)
    cursor_changed = Signal(int)
    hover_changed = Signal(object)
    place_changed = Signal(float)
    planning_changed = Signal(bool)
    progress = Signal(str, int, int)
    message = Signal(object)
    check_changed = Signal()

    def __init__(
        self, document: Document, look: Look | None = None, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self.document = document
        self.look = look or Look(parent=self)
        self.compared: tuple[Scheme, ...] = (Scheme.EXACT, Scheme.F2)
        self.live = False
        self._pool = QThreadPool(self)
        self._pool.setMaxThreadCount(3)
        self._builds = self._line(self._built, self._build_failed)
        self._plans = self._line(self._planned, self._plan_failed)
        self._wishes = self._line(self._answered, self._defect)
        self._checks = self._line(self._checked, self._check_failed)
        self._plans.progress.connect(self.progress)
        self._plans.busy_changed.connect(self.planning_changed)
        self._problem: PlanningProblem | None = None
        self._problem_error: PosoptError | None = None
        self._plan_error: PosoptError | None = None
        self._result: PlanningResult | None = None
        self._answer: Replanned | None = None
        self._report: ProgramReport | None = None
        self._planned_state: ProjectState | None = None
        self._ordered = document.state
        self._asked: tuple[tuple[Pin, ...], tuple[Region, ...]] = ((), ())
        self._stale = self._previewing = False
        self._place = 0.0
        self._hover: Hover | None = None
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setInterval(BUILD_DELAY)
        self._timer.timeout.connect(self._build)
        self._seen = document.state
        document.changed.connect(self._on_document)

    def _line(self, done: Callable[..., None], failed: Callable[[object], None]) -> JobLine:
        line = JobLine(self._pool, self)
        line.done.connect(done)
        line.failed.connect(failed)
        return line

    @property
    def problem(self) -> PlanningProblem | None:
        """The problem that the inputs state, None where they cannot be used."""
        return self._problem

    @property
    def problem_error(self) -> PosoptError | None:
        """Why the inputs cannot be used."""
        return self._problem_error

    @property
    def plan_error(self) -> PosoptError | None:
        """Why there is no plan for inputs that can be used (an InfeasiblePathError as a rule)."""
        return self._plan_error

    @property
    def result(self) -> PlanningResult | None:
        """The last plan."""
        return self._result

    @property
    def answer(self) -> Replanned | None:
        """The plan under pins and forbidden regions, None where there are none."""
        return self._answer

    @property
    def sequence(self) -> Sequence | None:
        """The sequence that is shown: under the wishes where there are any."""
        if self._answer is not None and self._answer.sequence is not None:
            return self._answer.sequence
        return self._result.sequence if self._result is not None else None

    @property
    def chosen_result(self) -> PlanningResult | None:
        """The plan with the shown sequence as its own: what is exported."""
        if self._result is None or self._answer is None or self._answer.sequence is None:
            return self._result
        sequences = {**self._result.sequences, Scheme.EXACT: self._answer.sequence}
        return replace(self._result, sequences=sequences, scheme=Scheme.EXACT)

    @property
    def report(self) -> ProgramReport | None:
        """Checks of the program of the shown sequence."""
        return self._report

    @property
    def stale(self) -> bool:
        """Whether inputs changed since the plan."""
        return self._stale

    @property
    def planning(self) -> bool:
        """Whether a plan is being made."""
        return self._plans.busy

    @property
    def place(self) -> float:
        """Place of the playback, in waypoints from 0."""
        return self._place

    @property
    def cursor(self) -> int:
        """The waypoint that is looked at, from 0."""
        return round(self._place)

    @property
    def hover(self) -> Hover | None:
        """The candidate under the mouse."""
        return self._hover

    @property
    def waypoints(self) -> int:
        """Number of waypoints of the plan, or of the path."""
        if self._result is not None:
            return len(self._result.problem.toolpath)
        return len(self._problem.toolpath) if self._problem is not None else 0

    def open(self, state: ProjectState, *, saved: bool = True) -> None:
        """Begin with another project; nothing of the one before stays."""
        for line in (self._builds, self._plans, self._wishes, self._checks):
            line.stop()
        self._problem = self._problem_error = self._plan_error = None
        self._result = self._answer = self._report = None
        self._planned_state = None
        self._asked = ((), ())
        self._place = 0.0
        self.set_hover(None)
        self.document.reset(state, saved=saved)
        self.problem_changed.emit()
        self.result_changed.emit()
        self.check_changed.emit()
        self.cursor_changed.emit(0)

    def start(self) -> None:
        """Read the inputs and plan; call it once the window is on screen."""
        self._build()
        self.plan()

    def plan(self) -> None:
        """Plan the current inputs; an older job is cancelled, and its answer dropped."""
        state, schemes = self.document.state, self.compared
        self._ordered = state
        self._checks.stop()
        self._plans.submit(lambda monitor: planned_by(state, schemes, monitor))

    def stop(self) -> None:
        """Cancel planning."""
        self._plans.stop()

    def set_compared(self, schemes: tuple[Scheme, ...]) -> None:
        """Choose the schemes that the next plan searches besides."""
        self.compared = schemes

    def set_cursor(self, waypoint: int) -> None:
        """Look at a waypoint, from 0."""
        self.set_place(float(waypoint))

    def set_place(self, place: float) -> None:
        """Move the playback to a place between waypoints."""
        place = min(max(place, 0.0), max(self.waypoints - 1.0, 0.0))
        if place == self._place:
            return
        before = self.cursor
        self._place = place
        self.place_changed.emit(place)
        if self.cursor != before:
            self.cursor_changed.emit(self.cursor)

    def set_hover(self, hover: Hover | None) -> None:
        """Point at a candidate."""
        if hover != self._hover:
            self._hover = hover
            self.hover_changed.emit(hover)

    def pin(
        self, waypoint: int, lean: float, branch: int | None = None, turn: int | None = None
    ) -> None:
        """Make the sequence pass a lean [rad] at a waypoint."""
        pins = [one for one in self.document.state.pins if one.waypoint != waypoint]
        pins.append(Pin(waypoint, lean, branch, turn))
        pins.sort(key=lambda one: one.waypoint)
        self.document.set_pins(tuple(pins), "Pin")

    def preview_pin(
        self, waypoint: int, lean: float, branch: int | None = None, turn: int | None = None
    ) -> None:
        """Answer as if it were pinned, without a step in the history (while dragging)."""
        state = self.document.state
        pins = tuple(one for one in state.pins if one.waypoint != waypoint)
        self._previewing = True
        self._ask((*pins, Pin(waypoint, lean, branch, turn)), state.regions)

    def end_preview(self) -> None:
        """Go back to the document's own wishes."""
        self._previewing = False
        self._ask(self.document.state.pins, self.document.state.regions)

    def unpin(self, waypoint: int) -> None:
        """Take the pin of a waypoint away."""
        pins = tuple(one for one in self.document.state.pins if one.waypoint != waypoint)
        if pins != self.document.state.pins:
            self.document.set_pins(pins, "Unpin")

    def forbid(self, region: Region) -> None:
        """Forbid a region of the map."""
        self.document.set_regions((*self.document.state.regions, region), "Forbid")

    def allow(self, index: int) -> None:
        """Take a forbidden region away."""
        regions = list(self.document.state.regions)
        if 0 <= index < len(regions):
            del regions[index]
            self.document.set_regions(tuple(regions), "Allow")

    def clear_wishes(self) -> None:
        """Take all pins and regions away, in one step."""
        state = self.document.state
        if state.pins or state.regions:
            self.document.edit("Clear wishes", replace(state, pins=(), regions=()))

    def check(self) -> None:
        """Check the program of the shown sequence, off the window's thread."""
        self._checks.stop()
        result = self.chosen_result
        if result is None or (self._answer is not None and self._answer.sequence is None):
            return
        self._checks.submit(lambda monitor: checked_by(result, monitor))

    def say(self, message: Message) -> None:
        """Show a sentence."""
        self.message.emit(message)

    def close(self) -> bool:
        """Cancel everything and wait for it; False where a job has not ended in time."""
        self._timer.stop()
        for line in (self._builds, self._plans, self._wishes, self._checks):
            line.close()
        return self._pool.waitForDone(CLOSING_TIME)

    def _on_document(self) -> None:
        before, state = self._seen, self.document.state
        self._seen = state
        self.state_changed.emit()
        if _inputs(before) != _inputs(state):
            self._timer.start()
        self._update_stale()
        self._previewing = False
        if (state.pins, state.regions) != self._asked and not self._stale:
            self._ask(state.pins, state.regions)

    def _update_stale(self) -> None:
        planned = self._planned_state
        stale = planned is not None and _inputs(planned) != _inputs(self.document.state)
        if stale != self._stale:
            self._stale = stale
            self.stale_changed.emit(stale)

    def _build(self) -> None:
        self._timer.stop()
        state = self.document.state
        self._builds.submit(lambda _: state.problem())

    def _built(self, problem: PlanningProblem) -> None:
        self._problem, self._problem_error = problem, None
        self._announce(self.problem_changed)
        if self.live and self._stale:
            self.plan()

    def _build_failed(self, error: object) -> None:
        if not isinstance(error, PosoptError):
            self._defect(error)
            return
        self._problem, self._problem_error = None, error
        self._announce(self.problem_changed)

    def _planned(self, planned: Planned) -> None:
        # An answer that is still being worked out belongs to the plan before.
        self._wishes.stop()
        self._checks.stop()
        self._asked = (planned.state.pins, planned.state.regions)
        self._planned_state, self._result = planned.state, planned.result
        self._answer, self._plan_error, self._report = planned.answer, None, None
        self._update_stale()
        self._announce_result()
        wishes = (planned.state.pins, planned.state.regions)
        if wishes != (self.document.state.pins, self.document.state.regions):
            self.end_preview()
        self.check()

    def _plan_failed(self, error: object) -> None:
        if not isinstance(error, PosoptError):
            self._defect(error)
            return
        self._wishes.stop()
        self._checks.stop()
        self._plan_error = error
        self._result = self._answer = self._report = None
        self._planned_state = self._ordered
        self._update_stale()
        self._announce_result()
        self.message.emit(Message("error", str(error)))

    def _announce_result(self) -> None:
        self._announce(self.result_changed, self.check_changed)

    def _announce(self, *signals: SignalInstance) -> None:
        """Tell of another plan or path; the place stays, as far as the path reaches."""
        before, cursor = self._place, self.cursor
        self._place = min(self._place, max(self.waypoints - 1.0, 0.0))
        for signal in signals:
            signal.emit()
        if self._place != before:
            self.place_changed.emit(self._place)
        if self.cursor != cursor:
            self.cursor_changed.emit(self.cursor)

    def _ask(self, pins: tuple[Pin, ...], regions: tuple[Region, ...]) -> None:
        result = self._result
        if result is None:
            return
        self._asked = (pins, regions)
        self._wishes.submit(
            lambda monitor: answered_by(result, pins, regions, monitor), cancel_running=False
        )

    def _answered(self, answer: Replanned | None) -> None:
        self._checks.stop()
        self._answer = answer
        self._report = None
        self.result_changed.emit()
        self.check_changed.emit()
        # While a pin is being dragged the next answer is already on its way.
        if not self._previewing:
            self.check()

    def _checked(self, report: ProgramReport) -> None:
        self._report = report
        self.check_changed.emit()

    def _check_failed(self, error: object) -> None:
        if not isinstance(error, PosoptError):
            self._defect(error)
            return
        self.message.emit(Message("warning", str(error)))

    def _defect(self, error: object) -> None:
        text = f"{type(error).__name__}: {error}"
        words = "posopt met a defect of its own and kept your work; please report it: {text}"
        self.message.emit(Message("error", self.look.tr(words, text=text)))


def _inputs(state: ProjectState) -> tuple[object, object]:
    return state.cell, state.files
