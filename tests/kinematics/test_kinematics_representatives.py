"""Turns of a joint vector within limits, against brute force."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from solver.errors import InputError
from solver.kinematics import kernels_arm
from solver.kinematics.arm import principal, representative_capacity, representatives
from solver.model.settings import Turns

degrees = st.integers(-1800, 1800).map(lambda tenth: tenth / 10.0)
interval = st.tuples(st.integers(-450, 450), st.integers(0, 900)).map(
    lambda pair: (pair[0], pair[0] + pair[1])
)


def brute_force(joints, limits):
    """Every combination of up to three turns either way, filtered; in degrees and exact."""
    options = [
        [value + 360.0 * turn for turn in range(-4, 5) if low <= value + 360.0 * turn <= high]
        for value, (low, high) in zip(joints, limits, strict=True)
    ]
    return list(itertools.product(*options))


@given(
    joints=st.tuples(*[degrees] * 6),
    limits=st.tuples(*[interval] * 6),
)
def test_representatives_equal_brute_force_in_ascending_order(joints, limits):
    found = representatives(np.radians(joints), np.radians(limits))
    expected = brute_force(joints, limits)
    assert len(found) == len(expected)
    if expected:
        np.testing.assert_allclose(np.degrees(found), expected, atol=1e-9)
    assert len(expected) <= representative_capacity(np.radians(limits))


def test_posture_of_the_m20ia_may_have_eight_representatives(m20ia):
    joints = np.radians([10, 20, -180, -170, 30, 100])
    found = np.degrees(representatives(joints, m20ia.limits))
    expected = list(itertools.product([10], [20], [-180, 180], [-170, 190], [30], [-260, 100]))
    np.testing.assert_allclose(found, expected, atol=1e-9)
    assert representative_capacity(m20ia.limits) == 8


def test_joint_exactly_on_a_limit_after_a_turn_is_kept(m20ia):
    joints = np.radians([-170, 160, 273.12 - 360, -160, 140, -90])
    found = np.degrees(representatives(joints, m20ia.limits))
    expected = [
        [-170, 160, j3, j4, 140, j6]
        for j3 in (-86.88, 273.12)
        for j4 in (-160, 200)
        for j6 in (-90, 270)
    ]
    np.testing.assert_allclose(found, expected, atol=1e-9)


def test_joint_past_a_limit_by_rounding_only_is_kept(m20ia):
    joints = m20ia.limits[:, 1] + 5e-13
    assert len(representatives(joints, m20ia.limits)) > 0
    joints = m20ia.limits[:, 0] - 5e-13
    assert len(representatives(joints, m20ia.limits)) > 0


def test_joint_past_a_limit_by_more_than_rounding_is_dropped(m20ia):
    joints = np.radians([170, 0, 0, 0, 0, 0])
    joints[0] += 1e-11
    assert len(representatives(joints, m20ia.limits)) == 0


def test_only_the_principal_representative_is_kept_when_asked(m20ia):
    joints = np.radians([10, 20, 190, -170, 30, -260])
    found = representatives(joints, m20ia.limits, Turns.PRINCIPAL)
    np.testing.assert_allclose(np.degrees(found), [[10, 20, -170, -170, 30, 100]], atol=1e-9)


def test_principal_representative_outside_the_limits_is_none_at_all(m20ia):
    joints = np.radians([10, 20, 30, 40, 50, 60])
    limits = np.radians([[-180, 180]] * 5 + [[100, 500]])
    assert len(representatives(joints, limits, Turns.PRINCIPAL)) == 0
    assert len(representatives(joints, limits, Turns.ALL)) == 1


@given(st.lists(st.floats(-1000, 1000), min_size=1, max_size=6))
def test_principal_angles_lie_in_the_half_open_turn_and_differ_by_whole_turns(angles):
    wrapped = principal(angles)
    assert np.all(wrapped > -math.pi)
    assert np.all(wrapped <= math.pi)
    turns = (np.array(angles) - wrapped) / (2 * math.pi)
    np.testing.assert_allclose(turns, np.round(turns), atol=1e-12)


@pytest.mark.parametrize(("angle", "expected"), [(math.pi, math.pi), (-math.pi, math.pi)])
def test_both_half_turns_become_plus_half_a_turn(angle, expected):
    assert principal(angle) == expected


def test_too_few_rows_are_reported_and_never_silently_cut(m20ia):
    joints = np.radians([10.0, 20, -180, -170, 30, 100])
    out = np.empty((7, 6))
    assert kernels_arm.representatives(joints, m20ia.limits, False, out) == -1
    assert kernels_arm.representatives(joints, m20ia.limits, False, np.empty((8, 6))) == 8


@pytest.mark.parametrize("value", [math.nan, math.inf, 1e300])
def test_senseless_angles_and_limits_are_refused(m20ia, value):
    joints = np.array([0, 0, 0, 0, 0, value])
    with pytest.raises(InputError, match="finite"):
        representatives(joints, m20ia.limits)
    limits = m20ia.limits.copy()
    limits[5, 1] = value
    out = np.empty((8, 6))
    assert kernels_arm.representatives(np.zeros(6), limits, False, out) == -1


def test_wide_limits_on_every_joint_are_handled():
    limits = np.radians([[-450, 450]] * 6)
    assert representative_capacity(limits) == 3**6
    found = representatives(np.radians([90.0] * 6), limits)
    assert len(found) == 3**6
    np.testing.assert_allclose(np.unique(np.degrees(found).round(9)), [-270, 90, 450])
    assert [tuple(row) for row in found] == sorted(tuple(row) for row in found)
