"""Which column of a table holds which field, and in which unit."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

from solver.errors import InputError, Place
from solver.io.importers.naming import listed, shown, suggestion
from solver.io.importers.table import Row
from solver.units import DEG, MM

POSITION: Final = ("x", "y", "z")
QUATERNION: Final = ("qw", "qx", "qy", "qz")
WPR: Final = ("w", "p", "r")
NORMAL: Final = ("nx", "ny", "nz")
TRAVEL: Final = ("tx", "ty", "tz")
PASS_FIELDS: Final = ("pass", "feed", "touches", "lean", "lead")
FIELDS: Final = (
    *POSITION, *QUATERNION, *WPR, *NORMAL, *TRAVEL, *PASS_FIELDS, "role", "events",
)  # fmt: skip
"""Every field that a column can hold."""

_LENGTH: Final = {"mm": MM, "m": 1.0}
_SPEED: Final = {"mm/s": MM, "mm/sec": MM, "m/s": 1.0}
_ANGLE: Final = {"deg": DEG, "°": DEG, "度": DEG}

_UNITS: Final[Mapping[str, Mapping[str, float]]] = MappingProxyType(
    dict.fromkeys(POSITION, _LENGTH)
    | {"feed": _SPEED}
    | dict.fromkeys((*WPR, "lean", "lead"), _ANGLE)
)
"""Fields that have a unit -> the units that a title may state and their SI factors."""

_DEFAULTS: Final = {"feed": MM} | dict.fromkeys((*WPR, "lean", "lead"), DEG)

_ALIASES: Final[Mapping[str, str]] = MappingProxyType(
    {name: name for name in FIELDS}
    | {f"{word}{axis}": axis for axis in POSITION for word in ("pos_", "position_", "坐标")}
    | {f"{axis}坐标": axis for axis in POSITION}
    | {f"{word}{axis}": f"q{axis}" for axis in "wxyz" for word in ("quat_", "四元数")}
    | {f"{word}{axis}": f"n{axis}" for axis in POSITION for word in ("normal_", "法向", "法向量")}
    | {
        f"{word}{axis}": f"t{axis}"
        for axis in POSITION
        for word in ("travel_", "tangent_", "切向", "行进")
    }
    | dict.fromkeys(("pass_name", "工序", "道次"), "pass")
    | dict.fromkeys(("feedrate", "speed", "进给", "进给速度", "速度"), "feed")
    | dict.fromkeys(("角色", "类型"), "role")
    | dict.fromkeys(("touch", "face", "接触", "接触面"), "touches")
    | dict.fromkeys(("event", "事件"), "events")
    | {"侧倾": "lean", "前倾": "lead"}
)
"""Accepted titles, in lower case and without unit -> field."""

_BRACKETED: Final = re.compile(r"([^\[(（]*[^\[(（\s])\s*[\[(（]\s*([^\])）]*?)\s*[\])）]")
_LONGEST_TITLE: Final = 64
_SUFFIXES: Final = {"_mm_s": "mm/s", "_m_s": "m/s", "_mm": "mm", "_m": "m", "_deg": "deg"}


@dataclass(frozen=True, slots=True)
class Columns:
    """Field -> index of its column from 0, and field -> SI factor of its unit.

    `length_unit` is the unit that the titles of x, y and z state, None where they are silent.
    """

    index: Mapping[str, int]
    factor: Mapping[str, float]
    length_unit: str | None

    def has(self, group: tuple[str, ...]) -> bool:
        """Whether the table has the columns of a group of fields."""
        return group[0] in self.index


def fitting_titles(cells: tuple[str, ...]) -> int:
    """How many of the cells are titles of known fields."""
    return sum(_ALIASES.get(_split_title(cell)[0]) is not None for cell in cells)


def columns_from_header(header: Row, file: str) -> Columns:
    """Read the titles of a header; unknown, repeated and missing columns are refused."""
    index: dict[str, int] = {}
    units: dict[str, str] = {}
    for number, title in enumerate(header.cells):
        place = Place(file, header.line, number + 1)
        name, unit = _split_title(title)
        field = _ALIASES.get(name)
        if field is None:
            raise InputError(_unknown_title(title), place)
        if field in index:
            raise InputError(
                f"the title {shown(title)} names {field} again, expected it only in column "
                f"{index[field] + 1}",
                place,
            )
        index[field] = number
        if unit is not None:
            units[field] = unit
    return _checked(index, units, header.line, file)


def columns_from_titles(mapping: Mapping[str, str], header: Row, file: str) -> Columns:
    """Find the mapped titles in a header; other columns are ignored."""
    index: dict[str, int] = {}
    units: dict[str, str] = {}
    for field, title in mapping.items():
        _check_field(field, file)
        found = [number for number, cell in enumerate(header.cells) if cell == title.strip()]
        if len(found) != 1:
            state = f"occurs {len(found)} times" if found else "is missing"
            column = found[1] + 1 if found else None
            raise InputError(
                f"the column {shown(title)} mapped to {field} {state}, expected it once",
                Place(file, header.line, column),
            )
        index[field] = found[0]
        unit = _split_title(title)[1]
        if unit is not None and field in _UNITS:
            units[field] = unit
    return _checked(index, units, header.line, file)


def columns_from_numbers(mapping: Mapping[str, int], first: Row, file: str) -> Columns:
    """Take the mapped column numbers, from 1, of a table without header."""
    index: dict[str, int] = {}
    for field, number in mapping.items():
        _check_field(field, file)
        if not 1 <= number <= len(first.cells):
            raise InputError(
                f"{field} is mapped to column {number}, expected 1 to {len(first.cells)}",
                Place(file, first.line),
            )
        index[field] = number - 1
    return _checked(index, {}, first.line, file)


def _split_title(title: str) -> tuple[str, str | None]:
    """Return a title without its unit in lower case, and the unit."""
    if len(title) > _LONGEST_TITLE:
        return title, None
    if found := _BRACKETED.fullmatch(title):
        return found[1].casefold(), found[2].casefold()
    name = title.casefold()
    for suffix, unit in _SUFFIXES.items():
        if name.endswith(suffix):
            return name.removesuffix(suffix), unit
    return name, None


def _unknown_title(title: str) -> str:
    if not title:
        return "the column has no title, expected the name of a field"
    hint = suggestion(_split_title(title)[0], _ALIASES)
    return f"no field is called {shown(title)}{hint}, expected one of {listed(FIELDS)}"


def _check_field(field: str, file: str) -> None:
    if field not in FIELDS:
        raise InputError(
            f"the column mapping names the field {shown(field)}{suggestion(field, FIELDS)}, "
            f"expected one of {listed(FIELDS)}",
            Place(file),
        )


def _checked(index: dict[str, int], units: dict[str, str], line: int, file: str) -> Columns:
    _check_groups(index, line, file)
    factor = dict(_DEFAULTS)
    for field, unit in units.items():
        known = _UNITS.get(field, {})
        if unit not in known:
            expected = f"expected {listed(known, 'or')}" if known else "expected none"
            raise InputError(
                f"{field} has the unit {shown(unit)}, {expected}",
                Place(file, line, index[field] + 1),
            )
        factor[field] = known[unit]
    return Columns(index, factor, _length_unit(index, units, line, file))


def _check_groups(index: dict[str, int], line: int, file: str) -> None:
    for group in (POSITION, QUATERNION, WPR, NORMAL, TRAVEL):
        missing = [field for field in group if field not in index]
        if missing and (len(missing) < len(group) or group is POSITION):
            what = "columns" if len(missing) > 1 else "column"
            raise InputError(
                f"the table has no {what} {listed(missing)}, expected all of {listed(group)}",
                Place(file, line),
            )
    stated = [group for group in (QUATERNION, WPR, NORMAL) if group[0] in index]
    if len(stated) > 1:
        place = Place(file, line, index[stated[1][0]] + 1)
        names = listed([" ".join(group) for group in stated])
        raise InputError(
            f"the table states orientations twice, by {names}, expected one of them", place
        )
    if TRAVEL[0] in index and NORMAL[0] not in index:
        place = Place(file, line, index[TRAVEL[0]] + 1)
        raise InputError(
            "the table has a travel direction but no normal, expected nx, ny and nz", place
        )


def _length_unit(index: dict[str, int], units: dict[str, str], line: int, file: str) -> str | None:
    stated = {field: units.get(field) for field in POSITION}
    for field in POSITION[1:]:
        if stated[field] != stated["x"]:
            raise InputError(
                f"x has {_unit_name(stated['x'])} and {field} has {_unit_name(stated[field])}, "
                f"expected one unit for x, y and z",
                Place(file, line, index[field] + 1),
            )
    return stated["x"]


def _unit_name(unit: str | None) -> str:
    return f"the unit {unit}" if unit else "no unit"
