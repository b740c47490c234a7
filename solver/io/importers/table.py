"""A text table as rows of cells with their line numbers; knows nothing of toolpaths."""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Final

from solver.errors import InputError, Place
from solver.io.importers.naming import shown

DELIMITER_NAMES: Final = {",": "comma", ";": "semicolon", "\t": "tab"}

LONGEST_LINE: Final = 100_000
"""Longest line [characters]; no table of waypoints comes near it."""

_DIRECTIVE: Final = re.compile(
    r"\s*(?:#+|//|;+)\s*(frame|unit|坐标系|单位)\s*[:=：]\s*(\S+)\s*", re.IGNORECASE
)
_SPREADSHEET_ERROR: Final = re.compile(r"#(?:REF!|N/A|VALUE!|NAME\?|DIV/0!|NUM!|NULL!)")
"""What a failed formula leaves in a cell; as the first of its row it is no comment."""

_DIRECTIVE_NAMES: Final = {"坐标系": "frame", "单位": "unit"}


@dataclass(frozen=True, slots=True)
class Row:
    """A row: its line in the file from 1, and its cells without surrounding blanks."""

    line: int
    cells: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Directive:
    """A statement in a comment above the first row, such as ``# frame: floor``."""

    line: int
    value: str


@dataclass(frozen=True, slots=True)
class Table:
    """The first row, the directives above it, and the rows below it, read once when asked for."""

    file: str
    first: Row
    directives: dict[str, Directive]
    delimiter: str
    _below: Iterator[tuple[int, str]]

    def rows(self) -> Iterator[Row]:
        """Yield the rows below the first; a row with another number of cells is refused."""
        expected = len(self.first.cells)
        for line, text in self._below:
            if _is_blank(text):
                continue
            if _is_comment(text, self.delimiter):
                _refuse_late_directive(text, Place(self.file, line))
                continue
            cells = split_row(text, self.delimiter, Place(self.file, line))
            if len(cells) != expected:
                place = Place(self.file, line, min(len(cells), expected) + 1)
                raise InputError(
                    f"the row has {_cells(len(cells))}, expected {expected} as in line "
                    f"{self.first.line} (is the file cut off?)",
                    place,
                )
            yield Row(line, cells)


def read_table(file: str, text: str, rank: Callable[[tuple[str, ...]], int]) -> Table:
    """Find the directives, the delimiter and the first row of a table.

    `rank` says how well the cells of the first row fit as a header; it decides between tab
    and comma where a first row holds both.
    """
    lines = _lines(text)
    directives: dict[str, Directive] = {}
    for number, line in lines:
        if _is_blank(line):
            continue
        if _is_comment(line, ""):
            _note_directive(directives, line, Place(file, number))
            continue
        place = Place(file, number)
        delimiter = _delimiter(line, place, rank)
        first = Row(number, split_row(line, delimiter, place))
        return Table(file, first, directives, delimiter, lines)
    raise InputError(
        "the file holds no rows, expected a header and two or more points", Place(file)
    )


def split_row(text: str, delimiter: str, place: Place) -> tuple[str, ...]:
    """Split a line into cells; a cell may be quoted with double quotes, doubled inside."""
    if len(text) > LONGEST_LINE:
        raise InputError(
            f"the line has {len(text):,} characters, expected at most {LONGEST_LINE:,}", place
        )
    if '"' not in text:
        return tuple(cell.strip(" \t") for cell in text.split(delimiter))
    cells: list[str] = []
    start = 0
    while start <= len(text):
        cell, start = _next_cell(
            text, start, delimiter, Place(place.file, place.line, len(cells) + 1)
        )
        cells.append(cell)
    return tuple(cells)


def _next_cell(text: str, start: int, delimiter: str, place: Place) -> tuple[str, int]:
    """Return the cell that begins at `start`, and where the next one begins."""
    while start < len(text) and text[start] in " \t" and text[start] != delimiter:
        start += 1
    if not text.startswith('"', start):
        end = text.find(delimiter, start)
        end = len(text) if end < 0 else end
        return text[start:end].strip(" \t"), end + 1
    end, parts = start + 1, []
    while True:
        quote = text.find('"', end)
        if quote < 0:
            raise InputError(
                "a quoted cell is open at the end of its line, expected a closing quote", place
            )
        parts.append(text[end:quote])
        if not text.startswith('""', quote):
            break
        end = quote + 2
    following = text.find(delimiter, quote + 1)
    following = len(text) if following < 0 else following
    if text[quote + 1 : following].strip(" \t"):
        raise InputError("text follows the closing quote of a cell, expected a delimiter", place)
    return '"'.join(parts).strip(" \t"), following + 1


def _lines(text: str) -> Iterator[tuple[int, str]]:
    """Yield the number of every line, from 1, and its text; lines end with LF, CRLF or CR."""
    for number, line in enumerate(io.StringIO(text, newline=None), start=1):
        yield number, line.removesuffix("\n")


def _delimiter(line: str, place: Place, rank: Callable[[tuple[str, ...]], int]) -> str:
    if ";" in line:
        return ";"
    present = [mark for mark in ("\t", ",") if mark in line]
    if not present:
        raise InputError(
            f"the first row {shown(line.strip())} has one cell, expected columns separated by "
            f"comma, semicolon or tab",
            place,
        )
    return max(present, key=lambda mark: rank(split_row(line, mark, place)))


def _is_blank(line: str) -> bool:
    return not line.strip(" \t")


def _is_comment(line: str, delimiter: str) -> bool:
    start = line.lstrip(" \t")
    if start.startswith("#"):
        return not _SPREADSHEET_ERROR.match(start)
    return start.startswith("//") or (start.startswith(";") and delimiter != ";")


def _note_directive(directives: dict[str, Directive], line: str, place: Place) -> None:
    found = _DIRECTIVE.fullmatch(line)
    if not found:
        return
    name = found[1].casefold()
    name = _DIRECTIVE_NAMES.get(name, name)
    if name in directives:
        raise InputError(
            f"the {name} is stated again, expected it only in line {directives[name].line}", place
        )
    directives[name] = Directive(place.line or 0, found[2])


def _refuse_late_directive(line: str, place: Place) -> None:
    found = _DIRECTIVE.fullmatch(line)
    if found:
        raise InputError(
            f"the comment states {shown(found[1])} below the first row, expected it above", place
        )


def _cells(count: int) -> str:
    return "1 cell" if count == 1 else f"{count} cells"
