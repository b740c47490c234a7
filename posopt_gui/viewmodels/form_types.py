"""What a form is made of: fields with label, kind, unit, range and default, in sections."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import Any, Final

from posopt_gui.viewmodels.number_words import in_figures, with_unit
from solver.catalog.toml_reader import MAXIMUM_ANGLE, MAXIMUM_LENGTH
from solver.units import DEG, MM

_LIMITS: Final[Mapping[str, float]] = {
    "mm": MAXIMUM_LENGTH / MM,
    "mm/s": MAXIMUM_LENGTH / MM,
    "deg": MAXIMUM_ANGLE / DEG,
}
"""Largest magnitude that a cell may state in a unit."""

AXES: Final = ("X", "Y", "Z")
ANGLES: Final = ("W", "P", "R")

Cell = Mapping[str, Any]
"""The tables of a cell's TOML file as nested dictionaries and lists."""


class Kind(Enum):
    """How a field is edited."""

    NUMBER = "number"
    INTEGER = "integer"
    NUMBERS = "numbers"
    CHOICE = "choice"
    FLAG = "flag"
    TEXT = "text"
    WORDS = "words"
    """A list of texts, separated by commas."""

    FILE = "file"
    """Name of a file, typed or chosen."""

    SUBSET = "subset"
    """Some of the numbers from 0, ascending."""


@dataclass(frozen=True, slots=True)
class Choice:
    """One of several values: what the cell holds, what is shown, and a line about it.

    `plain` labels are names that are the same in every language.
    """

    value: Any
    label: str
    detail: str = ""
    plain: bool = False


@dataclass(frozen=True, slots=True)
class Field:
    """One value of the cell and how it is shown. Texts are English and keys of translations.

    Attributes
    ----------
    key : str
        Dotted key of the cell document, or a name for a value that is stated by several keys
        (then with `read` and `apply`).
    label, tip : str
        Name of the field, and what it says.
    unit : str
        Unit of the value as the cell states it.
    low, high : float or None
        Range of a number, or of each of several; None where there is no bound of its own.
    above : bool
        Whether `low` itself is out of the range.
    step, decimals : float and int
        What an arrow key changes, and how many decimals are shown at least.
    default : any
        What holds where the cell states nothing, in the cell's own unit; None for nothing.
    parts : tuple of str
        Names of the several numbers.
    choices : tuple of Choice
        What can be chosen; `searchable` offers them by typing, and takes other texts too.
    unset : str
        Words for a number that is not stated and has no default.
    on, off : any
        What a flag writes.
    drop_default : bool
        Whether the default is written by removing the key.
    required : bool
        Whether the cell must state it.
    read, apply : callables
        Value of a cell, and the cell with another value, where the key alone does not say it.
    """

    key: str
    label: str
    kind: Kind
    tip: str = ""
    unit: str = ""
    low: float | None = None
    high: float | None = None
    above: bool = False
    step: float = 1.0
    decimals: int = 1
    default: Any = None
    parts: tuple[str, ...] = ()
    choices: tuple[Choice, ...] = ()
    searchable: bool = False
    unset: str = ""
    on: Any = True
    off: Any = False
    drop_default: bool = False
    required: bool = False
    read: Callable[[Cell], Any] | None = field(default=None, compare=False)
    apply: Callable[[Cell, Any], Cell] | None = field(default=None, compare=False)

    @property
    def count(self) -> int:
        """How many numbers the field holds."""
        return max(1, len(self.parts))

    def stated(self, cell: Cell) -> Any:
        """What the cell states; None for nothing."""
        return self.read(cell) if self.read is not None else at(cell, self.key)

    def value(self, cell: Cell) -> Any:
        """What the cell states, else the default."""
        stated = self.stated(cell)
        if self.kind is Kind.FLAG:
            return (self.default if stated is None else stated) != self.off
        return self.default if stated is None else stated

    def written(self, value: Any) -> Any:
        """What the cell is to hold for an edited value; None removes the key."""
        if self.kind is Kind.FLAG:
            value = self.on if value else self.off
        return None if self.drop_default and value == self.default else value


@dataclass(frozen=True, slots=True)
class Note:
    """A sentence with values that the form shows besides its fields."""

    text: str
    values: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class Section:
    """A group of fields.

    A summary with `said` is a word of the language, any other one a name or a number. `extra`
    names what a view shows besides them, above the field `before` ('' for the end);
    `keys` are the tables of the cell that the section speaks of, `summary` says in a few words
    what is chosen.
    """

    name: str
    title: str
    fields: tuple[Field, ...]
    keys: tuple[str, ...] = ()
    summary: str = ""
    said: bool = False
    extra: str = ""
    before: str = ""
    notes: tuple[Note, ...] = ()
    open: bool = False


def plain(values: tuple[str, ...]) -> tuple[Choice, ...]:
    """Choices whose labels are the values themselves."""
    return tuple(Choice(one, one, plain=True) for one in values)


def point_field(
    key: str, label: str, tip: str, parts: tuple[str, ...] = AXES, low: float | None = None
) -> Field:
    """A field of a point, or of extents above `low`, that the cell must state."""
    return Field(
        key, label, Kind.NUMBERS, tip, "mm", low, above=low is not None, step=5.0, parts=parts,
        required=True,
    )  # fmt: skip


def range_of(field: Field) -> Note | None:
    """The range of a field's numbers in words."""
    if field.kind not in (Kind.NUMBER, Kind.INTEGER, Kind.NUMBERS):
        return None
    unit = with_unit("", field.unit)
    low, high = field.low, field.high
    values = [("unit", unit)]
    if low is not None:
        values.append(("low", in_figures(low)))
    if high is not None:
        values.append(("high", in_figures(high)))
    if low is not None and high is not None:
        text = "Above {low}, up to {high}{unit}" if field.above else "{low} to {high}{unit}"
    elif low is not None:
        text = "Above {low}{unit}" if field.above else "{low}{unit} or more"
    else:
        limit = _LIMITS.get(field.unit)
        if limit is None:
            return None
        text = "Up to {high}{unit} either way"
        values = [("unit", unit), ("high", f"{limit:,.10g}")]
    return Note(text, tuple(values))


def at(container: Any, key: str, default: Any = None) -> Any:
    """What a dotted key holds; the default where there is nothing."""
    found = container
    for part in key.split("."):
        if isinstance(found, Mapping):
            found = found.get(part)
        elif isinstance(found, list) and part.isdecimal() and int(part) < len(found):
            found = found[int(part)]
        else:
            return default
    return default if found is None else found


def table_of(cell: Cell, key: str) -> dict[str, Any]:
    """A copy of a table; empty where the cell has none."""
    found = at(cell, key)
    return dict(found) if isinstance(found, Mapping) else {}


def rows_of(cell: Cell, key: str) -> list[Mapping[str, Any]]:
    """The tables of a list; what is no table is an empty one."""
    found = at(cell, key)
    rows = found if isinstance(found, list) else []
    return [one if isinstance(one, Mapping) else {} for one in rows]


def with_table(cell: Cell, key: str, table: Mapping[str, Any]) -> dict[str, Any]:
    """The cell with another table under one of its own keys."""
    return {**cell, key: dict(table)}
