"""The closed forms against plain numpy twins that search instead of solving."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from solver.collision.kernels_closed import (
    point_in_cylinder,
    segment_to_box,
    segment_to_segment,
)
from solver.collision.kernels_simplex import edge_weight, tetrahedron_weights, triangle_weights

coordinates = st.sampled_from([0.0, 0.1, -0.3, 1.0]) | st.floats(-2.0, 2.0)
points = st.tuples(*[coordinates] * 3).map(np.array)
half_lengths = st.sampled_from([0.1, 0.3, 1.0]) | st.floats(0.001, 1.0)
directions = (
    st.tuples(*[st.integers(-1, 1) | st.floats(-1.0, 1.0)] * 3)
    .map(lambda v: np.array(v, dtype=float))
    .filter(lambda v: np.linalg.norm(v) > 0.1)
    .map(lambda v: v / np.linalg.norm(v))
)


def least_over_interval(function, low, high):
    """Least value of a convex function of one number, by ever finer sampling."""
    for _ in range(12):
        samples = np.linspace(low, high, 41)
        values = np.array([function(x) for x in samples])
        best = int(values.argmin())
        low, high = samples[max(best - 1, 0)], samples[min(best + 1, 40)]
    return float(values.min())


def box_gap(point, half):
    return float(np.linalg.norm(np.maximum(abs(point) - half, 0.0)))


@settings(max_examples=60, deadline=None)
@given(points, directions, half_lengths, st.tuples(*[half_lengths] * 3).map(np.array))
def test_point_of_a_segment_nearest_to_a_box(centre, axis, half, box):
    s = segment_to_box(*centre, *axis, half, *box)
    assert -half <= s <= half
    searched = least_over_interval(lambda x: box_gap(centre + x * axis, box), -half, half)
    assert box_gap(centre + s * axis, box) == pytest.approx(searched, abs=1e-9)


@settings(max_examples=60, deadline=None)
@given(points, directions, half_lengths, directions, half_lengths)
def test_nearest_points_of_two_segments(centre, a, half_a, b, half_b):
    def to_second(x):
        p = centre + x * a
        return float(np.linalg.norm(p - np.clip(p @ b, -half_b, half_b) * b))

    s, t = segment_to_segment(*centre, *a, half_a, *b, half_b)
    assert abs(s) <= half_a
    assert abs(t) <= half_b
    searched = least_over_interval(to_second, -half_a, half_a)
    assert np.linalg.norm(centre + s * a - t * b) == pytest.approx(searched, abs=1e-9)


@pytest.mark.parametrize("turn", [0.0, 1e-12, 1e-9, 1e-6, 1e-3])
def test_nearly_parallel_segments_keep_their_distance(turn):
    b = np.array([0.0, 0.0, 1.0])
    a = np.array([np.sin(turn), 0.0, np.cos(turn)])
    s, t = segment_to_segment(0.0, 0.25, 0.1, *a, 1.0, *b, 1.0)
    gap = np.linalg.norm(np.array([0.0, 0.25, 0.1]) + s * a - t * b)
    assert gap == pytest.approx(0.25, abs=1e-12)


@settings(max_examples=60, deadline=None)
@given(points, half_lengths, half_lengths)
def test_point_of_a_cylinder_nearest_to_a_point(point, half, radius):
    nearest = np.array(point_in_cylinder(*point, half, radius))
    across = max(np.hypot(point[0], point[1]) - radius, 0.0)
    expected = np.hypot(across, max(abs(point[2]) - half, 0.0))
    assert np.linalg.norm(point - nearest) == pytest.approx(expected, abs=1e-12)
    assert np.hypot(nearest[0], nearest[1]) <= radius * (1 + 1e-12)
    assert abs(nearest[2]) <= half


@settings(max_examples=60, deadline=None)
@given(st.lists(points, min_size=4, max_size=4), st.integers(0, 10**6))
def test_no_point_of_a_simplex_is_nearer_to_the_origin_than_the_one_found(corners, seed):
    corners = np.array(corners)
    mixtures = np.random.default_rng(seed).dirichlet(np.full(4, 0.3), 300)
    for count in (2, 3, 4):
        if count == 2:
            weight = edge_weight(tuple(corners[0]), tuple(corners[1]))
            weights = np.array([1.0 - weight, weight])
        elif count == 3:
            weights = np.array(triangle_weights(*map(tuple, corners[:3]))[:3])
        else:
            weights = np.array(tetrahedron_weights(*map(tuple, corners)))
            if weights.sum() > 1.5:
                solved = np.linalg.solve(np.vstack([corners.T, np.ones(4)]), [0, 0, 0, 1])
                assert solved.min() > -1e-9
                continue
        assert weights.min() >= 0.0
        assert weights.sum() == pytest.approx(1.0)
        found = np.linalg.norm(weights @ corners[:count])
        mixed = mixtures[:, :count] + 1e-300
        mixed /= mixed.sum(axis=1, keepdims=True)
        assert found <= np.linalg.norm(mixed @ corners[:count], axis=1).min() + 1e-9
