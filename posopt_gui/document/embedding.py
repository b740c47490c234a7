"""Files that a cell names, taken into the project so that it needs nothing besides itself."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from posopt_gui.document.keys import changed_value
from solver.errors import InputError

Cell = Mapping[str, Any]
Files = Mapping[str, bytes]


def embedded(cell: Cell, files: Files, folder: str) -> tuple[Cell, Files]:
    """The cell and its files, with every file that the cell names among them.

    A file that is not in memory yet is read from the disk, and the cell names it without its
    folder from then on. What cannot be read stays as it is: its field says so. Where there is
    nothing to read, both are returned as they are.

    Parameters
    ----------
    cell : mapping
        The tables of a cell.
    files : mapping of name to bytes
        Files in memory by the names that the cell gives them.
    folder : str
        Where relative references of the cell start.
    """
    from posopt_gui.viewmodels.project_files import file_keys, free_name  # noqa: PLC0415 - see `_read`

    for key, name in file_keys(cell).items():
        if name in files:
            continue
        found = _read(key, Path(folder) / name)
        if found is None:
            continue
        wanted, data = found
        others = {other for one, other in file_keys(cell).items() if one != key}
        own = free_name({one: files[one] for one in others if one in files}, wanted, data)
        files = {**files, own: data}
        if own != name:
            cell = changed_value(cell, key, own)
    return cell, files


def _read(key: str, path: Path) -> tuple[str, bytes] | None:
    """Name and bytes of a file that is what its key asks for; None for any other."""
    # The readers take a moment to load; the window is on screen before.
    from solver.catalog.toml_reader import read_toml  # noqa: PLC0415
    from solver.io.importers import path_source  # noqa: PLC0415

    try:
        if key.endswith(".mesh"):
            from solver.collision.mesh_files import whole_file  # noqa: PLC0415 - loads numpy

            return whole_file(path)
        if key == "path.file":
            return path.name, path_source(path).data
        read_toml(path)
        name = _last(path.name)
        return name if name.lower().endswith(".toml") else f"{name}.toml", path.read_bytes()
    except (InputError, OSError, ValueError):
        return None


def _last(name: str) -> str:
    return re.split(r"[\\/]", name)[-1]
