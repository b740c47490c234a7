"""What a session holds and tells: read by all views, changed by the session alone."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from posopt_gui.controllers.said import Hover
from solver.model.scheme import Scheme

if TYPE_CHECKING:
    from posopt_gui.document.document import Document
    from posopt_gui.workers.jobs import JobLine
    from solver.analysis.result import PlanningResult, Sequence
    from solver.errors import PosoptError
    from solver.model.problem import PlanningProblem
    from solver.model.wishes import Pin, Region
    from solver.pipeline.program_check import ProgramReport
    from solver.pipeline.replanning import Replanned


class SessionState(QObject):
    """Problem, plan, answer to the wishes, checks, place and what is pointed at."""

    state_changed = Signal()
    problem_changed = Signal()
    result_changed = Signal()
    stale_changed = Signal(bool)
    cursor_changed = Signal(int)
    hover_changed = Signal(object)
    kept_changed = Signal(object)
    place_changed = Signal(float)
    planning_changed = Signal(bool)
    progress = Signal(str, int, int)
    message = Signal(object)
    check_changed = Signal()
    answering_changed = Signal(bool)
    opened = Signal()

    document: Document
    _wishes: JobLine

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._problem: PlanningProblem | None = None
        self._problem_error: PosoptError | None = None
        self._plan_error: PosoptError | None = None
        self._result: PlanningResult | None = None
        self._answer: Replanned | None = None
        self._report: ProgramReport | None = None
        self._check_error: PosoptError | None = None
        self._stale = self._previewing = self._told_answering = False
        self._answered_wishes: tuple[tuple[Pin, ...], tuple[Region, ...]] = ((), ())
        self._place = 0.0
        self._hover: Hover | None = None
        self._kept: Hover | None = None

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
        """The plan with the shown sequence as its own; None where none keeps to the wishes."""
        if self._result is None or self._answer is None:
            return self._result
        if self._answer.sequence is None:
            return None
        sequences = {**self._result.sequences, Scheme.EXACT: self._answer.sequence}
        return replace(self._result, sequences=sequences, scheme=Scheme.EXACT)

    @property
    def settled_result(self) -> PlanningResult | None:
        """The chosen result where it is that of the inputs, pins and regions as they are now.

        This alone is exported and reported: None while anything of it is out of date, is still
        being answered, or is only tried by a drag.
        """
        return None if self._stale or self.answering else self.chosen_result

    @property
    def answering(self) -> bool:
        """Whether the shown sequence is not (yet) the answer to the document's wishes."""
        if self._result is None:
            return False
        wishes = (self.document.state.pins, self.document.state.regions)
        return self._previewing or self._wishes.busy or self._answered_wishes != wishes

    def _tell_answering(self, *_: object) -> None:
        answering = self.answering
        if answering != self._told_answering:
            self._told_answering = answering
            self.answering_changed.emit(answering)

    @property
    def report(self) -> ProgramReport | None:
        """Checks of the program of the shown sequence."""
        return self._report

    @property
    def check_error(self) -> PosoptError | None:
        """Why the checks could not be completed, and so have failed."""
        return self._check_error

    @property
    def stale(self) -> bool:
        """Whether inputs changed since the plan."""
        return self._stale

    @property
    def previewing(self) -> bool:
        """Whether the shown sequence answers a pin that is still being dragged."""
        return self._previewing

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
    def kept(self) -> Hover | None:
        """The candidate that was chosen to be looked at, until the place changes."""
        return self._kept

    @property
    def waypoints(self) -> int:
        """Number of waypoints of the plan, or of the path."""
        if self._result is not None:
            return len(self._result.problem.toolpath)
        return len(self._problem.toolpath) if self._problem is not None else 0
