"""H sections as TOML: one file per series, a list of sections in each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from solver.catalog.names import entry_source, is_path, normalised, shipped_files, unknown_name
from solver.catalog.robots import read_sources
from solver.catalog.toml_reader import Table, read_toml
from solver.errors import InputError, Place
from solver.model.workpiece import BeamSection


@dataclass(frozen=True, slots=True)
class BeamEntry:
    """A section of a series; `later_root` [m] is the root radius of later editions, if known."""

    section: BeamSection
    series: str
    later_root: float | None = None


def load_beam(
    name: str | Path,
    *,
    relative_to: Path | None = None,
    files: Mapping[str, bytes] | None = None,
) -> BeamSection:
    """Load a section by name ('HW300', 'hea 200'), or the only one of a TOML file.

    `files` holds TOML files in memory by the references under which they are asked for.

    Raises
    ------
    UnknownNameError
        If no shipped series has this section.
    InputError
        If the file is unusable or holds more than one section.
    """
    if isinstance(name, Path) or is_path(name):
        path, data = entry_source("beams", name, relative_to, files)
        entries = read_series(path, data)
        if len(entries) != 1:
            raise InputError(
                f"expected one section, found {len(entries)}", Place(str(path), key="sections")
            )
        return entries[0].section
    entries = beam_entries()
    for entry in entries:
        if normalised(entry.section.name) == normalised(name):
            return entry.section
    raise unknown_name("beams", name, tuple(entry.section.name for entry in entries))


def beam_entries() -> tuple[BeamEntry, ...]:
    """All shipped sections, series by series."""
    return tuple(entry for path in shipped_files("beams") for entry in read_series(path))


def read_series(path: Path, data: bytes | None = None) -> tuple[BeamEntry, ...]:
    """All sections of a series file; `data` are its bytes where they are in memory already."""
    document = read_toml(path, data)
    head = document.table("series")
    series, standard = head.text("title"), head.text("standard")
    entries = tuple(_entry(one, series, standard) for one in document.tables("sections"))
    document.texts("assumptions", default=())
    read_sources(document)
    document.finish()
    names = [normalised(entry.section.name) for entry in entries]
    for index, one in enumerate(names):
        if one in names[:index]:
            raise document.error(f"sections[{index}].name", "two sections have this name")
    return entries


def read_dimensions(table: Table, name: str, source: str = "") -> BeamSection:
    """Read an H section from its dimensions; without a root radius it has sharp roots."""
    with table.located():
        return BeamSection(
            name=name,
            height=table.number("height_mm"),
            width=table.number("width_mm"),
            web=table.number("web_mm"),
            flange=table.number("flange_mm"),
            root=table.number("root_mm", 0.0),
            source=source,
        )


def _entry(table: Table, series: str, standard: str) -> BeamEntry:
    section = read_dimensions(table, table.name("name"), standard)
    later = table.number("later_root_mm", low=0.0) if table.has("later_root_mm") else None
    return BeamEntry(section, series, later)
