from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from motion_oracle import body_points, placed_points, tcp_pose, tcp_poses
from scipy.spatial.transform import Rotation, Slerp

from solver.catalog.cells import load_cell
from solver.collision.scene import build_scene
from solver.kinematics.arm import all_branches, inverse
from solver.kinematics.configuration import branch_of
from solver.model.program import MotionKind
from solver.motion.trajectory import (
    SAMPLE_LIMIT,
    SAMPLE_STEP,
    MotionError,
    body_reach,
    sampled_way,
)

J, L = MotionKind.JOINT, MotionKind.LINEAR
CELLS = ("groove_paper", "groove_hw300")
SOUND = np.radians([10.0, 20.0, -15.0, 30.0, -60.0, 40.0])
seeds = st.integers(0, 2**32 - 1)


@pytest.fixture(scope="module", params=CELLS)
def cell(request):
    problem = load_cell(request.param)
    return problem, body_reach(problem, build_scene(problem)), body_points(problem)


@pytest.fixture(scope="module")
def paper():
    problem = load_cell("groove_paper")
    return problem, body_reach(problem, build_scene(problem)), body_points(problem)


def follow(cell, kind, start, end, step=SAMPLE_STEP):
    problem, reach, _ = cell
    return sampled_way(problem.robot, problem.tool.tcp, reach, kind, start, end, step)


def random_joints(random, problem):
    return random.uniform(*problem.robot.limits.T)


def moved(points, joints, other):
    """How far each point of the bodies is displaced between two postures."""
    apart = placed_points(points, other) - placed_points(points, joints)
    return np.linalg.norm(apart, axis=1)


def neighbour(problem, start, offset, turn):
    """Joints of the same branch at the TCP's pose shifted and turned, next to `start`."""
    target = tcp_pose(start, problem.tool.tcp)
    target[:3, 3] += offset
    target[:3, :3] = target[:3, :3] @ Rotation.from_rotvec(turn).as_matrix()
    branches = all_branches(problem.robot, target, problem.tool.tcp)
    branch = branch_of(problem.robot, start)
    if not branches.found[branch]:
        return None
    end = branches.joints[branch]
    return end + 2 * np.pi * np.round((start - end) / (2 * np.pi))


def test_no_point_of_a_body_moves_more_than_the_reach_says(cell):
    problem, reach, points = cell
    random = np.random.default_rng(1)
    for scale in np.repeat([1e-3, 0.05, 0.5], 150):
        start = random_joints(random, problem)
        change = random.uniform(-scale, scale, 6) * (random.random(6) < 0.6)
        bound = np.abs(change) @ reach
        assert moved(points, start, start + change).max() <= bound + 1e-12


def test_the_reach_of_each_joint_is_no_wild_overestimate(cell):
    problem, reach, points = cell
    random = np.random.default_rng(2)
    share = np.zeros(6)
    for _ in range(150):
        start = random_joints(random, problem)
        for joint in range(6):
            change = np.zeros(6)
            change[joint] = 1e-4
            travel = moved(points, start, start + change).max()
            share[joint] = max(share[joint], travel / (1e-4 * reach[joint]))
    assert np.all(share <= 1.0)
    assert np.all(share > 0.3)


def test_the_reach_holds_for_a_pendant_without_coupled_joints(cell):
    problem, _, points = cell
    fanuc = problem.robot.model_from_pendant
    plain = replace(problem, robot=replace(problem.robot, model_from_pendant=np.eye(6)))
    reach = body_reach(plain, build_scene(plain))
    random = np.random.default_rng(3)
    for _ in range(150):
        start = random_joints(random, problem)
        change = random.uniform(-0.3, 0.3, 6) * (random.random(6) < 0.5)
        before, after = (np.linalg.solve(fanuc, row) for row in (start, start + change))
        assert moved(points, before, after).max() <= np.abs(change) @ reach + 1e-12


def test_a_joint_move_is_linear_in_the_joints_and_ends_exactly(cell):
    end = SOUND + np.radians([30.0, -10.0, 12.0, -50.0, 15.0, 90.0])
    way = follow(cell, J, SOUND, end)
    assert np.array_equal(way.joints[0], SOUND)
    assert np.array_equal(way.joints[-1], end)
    assert np.allclose(way.joints, SOUND + way.share[:, None] * (end - SOUND), atol=1e-15)
    assert (way.share[0], way.share[-1]) == (0.0, 1.0)


@pytest.mark.parametrize("kind", [J, L])
def test_bodies_move_no_farther_than_the_step_between_samples(cell, kind):
    problem, _, points = cell
    end = neighbour(problem, SOUND, (-0.05, 0.12, 0.06), (0.2, -0.1, 0.3))
    way = follow(cell, kind, SOUND, end)
    assert way.travel.max() <= SAMPLE_STEP
    for before, after, travel in zip(way.joints[:-1], way.joints[1:], way.travel, strict=True):
        assert moved(points, before, after).max() <= travel + 1e-12


