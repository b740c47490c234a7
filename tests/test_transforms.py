"""Rotations against scipy, and what FANUC's W P R keep."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from solver.transforms import (
    frozen,
    inverse,
    rigid,
    rotation_angle,
    rotation_from_normal_and_travel,
    rotation_from_quaternion,
    rotation_from_wpr,
    rotation_x,
    rotation_y,
    rotation_z,
    wpr_from_rotation,
)

angle = st.floats(-math.pi, math.pi)
tilt = st.floats(-math.pi / 2, math.pi / 2)
component = st.floats(-1.0, 1.0)
vector = st.tuples(component, component, component)
quaternion = st.tuples(component, component, component, component)


def length(values):
    return float(np.linalg.norm(values))


@pytest.mark.parametrize(
    ("axis", "turn"), [("x", rotation_x), ("y", rotation_y), ("z", rotation_z)]
)
def test_turns_about_the_axes_equal_scipys(axis, turn):
    for value in np.linspace(-7, 7, 29):
        expected = Rotation.from_euler(axis, value).as_matrix()
        np.testing.assert_allclose(turn(value), expected, atol=2e-16 * 8)


@given(angle, angle, angle)
def test_wpr_is_a_turn_about_fixed_x_then_y_then_z(w, p, r):
    expected = Rotation.from_euler("xyz", [w, p, r]).as_matrix()
    np.testing.assert_allclose(rotation_from_wpr(w, p, r), expected, atol=1e-15)


@given(angle, angle, angle)
def test_wpr_of_any_rotation_gives_the_rotation_back(w, p, r):
    rotation = rotation_from_wpr(w, p, r)
    again = rotation_from_wpr(*wpr_from_rotation(rotation))
    np.testing.assert_allclose(again, rotation, atol=1e-11)


@given(st.floats(-3.1, 3.1), st.floats(-1.5, 1.5), st.floats(-3.1, 3.1))
def test_wpr_away_from_gimbal_lock_gives_the_angles_back(w, p, r):
    assert wpr_from_rotation(rotation_from_wpr(w, p, r)) == pytest.approx((w, p, r), abs=1e-12)


@given(angle, st.sampled_from([math.pi / 2, -math.pi / 2]), angle)
def test_wpr_in_gimbal_lock_has_r_zero_and_gives_the_rotation_back(w, p, r):
    rotation = rotation_from_wpr(w, p, r)
    found = wpr_from_rotation(rotation)
    assert found[2] == 0.0
    assert found[1] == pytest.approx(p, abs=1e-12)
    np.testing.assert_allclose(rotation_from_wpr(*found), rotation, atol=1e-11)


@given(angle, st.floats(1e-13, 1e-3), st.sampled_from([-1, 1]), angle)
def test_wpr_close_to_gimbal_lock_gives_the_rotation_back(w, gap, side, r):
    rotation = rotation_from_wpr(w, side * (math.pi / 2 - gap), r)
    again = rotation_from_wpr(*wpr_from_rotation(rotation))
    np.testing.assert_allclose(again, rotation, atol=1e-11)


@given(angle, st.integers(-14, -3), st.sampled_from([-1, 1]), angle)
def test_wpr_close_to_gimbal_lock_gives_a_rounded_rotation_back(w, exponent, side, r):
    """W and R were once read independently, and missed such a rotation by up to 2e-4 rad."""
    exact = rotation_from_wpr(w, side * (math.pi / 2 - 10.0**exponent), r)
    other = rotation_from_wpr(0.3, 0.5, -0.7)
    rounded = other.T @ (other @ exact)
    again = rotation_from_wpr(*wpr_from_rotation(rounded))
    np.testing.assert_allclose(again, rounded, atol=1e-11)


def test_wpr_of_a_flange_that_looks_forward_is_written_without_negative_half_turns():
    w, p, r = wpr_from_rotation(np.array([[0.0, 0, 1], [0, -1, 0], [1, 0, 0]]))
    assert (w, p, r) == (math.pi, -math.pi / 2, 0.0)


@given(quaternion)
def test_quaternion_of_any_length_equals_scipys(wxyz):
    assume(length(wxyz) > 1e-3)
    w, x, y, z = wxyz
    expected = Rotation.from_quat([x, y, z, w]).as_matrix()
    np.testing.assert_allclose(rotation_from_quaternion(w, x, y, z), expected, atol=2e-15)


@given(vector, vector)
def test_reference_orientation_has_z_into_the_surface_and_y_along_the_travel(normal, travel):
    assume(length(normal) > 1e-3)
    assume(length(travel) > 1e-3)
    assume(length(np.cross(normal, travel)) > 1e-3 * length(normal) * length(travel))
    x, y, z = rotation_from_normal_and_travel(normal, travel).T
    np.testing.assert_allclose(z, -np.array(normal) / length(normal), atol=1e-14)
    np.testing.assert_allclose([x @ y, y @ z, z @ x], 0.0, atol=1e-12)
    np.testing.assert_allclose([length(x), length(y), length(z)], 1.0, atol=1e-12)
    np.testing.assert_allclose(np.cross(y, z), x, atol=1e-12)
    # y is the travel's direction within the surface.
    assert y @ np.array(travel) > 0.0
    assert abs(np.array(travel) @ x) < 1e-12 * length(travel) / 1e-3


def test_reference_orientation_of_a_pass_along_y_on_top_of_a_plate():
    expected = np.column_stack([[-1, 0, 0], [0, 1, 0], [0, 0, -1]])
    found = rotation_from_normal_and_travel((0, 0, 2), (0, 3, 0.5))
    np.testing.assert_allclose(found, expected, atol=1e-15)


@given(vector, st.one_of(st.floats(0.0, 3.14), st.floats(1e-14, 1e-3)))
def test_angle_of_a_rotation_is_accurate_down_to_the_smallest(axis, value):
    assume(length(axis) > 1e-2)
    direction = np.array(axis) / length(axis)
    rotation = Rotation.from_rotvec(direction * value).as_matrix()
    assert rotation_angle(rotation) == pytest.approx(value, rel=1e-9, abs=1e-15)


@given(vector, angle, angle, angle)
def test_inverse_of_a_rigid_transform_undoes_it(position, w, p, r):
    transform = rigid(rotation_from_wpr(w, p, r), position)
    np.testing.assert_allclose(inverse(transform) @ transform, np.eye(4), atol=1e-14)


def test_inverse_of_many_transforms_is_each_ones_inverse():
    poses = np.stack([rigid(rotation_x(0.1 * k), (k, 2 * k, 3)) for k in range(6)])
    found = inverse(poses.reshape(2, 3, 4, 4)).reshape(6, 4, 4)
    np.testing.assert_allclose(found, np.linalg.inv(poses), atol=1e-14)


def test_frozen_arrays_are_copies_that_cannot_be_written_and_have_the_asked_shape():
    source = np.zeros((2, 3))
    copy = frozen(source, (-1, 3))
    source[0, 0] = 7.0
    assert copy[0, 0] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        copy[0, 0] = 1.0
    with pytest.raises(ValueError, match="shape"):
        frozen(source, (3, 3))
