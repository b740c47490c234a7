"""What the catalogue and the cell itself say about what its form offers."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from posopt_gui.viewmodels.form_types import Cell, Choice, at, table_of
from solver.catalog.beams import BeamEntry, beam_entries, load_beam, read_dimensions
from solver.catalog.cell_workpiece import DIMENSIONS, read_workpiece
from solver.catalog.listing import describe
from solver.catalog.names import normalised
from solver.catalog.robots import load_robot
from solver.catalog.toml_reader import Table
from solver.catalog.tools import load_tool
from solver.errors import InputError
from solver.io.importers.beam_faces import Face, faces_of
from solver.model.robot import Robot
from solver.model.tool import Tool
from solver.model.workpiece import BeamSection, Workpiece
from solver.units import MM_PER_M

Files = Mapping[str, bytes]
Found = TypeVar("Found")

FREE = "free"
"""Name of the standard of a section that is stated by its dimensions."""


class Catalogue:
    """The shipped robots, tools and sections; robots and tools are read once each."""

    def __init__(self) -> None:
        self.beams: tuple[BeamEntry, ...] = beam_entries()
        self.robots = _choices("robots")
        self.tools = _choices("tools")
        self._robots: dict[tuple[str, str, bytes | None], Robot] = {}
        self._tools: dict[tuple[str, str, bytes | None], Tool] = {}

    @property
    def series(self) -> tuple[str, ...]:
        """Titles of the series of sections."""
        return tuple(dict.fromkeys(entry.series for entry in self.beams))

    def sections(self, series: str) -> tuple[BeamEntry, ...]:
        """The sections of a series."""
        return tuple(entry for entry in self.beams if entry.series == series)

    def entry(self, name: object) -> BeamEntry | None:
        """The shipped section of a name."""
        wanted = normalised(name) if isinstance(name, str) else None
        return next((one for one in self.beams if normalised(one.section.name) == wanted), None)

    def robot(self, name: object, folder: str, files: Files) -> Robot | None:
        """A robot by name or file; None where there is none."""
        return _looked_up(self._robots, load_robot, name, folder, files)

    def tool(self, name: object, folder: str, files: Files) -> Tool | None:
        """A tool by name or file; None where there is none."""
        return _looked_up(self._tools, load_tool, name, folder, files)


def _looked_up(
    known: dict[tuple[str, str, bytes | None], Found],
    load: Callable[..., Found],
    name: object,
    folder: str,
    files: Files,
) -> Found | None:
    """What has a name, in memory or in the catalogue; read once."""
    if not isinstance(name, str):
        return None
    key = folder, name, files.get(name)
    if key not in known:
        try:
            known[key] = load(name, relative_to=Path(folder), files=files)
        except InputError:
            return None
    return known[key]


@dataclass(frozen=True, slots=True, eq=False)
class Facts:
    """What a cell refers to; None where it cannot be found or contradicts itself.

    `section` is the one that the cell states, `catalogue_section` the shipped one of its name.
    """

    robot: Robot | None
    tool: Tool | None
    section: BeamSection | None
    catalogue_section: BeamSection | None
    workpiece: Workpiece | None
    faces: Mapping[str, Face]

    @property
    def world_height(self) -> float:
        """Height of fanuc_world above the floor [m]."""
        return self.robot.world_height if self.robot is not None else 0.0


def facts_of(
    cell: Cell, catalogue: Catalogue, folder: str = "", files: Files | None = None
) -> Facts:
    """Look up what a cell refers to, in memory first."""
    files = files or {}
    robot = catalogue.robot(at(cell, "robot.model"), folder, files)
    tool = catalogue.tool(at(cell, "tool.model"), folder, files)
    named = _named_section(cell, catalogue, folder, files)
    section = _section(cell, named)
    workpiece = None
    # A mesh is not read here: it may take long, and only its group is shown.
    if robot is not None and section is not None and "workpiece" not in cell:
        workpiece = _workpiece(cell, section, robot)
    faces: Mapping[str, Face] = {}
    if section is not None:
        filleted = at(cell, "beam.fillets", True) is True
        faces = faces_of(section, section.root if filleted else 0.0)
    return Facts(robot, tool, section, named, workpiece, faces)


def has_free_dimensions(cell: Cell) -> bool:
    """Whether the section is stated by its dimensions."""
    return any(at(cell, f"beam.{key}") is not None for key in DIMENSIONS)


def _choices(kind: str) -> tuple[Choice, ...]:
    return tuple(
        Choice(entry.name, entry.name, entry.title, plain=True) for entry in describe(kind)
    )


def _named_section(
    cell: Cell, catalogue: Catalogue, folder: str, files: Files
) -> BeamSection | None:
    name = at(cell, "beam.section")
    entry = catalogue.entry(name)
    if entry is not None:
        return entry.section
    if not isinstance(name, str) or has_free_dimensions(cell):
        return None
    try:
        return load_beam(name, relative_to=Path(folder), files=files)
    except InputError:
        return None


def _section(cell: Cell, named: BeamSection | None) -> BeamSection | None:
    table = at(cell, "beam")
    if not isinstance(table, dict):
        return None
    if not has_free_dimensions(cell):
        if named is None or "root_mm" not in table:
            return named
        table = {**dimensions_mm(named), "root_mm": table["root_mm"]}
    try:
        return read_dimensions(Table(table, "project", "beam"), "custom")
    except InputError:
        return None


def dimensions_mm(section: BeamSection) -> dict[str, float]:
    """The five dimensions of a section by the keys of a cell [mm]."""
    values = (section.height, section.width, section.web, section.flange, section.root)
    return {key: in_mm(value) for key, value in zip((*DIMENSIONS, "root_mm"), values, strict=True)}


def in_mm(length: float) -> float:
    """A length [m] in mm, free of the noise of its conversion."""
    return round(length * MM_PER_M, 9)


def _workpiece(cell: Cell, section: BeamSection, robot: Robot) -> Workpiece | None:
    # Stated by its dimensions, the section is not looked up in the files of the catalogue again.
    beam = {**table_of(cell, "beam"), **dimensions_mm(section), "section": section.name}
    try:
        return read_workpiece(Table({"beam": beam}, "project"), None, robot)
    except InputError:
        return None
