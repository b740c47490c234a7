"""A named verdict: one value against one limit."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from solver.units import MM_PER_M

if TYPE_CHECKING:
    from solver.transforms import FloatArray


@dataclass(frozen=True, slots=True)
class Check:
    """One verdict: `value` against `limit` in `unit`; `assumed` marks limits that are assumptions.

    `waypoint` is the number (from 0) of the worst waypoint, where there is one.
    """

    name: str
    passed: bool
    value: float
    limit: float
    unit: str
    detail: str = ""
    waypoint: int | None = None
    assumed: bool = False

    def __str__(self) -> str:
        """The check as a line for people."""
        word = "ok    " if self.passed else "FAILED"
        limit = f"{self.limit:.4g}, assumed" if self.assumed else f"{self.limit:.4g}"
        value = "not known" if math.isnan(self.value) else f"{self.value:.4g} {self.unit}"
        text = f"{word} {self.name}: {value} (limit {limit})"
        return f"{text}, {self.detail}" if self.detail else text


def unfinished(name: str, unit: str, why: str) -> Check:
    """A check that could not be completed, and so has failed."""
    return Check(name, False, float("nan"), 0.0, unit, why)


def down_mm(clearance: float) -> float:
    """A clearance [m] in mm, rounded down to 0.1 mm: people never read more than was checked."""
    if not math.isfinite(clearance):
        return clearance
    return math.floor(clearance * MM_PER_M * 10.0) / 10.0


def worst(values: FloatArray) -> tuple[float, int]:
    """Largest value and its index; a value that is not a number is the worst."""
    import numpy as np  # noqa: PLC0415 - the window shows checks before it needs numpy

    index = int(np.argmax(np.where(np.isnan(values), np.inf, values)))
    return float(values[index]), index
