"""Edits of the fixtures of a cell; each returns another cell."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import PurePath
from typing import Any

from posopt_gui.viewmodels.form_types import Cell, rows_of

CORNERS, MIDDLE = "corners", "centre"
"""Rules of a box: by two corners, or by its centre and its size."""

_MEASURES: Mapping[str, Mapping[str, object]] = {
    "box": {"min_mm": [1200.0, -100.0, 0.0], "max_mm": [1400.0, 100.0, 200.0]},
    "sphere": {"centre_mm": [1300.0, 0.0, 100.0], "radius_mm": 100.0},
    "cylinder": {"from_mm": [1300.0, 0.0, 0.0], "to_mm": [1300.0, 0.0, 200.0], "radius_mm": 100.0},
    "capsule": {"from_mm": [1300.0, 0.0, 100.0], "to_mm": [1300.0, 0.0, 200.0], "radius_mm": 100.0},
}
"""Place and size of a new fixture by its shape: on the floor, beyond the beam."""


def with_new_fixture(cell: Cell, shape: str = "box") -> tuple[Cell, int]:
    """The cell with one more fixture of a shape, and its index."""
    return _added(cell, {"name": shape, "shape": shape, **_MEASURES[shape]}, numbered=True)


def with_new_mesh(cell: Cell, file: str) -> tuple[Cell, int]:
    """The cell with a mesh file as one more fixture, and its index."""
    name = re.sub(r"[^A-Za-z0-9_.-]+", "_", PurePath(file).stem).lstrip("-.")[:60] or "mesh"
    return _added(cell, {"name": name, "mesh": file}, numbered=False)


def _added(cell: Cell, fixture: dict[str, object], *, numbered: bool) -> tuple[Cell, int]:
    fixtures = rows_of(cell, "fixtures")
    taken = {one.get("name") for one in fixtures} | {"floor"}
    name = fixture["name"]
    names = [f"{name}_{number}" for number in range(1, len(taken) + 2)]
    if not numbered:
        names.insert(0, str(name))
    free = next(one for one in names if one not in taken)
    return {**cell, "fixtures": [*fixtures, {**fixture, "name": free}]}, len(fixtures)


def without_fixture(cell: Cell, index: int) -> Cell:
    """The cell without one of its fixtures."""
    fixtures = rows_of(cell, "fixtures")
    del fixtures[index]
    rest = {key: value for key, value in cell.items() if key != "fixtures"}
    return {**rest, "fixtures": fixtures} if fixtures else rest


def with_shape(cell: Cell, key: str, shape: str) -> Cell:
    """The cell with another shape of a fixture, at a place of its own."""

    def changed(old: Mapping[str, Any]) -> dict[str, Any]:
        measures = _MEASURES[shape]
        if {old.get("shape"), shape} == {"cylinder", "capsule"}:
            measures = {name: old[name] for name in measures if name in old}
        kept = {name: old[name] for name in ("name", "group") if name in old}
        return {**kept, "shape": shape, **measures}

    return _changed(cell, key, changed)


def box_rule_of(fixture: Mapping[str, object]) -> str:
    """How a box is stated."""
    return MIDDLE if "centre_mm" in fixture or "size_mm" in fixture else CORNERS


def with_box_rule(cell: Cell, key: str, rule: str) -> Cell:
    """The cell with the same box of a fixture, stated by the other rule."""

    def changed(old: Mapping[str, Any]) -> dict[str, Any]:
        keys = ("min_mm", "max_mm", "centre_mm", "size_mm")
        kept = {name: value for name, value in old.items() if name not in keys}
        if rule == MIDDLE:
            low, high = _point(old.get("min_mm")), _point(old.get("max_mm"))
            pairs = list(zip(low, high, strict=True))
            centre = [(one + other) / 2.0 for one, other in pairs]
            return {**kept, "centre_mm": centre, "size_mm": [b - a for a, b in pairs]}
        pairs = list(zip(_point(old.get("centre_mm")), _point(old.get("size_mm")), strict=True))
        low = [centre - size / 2.0 for centre, size in pairs]
        return {**kept, "min_mm": low, "max_mm": [centre + size / 2.0 for centre, size in pairs]}

    return _changed(cell, key, changed)


def _changed(cell: Cell, key: str, change: Any) -> Cell:
    index = int(key.rpartition(".")[2])
    fixtures = rows_of(cell, "fixtures")
    fixtures[index] = change(fixtures[index])
    return {**cell, "fixtures": fixtures}


def _point(value: object) -> list[float]:
    numbers = value if isinstance(value, list) else []
    return [
        float(numbers[axis])
        if axis < len(numbers) and isinstance(numbers[axis], int | float)
        else 0.0
        for axis in range(3)
    ]
