"""A robot program without any maker's syntax: moves through rounded pendant joints."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solver.errors import ModelError
from solver.model.toolpath import Event
from solver.transforms import FloatArray, frozen
from solver.units import DEG, DEG_PER_RAD

JOINT_DECIMALS = 3
"""Decimals of a degree in exported joint positions."""


def rounded_joints(joints: FloatArray) -> FloatArray:
    """Pendant joints [rad] rounded to the export's decimals of a degree; -0 becomes 0."""
    return (np.round(joints * DEG_PER_RAD, JOINT_DECIMALS) + 0.0) * DEG


@dataclass(frozen=True, slots=True, eq=False)
class Move:
    """A joint move to `joints` (6,), the pendant's J1..J6 [rad], already rounded.

    Either `percent` of the joint speed (1..100) or a `duration` [s] is given; `cnt` is the
    rounding 0..100, or None for FINE. `waypoint` is the number of the waypoint it reaches.
    """

    joints: FloatArray
    percent: int | None = None
    duration: float | None = None
    cnt: int | None = None
    waypoint: int = 0
    events: tuple[Event, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "joints", frozen(self.joints, (6,)))
        if (self.percent is None) == (self.duration is None):
            raise ModelError("a move needs a speed in percent or a duration, and not both")
        if self.percent is not None and not 1 <= self.percent <= 100:
            raise ModelError(f"a joint speed is 1 to 100 percent, got {self.percent}")
        if self.duration is not None and not self.duration > 0.0:
            raise ModelError(f"the duration of a move must be positive, got {self.duration:g} s")
        if self.cnt is not None and not 0 <= self.cnt <= 100:
            raise ModelError(f"CNT is 0 to 100, got {self.cnt}")


@dataclass(frozen=True, slots=True, eq=False)
class JointProgram:
    """A program of joint moves; `remarks` stand at its head, `date` and `time` in its attributes.

    `date` is 'YY-MM-DD', `time` 'HH:MM:SS'.
    """

    name: str
    comment: str
    remarks: tuple[str, ...]
    uframe: int
    utool: int
    moves: tuple[Move, ...]
    date: str
    time: str

    @property
    def joints(self) -> FloatArray:
        """(n, 6) pendant joints of all moves [rad]."""
        return np.array([move.joints for move in self.moves])
