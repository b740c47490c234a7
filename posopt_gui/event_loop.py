"""Gaps of the event loop: how long the window answered nothing."""

from __future__ import annotations

import time
from typing import Final

from PySide6.QtCore import QObject, Qt, QTimer

from solver.units import MS_PER_S

TICK: Final = 2
"""How often the event loop is asked whether it lives [ms]."""

GAP_LIMIT: Final = 0.05
"""A gap from here on is counted [s]."""


class EventLoopGaps(QObject):
    """Measures how long the event loop did not run, while it is started.

    Attributes
    ----------
    longest : float
        Longest time between two ticks [s], less the time between ticks that was asked for.
    count : int
        Gaps of `GAP_LIMIT` and more.
    """

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._timer = QTimer(self)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.setInterval(TICK)
        self._timer.timeout.connect(self._tick)
        self._last = 0.0
        self.longest, self.count = 0.0, 0

    def start(self) -> None:
        """Begin to measure."""
        self.reset()
        self._timer.start()

    def reset(self) -> None:
        """Forget what was measured."""
        self.longest, self.count = 0.0, 0
        self._last = time.perf_counter()

    def stop(self) -> None:
        """End; what was measured stays."""
        self._tick()
        self._timer.stop()

    def _tick(self) -> None:
        now = time.perf_counter()
        gap = now - self._last - TICK / MS_PER_S
        self._last = now
        self.longest = max(self.longest, gap)
        self.count += gap >= GAP_LIMIT
