"""What takes a moment to find out about poses, computed off the window's thread."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer, Signal

from posopt_gui.viewmodels.inspector_model import Pose
from posopt_gui.workers.jobs import JobLine
from posopt_gui.workers.threads import JobThreads

if TYPE_CHECKING:
    from posopt_gui.controllers.session import Session
    from solver.analysis.result import PlanningResult, Sequence
    from solver.candidates.explain import Explanation

PAUSE = 40
"""How long a pose has to be looked at before it is explained [ms]."""


class PoseExplainer(QObject):
    """Explains the pose that is looked at; only the newest wish is answered."""

    explained = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._pool = JobThreads(2, self)
        self._line = JobLine(self._pool, self)
        self._line.done.connect(self._on_done)
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setInterval(PAUSE)
        self._timer.timeout.connect(self._start)
        self._wanted: tuple[PlanningResult, Pose] | None = None
        self._explanation: Explanation | None = None
        self._of: tuple[PlanningResult, Pose] | None = None

    def explanation(self, result: PlanningResult, pose: Pose) -> Explanation | None:
        """The explanation of a pose, None while it is not known."""
        if self._of is not None and self._of[0] is result and self._of[1] == pose:
            return self._explanation
        return None

    def ask(self, result: PlanningResult, pose: Pose) -> None:
        """Explain a pose as soon as it is looked at for a moment."""
        if not 0 <= pose.waypoint < len(result.problem.toolpath):
            self.forget()
            return
        if self.explanation(result, pose) is not None:
            self._timer.stop()
            self._wanted = self._of
            return
        wanted = (result, pose)
        if self._wanted is None or self._wanted[0] is not result or self._wanted[1] != pose:
            self._wanted = wanted
            self._timer.start()

    def forget(self) -> None:
        """Nothing is looked at."""
        self._timer.stop()
        self._line.stop()
        self._wanted = self._of = self._explanation = None

    def _start(self) -> None:
        wanted = self._wanted
        if wanted is not None:
            self._line.submit(lambda _: (wanted, _explain(*wanted)))

    def _on_done(self, answer: object) -> None:
        self._of, self._explanation = answer  # type: ignore[misc]
        self.explained.emit()


def _explain(result: PlanningResult, pose: Pose) -> Explanation:
    from solver.candidates.explain import explain  # noqa: PLC0415 - numba is loaded when needed

    return explain(
        result.problem, pose.waypoint, pose.lean, pose.branch, lead=pose.lead, spin=pose.spin,
        turn=pose.turn, scene=result.candidates.scene,
    )  # fmt: skip


class NearestBodies(QObject):
    """Who comes nearest to whom at every waypoint of the shown sequence."""

    changed = Signal()

    def __init__(self, session: Session, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._line = JobLine(session.follow_ups, self, self._on_done)
        self._of: Sequence | None = None
        self._names: tuple[tuple[str, str], ...] = ()

    @property
    def names(self) -> tuple[tuple[str, str], ...]:
        """The pairs of the shown sequence, empty until they are known."""
        return self._names if self._of is self._session.sequence else ()

    def ask(self) -> None:
        """Find them out, if they are not known."""
        result, sequence = self._session.result, self._session.sequence
        if result is None or sequence is None or sequence is self._of:
            return
        self._line.submit(lambda _: (sequence, _nearest(result, sequence)))

    def _on_done(self, answer: object) -> None:
        self._of, self._names = answer  # type: ignore[misc]
        self.changed.emit()


def _nearest(result: PlanningResult, sequence: Sequence) -> tuple[tuple[str, str], ...]:
    from solver.candidates.generate import touch_numbers  # noqa: PLC0415
    from solver.candidates.postures import check_postures  # noqa: PLC0415

    problem, scene = result.problem, result.candidates.scene
    touch = touch_numbers(problem, scene)
    return check_postures(problem.robot, scene, sequence.pendant, touch).bodies
