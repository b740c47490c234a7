"""Jacobian and manipulability against differences and linear algebra."""

from __future__ import annotations

import math

import numpy as np
import pytest

from solver.kinematics.arm import forward
from solver.kinematics.jacobian import jacobian, manipulability, posture_manipulability

TOOL = np.array([[-1.0, 0, 0, 0.02], [0, -1.0, 0, -0.03], [0, 0, 1.0, 0.41], [0, 0, 0, 1.0]])


def central_differences(robot, joints, tool, step=1e-6):
    """Column by column (p+ - p-) / 2h, and the angular velocity from (R+ - R-) R^T / 2h."""
    columns = []
    rotation = forward(robot, joints, tool)[:3, :3]
    for joint in range(6):
        change = np.zeros(6)
        change[joint] = step
        ahead, behind = (forward(robot, joints + sign * change, tool) for sign in (1, -1))
        rate = (ahead - behind) / (2 * step)
        spin = rate[:3, :3] @ rotation.T
        columns.append([*rate[:3, 3], spin[2, 1], spin[0, 2], spin[1, 0]])
    return np.array(columns).T


@pytest.mark.parametrize("name", ["m20ia", "short_arm"])
@pytest.mark.parametrize("tool", [None, TOOL])
def test_jacobian_equals_central_differences(name, tool, request):
    robot = request.getfixturevalue(name)
    for joints in np.random.default_rng(11).uniform(-3, 3, (40, 6)):
        expected = central_differences(robot, joints, tool)
        np.testing.assert_allclose(jacobian(robot, joints, tool), expected, atol=2e-9)


def test_many_jacobians_at_once_equal_one_at_a_time(m20ia):
    joints = np.random.default_rng(12).uniform(-3, 3, (3, 5, 6))
    many = jacobian(m20ia, joints)
    assert many.shape == (3, 5, 6, 6)
    np.testing.assert_array_equal(many[2, 4], jacobian(m20ia, joints[2, 4]))


@pytest.mark.parametrize("name", ["m20ia", "short_arm"])
def test_closed_form_of_manipulability_equals_its_definition(name, request):
    robot = request.getfixturevalue(name)
    joints = np.random.default_rng(13).uniform(-math.pi, math.pi, (500, 6))
    matrices = jacobian(robot, joints, TOOL)
    squares = np.linalg.det(matrices @ np.swapaxes(matrices, -1, -2))
    definition = np.sqrt(np.maximum(squares, 0.0))
    closed = posture_manipulability(robot, joints)
    # det(J J^T) squares the measure, so its rounding is felt as the root of 1e-16.
    np.testing.assert_allclose(closed, definition, atol=5e-8)
    np.testing.assert_allclose(closed, manipulability(matrices), atol=1e-14)


def test_manipulability_ignores_joints_1_4_and_6_and_the_tool(m20ia):
    joints = np.radians([10, 20, 30, 40, 50, 60])
    others = np.radians([-80, 20, 30, -170, 50, 200])
    here, there = posture_manipulability(m20ia, np.array([joints, others]))
    assert here == pytest.approx(there, rel=1e-14)
    with_tool, without = (manipulability(jacobian(m20ia, joints, tool)) for tool in (TOOL, None))
    assert with_tool == pytest.approx(without, rel=1e-12)


@pytest.mark.parametrize(
    ("what", "joints"),
    [
        ("wrist in line", [10, 20, 30, 40, 0, 60]),
        ("arm stretched", [10, 20, math.degrees(math.atan2(0.835, 0.25)) - 20, 40, 50, 60]),
    ],
)
def test_manipulability_vanishes_at_singularities(m20ia, what, joints):
    assert posture_manipulability(m20ia, np.radians(joints)) < 1e-16
