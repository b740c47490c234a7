"""Cyclic garbage is collected on the window's thread alone."""

from __future__ import annotations

import gc
from typing import Final

from PySide6.QtCore import QObject, QTimer

INTERVAL: Final = 100
"""How often it is asked whether there is enough garbage to be collected [ms]."""


class GarbageCollector(QObject):
    """Collects in turns of the event loop what Python would collect wherever it is just then.

    Python looks for unreachable cycles on the thread that happens to allocate. Parts of a window
    are often in cycles; if they die on a worker's thread while the window's thread destroys
    their parents or brings them an event, the process ends with a segmentation fault. From
    `start` to `stop` collecting happens here only, at Python's own thresholds.
    """

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
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
        if due:
            gc.collect(due[-1])
