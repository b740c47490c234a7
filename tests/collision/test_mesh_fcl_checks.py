from __future__ import annotations

import numpy as np
import pytest
from mesh_oracle import random_pose, random_solid

from solver.collision.distance import distance
from solver.collision.fcl_checks import NOT_RELIED_ON, collides_fcl, fcl_self_test
from solver.collision.mesh_distance import MeshObstacle, mesh_clearance
from solver.collision.mesh_proxy import ConvexProxy, box_triangles
from solver.model.shapes import Box, Capsule, Cylinder, Hull, Mesh, Sphere

UNCERTAIN = 1e-3
"""Distance [m] from touching up to which python-fcl's verdict is not asked for."""


def random_shape(rng):
    a, b, c = rng.uniform(0.05, 0.4, 3)
    return [
        Sphere(a),
        Capsule(a, b),
        Cylinder(a, b),
        Box(np.array([a, b, c])),
        Hull(rng.normal(size=(10, 3)) * a),
    ][rng.integers(5)]


def test_every_distance_that_is_relied_on_is_right_and_the_known_bad_one_is_shown():
    checks = fcl_self_test()
    relied = [check for check in checks if not check.name.startswith(NOT_RELIED_ON)]
    assert len(relied) >= 6
    for check in relied:
        assert check.ok, check
        assert check.found == pytest.approx(check.expected, abs=1e-6)
    shown = [check for check in checks if check.name.startswith(NOT_RELIED_ON)]
    assert any("4 m apart in y" in check.name for check in shown)
    for name, expected, found, ok in checks:
        assert ok == (abs(found - expected) <= 1e-6), name


@pytest.mark.parametrize("square", [False, True], ids=["turned", "square"])
def test_the_kernels_and_fcl_agree_whether_convex_shapes_overlap(square):
    rng = np.random.default_rng(21 + square)
    verdicts = []
    for _ in range(300):
        first, second = random_shape(rng), random_shape(rng)
        pose_a, pose_b = (random_pose(rng, 0.4, square=square) for _ in range(2))
        signed = distance(first, pose_a, second, pose_b).distance
        if abs(signed) < UNCERTAIN:
            continue
        verdicts.append(collides_fcl(first, pose_a, second, pose_b))
        assert verdicts[-1] == (signed < 0.0), (first, second, signed)
    assert 30 < sum(verdicts) < len(verdicts) - 30


@pytest.mark.parametrize("square", [False, True], ids=["turned", "square"])
def test_the_mesh_clearance_and_fcl_agree_whether_a_surface_is_met(square):
    rng = np.random.default_rng(31 + square)
    met = 0
    for _ in range(120):
        solid = Mesh(*random_solid(rng, ("box", "torus", "beam", "hull")[rng.integers(4)]))
        shape = random_shape(rng)
        home, pose = (random_pose(rng, 0.4, square=square) for _ in range(2))
        signed = mesh_clearance(ConvexProxy(shape), pose, MeshObstacle(solid, home)).distance
        if abs(signed) < UNCERTAIN:
            continue
        collides = collides_fcl(shape, pose, solid, home)
        met += collides
        # fcl's meshes are surfaces, so a body wholly inside another is no collision to it
        assert signed < 0.0 or not collides
        if signed > 0.0:
            assert not collides
    assert 20 < met < 110


@pytest.mark.parametrize("square", [False, True], ids=["turned", "square"])
def test_a_box_mesh_and_the_kernels_give_the_same_distance(square):
    rng = np.random.default_rng(41 + square)
    separated = 0
    for _ in range(60):
        size, shape = rng.uniform(0.05, 0.5, 3), random_shape(rng)
        home, pose = (random_pose(rng, 0.6, square=square) for _ in range(2))
        by_kernel = distance(shape, pose, Box(size), home).distance
        proxy = ConvexProxy(shape)
        obstacle = MeshObstacle(Mesh(*box_triangles(size)), home)
        by_mesh = mesh_clearance(proxy, pose, obstacle).distance
        if by_kernel <= UNCERTAIN:
            assert by_mesh <= by_kernel + 1e-6 or by_kernel < 0.0 >= by_mesh
            continue
        separated += 1
        assert by_kernel - proxy.tolerance - 1e-6 <= by_mesh <= by_kernel + 2e-6
    assert separated > 10
