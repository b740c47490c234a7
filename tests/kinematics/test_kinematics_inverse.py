"""Inverse kinematics: forward again, completeness, singularities and an independent solver."""

from __future__ import annotations

import math

import numpy as np
import pytest
from py_opw_kinematics import KinematicModel
from py_opw_kinematics import Robot as OpwRobot
from scipy.spatial.transform import RigidTransform

from solver.errors import InputError
from solver.kinematics.arm import (
    all_branches,
    forward,
    forward_frames,
    inverse,
    pendant_from_model,
    representatives,
)
from solver.kinematics.configuration import branch_of
from solver.kinematics.jacobian import posture_manipulability
from solver.model.settings import Turns

TOLERANCE = 1e-9
"""Largest residual of a pose [m] and [rad], and of a recovered joint [rad]."""


def joints_within_limits(robot, count, seed):
    """Random pendant joints inside the limits and the elbow's bounds."""
    generator = np.random.default_rng(seed)
    kept = np.empty((0, 6))
    while len(kept) < count:
        drawn = generator.uniform(robot.limits[:, 0], robot.limits[:, 1], (2 * count, 6))
        bend = drawn[:, 1] + drawn[:, 2]
        inside = (bend >= robot.elbow_limits[0]) & (bend <= robot.elbow_limits[1])
        kept = np.concatenate([kept, drawn[inside]])
    return kept[:count]


def pose_residuals(robot, branches, poses):
    """Position [m] and rotation [rad] residuals of every branch, 0 where it was not found."""
    joints = np.where(branches.found[..., np.newaxis], branches.joints, 0.0)
    difference = forward(robot, joints) - poses[..., np.newaxis, :, :]
    position = np.linalg.norm(difference[..., :3, 3], axis=-1)
    # The Frobenius norm of a difference of rotations is 2 sqrt(2) sin(angle / 2).
    chord = np.linalg.norm(difference[..., :3, :3], axis=(-2, -1))
    rotation = 2.0 * np.arcsin(np.minimum(chord / math.sqrt(8.0), 1.0))
    return np.where(branches.found, position, 0.0), np.where(branches.found, rotation, 0.0)


def distance_to_original(branches, joints):
    """Largest joint difference, whole turns aside, of the closest branch [rad]."""
    difference = branches.joints - joints[..., np.newaxis, :]
    difference -= 2 * math.pi * np.round(difference / (2 * math.pi))
    worst = np.where(branches.found, np.abs(difference).max(axis=-1), np.inf)
    return worst.min(axis=-1)


def reachable_sides(robot, poses):
    """Whether front and back reach the wrist centre, by the triangle inequality alone."""
    a1, a2, a3, d4 = robot.arm_lengths
    centres = (poses @ np.linalg.inv(robot.flange))[..., :3, 3]
    radius = np.hypot(centres[..., 0], centres[..., 1])
    sides = []
    for signed in (radius, -radius):
        span = np.hypot(signed - a1, centres[..., 2])
        outer, inner = a2 + math.hypot(a3, d4), abs(a2 - math.hypot(a3, d4))
        sides.append((span <= outer + 1e-12) & (span >= inner - 1e-12))
    return np.stack(sides, axis=-1)


def check_round_trip(robot, count, seed):
    """Check `count` random vectors; return the worst position, rotation and joint residual."""
    joints = joints_within_limits(robot, count, seed)
    poses = forward(robot, joints)
    branches = all_branches(robot, poses)
    position, rotation = pose_residuals(robot, branches, poses)
    original = distance_to_original(branches, joints)
    assert position.max() < TOLERANCE
    assert rotation.max() < TOLERANCE
    assert original.max() < TOLERANCE
    np.testing.assert_array_equal(
        branches.found, np.repeat(reachable_sides(robot, poses), 4, axis=-1)
    )
    assert np.all(np.isfinite(branches.joints[branches.found]))
    return position.max(), rotation.max(), original.max()


@pytest.mark.parametrize("name", ["m20ia", "short_arm"])
def test_random_joints_are_recovered_and_every_branch_reaches_the_pose(name, request):
    check_round_trip(request.getfixturevalue(name), 10_000, seed=31)


