"""What holds for any two bodies, however they stand."""

import math

import numpy as np
import pytest
from distance_oracle import KIND_PAIRS, PAIR_NAMES, random_bodies
from hypothesis import given, settings
from hypothesis import strategies as st

from solver.collision.distance import distance
from solver.collision.kernels_bound import quick_lower_bound, row_lower_bound
from solver.collision.kernels_distance import convex_distance, row_distance
from solver.collision.packed import PackedBodies
from solver.model.shapes import Box, Capsule, Cylinder, Hull, Sphere
from solver.transforms import rigid, rotation_from_quaternion

by_pair = pytest.mark.parametrize("kinds", KIND_PAIRS, ids=PAIR_NAMES)

lengths = st.floats(0.003, 1.0)
shapes = st.one_of(
    st.builds(Sphere, lengths),
    st.builds(Capsule, lengths, lengths),
    st.builds(Cylinder, lengths, lengths),
    st.builds(lambda *size: Box(np.array(size)), lengths, lengths, lengths),
    st.builds(
        lambda *size: Hull(np.vstack([np.zeros(3), np.diag(size), np.array(size)])),
        lengths,
        lengths,
        lengths,
    ),
)
quaternions = st.tuples(*[st.integers(-3, 3) | st.floats(-1, 1)] * 4).filter(
    lambda q: math.hypot(*q) > 0.1
)
places = st.tuples(*[st.sampled_from([0.0, 0.5, -1.0]) | st.floats(-2.0, 2.0)] * 3)
poses = st.builds(
    lambda q, p: rigid(rotation_from_quaternion(*q), np.array(p)), quaternions, places
)


def packed_rows(bodies):
    count, each = bodies.vertices.shape[:2]
    start = np.arange(count) * each
    kinds = np.full(count, bodies.kind)
    # A type of the product: kernels remember the types they met, in their cache on disk.
    return PackedBodies(
        kinds,
        bodies.size,
        bodies.rotation,
        bodies.position,
        start,
        start + each,
        bodies.vertices.reshape(-1, 3),
    )


def random_pairs(kinds, count=60):
    rng = np.random.default_rng([5, *kinds])
    return [random_bodies(rng, kind, count, aligned=False) for kind in kinds]


@settings(max_examples=80, deadline=None)
@given(shapes, poses, shapes, poses)
def test_distance_and_points_are_the_same_seen_from_the_other_body(a, pose_a, b, pose_b):
    one, other = distance(a, pose_a, b, pose_b), distance(b, pose_b, a, pose_a)
    if one.distance > 0.0:
        assert other.distance == pytest.approx(one.distance, abs=2e-8)
        gap = np.linalg.norm(other.point_a - other.point_b)
        assert gap == pytest.approx(one.distance, abs=1e-6)
    else:
        assert other.distance < 1e-8


@settings(max_examples=80, deadline=None)
@given(shapes, poses, shapes, poses, poses)
def test_distance_does_not_change_when_both_bodies_are_moved_alike(a, pose_a, b, pose_b, motion):
    still = distance(a, pose_a, b, pose_b)
    moved = distance(a, motion @ pose_a, b, motion @ pose_b)
    if still.distance > 0.0:
        assert moved.distance == pytest.approx(still.distance, abs=2e-8)
        gap = np.linalg.norm(moved.point_a - moved.point_b)
        assert gap == pytest.approx(still.distance, abs=1e-6)
    else:
        assert moved.distance < 1e-8


@settings(max_examples=80, deadline=None)
@given(shapes, poses, shapes, poses, st.floats(1e-6, 0.5))
def test_drawing_bodies_apart_along_their_nearest_points_adds_that_much(a, pose_a, b, pose_b, way):
    first = distance(a, pose_a, b, pose_b)
    if first.distance > 1e-3:
        direction = (first.point_a - first.point_b) / first.distance
        further = rigid(pose_a[:3, :3], pose_a[:3, 3] + way * direction)
        assert distance(a, further, b, pose_b).distance == pytest.approx(
            first.distance + way, abs=1e-6
        )


@by_pair
def test_quick_bound_never_exceeds_the_distance(kinds):
    bodies_a, bodies_b = random_pairs(kinds, 300)
    witness = np.empty((2, 3))
    tight = 0
    for i in range(300):
        kind_a, size_a, _, *pose_a = bodies_a.body(i)
        kind_b, size_b, _, *pose_b = bodies_b.body(i)
        exact = convex_distance(*bodies_a.body(i), *bodies_b.body(i), witness)
        quick = quick_lower_bound(kind_a, size_a, *pose_a, kind_b, size_b, *pose_b)
        assert quick <= max(exact, 0.0) + 1e-12
        tight += quick > 0.3 * exact > 0.0
    assert tight > 30


@by_pair
def test_rows_of_packed_bodies_give_the_same_numbers(kinds):
    bodies_a, bodies_b = random_pairs(kinds)
    rows_a, rows_b = packed_rows(bodies_a), packed_rows(bodies_b)
    poses_a, poses_b = bodies_a[3:], bodies_b[3:]
    single, row = np.empty((2, 3)), np.empty((2, 3))
    for i in range(60):
        exact = convex_distance(*bodies_a.body(i), *bodies_b.body(i), single)
        found = row_distance(rows_a, *poses_a, i, rows_b, *poses_b, i, math.inf, True, row)
        assert found == exact
        np.testing.assert_array_equal(row, single)
        quick = row_lower_bound(
            rows_a.kind, rows_a.size, *poses_a, i, rows_b.kind, rows_b.size, *poses_b, i
        )
        kind_a, size_a, _, *pose_a = bodies_a.body(i)
        kind_b, size_b, _, *pose_b = bodies_b.body(i)
        assert quick == quick_lower_bound(kind_a, size_a, *pose_a, kind_b, size_b, *pose_b)


@by_pair
@pytest.mark.parametrize("cutoff", [-0.01, 0.05, 0.5])
def test_cutoff_gives_the_distance_below_it_and_a_lower_bound_above_it(kinds, cutoff):
    bodies_a, bodies_b = random_pairs(kinds)
    rows_a, rows_b = packed_rows(bodies_a), packed_rows(bodies_b)
    poses_a, poses_b = bodies_a[3:], bodies_b[3:]
    witness = np.empty((2, 3))
    for i in range(60):
        exact = convex_distance(*bodies_a.body(i), *bodies_b.body(i), witness)
        found = row_distance(rows_a, *poses_a, i, rows_b, *poses_b, i, cutoff, False, witness)
        assert (found > 0.0) == (exact > 0.0)
        if exact > cutoff and exact > 0.0:
            assert cutoff - 1e-8 < found <= exact + 1e-8
        elif exact > 0.0:
            assert found == pytest.approx(exact, abs=1e-8)
