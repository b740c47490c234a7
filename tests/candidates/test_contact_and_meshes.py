"""Contact bodies may touch only what their pass names; meshes are obstacles like any other."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from solver.candidates.explain import explain
from solver.candidates.generate import generate
from solver.candidates.outcomes import Outcome
from solver.catalog import load_cell
from solver.model.settings import Sweep
from solver.model.shapes import Body, Box, Mesh
from solver.model.toolpath import Frame
from solver.transforms import rigid
from solver.units import DEG, MM


@pytest.fixture(scope="module")
def problem():
    loaded = load_cell("groove_hw300")
    one = loaded.toolpath.passes[0]
    few = replace(one, poses=one.poses[::10], roles=one.roles[::10])
    settings = replace(loaded.settings, lean=Sweep(8.0 * DEG, 16.0 * DEG, 2.0 * DEG), branches=(0,))
    return replace(loaded, toolpath=loaded.toolpath.with_passes((few,)), settings=settings)


def with_pass(problem, **changes):
    one = replace(problem.toolpath.passes[0], **changes)
    return replace(problem, toolpath=problem.toolpath.with_passes((one,)))


def deeper(problem, depth):
    """All waypoints moved into the web by `depth` [m]; the beam's y axis is the web's normal."""
    assert problem.toolpath.frame is Frame.BEAM
    poses = problem.toolpath.passes[0].poses.copy()
    poses[:, 1, 3] -= depth
    return with_pass(problem, poses=poses)


def test_the_ball_may_touch_the_web_that_its_pass_names(problem):
    assert generate(problem).counts()[Outcome.FEASIBLE] > 0


def test_the_same_pass_without_a_name_may_touch_nothing(problem):
    counts = generate(with_pass(problem, touches="")).counts()
    assert counts[Outcome.FEASIBLE] == 0
    assert counts[Outcome.MARGIN] > 0


@pytest.mark.parametrize(("depth", "allowed"), [(0.4 * MM, True), (0.6 * MM, False)])
def test_the_ball_may_enter_half_a_millimetre(problem, depth, allowed):
    counts = generate(deeper(problem, depth)).counts()
    assert (counts[Outcome.FEASIBLE] > 0) is allowed


def test_the_margin_of_a_contact_is_its_depth_left(problem):
    found = explain(deeper(problem, 0.3 * MM), 2, 12.0 * DEG, 0)
    contact = next(one for one in found.filters if one.filter is Outcome.MARGIN)
    assert contact.margin == pytest.approx(0.2, abs=1e-6)
    assert contact.subject == "ball and web"


def near_obstacle(problem, shape):
    """A box of 40 mm beside the spindle at the third waypoint, as a fixture."""
    centre = problem.waypoint_poses[2][:3, 3] + np.array([0.0, 0.09, 0.25])
    pose = rigid(position=centre + np.array([0.0, 0.0, problem.robot.world_height]))
    body = Body("obstacle", shape, pose)
    return replace(problem, fixtures=(*problem.fixtures, body))


def test_a_mesh_gives_the_clearance_of_the_box_that_it_is(problem):
    size = np.full(3, 0.040)
    solid = trimesh.creation.box(extents=size)
    mesh = Mesh(np.asarray(solid.vertices), np.asarray(solid.faces))
    boxed = generate(near_obstacle(problem, Box(size)))
    meshed = generate(near_obstacle(problem, mesh))
    free = generate(problem)
    assert np.array_equal(boxed.outcome, meshed.outcome)
    kept = boxed.outcome == Outcome.FEASIBLE
    assert kept.any()
    lower = boxed.clearance[kept] - meshed.clearance[kept]
    assert lower.min() > -1e-6
    assert lower.max() < 0.21 * MM
    assert np.nanmin(free.clearance[kept] - boxed.clearance[kept]) >= -1e-9
    assert np.nanmax(free.clearance[kept] - boxed.clearance[kept]) > 1.0 * MM


def test_an_explanation_names_the_mesh(problem):
    solid = trimesh.creation.box(extents=np.full(3, 0.040))
    mesh = Mesh(np.asarray(solid.vertices), np.asarray(solid.faces))
    changed = near_obstacle(problem, mesh)
    candidates = generate(changed)
    found = explain(changed, 2, 12.0 * DEG, 0, scene=candidates.scene)
    assert any("obstacle" in one.subject for one in found.filters)


@pytest.mark.parametrize("name", ["tool", "forearm", "base", "wrist"])
def test_a_fixture_named_like_a_part_of_the_robot_is_checked_like_any_other(problem, name):
    """Such a name once made neighbours of the two, and their pairs were left out."""
    size = np.full(3, 0.040)
    plain = near_obstacle(problem, Box(size))
    body = plain.fixtures[-1]
    named = replace(
        problem, fixtures=(*problem.fixtures, Body(name, body.shape, body.pose, group=name))
    )
    expected, found = generate(plain), generate(named)
    assert found.scene.pair_count == expected.scene.pair_count
    assert np.array_equal(found.outcome, expected.outcome)
