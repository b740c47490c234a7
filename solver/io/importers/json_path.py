"""Toolpaths in JSON: ``{"format": "posopt-toolpath", "version": 1, ...}``."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Final, TypeVar

from solver.errors import InputError, Place
from solver.io.importers.assembly import (
    Form,
    Part,
    PassRecord,
    PointRecord,
    agreed_frame,
    agreed_unit,
    assemble,
    check_feed,
    check_nominal,
    check_row_limit,
)
from solver.io.importers.located_json import Document, Node, kind_of, parse_json
from solver.io.importers.naming import listed, shown, suggestion
from solver.io.importers.options import LENGTH_UNITS, ImportOptions
from solver.io.importers.source import Source
from solver.io.importers.words import (
    read_event,
    read_frame,
    read_name,
    read_role,
    read_touches,
    read_unit,
)
from solver.model.toolpath import Event, Frame, Role, Toolpath
from solver.units import DEG, MM

FORMAT: Final = "posopt-toolpath"
VERSION: Final = 1

_FILE_MEMBERS: Final = ("format", "version", "frame", "unit", "comment", "passes")
_PASS_MEMBERS: Final = (
    "name", "feed_mm_s", "touches", "lean_deg", "lead_deg", "comment", "waypoints",
)  # fmt: skip
_POINT_MEMBERS: Final = (
    "position", "quaternion", "wpr_deg", "normal", "travel", "role", "events", "comment",
)  # fmt: skip

_Value = TypeVar("_Value")


def import_json(source: Source, options: ImportOptions) -> Toolpath:
    """Read a JSON toolpath.

    Raises
    ------
    InputError
        One sentence with the file, the line, the column and the path of the value, such as
        ``passes[0].waypoints[3].position[1]``.
    """
    document = parse_json(source.file, source.text(options.encoding))
    root = _Cursor(document, document.root, "")
    members = root.members(_FILE_MEMBERS, ("format", "version", "passes"))
    _check_version(members)
    frame = _frame(root, members, options)
    length = LENGTH_UNITS[_unit(root, members, options)]
    return assemble(_passes(members["passes"], length, options), frame, source.file, options)


@dataclass(frozen=True, slots=True)
class _Cursor:
    """A value, and how it is reached from the root."""

    document: Document
    node: Node
    path: str

    def place(self) -> Place:
        return self.document.place(self.node.offset, self.path or None)

    def fault(self, message: str) -> InputError:
        return InputError(f"{self.path or 'the file'} {message}", self.place())

    def members(self, allowed: tuple[str, ...], required: tuple[str, ...]) -> dict[str, _Cursor]:
        """Return the members of an object, all of them known."""
        value = self.node.value
        if not isinstance(value, dict):
            raise self.fault(f"is {kind_of(self.node)}, expected an object")
        prefix = f"{self.path}." if self.path else ""
        for name, node in value.items():
            if name not in allowed:
                raise InputError(
                    f"no member is called {shown(name)}{suggestion(name, allowed)}, "
                    f"expected one of {listed(allowed)}",
                    self.document.place(node.key, f"{prefix}{name[:40]}"),
                )
        for name in required:
            if name not in value:
                raise self.fault(f"has no member {name}, expected it to have one")
        return {name: _Cursor(self.document, node, prefix + name) for name, node in value.items()}

    def items(self) -> Iterator[_Cursor]:
        """Yield the items of an array."""
        elements = self.document.elements(self.node)
        if elements is None:
            raise self.fault(f"is {kind_of(self.node)}, expected an array")
        for index, node in enumerate(elements):
            yield _Cursor(self.document, node, f"{self.path}[{index}]")

    def number(self) -> float:
        value = self.node.value
        if not isinstance(value, float):
            raise self.fault(f"is {kind_of(self.node)}, expected a number")
        return value

    def checked(self, factor: float, check: Callable[[float], None]) -> float:
        """Return a number in its SI unit."""
        value = self.number() * factor
        try:
            check(value)
        except ValueError as error:
            raise self.fault(str(error)) from error
        return value

    def numbers(self, names: str) -> tuple[float, ...]:
        """Return an array of as many numbers as there are names."""
        value = self.node.value
        count = len(names.split())
        if not isinstance(value, list | tuple) or len(value) != count:
            length = f" of {len(value)}" if isinstance(value, list | tuple) else ""
            found = f"{kind_of(self.node)}{length}"
            raise self.fault(f"is {found}, expected the {count} numbers {names}")
        return value if isinstance(value, tuple) else tuple(item.number() for item in self.items())

    def word(self, read: Callable[[str], _Value]) -> _Value:
        value = self.node.value
        if not isinstance(value, str):
            raise self.fault(f"is {kind_of(self.node)}, expected a text")
        try:
            return read(value)
        except ValueError as error:
            raise self.fault(str(error)) from error


@dataclass(frozen=True, slots=True)
class _PointPlaces:
    """Where the parts of a waypoint stand."""

    waypoint: _Cursor

    def place(self, part: Part) -> Place:
        value = self.waypoint.node.value
        names = {
            Part.POSITION: ("position",),
            Part.ORIENTATION: ("quaternion", "wpr_deg", "normal"),
            Part.TRAVEL: ("travel", "normal"),
        }[part]
        for name in names:
            if isinstance(value, dict) and name in value:
                path = f"{self.waypoint.path}.{name}"
                return self.waypoint.document.place(value[name].offset, path)
        return self.waypoint.place()


def _check_version(members: dict[str, _Cursor]) -> None:
    if members["format"].node.value != FORMAT:
        found = kind_of(members["format"].node)
        raise members["format"].fault(f"is {found}, expected the text '{FORMAT}'")
    version = members["version"]
    if isinstance(version.node.value, bool) or version.node.value != VERSION:
        raise version.fault(f"is {kind_of(version.node)}, expected {VERSION}")


def _frame(root: _Cursor, members: dict[str, _Cursor], options: ImportOptions) -> Frame:
    stated = members.get("frame")
    if stated is None:
        return agreed_frame(None, root.place(), options)
    return agreed_frame(stated.word(read_frame), stated.place(), options)


def _unit(root: _Cursor, members: dict[str, _Cursor], options: ImportOptions) -> str:
    stated = members.get("unit")
    if stated is None:
        return agreed_unit(None, root.place(), options)
    return agreed_unit(stated.word(read_unit), stated.place(), options)


def _passes(passes: _Cursor, length: float, options: ImportOptions) -> Iterator[PassRecord]:
    count = 0
    for number, one in enumerate(passes.items(), start=1):
        members = one.members(_PASS_MEMBERS, ("waypoints",))
        record = _pass_record(one, members, number, options)
        for waypoint in members["waypoints"].items():
            count += 1
            if count > options.row_limit:
                check_row_limit(count, waypoint.place(), options)
            record.points.append(_point(waypoint, length))
        yield record


def _pass_record(
    one: _Cursor, members: dict[str, _Cursor], number: int, options: ImportOptions
) -> PassRecord:
    """Return what the file says about a pass; the options say the rest."""
    name, touches = members.get("name"), members.get("touches")
    feed, lean, lead = (members.get(key) for key in ("feed_mm_s", "lean_deg", "lead_deg"))
    return PassRecord(
        place=name.place() if name else one.place(),
        name=name.word(read_name) if name else str(number),
        feed=feed.checked(MM, check_feed) if feed else options.feed,
        touches=touches.word(read_touches) if touches else options.touches,
        lean=lean.checked(DEG, check_nominal) if lean else options.lean,
        lead=lead.checked(DEG, check_nominal) if lead else options.lead,
    )


def _point(waypoint: _Cursor, length: float) -> PointRecord:
    members = waypoint.members(_POINT_MEMBERS, ("position",))
    form, orientation = _orientation(waypoint, members)
    role, events = members.get("role"), members.get("events")
    return PointRecord(
        _PointPlaces(waypoint),
        tuple(value * length for value in members["position"].numbers("x y z")),
        form,
        orientation,
        role.word(read_role) if role else Role.CONTACT,
        _events(events) if events else (),
    )


def _events(events: _Cursor) -> tuple[Event, ...]:
    return tuple(item.word(read_event) for item in events.items())


def _orientation(waypoint: _Cursor, members: dict[str, _Cursor]) -> tuple[Form, tuple[float, ...]]:
    stated = [name for name in ("quaternion", "wpr_deg", "normal") if name in members]
    if len(stated) > 1:
        raise members[stated[1]].fault(f"is a second orientation beside {stated[0]}, expected one")
    if "travel" in members and "normal" not in members:
        raise members["travel"].fault("stands without a normal, expected both")
    if not stated:
        return Form.STATED, ()
    given = members[stated[0]]
    if stated[0] == "quaternion":
        return Form.QUATERNION, given.numbers("w x y z")
    if stated[0] == "wpr_deg":
        return Form.WPR, given.numbers("w p r")
    normal = given.numbers("x y z")
    if "travel" not in members:
        return Form.NORMAL, normal
    return Form.NORMAL_TRAVEL, (*normal, *members["travel"].numbers("x y z"))
