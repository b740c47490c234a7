"""A robot program without any maker's syntax: moves between rounded pendant joints.

Posts only render it, and the interpreter of a program file returns it: what is checked is the
same thing before writing and after reading.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

import numpy as np

from solver.errors import ModelError
from solver.model.toolpath import Event, Role
from solver.transforms import FloatArray, frozen
from solver.units import DEG, DEG_PER_RAD, MM_PER_M

JOINT_DECIMALS = 3
"""Decimals of a degree in exported joint positions."""


def rounded_joints(joints: FloatArray) -> FloatArray:
    """Pendant joints [rad] rounded to the export's decimals of a degree; -0 becomes 0."""
    return (np.round(joints * DEG_PER_RAD, JOINT_DECIMALS) + 0.0) * DEG


class MotionKind(Enum):
    """How the controller interpolates a move."""

    JOINT = "J"
    """Linearly in the joints."""

    LINEAR = "L"
    """The TCP on a straight line, the tool turning about one axis."""


class SpeedUnit(Enum):
    """What the number of a speed means."""

    PERCENT = "percent of the joint speed"
    LINEAR = "m/s"
    DURATION = "s"


@dataclass(frozen=True, slots=True)
class Speed:
    """A speed: percent of the joints' speeds (1..100), TCP speed [m/s], or time of the move [s]."""

    value: float
    unit: SpeedUnit

    def __post_init__(self) -> None:
        if not (math.isfinite(self.value) and self.value > 0.0):
            raise ModelError(f"a speed must be positive and finite, got {self.value:g}")
        if self.unit is SpeedUnit.PERCENT and not 1.0 <= self.value <= 100.0:
            raise ModelError(f"a joint speed is 1 to 100 percent, got {self.value:g}")

    def __str__(self) -> str:
        """The speed for people."""
        match self.unit:
            case SpeedUnit.PERCENT:
                return f"{self.value:g} %"
            case SpeedUnit.LINEAR:
                return f"{self.value * MM_PER_M:g} mm/s"
            case SpeedUnit.DURATION:
                return f"{self.value:g} s"

    @classmethod
    def percent(cls, value: float) -> Speed:
        """A share of every joint's speed [%]."""
        return cls(value, SpeedUnit.PERCENT)

    @classmethod
    def linear(cls, value: float) -> Speed:
        """A speed of the TCP [m/s]."""
        return cls(value, SpeedUnit.LINEAR)

    @classmethod
    def duration(cls, value: float) -> Speed:
        """The time that the move takes [s]."""
        return cls(value, SpeedUnit.DURATION)


@dataclass(frozen=True, slots=True, eq=False)
class Move:
    """A move to `joints` (6,), the pendant's J1..J6 [rad].

    Attributes
    ----------
    cnt : int or None
        Rounding of the corner 0..100; None for FINE.
    role : Role
        What the tool does on the way there.
    waypoint : int or None
        Number of the toolpath's waypoint that it reaches, from 0; None for a position that
        posopt generated, and in a program that was read.
    events : tuple of Event
        What happens when it has arrived.
    source : str
        Where it was read ('GROOVE.LS:12'), '' where it was generated.
    """

    joints: FloatArray
    speed: Speed
    kind: MotionKind = MotionKind.JOINT
    cnt: int | None = None
    role: Role = Role.CONTACT
    waypoint: int | None = None
    events: tuple[Event, ...] = ()
    source: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "joints", frozen(self.joints, (6,)))
        object.__setattr__(self, "events", tuple(self.events))
        if self.kind is MotionKind.LINEAR and self.speed.unit is SpeedUnit.PERCENT:
            raise ModelError("a linear move takes a speed in mm/s or a time, not percent")
        if self.kind is MotionKind.JOINT and self.speed.unit is SpeedUnit.LINEAR:
            raise ModelError("a joint move takes a speed in percent or a time, not mm/s")
        if self.cnt is not None and not 0 <= self.cnt <= 100:
            raise ModelError(f"CNT is 0 to 100, got {self.cnt}")


@dataclass(frozen=True, slots=True, eq=False)
class NumberedPose:
    """A frame or tool of the controller: its number and the pose that its register must hold.

    `pose` (4, 4) is fanuc_world_from_uframe or flange_from_tcp; `measured` says whether it was
    measured at the cell or is nominal.
    """

    number: int
    pose: FloatArray
    measured: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "pose", frozen(self.pose, (4, 4)))


@dataclass(frozen=True, slots=True, eq=False)
class JointProgram:
    """A program: remarks at its head, then moves in order.

    Attributes
    ----------
    frame, tool : NumberedPose
        User frame and tool that are selected before the first move.
    payload : int or None
        Number of the payload schedule that is selected, None for none.
    offset : int or None
        Number of the position register whose offset contact moves add, None for none.
    date, time : str
        'YY-MM-DD' and 'HH:MM:SS'.
    """

    name: str
    comment: str
    remarks: tuple[str, ...]
    frame: NumberedPose
    tool: NumberedPose
    moves: tuple[Move, ...]
    date: str
    time: str
    payload: int | None = None
    offset: int | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "remarks", tuple(self.remarks))
        object.__setattr__(self, "moves", tuple(self.moves))

    @property
    def joints(self) -> FloatArray:
        """(n, 6) pendant joints of all moves [rad]."""
        return np.array([move.joints for move in self.moves]).reshape(-1, 6)
