"""Bodies that touch or overlap: the sign is right and the depth is never under-stated."""

import math

import fcl
import numpy as np
import pytest
from distance_oracle import KIND_PAIRS, PAIR_NAMES, outside, plane_gap, random_bodies

from solver.collision.distance import distance
from solver.collision.kernels_distance import convex_distance
from solver.model.shapes import Box, Capsule, Cylinder, Hull, Sphere
from solver.transforms import rigid, rotation_x, rotation_y

UNIT_BOX = Box(np.ones(3))
HERE = np.eye(4)
WEDGE = Hull(
    np.array([[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.3], [0.1, 0, 0.3], [0, 0.1, 0.3]])
)


def at(x, y, z, rotation=None):
    return rigid(rotation, np.array([x, y, z]))


def overlapping_pairs(kinds, count):
    rng = np.random.default_rng([7, *kinds])
    bodies = [random_bodies(rng, kind, 4 * count, aligned=False) for kind in kinds]
    for body in bodies:
        body.position[:] *= 0.15
    found, witnesses = np.empty(4 * count), np.empty((4 * count, 2, 3))
    for i in range(4 * count):
        found[i] = convex_distance(*bodies[0].body(i), *bodies[1].body(i), witnesses[i])
    rows = np.flatnonzero(found < -1e-4)[:count]
    return bodies[0].rows(rows), bodies[1].rows(rows), found[rows], witnesses[rows]


@pytest.mark.parametrize("kinds", KIND_PAIRS, ids=PAIR_NAMES)
def test_drawn_apart_by_the_stated_depth_bodies_overlap_no_more(kinds):
    bodies_a, bodies_b, found, witnesses = overlapping_pairs(kinds, 60)
    assert len(found) > 30
    direction = witnesses[:, 1] - witnesses[:, 0]
    depth = np.linalg.norm(direction, axis=1)
    direction /= depth[:, None]
    np.testing.assert_allclose(depth, -found, rtol=0.0, atol=1e-3)
    gap = plane_gap(bodies_a, bodies_b, direction)
    assert (gap - found).min() > -1e-3
    assert np.median(abs(gap - found)) < 1e-8


@pytest.mark.parametrize("kinds", KIND_PAIRS, ids=PAIR_NAMES)
def test_deepest_points_lie_on_the_bodies(kinds):
    bodies_a, bodies_b, _, witnesses = overlapping_pairs(kinds, 60)
    for bodies, row in ((bodies_a, 0), (bodies_b, 1)):
        assert outside(bodies, witnesses[:, row]).max() < 1e-9


@pytest.mark.parametrize("kinds", KIND_PAIRS, ids=PAIR_NAMES)
def test_no_sampled_plane_parts_bodies_that_are_said_to_overlap(kinds):
    bodies_a, bodies_b, found, _ = overlapping_pairs(kinds, 40)
    rng = np.random.default_rng(11)
    for _ in range(200):
        direction = rng.normal(size=(len(found), 3))
        direction /= np.linalg.norm(direction, axis=1, keepdims=True)
        assert plane_gap(bodies_a, bodies_b, direction).max() < 1e-9


@pytest.mark.parametrize(
    ("pose", "depth"),
    [(at(0, 0, 0.9), 0.1), (at(0.95, 0.2, 0.1), 0.05), (HERE, 1.0)],
    ids=["above", "beside", "same place"],
)
def test_two_boxes_overlap_by_their_least_overlap(pose, depth):
    assert distance(UNIT_BOX, pose, UNIT_BOX, HERE).distance == pytest.approx(-depth, abs=1e-9)


@pytest.mark.parametrize("height", [0.55, 0.5, 0.45, 0.2, 0.0])
def test_sphere_in_a_box_is_as_deep_as_its_centre_and_its_radius(height):
    found = distance(Sphere(0.1), at(0.0, 0.1, height), UNIT_BOX, HERE)
    depth = 0.1 + min(0.5 - height, 0.4)
    assert found.distance == pytest.approx(-depth, abs=1e-9)


@pytest.mark.parametrize(("x", "z"), [(0.25, 0.0), (0.1, 0.0), (0.0, 0.35), (0.0, 0.0)])
def test_sphere_in_a_cylinder_leaves_by_the_nearer_of_side_and_end(x, z):
    found = distance(Sphere(0.1), at(x, 0.0, z), Cylinder(0.2, 0.6), HERE)
    assert found.distance == pytest.approx(-(0.1 + min(0.2 - x, 0.3 - abs(z))), abs=1e-9)


