"""Cyclic garbage is collected on the window's thread alone."""

from __future__ import annotations

import gc
import time
from typing import Final

from PySide6.QtCore import QObject, QTimer

INTERVAL: Final = 100
"""How often it is asked whether there is enough garbage to be collected [ms]."""

OLDEST: Final = 2
"""Python's generation of what has outlived two collections."""

GROWTH: Final = 1.25
"""How much more there is in the oldest generation when all of it is looked through again."""

PAUSE: Final = 5.0
"""How long it is not asked again whether there is [s]."""


class GarbageCollector(QObject):
    """Collects in turns of the event loop what Python would collect wherever it is just then.

    Python looks for unreachable cycles on the thread that happens to allocate. Parts of a window
    are often in cycles; if they die on a worker's thread while the window's thread destroys
    their parents or brings them an event, the process ends with a segmentation fault. From
    `start` to `stop` collecting happens here only, at Python's own thresholds.
    """

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._old = 0
        self._ask_again = 0.0
        self._timer = QTimer(self)
        self._timer.setInterval(INTERVAL)
        self._timer.timeout.connect(self.collect)

    def start(self) -> None:
        """Collect on this object's thread from now on, and nowhere else."""
        gc.disable()
        self._timer.start()

    def stop(self) -> None:
        """Let Python collect where it likes."""
        self._timer.stop()
        gc.enable()

    def collect(self) -> None:
        """Collect the oldest generation that is due, and with it the younger ones."""
        due = [
            generation
            for generation, (count, threshold) in enumerate(
                zip(gc.get_count(), gc.get_threshold(), strict=True)
            )
            if 0 < threshold < count
        ]
        if not due:
            return
        if due[-1] < OLDEST or not self._is_worth_it():
            gc.collect(min(due[-1], OLDEST - 1))
            return
        gc.collect()
        self._old = len(gc.get_objects(generation=OLDEST))

    def _is_worth_it(self) -> bool:
        """Whether there is much more to look through than was left the last time, as Python asks.

        With the plan of a long path it takes longer than the window may be still.
        """
        now = time.monotonic()
        if now < self._ask_again:
            return False
        self._ask_again = now + PAUSE
        return len(gc.get_objects(generation=OLDEST)) > GROWTH * self._old
