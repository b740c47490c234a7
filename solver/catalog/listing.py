"""What the catalogue holds, as names and as described entries."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from solver.catalog.beams import BeamEntry, beam_entries
from solver.catalog.names import KINDS, shipped_files
from solver.catalog.toml_reader import read_toml
from solver.errors import InputError
from solver.units import MM_PER_M


@dataclass(frozen=True, slots=True)
class CatalogEntry:
    """A shipped entry: its name, one line about it, and the file that holds it."""

    name: str
    title: str
    file: Path | None = None


def list_names(kind: str) -> tuple[str, ...]:
    """Names of all shipped entries of a kind: 'robots', 'tools', 'beams' or 'cells'."""
    return tuple(entry.name for entry in describe(kind))


def describe(kind: str) -> tuple[CatalogEntry, ...]:
    """All shipped entries of a kind with a line about each; lengths in the lines are in mm.

    Raises
    ------
    InputError
        If the kind is none of the four.
    """
    if kind not in KINDS:
        raise InputError(f"the catalogue has no {kind!r}; expected one of {', '.join(KINDS)}")
    if kind == "beams":
        return tuple(_beam(entry) for entry in beam_entries())
    entries = []
    for path in shipped_files(kind):
        head = read_toml(path).table(kind.removesuffix("s"))
        entries.append(CatalogEntry(path.stem, head.text("title"), path))
    return tuple(entries)


def _beam(entry: BeamEntry) -> CatalogEntry:
    one = entry.section
    height, width, web, flange, root = (
        value * MM_PER_M for value in (one.height, one.width, one.web, one.flange, one.root)
    )
    later = ""
    if entry.later_root is not None:
        later = f" (later editions {entry.later_root * MM_PER_M:g})"
    title = f"{height:g} x {width:g} x {web:g} x {flange:g} mm, root {root:g} mm{later}"
    return CatalogEntry(one.name, f"{title}, {one.source}")
