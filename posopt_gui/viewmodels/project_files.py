"""Files that a project carries: its path file, and all others that its cell names."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path, PurePath
from typing import Final

from posopt_gui.viewmodels.form_types import Cell, at, rows_of
from solver.catalog.names import is_path

MESH_SUFFIXES: Final = (".stl", ".obj", ".ply", ".gltf", ".glb")
"""Extensions of mesh files."""

PROJECT: Final = "project"
"""What errors call the inputs, which are in no file of their own."""

TOML_SUFFIX: Final = ".toml"
TOML_KEYS: Final = ("robot.model", "tool.model", "beam.section")
"""Keys that hold a shipped name, or the name of a TOML file."""

Files = Mapping[str, bytes]


def is_mesh(name: str) -> bool:
    """Whether a file is a mesh, by its extension."""
    return PurePath(name).suffix.casefold() in MESH_SUFFIXES


def mesh_keys(cell: Cell) -> dict[str, str]:
    """Which key of a cell names which mesh file."""
    keys = [
        "workpiece.mesh",
        *(f"fixtures.{n}.mesh" for n in range(len(rows_of(cell, "fixtures")))),
    ]
    found = {key: at(cell, key) for key in keys}
    return {key: name for key, name in found.items() if isinstance(name, str)}


def toml_keys(cell: Cell) -> dict[str, str]:
    """Which key of a cell names which TOML file; shipped names are none."""
    found = {key: at(cell, key) for key in TOML_KEYS}
    return {key: name for key, name in found.items() if isinstance(name, str) and is_path(name)}


def file_keys(cell: Cell) -> dict[str, str]:
    """Which key of a cell names which file."""
    path = at(cell, "path.file")
    path_keys = {"path.file": path} if isinstance(path, str) else {}
    return {**toml_keys(cell), **mesh_keys(cell), **path_keys}


def key_of_file(cell: Cell, file: str) -> str | None:
    """The key of a cell that names a file; None where none does."""
    name = Path(file).name
    path = at(cell, "path.file")
    if isinstance(path, str) and Path(path).name == name:
        return "path"
    named = {**mesh_keys(cell), **toml_keys(cell)}
    return next((key for key, one in named.items() if Path(one).name == name), None)


def path_file(files: Files) -> str:
    """Name of the path file that a project carries; '' for none."""
    return next((name for name in files if _is_path_file(name)), "")


def beside_the_path(files: Files) -> dict[str, bytes]:
    """The files of a project but its path file."""
    return {name: data for name, data in files.items() if not _is_path_file(name)}


def kept_files(cell: Cell, files: Files) -> dict[str, bytes]:
    """The path file of a project, and those others that its cell still names."""
    named = set(file_keys(cell).values())
    return {name: data for name, data in files.items() if name in named or _is_path_file(name)}


def free_name(files: Files, name: str, data: bytes) -> str:
    """A name for a file in a project: its own, or a numbered one where that is another file."""
    path = PurePath(name)
    number, free = 1, path.name
    while files.get(free, data) != data:
        number += 1
        free = f"{path.stem}_{number}{path.suffix}"
    return free


def _is_path_file(name: str) -> bool:
    return not is_mesh(name) and PurePath(name).suffix.casefold() != TOML_SUFFIX
