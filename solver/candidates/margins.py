"""One filter's verdict on one candidate, with its signed margin."""

from __future__ import annotations

from dataclasses import dataclass

from solver.candidates.outcomes import Outcome
from solver.transforms import FloatArray
from solver.units import MM_PER_M


@dataclass(frozen=True, slots=True, eq=False)
class FilterMargin:
    """One filter's verdict: `margin` is positive when passed, in `unit`; nan when not defined.

    `subject` names the joint or the two bodies; `points` (2, 3) are their nearest points in
    fanuc_world [m] where there are bodies.
    """

    filter: Outcome
    passed: bool
    margin: float
    unit: str
    subject: str = ""
    points: FloatArray | None = None


def pair_margin(outcome: Outcome, margin: float, subject: str, points: FloatArray) -> FilterMargin:
    """The verdict on two bodies whose distance exceeds what they must keep by `margin` [m]."""
    return FilterMargin(outcome, margin > 0.0, margin * MM_PER_M, "mm", subject, points.copy())
