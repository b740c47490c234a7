"""Cells as TOML: robot, tool, workpiece, fixtures, path and settings of one planning problem."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np

from solver.catalog.bodies import read_body, read_mesh_body, read_rotation
from solver.catalog.cell_path import PathOwner, read_path
from solver.catalog.cell_program import read_accuracy, read_program
from solver.catalog.cell_settings import read_settings
from solver.catalog.cell_workpiece import read_workpiece
from solver.catalog.names import file_of
from solver.catalog.robots import load_robot, read_sources
from solver.catalog.toml_reader import Table, read_toml
from solver.catalog.tools import load_tool
from solver.model.beam import STEEL_TOLERANCE, check_path_outside_steel
from solver.model.problem import PlanningProblem
from solver.model.robot import FLOOR_GROUP, JOINTS, Robot
from solver.model.shapes import Body, Box
from solver.model.tool import Tool
from solver.model.workpiece import BeamSection
from solver.transforms import FloatArray, rigid
from solver.units import DEG_PER_RAD

FLOOR_SIZE: Final = (10.0, 10.0, 1.0)
"""The floor as a box below z = 0, centred on the robot [m]."""


def load_cell(
    name_or_path: str | Path,
    *,
    beam: str | Path | BeamSection | None = None,
    path: str | Path | None = None,
) -> PlanningProblem:
    """Load a shipped cell by name, or one of a TOML file.

    Parameters
    ----------
    name_or_path : str or Path
        A shipped name, or a file (it ends in .toml or holds a separator).
    beam : str, Path or BeamSection, optional
        Another section in place of the cell's; the rule of its placement is kept. A cell whose
        workpiece is a mesh refuses it.
    path : str or Path, optional
        Another path file, relative to the working directory, read with the cell's options; it
        states its frame itself.

    Raises
    ------
    UnknownNameError
        If no shipped cell, robot, tool or section has the stated name.
    InputError
        If a file is unusable, contradicts itself, or the path enters the beam's steel.

    Examples
    --------
    >>> from solver.catalog import load_cell
    >>> load_cell("groove_paper").workpiece.name
    'HW300'
    """
    document = read_toml(file_of("cells", name_or_path))
    return read_cell(document, beam=beam, path=path)


def read_cell(
    document: Table,
    *,
    beam: str | Path | BeamSection | None = None,
    path: str | Path | None = None,
    files: Mapping[str, bytes] | None = None,
) -> PlanningProblem:
    """Read a cell from a whole document; see `load_cell`.

    `files` holds files in memory by the names under which the cell refers to them: its path,
    meshes, and TOML files of robot, tool and section are read from there before the disk.

    Raises
    ------
    InputError
        As `load_cell`.
    """
    head = document.table("cell")
    name, title = head.name("name"), head.text("title")
    robot_table = document.table("robot")
    with robot_table.located("model"):
        robot = load_robot(robot_table.text("model"), relative_to=document.folder, files=files)
    tool_table = document.table("tool")
    with tool_table.located("model"):
        tool = load_tool(tool_table.text("model"), relative_to=document.folder, files=files)
    workpiece = read_workpiece(document, beam, robot, files)
    fixtures = _fixtures(document, head, files)
    owner = PathOwner(workpiece, robot, tool, files or {})
    toolpath = read_path(document.table("path"), owner, None if path is None else Path(path))
    bodies = _body_set(robot_table, robot)
    windows = _joint_windows(robot_table.optional_table("windows_deg"), robot)
    settings = read_settings(document.table("settings"))
    program = read_program(document.optional_table("program"))
    accuracy = read_accuracy(document.optional_table("accuracy"))
    assumptions = document.texts("assumptions", default=())
    read_sources(document)
    document.finish()
    with document.located():
        problem = PlanningProblem(
            name=name,
            robot=robot,
            bodies=bodies,
            tool=tool,
            workpiece=workpiece,
            fixtures=fixtures,
            toolpath=toolpath,
            settings=settings,
            program=program,
            joint_windows=windows,
            accuracy=accuracy,
            title=title,
            assumptions=assumptions,
        )
        check_path_outside_steel(problem, _path_allowance(tool))
    return problem


def _path_allowance(tool: Tool) -> float:
    """How deep a path point may lie in the steel: as deep as the tool may enter it [m]."""
    depths = [one.depth for one in tool.bodies if one.role.value == "contact"]
    return max([STEEL_TOLERANCE, *depths])


def _body_set(table: Table, robot: Robot) -> str:
    return table.choice("bodies", tuple(robot.body_sets))


def _joint_windows(table: Table | None, robot: Robot) -> FloatArray | None:
    """Narrow the windows of single joints; a window outside the limits is an error."""
    if table is None:
        return None
    windows = np.array(robot.limits)
    for joint in range(JOINTS):
        key = f"J{joint + 1}"
        if not table.has(key):
            continue
        low, high = _window(table, key)
        if not low < high:
            raise table.error(key, "expected the lower angle before the higher one")
        if low >= windows[joint, 1] or high <= windows[joint, 0]:
            limits = " to ".join(f"{limit * DEG_PER_RAD:g}" for limit in windows[joint])
            raise table.error(key, f"the window lies outside the robot's limits, {limits} deg")
        windows[joint] = (low, high)
    return windows


def _window(table: Table, key: str) -> tuple[float, float]:
    # The unit stands in the name of the table, so the joint's key is given it here.
    value = table.get(key, "a list of 2 numbers in deg")
    unit = Table({f"{key}_deg": value}, table.file, table.key)
    low, high = unit.numbers(f"{key}_deg", 2)
    return low, high


def _fixtures(document: Table, head: Table, files: Mapping[str, bytes] | None) -> tuple[Body, ...]:
    """Bodies in the floor frame; the floor itself is one of them where the cell says so."""
    bodies = [_fixture(one, files) for one in document.tables("fixtures", ())]
    for index, body in enumerate(bodies):
        if FLOOR_GROUP in (body.name, body.group):
            raise document.error(
                f"fixtures[{index}].name", "the name 'floor' is kept for the floor of the cell"
            )
    if head.boolean("floor", False):
        centre = (0.0, 0.0, -FLOOR_SIZE[2] / 2.0)
        bodies.append(Body("floor", Box(np.array(FLOOR_SIZE)), rigid(position=centre), FLOOR_GROUP))
    names = [one.name for one in bodies]
    for index, one in enumerate(names):
        if one in names[:index]:
            raise document.error(f"fixtures[{index}].name", f"two fixtures are called {one!r}")
    return tuple(bodies)


def _fixture(table: Table, files: Mapping[str, bytes] | None) -> Body:
    if not table.has("mesh"):
        return read_body(table)
    position = table.numbers("position_mm", 3, (0.0, 0.0, 0.0))
    return read_mesh_body(table, rigid(read_rotation(table), position), files)
