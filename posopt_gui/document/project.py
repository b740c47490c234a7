"""The inputs of a project as plain, frozen data."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from solver.errors import InputError
from solver.model.wishes import Pin, Region

if TYPE_CHECKING:
    from solver.model.problem import PlanningProblem


@dataclass(frozen=True, slots=True)
class ProjectState:
    """Everything that a plan depends on.

    Attributes
    ----------
    cell : mapping
        The tables of a cell's TOML file as nested dictionaries and lists.
    files : mapping of name to bytes
        Path files that the cell refers to.
    pins, regions : tuples
        What the sequence must pass and must not pass.
    folder : str
        Where relative references of the cell start ('' for none).
    """

    cell: Mapping[str, Any]
    files: Mapping[str, bytes] = field(default_factory=dict)
    pins: tuple[Pin, ...] = ()
    regions: tuple[Region, ...] = ()
    folder: str = ""

    def problem(self) -> PlanningProblem:
        """Build the planning problem.

        Raises
        ------
        InputError
            Naming the key of the cell that cannot be used (`error.place.key`).
        """
        # The catalogue takes a moment to load; the window is on screen before.
        from solver.catalog.cells import read_cell  # noqa: PLC0415
        from solver.catalog.toml_reader import Table  # noqa: PLC0415

        file = str(Path(self.folder) / "cell.toml") if self.folder else "project"
        return read_cell(Table(self.cell, file), files=self.files)

    def value(self, key: str) -> Any:
        """What a dotted key such as 'beam.section' or 'fixtures.0.min_mm' holds; None without."""
        found: Any = self.cell
        for part in key.split("."):
            found = _child(found, part)
            if found is None:
                return None
        return found

    def with_value(self, key: str, value: Any) -> ProjectState:
        """The state with another value under a dotted key; None removes the key."""
        return replace(self, cell=_changed(self.cell, key.split("."), value))


def _child(container: Any, part: str) -> Any:
    if isinstance(container, Mapping):
        return container.get(part)
    if isinstance(container, list) and part.isdecimal() and int(part) < len(container):
        return container[int(part)]
    return None


def _changed(container: Any, parts: list[str], value: Any) -> Any:
    first, rest = parts[0], parts[1:]
    if isinstance(container, list):
        items = list(container)
        index = int(first)
        if rest:
            items[index] = _changed(items[index], rest, value)
        elif value is None:
            del items[index]
        elif index == len(items):
            items.append(value)
        else:
            items[index] = value
        return items
    table = dict(container or {})
    if rest:
        table[first] = _changed(table.get(first, {}), rest, value)
    elif value is None:
        table.pop(first, None)
    else:
        table[first] = value
    return table


def state_of_cell(name_or_path: str | Path) -> ProjectState:
    """The inputs of a shipped cell or of a cell's TOML file, its path file included.

    Raises
    ------
    InputError
        If the cell, or the path file that it names, cannot be read.
    """
    from solver.catalog.names import file_of  # noqa: PLC0415
    from solver.catalog.toml_reader import read_toml  # noqa: PLC0415
    from solver.io.importers import path_source  # noqa: PLC0415

    path = file_of("cells", name_or_path)
    table = read_toml(path)
    values = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    files = {}
    reference = values.get("path", {}).get("file")
    if isinstance(reference, str):
        name = Path(reference).name
        files[name] = path_source(table.folder / reference).data
        values["path"]["file"] = name
    return ProjectState(cell=values, files=files, folder=str(path.parent.absolute()))


def key_of_error(error: InputError) -> str | None:
    """The dotted key of the cell that an error is about, as `ProjectState.value` takes it."""
    place = error.place
    if place is None or place.key is None:
        return None
    return place.key.replace("[", ".").replace("]", "")
