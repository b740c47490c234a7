"""Reader of a neutral program in JSON; it shares no code with the post that writes it."""

from __future__ import annotations

from typing import Final, TypeVar

import numpy as np

from solver.errors import InputError
from solver.io.importers.located_json import Document, Node, kind_of, parse_json
from solver.io.importers.naming import listed, shown
from solver.model.program import JointProgram, MotionKind, Move, NumberedPose, Speed, SpeedUnit
from solver.model.toolpath import Event, EventKind, Role
from solver.transforms import FloatArray, rigid
from solver.units import DEG, MM

_Kind = TypeVar("_Kind", MotionKind, Role, EventKind)

_UNITS: Final = {
    "%": (SpeedUnit.PERCENT, 1.0),
    "mm/s": (SpeedUnit.LINEAR, MM),
    "s": (SpeedUnit.DURATION, 1.0),
}
_TEXTS: Final = ("name", "comment", "date", "time")


def read_json_program(data: bytes, file: str) -> JointProgram:
    """Read a JSON program; `file` is its name for errors.

    Raises
    ------
    InputError
        With line, column and key, for anything that is no whole program of version 1.
    """
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        raise InputError(f"{file}: byte {error.start + 1} is no UTF-8") from error
    document = parse_json(file, text)
    top = _Members(document, document.root, "")
    if (kind := top.text("format")) != "posopt-program":
        raise top.error("format", f"expected posopt-program, found {shown(kind)}")
    if (version := top.whole("version")) != 1:
        raise top.error("version", f"version 1 is read, found {version}")
    name, comment, date, time = (top.text(key) for key in _TEXTS)
    program = JointProgram(
        name=name,
        comment=comment,
        remarks=tuple(
            top.as_text(one, f"remarks[{index}]") for index, one in enumerate(top.array("remarks"))
        ),
        frame=_numbered(top.members("user_frame"), "fanuc_world_from_uframe"),
        tool=_numbered(top.members("tool"), "flange_from_tcp"),
        moves=tuple(
            _move(_Members(document, one, f"moves[{index}]."))
            for index, one in enumerate(top.array("moves"))
        ),
        date=date,
        time=time,
        payload=top.whole_or_none("payload"),
        offset=top.whole_or_none("offset_register"),
    )
    top.finish()
    return program


class _Members:
    """The members of one object; each is asked for once, and none may be left over."""

    def __init__(self, document: Document, node: Node, path: str) -> None:
        self._document, self._node, self._path = document, node, path
        if not isinstance(node.value, dict):
            raise InputError(
                f"expected an object, found {kind_of(node)}",
                document.place(node.offset, path.rstrip(".") or None),
            )
        self._left = dict(node.value)

    def error(self, key: str, message: str, node: Node | None = None) -> InputError:
        offset = (node or self._node).offset
        return InputError(message, self._document.place(offset, f"{self._path}{key}"))

    def take(self, key: str) -> Node:
        if key not in self._left:
            raise self.error(key, "is missing")
        return self._left.pop(key)

    def finish(self) -> None:
        for key, node in self._left.items():
            raise self.error(key, "is no member that a program has", node)

    def as_text(self, node: Node, key: str) -> str:
        if not isinstance(node.value, str):
            raise self.error(key, f"expected a text, found {kind_of(node)}", node)
        return node.value

    def text(self, key: str) -> str:
        return self.as_text(self.take(key), key)

    def number(self, key: str) -> float:
        return self._as_number(self.take(key), key)

    def _as_number(self, node: Node, key: str) -> float:
        if isinstance(node.value, bool) or not isinstance(node.value, float):
            raise self.error(key, f"expected a number, found {kind_of(node)}", node)
        return node.value

    def whole(self, key: str) -> int:
        return self._as_whole(self.take(key), key)

    def _as_whole(self, node: Node, key: str) -> int:
        value = self._as_number(node, key)
        if not value.is_integer() or abs(value) > 1e9:
            raise self.error(key, f"expected a whole number, found {value:g}", node)
        return int(value)

    def whole_or_none(self, key: str) -> int | None:
        node = self.take(key)
        return None if node.value is None else self._as_whole(node, key)

    def boolean(self, key: str) -> bool:
        node = self.take(key)
        if not isinstance(node.value, bool):
            raise self.error(key, f"expected true or false, found {kind_of(node)}", node)
        return node.value

    def array(self, key: str) -> list[Node]:
        node = self.take(key)
        elements = self._document.elements(node)
        if elements is None:
            raise self.error(key, f"expected an array, found {kind_of(node)}", node)
        return elements

    def numbers(self, key: str, count: int) -> tuple[float, ...]:
        return self.as_numbers(self.take(key), key, count)

    def as_numbers(self, node: Node, key: str, count: int) -> tuple[float, ...]:
        if not isinstance(node.value, tuple) or len(node.value) != count:
            raise self.error(key, f"expected {count} numbers, found {kind_of(node)}", node)
        return node.value

    def choice(self, key: str, kinds: type[_Kind]) -> _Kind:
        node = self.take(key)
        word = self.as_text(node, key)
        for kind in kinds:
            if kind.value == word:
                return kind
        names = listed([kind.value for kind in kinds], "or")
        raise self.error(key, f"expected {names}, found {shown(word)}", node)

    def members(self, key: str) -> _Members:
        return _Members(self._document, self.take(key), f"{self._path}{key}.")

    def inner(self, node: Node, key: str) -> _Members:
        return _Members(self._document, node, f"{self._path}{key}.")


