"""Names of the catalogue: which files hold robots, tools, beams and cells, and what is in them."""

from __future__ import annotations

import difflib
import importlib.resources
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from solver.errors import InputError, UnknownNameError

KINDS: Final = ("robots", "tools", "beams", "cells")
"""Kinds of entries; each is a folder of TOML files."""

RESOURCE_PACKAGE: Final = "posopt_resources"


def resource_folder() -> Path:
    """Find the folder of the shipped data: the installed package, else that of a checkout.

    Raises
    ------
    InputError
        If neither exists (a broken installation).
    """
    try:
        folder = Path(str(importlib.resources.files(RESOURCE_PACKAGE)))
    except ModuleNotFoundError:
        folder = Path(__file__).resolve().parents[2] / "resources"
    if not folder.is_dir():
        raise InputError(
            f"the shipped data are missing: expected the folder {folder}; install posopt again"
        )
    return folder


def is_path(name: str) -> bool:
    """Whether a reference means a file: it ends in .toml or holds a separator."""
    return name.lower().endswith(".toml") or "/" in name or "\\" in name


def normalised(name: str) -> str:
    """Drop spaces and case of a name, so that 'HEB 300' finds 'HEB300'."""
    return re.sub(r"\s+", "", name).casefold()


def shipped_files(kind: str) -> tuple[Path, ...]:
    """All TOML files of a kind, by name."""
    return tuple(sorted((resource_folder() / kind).glob("*.toml")))


def unknown_name(kind: str, name: str, known: tuple[str, ...]) -> UnknownNameError:
    """Build the error for a name that is not there; what resembles it is listed first."""
    by_key = {normalised(one): one for one in known}
    close = difflib.get_close_matches(normalised(name), by_key, n=3, cutoff=0.5)
    first = [by_key[one] for one in close]
    ordered = (*first, *(one for one in known if one not in first))
    shown = name if len(name) <= 60 else name[:57] + "..."
    return UnknownNameError(kind.removesuffix("s"), shown, ordered)


def file_of(kind: str, name_or_path: str | Path, relative_to: Path | None = None) -> Path:
    """Find the file of an entry: a shipped name, or a path (relative to the referring folder).

    Raises
    ------
    UnknownNameError
        If no shipped entry has this name.
    """
    name = str(name_or_path)
    if isinstance(name_or_path, Path) or is_path(name):
        path = Path(name)
        return path if relative_to is None else relative_to / path
    files = {path.stem: path for path in shipped_files(kind)}
    for stem, path in files.items():
        if normalised(stem) == normalised(name):
            return path
    raise unknown_name(kind, name, tuple(files))


def entry_source(
    kind: str,
    name_or_path: str | Path,
    relative_to: Path | None = None,
    files: Mapping[str, bytes] | None = None,
) -> tuple[Path, bytes | None]:
    """Find an entry as `file_of`, or in `files`, which holds files in memory by their references.

    Returns
    -------
    Path, bytes or None
        The file, and its bytes where they are in memory; the path then only names it.

    Raises
    ------
    UnknownNameError
        As `file_of`.
    """
    name = str(name_or_path)
    if files is not None and is_path(name) and name in files:
        return Path(name), files[name]
    return file_of(kind, name_or_path, relative_to), None
