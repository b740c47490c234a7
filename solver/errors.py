"""The one error tree: every way of failing that a person can meet.

An error is data. It carries the values, the place and what to try, and builds one sentence
from them; the command line and the window print that sentence and never a traceback.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Place:
    """Where in a file something was found; lines and columns count from 1."""

    file: str
    line: int | None = None
    column: int | None = None
    key: str | None = None

    def __str__(self) -> str:
        parts = [self.file]
        if self.line is not None:
            parts.append(f"line {self.line}")
        if self.column is not None:
            parts.append(f"column {self.column}")
        if self.key is not None:
            parts.append(f"key {self.key}")
        return ", ".join(parts)


class PosoptError(Exception):
    """Base of everything that posopt raises on purpose; `str()` is one sentence."""

    exit_code = 2


class InputError(PosoptError):
    """A file, argument or value that cannot be used: what, where, and what was expected."""

    def __init__(self, message: str, place: Place | None = None) -> None:
        self.place = place
        self.message = message
        super().__init__(f"{place}: {message}" if place is not None else message)


class ModelError(InputError):
    """A robot, tool, beam, cell or setting that contradicts itself or its stated range."""


class UnknownNameError(InputError):
    """A name that the catalogue does not hold; the sentence lists what it does hold, or a few."""

    LISTED = 6
    """Most names that are listed; of more, the first three are."""

    def __init__(self, kind: str, name: str, known: tuple[str, ...]) -> None:
        self.kind, self.name, self.known = kind, name, known
        shown = known if len(known) <= self.LISTED else (*known[:3], "...")
        super().__init__(f"no {kind} is called {name!r} (known: {', '.join(shown) or 'none'})")


class PlanningError(PosoptError):
    """The inputs are sound but no pose sequence fulfils them."""

    exit_code = 3


class RefusedError(PosoptError):
    """A check failed, so nothing was written."""

    exit_code = 4


class Cancelled(Exception):  # noqa: N818 - cancelling is a wish that was granted, not an error
    """Raised inside a computation when its monitor asks it to stop."""