def _numbered(members: _Members, transform: str) -> NumberedPose:
    if (found := members.text("transform")) != transform:
        raise members.error("transform", f"expected {transform}, found {shown(found)}")
    rows = members.array("rotation")
    if len(rows) != 3:
        raise members.error("rotation", f"expected 3 rows, found {len(rows)}")
    rotation = np.array(
        [members.as_numbers(row, f"rotation[{index}]", 3) for index, row in enumerate(rows)]
    )
    _check_rotation(members, rotation)
    position = np.array(members.numbers("position_mm", 3)) * MM
    number, measured = members.whole("number"), members.boolean("measured")
    members.finish()
    return NumberedPose(number, rigid(rotation, position), measured)


def _check_rotation(members: _Members, rotation: FloatArray) -> None:
    off = float(np.abs(rotation @ rotation.T - np.eye(3)).max())
    if off > 1e-9 or np.linalg.det(rotation) < 0.0:
        raise members.error("rotation", f"is no rotation (off by {off:.2g})")


def _move(members: _Members) -> Move:
    unit_name = members.text("unit")
    if unit_name not in _UNITS:
        raise members.error("unit", f"expected {listed(_UNITS, 'or')}, found {shown(unit_name)}")
    unit, factor = _UNITS[unit_name]
    speed = members.number("speed") * factor
    joints = np.array(members.numbers("joints_deg", 6)) * DEG
    waypoint = members.whole_or_none("waypoint")
    if waypoint is not None and waypoint < 1:
        raise members.error("waypoint", f"waypoints count from 1, found {waypoint}")
    events = [
        _event(members.inner(one, f"events[{index}]"))
        for index, one in enumerate(members.array("events"))
    ]
    kind, role = members.choice("motion", MotionKind), members.choice("role", Role)
    cnt = members.whole_or_none("cnt")
    members.finish()
    try:
        return Move(
            joints=joints,
            speed=Speed(speed, unit),
            kind=kind,
            cnt=cnt,
            role=role,
            waypoint=None if waypoint is None else waypoint - 1,
            events=tuple(events),
        )
    except InputError as error:
        raise members.error("speed", error.message) from error


def _event(members: _Members) -> Event:
    event = Event(
        members.choice("kind", EventKind), members.text("target"), members.number("value")
    )
    members.finish()
    return event
