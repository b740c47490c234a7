"""Threads on which the window's jobs run."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor, wait
from functools import partial

from PySide6.QtCore import QObject

from solver.units import MS_PER_S


class JobThreads(QObject):
    """A few threads that take jobs in their order.

    A QThreadPool waits in its destructor for the job that runs. Destroyed from Python, as the
    last reference to a view goes, it would wait with the interpreter in its hand, which the job
    needs to end: both would wait for ever. The end of these threads waits for nothing.
    """

    def __init__(self, most: int, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._executor = ThreadPoolExecutor(most, thread_name_prefix="posopt-job")
        # Idle threads end with this object, even where something still refers to it.
        self.destroyed.connect(partial(self._executor.shutdown, wait=False))
        self._jobs: set[Future[None]] = set()

    def start(self, job: Callable[[], None]) -> None:
        """Run a job as soon as a thread is free."""
        self._jobs = {one for one in self._jobs if not one.done()}
        self._jobs.add(self._executor.submit(job))

    def wait(self, patience: float | None = None) -> bool:
        """Wait until all jobs have ended, at most `patience` [ms]; False where one has not."""
        seconds = None if patience is None else patience / MS_PER_S
        return not wait(self._jobs, seconds).not_done
