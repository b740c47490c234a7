"""Work on the window's thread that is done piece by piece, so that the window stays awake."""

from __future__ import annotations

from collections.abc import Callable, Hashable

from PySide6.QtCore import QObject, QTimer

Piece = Callable[[], object]


class Turns(QObject):
    """Does one piece in each turn of the event loop, in the order in which they were asked for.

    Between two pieces the window paints, and the mouse and the keys are answered. What is asked
    for again before its turn came is done once. Timers of their own would not do: all that are
    due run in the same turn.
    """

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._pieces: dict[Hashable, Piece] = {}
        self._timer = QTimer(self)
        self._timer.setInterval(0)
        self._timer.timeout.connect(self._turn)

    @property
    def waiting(self) -> bool:
        """Whether anything is still to be done."""
        return bool(self._pieces)

    def ask(self, key: Hashable, piece: Piece) -> None:
        """Do a piece in a turn of its own; `key` says that it is the same as one before."""
        self._pieces[key] = piece
        if not self._timer.isActive():
            self._timer.start()

    def forget(self, key: Hashable) -> None:
        """Do not do what was asked for."""
        self._pieces.pop(key, None)

    def clear(self) -> None:
        """Do nothing of what is still waiting."""
        self._pieces.clear()
        self._timer.stop()

    def finish(self) -> None:
        """Do at once all that is waiting, and what that asks for."""
        while self._pieces:
            self._turn()

    def _turn(self) -> None:
        if self._pieces:
            piece = self._pieces.pop(next(iter(self._pieces)))
            if not self._pieces:
                self._timer.stop()
            piece()
        else:
            self._timer.stop()