@pytest.mark.long
@pytest.mark.parametrize("name", ["m20ia", "short_arm"])
def test_a_hundred_thousand_random_joints_are_recovered(name, request):
    worst = check_round_trip(request.getfixturevalue(name), 100_000, seed=32)
    print("worst residuals: {:.2e} m, {:.2e} rad, joints {:.2e} rad".format(*worst))


@pytest.mark.parametrize("name", ["m20ia", "short_arm"])
def test_solutions_hold_the_original_with_its_turns_and_nothing_outside_the_limits(name, request):
    robot = request.getfixturevalue(name)
    low, high = robot.limits.T
    tool = np.diag([-1.0, -1.0, 1.0, 1.0])
    tool[:3, 3] = [0.03, -0.02, 0.41]
    for joints in joints_within_limits(robot, 300, seed=33):
        pose = forward(robot, joints, tool)
        solutions = inverse(robot, pose, tool)
        assert np.abs(solutions.joints - joints).max(axis=1).min() < TOLERANCE
        assert np.all(solutions.joints >= low - TOLERANCE)
        assert np.all(solutions.joints <= high + TOLERANCE)
        bend = solutions.joints[:, 1] + solutions.joints[:, 2]
        assert np.all(bend >= robot.elbow_limits[0] - TOLERANCE)
        assert np.all(bend <= robot.elbow_limits[1] + TOLERANCE)
        np.testing.assert_allclose(
            forward(robot, solutions.joints, tool),
            np.broadcast_to(pose, (len(solutions), 4, 4)),
            atol=TOLERANCE,
        )


def test_solutions_stand_in_their_stated_order(m20ia):
    for joints in joints_within_limits(m20ia, 200, seed=34):
        solutions = inverse(m20ia, forward(m20ia, joints))
        keys = [(int(b), *row) for b, row in zip(solutions.branch, solutions.joints, strict=True)]
        assert keys == sorted(keys)
        assert all(
            branch_of(m20ia, row) == key[0] for row, key in zip(solutions.joints, keys, strict=True)
        )


def test_principal_solutions_are_those_without_turns(m20ia):
    for joints in joints_within_limits(m20ia, 100, seed=35):
        pose = forward(m20ia, joints)
        every, few = inverse(m20ia, pose), inverse(m20ia, pose, turns=Turns.PRINCIPAL)
        inside = np.all((every.joints > -math.pi) & (every.joints <= math.pi), axis=1)
        np.testing.assert_array_equal(few.joints, every.joints[inside])
        np.testing.assert_array_equal(few.branch, every.branch[inside])


def test_narrower_limits_leave_fewer_solutions_and_wider_ones_more(m20ia):
    pose = forward(m20ia, np.radians([10, 20, 30, 170, -50, 200]))
    window = m20ia.limits.copy()
    window[3] = np.radians([-180, 180])
    window[5] = np.radians([-180, 180])
    wide = np.radians([[-450.0, 450]] * 6)
    free = np.radians([-2000.0, 2000])
    default, narrow = inverse(m20ia, pose), inverse(m20ia, pose, limits=window)
    kept = np.all(np.abs(default.joints[:, [3, 5]]) <= math.pi + 1e-12, axis=1)
    np.testing.assert_array_equal(narrow.joints, default.joints[kept])
    assert 0 < len(narrow) < len(default)
    everything = inverse(m20ia, pose, limits=wide, elbow_limits=free)
    expected = sum(
        len(representatives(row, wide)) for row in all_branches(m20ia, pose).joints[default.reached]
    )
    assert len(everything) == expected > len(default)


def matches(one, many):
    """Whether `one` equals a row of `many` up to whole turns."""
    difference = many - one
    difference -= 2 * math.pi * np.round(difference / (2 * math.pi))
    return bool(np.any(np.abs(difference).max(axis=1) < 1e-7))


