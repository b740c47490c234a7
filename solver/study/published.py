"""Published figures and parameters of experiments, read from the shipped data of a study."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from solver.catalog.names import resource_folder
from solver.catalog.toml_reader import Table, read_toml
from solver.errors import UnknownNameError

JOINT_NAMES = ("J1", "J2", "J3", "J4", "J5", "J6")
MODEL_NAMES = ("θ1", "θ2", "θ3", "θ4", "θ5", "θ6")


@dataclass(frozen=True, slots=True)
class PublishedRun:
    """What is published of one search; None where it is not. Lengths in [m], time in [s]."""

    name: str
    least_clearance: float | None = None
    mean_clearance: float | None = None
    search_time: float | None = None
    expanded: int | None = None


@dataclass(frozen=True, slots=True)
class Published:
    """Published figures; changes are shares, -0.1 for 10 % less."""

    source: str
    beam: str
    schemes: Mapping[str, PublishedRun]
    beams: tuple[PublishedRun, ...]
    changes: Mapping[str, float]
    variation: Mapping[str, float]
    improved: Mapping[str, float]
    weight_ratio: tuple[float, float]

    @property
    def beam_names(self) -> tuple[str, ...]:
        """All beams, that of the schemes last."""
        return (*(one.name for one in self.beams), self.beam)


@dataclass(frozen=True, slots=True)
class Parameters:
    """Parameters of the experiments; lengths in [m], angles in [rad], shares of 1."""

    time_repeats: int
    weight_seeds: tuple[int, ...]
    weight_pairs: int
    random_draws: int
    lean_steps: tuple[float, ...]
    wider_lean: tuple[float, ...]
    lead_range: float
    lead_step: float
    penalty_poses: int
    penalty_near: float
    heuristic_nodes: int
    placement_quantile: float
    placement_shift: float
    placement_turn: float
    placement_draws: int
    placement_seed: int
    refine_gain: float
    refine_patience: int
    refine_halvings: int
    refine_keep: float
    refine_nodes: int
    bound_pairs: int
    bound_gap: float
    front_step: float


@dataclass(frozen=True, slots=True)
class StudyData:
    """One study: its usual cell, what is published, and the parameters of its experiments."""

    name: str
    title: str
    cell: str
    published: Published
    parameters: Parameters


def study_names() -> tuple[str, ...]:
    """Names of the shipped studies."""
    return tuple(sorted(path.stem for path in (resource_folder() / "studies").glob("*.toml")))


def load_study(name: str) -> StudyData:
    """Load a shipped study by name.

    Raises
    ------
    UnknownNameError
        If there is no such study.
    """
    if name not in study_names():
        raise UnknownNameError("study", name, study_names())
    document = read_toml(resource_folder() / "studies" / f"{name}.toml")
    head = document.table("study")
    data = StudyData(
        head.name("name"),
        head.text("title"),
        head.name("cell"),
        _published(document.table("published")),
        _parameters(document.table("experiments")),
    )
    document.finish()
    return data


PERCENT = 0.01


def _published(table: Table) -> Published:
    keys = (
        "search_time_change",
        "expanded_change",
        "search_time_change_against_goals",
        "expanded_change_against_goals",
        "amplitude_change",
        "deviation_change",
    )
    variation = table.table("variation_change_percent")
    improved = table.table("improved")
    kinds = ("search_time_change", "mean_clearance_change", "least_clearance_change")
    low, high = table.numbers("weight_ratio", 2)
    runs = [_run(one) for one in table.tables("schemes")]
    return Published(
        source=table.text("source"),
        beam=table.name("beam"),
        schemes={one.name: one for one in runs},
        beams=tuple(_run(one) for one in table.tables("beams")),
        changes={key: table.number(f"{key}_percent") * PERCENT for key in keys},
        variation={
            key: variation.number(key) * PERCENT for key in JOINT_NAMES if variation.has(key)
        },
        improved={key: improved.number(f"{key}_percent") * PERCENT for key in kinds},
        weight_ratio=(low, high),
    )


def _run(table: Table) -> PublishedRun:
    return PublishedRun(
        table.name("name"),
        table.number("least_clearance_mm", None),
        table.number("mean_clearance_mm", None),
        table.number("search_time_s", None),
        table.integer("expanded", 1, 10**9, None),
    )


def _parameters(table: Table) -> Parameters:
    return Parameters(
        time_repeats=table.integer("time_repeats", 1, 1000),
        weight_seeds=table.integers("weight_seeds", 0, 10**6),
        weight_pairs=table.integer("weight_pairs", 1, 10**5),
        random_draws=table.integer("random_draws", 1, 10**5),
        lean_steps=_angles(table, "lean_steps_deg"),
        wider_lean=_angles(table, "wider_lean_deg"),
        lead_range=table.number("lead_range_deg"),
        lead_step=table.number("lead_step_deg"),
        penalty_poses=table.integer("penalty_poses", 1, 10**6),
        penalty_near=table.number("penalty_near_mm", low=0.0),
        heuristic_nodes=table.integer("heuristic_nodes", 1, 10**7),
        placement_quantile=table.number("placement_quantile_percent", low=0.0) * PERCENT,
        placement_shift=table.number("placement_shift_mm", low=0.0),
        placement_turn=table.number("placement_turn_deg", low=0.0),
        placement_draws=table.integer("placement_draws", 1, 10**6),
        placement_seed=table.integer("placement_seed", 0, 10**6),
        refine_gain=table.number("refine_gain_percent", low=0.0) * PERCENT,
        refine_patience=table.integer("refine_patience", 1, 10),
        refine_halvings=table.integer("refine_halvings", 1, 20),
        refine_keep=table.number("refine_keep_percent", low=0.0) * PERCENT,
        refine_nodes=table.integer("refine_nodes", 1, 10**8),
        bound_pairs=table.integer("bound_pairs", 1, 10**10),
        bound_gap=table.number("bound_gap_percent", low=0.0) * PERCENT,
        front_step=table.number("front_step_mm", low=0.0),
    )


def _angles(table: Table, key: str) -> tuple[float, ...]:
    count = len(table.get(key, "a list of numbers in deg"))
    return table.numbers(key, count)
