"""What an importer is told besides the file itself."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

import numpy as np

from solver.errors import InputError
from solver.io.importers.naming import listed, shown
from solver.model.toolpath import Frame
from solver.transforms import FloatArray, frozen
from solver.units import DEG, MM

if TYPE_CHECKING:
    from solver.model.robot import Robot
    from solver.model.tool import Tool

LENGTH_UNITS: Final[Mapping[str, float]] = MappingProxyType({"mm": MM, "m": 1.0})
"""Length units of path files -> metres."""

ENCODINGS: Final = ("utf-8", "gbk", "gb18030", "ascii", "latin-1")
"""Text encodings that may be stated; without one, UTF-8 and then GBK are tried."""

CONVENTIONS: Final = ("normal_travel", "normal_travel_x")
"""How a normal and a travel direction become an orientation, see `ImportOptions.convention`."""

DEFAULT_FEED: Final = 50.0 * MM
"""Feed of passes that state none [m/s]."""

MAX_FEED: Final = 10.0
"""Feeds above this are taken for a mistake of unit [m/s]."""

MAX_NOMINAL: Final = 90.0 * DEG
"""Nominal lean and lead lie within plus and minus this angle [rad]."""


@dataclass(frozen=True, slots=True, eq=False)
class ImportOptions:
    """What the file does not say, and how much of it is accepted.

    Attributes
    ----------
    frame : Frame or None
        Frame of the poses; None takes what the file states. A file that states another is
        refused, and so is a file without a frame when none is given here.
    unit : str or None
        'mm' or 'm' for positions; None takes what the file states, else 'mm'.
    columns : mapping or None
        Field name -> column of a table: the title in its header, or (all of them) the number
        from 1 in a table without a header. Unmapped columns are ignored. None reads the header.
    orientation : (3, 3) array or None
        frame_from_reference rotation of every waypoint that states none itself.
    convention : str
        'normal_travel' (z against the outward normal, y along travel, x = y x z) or
        'normal_travel_x' (z against the outward normal, x along travel, y = z x x).
    feed : float
        Feed of passes that state none [m/s].
    touches : str
        Workpiece group that passes without a statement may touch ('' for none).
    lean, lead : float
        Nominal angles of passes that state none [rad].
    row_limit : int
        Most waypoints that are accepted.
    resample : float or None
        Largest distance between waypoints after import [m]; None keeps the file's points.
    encoding : str or None
        One of 'utf-8', 'gbk', 'gb18030', 'ascii', 'latin-1'; None tries UTF-8, then GBK.
    robot, tool : Robot and Tool, or None
        Needed only to read the joint positions of a robot program.
    """

    frame: Frame | None = None
    unit: str | None = None
    columns: Mapping[str, str | int] | None = None
    orientation: FloatArray | None = None
    convention: str = CONVENTIONS[0]
    feed: float = DEFAULT_FEED
    touches: str = ""
    lean: float = 0.0
    lead: float = 0.0
    row_limit: int = 200_000
    resample: float | None = None
    encoding: str | None = None
    robot: Robot | None = None
    tool: Tool | None = None

    def __post_init__(self) -> None:
        _one_of("unit", self.unit, (None, *LENGTH_UNITS))
        _one_of("convention", self.convention, CONVENTIONS)
        _one_of("encoding", self.encoding, (None, *ENCODINGS))
        if not (math.isfinite(self.feed) and 0.0 < self.feed <= MAX_FEED):
            raise InputError(f"the feed must lie above 0 and up to 10 m/s, got {self.feed:g} m/s")
        for name, angle in (("lean", self.lean), ("lead", self.lead)):
            if not abs(angle) <= MAX_NOMINAL:
                raise InputError(f"the nominal {name} must lie within +-90 deg, got {angle:g} rad")
        if self.row_limit < 2:
            raise InputError(f"the row limit must be 2 or more, got {self.row_limit}")
        if self.resample is not None and not (math.isfinite(self.resample) and self.resample > 0):
            raise InputError(f"the resampling step must be positive, got {self.resample:g} m")
        if self.columns is not None:
            object.__setattr__(self, "columns", MappingProxyType(dict(self.columns)))
        if self.orientation is not None:
            object.__setattr__(self, "orientation", _rotation(self.orientation))


def _one_of(what: str, value: str | None, known: tuple[str | None, ...]) -> None:
    if value not in known:
        names = [name for name in known if name is not None]
        raise InputError(f"the {what} of an import is {listed(names, 'or')}, got {shown(value)}")


def _rotation(values: FloatArray) -> FloatArray:
    try:
        rotation = frozen(values, (3, 3))
    except (TypeError, ValueError) as error:
        raise InputError("the stated orientation must be a 3 x 3 rotation of numbers") from error
    square = np.abs(rotation.T @ rotation - np.eye(3)).max()
    if not (square < 1e-6 and np.linalg.det(rotation) > 0.0):
        raise InputError("the stated orientation is not a right-handed rotation within 1e-6")
    return rotation
