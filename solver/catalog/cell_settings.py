"""Settings of planning and of the robot program, as a cell states them."""

from __future__ import annotations

import datetime
import re
from collections.abc import Mapping
from typing import Final, TypeVar

import numpy as np

from solver.catalog.toml_reader import Table
from solver.model.problem import ProgramSettings
from solver.model.robot import JOINTS
from solver.model.settings import (
    BRANCHES,
    CostWeights,
    EdgeCost,
    PlanningSettings,
    Scheme,
    StepLimits,
    Sweep,
    Turns,
)
from solver.transforms import FloatArray

PROGRAM_NAME: Final = re.compile(r"[A-Z][A-Z0-9_]{0,35}")
MAXIMUM_COMMENT: Final = 16
MAXIMUM_UFRAME: Final = 61
MAXIMUM_UTOOL: Final = 29
MAXIMUM_SEED: Final = 2**31 - 1

_Value = TypeVar("_Value")


def read_settings(table: Table) -> PlanningSettings:
    """Read the table `settings`; what it leaves out has the default of `PlanningSettings`.

    A `self_margin_mm` of false leaves pairs of the robot with itself out.
    """
    default = PlanningSettings()
    with table.located():
        branches = table.integers("branches", 0, BRANCHES - 1, default=default.branches)
        return PlanningSettings(
            lean=_sweep(table, "lean_deg", default.lean),
            lead=_sweep(table, "lead_deg", default.lead),
            spin=_sweep(table, "spin_deg", default.spin),
            branches=branches,
            turns=_choice(table, "turns", {one.value: one for one in Turns}, default.turns),
            manipulability=table.number("manipulability_m3", default.manipulability, low=0.0),
            safety_distance=table.number("safety_distance_mm", default.safety_distance, low=0.0),
            self_margin=_self_margin(table),
            edge_cost=_choice(
                table, "edge_cost", {one.value: one for one in EdgeCost}, default.edge_cost
            ),
            weights=_weights(table.optional_table("weights")),
            steps=_steps(table.optional_table("steps")),
            scheme=_choice(table, "scheme", {one.value: one for one in Scheme}, default.scheme),
            heuristic_weight=table.number(
                "heuristic_weight", default.heuristic_weight, low=0.0, high=1.0
            ),
            seed=table.integer("seed", 0, MAXIMUM_SEED, default.seed),
        )


def read_program(table: Table | None) -> ProgramSettings:
    """Read the table `program`: name, marks and date of the robot program."""
    default = ProgramSettings()
    if table is None:
        return default
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
    )  # fmt: skip


def _choice(table: Table, key: str, options: Mapping[str, _Value], default: _Value) -> _Value:
    return options[table.choice(key, tuple(options))] if table.has(key) else default


def _sweep(table: Table, key: str, default: Sweep) -> Sweep:
    if not table.has(key):
        return default
    with table.located(key):
        return Sweep(*table.numbers(key, 3))


def _self_margin(table: Table) -> float | None:
    default = PlanningSettings().self_margin
    if not table.has("self_margin_mm"):
        return default
    if table.get("self_margin_mm", "a number in mm, or false", False) is False:
        return None
    return table.number("self_margin_mm", low=0.0)


def _weights(table: Table | None) -> CostWeights:
    default = CostWeights()
    if table is None:
        return default
    with table.located():
        return CostWeights(
            clearance=table.number("clearance", default.clearance, low=0.0),
            comfort=table.number("comfort_mm", default.comfort),
            lean=table.number("lean", default.lean, low=0.0),
            lead=table.number("lead", default.lead, low=0.0),
            link=table.number("link", default.link, low=0.0),
        )


def _steps(table: Table | None) -> StepLimits:
    default = StepLimits()
    if table is None:
        return default
    with table.located():
        return StepLimits(
            joints=_joints(table, "joints_deg", default.joints),
            link_joints=_joints(table, "link_joints_deg", default.link_joints),
            lean=table.number("lean_deg", default.lean),
            at_feed=table.boolean("at_feed", default.at_feed),
        )


def _joints(table: Table, key: str, default: FloatArray) -> FloatArray:
    return np.array(table.numbers(key, JOINTS)) if table.has(key) else default


def _pattern(table: Table, key: str, default: str, pattern: re.Pattern[str], expected: str) -> str:
    value = table.text(key, default)
    if not pattern.fullmatch(value):
        raise table.error(key, f"expected {expected}, found {value[:40]!r}")
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
