"""What only the person in front of a window can answer about its files."""

from __future__ import annotations

from enum import Enum, auto
from typing import Protocol


class Choice(Enum):
    """What is to become of unsaved work."""

    SAVE = auto()
    DISCARD = auto()
    CANCEL = auto()


class Clash(Enum):
    """What is to become of a project file that another program or window has written."""

    REPLACE = auto()
    OTHER_NAME = auto()
    CANCEL = auto()


class Questions(Protocol):
    """What only the person can answer; a name is '' where nothing was chosen."""

    def unsaved(self, name: str) -> Choice:
        """Ask what to do with changes that were not saved."""

    def open_name(self, folder: str) -> str:
        """Ask which project, cell or path to open."""

    def save_name(self, proposal: str, suffix: str) -> str:
        """Ask where to save; an existing file was agreed to be replaced."""

    def written_meanwhile(self, name: str) -> Clash:
        """Ask what to do with a file that is no longer as it was read or saved here."""


class NoQuestions:
    """Nobody is there to answer: nothing is chosen and nothing thrown away."""

    def unsaved(self, _name: str) -> Choice:
        """Keep the work."""
        return Choice.CANCEL

    def open_name(self, _folder: str) -> str:
        """Choose nothing."""
        return ""

    def save_name(self, _proposal: str, _suffix: str) -> str:
        """Choose nothing."""
        return ""

    def written_meanwhile(self, _name: str) -> Clash:
        """Keep the other one's work."""
        return Clash.CANCEL
