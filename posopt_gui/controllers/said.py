"""What is pointed at, and what is said to the person."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Hover:
    """A cell of the map: waypoint, orientation, branch slot, and turn where it is one."""

    waypoint: int
    orientation: int
    branch: int
    turn: int | None = None


@dataclass(frozen=True, slots=True)
class Message:
    """A sentence for the person: severity is 'info', 'warning' or 'error'."""

    severity: str
    text: str
    waypoint: int | None = None
