"""The path of a cell: a file, or a line across the web that follows the section.

The table `path` holds one of `file`, `web_line` and `parametric`, and beside it what the file does
not say itself: `frame`, `unit`, `orientation_wpr_deg` with `orientation_frame`, `feed_mm_s`,
`touches`, `lean_deg`, `lead_deg`, `resample_mm`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

from solver.catalog.bodies import read_rotation
from solver.catalog.toml_reader import Table
from solver.io.importers import ImportOptions, load_toolpath
from solver.model.robot import Robot
from solver.model.tool import Tool
from solver.model.toolpath import Frame, Pass, Role, Toolpath
from solver.model.workpiece import BeamSection, Workpiece
from solver.transforms import FloatArray, rigid
from solver.units import MM

FRAMES: Final = tuple(frame.value for frame in Frame)
KINDS: Final = ("file", "web_line")
MAXIMUM_POINTS: Final = 200_000
MAXIMUM_FEED: Final = 10.0
"""Largest feed that is taken for a feed [m/s]."""


@dataclass(frozen=True, slots=True, eq=False)
class PathOwner:
    """What a path is planned on: the frames and the joints of its poses refer to these."""

    workpiece: Workpiece
    robot: Robot
    tool: Tool

    def rotation_in(self, target: Frame, source: Frame, rotation: FloatArray) -> FloatArray:
        """Turn a (3, 3) rotation stated in the source frame into the target frame."""
        # Floor and fanuc_world are parallel; only the beam is turned.
        floor_from_beam = self.workpiece.placement[:3, :3]
        if source is Frame.BEAM:
            rotation = floor_from_beam @ rotation
        return floor_from_beam.T @ rotation if target is Frame.BEAM else rotation


@dataclass(frozen=True, slots=True, eq=False)
class _Orientation:
    """The stated orientation of points that have none, and the frame it is stated in."""

    rotation: FloatArray
    frame: Frame | None


def read_path(table: Table, owner: PathOwner, override: Path | None = None) -> Toolpath:
    """Read the cell's own path, or that of another file read with the cell's options.

    A file given instead of the cell's own states its frame itself.

    Raises
    ------
    InputError
        If the table or the path file is unusable.
    """
    kinds = [key for key in KINDS if table.has(key)]
    if len(kinds) != 1:
        found = " and ".join(kinds) if kinds else "none"
        raise table.error(None, f"expected one of the keys {', '.join(KINDS)}, found {found}")
    orientation = _orientation(table)
    options = _options(table, owner)
    frame = _frame(table, "frame")
    own = None
    if kinds[0] == "web_line":
        own = _web_line(table, owner, options, orientation)
    file = table.text("file") if kinds[0] == "file" else ""
    if override is not None:
        return _load(override, options, orientation, owner)
    if own is not None:
        return own
    return _load(table.folder / file, replace(options, frame=frame), orientation, owner)


def _load(
    path: Path, options: ImportOptions, orientation: _Orientation | None, owner: PathOwner
) -> Toolpath:
    if orientation is None:
        return load_toolpath(path, options)
    options = replace(options, orientation=orientation.rotation)
    toolpath = load_toolpath(path, options)
    stated = orientation.frame or toolpath.frame
    turned = owner.rotation_in(toolpath.frame, stated, orientation.rotation)
    if np.array_equal(turned, orientation.rotation):
        return toolpath
    return load_toolpath(path, replace(options, orientation=turned))


def _frame(table: Table, key: str) -> Frame | None:
    return Frame(table.choice(key, FRAMES)) if table.has(key) else None


def _orientation(table: Table) -> _Orientation | None:
    frame = _frame(table, "orientation_frame")
    if not table.has("orientation_wpr_deg"):
        return None
    return _Orientation(read_rotation(table, "orientation_wpr_deg"), frame)


def _options(table: Table, owner: PathOwner) -> ImportOptions:
    default = ImportOptions()
    unit = table.choice("unit", ("mm", "m")) if table.has("unit") else None
    limit = 90.0
    return ImportOptions(
        unit=unit,
        feed=_feed(table, default.feed),
        touches=_touches(table, owner.workpiece),
        lean=table.number("lean_deg", default.lean, low=-limit, high=limit),
        lead=table.number("lead_deg", default.lead, low=-limit, high=limit),
        resample=_positive(table, "resample_mm") if table.has("resample_mm") else None,
        robot=owner.robot,
        tool=owner.tool,
    )


def _feed(table: Table, default: float) -> float:
    if not table.has("feed_mm_s"):
        return default
    feed = _positive(table, "feed_mm_s")
    if feed > MAXIMUM_FEED:
        raise table.error("feed_mm_s", f"expected at most {MAXIMUM_FEED / MM:g} mm/s")
    return feed


def _positive(table: Table, key: str) -> float:
    value = table.number(key)
    if not value > 0.0:
        raise table.error(key, f"expected more than 0, found {value / MM:g}")
    return value


def _touches(table: Table, workpiece: Workpiece) -> str:
    if not table.has("touches"):
        return ""
    return table.choice("touches", workpiece.groups)


def _web_line(
    table: Table, owner: PathOwner, options: ImportOptions, orientation: _Orientation | None
) -> Toolpath:
    """Build a straight pass over the web, in shares of the section: it follows another beam.

    `from_along_mm` and `to_along_mm` run along the beam from its middle, `from_across` and
    `to_across` from the middle of the web (0) to the inside of a flange (+-1: H/2 - t2), on the
    web's `side` ('left': +y, 'right': -y), `lift_mm` above its face, in `points` equal steps.
    """
    line = table.table("web_line")
    section = owner.workpiece.section
    if section is None:
        raise line.error(None, "a line across the web needs an H section as workpiece")
    ends = [
        (line.number(f"{end}_along_mm"), line.number(f"{end}_across", low=-1.0, high=1.0))
        for end in ("from", "to")
    ]
    side = 1.0 if line.choice("side", ("left", "right"), "left") == "left" else -1.0
    lift = line.number("lift_mm", 0.0)
    count = line.integer("points", 2, MAXIMUM_POINTS)
    name = line.text("name", "web line")
    if orientation is None:
        raise table.error("orientation_wpr_deg", "the key is missing; a web_line needs it")
    start, end = (_on_web(section, along, across, side, lift) for along, across in ends)
    if not np.linalg.norm(end - start) > 0.0:
        raise line.error("to_along_mm", "the line ends where it starts; expected another point")
    rotation = owner.rotation_in(Frame.BEAM, orientation.frame or Frame.BEAM, orientation.rotation)
    share = np.arange(count)[:, None] / (count - 1)
    poses = np.array([rigid(rotation, point) for point in start + (end - start) * share])
    one = Pass(
        poses=poses,
        roles=(Role.CONTACT,) * count,
        feed=options.feed,
        lean=options.lean,
        lead=options.lead,
        touches=options.touches,
        name=name,
    )
    return Toolpath((one,), Frame.BEAM, source=name)


def _on_web(
    section: BeamSection, along: float, across: float, side: float, lift: float
) -> FloatArray:
    reach = section.height / 2.0 - section.flange
    return np.array([along, side * (section.web / 2.0 + lift), across * reach])