def test_branches_are_the_solutions_of_py_opw_kinematics(m20ia):
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
    robot = OpwRobot(model, degrees=True)
    for joints in joints_within_limits(m20ia, 300, seed=36):
        pose = forward(m20ia, joints)
        branches = all_branches(m20ia, pose)
        ours = branches.joints[branches.found]
        on_floor = pose.copy()
        on_floor[2, 3] += m20ia.world_height
        theirs = np.radians(robot.inverse(RigidTransform.from_matrix(on_floor)))
        theirs[:, 2] -= theirs[:, 1]
        assert len(theirs) == len(ours)
        assert all(matches(row, theirs) for row in ours)
        assert all(matches(row, ours) for row in theirs)


def singular_joints(robot, kind, distances, generator):
    """Pendant joints at `distances` [rad, or m for the shoulder] from a singularity."""
    a1, a2, a3, d4 = robot.arm_lengths
    count = len(distances)
    angles = generator.uniform(-math.pi, math.pi, (count, 6))
    if "wrist" in kind:
        angles[:, 4] = np.where(generator.random(count) < 0.8, 0.0, math.pi) + distances
    if "elbow" in kind:
        folded = np.where(generator.random(count) < 0.8, 0.0, math.pi)
        angles[:, 2] = -math.atan2(d4, a3) + folded + distances
    if "shoulder" in kind:
        # a1 + a2 s2 + a3 s23 + d4 c23 = distance, solved for theta2 + theta3.
        forearm = math.hypot(a3, d4)
        needed = distances - a1 - a2 * np.sin(angles[:, 1])
        inside = np.abs(needed) < 0.99 * forearm
        angles[~inside, 1] = math.pi
        needed = distances - a1 - a2 * np.sin(angles[:, 1])
        bend = np.arccos(needed / forearm) * generator.choice([-1.0, 1.0], count)
        angles[:, 2] = bend + math.atan2(a3, d4) - angles[:, 1]
    return pendant_from_model(robot, angles)


def distances_from_singularity(count, generator):
    """Distances 1e-3 to 1e-12 on either side, and every tenth exactly none."""
    distances = 10.0 ** generator.uniform(-12, -3, count) * generator.choice([-1.0, 1.0], count)
    distances[::10] = 0.0
    return distances


@pytest.mark.parametrize("name", ["m20ia", "short_arm"])
@pytest.mark.parametrize("kind", ["wrist", "elbow", "shoulder", "wrist and elbow"])
def test_near_singularities_every_branch_is_there_and_reaches_the_pose(name, kind, request):
    robot = request.getfixturevalue(name)
    generator = np.random.default_rng(37)
    distances = distances_from_singularity(2500, generator)
    joints = singular_joints(robot, kind, distances, generator)
    poses = forward(robot, joints)
    branches = all_branches(robot, poses)
    np.testing.assert_array_equal(
        branches.found, np.repeat(reachable_sides(robot, poses), 4, axis=-1)
    )
    assert np.all(np.isfinite(branches.joints[branches.found]))
    position, rotation = pose_residuals(robot, branches, poses)
    assert position.max() < TOLERANCE
    assert rotation.max() < TOLERANCE
    number = np.array([branch_of(robot, row) for row in joints])
    assert np.all(branches.found[np.arange(len(joints)), number])


@pytest.mark.parametrize("kind", ["wrist", "elbow", "shoulder"])
def test_near_singularities_the_original_is_recovered_as_far_as_rounding_allows(m20ia, kind):
    """The rounding of a pose, about 1e-15, is felt in the joints divided by the measure."""
    generator = np.random.default_rng(38)
    distances = 10.0 ** generator.uniform(-9, -3, 2500) * generator.choice([-1.0, 1.0], 2500)
    joints = singular_joints(m20ia, kind, distances, generator)
    branches = all_branches(m20ia, forward(m20ia, joints))
    # The measure is the product of the distances from all three kinds of singularity.
    allowed = TOLERANCE + 1e-14 / posture_manipulability(m20ia, joints)
    assert np.all(distance_to_original(branches, joints) < allowed)


def test_on_the_wrist_singularity_theta4_is_chosen_and_theta6_follows(m20ia):
    joints = np.radians([10, 20, -10, 35, 0, 40])
    solutions = inverse(m20ia, forward(m20ia, joints), turns=Turns.PRINCIPAL)
    chosen = solutions.joints[solutions.branch == 0]
    np.testing.assert_allclose(np.degrees(chosen), [[10, 20, -10, 0, 0, 75]], atol=1e-9)


