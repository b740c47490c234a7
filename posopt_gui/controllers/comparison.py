"""The references that the plan is compared with, computed off the window's thread."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from posopt_gui.viewmodels.curves_model import Track, compared_tracks
from posopt_gui.workers.jobs import JobLine

if TYPE_CHECKING:
    from posopt_gui.controllers.session import Session
    from solver.analysis.result import PlanningResult


class Comparison(QObject):
    """Curves of the references of the session's plan; wishes change the plan, not them."""

    changed = Signal()

    def __init__(self, session: Session, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._line = JobLine(session.follow_ups, self, self._on_done, self._on_failed)
        self._of: PlanningResult | None = None
        self._tracks: tuple[Track, ...] = ()
        session.result_changed.connect(self._on_result)
        self._on_result()

    @property
    def tracks(self) -> tuple[Track, ...]:
        """Curves of the references, empty until they are known."""
        return self._tracks

    def _on_result(self) -> None:
        result = self._session.result
        if result is self._of:
            return
        self._of, self._tracks = result, ()
        if result is None:
            self._line.stop()
            self.changed.emit()
        else:
            self._line.submit(lambda _: compared_tracks(result))

    def _on_done(self, tracks: object) -> None:
        assert isinstance(tracks, tuple)
        self._tracks = tracks
        self.changed.emit()

    def _on_failed(self, error: object) -> None:
        # Without references the plan is still shown; the tables say that there are none.
        self._tracks = ()
        self.changed.emit()
