from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from motion_oracle import SPEEDS, numeric_jacobian, tcp_pose, tcp_poses
from scipy.spatial.transform import Rotation

from solver.catalog.cells import load_cell
from solver.collision.scene import build_scene
from solver.kinematics.arm import all_branches
from solver.kinematics.configuration import branch_of
from solver.model.program import MotionKind, Move, Speed, rounded_joints
from solver.motion.feed import predict
from solver.motion.trajectory import MotionError, body_reach
from solver.pipeline.planning import plan

SOUND = np.radians([10.0, 20.0, -15.0, 30.0, -60.0, 40.0])
L = MotionKind.LINEAR


@pytest.fixture(scope="module")
def cell():
    problem = load_cell("groove_paper")
    return problem.robot, problem.tool.tcp, body_reach(problem, build_scene(problem))


def linear_end(cell, start, offset, turn=(0.0, 0.0, 0.0)):
    robot, tcp, _ = cell
    target = tcp_pose(start, tcp)
    target[:3, 3] += offset
    target[:3, :3] = target[:3, :3] @ Rotation.from_rotvec(turn).as_matrix()
    end = all_branches(robot, target, tcp).joints[branch_of(robot, start)]
    return end + 2 * np.pi * np.round((start - end) / (2 * np.pi))


def speeds_from_derivatives(cell, start, end, duration, count=2000):
    """TCP speeds along a joint move, from central differences of the D-H table."""
    share = np.linspace(0.0, 1.0, count + 1)
    joints = start + share[:, None] * (end - start)
    positions = tcp_poses(joints, cell[1])[:, :3, 3]
    return np.linalg.norm(np.gradient(positions, share, axis=0), axis=1) / duration


@pytest.mark.parametrize("percent", [1.0, 20.0, 100.0])
def test_a_turn_of_j1_runs_on_its_circle_at_its_share_of_the_joint_speed(cell, percent):
    end = SOUND + np.radians([40.0, 0, 0, 0, 0, 0])
    found = predict(*cell, SOUND, Move(end, Speed.percent(percent)))
    x, y = tcp_pose(SOUND, cell[1])[:2, 3]
    speed = np.hypot(x, y) * SPEEDS[0] * percent / 100.0
    assert found.slowest == pytest.approx(speed, rel=1e-6)
    assert found.fastest == pytest.approx(speed, rel=1e-6)
    assert found.duration == pytest.approx(np.radians(40.0) / SPEEDS[0] * 100.0 / percent)
    assert found.best == pytest.approx(np.hypot(x, y) * SPEEDS[0], rel=1e-6)
    assert found.joint == 0
    assert found.holds
    assert found.joint_speeds == pytest.approx([SPEEDS[0] * percent / 100.0, 0, 0, 0, 0, 0])


def test_the_joint_with_the_longest_time_sets_that_of_a_move_in_percent(cell):
    turned = np.radians([3.0, -5.0, 4.0, 60.0, 10.0, -80.0])
    found = predict(*cell, SOUND, Move(SOUND + turned, Speed.percent(50.0)))
    alone = np.abs(turned) / (0.5 * SPEEDS)
    assert found.duration == pytest.approx(alone.max())
    assert found.joint == int(np.argmax(alone)) == 3


def test_speeds_of_joint_moves_are_those_of_numeric_derivatives(cell):
    random = np.random.default_rng(1)
    robot = cell[0]
    for _ in range(8):
        start = random.uniform(*robot.limits.T)
        end = start + random.uniform(-0.4, 0.4, 6)
        found = predict(*cell, start, Move(end, Speed.duration(2.0)))
        expected = speeds_from_derivatives(cell, start, end, 2.0, 600)
        assert found.duration == 2.0
        assert found.slowest == pytest.approx(expected.min(), rel=0.02, abs=2e-3)
        assert found.fastest == pytest.approx(expected.max(), rel=0.01)
        assert found.mean == pytest.approx(expected[:-1].mean(), rel=0.01)


