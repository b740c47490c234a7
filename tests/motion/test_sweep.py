from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from motion_oracle import frames, tcp_pose

from solver.catalog.cells import load_cell
from solver.collision.kernels_scene import FREE, HIT, MARGIN_BROKEN, SELF_BROKEN
from solver.collision.scene import build_scene
from solver.kinematics.arm import all_branches
from solver.model.program import MotionKind
from solver.model.robot import LinkBody
from solver.model.shapes import Body, Box, Sphere
from solver.motion.sweep import sweep
from solver.motion.trajectory import body_reach, sampled_way
from solver.transforms import rigid

J, L = MotionKind.JOINT, MotionKind.LINEAR
BALL, TABLE = 0.05, 0.2


@pytest.fixture(scope="module")
def ball_over_table():
    """A ball at the wrist above a wide table whose top is 0.2 m above the floor."""
    cell = load_cell("groove_paper")
    ball = LinkBody(6, Body("ball", Sphere(BALL), np.eye(4)))
    table = Body("table", Box(np.array([20.0, 20.0, TABLE])), rigid(position=(0, 0, TABLE / 2)))
    away = replace(cell.workpiece, placement=rigid(position=(50.0, 0.0, 0.0)))
    robot = replace(cell.robot, body_sets={"ball": (ball,)}, neighbours=frozenset())
    return replace(
        cell,
        robot=robot,
        bodies="ball",
        tool=replace(cell.tool, bodies=()),
        workpiece=away,
        fixtures=(table,),
        toolpath=replace(
            cell.toolpath, passes=tuple(replace(one, touches="") for one in cell.toolpath.passes)
        ),
    )


def swept(problem, kind, start, end, step, touch=-1):
    scene = build_scene(problem)
    reach = body_reach(problem, scene)
    way = sampled_way(problem.robot, problem.tool.tcp, reach, kind, start, end, step)
    return way, sweep(problem, scene, way, touch)


def height(joints):
    """Of the ball's lowest point above the table."""
    return frames(joints)[6][2, 3] + 0.525 - BALL - TABLE


@settings(max_examples=30)
@given(st.integers(0, 2**32 - 1), st.sampled_from([0.3, 0.05, 0.002]))
def test_the_clearance_is_certain_between_the_samples_too(ball_over_table, seed, step):
    random = np.random.default_rng(seed)
    start = np.radians([0.0, 10.0, -20.0, 0.0, 0.0, 0.0]) + random.uniform(-0.3, 0.3, 6)
    end = start + random.uniform(-0.5, 0.5, 6)
    way, found = swept(ball_over_table, J, start, end, step)
    between = start + np.linspace(0.0, 1.0, 400)[:, None] * (end - start)
    heights = np.array([height(row) for row in between])
    sampled = np.array([height(row) for row in way.joints])
    assert found.clearance == pytest.approx(sampled, abs=1e-6)
    assert found.least <= heights.min() + 1e-9
    assert found.least >= sampled.min() - way.travel.max() / 2.0 - 1e-6
    assert found.at == int(np.argmin(found.clearance))
    assert found.nearest == ("ball", "table")
    assert found.free
    assert len(found.clearance) == len(found.status) == len(found.points) == len(way)


@pytest.mark.parametrize("kind", [J, L])
def test_a_way_into_the_table_is_broken_where_the_ball_meets_it(ball_over_table, kind):
    problem = ball_over_table
    start = np.radians([0.0, 30.0, -30.0, 0.0, -60.0, 0.0])
    target = tcp_pose(start, problem.tool.tcp)
    target[2, 3] -= 0.9
    end = all_branches(problem.robot, target, problem.tool.tcp).joints[0]
    way, found = swept(problem, kind, start, end, 0.002)
    heights = np.array([height(row) for row in way.joints])
    assert heights.min() < 0.0
    assert found.broken == int(np.argmax(heights <= 0.0)) == found.at
    assert found.status[found.broken] == HIT
    assert found.least == -np.inf
    assert found.nearest == ("ball", "table")
    assert not found.free


@pytest.fixture(scope="module")
def grinder():
    """The shipped cell, and joints with the ball on the web's middle and 100 mm off it."""
    problem = load_cell("groove_hw300")
    pose = problem.waypoint_poses[0].copy()
    ends = []
    for lift in (0.1, 0.0):
        lifted = pose.copy()
        lifted[:3, 3] -= lift * pose[:3, 2]
        ends.append(all_branches(problem.robot, lifted, problem.tool.tcp).joints[0])
    return problem, np.array(ends)


def test_a_contact_body_may_only_enter_what_is_touched(grinder):
    problem, (above, down) = grinder
    web = build_scene(problem).touch_number("web")
    way, free = swept(problem, L, above, down, 0.002, web)
    assert free.free
    assert np.all(free.status == FREE)
    _, refused = swept(problem, L, above, down, 0.002, -1)
    assert refused.status[refused.broken] == MARGIN_BROKEN
    assert "ball" in refused.nearest[0]
    assert refused.nearest[1].startswith("web")
    assert np.isnan(refused.clearance[refused.broken])
    assert refused.least == -np.inf
    only_at_the_end = np.full(len(way), -1)
    only_at_the_end[refused.broken :] = web
    _, again = swept(problem, L, above, down, 0.002, only_at_the_end)
    assert again.free


def test_the_robot_against_its_own_tool_is_named(grinder):
    problem, _ = grinder
    start = np.radians([0.0, -30.0, 0.0, 0.0, -90.0, 0.0])
    end = np.radians([0.0, -30.0, -60.0, 0.0, -140.0, 0.0])
    _, found = swept(problem, J, start, end, 0.02)
    assert found.status[found.broken] == SELF_BROKEN
    assert found.nearest == ("forearm (forearm_taper)", "adapter")
    assert np.isnan(found.clearance[found.broken])
