"""What a person asks of a sequence: places to pass, and regions to stay out of."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Pin:
    """The sequence has to pass waypoint `waypoint` (from 0) with this lean [rad].

    `branch` and `turn` are numbers of the inverse kinematics, None for any.
    """

    waypoint: int
    lean: float
    branch: int | None = None
    turn: int | None = None


@dataclass(frozen=True, slots=True)
class Region:
    """No sequence may pass the waypoints `first` to `last` with leans `low` to `high` [rad].

    `branch` is the only branch that it is about, None for all.
    """

    first: int
    last: int
    low: float
    high: float
    branch: int | None = None
