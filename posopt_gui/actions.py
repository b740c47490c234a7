"""The actions of the window: their words, keys and menus, in one table."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final

from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QMenu, QMenuBar, QWidget

from posopt_gui.look import Look


@dataclass(frozen=True, slots=True)
class ActionSpec:
    """One action: `text` and `tip` are English keys of the translations."""

    name: str
    menu: str
    text: str
    tip: str
    keys: str = ""
    checkable: bool = False


SEPARATOR: Final = "-"

MENUS: Final = ("File", "Edit", "Plan", "View", "Help")

ACTIONS: Final[tuple[ActionSpec, ...]] = (
    ActionSpec("new", "File", "New", "Begin with the default cell", "Ctrl+N"),
    ActionSpec("open", "File", "Open…", "Open a project, a cell or a path", "Ctrl+O"),
    ActionSpec("save", "File", "Save", "Save the project", "Ctrl+S"),
    ActionSpec("save_as", "File", "Save as…", "Save under another name", "Ctrl+Shift+S"),
    ActionSpec("export", "File", "Export…", "Check and export the program", "Ctrl+E"),
    ActionSpec("report", "File", "Report…", "Write a report with pictures", "Ctrl+R"),
    ActionSpec("quit", "File", "Quit", "Close the window", "Ctrl+Q"),
    ActionSpec("undo", "Edit", "Undo", "Take the last change back", "Ctrl+Z"),
    ActionSpec("redo", "Edit", "Redo", "Do it again", "Ctrl+Y"),
    ActionSpec("clear_wishes", "Edit", "Clear pins and regions", "Plan freely again"),
    ActionSpec("plan", "Plan", "Plan", "Plan the inputs as they are", "F5"),
    ActionSpec("stop", "Plan", "Stop", "Stop planning", "Esc"),
    ActionSpec("live", "Plan", "Follow changes", "Plan after every change", checkable=True),
    ActionSpec(
        "compare", "Plan", "Compare all schemes", "Search f, f1 and f2 besides", checkable=True
    ),
    ActionSpec("dark", "View", "Dark", "Dark colours", checkable=True),
    ActionSpec("chinese", "View", "中文 / English", "Change the language", checkable=True),
    ActionSpec("reset_layout", "View", "Reset layout", "Put all panels back"),
    ActionSpec("guide", "Help", "Guide", "Open the user guide", "F1"),
    ActionSpec("about", "Help", "About", "Version and limits"),
)


class Actions:
    """All actions of a window by their names."""

    def __init__(self, owner: QWidget, look: Look) -> None:
        self._look = look
        self.by_name: dict[str, QAction] = {}
        for spec in ACTIONS:
            action = QAction(owner)
            action.setObjectName(spec.name)
            action.setCheckable(spec.checkable)
            if spec.keys:
                action.setShortcut(QKeySequence(spec.keys))
            owner.addAction(action)
            self.by_name[spec.name] = action
        self._menus: dict[str, QMenu] = {}
        self.retranslate()

    def __getitem__(self, name: str) -> QAction:
        """The action of that name."""
        return self.by_name[name]

    def connect(self, slots: Mapping[str, Callable[..., object]]) -> None:
        """Connect actions by name; checkable ones hand their state over."""
        for name, slot in slots.items():
            self.by_name[name].triggered.connect(slot)

    def fill(self, bar: QMenuBar) -> Mapping[str, QMenu]:
        """Put every action into its menu."""
        for title in MENUS:
            menu = bar.addMenu(self._look.tr(title))
            self._menus[title] = menu
            for spec in ACTIONS:
                if spec.menu == title:
                    menu.addAction(self.by_name[spec.name])
        return self._menus

    def say_what(self, name: str, what: str) -> None:
        """Say in the menu what an action would do; the tool bar keeps its short words."""
        spec = next(one for one in ACTIONS if one.name == name)
        text, keys = self._look.tr(spec.text), f" ({spec.keys})" if spec.keys else ""
        beside = f": {what}" if what else ""
        action = self.by_name[name]
        action.setText(text + beside)
        action.setIconText(text)
        action.setToolTip(self._look.tr(spec.tip) + beside + keys)

    def retranslate(self) -> None:
        """Set all words again."""
        tr = self._look.tr
        for spec in ACTIONS:
            action = self.by_name[spec.name]
            action.setText(tr(spec.text))
            action.setIconText(tr(spec.text).removesuffix("…"))
            keys = f" ({spec.keys})" if spec.keys else ""
            action.setToolTip(tr(spec.tip) + keys)
        for title, menu in self._menus.items():
            menu.setTitle(tr(title))
