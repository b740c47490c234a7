"""How a computation tells its progress and learns that it should stop."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from solver.errors import Cancelled


@runtime_checkable
class Monitor(Protocol):
    """What a long computation talks to; the command line and the window implement it."""

    def report(self, stage: str, done: int, total: int) -> None:
        """Tell that `done` of `total` units of the named stage are finished."""

    def cancelled(self) -> bool:
        """Whether the computation should stop; asked at least every 20 ms."""


COMPILING = "compiling"
"""Stage that is reported when kernels have to be compiled, which happens once."""


class SilentMonitor:
    """A monitor that shows nothing and never cancels."""

    def report(self, stage: str, done: int, total: int) -> None:
        """Ignore the report."""

    def cancelled(self) -> bool:
        """Never cancel."""
        return False


def checkpoint(monitor: Monitor, stage: str, done: int, total: int) -> None:
    """Report progress and raise :class:`~solver.errors.Cancelled` if the monitor wants to stop."""
    monitor.report(stage, done, total)
    if monitor.cancelled():
        raise Cancelled
