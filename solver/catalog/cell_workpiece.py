"""The workpiece of a cell: an H-beam in the table `beam`, or a mesh in the table `workpiece`.

Both are placed by W, P, R and a position in `floor` or `fanuc_world`; a beam may state the height
of its lowest edge instead of that of its centre.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np

from solver.catalog.beams import load_beam, read_dimensions
from solver.catalog.bodies import read_mesh_body, read_rotation
from solver.catalog.toml_reader import Table
from solver.model.beam import beam_workpiece
from solver.model.robot import FLOOR_GROUP, Robot
from solver.model.toolpath import Frame
from solver.model.workpiece import BeamSection, Workpiece
from solver.transforms import FloatArray, rigid

DIMENSIONS: Final = ("height_mm", "width_mm", "web_mm", "flange_mm")
PLACEMENT_FRAMES: Final = (Frame.FLOOR.value, Frame.FANUC_WORLD.value)


def read_workpiece(
    document: Table,
    beam: str | Path | BeamSection | None,
    robot: Robot,
    files: Mapping[str, bytes] | None = None,
) -> Workpiece:
    """Read the workpiece of a cell; `beam` is another section in place of that of the cell.

    `files` holds mesh and TOML files in memory by the names that the cell gives them.

    Raises
    ------
    InputError
        If the cell has no workpiece or two, a key of it is unusable, or a mesh is to become
        another beam.
    """
    if not document.has("workpiece"):
        document.get("beam", "a table [beam] or a table [workpiece]")
        return _beam(document.table("beam"), beam, robot, files)
    if document.has("beam"):
        raise document.error("workpiece", "expected no second workpiece beside 'beam'")
    table = document.table("workpiece")
    if beam is not None:
        raise table.error(
            None, "the workpiece is a mesh, which no beam can replace; leave the other beam out"
        )
    return _mesh_workpiece(table, robot, files)


def _mesh_workpiece(table: Table, robot: Robot, files: Mapping[str, bytes] | None) -> Workpiece:
    """Read one watertight mesh as a workpiece; the axes of the file are its frame."""
    rotation = read_rotation(table)
    position = np.array(table.numbers("position_mm", 3)) + _frame_origin(table, robot)
    body = read_mesh_body(table, np.eye(4), files)
    for key, value in (("name", body.name), ("group", body.group)):
        if value == FLOOR_GROUP:
            raise table.error(key, "the name 'floor' is kept for the floor of the cell")
    return Workpiece(body.name, (body,), rigid(rotation, position))


def _beam(
    table: Table,
    beam: str | Path | BeamSection | None,
    robot: Robot,
    files: Mapping[str, bytes] | None,
) -> Workpiece:
    own = _section(table, files)
    section = own
    if isinstance(beam, BeamSection):
        section = beam
    elif beam is not None:
        section = load_beam(beam)
    length = table.number("length_mm")
    fillets = table.boolean("fillets", True)
    rotation = read_rotation(table)
    position = _position(table, section, length, rotation) + _frame_origin(table, robot)
    table.finish()
    with table.located():
        return beam_workpiece(section, length, rigid(rotation, position), fillets)


def _frame_origin(table: Table, robot: Robot) -> FloatArray:
    """(3,) origin of the frame of the placement in the floor frame [m]; the axes are parallel."""
    frame = table.choice("frame", PLACEMENT_FRAMES, Frame.FLOOR.value)
    return np.array([0.0, 0.0, robot.world_height if frame == Frame.FANUC_WORLD.value else 0.0])


def _section(table: Table, files: Mapping[str, bytes] | None) -> BeamSection:
    """Find the section by name, or by its dimensions; a root radius may replace that of a name."""
    if any(table.has(key) for key in DIMENSIONS):
        name = table.name("section") if table.has("section") else "custom"
        return read_dimensions(table, name, "stated by the cell")
    name = table.text("section")
    with table.located("section"):
        section = load_beam(name, relative_to=table.folder, files=files)
    if not table.has("root_mm"):
        return section
    with table.located("root_mm"):
        return BeamSection(
            section.name,
            section.height,
            section.width,
            section.web,
            section.flange,
            table.number("root_mm", low=0.0),
            f"{section.source}, root radius stated by the cell",
        )


def _position(
    table: Table, section: BeamSection, length: float, rotation: FloatArray
) -> FloatArray:
    """Find the beam's centre: stated, or over a point of the plan with its lowest edge at a height.

    The second rule keeps the beam on its supports when another section takes its place.
    """
    if table.has("lower_edge_mm") or table.has("position_xy_mm"):
        x, y = table.numbers("position_xy_mm", 2)
        half = np.array([length, section.width, section.height]) / 2.0
        reach = float(np.abs(rotation[2]) @ half)
        return np.array([x, y, table.number("lower_edge_mm") + reach])
    return np.array(table.numbers("position_mm", 3))
