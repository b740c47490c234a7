"""Forward kinematics against published figures and two independent computations."""

from __future__ import annotations

import math

import numpy as np
import pytest
from py_opw_kinematics import KinematicModel
from py_opw_kinematics import Robot as OpwRobot

from solver.errors import InputError
from solver.kinematics.arm import (
    forward,
    forward_frames,
    forward_links,
    link_offsets,
    model_from_pendant,
    pendant_from_model,
)
from solver.transforms import rotation_angle, rotation_from_wpr, wpr_from_rotation
from solver.units import DEG_PER_RAD, MM

# Pendant joints [deg], flange X Y Z [mm] and W P R [deg] in FANUC's world frame.
CHECK_VALUES = [
    ((0, 0, 0, 0, 0, 0), (1085, 0, 1040), (180, -90, 0)),
    ((0, 0, 0, 0, -90, 0), (985, 0, 940), (180, 0, 0)),
    ((30, 20, -10, 15, -60, 45), (1154.9123, 640.9070, 752.4997), (155.7498, -2.8516, 80.8485)),
    (
        (-45, 40, -30, 100, 50, -120),
        (1152.8598, -1046.1706, 360.5220),
        (-122.9172, -36.5431, -56.9336),
    ),
]


@pytest.mark.parametrize(("joints", "position", "wpr"), CHECK_VALUES)
def test_flange_pose_equals_the_published_check_values(m20ia, joints, position, wpr):
    pose = forward(m20ia, np.radians(joints))
    assert pose[:3, 3] / MM == pytest.approx(position, abs=5.1e-5)
    assert rotation_angle(pose[:3, :3].T @ rotation_from_wpr(*np.radians(wpr))) < 2e-6


@pytest.mark.parametrize(("joints", "position", "wpr"), CHECK_VALUES[2:])
def test_wpr_of_the_flange_equals_the_published_check_values(m20ia, joints, position, wpr):
    pose = forward(m20ia, np.radians(joints))
    shown = np.array(wpr_from_rotation(pose[:3, :3])) * DEG_PER_RAD
    assert shown == pytest.approx(wpr, abs=5.1e-5)


def test_at_zero_the_flange_looks_forward_with_x_up(m20ia):
    pose = forward(m20ia, np.zeros(6))
    np.testing.assert_allclose(pose[:3, 0], [0, 0, 1], atol=1e-15)
    np.testing.assert_allclose(pose[:3, 1], [0, -1, 0], atol=1e-15)
    np.testing.assert_allclose(pose[:3, 2], [1, 0, 0], atol=1e-15)


def modified_dh(alpha, length, angle, offset):
    """Craig's matrix Rx(alpha) Tx(length) Rz(angle) Tz(offset)."""
    ca, sa, c, s = math.cos(alpha), math.sin(alpha), math.cos(angle), math.sin(angle)
    turn_x = np.array([[1, 0, 0, 0], [0, ca, -sa, 0], [0, sa, ca, 0], [0, 0, 0, 1.0]])
    turn_z = np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])
    shift = np.eye(4)
    shift[0, 3] = length
    lift = np.eye(4)
    lift[2, 3] = offset
    return turn_x @ shift @ turn_z @ lift


@pytest.mark.parametrize("name", ["m20ia", "short_arm"])
def test_every_frame_equals_the_product_of_dh_matrices(name, request):
    robot = request.getfixturevalue(name)
    vectors = np.random.default_rng(1).uniform(-2 * math.pi, 2 * math.pi, (200, 6))
    frames = forward_frames(robot, pendant_from_model(robot, vectors))
    for angles, computed in zip(vectors, frames, strict=True):
        expected = np.eye(4)
        np.testing.assert_array_equal(computed[0], expected)
        for joint, (alpha, length, offset, zero) in enumerate(robot.dh):
            expected = expected @ modified_dh(alpha, length, angles[joint] + zero, offset)
            np.testing.assert_allclose(computed[joint + 1], expected, atol=4e-15)


def test_pendant_j2_alone_leaves_the_forearm_at_its_angle_above_the_horizontal(m20ia):
    forearms = forward_frames(m20ia, np.radians([[0, 0, 25, 0, 0, 0], [0, 50, 25, 0, 0, 0]]))[:, 4]
    for forearm in forearms:
        direction = [math.cos(math.radians(25)), 0, math.sin(math.radians(25))]
        np.testing.assert_allclose(forearm[:3, 2], direction, atol=1e-15)


def test_pendant_and_model_angles_convert_both_ways_without_losing_turns(m20ia):
    joints = np.random.default_rng(2).uniform(-7, 7, (50, 2, 6))
    angles = model_from_pendant(m20ia, joints)
    np.testing.assert_array_equal(angles[..., 2], -joints[..., 1] - joints[..., 2])
    np.testing.assert_allclose(pendant_from_model(m20ia, angles), joints, atol=1e-14)


