"""Words of path files: roles, events, pass names, frames and units."""

from __future__ import annotations

import re
from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from solver.io.importers.naming import listed, shown
from solver.io.importers.options import LENGTH_UNITS
from solver.io.importers.strict_numbers import read_number
from solver.model.toolpath import Event, EventKind, Frame, Role

ROLES: Final[Mapping[str, Role]] = MappingProxyType(
    {role.value: role for role in Role}
    | {"接近": Role.APPROACH, "切入": Role.LEAD_IN, "接触": Role.CONTACT}
    | {"打磨": Role.CONTACT, "切出": Role.LEAD_OUT, "连接": Role.LINK}
)
"""Accepted words -> roles; underscores and spaces count as hyphens."""

FRAMES: Final[Mapping[str, Frame]] = MappingProxyType({frame.value: frame for frame in Frame})

LONGEST_NAME: Final = 64
LONGEST_DWELL: Final = 3600.0
"""Longest accepted dwell [s]."""

_PROGRAM: Final = re.compile(r"[A-Z][A-Z0-9_]{0,35}")
_OUTPUT: Final = re.compile(r"([0-9]{1,5})=(0|1|on|off)", re.IGNORECASE)
_SPINDLE: Final = {"spindle-on": EventKind.SPINDLE_ON, "spindle-off": EventKind.SPINDLE_OFF}


def read_role(text: str) -> Role:
    """Return the role that a word names; an empty word is contact."""
    if not text:
        return Role.CONTACT
    role = ROLES.get(text.casefold().replace("_", "-").replace(" ", "-"))
    if role is None:
        names = listed([one.value for one in Role], "or")
        raise ValueError(f"is {shown(text)}, expected {names}")
    return role


def read_event(text: str) -> Event:
    """Read one event: spindle-on, spindle-off, dwell:SECONDS, do:NUMBER=0|1 or call:PROGRAM."""
    kind, colon, value = text.partition(":")
    kind = kind.strip().casefold().replace("_", "-")
    value = value.strip()
    if kind in _SPINDLE and not colon:
        return Event(_SPINDLE[kind])
    if kind == "dwell" and colon:
        seconds = read_number(value)
        if not 0.0 < seconds <= LONGEST_DWELL:
            raise ValueError(f"is a dwell of {seconds:g} s, expected above 0 and up to 3600 s")
        return Event(EventKind.DWELL, value=seconds)
    if kind == "do" and (output := _OUTPUT.fullmatch(value)) and int(output[1]) > 0:
        state = 1.0 if output[2].casefold() in {"1", "on"} else 0.0
        return Event(EventKind.DIGITAL_OUTPUT, str(int(output[1])), state)
    if kind == "call" and _PROGRAM.fullmatch(value.upper()) and value.isascii():
        return Event(EventKind.CALL, value.upper())
    raise ValueError(
        f"is {shown(text)}, expected spindle-on, spindle-off, dwell:SECONDS, do:NUMBER=0 or 1, "
        f"or call:PROGRAM"
    )


def read_events(text: str) -> tuple[Event, ...]:
    """Read events separated by '|'; an empty text holds none."""
    if not text:
        return ()
    return tuple(read_event(part.strip()) for part in text.split("|"))


def read_name(text: str) -> str:
    """Read a printable name of 1 to 64 characters."""
    if not text:
        raise ValueError("is empty, expected a name")
    if len(text) > LONGEST_NAME or not text.isprintable():
        raise ValueError(f"is {shown(text)}, expected a printable name of up to 64 characters")
    return text


def read_touches(text: str) -> str:
    """Read the workpiece group that a pass may touch; an empty text is none."""
    return read_name(text) if text else ""


def read_frame(text: str) -> Frame:
    """Return the frame that a word names."""
    frame = FRAMES.get(text.casefold())
    if frame is None:
        raise ValueError(f"is {shown(text)}, expected {listed(FRAMES, 'or')}")
    return frame


def read_unit(text: str) -> str:
    """Return the length unit that a word names."""
    if text not in LENGTH_UNITS:
        raise ValueError(f"is {shown(text)}, expected {listed(LENGTH_UNITS, 'or')}")
    return text
