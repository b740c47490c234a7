"""Distances that can be worked out by hand."""

import math

import numpy as np
import pytest

from solver.collision.distance import distance, pack_shape
from solver.errors import ModelError
from solver.model.shapes import Box, Capsule, Cylinder, Hull, Mesh, Sphere
from solver.transforms import rigid, rotation_x, rotation_y, rotation_z

UNIT_BOX = Box(np.ones(3))
CUBE_HULL = Hull(np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * 0.5)
HERE = np.eye(4)


def at(x, y, z, rotation=None):
    return rigid(rotation, np.array([x, y, z]))


@pytest.mark.parametrize("shape", [UNIT_BOX, CUBE_HULL], ids=["box", "hull"])
@pytest.mark.parametrize("axis", range(3))
def test_unit_cubes_four_metres_apart_are_three_apart_as_fcl_issue_508_gets_wrong(shape, axis):
    offset = np.zeros(3)
    offset[axis] = 4.0
    assert distance(UNIT_BOX, HERE, shape, at(*offset)).distance == pytest.approx(3.0, abs=1e-12)


@pytest.mark.parametrize(
    ("offset", "expected"),
    [((0, 0, 2), 1.0), ((0, 1.3, 1.4), 0.5), ((1.3, 1.4, 3.0), math.sqrt(0.09 + 0.16 + 4.0))],
    ids=["face", "edge", "corner"],
)
def test_aligned_boxes_are_as_far_apart_as_their_nearest_features(offset, expected):
    assert distance(UNIT_BOX, HERE, UNIT_BOX, at(*offset)).distance == pytest.approx(expected)


@pytest.mark.parametrize(
    ("x", "y", "expected"),
    [
        (0.0, 0.0, 0.2),
        (0.7, 0.0, math.hypot(0.1, 0.2)),
        (0.59, 0.0, 0.2),
        (0.8, 0.9, math.hypot(0.5 - 0.1, 0.2)),
    ],
    ids=["over the face", "past the edge", "rim still over the face", "past the corner"],
)
def test_upright_cylinder_above_a_box(x, y, expected):
    pin = Cylinder(radius=0.1, length=0.4)
    found = distance(pin, at(x, y, 0.9), UNIT_BOX, HERE)
    assert found.distance == pytest.approx(expected, abs=1e-8)


@pytest.mark.parametrize("lean", [0.0, 1e-9, 1e-6, 0.01, 0.5, 1.2, math.pi / 2])
def test_leaning_cylinder_touches_a_face_first_with_its_rim(lean):
    radius, half, height = 0.05, 0.2, 0.9
    reach = half * math.cos(lean) + radius * math.sin(lean)
    pose = at(0.05, -0.1, height, rotation_z(0.7) @ rotation_x(lean))
    found = distance(Cylinder(radius, 2 * half), pose, UNIT_BOX, HERE)
    assert found.distance == pytest.approx(height - 0.5 - reach, abs=1e-8)
    assert found.point_a[2] == pytest.approx(height - reach, abs=1e-8)
    assert found.point_b[2] == pytest.approx(0.5, abs=1e-12)


@pytest.mark.parametrize("shape", [Cylinder, Capsule])
def test_side_of_an_upright_pin_beside_a_box(shape):
    pin = shape(radius=0.05, length=0.2)
    found = distance(pin, at(0.9, 0.1, 0.2), UNIT_BOX, HERE)
    assert found.distance == pytest.approx(0.35, abs=1e-9)


def test_flat_end_leaves_the_room_that_a_capsule_would_take():
    flat, round_ended = Cylinder(radius=0.1, length=0.4), Capsule(radius=0.1, length=0.4)
    above = at(0.0, 0.0, 0.9)
    assert distance(flat, above, UNIT_BOX, HERE).distance == pytest.approx(0.2, abs=1e-9)
    assert distance(round_ended, above, UNIT_BOX, HERE).distance == pytest.approx(0.1, abs=1e-12)