@settings(max_examples=25)
@given(seeds)
def test_bodies_travel_no_farther_than_stated_between_samples_of_a_linear_move(seed):
    """The way between two samples is measured in pieces of at most 5 mm."""
    problem = load_cell("groove_paper")
    reach, points = body_reach(problem, build_scene(problem)), body_points(problem)
    random = np.random.default_rng(seed)
    start = random_joints(random, problem)
    end = neighbour(problem, start, random.uniform(-0.3, 0.3, 3), random.uniform(-1.0, 1.0, 3))
    assume(end is not None)
    wide = (problem.robot, problem.tool.tcp, reach, L, start, end)
    try:
        way = sampled_way(*wide, step=0.3)
        fine = sampled_way(*wide, step=0.005)
    except MotionError:
        return
    placed = np.array([placed_points(points, row) for row in fine.joints])
    lengths = np.linalg.norm(np.diff(placed, axis=0), axis=2)
    turned = np.abs(np.diff(fine.joints, axis=0)) @ reach
    for way_of_one in [turned, *lengths.T[::7]]:
        total = np.concatenate([[0.0], np.cumsum(way_of_one)])
        measured = np.diff(np.interp(way.share, fine.share, total))
        assert np.all(measured <= way.travel * 1.001)


@settings(max_examples=40)
@given(seeds)
def test_a_linear_move_is_straight_and_turns_about_one_axis(seed):
    problem = load_cell("groove_paper")
    reach = body_reach(problem, build_scene(problem))
    tcp = problem.tool.tcp
    random = np.random.default_rng(seed)
    start = random_joints(random, problem)
    end = neighbour(problem, start, random.uniform(-0.1, 0.1, 3), random.uniform(-1.0, 1.0, 3))
    assume(end is not None)
    try:
        way = sampled_way(problem.robot, tcp, reach, L, start, end, step=0.01)
    except MotionError:
        return
    poses = tcp_poses(way.joints, tcp)
    first, last = poses[0], poses[-1]
    line = first[:3, 3] + way.share[:, None] * (last[:3, 3] - first[:3, 3])
    assert np.abs(poses[:, :3, 3] - line).max() < 1e-9
    both = Rotation.from_matrix([first[:3, :3], last[:3, :3]])
    expected = Slerp([0.0, 1.0], both)(way.share)
    apart = (expected.inv() * Rotation.from_matrix(poses[:, :3, :3])).magnitude()
    assert apart.max() < 1e-8
    assert np.all(np.diff(way.share) > 0.0)
    assert way.travel.max() <= 0.01
    assert np.array_equal(way.joints[0], start)
    assert np.array_equal(way.joints[-1], end)
    assert np.abs(np.diff(way.joints, axis=0)).max() < 1.0


def test_most_random_short_linear_moves_can_be_followed(paper):
    problem, _, _ = paper
    random = np.random.default_rng(5)
    followed = tried = 0
    while tried < 40:
        start = random_joints(random, problem)
        end = neighbour(problem, start, random.uniform(-0.02, 0.02, 3), np.zeros(3))
        if end is None or abs(np.sin(start[4])) < 0.3:
            continue
        tried += 1
        try:
            follow(paper, L, start, end)
        except MotionError:
            continue
        followed += 1
    assert followed >= 30


def test_a_linear_move_keeps_the_turn_it_starts_in(paper):
    problem, _, _ = paper
    start = SOUND + np.radians([0.0, 0.0, 0.0, 0.0, 0.0, 165.0])
    end = neighbour(problem, start, (0.0, 0.1, 0.0), (0.0, 0.0, 0.3))
    assert np.degrees(min(start[5], end[5])) > 181.0
    assert np.degrees(follow(paper, L, start, end).joints[:, 5]).min() > 181.0


@pytest.mark.parametrize("joint", [3, 5])
@pytest.mark.parametrize("turn", [-360.0, 360.0])
def test_a_linear_move_to_another_turn_is_refused(paper, joint, turn):
    problem, _, _ = paper
    end = neighbour(problem, SOUND, (0.0, 0.05, 0.0), (0.0, 0.1, 0.0))
    end[joint] += np.radians(turn)
    with pytest.raises(MotionError, match=rf"arrives at J{joint + 1} .* shortest joint way"):
        follow(paper, L, SOUND, end)


