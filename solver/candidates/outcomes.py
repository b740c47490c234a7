"""What becomes of a candidate: kept, or the first filter that rejected it."""

from __future__ import annotations

from enum import IntEnum


class Outcome(IntEnum):
    """Outcome of a candidate, in the order in which the filters are asked."""

    FEASIBLE = 0
    UNREACHABLE = 1
    JOINT_LIMIT = 2
    SINGULAR = 3
    COLLISION = 4
    MARGIN = 5
    SELF_COLLISION = 6

    @property
    def label(self) -> str:
        """The outcome in words."""
        return _LABELS[self]


_LABELS = {
    Outcome.FEASIBLE: "feasible",
    Outcome.UNREACHABLE: "out of reach",
    Outcome.JOINT_LIMIT: "joint limit",
    Outcome.SINGULAR: "near a singularity",
    Outcome.COLLISION: "collision with workpiece or fixture",
    Outcome.MARGIN: "near or contact body of the tool too close",
    Outcome.SELF_COLLISION: "robot or tool too close to the robot",
}
