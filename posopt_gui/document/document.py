"""The document: the project's state with undo and redo."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from PySide6.QtCore import QObject, Signal

from posopt_gui.document.project import ProjectState
from solver.model.wishes import Pin, Region

HISTORY_LIMIT = 500
"""Most steps that can be undone."""


@dataclass(frozen=True, slots=True)
class _Step:
    """A state, the words for what led to it, and a key by which like steps are merged."""

    state: ProjectState
    label: str
    merge: str


class Document(QObject):
    """Holds the state of the project; every change is one step that can be undone.

    States are frozen, so that a step is the state itself and undo is going back to it.
    """

    changed = Signal()
    history_changed = Signal()

    def __init__(self, state: ProjectState, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._steps = [_Step(state, "", "")]
        self._index = 0
        self._saved: ProjectState | None = state

    @property
    def state(self) -> ProjectState:
        """The current state."""
        return self._steps[self._index].state

    @property
    def modified(self) -> bool:
        """Whether anything differs from what was saved or opened."""
        return self.state is not self._saved and self.state != self._saved

    @property
    def can_undo(self) -> bool:
        """Whether there is a step to undo."""
        return self._index > 0

    @property
    def can_redo(self) -> bool:
        """Whether there is a step to do again."""
        return self._index + 1 < len(self._steps)

    @property
    def undo_label(self) -> str:
        """Words for what undo takes back."""
        return self._steps[self._index].label if self.can_undo else ""

    @property
    def redo_label(self) -> str:
        """Words for what redo does again."""
        return self._steps[self._index + 1].label if self.can_redo else ""

    def value(self, key: str) -> Any:
        """What a dotted key of the cell holds."""
        return self.state.value(key)

    def set_value(self, key: str, value: Any, label: str = "") -> None:
        """Change one value of the cell; changes of the same key in a row are one step."""
        if self.value(key) == value:
            return
        self.edit(label or key, self.state.with_value(key, value), merge=key)

    def set_pins(self, pins: tuple[Pin, ...], label: str) -> None:
        """Replace the pins."""
        self.edit(label, replace(self.state, pins=pins))

    def set_regions(self, regions: tuple[Region, ...], label: str) -> None:
        """Replace the forbidden regions."""
        self.edit(label, replace(self.state, regions=regions))

    def edit(self, label: str, state: ProjectState, merge: str = "") -> None:
        """Make a new state current, with the files that it names.

        What had been undone is dropped.
        """
        state = state.with_its_files()
        last = self._steps[self._index]
        merges = bool(merge) and merge == last.merge and last.state is not self._saved
        del self._steps[self._index + 1 :]
        if merges:
            self._steps[self._index] = _Step(state, label, merge)
        else:
            self._steps.append(_Step(state, label, merge))
            del self._steps[: max(0, len(self._steps) - HISTORY_LIMIT)]
            self._index = len(self._steps) - 1
        self._announce()

    def undo(self) -> None:
        """Go one step back."""
        if self.can_undo:
            self._index -= 1
            self._announce()

    def redo(self) -> None:
        """Go one step forward again."""
        if self.can_redo:
            self._index += 1
            self._announce()

    def reset(self, state: ProjectState, *, saved: bool = True) -> None:
        """Begin anew with another project."""
        self._steps = [_Step(state, "", "")]
        self._index = 0
        self._saved = state if saved else None
        self._announce()

    def mark_saved(self) -> None:
        """The current state is what the file holds."""
        self._saved = self.state
        self.history_changed.emit()

    def _announce(self) -> None:
        self.changed.emit()
        self.history_changed.emit()