def test_a_linear_move_to_another_branch_is_refused(paper):
    problem, _, _ = paper
    near = neighbour(problem, SOUND, (0.0, 0.05, 0.0), (0.0, 0.1, 0.0))
    solutions = inverse(problem.robot, tcp_pose(near, problem.tool.tcp), problem.tool.tcp)
    others = solutions.joints[solutions.branch != branch_of(problem.robot, SOUND)]
    assert len(others)
    for end in others:
        with pytest.raises(MotionError, match="arrives at"):
            follow(paper, L, SOUND, end)


@pytest.mark.parametrize(("off", "refused"), [(0.9e-3, False), (1.1e-3, True)])
def test_a_linear_move_may_arrive_a_thousandth_of_a_degree_beside(paper, off, refused):
    """On the wrist singularity J4 and J6 share a turn, so either may be off with the same pose."""
    problem, _, _ = paper
    start = np.radians([0.0, 10.0, 0.0, 0.0, -30.0, 0.0])
    end = neighbour(problem, start, (0.0, 0.0, 0.05), np.zeros(3))
    end[3:] = np.radians([off, 0.0, -off])
    if refused:
        with pytest.raises(MotionError):
            follow(paper, L, start, end)
    else:
        assert np.array_equal(follow(paper, L, start, end).joints[-1], end)


def test_a_linear_move_through_a_wrist_singularity_is_refused(paper):
    start = np.radians([0.0, 10.0, -10.0, 0.0, 25.0, 0.0])
    end = np.radians([0.0, 15.0, -5.0, 0.0, -25.0, 0.0])
    with pytest.raises(
        MotionError, match=r"passes a singularity .* J[46] would turn by 180\.0 deg"
    ):
        follow(paper, L, start, end)


def test_a_linear_move_close_to_a_wrist_singularity_is_sampled_more_finely_there(paper):
    problem, _, _ = paper
    start = np.radians([0.0, -20.0, -20.0, 4.0, 25.0, 0.0])
    end = neighbour(problem, start, (0.0, 0.0, 0.0), (0.0, np.radians(50.0), 0.0))
    way = follow(paper, L, start, end)
    near = np.abs(np.sin(way.joints[:, 4]))
    assert way.travel.max() <= SAMPLE_STEP
    assert near.min() < 0.05
    steps = np.diff(way.share)
    assert steps[np.argmin(near) - 1] < steps[0]


def test_a_linear_move_out_of_reach_on_the_way_is_refused(paper):
    """The tool points at the robot half-way, which takes the wrist beyond the stretched arm."""
    problem, _, _ = paper
    tcp = problem.tool.tcp
    ends = []
    for tilt in (-60.0, 60.0):
        pose = np.eye(4)
        pose[:3, :3] = Rotation.from_euler("y", -90.0 + tilt, degrees=True).as_matrix()
        pose[:3, 3] = 1.40, 0.0, 0.0
        solved = all_branches(problem.robot, pose, tcp)
        ends.append(solved.joints[0] if solved.found[0] else None)
    assert all(one is not None for one in ends)
    with pytest.raises(MotionError, match=r"leaves the reach of its posture .* of the way"):
        follow(paper, L, *ends)


def test_a_linear_move_that_turns_the_tool_half_round_is_refused(paper):
    end = SOUND.copy()
    end[5] += np.pi
    with pytest.raises(MotionError, match=r"turns the tool by 180\.0 deg"):
        follow(paper, L, SOUND, end)


@pytest.mark.parametrize("kind", [J, L])
def test_a_move_to_where_it_starts_has_two_equal_samples_at_least(paper, kind):
    way = follow(paper, kind, SOUND, SOUND)
    assert len(way) >= 2
    assert np.allclose(way.joints, SOUND, atol=1e-9)


@pytest.mark.parametrize("kind", [J, L])
def test_a_move_of_too_many_samples_is_refused(paper, kind):
    problem, reach, _ = paper
    end = neighbour(problem, SOUND, (0.0, 0.1, 0.0), np.zeros(3))
    step = float(np.abs(end - SOUND) @ reach) / (2 * SAMPLE_LIMIT)
    with pytest.raises(MotionError, match="too long to be followed in 20,000 samples"):
        follow(paper, kind, SOUND, end, step)


@pytest.mark.parametrize("kind", [J, L])
@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_joint_that_is_no_number_is_refused(paper, kind, value):
    end = SOUND.copy()
    end[2] = value
    with pytest.raises(MotionError, match="not a number"):
        follow(paper, kind, SOUND, end)


def test_the_sentence_names_the_move(paper):
    problem, reach, _ = paper
    end = SOUND + np.array([0, 0, 0, 0, 0, 2 * np.pi])
    with pytest.raises(MotionError, match=r"^the move to waypoint 7 arrives at J6"):
        sampled_way(
            problem.robot, problem.tool.tcp, reach, L, SOUND, end, move="the move to waypoint 7"
        )