def test_pendant_joints_act_as_six_turns_about_the_axes_of_the_maker(m20ia):
    """Product of turns about fixed axes at the zero pose, built without any D-H table."""

    def about(axis, angle, point):
        cross = np.cross(np.eye(3), axis)
        turn = np.eye(4)
        turn[:3, :3] += math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross
        turn[:3, 3] = point - turn[:3, :3] @ point
        return turn

    elbow, wrist = np.array([0.15, 0, 0.79]), np.array([0.985, 0, 1.04])
    zero = np.eye(4)
    zero[:3, :3] = np.column_stack([[0, 0, 1], [0, -1, 0], [1, 0, 0]])
    zero[:3, 3] = [1.085, 0, 1.04]
    x, y, z = np.eye(3)
    for j1, j2, j3, j4, j5, j6 in np.random.default_rng(3).uniform(-3, 3, (100, 6)):
        expected = (
            about(z, j1, np.zeros(3))
            @ about(y, j2, np.array([0.15, 0, 0]))
            @ about(y, -j2 - j3, elbow)
            @ about(x, -j4, wrist)
            @ about(y, -j5, wrist)
            @ about(x, -j6, wrist)
            @ zero
        )
        pose = forward(m20ia, [j1, j2, j3, j4, j5, j6])
        np.testing.assert_allclose(pose, expected, atol=4e-15)


def test_forward_equals_py_opw_kinematics(m20ia):
    model = KinematicModel(
        a1=0.15,
        a2=-0.25,
        b=0.0,
        c1=0.525,
        c2=0.79,
        c3=0.835,
        c4=0.10,
        offsets=(0, 0, -90, 0, 0, 180),
        flip_axes=(False, False, True, True, True, True),
    )
    joints = np.random.default_rng(4).uniform(-180, 180, (500, 6))
    elsewhere = joints.copy()
    elsewhere[:, 2] += joints[:, 1]
    expected = OpwRobot(model, degrees=True).batch_forward(elsewhere).as_matrix()
    expected[:, 2, 3] -= m20ia.world_height
    np.testing.assert_allclose(forward(m20ia, np.radians(joints)), expected, atol=1e-13)


def test_tcp_is_carried_by_the_flange(m20ia):
    flange_from_tcp = np.eye(4)
    flange_from_tcp[:3, :3] = np.diag([-1.0, -1.0, 1.0])
    flange_from_tcp[:3, 3] = [0.01, -0.02, 0.41]
    joints = np.random.default_rng(5).uniform(-3, 3, (4, 3, 6))
    poses = forward(m20ia, joints, flange_from_tcp)
    assert poses.shape == (4, 3, 4, 4)
    np.testing.assert_allclose(poses, forward(m20ia, joints) @ flange_from_tcp, atol=1e-14)


@pytest.mark.parametrize("name", ["m20ia", "short_arm"])
def test_link_frames_at_zero_are_parallel_to_fanuc_world_on_their_axes(name, request):
    robot = request.getfixturevalue(name)
    a1, a2, a3, d4 = robot.arm_lengths
    links = forward_links(robot, np.zeros(6))
    np.testing.assert_allclose(links[:, :3, :3], np.broadcast_to(np.eye(3), (7, 3, 3)), atol=1e-15)
    expected = [
        [0, 0, -robot.world_height],
        [0, 0, 0],
        [a1, 0, 0],
        [a1, 0, a2],
        [a1, 0, a2 + a3],
        [a1 + d4, 0, a2 + a3],
        [a1 + d4, 0, a2 + a3],
    ]
    np.testing.assert_allclose(links[:, :3, 3], expected, atol=1e-15)


def test_links_are_rigid_and_each_turns_about_its_own_axis_only(m20ia):
    """A joint moves its own link about a line through the link's origin, and no earlier link."""
    start = np.radians([20, -15, 30, 40, -50, 60])
    before = forward_links(m20ia, start)
    for joint in range(6):
        moved = start.copy()
        moved[joint] += 0.3
        if joint == 1:
            moved[2] -= 0.3  # the pendant's J3 is measured from the horizontal
        after = forward_links(m20ia, moved)
        np.testing.assert_allclose(after[: joint + 1], before[: joint + 1], atol=1e-15)
        np.testing.assert_allclose(after[joint + 1, :3, 3], before[joint + 1, :3, 3], atol=1e-15)
        change = after[joint + 1, :3, :3].T @ before[joint + 1, :3, :3]
        assert rotation_angle(change) == pytest.approx(0.3, abs=1e-12)


def test_link_offsets_are_constant_transforms_between_dh_and_link_frames(m20ia):
    joints = np.radians([10, 20, 30, 40, 50, 60])
    expected = forward_frames(m20ia, joints) @ link_offsets(m20ia)
    np.testing.assert_allclose(forward_links(m20ia, joints), expected, atol=1e-15)


def test_a_joint_vector_of_wrong_length_is_refused(m20ia):
    with pytest.raises(InputError, match="6 angles"):
        forward(m20ia, np.zeros(5))
