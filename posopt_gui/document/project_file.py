"""The project file: one JSON with every input inside, written whole or not at all."""

from __future__ import annotations

import base64
import json
import stat
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from posopt_gui.document.project import ProjectState
from posopt_gui.document.project_json import located, strict_json
from solver.errors import InputError, Place
from solver.io.atomic import write_atomically
from solver.model.wishes import Pin, Region

FORMAT: Final = "posopt-project"
VERSION: Final = 2
READ_VERSIONS: Final = (1, 2)
"""A project of version 1 carries its path file alone."""

SUFFIX: Final = ".posopt"
SIZE_LIMIT: Final = 256 * 1024 * 1024
"""Largest project file that is read [bytes]."""

KEYS: Final = ("format", "version", "folder", "cell", "files", "pins", "regions")
PIN_KEYS: Final = ("waypoint", "lean", "branch", "turn")
REGION_KEYS: Final = ("first", "last", "low", "high", "branch")

DEPTH_LIMIT: Final = 50
"""Deepest nesting of the cell's tables and lists."""


def save_project(state: ProjectState, path: Path) -> None:
    """Write a project; a reader sees the old file or the new one, never a part.

    Raises
    ------
    InputError
        When it cannot be written.
    """
    write_atomically(path, project_bytes(state))


def project_bytes(state: ProjectState) -> bytes:
    """The bytes of a project file; the same state gives the same bytes.

    Raises
    ------
    InputError
        When the state holds what JSON cannot say, such as an infinite number or a date.
    """
    document = {
        "format": FORMAT,
        "version": VERSION,
        "folder": state.folder,
        "cell": state.cell,
        "files": {
            name: base64.b64encode(data).decode("ascii") for name, data in state.files.items()
        },
        "pins": [
            {"waypoint": one.waypoint, "lean": one.lean, "branch": one.branch, "turn": one.turn}
            for one in state.pins
        ],
        "regions": [
            {
                "first": one.first,
                "last": one.last,
                "low": one.low,
                "high": one.high,
                "branch": one.branch,
            }
            for one in state.regions
        ],
    }
    try:
        data = json.dumps(document, ensure_ascii=False, indent=1, allow_nan=False).encode()
    except (TypeError, ValueError, RecursionError) as error:
        raise InputError(f"the project cannot be saved ({_short(error)})") from error
    if len(data) > SIZE_LIMIT:
        size, most = (one // 2**20 for one in (len(data), SIZE_LIMIT))
        raise InputError(
            f"the project cannot be saved: with its files it has {size} MB, at most {most} MB are "
            "read; use smaller meshes"
        )
    return data


def load_project(path: Path) -> ProjectState:
    """Read a project file.

    Raises
    ------
    InputError
        When it cannot be read or is no whole and sound project, with what was expected.
    """
    place = Place(str(path))
    try:
        status = Path(path).stat()
        if not stat.S_ISREG(status.st_mode):
            raise InputError("is no file, expected a posopt project", place)
        if status.st_size > SIZE_LIMIT:
            size, most = (one // 2**20 for one in (status.st_size, SIZE_LIMIT))
            raise InputError(f"has {size} MB, expected a project of at most {most} MB", place)
        data = Path(path).read_bytes()
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(f"cannot be read ({reason})", place) from error
    # What an older version left out is taken in where it is still there.
    return read_project(data, str(path)).with_its_files()


def read_project(data: bytes, file: str) -> ProjectState:
    """Read the content of a project file; `file` is its name for errors.

    Raises
    ------
    InputError
        With line and column of what does not belong there.
    """
    document = strict_json(data, file)
    try:
        if b"\\u" in data:
            _refuse_half_characters(document, file)
        return _project(document, file)
    except InputError as error:
        raise located(error, data) from error


def _project(document: Any, file: str) -> ProjectState:
    place = Place(file)
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise InputError("is no posopt project: its 'format' is missing", place)
    version = document.get("version")
    if isinstance(version, bool) or version not in READ_VERSIONS:
        known = " and ".join(str(one) for one in READ_VERSIONS)
        raise InputError(f"has version {_short(version)}, this posopt reads {known}", place)
    _refuse_unknown(document, KEYS, "", file)
    return ProjectState(
        cell=_cell(document, file),
        files=_files(document, file),
        pins=tuple(_pin(one, file, i) for i, one in enumerate(_rows(document, "pins", file))),
        regions=tuple(
            _region(one, file, i) for i, one in enumerate(_rows(document, "regions", file))
        ),
        folder=_text(document.get("folder", ""), "folder", file),
    )


def _short(value: object) -> str:
    return repr(str(value)[:80])


def _expected(file: str, key: str, what: str, found: object) -> InputError:
    return InputError(f"expected {what}, found {_short(found)}", Place(file, key=key))


def _cell(document: Mapping[str, Any], file: str) -> dict[str, Any]:
    cell = document.get("cell")
    if not isinstance(cell, dict):
        raise _expected(file, "cell", "a table", cell)
    if _depth(cell) > DEPTH_LIMIT:
        raise InputError("tables are nested too deeply", Place(file, key="cell"))
    return cell


def _refuse_unknown(table: Any, known: tuple[str, ...], key: str, file: str) -> None:
    """Refuse what this posopt does not know, since it would be lost when the project is saved."""
    for name in table if isinstance(table, dict) else ():
        if name not in known:
            place = Place(file, key=f"{key}.{name}" if key else name)
            raise InputError(f"unknown key, expected one of {', '.join(known)}", place)


def _refuse_half_characters(data: object, file: str) -> None:
    """JSON may escape one half of a character, which no file can hold."""
    try:
        json.dumps(data, ensure_ascii=False).encode()
    except UnicodeEncodeError as error:
        raise InputError("a text holds half a character", Place(file)) from error


def _depth(value: Any, level: int = 1) -> int:
    children = value.values() if isinstance(value, dict) else value
    if not isinstance(value, dict | list) or level > DEPTH_LIMIT:
        return level
    return max((_depth(one, level + 1) for one in children), default=level)


def _files(document: Mapping[str, Any], file: str) -> dict[str, bytes]:
    files = document.get("files", {})
    if not isinstance(files, dict):
        raise _expected(file, "files", "a table of names", files)
    found = {}
    for name, text in files.items():
        try:
            found[name] = base64.b64decode(_text(text, f"files.{name}", file), validate=True)
        except ValueError as error:
            raise _expected(file, f"files.{name}", "Base64", text) from error
    return found


def _rows(document: Mapping[str, Any], key: str, file: str) -> list[Any]:
    rows = document.get(key, [])
    if not isinstance(rows, list):
        raise _expected(file, key, "a list", rows)
    return rows


def _pin(row: Any, file: str, index: int) -> Pin:
    key = f"pins[{index}]"
    _refuse_unknown(row, PIN_KEYS, key, file)
    return Pin(
        _whole(row, "waypoint", key, file),
        _number(row, "lean", key, file),
        _optional(row, "branch", key, file),
        _optional(row, "turn", key, file),
    )


def _region(row: Any, file: str, index: int) -> Region:
    key = f"regions[{index}]"
    _refuse_unknown(row, REGION_KEYS, key, file)
    return Region(
        _whole(row, "first", key, file),
        _whole(row, "last", key, file),
        _number(row, "low", key, file),
        _number(row, "high", key, file),
        _optional(row, "branch", key, file),
    )


def _value(row: Any, name: str, key: str, file: str) -> Any:
    if not isinstance(row, dict):
        raise _expected(file, key, "a table", row)
    return row.get(name)


def _whole(row: Any, name: str, key: str, file: str) -> int:
    value = _value(row, name, key, file)
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value < 10**9:
        raise _expected(file, f"{key}.{name}", "a whole number from 0", value)
    return value


def _optional(row: Any, name: str, key: str, file: str) -> int | None:
    return None if _value(row, name, key, file) is None else _whole(row, name, key, file)


def _number(row: Any, name: str, key: str, file: str) -> float:
    value = _value(row, name, key, file)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise _expected(file, f"{key}.{name}", "a number", value)
    try:
        return float(value)
    except OverflowError as error:
        raise _expected(file, f"{key}.{name}", "a number", value) from error


def _text(value: Any, key: str, file: str) -> str:
    if not isinstance(value, str):
        raise _expected(file, key, "a text", value)
    return value
