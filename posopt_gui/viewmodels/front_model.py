"""The front of clearance against joint motion, as arrays, marks and words."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from posopt_gui.viewmodels.number_words import decimal, signed
from solver.model.scheme import Scheme
from solver.model.settings import CostWeights, EdgeCost, PlanningSettings
from solver.transforms import FloatArray
from solver.units import DEG_PER_RAD, MM, MM_PER_M

if TYPE_CHECKING:
    from solver.analysis.result import PlanningResult, Sequence
    from solver.progress import Monitor
    from solver.study.planned_front import FrontPlan

Translate = Callable[..., str]

PERCENT = 100.0

SAME = 1e-6
"""Clearances nearer to each other than this are one point [m]."""

MOST_EDGES = 2e10
"""Edges that all searches of one front may look at: some ten seconds of one core."""

LEAST_POINTS, MOST_POINTS = 60, 2000
"""Bounds of the number of points, whatever the edges."""

DECIMALS = (2, 3, 4, 5, 6)
"""Decimals of a minimum in mm, tried in this order."""


@dataclass(frozen=True, slots=True)
class Mark:
    """A sequence beside the front: its name, least clearance [mm] and cost."""

    name: str
    clearance: float
    cost: float


@dataclass(frozen=True, slots=True, eq=False)
class FrontModel:
    """All points of a front, by rising clearance.

    `clearance` (k,) [mm] and `cost` (k,); `minimum` (k,) is the safety distance [mm] under
    which planning gives each point; `lean` (k, 2) the least and the largest lean [deg].
    `knee` is the number of a point. `step` [mm] is the least distance of two points, 0 where
    every point is there. `plain` says whether the cost is the joint cost alone.
    """

    clearance: FloatArray
    cost: FloatArray
    minimum: FloatArray
    lean: FloatArray
    knee: int | None
    marks: tuple[Mark, ...]
    step: float
    plain: bool

    def __len__(self) -> int:
        return len(self.cost)

    def nearest(self, place: tuple[float, float], scale: tuple[float, float]) -> tuple[int, float]:
        """The point next to a place, and how far away it is, in units of `scale` a pixel."""
        across = (self.clearance - place[0]) / scale[0]
        up = (self.cost - place[1]) / scale[1]
        away = np.hypot(across, up)
        found = int(away.argmin())
        return found, float(away[found])

    def at(self, present: Mark | None) -> int | None:
        """The number of the point that the present plan is; None where it is none of them."""
        if present is None:
            return None
        same = np.abs(self.cost - present.cost) <= 1e-9 * np.maximum(1.0, self.cost)
        same &= np.abs(self.clearance - present.clearance) <= 0.05
        return int(same.argmax()) if same.any() else None

    def stairs(self) -> tuple[FloatArray, FloatArray]:
        """X [mm] and y of the line between feasible and impossible: it rises behind a point."""
        return np.repeat(self.clearance, 2)[:-1], np.repeat(self.cost, 2)[1:]


def front_model(result: PlanningResult, monitor: Monitor) -> FrontModel | None:
    """Work out the front of a plan's candidates; None where there is no sequence at all.

    Raises
    ------
    Cancelled
        When the monitor asks for it.
    """
    # numba is loaded when it is needed
    from solver.pipeline.planning import layered_graph  # noqa: PLC0415
    from solver.study.pareto import knee  # noqa: PLC0415
    from solver.study.planned_front import planned_front  # noqa: PLC0415

    step = step_of(result)
    plans = planned_front(result, step, monitor)
    if not plans:
        return None
    points = np.array([(one.kept, one.sequence.cost) for one in plans])
    graph = layered_graph(result.candidates)
    costs = {
        scheme: graph.path_cost(one.nodes)
        for scheme, one in result.sequences.items()
        if scheme is not Scheme.EXACT
    }
    marks = tuple(
        Mark(scheme.value, result.sequences[scheme].least_clearance * MM_PER_M, cost)
        for scheme, cost in costs.items()
        if math.isfinite(cost)
    )
    lean = np.array([_lean_range(one.sequence) for one in plans]) * DEG_PER_RAD
    return FrontModel(
        clearance=points[:, 0] * MM_PER_M,
        cost=points[:, 1],
        minimum=np.array([minimum_mm(one) for one in plans]),
        lean=lean,
        knee=knee(points),
        marks=marks,
        step=0.0 if step <= SAME else step * MM_PER_M,
        plain=is_plain(result.problem.settings),
    )


def step_of(result: PlanningResult) -> float:
    """Least distance of two points [m], so that the front of a large graph comes in time."""
    allowed = MOST_EDGES / max(result.graph.edge_count, 1)
    points = min(max(allowed, LEAST_POINTS), MOST_POINTS)
    if points >= MOST_POINTS:
        return SAME
    clearance = result.candidates.nodes.clearance
    finite = clearance[np.isfinite(clearance)]
    return max(float(np.ptp(finite)) / points, SAME) if len(finite) else SAME


def minimum_mm(plan: FrontPlan) -> float:
    """A safety distance [mm] with few decimals under which planning gives this very plan."""
    kept = plan.kept * MM_PER_M
    for decimals in DECIMALS:
        tens = 10.0**decimals
        value = math.floor(kept * tens) / tens
        if plan.lowest <= value * MM <= plan.kept:
            return value
    while kept * MM > plan.kept:
        kept = math.nextafter(kept, 0.0)
    return kept


def is_plain(settings: PlanningSettings) -> bool:
    """Whether the objective is the joint cost alone."""
    weights, none = settings.weights, CostWeights()
    extra = (weights.clearance, weights.lean, weights.lead, weights.link)
    return settings.edge_cost is EdgeCost.ABSOLUTE and extra == (
        none.clearance, none.lean, none.lead, none.link,
    )  # fmt: skip


def present_mark(model: FrontModel, sequence: Sequence | None) -> Mark | None:
    """Where the shown sequence stands; None where its cost cannot be compared."""
    if sequence is None:
        return None
    clearance = sequence.least_clearance * MM_PER_M
    if sequence.scheme is Scheme.EXACT:
        return Mark("", clearance, sequence.cost)
    same = [one for one in model.marks if one.name == sequence.scheme.value]
    return Mark("", clearance, same[0].cost) if same else None


def alike(one: Mark, other: Mark) -> bool:
    """Whether two marks stand in one place."""
    same_cost = math.isclose(one.cost, other.cost, rel_tol=1e-9)
    return same_cost and abs(one.clearance - other.clearance) < SAME * MM_PER_M


def joined(marks: tuple[Mark, ...]) -> tuple[Mark, ...]:
    """Marks in one place become one with all their names."""
    found: list[Mark] = []
    for one in marks:
        same = [at for at, other in enumerate(found) if alike(one, other)]
        if same:
            other = found[same[0]]
            found[same[0]] = Mark(f"{other.name}, {one.name}", other.clearance, other.cost)
        else:
            found.append(one)
    return tuple(found)


def axis_range(
    values: FloatArray, others: list[float], room: tuple[float, float] = (0.07, 0.07)
) -> tuple[float, float]:
    """Range of an axis that shows all points, and marks that are not far away.

    `room` is what is left below and above, as shares of their range.
    """
    low, high = float(values.min()), float(values.max())
    span = max(high - low, 1e-9 * max(abs(high), 1.0))
    near = [one for one in others if low - span <= one <= high + span]
    low, high = min([low, *near]), max([high, *near])
    span = max(high - low, span)
    return low - room[0] * span, high + room[1] * span


def cost_words(model: FrontModel, translate: Translate) -> str:
    """What the cost is called."""
    return translate("joint cost") if model.plain else translate("objective")


def point_words(
    model: FrontModel, index: int, present: Mark | None, translate: Translate
) -> tuple[str, str]:
    """A point in two lines: its clearance and cost, and how that differs from the plan."""
    clearance = math.floor(model.clearance[index] * 100.0) / 100.0
    head = translate(
        "{clearance} mm · {name} {cost}",
        clearance=decimal(clearance, 2), name=cost_words(model, translate),
        cost=decimal(float(model.cost[index]), 5),
    )  # fmt: skip
    low, high = model.lean[index]
    lean = translate("lean {low}° to {high}°", low=decimal(low, 2), high=decimal(high, 2))
    parts = []
    if index == model.at(present):
        parts.append(translate("this is the plan"))
    elif present is not None and present.cost > 0.0:
        share = PERCENT * (float(model.cost[index]) / present.cost - 1.0)
        parts.append(
            translate(
                "{clearance} mm and {share} % to the plan",
                clearance=signed(float(model.clearance[index]) - present.clearance, 2),
                share=signed(share, 1),
            )
        )
    if index == model.knee:
        parts.append(translate("knee: from here on clearance becomes dearer"))
    parts.append(lean)
    return head, " · ".join(parts)


def summary(model: FrontModel, translate: Translate) -> str:
    """How many points there are, and what each is."""
    if model.step > 0.0:
        return translate(
            "{count} points, at least {step} mm apart; each is the proven optimum for its least "
            "clearance. A click takes that plan.",
            count=f"{len(model):,}", step=decimal(model.step, 2),
        )  # fmt: skip
    return translate(
        "All {count} points; each is the proven optimum for its least clearance. A click takes "
        "that plan.",
        count=f"{len(model):,}",
    )


def moved(model: FrontModel, index: int | None, by: int, present: Mark | None) -> int:
    """The point to select when a key moves the selection."""
    if index is None:
        start = model.at(present)
        return start if start is not None else (model.knee or 0)
    return min(max(index + by, 0), len(model) - 1)


def _lean_range(sequence: Sequence) -> tuple[float, float]:
    lean: FloatArray = sequence.angles[:, 0]
    return float(lean.min()), float(lean.max())
