"""A path file becomes the path of a project."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Final

from posopt_gui.document.project import ProjectState
from solver.errors import PosoptError

PATH_SUFFIXES: Final = (".csv", ".txt", ".tsv", ".json", ".ls")
"""Endings of path files."""


class PathError(PosoptError):
    """A path file that cannot be the path of the project."""

    def __init__(self, path: Path, error: PosoptError) -> None:
        self.path, self.error = path, error
        super().__init__(str(error))


def is_path_file(file: str | Path) -> bool:
    """Whether a file is a path, by its ending."""
    return Path(file).suffix.lower() in PATH_SUFFIXES


def state_with_path(state: ProjectState, name: str, data: bytes) -> ProjectState:
    """The state with a path file in place of its path; what else is said of paths stays."""
    # What is imported here takes a moment; the window is on screen before.
    from posopt_gui.viewmodels.path_preview import without_frame  # noqa: PLC0415
    from posopt_gui.viewmodels.project_files import beside_the_path  # noqa: PLC0415

    cell = {**state.cell, "path": without_frame(state.cell, name)}
    files = {**beside_the_path(state.files), name: data}
    return replace(state, cell=cell, files=files, pins=(), regions=())


def path_for(state: ProjectState, path: Path) -> tuple[str, bytes]:
    """Read a path file, and try whether the cell can be built with it.

    Raises
    ------
    PathError
        When it cannot.
    """
    from solver.io.importers import path_source  # noqa: PLC0415 - loaded when it is needed

    try:
        data = path_source(path).data
        state_with_path(state, path.name, data).problem()
    except PosoptError as error:
        raise PathError(path, error) from error
    return path.name, data
