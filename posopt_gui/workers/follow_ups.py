"""Jobs that follow a plan, kept out of the way of the window that shows it."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Final

from PySide6.QtCore import QObject, QTimer, Signal

from posopt_gui.workers.threads import JobThreads
from posopt_gui.workers.turns import Turns

REST: Final = 20
"""How long the window has had nothing to do before a job begins [ms]."""

MOST_RESTS: Final = 50
"""How often a job waits for a window that always has something to do."""


class FollowUps(QObject):
    """Runs jobs one at a time on a thread, each when the window has nothing more to do.

    A job and the window that work at the same time take the interpreter from each other, and
    both take more than twice as long. What a job has found is on screen before the next begins.
    It takes the place of a thread pool.
    """

    _ended = Signal()

    def __init__(self, turns: Turns, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._turns = turns
        self._pool = JobThreads(1, self)
        self._jobs: deque[Callable[[], None]] = deque()
        self._running = False
        self._rests = 0
        self._rest = QTimer(self)
        self._rest.setSingleShot(True)
        self._rest.setInterval(REST)
        self._rest.timeout.connect(self._next)
        self._ended.connect(self._after)

    def start(self, job: Callable[[], None]) -> None:
        """Run a job after those before it."""
        self._jobs.append(job)
        if not self._running:
            self._rest.start()

    def close(self, patience: int) -> bool:
        """Forget what has not begun; False where what runs does not end in `patience` [ms]."""
        self._rest.stop()
        self._jobs.clear()
        return self._pool.wait(patience)

    def _next(self) -> None:
        if self._running or not self._jobs:
            return
        if self._turns.waiting and self._rests < MOST_RESTS:
            self._rests += 1
            self._rest.start()
            return
        job = self._jobs.popleft()
        self._running, self._rests = True, 0

        def run() -> None:
            try:
                job()
            finally:
                self._tell()

        self._pool.start(run)

    def _tell(self) -> None:
        try:
            self._ended.emit()
        except RuntimeError:
            # The window is gone: nothing follows any more.
            self._jobs.clear()

    def _after(self) -> None:
        self._running = False
        if self._jobs:
            self._rest.start()
