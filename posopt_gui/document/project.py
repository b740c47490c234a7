"""The inputs of a project as plain, frozen data."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from posopt_gui.document.embedding import embedded
from posopt_gui.document.keys import changed_value, value_at
from solver.errors import InputError, Place
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
        The files that the cell refers to, by the names that it gives them.
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
        from posopt_gui.viewmodels.project_files import PROJECT  # noqa: PLC0415
        from solver.catalog.cells import read_cell  # noqa: PLC0415
        from solver.catalog.toml_reader import Table  # noqa: PLC0415

        table = Table(self.cell, PROJECT, folder=Path(self.folder))
        return read_cell(table, files=self.files)

    def value(self, key: str) -> Any:
        """What a dotted key such as 'beam.section' or 'fixtures.0.min_mm' holds; None without."""
        return value_at(self.cell, key)

    def with_value(self, key: str, value: Any) -> ProjectState:
        """The state with another value under a dotted key; None removes the key."""
        return replace(self, cell=changed_value(self.cell, key, value))

    def with_its_files(self) -> ProjectState:
        """The state with every file that its cell names; itself where there is nothing to read."""
        cell, files = embedded(self.cell, self.files, self.folder)
        return self if files is self.files else replace(self, cell=cell, files=files)


def state_of_cell(name_or_path: str | Path) -> ProjectState:
    """The inputs of a shipped cell or of a cell's TOML file, all files that it names included.

    Raises
    ------
    InputError
        If the cell, or the path file that it names, cannot be read. What is wrong with another
        file is told when the cell is built.
    """
    from solver.catalog.names import file_of  # noqa: PLC0415
    from solver.catalog.toml_reader import read_toml  # noqa: PLC0415
    from solver.io.importers import path_source  # noqa: PLC0415

    path = file_of("cells", name_or_path)
    table = read_toml(path)
    values = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    if not isinstance(values.get("cell"), dict):
        raise InputError("is no cell: its table [cell] is missing", Place(str(path)))
    state = ProjectState(cell=values, folder=str(path.parent.absolute())).with_its_files()
    reference = state.value("path.file")
    if isinstance(reference, str) and reference not in state.files:
        path_source(table.folder / reference)
    return state


def key_of_error(error: InputError) -> str | None:
    """The dotted key of the cell that an error is about, as `ProjectState.value` takes it."""
    place = error.place
    if place is None or place.key is None:
        return None
    return place.key.replace("[", ".").replace("]", "")
