"""Where the panels of the window stand: at the sides, below, and one above the other between."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from PySide6.QtCore import QByteArray, QSettings, Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QDockWidget, QMainWindow, QSplitter, QWidget

from posopt_gui.theme import Theme
from posopt_gui.views.shell_parts import PanelTitle

LAYOUT_VERSION: Final = 1

SIDE_SHARE: Final = 0.23
"""Share of the window's width that each side panel takes at first, between two widths [px]."""

SIDE_WIDTHS: Final = (310, 400)

SHARES: Final = (9, 8, 8)
"""Heights of 3D view, map and curves at first."""

AREAS: Final = {
    "Setup": Qt.DockWidgetArea.LeftDockWidgetArea,
    "Inspector": Qt.DockWidgetArea.RightDockWidgetArea,
    "Playback": Qt.DockWidgetArea.BottomDockWidgetArea,
}


class Places:
    """The docks and the middle of a window; empty at first, so that it has its shape at once."""

    def __init__(self, window: QMainWindow, settings: QSettings) -> None:
        self._window, self._settings = window, settings
        self._middle = QSplitter(Qt.Orientation.Vertical)
        self._middle.setObjectName("middle")
        self._middle.setChildrenCollapsible(False)
        for share, factor in enumerate(SHARES):
            self._middle.addWidget(QWidget())
            self._middle.setStretchFactor(share, factor)
        window.setCentralWidget(self._middle)
        options = QMainWindow.DockOption
        window.setDockOptions(options.AnimatedDocks | options.AllowTabbedDocks)
        self.docks: dict[str, QDockWidget] = {}
        for name, area in AREAS.items():
            dock = QDockWidget(window)
            dock.setObjectName(name)
            dock.setWidget(QWidget())
            window.addDockWidget(area, dock)
            self.docks[name] = dock
        self._titles = {name: PanelTitle(self.docks[name]) for name in ("Setup", "Inspector")}
        for name, title in self._titles.items():
            self.docks[name].setTitleBarWidget(title)
        self.docks["Playback"].setTitleBarWidget(QWidget())
        window.setCorner(Qt.Corner.BottomLeftCorner, AREAS["Setup"])
        window.setCorner(Qt.Corner.BottomRightCorner, AREAS["Inspector"])
        self.share_width()

    @property
    def actions(self) -> list[QAction]:
        """Opening and closing of each panel, for the menu."""
        return [dock.toggleViewAction() for dock in self.docks.values()]

    def put(self, name: str, panel: QWidget) -> None:
        """Put a panel into its dock."""
        empty = self.docks[name].widget()
        self.docks[name].setWidget(panel)
        if empty is not None:
            empty.deleteLater()

    def put_middle(self, number: int, view: QWidget) -> None:
        """Put a view into the middle: 3D view, map or tabs."""
        empty = self._middle.replaceWidget(number, view)
        if empty is not None:
            empty.deleteLater()
        self._middle.setStretchFactor(number, SHARES[number])
        view.show()

    def settle(self) -> None:
        """Put all, once they are filled, as they were left the last time."""
        self.share_width()
        self.share_height()
        self._restore()

    def show(self, name: str) -> None:
        """Bring a panel to the front."""
        self.docks[name].show()
        self.docks[name].raise_()

    def share_width(self) -> None:
        """Give the panels at the sides their share of the width."""
        wanted = int(SIDE_SHARE * self._window.width())
        width = min(max(wanted, SIDE_WIDTHS[0]), SIDE_WIDTHS[1])
        docks = [self.docks["Setup"], self.docks["Inspector"]]
        self._window.resizeDocks(docks, [width, width], Qt.Orientation.Horizontal)

    def share_height(self, shares: tuple[int, int, int] = SHARES) -> None:
        """Divide the height of the middle among 3D view, map and tabs."""
        height = self._middle.height()
        self._middle.setSizes([height * part // sum(shares) for part in shares])

    def reset(self) -> None:
        """Put all panels back to where they were at first."""
        self._settings.remove("layout")
        for name, dock in self.docks.items():
            dock.setFloating(False)
            dock.show()
            self._window.addDockWidget(AREAS[name], dock)
        self.share_width()
        self.share_height()

    def save(self) -> None:
        """Keep the layout for the next time."""
        self._settings.setValue("layout/geometry", self._window.saveGeometry())
        self._settings.setValue("layout/state", self._window.saveState(LAYOUT_VERSION))
        self._settings.setValue("layout/middle", self._middle.saveState())

    def _restore(self) -> None:
        window = self._window
        for key, restore in (
            ("geometry", window.restoreGeometry),
            ("state", lambda kept: window.restoreState(kept, LAYOUT_VERSION)),
            ("middle", self._middle.restoreState),
        ):
            kept = self._settings.value(f"layout/{key}", QByteArray(), type=QByteArray)
            if isinstance(kept, QByteArray) and not kept.isEmpty():
                restore(kept)

    def retranslate(self, tr: Callable[..., str]) -> None:
        """Set all texts again."""
        for name, dock in self.docks.items():
            dock.setWindowTitle(tr(name))
        for title in self._titles.values():
            title.retranslate(tr)

    def retheme(self, theme: Theme) -> None:
        """Set all colours again."""
        for title in self._titles.values():
            title.retheme(theme)
