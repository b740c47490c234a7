"""The importers by file extension; a new one is a file and a line here.

Each is loaded when its first file is read, so that asking for an extension costs nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

from solver.errors import InputError, Place
from solver.io.importers.naming import listed, shown
from solver.io.importers.source import Source, read_source

if TYPE_CHECKING:
    from solver.io.importers.options import ImportOptions
    from solver.model.toolpath import Toolpath

Importer = Callable[[Source, "ImportOptions"], "Toolpath"]
"""Reads the bytes of a file; every refusal is an InputError."""


def _importer_in(module: str, function: str) -> Importer:
    """An importer that loads its module when it is first called."""

    def run(source: Source, options: ImportOptions) -> Toolpath:
        importer: Importer = getattr(import_module(f"solver.io.importers.{module}"), function)
        return importer(source, options)

    return run


IMPORTERS: Final[Mapping[str, Importer]] = MappingProxyType(
    {
        ".csv": _importer_in("csv_path", "import_csv"),
        ".txt": _importer_in("csv_path", "import_csv"),
        ".tsv": _importer_in("csv_path", "import_csv"),
        ".json": _importer_in("json_path", "import_json"),
        ".ls": _importer_in("ls_path", "import_ls"),
    }
)
"""Extension in lower case -> importer."""


def load_toolpath(path: str | Path, options: ImportOptions | None = None) -> Toolpath:
    """Read a path file in the format that its extension names.

    Parameters
    ----------
    path : str or Path
        A .csv, .txt, .tsv, .json or .ls file of at most 64 MB.
    options : ImportOptions, optional
        What the file does not say itself.

    Returns
    -------
    Toolpath
        Poses in the frame that the file or the options state; lengths in [m].

    Raises
    ------
    InputError
        One sentence that names the file, the line and the column.
    """
    return import_source(path_source(path), options)


def path_source(path: str | Path) -> Source:
    """Read the bytes of a path file whose extension names a known format."""
    _importer(str(path))
    return read_source(path)


def import_source(source: Source, options: ImportOptions | None = None) -> Toolpath:
    """Read a path from bytes in memory; the extension of `source.file` names the format."""
    from solver.io.importers.options import ImportOptions  # noqa: PLC0415 - loads numpy
    from solver.io.importers.resampling import resample  # noqa: PLC0415

    chosen = options or ImportOptions()
    importer = _importer(source.file)
    toolpath = importer(source, chosen)
    return toolpath if chosen.resample is None else resample(toolpath, chosen.resample)


def _importer(file: str) -> Importer:
    extension = Path(file).suffix.casefold()
    importer = IMPORTERS.get(extension)
    if importer is None:
        raise InputError(
            f"the extension {shown(extension)} names no path format, "
            f"expected {listed(IMPORTERS, 'or')}",
            Place(file),
        )
    return importer