@pytest.mark.parametrize(
    ("share", "holds"), [(2.0, True), (1.0, True), (0.999, False), (0.5, False)]
)
def test_a_time_is_kept_unless_a_joint_would_be_too_fast(cell, share, holds):
    turned = np.radians([3.0, -5.0, 4.0, 60.0, 10.0, -80.0])
    shortest = np.radians(60.0) / SPEEDS[3]
    found = predict(*cell, SOUND, Move(SOUND + turned, Speed.duration(share * shortest)))
    assert found.holds is holds
    assert found.duration == pytest.approx(max(share, 1.0) * shortest)
    assert np.all(found.joint_speeds <= SPEEDS * (1.0 + 1e-9))
    assert found.joint == 3
    assert found.best == pytest.approx(found.length / shortest)


@pytest.mark.parametrize("speed", [0.005, 0.05, 0.2])
def test_a_linear_move_that_the_joints_allow_runs_at_its_constant_speed(cell, speed):
    end = linear_end(cell, SOUND, (0.05, 0.1, -0.03), (0.0, 0.2, 0.1))
    found = predict(*cell, SOUND, Move(end, Speed.linear(speed), kind=L))
    length = float(np.linalg.norm([0.05, 0.1, -0.03]))
    assert found.holds
    assert found.slowest == pytest.approx(speed, rel=1e-6)
    assert found.fastest == pytest.approx(speed, rel=1e-6)
    assert found.length == pytest.approx(length, rel=1e-9)
    assert found.duration == pytest.approx(length / speed, rel=1e-6)


def joint_pace(cell, start, end, shares):
    """(m, 6) joint rates per share of a linear move: twist through the numeric Jacobian."""
    first, last = tcp_pose(start, cell[1]), tcp_pose(end, cell[1])
    spin = Rotation.from_matrix(last[:3, :3] @ first[:3, :3].T).as_rotvec()
    twist = np.concatenate([last[:3, 3] - first[:3, 3], spin])
    robot, tcp, _ = cell
    branch = branch_of(robot, start)
    rates = []
    for share in shares:
        pose = np.eye(4)
        turned = Rotation.from_rotvec(share * spin).as_matrix()
        pose[:3, :3] = turned @ first[:3, :3]
        pose[:3, 3] = first[:3, 3] + share * twist[:3]
        joints = all_branches(robot, pose, tcp).joints[branch]
        rates.append(np.linalg.solve(numeric_jacobian(joints, tcp), twist))
    return np.abs(rates)


@pytest.mark.parametrize("turn", [(0.0, 0.0, 0.0), (0.4, -0.2, 0.3)])
def test_the_best_speed_of_a_linear_move_is_that_of_the_numeric_jacobian(cell, turn):
    start = np.radians([10.0, 20.0, -15.0, 8.0, -25.0, 40.0])
    end = linear_end(cell, start, (0.04, 0.12, -0.06), turn)
    found = predict(*cell, start, Move(end, Speed.linear(0.01), kind=L))
    pace = joint_pace(cell, start, end, np.linspace(0.0, 1.0, 101)) / SPEEDS
    assert found.best == pytest.approx(0.14 / pace.max(), rel=0.01)
    assert found.joint == int(np.argmax(pace.max(axis=0)))
    almost = predict(*cell, start, Move(end, Speed.linear(0.999 * found.best), kind=L))
    beyond = predict(*cell, start, Move(end, Speed.linear(1.001 * found.best), kind=L))
    assert (almost.holds, beyond.holds) == (True, False)


