"""The robot program of a cell: its name and numbers, its links, and the declared accuracy."""

from __future__ import annotations

import datetime
import re
from typing import Final

import numpy as np

from solver.catalog.toml_reader import Table
from solver.io.importers.words import read_event
from solver.io.posts import POSTS
from solver.model.program_names import is_device_name
from solver.model.program_settings import (
    Accuracy,
    ContactMotion,
    LinkSettings,
    ProgramSettings,
    Withdrawal,
)
from solver.model.robot import JOINTS
from solver.model.toolpath import Event

PROGRAM_NAME: Final = re.compile(r"[A-Z][A-Z0-9_]{0,35}")
MAXIMUM_COMMENT: Final = 16
MAXIMUM_UFRAME: Final = 61
MAXIMUM_UTOOL: Final = 29
MAXIMUM_PAYLOAD: Final = 10
MAXIMUM_REGISTER: Final = 999
LONGEST_NAME: Final = 36
FEWEST_LINES: Final = 20
MOST_LINES: Final = 9_999


def read_program(table: Table | None) -> ProgramSettings:
    """Read the table `program` and its `links`; what is left out has the default."""
    default = ProgramSettings()
    if table is None:
        return default
    posts = tuple(POSTS)
    on = table.text("spindle_on", default.spindle_on)
    if on == table.text("spindle_off", default.spindle_off):
        raise table.error("spindle_off", f"expected another program than spindle_on, found {on!r}")
    return ProgramSettings(
        name=_pattern(
            table, "name", default.name, PROGRAM_NAME,
            "up to 36 of A-Z, 0-9 and _, a letter first",
        ),
        comment=_comment(table, default.comment),
        uframe=table.integer("uframe", 0, MAXIMUM_UFRAME, default.uframe),
        utool=table.integer("utool", 1, MAXIMUM_UTOOL, default.utool),
        date=_date(table, default.date),
        time=_time(table, default.time),
        approach_percent=table.integer("approach_percent", 1, 100, default.approach_percent),
        post=table.choice("post", posts, default.post),
        contact=ContactMotion(
            table.choice("contact", [one.value for one in ContactMotion], default.contact.value)
        ),
        payload=_optional_integer(table, "payload", 1, MAXIMUM_PAYLOAD),
        offset=_optional_integer(table, "offset_register", 1, MAXIMUM_REGISTER),
        frame_measured=table.boolean("frame_measured", default.frame_measured),
        tool_measured=table.boolean("tool_measured", default.tool_measured),
        name_length=table.integer("name_length", 1, LONGEST_NAME, default.name_length),
        line_limit=table.integer("line_limit", FEWEST_LINES, MOST_LINES, default.line_limit),
        spindle_on=_called(table, "spindle_on", default.spindle_on),
        spindle_off=_called(table, "spindle_off", default.spindle_off),
        path_tolerance=table.number("path_tolerance_mm", default.path_tolerance, low=0.001),
        feed_tolerance=table.number("feed_tolerance", default.feed_tolerance, low=0.0, high=1.0),
        links=_links(table.optional_table("links")),
    )  # fmt: skip


def read_accuracy(table: Table | None) -> Accuracy | None:
    """Read the table `accuracy`: how far the real cell may be from the nominal one."""
    if table is None:
        return None
    with table.located():
        return Accuracy(
            robot=table.number("robot_mm", low=0.0),
            workpiece=table.number("workpiece_mm", low=0.0),
            tcp=table.number("tcp_mm", low=0.0),
        )


def _links(table: Table | None) -> LinkSettings | None:
    if table is None:
        return None
    default = LinkSettings()
    withdrawal = table.choice(
        "withdrawal", [one.value for one in Withdrawal], default.withdrawal.value
    )
    home = np.array(table.numbers("home_deg", JOINTS)) if table.has("home_deg") else None
    with table.located():
        return LinkSettings(
            approach=table.number("approach_mm", default.approach, low=1.0),
            withdrawal=Withdrawal(withdrawal),
            lead_in=table.number("lead_in_mm", default.lead_in, low=0.0),
            lead_in_height=table.number("lead_in_height_mm", default.lead_in_height, low=0.0),
            lead_out=table.number("lead_out_mm", default.lead_out, low=0.0),
            lead_out_height=table.number("lead_out_height_mm", default.lead_out_height, low=0.0),
            height=table.number("height_mm", default.height, low=0.0),
            percent=table.integer("percent", 1, 100, default.percent),
            speed=table.number("speed_mm_s", default.speed, low=1.0),
            clearance=table.number("clearance_mm", default.clearance, low=0.0),
            home=home,
            before=_events(table, "before"),
            after=_events(table, "after"),
        )


def _events(table: Table, key: str) -> tuple[Event, ...]:
    events = []
    for index, text in enumerate(table.texts(key, default=())):
        try:
            events.append(read_event(text))
        except ValueError as error:
            raise table.error(f"{key}[{index}]", str(error)) from error
    return tuple(events)


def _optional_integer(table: Table, key: str, low: int, high: int) -> int | None:
    return table.integer(key, low, high) if table.has(key) else None


def _called(table: Table, key: str, default: str) -> str:
    return _pattern(
        table, key, default, PROGRAM_NAME, "a program name of A-Z, 0-9 and _, a letter first"
    )


def _pattern(table: Table, key: str, default: str, pattern: re.Pattern[str], expected: str) -> str:
    value = table.text(key, default)
    if not pattern.fullmatch(value):
        raise table.error(key, f"expected {expected}, found {value[:40]!r}")
    if is_device_name(value):
        raise table.error(key, f"expected a name that is no device of Windows, found {value!r}")
    return value


def _comment(table: Table, default: str) -> str:
    value = table.text("comment", default)
    if len(value) > MAXIMUM_COMMENT or not value.isascii() or '"' in value or ";" in value:
        raise table.error(
            "comment",
            f"expected up to {MAXIMUM_COMMENT} ASCII characters without quotes and semicolons, "
            f"found {value[:40]!r}",
        )
    return value


def _date(table: Table, default: str) -> str:
    value = table.text("date", default)
    found = re.fullmatch(r"([0-9]{2})-([0-9]{2})-([0-9]{2})", value)
    try:
        year, month, day = map(int, found.groups() if found else (0, 0, 0))
        datetime.date(2000 + year, month, day)
    except ValueError:
        raise table.error("date", f"expected a date as 'YY-MM-DD', found {value[:40]!r}") from None
    return value


def _time(table: Table, default: str) -> str:
    return _pattern(
        table,
        "time",
        default,
        re.compile(r"(?:[01][0-9]|2[0-3]):[0-5][0-9]:[0-5][0-9]"),
        "a time as 'HH:MM:SS'",
    )
