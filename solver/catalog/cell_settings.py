"""Settings of planning, as a cell states them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, TypeVar

import numpy as np

from solver.catalog.toml_reader import Table
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
