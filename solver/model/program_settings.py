"""What the robot program of a cell looks like: names, numbers, motions, links and accuracy."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

import numpy as np

from solver.errors import ModelError
from solver.model.toolpath import Event
from solver.transforms import FloatArray, frozen
from solver.units import MM


class ContactMotion(Enum):
    """How the tool is moved along the path while it grinds."""

    JOINT = "joint"
    """Joint moves that take the time of their distance at the feed (`J ... msec`)."""

    LINEAR = "linear"
    """Linear moves at the feed (`L ... mm/sec`)."""


class Withdrawal(Enum):
    """Direction in which the tool leaves the face."""

    TOOL = "tool"
    """Back along the tool's own z axis."""

    NORMAL = "normal"
    """Along the outward normal of the face that the pass touches."""


@dataclass(frozen=True, slots=True, eq=False)
class LinkSettings:
    """How the tool comes to a pass and leaves it. Lengths in [m], speeds in [m/s].

    Attributes
    ----------
    approach : float
        How far the tool is withdrawn before and after a pass.
    withdrawal : Withdrawal
        The direction of approach and retract.
    lead_in, lead_in_height : float
        The tool comes onto the face while moving: from a point this far before the first
        waypoint, against the travel, and this high above it. Both 0 leave it out; what is not
        free is shortened.
    lead_out, lead_out_height : float
        The same behind the last waypoint.
    height : float
        How far the tool is lifted, straight up, where the direct link is not free.
    percent : int
        Joint speed of links and of the moves from and to home [%].
    speed : float
        TCP speed of approach and retract.
    clearance : float
        Least clearance on everything that is no contact move.
    home : (6,) array or None
        Pendant joints [rad] where the program begins and ends; None for no such moves.
    before, after : tuple of Event
        What happens above the face before a pass and after it (spindle, air).
    """

    approach: float = 60.0 * MM
    withdrawal: Withdrawal = Withdrawal.TOOL
    lead_in: float = 10.0 * MM
    lead_in_height: float = 5.0 * MM
    lead_out: float = 10.0 * MM
    lead_out_height: float = 5.0 * MM
    height: float = 150.0 * MM
    percent: int = 20
    speed: float = 100.0 * MM
    clearance: float = 10.0 * MM
    home: FloatArray | None = None
    before: tuple[Event, ...] = ()
    after: tuple[Event, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "before", tuple(self.before))
        object.__setattr__(self, "after", tuple(self.after))
        if self.home is not None:
            object.__setattr__(self, "home", frozen(self.home, (6,)))
            if not np.isfinite(self.home).all():
                raise ModelError("the home position holds a joint that is not finite")
        lengths = (self.lead_in, self.lead_in_height, self.lead_out, self.lead_out_height)
        if min(*lengths, self.height, self.clearance) < 0.0:
            raise ModelError("lengths and heights of links cannot be negative")
        if not (self.approach > 0.0 and self.speed > 0.0):
            raise ModelError("the approach distance and its speed must be positive")
        if not 1 <= self.percent <= 100:
            raise ModelError(f"the speed of links is 1 to 100 percent, got {self.percent}")


@dataclass(frozen=True, slots=True)
class Accuracy:
    """How far robot, workpiece and TCP may be from the nominal model [m], as the cell declares."""

    robot: float = 0.0
    workpiece: float = 0.0
    tcp: float = 0.0

    def __post_init__(self) -> None:
        if not all(math.isfinite(one) and one >= 0.0 for one in self.parts):
            raise ModelError("a declared accuracy cannot be negative")

    @property
    def parts(self) -> tuple[float, float, float]:
        """The three shares [m]."""
        return self.robot, self.workpiece, self.tcp

    @property
    def total(self) -> float:
        """What they take from a clearance at worst: their sum [m]."""
        return sum(self.parts)


@dataclass(frozen=True, slots=True, eq=False)
class ProgramSettings:
    """What the robot program is called, what it holds, and what it is held to.

    Attributes
    ----------
    post : str
        Name of the post-processor.
    uframe, utool, payload, offset : int
        Numbers on the controller: user frame, tool, payload schedule (None: not selected) and
        the position register of an offset (None: none). User frame 0 is fanuc_world, any other
        one is the workpiece's frame.
    frame_measured, tool_measured : bool
        Whether the workpiece's placement and the tool's TCP were measured at the cell.
    date, time : str
        'YY-MM-DD' and 'HH:MM:SS': stated by the cell, never by the clock.
    approach_percent : int
        Joint speed of the move to the first position where there are no links [%].
    name_length, line_limit : int
        Longest program name and most lines of a program that the controller takes.
    spindle_on, spindle_off : str
        Programs on the controller that the spindle events call.
    path_tolerance : float
        How far the moved TCP may leave the path between positions [m].
    feed_tolerance : float
        How far the predicted TCP speed may be from the asked feed, as a share.
    """

    name: str = "POSOPT"
    comment: str = ""
    uframe: int = 0
    utool: int = 1
    date: str = "26-01-01"
    time: str = "00:00:00"
    approach_percent: int = 10
    post: str = "fanuc-joint"
    contact: ContactMotion = ContactMotion.JOINT
    payload: int | None = None
    offset: int | None = None
    frame_measured: bool = False
    tool_measured: bool = False
    name_length: int = 36
    line_limit: int = 9_999
    spindle_on: str = "SPINDLE_ON"
    spindle_off: str = "SPINDLE_OFF"
    path_tolerance: float = 0.5 * MM
    feed_tolerance: float = 0.1
    links: LinkSettings | None = None
