"""One painting of the window for everything that changed, instead of one for every plot."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication, QEvent, QObject, QTimer
from PySide6.QtWidgets import QWidget


class OneFlush(QObject):
    """Gathers a window's requests to be painted until the event loop has nothing else to do.

    A graphics scene that has changed has its window painted at once, and a progress bar does so
    too. In a window with an OpenGL panel each of these composes the whole window again, and may
    wait for the screen: a cursor through seven plots would take seven frames.
    """

    def __init__(self, window: QWidget) -> None:
        super().__init__(window)
        self._window = window
        self._passing = False
        self.count = 0
        self._later = QTimer(self)
        self._later.setSingleShot(True)
        self._later.setInterval(0)
        self._later.timeout.connect(self._flush)
        window.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 - Qt's name
        """Hold requests back."""
        if event.type() != QEvent.Type.UpdateRequest or self._passing:
            return False
        if not self._later.isActive():
            self._later.start()
        return True

    def _flush(self) -> None:
        self._passing = True
        self.count += 1
        QCoreApplication.sendEvent(self._window, QEvent(QEvent.Type.UpdateRequest))
        self._passing = False