@pytest.mark.parametrize("lean", [0.0, 0.2, 1.0, math.pi / 2])
def test_wheel_that_dips_into_a_face_is_as_deep_as_its_rim(lean):
    wheel, dip = Cylinder(0.05, 0.02), 0.0005
    reach = 0.01 * math.cos(lean) + 0.05 * math.sin(lean)
    pose = at(0.1, 0.2, 0.5 + reach - dip, rotation_x(lean))
    assert distance(wheel, pose, UNIT_BOX, HERE).distance == pytest.approx(-dip, abs=1e-8)


def test_wheel_that_dips_into_the_sloped_face_of_a_hull():
    normal = np.array([1.0, 1.0, 0.0]) / math.sqrt(2.0)
    turn = np.column_stack([np.array([0.0, 0.0, 1.0]), np.cross(normal, [0.0, 0.0, 1.0]), normal])
    pose = rigid(turn, np.array([0.05, 0.05, 0.15]) + (0.01 - 0.0005) * normal)
    found = distance(Cylinder(0.02, 0.02), pose, WEDGE, HERE)
    assert found.distance == pytest.approx(-0.0005, abs=1e-8)


@pytest.mark.parametrize("shape", [Capsule(0.1, 0.4), Cylinder(0.1, 0.4)])
def test_crossed_pins_overlap_by_their_radii(shape):
    found = distance(
        shape,
        at(0, 0, 0.15, rotation_x(math.pi / 2)),
        Capsule(0.1, 0.4),
        at(0, 0, 0, rotation_y(math.pi / 2)),
    )
    assert found.distance == pytest.approx(-0.05, abs=1e-8)


@pytest.mark.parametrize(
    "shape", [Sphere(0.2), Capsule(0.2, 0.4), Cylinder(0.2, 0.4), UNIT_BOX, WEDGE]
)
@pytest.mark.parametrize(
    "other", [Sphere(0.2), Capsule(0.2, 0.4), Cylinder(0.2, 0.4), UNIT_BOX, WEDGE]
)
def test_bodies_in_the_same_place_overlap(shape, other):
    found = distance(shape, HERE, other, HERE)
    assert found.distance < -0.01
    assert np.isfinite(found.point_a).all()
    assert np.isfinite(found.point_b).all()


@pytest.mark.parametrize("kinds", KIND_PAIRS, ids=PAIR_NAMES)
def test_pose_that_is_not_a_number_counts_as_an_overlap(kinds):
    rng = np.random.default_rng(13)
    bodies_a, bodies_b = (random_bodies(rng, kind, 3, aligned=False) for kind in kinds)
    for axis in range(3):
        bodies_a.position[axis, axis] = np.nan
        witness = np.empty((2, 3))
        found = convex_distance(*bodies_a.body(axis), *bodies_b.body(axis), witness)
        assert found <= 0.0


FCL_PAIRS = [pair for pair in KIND_PAIRS if 4 not in pair]


@pytest.mark.parametrize("aligned", [False, True], ids=["random", "aligned"])
@pytest.mark.parametrize(
    "kinds", FCL_PAIRS, ids=[PAIR_NAMES[KIND_PAIRS.index(p)] for p in FCL_PAIRS]
)
def test_fcl_collides_where_and_only_where_bodies_overlap(kinds, aligned):
    rng = np.random.default_rng([17, *kinds, aligned])
    bodies = [random_bodies(rng, kind, 200, aligned=aligned) for kind in kinds]
    witness = np.empty((2, 3))
    seen = {True: 0, False: 0}
    for i in range(200):
        bodies[0].position[i] *= 0.4
        bodies[1].position[i] *= 0.4
        found = convex_distance(*bodies[0].body(i), *bodies[1].body(i), witness)
        if abs(found) > 1e-3:
            hit = fcl.collide(*(fcl_object(*body.body(i)) for body in bodies)) > 0
            assert hit == (found < 0.0)
            seen[hit] += 1
    assert min(seen.values()) > 10


def fcl_object(kind, size, _, rotation, position):
    x, y, z = size
    shape = (
        lambda: fcl.Sphere(x),
        lambda: fcl.Capsule(y, 2 * x),
        lambda: fcl.Cylinder(y, 2 * x),
        lambda: fcl.Box(2 * x, 2 * y, 2 * z),
    )[kind]()
    return fcl.CollisionObject(shape, fcl.Transform(rotation, position))