def test_a_linear_move_is_slowed_only_where_a_joint_would_be_too_fast(cell):
    start = np.radians([10.0, 20.0, -15.0, 8.0, -25.0, 40.0])
    end = linear_end(cell, start, (0.04, 0.12, -0.06), (0.4, -0.2, 0.3))
    best = predict(*cell, start, Move(end, Speed.linear(0.01), kind=L)).best
    asked = 1.2 * best
    found = predict(*cell, start, Move(end, Speed.linear(asked), kind=L))
    assert not found.holds
    assert found.slowest == pytest.approx(best, rel=1e-6)
    assert found.fastest <= asked * (1.0 + 1e-9)
    assert 0.14 / asked < found.duration < 0.14 / best * (1.0 + 1e-9)
    assert np.all(found.joint_speeds <= SPEEDS * (1.0 + 1e-9))


def test_a_turn_on_the_spot_takes_its_time_and_holds_no_speed(cell):
    end = linear_end(cell, SOUND, (0.0, 0.0, 0.0), (0.0, 0.0, 0.5))
    found = predict(*cell, SOUND, Move(end, Speed.linear(0.05), kind=L))
    assert not found.holds
    assert found.fastest == pytest.approx(0.0, abs=1e-6)
    assert found.duration == pytest.approx(0.5 / SPEEDS[5], rel=1e-3)


@pytest.mark.parametrize("speed", [Speed.percent(20.0), Speed.duration(0.5), Speed.linear(0.05)])
def test_a_move_to_where_the_robot_is_moves_nothing(cell, speed):
    kind = L if speed.unit.name == "LINEAR" else MotionKind.JOINT
    found = predict(*cell, SOUND, Move(SOUND, speed, kind=kind))
    assert (found.holds, found.best) == (True, np.inf)
    assert found.duration == (0.5 if speed.unit.name == "DURATION" else 0.0)
    assert (found.slowest, found.fastest, found.mean) == (0.0, 0.0, 0.0)


def test_a_move_that_cannot_be_made_is_refused_by_name(cell):
    end = SOUND + np.array([0, 0, 0, 0, 0, 2 * np.pi])
    with pytest.raises(MotionError, match="line 12 arrives at J6"):
        predict(*cell, SOUND, Move(end, Speed.linear(0.05), kind=L), title="line 12")


@pytest.fixture(scope="module")
def groove():
    """Joints of the groove pass, and the share that each move needs of the joint speed."""
    result = plan(load_cell("groove_paper"))
    problem = result.problem
    joints = rounded_joints(result.sequence.pendant)
    distance = np.linalg.norm(np.diff(problem.waypoint_poses[:, :3, 3], axis=0), axis=1)
    assert problem.toolpath.passes[0].feed == 0.05
    time = distance / 0.05
    needed = (np.abs(np.diff(joints, axis=0)) / SPEEDS).max(axis=1) / time
    return joints, needed, time


def means(cell, joints, speeds):
    pairs = zip(joints[:-1], joints[1:], speeds, strict=True)
    return np.array([predict(*cell, one, Move(other, speed)).mean for one, other, speed in pairs])


def test_whole_percents_let_the_groove_run_at_33_to_66_mm_s_where_50_are_asked(cell, groove):
    joints, needed, _ = groove
    speeds = [Speed.percent(float(round(100.0 * share))) for share in needed]
    found = means(cell, joints, speeds) * 1e3
    assert found.min() == pytest.approx(33.4, abs=0.1)
    assert found.max() == pytest.approx(66.0, abs=0.1)


def test_times_let_the_groove_run_at_the_asked_feed(cell, groove):
    joints, _, time = groove
    speeds = [Speed.duration(float(round(one, 3))) for one in time]
    found = means(cell, joints, speeds) * 1e3
    assert np.abs(found - 50.0).max() < 0.3


def test_a_slower_robot_takes_longer(cell, groove):
    joints, _, _ = groove
    robot, tcp, reach = cell
    slow = replace(robot, speeds=robot.speeds / 10.0)
    move = Move(joints[1], Speed.percent(10.0))
    fast_one = predict(robot, tcp, reach, joints[0], move)
    slow_one = predict(slow, tcp, reach, joints[0], move)
    assert slow_one.duration == pytest.approx(10.0 * fast_one.duration)
    assert slow_one.best == pytest.approx(fast_one.best / 10.0)