@pytest.mark.parametrize(
    ("pose", "expected"),
    [
        (at(0.5, 0.0, 0.0), 0.2),
        (at(0.0, 0.0, 1.0), 0.6),
        (at(0.3, 0.4, 0.0), 0.2),
        (at(0.5, 0.0, 0.7), math.hypot(0.2, 0.3)),
        (at(0.0, 0.6, 0.0, rotation_y(math.pi / 2)), 0.3),
        (at(0.6, 0.0, 0.0, rotation_y(math.pi / 2)), 0.2),
    ],
    ids=["side by side", "stacked", "diagonal", "rim to rim", "crossed", "end against side"],
)
def test_two_cylinders(pose, expected):
    found = distance(Cylinder(0.1, 0.4), pose, Cylinder(0.2, 0.4), HERE)
    assert found.distance == pytest.approx(expected, abs=1e-8)


@pytest.mark.parametrize(
    ("position", "expected"),
    [((0.5, 0, 0), 0.2), ((0, 0, 0.5), 0.2), ((0.5, 0, 0.6), math.hypot(0.3, 0.4) - 0.1)],
    ids=["side", "end", "rim"],
)
def test_sphere_about_a_cylinder(position, expected):
    found = distance(Sphere(0.1), at(*position), Cylinder(0.2, 0.4), HERE)
    assert found.distance == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize(
    ("position", "expected"),
    [((0.7, 0, 0), 0.1), ((0.8, 0.9, 0), 0.4), ((0.9, 0.9, 0.7), 0.5)],
    ids=["face", "edge", "corner"],
)
@pytest.mark.parametrize("box", [UNIT_BOX, CUBE_HULL], ids=["box", "hull"])
def test_sphere_about_a_box(box, position, expected):
    found = distance(Sphere(0.1), at(*position), box, HERE)
    assert found.distance == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize(
    ("pose", "expected"),
    [
        (at(0.5, 0.0, 0.0), 0.2),
        (at(0.5, 0.0, 0.9), math.hypot(0.5, 0.4) - 0.3),
        (at(0.0, 0.0, 1.0), 0.2),
        (at(0.0, 0.5, 0.1, rotation_y(math.pi / 2)), 0.2),
        (at(0.8, 0.0, 0.0, rotation_y(math.pi / 2)), 0.25),
    ],
    ids=["parallel", "parallel and shifted", "in line", "crossed", "end against side"],
)
def test_two_capsules(pose, expected):
    found = distance(Capsule(0.1, 0.5), pose, Capsule(0.2, 0.5), HERE)
    assert found.distance == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("gap", [1e-3, 1e-5, 1e-7, 1e-8])
@pytest.mark.parametrize(
    "shape", [Sphere(0.2), Capsule(0.1, 0.2), Cylinder(0.3, 0.4), Box(np.full(3, 0.4))]
)
def test_sign_is_right_on_both_sides_of_touching(shape, gap):
    assert distance(shape, at(0.1, 0.1, 0.7 + gap), UNIT_BOX, HERE).distance > 0.0
    assert distance(shape, at(0.1, 0.1, 0.7 - gap), UNIT_BOX, HERE).distance < 0.0


def test_three_millimetre_pin_three_metres_away():
    pin = Cylinder(radius=0.003, length=0.006)
    found = distance(pin, at(3.0, 0.0, 0.0), UNIT_BOX, HERE)
    assert found.distance == pytest.approx(3.0 - 0.5 - 0.003, abs=1e-9)


def test_mesh_is_refused_as_not_convex():
    mesh = Mesh(np.eye(3), np.array([[0, 1, 2]]))
    with pytest.raises(TypeError, match="Mesh is not a convex shape"):
        pack_shape(mesh)


@pytest.mark.parametrize(
    "pose",
    [np.full((4, 4), np.nan), np.diag([2.0, 2.0, 2.0, 1.0]), np.diag([1.0, 1.0, -1.0, 1.0])],
    ids=["not a number", "scaled", "mirrored"],
)
def test_pose_that_is_no_rigid_transform_is_refused(pose):
    with pytest.raises(ModelError, match="the pose of the second shape"):
        distance(UNIT_BOX, HERE, UNIT_BOX, pose)
