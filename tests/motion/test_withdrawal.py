from dataclasses import replace

import link_cells as cells
import numpy as np
import pytest

import solver
from solver.errors import RefusedError
from solver.model.program_settings import Withdrawal
from solver.model.shapes import Body, Mesh
from solver.motion.withdrawal import withdrawal_direction
from solver.transforms import rigid
from solver.units import MM


@pytest.fixture(scope="module")
def cell():
    return cells.two_passes(solver.load_cell("groove_hw300"), 12, 38)


def touching(problem, group):
    one = replace(problem.toolpath.passes[0], touches=group)
    return replace(problem, toolpath=problem.toolpath.with_passes((one,)))


@pytest.mark.parametrize(
    ("group", "point", "normal"),
    [
        # Beam frame of an HW300: flanges 15 thick, 300 wide, web 10, root radius 20.
        ("web", (0.1, 13.0, 30.0), (0, 1, 0)),
        ("web", (0.1, 4.7, -100.0), (0, 1, 0)),
        ("flange_top", (-0.2, 60.0, 127.0), (0, 0, -1)),
        ("flange_top", (-0.2, 60.0, 135.2), (0, 0, -1)),
        ("flange_bottom", (-0.2, 60.0, -127.0), (0, 0, 1)),
    ],
)
def test_the_normal_is_that_of_the_nearest_face(cell, group, point, normal):
    problem = touching(cell, group)
    position = np.array(point) * [1.0, MM, MM]
    tool = -np.add(normal, (0.1, 0.3, 0.2))
    found = direction(problem, position, tool / np.linalg.norm(tool))
    assert np.abs(found - normal).max() < 1e-12


def direction(problem, position, tool):
    """Withdrawal along the normal at a point of the beam, the tool pointing along `tool`."""
    side = np.cross(tool, [0.36, 0.48, 0.8])
    side /= np.linalg.norm(side)
    rotation = np.column_stack([side, np.cross(tool, side), tool])
    world_from_beam = problem.fanuc_world_from_floor @ problem.workpiece.placement
    pose = world_from_beam @ rigid(rotation, position)
    found = withdrawal_direction(problem, problem.toolpath.passes[0], Withdrawal.NORMAL, pose)
    return world_from_beam[:3, :3].T @ found


def test_the_normal_of_a_fillet_points_to_the_middle_of_its_arc(cell):
    problem = touching(cell, "fillet_top_left")
    middle = np.array([5.0 + 20.0, 135.0 - 20.0]) * MM
    for angle in np.radians(np.linspace(96.0, 174.0, 14)):
        inward = np.array([np.cos(angle), np.sin(angle)])
        point = np.append(0.1, middle + 12.0 * MM * inward)
        tool = np.append(0.0, inward)
        found = direction(problem, point, tool)
        # Chords of the arc differ from it by half of the angle of a slice.
        assert found @ -tool >= np.cos(np.radians(12.0))
        assert abs(found[0]) < 1e-9


def test_a_mesh_or_no_body_to_touch_asks_for_withdrawal_along_the_tool(cell):
    corners = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], float)
    faces = np.array([(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])
    plate = Body("plate", Mesh(corners, faces), np.eye(4))
    piece = replace(cell.workpiece, bodies=(plate,))
    passes = tuple(replace(one, touches="plate") for one in cell.toolpath.passes)
    meshed = replace(cell, workpiece=piece, toolpath=cell.toolpath.with_passes(passes))
    for problem in (touching(cell, ""), meshed):
        with pytest.raises(RefusedError, match='withdrawal = "tool"'):
            direction(problem, np.array([0.1, 0.02, 0.03]), np.array([0.0, -1.0, 0.0]))
