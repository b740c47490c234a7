"""The path of a cell: a file, a line on a face of the beam, or parallel passes along it.

The table `path` holds one of

- `file`: a path file, relative to the cell's file;
- `line`: one straight pass on a face; with `from_share` and `to_share` it follows the section, so
  that another beam has the same path in proportion;
- `parametric`: one or several passes along a face, at a distance from an edge.

Beside it stands what the path does not say itself: `orientation_wpr_deg` stated in
`orientation_frame`, `feed_mm_s`, `lean_deg`, `lead_deg`, `convention`; and beside a file alone its
`frame`, `unit`, `touches` and `resample_mm`. Lines and passes along a face need a beam.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import MappingProxyType
from typing import Final

import numpy as np

from solver.catalog.bodies import read_rotation
from solver.catalog.toml_reader import Table
from solver.io.importers import (
    FaceLine,
    ImportOptions,
    ParametricPath,
    Source,
    face_line_toolpath,
    import_source,
    parametric_toolpath,
    path_source,
)
from solver.io.importers.options import CONVENTIONS, LENGTH_UNITS, MAX_FEED, MAX_NOMINAL
from solver.io.importers.parametric import MAX_POINTS
from solver.model.robot import Robot
from solver.model.tool import Tool
from solver.model.toolpath import Frame, Toolpath
from solver.model.workpiece import Workpiece
from solver.transforms import FloatArray
from solver.units import DEG, MM

FRAMES: Final = tuple(frame.value for frame in Frame)
KINDS: Final = ("file", "line", "parametric")

FILE_KEYS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "frame": "its points lie in the frame of the beam",
        "unit": "its lengths are in mm",
        "touches": "it touches the group of its face",
        "resample_mm": "it has points of its own",
    }
)
"""Keys that only a file may have beside it, and why the other kinds need none."""


@dataclass(frozen=True, slots=True, eq=False)
class PathOwner:
    """What a path is planned on: the frames and the joints of its poses refer to these."""

    workpiece: Workpiece
    robot: Robot
    tool: Tool
    files: Mapping[str, bytes] = field(default_factory=dict)

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
    if not kinds:
        table.get("file", f"one of the keys {', '.join(KINDS)}")
    if len(kinds) > 1:
        raise table.error(kinds[1], f"expected no second path beside {kinds[0]!r}")
    if kinds[0] != "file":
        _check_face_path(table, kinds[0], owner.workpiece)
    orientation = _orientation(table)
    with table.located():
        options = _options(table, owner)
    frame = _frame(table, "frame")
    spec = _path_spec(table, kinds[0], options, orientation)
    table.finish()
    if override is not None:
        return _load(override, options, orientation, owner)
    if isinstance(spec, Path):
        return _load(spec, replace(options, frame=frame), orientation, owner, table.folder)
    with table.located(kinds[0]):
        if isinstance(spec, FaceLine):
            return face_line_toolpath(owner.workpiece, spec)
        return parametric_toolpath(owner.workpiece, spec)


def _check_face_path(table: Table, kind: str, workpiece: Workpiece) -> None:
    """Refuse a path on a face where there is no face, or with keys that would change nothing."""
    if workpiece.section is None:
        raise table.error(
            kind,
            f"workpiece {workpiece.name} is a mesh, which has no faces of a beam; state a file",
        )
    for key, reason in FILE_KEYS.items():
        if table.has(key):
            raise table.error(
                key,
                f"the key belongs to a file, not to a path by {kind!r}: {reason}; leave it out",
            )


def _load(
    path: Path,
    options: ImportOptions,
    orientation: _Orientation | None,
    owner: PathOwner,
    folder: Path | None = None,
) -> Toolpath:
    source = _source(path, owner, folder)
    if orientation is None:
        return import_source(source, options)
    toolpath = import_source(source, replace(options, orientation=orientation.rotation))
    stated = orientation.frame or toolpath.frame
    turned = owner.rotation_in(toolpath.frame, stated, orientation.rotation)
    if np.array_equal(turned, orientation.rotation):
        return toolpath
    # Only now is the file's frame known, in which the importer takes the orientation.
    return import_source(source, replace(options, orientation=turned))


def _source(path: Path, owner: PathOwner, folder: Path | None) -> Source:
    """The bytes of a path file: those in memory under its name in the cell, or the file's."""
    if folder is not None and path.is_relative_to(folder):
        name = path.relative_to(folder).as_posix()
        if name in owner.files:
            return Source(name, owner.files[name])
    return path_source(path)


