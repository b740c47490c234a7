"""Jobs on a thread of their own: one at a time of each kind, late answers dropped."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from PySide6.QtCore import QObject, Signal

from posopt_gui.workers.follow_ups import FollowUps
from posopt_gui.workers.threads import JobThreads
from solver.errors import Cancelled, PosoptError
from solver.progress import Monitor
from solver.units import MS_PER_S

REPORT_INTERVAL = 0.05
"""Least time between two reports of progress [s]: more would only flood the event queue."""

LOG = logging.getLogger("posopt")
"""Where defects of the window's own leave their traceback."""

Work = Callable[[Monitor], Any]


class _Relay(QObject):
    """Carries signals from the worker's thread to the window's."""

    progress = Signal(int, str, int, int)
    done = Signal(int, object)
    failed = Signal(int, object)


class _JobMonitor:
    """Progress and cancelling of one job."""

    def __init__(self, relay: _Relay, number: int) -> None:
        self._relay, self._number = relay, number
        self._stop = threading.Event()
        self._last = 0.0

    def stop(self) -> None:
        self._stop.set()

    def report(self, stage: str, done: int, total: int) -> None:
        now = time.monotonic()
        if now - self._last >= REPORT_INTERVAL or done >= total:
            self._last = now
            try:
                self._relay.progress.emit(self._number, stage, done, total)
            except RuntimeError:
                # The window is gone: nobody waits for the answer.
                self._stop.set()

    def cancelled(self) -> bool:
        return self._stop.is_set()


@dataclass(frozen=True, slots=True)
class _Waiting:
    work: Work
    number: int


class JobLine(QObject):
    """Runs the newest job; an older one is cancelled, one that still waits is forgotten.

    Signals come on the thread that owns this object: `done(answer)`, `failed(error)` (a
    PosoptError, or any other exception, which is a defect), `progress(stage, done, total)` and
    `busy_changed(bool)`. After `stop` nothing more is said of the jobs before. What takes the
    answers and the errors of all jobs can be given at once.
    """

    done = Signal(object)
    failed = Signal(object)
    progress = Signal(str, int, int)
    busy_changed = Signal(bool)

    def __init__(
        self,
        pool: JobThreads | FollowUps,
        parent: QObject | None = None,
        done: Callable[..., None] | None = None,
        failed: Callable[[object], None] | None = None,
    ) -> None:
        super().__init__(parent)
        if done is not None:
            self.done.connect(done)
        if failed is not None:
            self.failed.connect(failed)
        self._pool = pool
        self._relay = _Relay()
        self._relay.progress.connect(self._on_progress)
        self._relay.done.connect(self._on_done)
        self._relay.failed.connect(self._on_failed)
        self._newest = 0
        self._running: _JobMonitor | None = None
        self._waiting: _Waiting | None = None
        self._closed = False

    @property
    def busy(self) -> bool:
        """Whether a job runs, or waits, whose answer is wanted."""
        running = self._running
        return self._waiting is not None or (running is not None and not running.cancelled())

    def submit(self, work: Work, *, cancel_running: bool = True) -> None:
        """Run `work` as soon as the job before it has ended."""
        if self._closed:
            return
        was_busy = self.busy
        self._newest += 1
        if self._running is None:
            self._start(work, self._newest)
        else:
            if cancel_running:
                self._running.stop()
            self._waiting = _Waiting(work, self._newest)
        if not was_busy:
            self.busy_changed.emit(True)

    def stop(self) -> None:
        """Cancel the running job and forget the waiting one."""
        was_busy = self.busy
        self._waiting = None
        self._newest += 1
        if self._running is not None:
            self._running.stop()
        if was_busy:
            self.busy_changed.emit(False)

    def close(self) -> None:
        """Cancel everything and take no more; the pool still has to be waited for."""
        self._closed = True
        self.stop()

    def _start(self, work: Work, number: int) -> None:
        relay = self._relay
        monitor = _JobMonitor(relay, number)
        self._running = monitor

        def run() -> None:
            try:
                answer = _do(work, monitor)
            except (Cancelled, PosoptError) as error:
                _send(relay.failed, number, error)
            except Exception as error:
                LOG.exception("a job has failed by a defect")
                _send(relay.failed, number, error)
            else:
                _send(relay.done, number, answer)

        self._pool.start(run)

    def _on_progress(self, number: int, stage: str, done: int, total: int) -> None:
        if number == self._newest and not self._closed:
            self.progress.emit(stage, done, total)

    def _on_done(self, number: int, answer: object) -> None:
        self._finish(number, lambda: self.done.emit(answer))

    def _on_failed(self, number: int, error: object) -> None:
        if isinstance(error, Cancelled):
            self._finish(number, lambda: None)
        else:
            self._finish(number, lambda: self.failed.emit(error))

    def _finish(self, number: int, tell: Callable[[], None]) -> None:
        was_busy = self.busy
        self._running = None
        waiting, self._waiting = self._waiting, None
        if waiting is not None and not self._closed:
            self._start(waiting.work, waiting.number)
        elif was_busy:
            self.busy_changed.emit(False)
        # An answer that is no longer wanted is dropped.
        if number == self._newest and not self._closed:
            tell()


def end_all(*owners: QObject, patience: int) -> bool:
    """Cancel every job under these objects and wait for all of them, at most `patience` [ms].

    False where one has not ended: a kernel that is being compiled cannot be stopped.
    """
    for owner in owners:
        for line in owner.findChildren(JobLine):
            line.close()
    end = time.monotonic() + patience / MS_PER_S
    ended = True
    for owner in owners:
        for pool in owner.findChildren(JobThreads):
            left = max(0, int((end - time.monotonic()) * MS_PER_S))
            ended = pool.wait(left) and ended
    return ended


def _do(work: Work, monitor: _JobMonitor) -> object:
    # What was cancelled before it began need not begin.
    if monitor.cancelled():
        raise Cancelled
    return work(monitor)


def _send(signal: Any, number: int, value: object) -> None:
    try:
        signal.emit(number, value)
    except RuntimeError:
        # The window was closed and its objects are gone: nobody waits for the answer.
        return
