"""What docs/units_and_frames.md says about the M-20iA holds for the shipped robot and cells."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from solver.candidates.generate import tool_rotation
from solver.catalog import load_cell, load_robot
from solver.kinematics.arm import forward, model_from_pendant
from solver.kinematics.configuration import configuration
from solver.transforms import rotation_from_wpr, rotation_y

PAGE = (Path(__file__).resolve().parents[1] / "docs" / "units_and_frames.md").read_text("utf-8")


def rows(heading: str) -> list[list[str]]:
    """Cells of the table under the row that begins with `heading`."""
    (table,) = re.findall(
        rf"^\| {re.escape(heading)}.*\n\|[-|]+\n((?:\|.*\n)+)", PAGE, re.MULTILINE
    )
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in table.splitlines()]


def numbers(cell: str) -> list[float]:
    return [float(part) for part in cell.split(",")]


@pytest.fixture(scope="module")
def robot():
    return load_robot("fanuc_m20ia")


@pytest.mark.parametrize("row", rows("J1..J6 deg"), ids=lambda row: row[0])
def test_documented_flange_poses_are_those_of_the_robot(robot, row):
    joints, position, angles = (numbers(cell) for cell in row)
    pose = forward(robot, np.radians(joints))
    np.testing.assert_allclose(pose[:3, 3], np.array(position) / 1000.0, atol=1e-7)
    np.testing.assert_allclose(
        pose[:3, :3], rotation_from_wpr(*np.radians(angles)), atol=2e-6, rtol=0.0
    )


def test_documented_chain_is_the_one_of_the_robot(robot):
    for row, (alpha, a, d, offset) in zip(rows("i |"), robot.dh, strict=True):
        stated = [float(cell) for cell in row[1:]]
        given = [np.degrees(alpha), a * 1000.0, d * 1000.0, np.degrees(offset)]
        np.testing.assert_allclose(given, stated, atol=1e-9)


def test_documented_coupling_is_the_one_of_the_robot(robot):
    joints = np.array([0.1, 0.2, 0.4, 0.8, 1.6, 3.2])
    j1, j2, j3, j4, j5, j6 = joints
    expected = [j1, j2, -(j2 + j3), -j4, -j5, -j6]
    np.testing.assert_allclose(model_from_pendant(robot, joints), expected, atol=1e-15)


def test_fanuc_world_is_525_mm_above_the_floor(robot):
    assert robot.world_height == pytest.approx(0.525)
    point = load_cell("groove_paper").fanuc_world_from_floor @ [0.0, 0.0, 0.6, 1.0]
    np.testing.assert_allclose(point, [0.0, 0.0, 0.075, 1.0], atol=1e-12)


@pytest.mark.parametrize(("cell", "tilt"), [("groove_paper", 135.0), ("groove_hw300", 150.0)])
def test_shipped_cells_have_the_documented_reference_orientation(cell, tilt):
    for pose in load_cell(cell).waypoint_poses:
        np.testing.assert_allclose(pose[:3, :3], rotation_y(np.radians(tilt)), atol=1e-6)


def test_the_zigzag_cell_has_the_documented_reference_orientations():
    poses = iter(load_cell("zigzag_hw250").waypoint_poses)
    for one, tilt in zip(load_cell("zigzag_hw250").toolpath.passes, (150, 180, 210), strict=True):
        for _ in range(len(one)):
            expected = rotation_y(np.radians(tilt))
            np.testing.assert_allclose(next(poses)[:3, :3], expected, atol=1e-6)


def test_the_user_frame_is_the_world_or_the_workpiece_as_documented():
    cell = load_cell("zigzag_hw250")
    assert cell.user_frame.number == 1
    np.testing.assert_array_equal(
        cell.user_frame.pose, cell.fanuc_world_from_floor @ cell.workpiece.placement
    )
    plain = replace(cell, program=replace(cell.program, uframe=0))
    np.testing.assert_array_equal(plain.user_frame.pose, np.eye(4))


def test_positive_lean_lead_and_spin_turn_as_documented():
    # Columns of reference_from_tool; the tool's body lies along -z.
    lean, lead, spin = (tool_rotation(*np.eye(3)[axis] * 0.3) for axis in range(3))
    assert -lean[0, 2] < -0.2  # towards -x
    assert -lead[1, 2] > 0.2  # towards +y, the travel
    assert spin[1, 0] > 0.2  # x towards y
    combined = tool_rotation(0.3, 0.2, 0.1)
    steps = tool_rotation(0.3, 0, 0) @ tool_rotation(0, 0.2, 0) @ tool_rotation(0, 0, 0.1)
    np.testing.assert_allclose(combined, steps, atol=1e-15)


@pytest.mark.parametrize(
    ("j2_plus_j3", "letter"), [(-106.6, "U"), (-106.7, "D"), (73.3, "U"), (73.4, "D")]
)
def test_elbow_letter_changes_where_documented(robot, j2_plus_j3, letter):
    joints = np.radians([0.0, 0.0, j2_plus_j3, 0.0, -30.0, 0.0])
    assert f" {letter} " in str(configuration(robot, joints))


@pytest.mark.parametrize(("angle", "turns"), [(179.9, 0), (180.0, 1), (-180.0, -1), (-179.9, 0)])
def test_turns_are_counted_as_documented(robot, angle, turns):
    joints = np.radians([0.0, 0.0, 0.0, angle, -30.0, 0.0])
    assert str(configuration(robot, joints)).split(", ")[2] == str(turns)
