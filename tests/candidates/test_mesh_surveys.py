"""What boxes tell of many postures at once is what each posture's own distances tell."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from solver.candidates.generate import generate
from solver.candidates.outcomes import Outcome
from solver.candidates.postures import check_exact_postures
from solver.catalog import load_cell
from solver.collision.mesh_distance import mesh_clearance
from solver.collision.scene import build_scene
from solver.kinematics.arm import forward_frames
from solver.model.settings import Sweep
from solver.model.shapes import Body, Mesh
from solver.progress import SilentMonitor
from solver.transforms import rigid
from solver.units import DEG

PLACES = {"in the way": (0.9, 0.35, 0.5), "beside": (0.9, 0.6, 0.7), "far": (0.5, 1.5, 0.7)}


def beside_a_block(place):
    """The groove at every fifth lean, with a block as a triangle mesh."""
    problem = load_cell("groove_hw300")
    block = trimesh.creation.box((0.3, 0.2, 0.4))
    mesh = Mesh(np.array(block.vertices), np.array(block.faces))
    body = Body("block", mesh, rigid(position=np.array(PLACES[place])))
    settings = replace(problem.settings, lean=Sweep(-25.0 * DEG, 25.0 * DEG, 5.0 * DEG))
    return replace(problem, settings=settings, fixtures=(*problem.fixtures, body))


def one_by_one(problem, joints):
    """Least clearance from the mesh and whether every margin holds, pair by pair."""
    scene = build_scene(problem)
    packed = scene.packed
    frames = forward_frames(problem.robot, joints)
    least, kept = np.inf, True
    for rule in scene.mesh_rules:
        own = rigid(packed.moving.rotation[rule.row], packed.moving.position[rule.row])
        pose = frames[packed.frame[rule.row]] @ own
        gap = mesh_clearance(
            scene.mesh_proxies[rule.row], pose, scene.mesh_obstacles[rule.mesh]
        ).distance
        if rule.counts:
            least = min(least, gap)
        else:
            kept &= gap > rule.threshold
    return least, kept


@pytest.mark.parametrize("place", PLACES)
def test_candidates_beside_a_mesh_are_those_that_every_pair_allows(place):
    problem = beside_a_block(place)
    without = generate(replace(problem, fixtures=problem.fixtures[:-1]), SilentMonitor())
    with_mesh = generate(problem, SilentMonitor())
    rows = np.argwhere(without.outcome == Outcome.FEASIBLE)[::37]
    assert len(rows) > 20
    for n, o, b in rows:
        least, kept = one_by_one(problem, without.joints[n, o, b])
        least = min(least, without.clearance[n, o, b])
        feasible = bool(kept and least > 0.0)
        assert (with_mesh.outcome[n, o, b] == Outcome.FEASIBLE) == feasible
        if feasible:
            assert with_mesh.clearance[n, o, b] == pytest.approx(least, abs=1e-12)


def test_many_postures_are_checked_as_each_one_alone():
    problem = beside_a_block("beside")
    scene = build_scene(problem)
    random = np.random.default_rng(5)
    low, high = problem.joint_limits.T
    pendant = random.uniform(low, high, (60, 6))
    touch = np.full(60, -1)
    together = check_exact_postures(problem.robot, scene, pendant, touch)
    for row in range(60):
        alone = check_exact_postures(problem.robot, scene, pendant[row : row + 1], touch[:1])
        assert alone.status[0] == together.status[row]
        assert alone.bodies[0] == together.bodies[row]
        np.testing.assert_array_equal(alone.clearance[0], together.clearance[row])
        np.testing.assert_array_equal(alone.points[0], together.points[row])
