"""The small bar over the 3D panel: camera, what is shown, picture."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QFrame, QHBoxLayout, QMenu, QToolButton, QWidget

from posopt_gui.theme import Theme
from posopt_gui.views.camera import CLOSE_UP, PRESETS

PARTS: Mapping[str, tuple[str, str, bool]] = {
    "path": ("Path", "Waypoints with their normals", True),
    "trail": ("Trail", "The way of the TCP through the plan", True),
    "clearance": ("Clearance", "The two nearest points and their distance", True),
    "bodies": ("Bodies", "Robot and tool as collision checking sees them", False),
    "frames": ("Frames", "fanuc_world, floor, beam, flange and TCP", False),
}
"""Parts of the picture: caption, explanation and whether they are shown at first."""

TRAILS = {False: "#7B3FB5", True: "#C9A2F2"}
"""Colour of the trail in the light and in the dark theme: the path, on which it lies, is blue."""

CAMERAS = (*PRESETS, CLOSE_UP)


class SceneTools(QFrame):
    """Chooses the camera and what is shown; all actions can also stand in a menu."""

    preset_chosen = Signal(str)
    fit_asked = Signal()
    picture_asked = Signal()
    shown_changed = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("sceneTools")
        self.camera_actions = [self._camera_action(i, name) for i, name in enumerate(CAMERAS)]
        self.fit_action = self._action("F", self.fit_asked.emit)
        self.picture_action = self._action("", self.picture_asked.emit)
        self.part_actions = {name: self._part_action(name) for name in PARTS}
        self._camera_menu, self._parts_menu = QMenu(self), QMenu(self)
        self._camera_menu.addActions(self.camera_actions)
        self._parts_menu.addActions(list(self.part_actions.values()))
        self._camera_button = self._menu_button(self._camera_menu)
        self._parts_button = self._menu_button(self._parts_menu)
        self._part_buttons = [self._button(one) for one in self.part_actions.values()]
        for name, button in zip(self.part_actions, self._part_buttons, strict=True):
            button.setObjectName(f"part_{name}")
        layout = QHBoxLayout(self)
        layout.setContentsMargins(3, 3, 3, 3)
        layout.setSpacing(1)
        for button in (
            self._camera_button,
            self._button(self.fit_action),
            *self._part_buttons,
            self._parts_button,
            self._button(self.picture_action),
        ):
            layout.addWidget(button)
        self._wide: bool | None = None
        self._full_width = 0

    @property
    def shown(self) -> dict[str, bool]:
        """Which parts are shown."""
        return {name: action.isChecked() for name, action in self.part_actions.items()}

    def show_part(self, name: str, shown: bool = True) -> None:
        """Switch a part on or off."""
        self.part_actions[name].setChecked(shown)

    def retranslate(self, tr: Callable[..., str]) -> None:
        """Set all texts again."""
        for action, name in zip(self.camera_actions, CAMERAS, strict=True):
            action.setText(tr(name))
        self.fit_action.setText(tr("Fit"))
        self.fit_action.setToolTip(tr("Show the whole cell (F)"))
        self.picture_action.setText(tr("Picture"))
        self.picture_action.setToolTip(tr("Save the picture to a file"))
        for name, (caption, explanation, _) in PARTS.items():
            self.part_actions[name].setText(tr(caption))
            self.part_actions[name].setToolTip(tr(explanation))
        self._camera_button.setText(tr("Camera"))
        self._camera_button.setToolTip(tr("Look from a fixed direction (1 to 6)"))
        self._parts_button.setText(tr("Show"))
        self._parts_button.setToolTip(tr("What the picture shows"))
        self._wide = None
        self.adjustSize()

    def retheme(self, theme: Theme) -> None:
        """Set all colours again."""
        self.setStyleSheet(
            f"QFrame#sceneTools {{ background: {theme.surface};"
            f" border: 1px solid {theme.border}; border-radius: 5px; }}"
            f"QToolButton {{ color: {theme.text}; background: transparent; border: none;"
            f" border-radius: 3px; padding: 3px 7px; }}"
            f"QToolButton:hover {{ background: {theme.raised}; }}"
            f"QToolButton:focus {{ border: 1px solid {theme.accent}; padding: 2px 6px; }}"
            f"QToolButton:checked {{ background: {theme.selection}; color: {theme.text}; }}"
            f'QToolButton[popupMode="2"] {{ padding-right: 18px; }}'
            f"QToolButton#part_path {{ border-bottom: 2px solid {theme.line}; }}"
            f"QToolButton#part_trail {{ border-bottom: 2px solid {TRAILS[theme.dark]}; }}"
            f"QToolButton::menu-indicator {{ border-left-color: {theme.surface};"
            f" border-right-color: {theme.surface}; }}"
        )

    def fit_into(self, width: int) -> None:
        """Take the short form, with one menu for all parts, where there is little room."""
        if self._wide is None:
            self._set_wide(True)
            self.adjustSize()
            self._full_width = self.sizeHint().width()
        wide = self._full_width <= width
        if wide != self._wide:
            self._set_wide(wide)
        self.adjustSize()

    def _set_wide(self, wide: bool) -> None:
        self._wide = wide
        for button in self._part_buttons:
            button.setVisible(wide)
        self._parts_button.setVisible(not wide)

    def _camera_action(self, index: int, name: str) -> QAction:
        return self._action(str(index + 1), lambda: self.preset_chosen.emit(name))

    def _part_action(self, name: str) -> QAction:
        action = self._action("", lambda: None)
        action.setCheckable(True)
        action.setChecked(PARTS[name][2])
        action.toggled.connect(lambda _: self.shown_changed.emit())
        return action

    def _action(self, key: str, run: Callable[[], None]) -> QAction:
        action = QAction(self)
        if key:
            action.setShortcut(QKeySequence(key))
        action.triggered.connect(lambda _=False: run())
        self.addAction(action)
        return action

    def _button(self, action: QAction) -> QToolButton:
        button = QToolButton(self)
        button.setDefaultAction(action)
        button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        button.setCursor(Qt.CursorShape.ArrowCursor)
        return button

    def _menu_button(self, menu: QMenu) -> QToolButton:
        button = QToolButton(self)
        button.setMenu(menu)
        button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        return button
