"""A path file before it is taken: its first rows, which column is what, and what is missing."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from itertools import chain, islice
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

from posopt_gui.viewmodels.form_types import Cell, table_of
from posopt_gui.viewmodels.project_files import PROJECT
from solver.catalog.cell_path import KINDS, PathOwner, read_path
from solver.catalog.cell_workpiece import read_workpiece
from solver.catalog.robots import load_robot
from solver.catalog.toml_reader import Table
from solver.catalog.tools import load_tool
from solver.errors import InputError
from solver.io.importers import Source
from solver.io.importers.columns import (
    FIELDS,
    NORMAL,
    POSITION,
    QUATERNION,
    WPR,
    columns_from_header,
    fitting_titles,
)
from solver.io.importers.registry import IMPORTERS
from solver.io.importers.table import Row, read_table
from solver.model.toolpath import Toolpath

SHOWN_ROWS: Final = 12
"""Rows of a table that are shown."""

TABLES: Final = (".csv", ".txt", ".tsv")
"""Extensions of tables, whose columns can be mapped."""

SUFFIXES: Final = tuple(IMPORTERS)
"""Extensions of path files."""

_UNIT: Final = re.compile(r"[\[(（]\s*([^\])）]*?)\s*[\])）]\s*$")
_ENDINGS: Final = {"_mm_s": "mm/s", "_m_s": "m/s", "_mm": "mm", "_m": "m", "_deg": "deg"}
_NUMBER: Final = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
_GUESSES: Final[Mapping[str, str]] = MappingProxyType(
    {name: name for name in FIELDS}
    | {f"{word}{axis}": axis for axis in POSITION for word in ("pos", "position", "coord", "point")}
    | {f"{axis}{word}": axis for axis in POSITION for word in ("pos", "position", "coord")}
    | {f"{word}{axis}": f"n{axis}" for axis in POSITION for word in ("normal", "norm", "nrm")}
    | {f"{axis}normal": f"n{axis}" for axis in POSITION}
    | {
        f"{word}{axis}": f"t{axis}"
        for axis in POSITION
        for word in ("travel", "tangent", "dir", "direction")
    }
    | {f"{word}{axis}": f"q{axis}" for axis in "wxyz" for word in ("quat", "quaternion", "rot")}
    | {f"{word}{i}": n for i, n in zip("ijk", NORMAL, strict=True) for word in ("", "normal")}
    | {"yaw": "r", "pitch": "p", "roll": "w", "speed": "feed", "feedrate": "feed"}
)
"""Titles without blanks, signs and unit, in lower case -> the field that they probably mean."""


@dataclass(frozen=True, slots=True, eq=False)
class PathPreview:
    """What is known of a path file.

    Attributes
    ----------
    source : Source
        Its name and bytes.
    titles : tuple of str
        Cells of the header; numbers of the columns where there is none.
    rows : tuple of tuples of str
        The first rows with points.
    header : bool
        Whether the first row holds titles.
    understood : bool
        Whether the importer understands the header by itself.
    mapping : mapping of field to column from 0
        As stated, else as the titles suggest.
    toolpath : Toolpath or None
        The path, where it can be read.
    error : InputError or None
        Why it cannot.
    frame_said : bool
        Whether the file, or a person for it, says its frame; else that of another file is shown.
    """

    source: Source
    titles: tuple[str, ...] = ()
    rows: tuple[tuple[str, ...], ...] = ()
    header: bool = True
    understood: bool = True
    mapping: Mapping[str, int] = field(default_factory=dict)
    toolpath: Toolpath | None = None
    error: InputError | None = None
    frame_said: bool = True

    @property
    def name(self) -> str:
        """Name of the file without its folder."""
        return Path(self.source.file).name

    @property
    def mappable(self) -> bool:
        """Whether the file is a table whose columns can be told."""
        return bool(self.titles)

    @property
    def askable(self) -> bool:
        """Whether a person is asked: for guessed columns, or for what the file leaves open."""
        if (self.mappable and not self.understood) or not self.frame_said:
            return True
        if self.error is None:
            return False
        words = ("the frame of the poses is not stated", "the file states", "no orientation")
        return any(word in self.error.message for word in words)


def examine(
    source: Source,
    cell: Cell,
    *,
    folder: str = "",
    files: Mapping[str, bytes] | None = None,
    path: Mapping[str, Any] | None = None,
    mapping: Mapping[str, int] | None = None,
    header: bool | None = None,
) -> PathPreview:
    """Look into a path file and read it as the cell would.

    Parameters
    ----------
    source : Source
        The file's name and bytes.
    cell : mapping
        The cell that takes the path.
    folder : str
        Where relative references of the cell start.
    files : mapping of name to bytes, optional
        Files that the cell names and the project carries.
    path : mapping, optional
        The cell's table `path` for this file; None takes `path_table`.
    mapping : mapping of field to column from 0, optional
        Which column is what; None takes the titles as the importer understands them.
    header : bool, optional
        Whether the first row holds titles; None looks for itself.
    """
    source = Source(Path(source.file).name, source.data)
    found = PathPreview(source)
    if Path(source.file).suffix.casefold() in TABLES:
        try:
            found = _table(source, mapping, header)
        except InputError as error:
            return PathPreview(source, error=error)
    table = dict(path_table(cell, source.file) if path is None else path)
    try:
        taken = taken_source(found)
        toolpath = _read(taken, cell, {**table, "file": taken.file}, folder, files)
    except InputError as error:
        return _with(found, error=error)
    if path is None and not _says_its_frame(taken, cell, table, folder, files):
        return replace(_with(found, toolpath=toolpath), frame_said=False)
    return _with(found, toolpath=toolpath)


def without_frame(cell: Cell, file: str) -> dict[str, Any]:
    """`path_table` without the frame that was said of another file: none is ever guessed."""
    table = path_table(cell, file)
    if table_of(cell, "path").get("file") != table["file"]:
        table.pop("frame", None)
    return table


def _says_its_frame(
    source: Source,
    cell: Cell,
    table: Mapping[str, Any],
    folder: str,
    files: Mapping[str, bytes] | None,
) -> bool:
    own = without_frame(cell, source.file)
    if own == table:
        return True
    try:
        _read(source, cell, own, folder, files)
    except InputError:
        return False
    return True


def path_table(cell: Cell, file: str) -> dict[str, Any]:
    """The cell's table `path` with a file as its path."""
    kept = {key: value for key, value in table_of(cell, "path").items() if key not in KINDS}
    return {**kept, "file": Path(file).name}