def test_stretched_arm_is_a_solution_and_a_micrometre_more_is_out_of_reach(m20ia):
    a1, a2, a3, d4 = m20ia.arm_lengths
    length = a2 + math.hypot(a3, d4)
    generator = np.random.default_rng(39)
    wrist_from_flange = m20ia.flange
    for elevation, bearing in generator.uniform([-0.5, -3], [1.5, 3], (300, 2)):
        for extra, reached in ((0.0, True), (1e-6, False)):
            span = length + extra
            radius, height = a1 + span * math.cos(elevation), span * math.sin(elevation)
            wrist = np.eye(4)
            wrist[:3, 3] = [radius * math.cos(bearing), radius * math.sin(bearing), height]
            pose = wrist @ wrist_from_flange
            branches = all_branches(m20ia, pose)
            assert np.all(branches.found[:4]) == reached
            assert np.any(branches.found[:4]) == reached
            position, _ = pose_residuals(m20ia, branches, pose)
            assert position.max() < 1e-11


def test_wrist_centre_on_the_j1_axis_has_both_sides_half_a_turn_apart(m20ia):
    wrist = np.eye(4)
    wrist[:3, 3] = [0.0, 0.0, 1.1]
    branches = all_branches(m20ia, wrist @ m20ia.flange)
    assert np.all(branches.found)
    np.testing.assert_array_equal(branches.joints[:, 0], [0.0] * 4 + [math.pi] * 4)
    position, rotation = pose_residuals(m20ia, branches, wrist @ m20ia.flange)
    assert position.max() < 1e-14
    assert rotation.max() < 1e-14


def test_wrist_centre_on_the_j2_axis_of_an_even_arm_has_solutions(even_arm):
    wrist = np.eye(4)
    poses = np.stack([wrist, wrist, wrist])
    poses[1, :3, 3] = [1e-9, 0, -1e-9]
    poses[2, :3, 3] = [0, 1e-13, 0]
    poses = poses @ even_arm.flange
    branches = all_branches(even_arm, poses)
    assert np.all(branches.found)
    position, rotation = pose_residuals(even_arm, branches, poses)
    assert position.max() < 1e-11
    assert rotation.max() < TOLERANCE


def test_pose_out_of_reach_has_no_solution_and_no_number_for_it(m20ia):
    pose = np.eye(4)
    pose[:3, 3] = [5.0, 0.0, 0.0]
    branches = all_branches(m20ia, pose)
    assert not np.any(branches.found)
    assert np.all(np.isnan(branches.joints))
    solutions = inverse(m20ia, pose)
    assert len(solutions) == 0
    assert solutions.joints.shape == (0, 6)
    assert solutions.config == ()


def test_branches_of_many_poses_keep_their_shape(m20ia):
    joints = np.random.default_rng(40).uniform(-1, 1, (2, 3, 6))
    poses = forward(m20ia, joints)
    many = all_branches(m20ia, poses)
    assert many.joints.shape == (2, 3, 8, 6)
    assert many.found.shape == (2, 3, 8)
    np.testing.assert_array_equal(many.joints[1, 2], all_branches(m20ia, poses[1, 2]).joints)


def test_wrist_centre_is_where_the_last_three_axes_meet(m20ia):
    frames = forward_frames(m20ia, np.radians([10, 20, 30, 40, 50, 60]))
    np.testing.assert_array_equal(frames[4, :, 3], frames[5, :, 3])
    np.testing.assert_array_equal(frames[4, :, 3], frames[6, :, 3])


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda pose: pose[:3], "4 x 4"),
        (lambda pose: pose * np.nan, "not finite"),
        (lambda pose: pose * 1.001, "not a rigid transform"),
        (lambda pose: pose @ np.diag([-1.0, 1, 1, 1]), "not a rigid transform"),
    ],
)
def test_pose_that_is_no_rigid_transform_is_refused(m20ia, spoil, words):
    with pytest.raises(InputError, match=words):
        all_branches(m20ia, spoil(forward(m20ia, np.zeros(6))))
