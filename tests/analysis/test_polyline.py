"""Distances to polylines and matching of points, against dense sampling and brute force."""

from itertools import combinations, combinations_with_replacement, pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize_scalar

from solver.analysis.polyline import match, project

COORDINATE = st.integers(-4, 4).map(float)
POINT = st.tuples(COORDINATE, COORDINATE, COORDINATE)


def points(least, most):
    return st.lists(POINT, min_size=least, max_size=most).map(np.array)


def distance_to_segment(point, start, end):
    """Minimum over the segment, found numerically."""
    found = minimize_scalar(
        lambda share: np.linalg.norm(point - start - share * (end - start)),
        bounds=(0.0, 1.0),
        method="bounded",
        options={"xatol": 1e-10},
    )
    ends = np.linalg.norm(point - start), np.linalg.norm(point - end)
    return min(float(found.fun), *ends)


@given(points(1, 3), points(1, 5))
def test_the_distance_is_that_of_the_nearest_segment(asked, line):
    near = project(asked, line)
    for row, point in enumerate(asked):
        segments = list(pairwise(line)) or [(line[0], line[0])]
        expected = min(distance_to_segment(point, *one) for one in segments)
        assert near.distance[row] == pytest.approx(expected, abs=1e-7)


@given(points(1, 3), points(1, 5))
def test_segment_and_share_name_the_point_that_is_so_far_away(asked, line):
    near = project(asked, line)
    assert ((near.share >= 0.0) & (near.share <= 1.0)).all()
    after = line[np.minimum(near.segment + 1, len(line) - 1)]
    foot = line[near.segment] + near.share[:, None] * (after - line[near.segment])
    np.testing.assert_allclose(np.linalg.norm(asked - foot, axis=1), near.distance, atol=1e-12)


def test_a_segment_of_no_length_is_a_point():
    line = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    near = project(np.array([[-3.0, 4.0, 0.0], [0.25, 1.0, 0.0]]), line)
    np.testing.assert_allclose(near.distance, [5.0, 1.0])
    assert near.segment[1] + near.share[1] == pytest.approx(1.25)


def test_where_two_segments_are_equally_near_the_first_is_named():
    corner = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]])
    near = project(np.array([[0.5, 0.5, 0.0]]), corner)
    assert near.segment[0] == 0


def least_sum(found, targets, choices):
    """Smallest sum of distances over all ways of choosing points for the targets."""
    away = np.linalg.norm(found[:, None] - targets[None], axis=2)
    return min(sum(away[row, column] for column, row in enumerate(one)) for one in choices)


@given(st.data())
def test_no_other_ascending_choice_is_nearer(data):
    strictly = data.draw(st.booleans())
    targets = data.draw(points(1, 4))
    found = data.draw(points(len(targets) if strictly else 1, 7))
    chosen = match(found, targets, strictly=strictly)
    steps = np.diff(chosen)
    assert (steps > 0).all() if strictly else (steps >= 0).all()
    assert ((chosen >= 0) & (chosen < len(found))).all()
    every = combinations if strictly else combinations_with_replacement
    expected = least_sum(found, targets, every(range(len(found)), len(targets)))
    actual = np.linalg.norm(found[chosen] - targets, axis=1).sum()
    assert actual == pytest.approx(expected, abs=1e-9)


def test_targets_in_the_other_order_share_one_point_or_come_apart():
    found = np.array([[0.0, 0, 0], [1.0, 0, 0], [2.0, 0, 0]])
    backward = found[::-1].copy()
    assert len(set(match(found, backward, strictly=False).tolist())) == 1
    assert match(found, backward, strictly=True).tolist() == [0, 1, 2]


def test_many_points_are_matched_to_themselves():
    random = np.random.default_rng(3)
    line = np.cumsum(random.uniform(0.0, 1.0, (2_000, 3)), axis=0)
    rows = np.sort(random.choice(2_000, 300, replace=False))
    assert match(line, line[rows], strictly=True).tolist() == rows.tolist()
