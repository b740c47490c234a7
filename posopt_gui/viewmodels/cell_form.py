"""The form of a cell: its sections and fields for what the cell states now.

The form is a function of the cell: which fields there are, what can be chosen and what holds by
default follow what is already stated. Writing goes through `Form.edited`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from posopt_gui.viewmodels.cell_facts import Catalogue, Facts, facts_of
from posopt_gui.viewmodels.form_fields_cell import (
    beam_section,
    cell_section,
    placement_section,
    robot_section,
    tool_section,
    workpiece_section,
)
from posopt_gui.viewmodels.form_fields_fixtures import fixtures_section
from posopt_gui.viewmodels.form_fields_path import path_section
from posopt_gui.viewmodels.form_fields_program import (
    accuracy_section,
    links_section,
    program_section,
)
from posopt_gui.viewmodels.form_fields_settings import cost_section, lean_section, limits_section
from posopt_gui.viewmodels.form_types import Cell, Field, Section, at


@dataclass(frozen=True, slots=True, eq=False)
class Form:
    """The sections of a cell, and what the cell refers to."""

    cell: Cell
    sections: tuple[Section, ...]
    facts: Facts

    def section(self, name: str) -> Section:
        """A section by its name."""
        return next(one for one in self.sections if one.name == name)

    def field(self, key: str) -> Field | None:
        """The field of a key; None where the form has none now."""
        return next(
            (field for one in self.sections for field in one.fields if field.key == key), None
        )

    def edited(self, field: Field, value: Any) -> Cell | None:
        """The cell with a field's value; None where that changes nothing."""
        if field.value(self.cell) == value:
            return None
        written = field.written(value)
        if field.apply is not None:
            return field.apply(self.cell, written)
        return None if field.stated(self.cell) == written else put(self.cell, field.key, written)

    def place_of(self, key: str | None) -> tuple[str, str]:
        """Name of the section and key of the field that an error's key belongs to.

        The field is '' where the error speaks of several fields, the section where of the cell.
        """
        if not key:
            return "", ""
        for one in self.sections:
            if any(field.key == key for field in one.fields):
                return one.name, key
        inside = [
            (len(field.key), one.name, field.key)
            for one in self.sections
            for field in one.fields
            if key.startswith(f"{field.key}.")
        ]
        if inside:
            _, section, field_key = max(inside)
            return section, field_key
        near = [
            (len(table), one.name)
            for one in self.sections
            for table in one.keys
            if key == table or key.startswith(f"{table}.")
        ]
        if near:
            return max(near)[1], ""
        below = (
            one.name
            for one in self.sections
            if any(field.key.startswith(f"{key}.") for field in one.fields)
        )
        return next(below, ""), ""


def cell_form(
    cell: Cell,
    catalogue: Catalogue,
    *,
    folder: str = "",
    files: Mapping[str, bytes] | None = None,
    fixture: int = 0,
) -> Form:
    """The form of a cell; `fixture` is the one whose fields are shown, from 0."""
    facts = facts_of(cell, catalogue, folder, files)
    return form_of(cell, catalogue, facts, files or {}, fixture)


def form_of(
    cell: Cell, catalogue: Catalogue, facts: Facts, files: Mapping[str, bytes], fixture: int
) -> Form:
    """The form of a cell of which the facts are known."""
    mesh = "workpiece" in cell
    sections = (
        robot_section(cell, catalogue, facts),
        tool_section(cell, catalogue, facts),
        workpiece_section(cell) if mesh else beam_section(cell, catalogue, facts),
        placement_section(cell, facts),
        fixtures_section(cell, fixture),
        path_section(cell, facts, files),
        lean_section(cell),
        limits_section(cell),
        cost_section(cell),
        program_section(cell),
        links_section(cell),
        accuracy_section(cell),
        cell_section(cell),
    )
    return Form(cell, sections, facts)


def put(cell: Cell, key: str, value: Any) -> Cell:
    """The cell with another value under a dotted key; None removes the key."""
    return dict(_put(cell, key.split("."), value))


def _put(container: Any, parts: list[str], value: Any) -> Any:
    first, rest = parts[0], parts[1:]
    if isinstance(container, list):
        items = list(container)
        index = int(first)
        items[index] = _put(items[index], rest, value) if rest else value
        return items
    table = dict(container) if isinstance(container, Mapping) else {}
    if rest:
        table[first] = _put(at(table, first, {}), rest, value)
    elif value is None:
        table.pop(first, None)
    else:
        table[first] = value
    return table
