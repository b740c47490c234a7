"""Every pair of kinds, random and axis-aligned, against planes, points, coal and a programme."""

import numpy as np
import pytest
from distance_oracle import (
    KIND_PAIRS,
    PAIR_NAMES,
    coal_distances,
    outside,
    plane_gap,
    programme_distance,
    random_bodies,
)

from solver.collision.kernels_distance import convex_distance

TOLERANCE = 1e-6
by_pair = pytest.mark.parametrize("kinds", KIND_PAIRS, ids=PAIR_NAMES)
by_placement = pytest.mark.parametrize("aligned", [False, True], ids=["random", "aligned"])


@pytest.fixture(scope="module")
def coal():
    return pytest.importorskip("coal", reason="coal has no wheels outside Linux")


def random_pairs(kinds, count, seed, *, aligned):
    rng = np.random.default_rng([seed, *kinds, aligned])
    return tuple(random_bodies(rng, kind, count, aligned=aligned) for kind in kinds)


def kernel_distances(bodies_a, bodies_b):
    count = len(bodies_a.size)
    found, witnesses = np.empty(count), np.empty((count, 2, 3))
    for i in range(count):
        found[i] = convex_distance(*bodies_a.body(i), *bodies_b.body(i), witnesses[i])
    return found, witnesses


def errors_of_separated(bodies_a, bodies_b, coal):
    """Over-statement of each pair that anyone holds to be separated [m], and the disputes.

    Where coal disagrees, the convex programme decides.
    """
    found, _ = kernel_distances(bodies_a, bodies_b)
    claimed = np.maximum(found, 0.0)
    error = claimed - np.maximum(coal_distances(coal, bodies_a, bodies_b), 0.0)
    disputes = np.flatnonzero(abs(error) > TOLERANCE)
    for i in disputes:
        error[i] = claimed[i] - max(programme_distance(bodies_a.body(i), bodies_b.body(i)), 0.0)
    return error[(found > 0.0) | (error < 0.0)], len(disputes)


@by_placement
@by_pair
def test_distance_is_exact_within_a_micrometre(kinds, aligned, coal):
    bodies_a, bodies_b = random_pairs(kinds, 300, 1, aligned=aligned)
    error, disputes = errors_of_separated(bodies_a, bodies_b, coal)
    assert len(error) > 100
    assert error.max() <= TOLERANCE
    assert error.min() >= -TOLERANCE
    assert disputes < 30


@by_placement
@by_pair
def test_distance_is_the_least_of_a_convex_programme(kinds, aligned):
    bodies_a, bodies_b = random_pairs(kinds, 8, 4, aligned=aligned)
    found, _ = kernel_distances(bodies_a, bodies_b)
    apart = np.flatnonzero(found > 0.0)
    assert len(apart) > 3
    for i in apart:
        truth = programme_distance(bodies_a.body(i), bodies_b.body(i))
        assert found[i] == pytest.approx(truth, rel=0.0, abs=TOLERANCE)


@by_placement
@by_pair
def test_a_plane_that_parts_the_bodies_proves_the_distance(kinds, aligned):
    bodies_a, bodies_b = random_pairs(kinds, 300, 2, aligned=aligned)
    found, witnesses = kernel_distances(bodies_a, bodies_b)
    clear = np.flatnonzero(found > 1e-4)
    assert len(clear) > 100
    between = witnesses[clear, 0] - witnesses[clear, 1]
    between /= np.linalg.norm(between, axis=1, keepdims=True)
    proven = plane_gap(bodies_a.rows(clear), bodies_b.rows(clear), between)
    assert (found[clear] - proven).max() <= TOLERANCE


@by_placement
@by_pair
def test_nearest_points_lie_on_the_bodies_as_far_apart_as_stated(kinds, aligned):
    bodies_a, bodies_b = random_pairs(kinds, 200, 3, aligned=aligned)
    found, witnesses = kernel_distances(bodies_a, bodies_b)
    apart = np.flatnonzero(found > 0.0)
    gap = np.linalg.norm(witnesses[apart, 0] - witnesses[apart, 1], axis=1)
    np.testing.assert_allclose(gap, found[apart], rtol=0.0, atol=TOLERANCE)
    for body, row in ((bodies_a, 0), (bodies_b, 1)):
        assert outside(body.rows(apart), witnesses[apart, row]).max() < 1e-9


@by_placement
@by_pair
def test_pairs_brought_together_along_their_nearest_points_keep_what_is_left(kinds, aligned):
    bodies_a, bodies_b = random_pairs(kinds, 200, 5, aligned=aligned)
    found, witnesses = kernel_distances(bodies_a, bodies_b)
    apart = np.flatnonzero(found > 1e-3)
    bodies_a, bodies_b = bodies_a.rows(apart), bodies_b.rows(apart)
    way = witnesses[apart, 1] - witnesses[apart, 0]
    length = np.linalg.norm(way, axis=1, keepdims=True)
    left = 10.0 ** np.random.default_rng(6).uniform(-8.0, -3.0, (len(apart), 1))
    near = bodies_a._replace(position=bodies_a.position + way * (1.0 - left / length))
    found, _ = kernel_distances(near, bodies_b)
    error = found - left[:, 0]
    assert error.max() < 1e-8
    assert error.min() > -TOLERANCE
    assert (found[left[:, 0] > TOLERANCE] > 0.0).all()


@pytest.mark.long
@by_placement
@by_pair
def test_a_hundred_thousand_pairs_are_exact_within_a_micrometre(kinds, aligned, coal):
    over = under = 0.0
    separated = disputes = 0
    for chunk in range(20):
        pairs = random_pairs(kinds, 5000, 100 + chunk, aligned=aligned)
        error, disputed = errors_of_separated(*pairs, coal)
        over, under = max(over, error.max()), max(under, -error.min())
        separated += len(error)
        disputes += disputed
    print(f"separated {separated}, over {over:.1e} m, under {under:.1e} m, disputes {disputes}")
    assert over <= TOLERANCE
    assert under <= TOLERANCE
