"""The session: inputs, plan, wishes, selection. Views talk to it and to nothing else."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer, SignalInstance

from posopt_gui.controllers.said import Hover as Hover  # noqa: PLC0414 - told from here
from posopt_gui.controllers.said import Message as Message  # noqa: PLC0414 - told from here
from posopt_gui.controllers.session_jobs import Planned, answered_by, checked_by, planned_by
from posopt_gui.controllers.session_state import SessionState
from posopt_gui.document.document import Document
from posopt_gui.document.project import ProjectState
from posopt_gui.look import Look
from posopt_gui.workers.follow_ups import FollowUps
from posopt_gui.workers.jobs import JobLine
from posopt_gui.workers.threads import JobThreads
from posopt_gui.workers.turns import Turns
from solver.errors import InputError, PosoptError
from solver.model.scheme import Scheme
from solver.model.wishes import Pin, Region

if TYPE_CHECKING:
    from solver.model.problem import PlanningProblem
    from solver.model.toolpath import Toolpath
    from solver.pipeline.program_check import ProgramReport
    from solver.pipeline.replanning import Replanned

BUILD_DELAY = 30
"""How long the session waits for further changes before it reads the inputs [ms]."""

CLOSING_TIME = 10_000
"""How long closing waits for a running job to see that it was cancelled [ms]."""


class Session(SessionState):
    """What is open, what was planned, and what is looked at."""

    def __init__(
        self, document: Document, look: Look | None = None, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self.document = document
        self.look = look or Look(parent=self)
        self.compared: tuple[Scheme, ...] = (Scheme.EXACT, Scheme.F2)
        self.live = False
        self.turns = Turns(self)
        self.follow_ups = FollowUps(self.turns, self)
        self._pool = JobThreads(3, self)
        self._builds = JobLine(self._pool, self, self._built, self._build_failed)
        self._plans = JobLine(self._pool, self, self._planned, self._plan_failed)
        self._wishes = JobLine(self._pool, self, self._answered, self._defect)
        self._checks = JobLine(self.follow_ups, self, self._checked, self._check_failed)
        self._plans.progress.connect(self.progress)
        self._plans.busy_changed.connect(self.planning_changed)
        self._planned_state: ProjectState | None = None
        self._path: Toolpath | None = None
        self._ordered = document.state
        self._asked: tuple[tuple[Pin, ...], tuple[Region, ...]] = ((), ())
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setInterval(BUILD_DELAY)
        self._timer.timeout.connect(self._build)
        self._seen = document.state
        for signal in (self.state_changed, self.result_changed, self._wishes.busy_changed):
            signal.connect(self._tell_answering)
        document.changed.connect(self._on_document)

    @property
    def planning(self) -> bool:
        """Whether a plan is being made."""
        return self._plans.busy

    def open(self, state: ProjectState, *, saved: bool = True) -> None:
        """Begin with another project; nothing of the one before stays."""
        for line in (self._builds, self._plans, self._wishes, self._checks):
            line.stop()
        self._problem = self._problem_error = self._plan_error = self._path = None
        self._result = self._answer = self._report = self._check_error = None
        self._planned_state = None
        self._asked = ((), ())
        self._place = 0.0
        self.set_hover(None)
        self.keep(None)
        self.document.reset(state, saved=saved)
        self.opened.emit()
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
        """Cancel planning; the plan that stays is checked where planning had stopped its check."""
        self._plans.stop()
        self._check_again()

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
        self.keep(None)
        self.place_changed.emit(place)
        if self.cursor != before:
            self.cursor_changed.emit(self.cursor)

    def set_hover(self, hover: Hover | None) -> None:
        """Point at a candidate."""
        if hover != self._hover:
            self._hover = hover
            self.hover_changed.emit(hover)

    def look_at(self, candidate: Hover) -> None:
        """Look at a candidate that the sequence does not pass, until the place changes."""
        self.set_cursor(candidate.waypoint)
        self.keep(candidate)

    def keep(self, candidate: Hover | None) -> None:
        """Keep looking at a candidate, None at the sequence."""
        if candidate != self._kept:
            self._kept = candidate
            self.kept_changed.emit(candidate)

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
        if result is None:
            return
        self._checks.submit(lambda monitor: checked_by(result, monitor))

    def say(self, message: Message) -> None:
        """Show a sentence."""
        self.message.emit(message)

    def close(self) -> bool:
        """Cancel everything and wait for it; False where a job has not ended in time."""
        self._timer.stop()
        self.turns.clear()
        for line in (self._builds, self._plans, self._wishes, self._checks):
            line.close()
        ended = self._pool.wait(CLOSING_TIME)
        return self.follow_ups.close(CLOSING_TIME) and ended

    def _on_document(self) -> None:
        before, state = self._seen, self.document.state
        self._seen = state
        previewed, self._previewing = self._previewing, False
        self.state_changed.emit()
        if _inputs(before) != _inputs(state):
            self._timer.start()
        self._update_stale()
        if (state.pins, state.regions) != self._asked and not self._stale:
            self._ask(state.pins, state.regions)
        elif previewed and not self._wishes.busy:
            # What was let go of has its answer already; only now it counts, and is checked.
            self.result_changed.emit()
            self.check()
        else:
            self._check_again()

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
        if self._is_left(planned.state):
            self._check_again()
            return
        # An answer that is still being worked out belongs to the plan before.
        self._wishes.stop()
        self._checks.stop()
        self.set_hover(None)
        self.keep(None)
        self._asked = self._answered_wishes = (planned.state.pins, planned.state.regions)
        self._tell_moved_pins(planned)
        self._planned_state, self._result = planned.state, planned.result
        self._answer, self._plan_error = planned.answer, None
        self._report = self._check_error = None
        self._update_stale()
        self._announce_result()
        wishes = (planned.state.pins, planned.state.regions)
        if wishes != (self.document.state.pins, self.document.state.regions):
            self.end_preview()
        self.check()

    def _is_left(self, state: ProjectState) -> bool:
        """Whether a plan of these inputs came too late: they were left for those of a plan."""
        fits = self._result is not None and not self._stale
        return fits and _inputs(state) != _inputs(self.document.state)

    def _tell_moved_pins(self, planned: Planned) -> None:
        """A pin holds the number of a waypoint: say where that is another place now."""
        before, self._path = self._path, planned.result.problem.toolpath
        pins = planned.state.pins
        if before is None or not pins:
            return
        # Loaded when there are pins, not before the window shows.
        from posopt_gui.viewmodels.wish_words import moved_pins, moved_words  # noqa: PLC0415

        moved = moved_pins(before, self._path, pins)
        if moved:
            self.say(Message("warning", moved_words(moved, self.look.tr), moved[0]))

    def _plan_failed(self, error: object) -> None:
        if not isinstance(error, PosoptError):
            self._defect(error)
            return
        if self._is_left(self._ordered):
            self._check_again()
            return
        if isinstance(error, InputError):
            self._plan_refused(error)
            return
        self._wishes.stop()
        self._checks.stop()
        self.set_hover(None)
        self.keep(None)
        self._plan_error = error
        self._result = self._answer = self._report = self._check_error = None
        self._planned_state = self._ordered
        self._update_stale()
        self._announce_result()
        # Loaded when something went wrong, not before the window shows.
        from posopt_gui.viewmodels.trouble_model import plan_words  # noqa: PLC0415

        self.message.emit(Message("error", plan_words(error, self.look.tr)))

    def _plan_refused(self, error: InputError) -> None:
        """Wrong inputs are no answer to a plan: the one before stays, and is out of date."""
        from posopt_gui.viewmodels.input_words import input_words  # noqa: PLC0415

        if _inputs(self._ordered) != _inputs(self.document.state):
            return
        self._problem, self._problem_error = None, error
        self._announce(self.problem_changed)
        words = input_words(error, self.document.state.cell, self.look.tr)
        self.message.emit(Message("error", words))
        self._check_again()

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
        self._answer, self._answered_wishes = answer, self._asked
        self._report = self._check_error = None
        self.result_changed.emit()
        self.check_changed.emit()
        # While a pin is being dragged the next answer is already on its way.
        if not self._previewing:
            self.check()

    def _check_again(self) -> None:
        """Check what has lost its check to planning that came to nothing."""
        known = self._report is not None or self._check_error is not None
        if not known and not self._stale and not self.planning and not self._checks.busy:
            self.check()

    def _checked(self, report: ProgramReport) -> None:
        self._report = report
        self.check_changed.emit()

    def _check_failed(self, error: object) -> None:
        if not isinstance(error, PosoptError):
            self._defect(error)
            return
        # A check that cannot be completed has failed.
        self._check_error = error
        self.check_changed.emit()
        self.message.emit(Message("warning", self._words_of(error)))

    def _words_of(self, error: PosoptError) -> str:
        # Loaded when something went wrong, not before the window shows.
        from posopt_gui.viewmodels.error_words import error_words  # noqa: PLC0415

        return error_words(error, self.look.tr)

    def _defect(self, error: object) -> None:
        text = f"{type(error).__name__}: {error}"
        words = "posopt met a defect of its own and kept your work; please report it: {text}"
        self.message.emit(Message("error", self.look.tr(words, text=text)))


def _inputs(state: ProjectState) -> tuple[object, object]:
    return state.cell, state.files
