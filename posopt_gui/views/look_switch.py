"""Another theme or language for the whole window, without holding it up."""

from __future__ import annotations

import time
from functools import partial
from typing import Final

import shiboken6
from PySide6.QtCore import QCoreApplication, QEvent, QObject, QTimer
from PySide6.QtWidgets import QApplication, QGraphicsView, QWidget

from posopt_gui.controllers.session import Session
from posopt_gui.style import apply_theme, follow_theme, prepare_style

SHARE: Final = 0.012
"""How long widgets are styled anew in one turn of the event loop [s]."""

PATIENCE: Final = 2.0
"""The window is painted again after this, even where something is still to be done [s]."""


class LookSwitch(QObject):
    """Brings a window into another theme or language in small turns, and shows it when all is done.

    A style sheet that is set anew goes through all widgets at once, the application's even
    through each widget as often as there are widgets above it. Here the sheet stays, see
    `posopt_gui.style`, and the widgets are looked up in it again a few in each turn. The views
    follow in turns of their own (`posopt_gui.views.refresh`). Until the last one has
    followed nothing is painted, so that no half of the window is seen in the old colours.
    """

    def __init__(self, window: QWidget, session: Session) -> None:
        super().__init__(window)
        self._window, self._session = window, session
        self._widgets: list[QWidget] = []
        self._key = object()
        self._held: list[QWidget] = []
        self._since = 0.0
        self._prepared = False
        self._end = QTimer(self)
        self._end.setInterval(0)
        self._end.timeout.connect(self._show_if_done)
        application = QApplication.instance()
        assert isinstance(application, QApplication)
        self._application = application
        prepare_style(application)
        apply_theme(application, window, session.look.theme)
        # Connected before all views: the window is held before the first of them changes.
        session.look.theme_changed.connect(self._on_theme)
        session.look.language_changed.connect(self._hold)

    @property
    def going_on(self) -> bool:
        """Whether something of a switch is not on screen yet."""
        return self._end.isActive()

    def _on_theme(self) -> None:
        self._hold()
        apply_theme(self._application, self._window, self._session.look.theme)
        # From the outside to the inside, as Qt does it: the last one is the next.
        self._widgets = [self._window, *self._window.findChildren(QWidget)][::-1]
        self._session.turns.ask(self._key, self._style_some)

    def _style_some(self) -> None:
        end = time.perf_counter() + SHARE
        changed = QEvent(QEvent.Type.StyleChange)
        while self._widgets and time.perf_counter() < end:
            widget = self._widgets.pop()
            if shiboken6.isValid(widget):
                follow_theme(widget)
                QCoreApplication.sendEvent(widget, changed)
        if self._widgets:
            self._session.turns.ask(self._key, self._style_some)

    def _hold(self) -> None:
        """Paint nothing until all is done, neither here nor in dialogs and floating panels."""
        self._since, self._prepared = time.monotonic(), False
        for window in self._application.topLevelWidgets():
            if window.isVisible() and window.updatesEnabled():
                window.setUpdatesEnabled(False)
                self._held.append(window)
        self._end.start()

    def _show_if_done(self) -> None:
        late = time.monotonic() - self._since > PATIENCE
        if self._session.turns.waiting and not late:
            return
        if not self._prepared and not late:
            self._prepared = True
            self._prepare_plots()
            return
        self._end.stop()
        held, self._held = self._held, []
        for window in held:
            if shiboken6.isValid(window):
                window.setUpdatesEnabled(True)

    def _prepare_plots(self) -> None:
        """Leave less to the one painting that shows everything."""
        if self._window.findChild(QGraphicsView) is None:
            return
        from posopt_gui.views.axis_pictures import draw_axes, plots_on_screen  # noqa: PLC0415

        for plot in plots_on_screen(self._window):
            self._session.turns.ask(("axes", plot), partial(draw_axes, plot))