def taken_source(preview: PathPreview) -> Source:
    """The file as the project takes it: as it is, or with the columns that were told."""
    if not preview.mappable or preview.understood:
        return preview.source
    return Source(preview.source.file, remapped(preview.source, preview.mapping, preview.header))


def remapped(source: Source, mapping: Mapping[str, int], header: bool) -> bytes:
    """The table with only the mapped columns under the importer's own titles.

    Every cell stays as it is, and so do statements above the table and the units of titles.
    """
    table = read_table(source.file, source.text(), fitting_titles)
    columns = sorted((column, name) for name, column in mapping.items() if name in FIELDS)
    lines = [f"# {name}: {one.value}" for name, one in table.directives.items()]
    first = table.first.cells
    titles = [
        name + (f"[{_unit(first[column])}]" if header and _unit(first[column]) else "")
        for column, name in columns
    ]
    lines.append(",".join(_quoted(title) for title in titles))
    rows: Iterable[Row] = table.rows() if header else chain([table.first], table.rows())
    lines += [",".join(_quoted(row.cells[column]) for column, _ in columns) for row in rows]
    return ("\n".join(lines) + "\n").encode()


def guessed_mapping(titles: Iterable[str]) -> dict[str, int]:
    """Which field each title probably means -> its column from 0; incomplete groups are left."""
    found: dict[str, int] = {}
    for column, title in enumerate(titles):
        name = _GUESSES.get(_bare(title))
        if name is not None and name not in found:
            found[name] = column
    groups = [group for group in (QUATERNION, WPR, NORMAL) if all(one in found for one in group)]
    for group in (QUATERNION, WPR, NORMAL):
        # One statement of the orientation is enough, and half of one is none.
        if group not in groups[:1]:
            for name in group:
                found.pop(name, None)
    tangents = ("tx", "ty", "tz")
    if "nx" not in found or not all(one in found for one in tangents):
        for name in tangents:
            found.pop(name, None)
    return found


def _table(source: Source, mapping: Mapping[str, int] | None, header: bool | None) -> PathPreview:
    table = read_table(source.file, source.text(), fitting_titles)
    first = table.first
    if header is None:
        header = not all(_NUMBER.fullmatch(cell) for cell in first.cells if cell)
    rows = [row.cells for row in islice(table.rows(), SHOWN_ROWS)]
    understood = header and mapping is None
    if understood:
        try:
            columns_from_header(first, source.file)
        except InputError:
            understood = False
    if not header:
        rows = [first.cells, *rows][:SHOWN_ROWS]
    titles = first.cells if header else tuple(str(n + 1) for n in range(len(first.cells)))
    if mapping is None:
        mapping = guessed_mapping(first.cells) if header else {}
        if not header and len(first.cells) >= len(POSITION):
            mapping = {name: column for column, name in enumerate(POSITION)}
    return PathPreview(
        source, titles, tuple(rows), header, understood, MappingProxyType(dict(mapping))
    )


def _read(
    source: Source,
    cell: Cell,
    path: Mapping[str, Any],
    folder: str,
    files: Mapping[str, bytes] | None,
) -> Toolpath:
    # As in a project: references start in its folder, the file itself is in memory.
    document = Table({**cell, "path": dict(path)}, PROJECT, folder=Path(folder))
    robot_name = document.table("robot").text("model")
    tool_name = document.table("tool").text("model")
    robot = load_robot(robot_name, relative_to=document.folder, files=files)
    tool = load_tool(tool_name, relative_to=document.folder, files=files)
    workpiece = read_workpiece(document, None, robot, files)
    owner = PathOwner(workpiece, robot, tool, {source.file: source.data})
    return read_path(document.table("path"), owner)


def _with(
    found: PathPreview, toolpath: Toolpath | None = None, error: InputError | None = None
) -> PathPreview:
    return PathPreview(
        found.source,
        found.titles,
        found.rows,
        found.header,
        found.understood,
        found.mapping,
        toolpath,
        error,
    )


def _bare(title: str) -> str:
    text = _UNIT.sub("", title).strip().casefold()
    for ending in _ENDINGS:
        text = text.removesuffix(ending)
    return re.sub(r"[\s_\-.:]+", "", text)


def _unit(title: str) -> str:
    if found := _UNIT.search(title):
        return found[1]
    return next((unit for end, unit in _ENDINGS.items() if title.casefold().endswith(end)), "")


def _quoted(cell: str) -> str:
    if any(mark in cell for mark in ',"') or cell[:1] in ("#", ";", "/"):
        doubled = cell.replace('"', '""')
        return f'"{doubled}"'
    return cell