def _frame(table: Table, key: str) -> Frame | None:
    return Frame(table.choice(key, FRAMES)) if table.has(key) else None


def _orientation(table: Table) -> _Orientation | None:
    frame = _frame(table, "orientation_frame")
    if not table.has("orientation_wpr_deg"):
        if frame is not None:
            raise table.error("orientation_frame", "expected orientation_wpr_deg, which it is for")
        return None
    return _Orientation(read_rotation(table, "orientation_wpr_deg"), frame)


def _options(table: Table, owner: PathOwner) -> ImportOptions:
    default = ImportOptions()
    limit = MAX_NOMINAL / DEG
    return ImportOptions(
        unit=table.choice("unit", tuple(LENGTH_UNITS)) if table.has("unit") else None,
        convention=table.choice("convention", CONVENTIONS, default.convention),
        feed=_feed(table, default.feed),
        touches=table.choice("touches", owner.workpiece.groups) if table.has("touches") else "",
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
    if feed > MAX_FEED:
        raise table.error("feed_mm_s", f"expected at most {MAX_FEED / MM:g} mm/s")
    return feed


def _positive(table: Table, key: str) -> float:
    value = table.number(key)
    if not value > 0.0:
        raise table.error(key, f"expected more than 0, found {value / MM:g}")
    return value


def _path_spec(
    table: Table, kind: str, options: ImportOptions, orientation: _Orientation | None
) -> Path | FaceLine | ParametricPath:
    if kind == "file":
        return table.folder / table.text("file")
    own = table.table(kind)
    with own.located():
        if kind == "line":
            return _line(own, options, orientation)
        if orientation is not None:
            raise table.error(
                "orientation_wpr_deg",
                "passes along a beam take their orientation from face and travel; leave it out",
            )
        return _parametric(own, options)


def _line(table: Table, options: ImportOptions, orientation: _Orientation | None) -> FaceLine:
    """Read a line: `from_share`, `to_share` of the face, or `from_offset_mm`, `to_offset_mm`."""
    relative = table.has("from_share") or table.has("to_share")
    across = ("from_share", "to_share") if relative else ("from_offset_mm", "to_offset_mm")
    frame = Frame.BEAM
    if orientation is not None and orientation.frame not in (None, Frame.BEAM):
        frame = Frame.FLOOR  # parallel to fanuc_world
    return FaceLine(
        face=table.text("face"),
        start=(table.number("from_along_mm"), table.number(across[0])),
        end=(table.number("to_along_mm"), table.number(across[1])),
        points=table.integer("points", 2, MAX_POINTS),
        relative=relative,
        edge="" if relative else table.text("edge", ""),
        lift=table.number("lift_mm", 0.0, low=0.0),
        orientation=None if orientation is None else orientation.rotation,
        orientation_frame=frame,
        lean=options.lean,
        lead=options.lead,
        feed=options.feed,
        convention=options.convention,
        name=table.text("name", "line"),
    )


def _parametric(table: Table, options: ImportOptions) -> ParametricPath:
    return ParametricPath(
        face=table.text("face"),
        start=table.number("from_along_mm"),
        end=table.number("to_along_mm"),
        offset=table.number("offset_mm"),
        edge=table.text("edge", ""),
        points=table.integer("points", 2, MAX_POINTS) if table.has("points") else None,
        step=_positive(table, "step_mm") if table.has("step_mm") else None,
        passes=table.integer("passes", 1, MAX_POINTS, 1),
        spacing=table.number("spacing_mm", 0.0),
        zigzag=table.boolean("zigzag", True),
        turn_with_travel=table.boolean("turn_with_travel", True),
        lift=table.number("lift_mm", 0.0, low=0.0),
        lean=options.lean,
        lead=options.lead,
        feed=options.feed,
        convention=options.convention,
        name=table.text("name", "pass"),
    )
