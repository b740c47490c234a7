"""What an experiment hands over: tables, sentences and drawings, all made of computed values."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

Value = str | int | float | bool | None


@dataclass(frozen=True, slots=True)
class Column:
    """A column of a table; `decimals` are those shown to people, `timing` marks measured times."""

    name: str
    unit: str = ""
    decimals: int = 2
    timing: bool = False

    @property
    def head(self) -> str:
        """Name and unit."""
        return f"{self.name}, {self.unit}" if self.unit else self.name


@dataclass(frozen=True, slots=True)
class StudyTable:
    """Rows of values; None stands where there is no value."""

    key: str
    title: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Value, ...], ...]
    note: str = ""

    def column(self, name: str) -> list[Value]:
        """All values under a name."""
        at = [one.name for one in self.columns].index(name)
        return [row[at] for row in self.rows]

    def row(self, label: str) -> dict[str, Value]:
        """The row whose first value is `label`, by column name."""
        for row in self.rows:
            if row[0] == label:
                return dict(zip((one.name for one in self.columns), row, strict=True))
        raise KeyError(label)

    def document(self) -> dict[str, Any]:
        """The table as JSON."""
        return {
            "key": self.key,
            "title": self.title,
            "note": self.note,
            "columns": [
                {"name": one.name, "unit": one.unit, "timing": one.timing} for one in self.columns
            ],
            "rows": [[_finite(value) for value in row] for row in self.rows],
        }


def _finite(value: Value) -> Value:
    return None if isinstance(value, float) and not math.isfinite(value) else value


def shown(value: Value, column: Column) -> str:
    """A value as people read it."""
    value = _finite(value)
    if value is None:
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int):
        return f"{value:,}"
    if isinstance(value, float):
        return f"{round(value, column.decimals) + 0.0:.{column.decimals}f}"
    return value


Draw = Callable[[Any], None]
"""Draws on an empty figure of the plotting library."""


@dataclass(frozen=True, slots=True, eq=False)
class Drawing:
    """A figure that is drawn when the plotting library is at hand; `size` in inches."""

    key: str
    title: str
    draw: Draw
    size: tuple[float, float] = (7.2, 3.6)


@dataclass(frozen=True, slots=True, eq=False)
class Section:
    """One experiment's outcome.

    `text` are paragraphs in plain words; `numbers` the values behind them. `reason` says why
    an experiment does not apply to a cell, '' where it does.
    """

    key: str
    title: str
    text: tuple[str, ...] = ()
    tables: tuple[StudyTable, ...] = ()
    drawings: tuple[Drawing, ...] = ()
    numbers: Mapping[str, Any] = field(default_factory=dict)
    reason: str = ""

    def table(self, key: str) -> StudyTable:
        """The table of this key."""
        return next(one for one in self.tables if one.key == key)

    def document(self) -> dict[str, Any]:
        """The section as JSON."""
        return {
            "key": self.key,
            "title": self.title,
            "applies": not self.reason,
            "reason": self.reason,
            "text": list(self.text),
            "numbers": dict(self.numbers),
            "tables": [one.document() for one in self.tables],
            "figures": [{"key": one.key, "title": one.title} for one in self.drawings],
        }


def percent(share: float, decimals: int = 1) -> str:
    """A share as a signed percentage."""
    return f"{100.0 * share:+.{decimals}f} %"


def counted(count: int, one: str, many: str = "") -> str:
    """A number with its noun."""
    return f"{count:,} {one if count == 1 else many or one + 's'}"
