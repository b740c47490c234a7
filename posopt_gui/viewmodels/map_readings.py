"""The card beside the mouse: what a cell holds, in words and numbers."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from posopt_gui.viewmodels.map_colours import CLASS_LABELS, Layer
from posopt_gui.viewmodels.map_model import PERCENT, MapModel, Reading
from posopt_gui.viewmodels.number_words import clearance_mm, decimal, signed
from solver.analysis.check import down_mm
from solver.units import MM

if TYPE_CHECKING:
    from solver.candidates.explain import Explanation

Translate = Callable[..., str]


@dataclass(frozen=True, slots=True)
class Row:
    """A line of the card: `passed` is None where nothing was checked.

    As in the inspector, `value` is what was found and `margin` what is left to the limit; `near`
    is what passed, but keeps less than the safety distance.
    """

    label: str
    value: str
    subject: str = ""
    passed: bool | None = None
    margin: str = ""
    near: bool = False


@dataclass(frozen=True, slots=True)
class Card:
    """Heading, verdict and lines about one candidate."""

    title: str
    posture: str
    verdict: str
    rows: tuple[Row, ...]


def degrees(value: float, decimals: int = 0) -> str:
    """An angle [deg] in words."""
    return f"{decimal(value, decimals)}°"


def angle_words(model: MapModel, reading: Reading, tr: Translate) -> str:
    """Lean, and lead and spin where they are swept."""
    decimals = 0 if abs(model.lean_step - round(model.lean_step)) < 1e-9 else 2
    words = tr("lean {value}", value=degrees(reading.lean, decimals))
    if len(model.leads) > 1:
        words += ", " + tr("lead {value}", value=degrees(reading.lead, 1))
    if len(model.spins) > 1:
        words += ", " + tr("spin {value}", value=degrees(reading.spin, 1))
    return words


def price_words(price: float, cost: float, tr: Translate) -> str:
    """What a wish costs, absolute and as a share of the plan's cost."""
    if not math.isfinite(price):
        return tr("no sequence")
    share = f" ({signed(PERCENT * price / cost, 1)} %)" if cost > 0.0 else ""
    return f"{signed(price, 4)}{share}"


def card(
    model: MapModel,
    reading: Reading,
    values: dict[Layer, float],
    explanation: Explanation | None,
    tr: Translate,
) -> Card:
    """The card of a cell; `explanation` adds every filter with its bodies once it is known."""
    title = tr("Waypoint {number}", number=reading.waypoint + 1)
    title += " · " + angle_words(model, reading, tr)
    posture = tr("branch {number}", number=reading.branch)
    if reading.turn is not None and reading.turns > 1:
        posture += " · " + tr(
            "turn {number} of {count}", number=reading.turn + 1, count=reading.turns
        )
    rows = _search_rows(values, tr)
    if explanation is not None:
        rows += _filter_rows(model, explanation, tr)
    else:
        rows += _array_rows(model, reading, values, tr)
    return Card(title, posture, tr(CLASS_LABELS[reading.kind]), tuple(rows))


def _search_rows(values: dict[Layer, float], tr: Translate) -> list[Row]:
    rows = []
    extra = values.get(Layer.EXTRA_COST, math.nan)
    if math.isinf(extra):
        rows.append(Row(tr("Extra cost"), tr("no sequence passes"), "", False))
    elif not math.isnan(extra):
        rows.append(Row(tr("Extra cost"), f"{signed(extra, 2)} %"))
    for layer in (Layer.EXPANDED_F, Layer.EXPANDED_F1, Layer.EXPANDED_F2):
        if layer in values:
            order = values[layer]
            text = tr("never") if math.isnan(order) else f"{order:.0f}"
            rows.append(Row(tr("Expanded by {scheme}", scheme=layer.scheme), text))
    return rows


def _array_rows(
    model: MapModel, reading: Reading, values: dict[Layer, float], tr: Translate
) -> list[Row]:
    """What is known at once, without asking the solver."""
    rows = []
    if Layer.CLEARANCE in values:
        safety = model.candidates.problem.settings.safety_distance
        found = values[Layer.CLEARANCE] * MM
        beyond = f"{signed(down_mm(found - safety), 1)} mm"
        value = f"{clearance_mm(found)} mm"
        rows.append(Row(tr("Clearance"), value, "", True, beyond, near=found < safety))
    if Layer.MANIPULABILITY in values:
        rows.append(Row(tr("Manipulability"), f"{decimal(values[Layer.MANIPULABILITY], 4)} m³"))
    if Layer.LIMIT_MARGIN in values:
        margin = f"{signed(values[Layer.LIMIT_MARGIN], 2)}°"
        rows.append(Row(tr("Joint limits"), "", margin=margin))
    return rows


def _filter_rows(model: MapModel, explanation: Explanation, tr: Translate) -> list[Row]:
    """Every filter as the inspector has it."""
    from posopt_gui.viewmodels.inspector_model import filter_rows  # noqa: PLC0415

    return [
        Row(
            one.name,
            one.value,
            one.subject,
            one.state != "bad",
            one.margin,
            near=one.state == "near",
        )
        for one in filter_rows(model.candidates.problem, explanation, tr)
    ]
