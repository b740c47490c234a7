"""What is pointed at, and what is said to the person."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from solver.candidates.generate import CandidateSet


@dataclass(frozen=True, slots=True)
class Hover:
    """A cell of the map: waypoint, orientation, branch slot, and turn where it is one."""

    waypoint: int
    orientation: int
    branch: int
    turn: int | None = None

    def stands_in(self, candidates: CandidateSet) -> bool:
        """Whether these candidates have such a cell; those of another plan may not."""
        cell = (self.waypoint, self.orientation, self.branch)
        shape = candidates.outcome.shape
        return all(0 <= index < size for index, size in zip(cell, shape, strict=True))


@dataclass(frozen=True, slots=True)
class Message:
    """A sentence for the person: severity is 'info', 'warning' or 'error'."""

    severity: str
    text: str
    waypoint: int | None = None
