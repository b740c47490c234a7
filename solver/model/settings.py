"""Settings of planning: what is tried, what is allowed, and what is cheap."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import Enum

import numpy as np

from solver.errors import ModelError
from solver.model.scheme import Scheme as Scheme  # noqa: PLC0414 - a setting
from solver.transforms import FloatArray, frozen
from solver.units import DEG, DEG_PER_RAD, MM

BRANCHES = 8


@dataclass(frozen=True, slots=True)
class Sweep:
    """Angles tried about one axis [rad]: lower, lower + step, ... up to upper."""

    lower: float
    upper: float
    step: float

    def __post_init__(self) -> None:
        if not all(map(math.isfinite, (self.lower, self.upper, self.step))):
            raise ModelError("the bounds and the step of a sweep must be finite")
        if self.upper < self.lower:
            raise ModelError(
                f"a sweep must run upward, got {self.lower * DEG_PER_RAD:g} to "
                f"{self.upper * DEG_PER_RAD:g} deg"
            )
        if self.step <= 0.0:
            raise ModelError(f"the step of a sweep must be positive, got {self.step:g} rad")
        if (self.upper - self.lower) / self.step > 100_000:
            raise ModelError("a sweep holds more than 100,000 angles; use a larger step")

    def angles(self) -> FloatArray:
        """All angles, ascending [rad]; the upper bound is one of them where the step meets it."""
        count = math.floor((self.upper - self.lower) / self.step + 1e-9) + 1
        return self.lower + self.step * np.arange(count, dtype=np.float64)

    @classmethod
    def fixed(cls, angle: float = 0.0) -> Sweep:
        """A sweep of a single angle [rad]."""
        return cls(angle, angle, 1.0)


class Turns(Enum):
    """Which representatives of a joint vector become candidates."""

    ALL = "all"
    """Every +-360 deg turn inside the limits."""

    PRINCIPAL = "principal"
    """Only the one with every joint in (-180, 180] deg, as in the paper."""


class EdgeCost(Enum):
    """How a change of joints between neighbouring waypoints is counted."""

    ABSOLUTE = "absolute"
    """Sum of range-normalised absolute changes (the paper's)."""

    SQUARED = "squared"
    """Sum of range-normalised squared changes."""


@dataclass(frozen=True, slots=True)
class CostWeights:
    """Weights of the continuous node terms of `exact`; each is scaled by the path's length.

    `clearance` weighs ``max(0, 1 - d / comfort)^2``, `lean` and `lead` the squared deviation
    from the pass's nominal angle in units of 45 deg; `link` multiplies the joint cost of links.
    """

    clearance: float = 0.0
    comfort: float = 0.1
    lean: float = 0.0
    lead: float = 0.0
    link: float = 1.0

    def __post_init__(self) -> None:
        if min(self.clearance, self.lean, self.lead, self.link) < 0.0 or self.comfort <= 0.0:
            raise ModelError("cost weights cannot be negative, and comfort must be positive")


@dataclass(frozen=True, slots=True, eq=False)
class StepLimits:
    """Bounds of what may change between neighbouring waypoints (infinite: no bound).

    `joints` (6,) is for the pendant's joints within a pass, `link_joints` (6,) between passes
    [rad]; `lean` bounds the lean within a pass [rad]. With `at_feed`, a joint may also not
    move faster than its speed allows at the asked feed.
    """

    joints: FloatArray = field(default_factory=lambda: np.full(6, np.inf))
    link_joints: FloatArray = field(default_factory=lambda: np.full(6, np.inf))
    lean: float = math.inf
    at_feed: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "joints", frozen(self.joints, (6,)))
        object.__setattr__(self, "link_joints", frozen(self.link_joints, (6,)))
        if np.any(self.joints <= 0.0) or np.any(self.link_joints <= 0.0) or self.lean <= 0.0:
            raise ModelError("step limits must be positive")


@dataclass(frozen=True, slots=True, eq=False)
class PlanningSettings:
    """Everything that shapes the candidates, the filters and the search.

    Lengths in [m], angles in [rad], manipulability in [m^3]. `self_margin` is the least
    distance between bodies of the robot and its tool; None leaves self pairs out.
    """

    lean: Sweep = Sweep(-25.0 * DEG, 25.0 * DEG, 1.0 * DEG)
    lead: Sweep = Sweep.fixed()
    spin: Sweep = Sweep.fixed()
    branches: tuple[int, ...] = tuple(range(BRANCHES))
    turns: Turns = Turns.ALL
    manipulability: float = 0.01
    safety_distance: float = 50.0 * MM
    self_margin: float | None = 10.0 * MM
    edge_cost: EdgeCost = EdgeCost.ABSOLUTE
    weights: CostWeights = CostWeights()
    steps: StepLimits = field(default_factory=StepLimits)
    scheme: Scheme = Scheme.EXACT
    heuristic_weight: float = 0.9
    seed: int = 1

    def __post_init__(self) -> None:
        object.__setattr__(self, "branches", tuple(self.branches))
        if not self.branches or sorted(set(self.branches)) != list(self.branches):
            raise ModelError("branches must be a non-empty ascending list without repetition")
        if self.branches[0] < 0 or self.branches[-1] >= BRANCHES:
            raise ModelError(f"branches are numbered 0 to 7, got {list(self.branches)}")
        if not 0.0 <= self.heuristic_weight <= 1.0:
            raise ModelError("the heuristic weight lies in 0..1; above 1 it is not admissible")
        if self.manipulability < 0.0 or self.safety_distance < 0.0:
            raise ModelError("manipulability and safety distance cannot be negative")
        if self.self_margin is not None and self.self_margin < 0.0:
            raise ModelError("the margin of self pairs cannot be negative")
