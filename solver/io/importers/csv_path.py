"""Tables of waypoints: comma, semicolon or tab, with a header or a given mapping."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import chain
from typing import TypeVar

from solver.errors import InputError, Place
from solver.io.importers.assembly import (
    Form,
    Part,
    PassRecord,
    PointRecord,
    agreed_frame,
    agreed_unit,
    assemble,
    check_feed,
    check_nominal,
    check_row_limit,
)
from solver.io.importers.columns import (
    NORMAL,
    PASS_FIELDS,
    POSITION,
    QUATERNION,
    TRAVEL,
    WPR,
    Columns,
    columns_from_header,
    columns_from_numbers,
    columns_from_titles,
    fitting_titles,
)
from solver.io.importers.naming import shown
from solver.io.importers.options import LENGTH_UNITS, ImportOptions
from solver.io.importers.source import Source
from solver.io.importers.strict_numbers import read_number
from solver.io.importers.table import Row, Table, read_table
from solver.io.importers.words import (
    read_events,
    read_frame,
    read_name,
    read_role,
    read_touches,
    read_unit,
)
from solver.model.toolpath import Frame, Role, Toolpath

FIRST_PASS = "1"
"""Name of the pass of a table without a pass column."""

_Value = TypeVar("_Value")


def import_csv(source: Source, options: ImportOptions) -> Toolpath:
    """Read a table of waypoints as a toolpath.

    Raises
    ------
    InputError
        One sentence with the file, the line and the column (the number of the cell, from 1).
    """
    table = read_table(source.file, source.text(options.encoding), fitting_titles)
    columns, rows = _columns(table, options)
    frame = _frame(table, options)
    reader = _RowReader(table.file, columns, _length_factor(table, columns, options), options)
    return assemble(_passes(reader, rows), frame, source.file, options)


def _columns(table: Table, options: ImportOptions) -> tuple[Columns, Iterable[Row]]:
    """Return the columns, and the rows that hold points."""
    if options.columns is None:
        return columns_from_header(table.first, table.file), table.rows()
    titles = {name: title for name, title in options.columns.items() if isinstance(title, str)}
    if len(titles) == len(options.columns):
        return columns_from_titles(titles, table.first, table.file), table.rows()
    if titles:
        raise InputError(
            "the column mapping mixes titles and numbers, expected one of them", Place(table.file)
        )
    numbers = {name: int(number) for name, number in options.columns.items()}
    columns = columns_from_numbers(numbers, table.first, table.file)
    return columns, chain([table.first], table.rows())


def _frame(table: Table, options: ImportOptions) -> Frame:
    stated = table.directives.get("frame")
    if stated is None:
        return agreed_frame(None, Place(table.file), options)
    place = Place(table.file, stated.line)
    return agreed_frame(_located("the frame", read_frame, stated.value, place), place, options)


def _length_factor(table: Table, columns: Columns, options: ImportOptions) -> float:
    unit = columns.length_unit
    place = Place(table.file, table.first.line, columns.index["x"] + 1)
    if directive := table.directives.get("unit"):
        above = Place(table.file, directive.line)
        stated = _located("the unit", read_unit, directive.value, above)
        if unit is not None and unit != stated:
            raise InputError(
                f"x, y and z have the unit {unit}, expected {stated} as in line {directive.line}",
                place,
            )
        unit, place = stated, above
    return LENGTH_UNITS[agreed_unit(unit, place, options)]


def _located(what: str, read: Callable[[str], _Value], text: str, place: Place) -> _Value:
    try:
        return read(text)
    except ValueError as error:
        raise InputError(f"{what} {error}", place) from error


def _passes(reader: _RowReader, rows: Iterable[Row]) -> Iterator[PassRecord]:
    current: PassRecord | None = None
    said: tuple[str, ...] = ()
    for count, row in enumerate(rows, start=1):
        check_row_limit(count, Place(reader.file, row.line), reader.options)
        says = reader.pass_cells(row)
        if current is None or says != said:
            record = reader.pass_record(row)
            if current is None or record.name != current.name:
                if current is not None:
                    yield current
                current = record
            reader.check_same_pass(row, current, record)
            said = says
        current.points.append(reader.point(row))
    if current is not None:
        yield current


@dataclass(frozen=True, slots=True)
class _RowPlaces:
    """Where the parts of the waypoint of one row stand."""

    reader: _RowReader
    line: int

    def place(self, part: Part) -> Place:
        return self.reader.place(self.line, self.reader.fields[part])


class _RowReader:
    """Reads the fields of one row after another."""

    def __init__(self, file: str, columns: Columns, length: float, options: ImportOptions) -> None:
        self.file, self.options = file, options
        self._columns, self._length = columns, length
        self._form, names = _orientation(columns)
        self._position = [columns.index[name] for name in POSITION]
        self._numbers = [columns.index[name] for name in names]
        self._names = dict(zip([*self._position, *self._numbers], [*POSITION, *names], strict=True))
        self._pass = [columns.index[name] for name in PASS_FIELDS if name in columns.index]
        self.fields = {
            Part.POSITION: "x",
            Part.ORIENTATION: names[0] if names else "x",
            Part.TRAVEL: "tx" if "tx" in names else "x",
        }

    def place(self, line: int, field: str) -> Place:
        """Return where the cell of a field is."""
        return Place(self.file, line, self._columns.index[field] + 1)

    def pass_cells(self, row: Row) -> tuple[str, ...]:
        """Return the cells in which the row speaks of its pass."""
        return tuple(row.cells[index] for index in self._pass)

    def pass_record(self, row: Row) -> PassRecord:
        """Return what the row says about its pass; the options say the rest."""
        options = self.options
        return PassRecord(
            place=Place(self.file, row.line, self._columns.index.get("pass", -1) + 1 or None),
            name=self._word(row, "pass", read_name, FIRST_PASS),
            feed=self._value(row, "feed", options.feed, check_feed),
            touches=self._word(row, "touches", read_touches, options.touches),
            lean=self._value(row, "lean", options.lean, check_nominal),
            lead=self._value(row, "lead", options.lead, check_nominal),
        )

    def check_same_pass(self, row: Row, first: PassRecord, record: PassRecord) -> None:
        """Refuse a row that says of its pass what the pass's first row does not."""
        for field in ("feed", "touches", "lean", "lead"):
            if getattr(first, field) != getattr(record, field):
                index = self._columns.index[field]
                raise InputError(
                    f"{field} changes to {shown(row.cells[index])} inside pass "
                    f"{shown(first.name)}, expected one value for a pass",
                    self.place(row.line, field),
                )

    def point(self, row: Row) -> PointRecord:
        """Return the waypoint of a row."""
        cells = row.cells
        try:
            position = tuple(read_number(cells[index]) * self._length for index in self._position)
            orientation = tuple(read_number(cells[index]) for index in self._numbers)
        except ValueError:
            self._refuse_numbers(row)
            raise
        return PointRecord(
            _RowPlaces(self, row.line),
            position,
            self._form,
            orientation,
            self._word(row, "role", read_role, Role.CONTACT),
            self._word(row, "events", read_events, ()),
        )

    def _refuse_numbers(self, row: Row) -> None:
        """Name the first cell, from the left, that is no number."""
        for index in sorted(self._names):
            name = self._names[index]
            _located(name, read_number, row.cells[index], self.place(row.line, name))

    def _value(self, row: Row, field: str, default: float, check: Callable[[float], None]) -> float:
        """Read an optional number in its SI unit."""
        index = self._columns.index.get(field)
        if index is None:
            return default
        factor = self._columns.factor[field]

        def read(text: str) -> float:
            value = read_number(text) * factor
            check(value)
            return value

        return _located(field, read, row.cells[index], self.place(row.line, field))

    def _word(self, row: Row, field: str, read: Callable[[str], _Value], default: _Value) -> _Value:
        """Read an optional word."""
        index = self._columns.index.get(field)
        if index is None:
            return default
        return _located(field, read, row.cells[index], self.place(row.line, field))


def _orientation(columns: Columns) -> tuple[Form, tuple[str, ...]]:
    """Return the form of the orientations and the fields that hold their numbers."""
    if columns.has(QUATERNION):
        return Form.QUATERNION, QUATERNION
    if columns.has(WPR):
        return Form.WPR, WPR
    if columns.has(TRAVEL):
        return Form.NORMAL_TRAVEL, (*NORMAL, *TRAVEL)
    if columns.has(NORMAL):
        return Form.NORMAL, NORMAL
    return Form.STATED, ()
