"""Bringing a view up to date without holding up the window."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QObject, QTimer

from posopt_gui.controllers.session import Session

REST = 120
"""How long the line that is dragged has to rest until all views follow [ms]."""


class Refresh(QObject):
    """Does a view's work in a turn of its own, and once for all that changed before.

    While the line of the map is dragged, only the map follows the hand at once; a view that is
    refreshed with this one follows where the hand rests, and in full when it lets go.
    """

    def __init__(self, session: Session, work: Callable[[], object], view: QObject) -> None:
        super().__init__(view)
        self._session, self._work = session, work
        self._key = object()
        self._rest = QTimer(self)
        self._rest.setSingleShot(True)
        self._rest.setInterval(REST)
        self._rest.timeout.connect(self._ask)
        turns, key = session.turns, self._key
        view.destroyed.connect(lambda: turns.forget(key))

    def soon(self, *_: object) -> None:
        """Refresh in the next turns."""
        if self._session.previewing:
            self._rest.start()
        else:
            self._ask()

    def next_turn(self, *_: object) -> None:
        """Refresh in the next turns, whatever is dragged."""
        self._ask()

    def _ask(self) -> None:
        self._rest.stop()
        self._session.turns.ask(self._key, self._work)
