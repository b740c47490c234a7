"""A toolpath: ordered passes of waypoints, each a pose with a role and events."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from enum import Enum
from types import MappingProxyType

import numpy as np

from solver.errors import ModelError
from solver.transforms import FloatArray, frozen


class Frame(Enum):
    """The frame in which the poses of a toolpath are given."""

    BEAM = "beam"
    FLOOR = "floor"
    FANUC_WORLD = "fanuc_world"


class Role(Enum):
    """What the tool does on the way to a waypoint."""

    APPROACH = "approach"
    LEAD_IN = "lead-in"
    CONTACT = "contact"
    LEAD_OUT = "lead-out"
    LINK = "link"


class EventKind(Enum):
    """What happens at a waypoint besides the motion."""

    SPINDLE_ON = "spindle-on"
    SPINDLE_OFF = "spindle-off"
    DWELL = "dwell"
    DIGITAL_OUTPUT = "digital-output"
    CALL = "call"


@dataclass(frozen=True, slots=True)
class Event:
    """An event: `value` is the dwell [s] or the output's 0/1, `target` the output or program."""

    kind: EventKind
    target: str = ""
    value: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class Waypoint:
    """One waypoint: `pose` is frame_from_reference (4, 4), the tool at zero lean, lead and spin."""

    pose: FloatArray
    role: Role = Role.CONTACT
    events: tuple[Event, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class Pass:
    """One pass over the workpiece.

    Attributes
    ----------
    poses : (n, 4, 4) array
        frame_from_reference of every waypoint, in the toolpath's frame.
    roles : tuple of n roles
    events : mapping of waypoint index to events
    feed : float
        Speed of the TCP along the pass [m/s].
    lean, lead : float
        Nominal angles [rad] that the deviation terms of the cost refer to.
    touches : str
        Group of the workpiece body that contact bodies may enter ('' for none).
    """

    poses: FloatArray
    roles: tuple[Role, ...]
    feed: float
    events: Mapping[int, tuple[Event, ...]] = field(default_factory=dict)
    lean: float = 0.0
    lead: float = 0.0
    touches: str = ""
    name: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "poses", frozen(self.poses, (-1, 4, 4)))
        object.__setattr__(self, "roles", tuple(self.roles))
        object.__setattr__(self, "events", MappingProxyType(dict(self.events)))
        if len(self.poses) == 0 or len(self.roles) != len(self.poses):
            raise ModelError(f"pass {self.name!r}: every waypoint needs a pose and a role")
        if not np.isfinite(self.poses).all():
            raise ModelError(f"pass {self.name!r}: a pose holds a value that is not finite")
        if not (np.isfinite(self.feed) and self.feed > 0.0):
            raise ModelError(f"pass {self.name!r}: feed must be positive, got {self.feed:g} m/s")

    def __len__(self) -> int:
        return len(self.poses)

    @property
    def positions(self) -> FloatArray:
        """(n, 3) positions [m]."""
        return self.poses[:, :3, 3]

    def waypoints(self) -> Iterator[Waypoint]:
        """Yield the waypoints of this pass, in order."""
        for index, (pose, role) in enumerate(zip(self.poses, self.roles, strict=True)):
            yield Waypoint(pose, role, self.events.get(index, ()))


@dataclass(frozen=True, slots=True, eq=False)
class Toolpath:
    """Ordered passes in one frame; waypoints are numbered through all passes from 0."""

    passes: tuple[Pass, ...]
    frame: Frame
    source: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "passes", tuple(self.passes))
        if sum(map(len, self.passes)) < 2:
            raise ModelError("a toolpath needs two or more waypoints")

    def __len__(self) -> int:
        return sum(map(len, self.passes))

    @property
    def poses(self) -> FloatArray:
        """(n, 4, 4) frame_from_reference of all waypoints."""
        return np.concatenate([one.poses for one in self.passes])

    @property
    def pass_index(self) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
        """(n,) number of the pass of every waypoint."""
        lengths = [len(one) for one in self.passes]
        return np.repeat(np.arange(len(lengths)), lengths)

    def with_passes(self, passes: tuple[Pass, ...]) -> Toolpath:
        """The same toolpath with other passes."""
        return replace(self, passes=passes)
