from __future__ import annotations

import math

import numpy as np
import pytest
from mesh_oracle import (
    hull_mesh,
    moved,
    random_pose,
    random_solid,
    surfaces_cross,
    triangle_distance,
)

from solver.collision.mesh_distance import (
    MeshObstacle,
    clearances,
    lower_bounds,
    mesh_clearance,
)
from solver.collision.mesh_proxy import ConvexProxy, box_triangles
from solver.errors import InputError, ModelError
from solver.model.shapes import Box, Capsule, Cylinder, Hull, Mesh, Sphere

SOLIDS = ("box", "cylinder", "torus", "beam", "hull")
SHAPES = ("sphere", "capsule", "cylinder", "box", "hull")
TOLERANCE = 2e-4


def random_shape(rng, kind):
    """A shape, triangles or a segment that stand for it, the radius about these, their deficit."""
    a, b, c = rng.uniform(0.03, 0.3, 3)
    point = np.zeros((1, 3, 3))
    if kind == "sphere":
        return Sphere(a), point, a, 0.0
    if kind == "capsule":
        ends = np.array([[0, 0, -c], [0, 0, c], [0, 0, c]]) / 2.0
        return Capsule(a, c), ends[None], a, 0.0
    if kind == "cylinder":
        sides = 48
        angle = 2.0 * np.pi * np.arange(sides) / sides
        ring = a * np.column_stack([np.cos(angle), np.sin(angle)])
        rings = [np.column_stack([ring, np.full(sides, z)]) for z in (-c / 2, c / 2)]
        vertices, faces = hull_mesh(np.vstack(rings))
        return Cylinder(a, c), vertices[faces], 0.0, a * (1.0 - math.cos(math.pi / sides))
    if kind == "box":
        signs = np.array(np.meshgrid((-1, 1), (-1, 1), (-1, 1))).reshape(3, 8).T
        vertices, faces = hull_mesh(signs * np.array([a, b, c]) / 2)
        return Box(np.array([a, b, c])), vertices[faces], 0.0, 0.0
    vertices, faces = hull_mesh(rng.normal(size=(12, 3)) * a / 2)
    return Hull(vertices), vertices[faces], 0.0, 0.0


def check_against_brute_force(solid_kind, shape_kind, square, trials):
    """Compare random separated pairs; returns how many there were."""
    rng = np.random.default_rng([SOLIDS.index(solid_kind), SHAPES.index(shape_kind), square])
    checked = 0
    for _ in range(trials):
        vertices, faces = random_solid(rng, solid_kind)
        shape, pieces, radius, deficit = random_shape(rng, shape_kind)
        home, pose = (random_pose(rng, s, square=square) for s in (0.3, 0.9))
        solid, body = moved(home, vertices[faces]), moved(pose, pieces)
        true = triangle_distance(body, solid) - radius
        if true < 1e-4 or surfaces_cross(body, solid):
            continue
        centre = moved(pose, np.zeros(3))
        if winding(centre, solid) > 0.5 or winding(solid[0, 0], body) > 0.5:
            continue
        checked += 1
        found = mesh_clearance(
            ConvexProxy(shape, TOLERANCE), pose, MeshObstacle(Mesh(vertices, faces), home)
        )
        assert found.distance <= true + 1e-9
        assert found.distance >= true - deficit - TOLERANCE - 1e-6
        between = np.linalg.norm(found.point_on_body - found.point_on_mesh)
        assert between == pytest.approx(found.distance, abs=1e-9)
        onto = triangle_distance(np.broadcast_to(found.point_on_mesh, (1, 3, 3)), solid)
        assert onto < 1e-9
    return checked


@pytest.mark.parametrize("square", [False, True], ids=["turned", "square"])
@pytest.mark.parametrize("shape_kind", SHAPES)
@pytest.mark.parametrize("solid_kind", SOLIDS)
def test_mesh_clearance_is_at_most_brute_force_and_less_by_at_most_the_tolerance(
    solid_kind, shape_kind, square
):
    assert check_against_brute_force(solid_kind, shape_kind, square, 8) >= 1


@pytest.mark.long
@pytest.mark.parametrize("square", [False, True], ids=["turned", "square"])
@pytest.mark.parametrize("shape_kind", SHAPES)
@pytest.mark.parametrize("solid_kind", SOLIDS)
def test_mesh_clearance_holds_against_brute_force_on_many_pairs(solid_kind, shape_kind, square):
    assert check_against_brute_force(solid_kind, shape_kind, square, 1000) >= 200


def winding(point, triangles):
    """Winding number by solid angles; triangles of zero size count nothing."""
    a, b, c = np.moveaxis(triangles - point, 1, 0)
    la, lb, lc = (np.linalg.norm(v, axis=1) for v in (a, b, c))
    spat = (a * np.cross(b, c)).sum(1)
    rest = la * lb * lc + (a * b).sum(1) * lc + (b * c).sum(1) * la + (c * a).sum(1) * lb
    return np.arctan2(spat, rest).sum() / (2 * np.pi)


def unit_box_obstacle():
    return MeshObstacle(Mesh(*box_triangles(np.ones(3))), np.eye(4))


def at(x=0.0, y=0.0, z=0.0):
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


@pytest.mark.parametrize("gap", [1e-9, 1e-6, 1e-3, 0.05, 3.0])
@pytest.mark.parametrize("axis", range(3))
def test_clearance_from_a_box_mesh_is_the_closed_form_down_to_a_nanometre(axis, gap):
    obstacle = unit_box_obstacle()
    shapes = {
        Sphere(0.2): 0.2,
        Capsule(0.1, 0.6): (0.1, 0.1, 0.4)[axis],
        Box(np.array([0.2, 0.4, 0.6])): (0.1, 0.2, 0.3)[axis],
    }
    for shape, half in shapes.items():
        pose = np.eye(4)
        pose[axis, 3] = 0.5 + gap + half
        found = mesh_clearance(ConvexProxy(shape), pose, obstacle)
        assert gap - 1e-6 <= found.distance <= gap + 1e-12
    pose = np.eye(4)
    pose[axis, 3] = 0.5 + gap + (0.2, 0.2, 0.3)[axis]
    found = mesh_clearance(ConvexProxy(Cylinder(0.2, 0.6)), pose, obstacle)
    assert gap - TOLERANCE <= found.distance <= gap + 1e-12


def test_unit_boxes_four_metres_apart_in_y_are_three_metres_from_each_other():
    found = mesh_clearance(ConvexProxy(Box(np.ones(3))), at(y=4.0), unit_box_obstacle())
    assert found.distance == pytest.approx(3.0, abs=1e-12)


@pytest.mark.parametrize(
    "shape",
    [Sphere(0.1), Capsule(0.05, 0.2), Cylinder(0.05, 0.2), Box(np.full(3, 0.2))],
    ids=lambda shape: type(shape).__name__,
)
def test_a_body_wholly_inside_a_mesh_overlaps(shape):
    found = mesh_clearance(ConvexProxy(shape), at(0.1, 0.05, -0.02), unit_box_obstacle())
    assert found.distance < -0.1


@pytest.mark.parametrize(
    "shape",
    [
        Sphere(2.0),
        Capsule(2.0, 0.2),
        Cylinder(2.0, 3.0),
        Box(np.full(3, 4.0)),
        Hull(2.0 * np.array(np.meshgrid((-1, 1), (-1, 1), (-1, 1))).reshape(3, 8).T),
    ],
    ids=lambda shape: type(shape).__name__,
)
@pytest.mark.parametrize("x", [0.05, 0.9])
def test_a_mesh_wholly_inside_a_body_overlaps_wherever_it_lies(shape, x):
    found = mesh_clearance(ConvexProxy(shape), at(x, 0.02, 0.03), unit_box_obstacle())
    assert found.distance < -0.5


def test_one_of_several_bodies_of_a_mesh_inside_a_convex_body_is_found():
    vertices, faces = box_triangles(np.ones(3))
    small = 0.1 * vertices + np.array([5.0, 0.0, 0.0])
    both = Mesh(np.vstack([vertices, small]), np.vstack([faces, faces + 8]))
    obstacle = MeshObstacle(both, np.eye(4))
    found = mesh_clearance(ConvexProxy(Box(np.ones(3))), at(5.3), obstacle)
    assert found.distance < 0.0


def test_a_body_in_a_cavity_is_clear_of_the_walls():
    vertices, faces = box_triangles(np.ones(3))
    hollow = Mesh(np.vstack([vertices, 0.5 * vertices]), np.vstack([faces, faces[:, ::-1] + 8]))
    found = mesh_clearance(ConvexProxy(Sphere(0.1)), at(0.05), MeshObstacle(hollow, np.eye(4)))
    assert found.distance == pytest.approx(0.25 - 0.05 - 0.1, abs=1e-6)


def test_a_body_in_the_groove_of_a_beam_is_outside_though_the_beam_surrounds_its_box():
    vertices, faces = random_solid(np.random.default_rng(0), "beam")
    obstacle = MeshObstacle(Mesh(vertices, faces), np.eye(4))
    found = mesh_clearance(ConvexProxy(Sphere(0.02)), at(0.0, 0.06), obstacle)
    assert found.distance == pytest.approx(0.06 - 0.01 - 0.02, abs=1e-6)


def test_a_ball_that_enters_a_flat_face_is_as_deep_as_it_reaches():
    found = mesh_clearance(ConvexProxy(Sphere(0.05)), at(0.5 + 0.048), unit_box_obstacle())
    assert found.distance == pytest.approx(-0.002, abs=1e-6)


def test_the_depth_of_a_disc_that_enters_edge_on_is_not_cut_to_its_thickness():
    disc = ConvexProxy(Cylinder(0.06, 0.004))
    found = mesh_clearance(disc, at(0.5 + 0.04), unit_box_obstacle())
    assert found.distance == pytest.approx(-0.02, abs=2 * TOLERANCE)
    assert found.point_on_body[0] == pytest.approx(0.48, abs=2 * TOLERANCE)


@pytest.mark.parametrize("seed", range(4))
def test_a_depth_is_never_less_than_the_way_that_parts_two_boxes(seed):
    rng = np.random.default_rng(seed)
    obstacle = unit_box_obstacle()
    proxy = ConvexProxy(Box(rng.uniform(0.1, 0.5, 3)))
    for _ in range(10):
        pose = random_pose(rng, 0.55, square=True)
        half = np.abs(pose[:3, :3]) @ proxy.shape.size / 2
        needed = (0.5 + half - np.abs(pose[:3, 3])).min()
        found = mesh_clearance(proxy, pose, obstacle).distance
        if needed > 0.0:
            assert found <= -needed + 1e-9
        else:
            assert found >= 0.0


def test_bounds_by_boxes_never_exceed_the_clearance():
    rng = np.random.default_rng(5)
    for kind in SHAPES:
        shape, *_ = random_shape(rng, kind)
        proxy = ConvexProxy(shape)
        obstacle = MeshObstacle(
            Mesh(*random_solid(rng, "beam")), random_pose(rng, 0.5, square=False)
        )
        poses = np.array([random_pose(rng, 1.5, square=False) for _ in range(20)])
        true = [mesh_clearance(proxy, pose, obstacle).distance for pose in poses]
        bounds = lower_bounds(proxy, poses, obstacle)
        assert (bounds <= np.array(true) + 1e-12).all()
        assert np.isfinite(bounds).any()


def test_many_poses_give_the_clearance_below_the_cutoff_and_a_bound_above_it():
    rng = np.random.default_rng(6)
    proxy, obstacle = ConvexProxy(Capsule(0.05, 0.3)), unit_box_obstacle()
    poses = np.array([random_pose(rng, 1.5, square=False) for _ in range(40)])
    true = np.array([mesh_clearance(proxy, pose, obstacle).distance for pose in poses])
    found = clearances(proxy, poses, obstacle, cutoff=0.2)
    assert np.array_equal(clearances(proxy, poses, obstacle), true)
    assert (found <= true + 1e-12).all()
    assert np.array_equal(found[true <= 0.2], true[true <= 0.2])
    assert (found[true > 0.2] > 0.2).all()


def test_triangles_without_area_change_no_distance():
    vertices, faces = box_triangles(np.ones(3))
    rng = np.random.default_rng(8)
    proxy, plain = ConvexProxy(Box(np.full(3, 0.2))), unit_box_obstacle()
    # every edge of the first triangle gets a vertex, and a triangle without area to close it
    a, b, c = faces[0]
    middles = 0.5 * (vertices[[a, b, c]] + vertices[[b, c, a]])
    p, q, r = range(len(vertices), len(vertices) + 3)
    caps = [[a, b, p], [b, c, q], [c, a, r]]
    split = [[a, p, r], [p, b, q], [r, q, c], [p, q, r]]
    closing = [[x, m, y] for (x, y, m) in caps]
    faces = np.vstack([faces[1:], split, [cap[::-1] for cap in closing]])
    capped = MeshObstacle(Mesh(np.vstack([vertices, middles]), faces), np.eye(4))
    assert len(capped.mesh.faces) == 11 + 4 + 3
    for _ in range(200):
        pose = random_pose(rng, 1.5, square=bool(rng.integers(2)))
        expected = mesh_clearance(proxy, pose, plain)
        found = mesh_clearance(proxy, pose, capped)
        if expected.distance > 0.0:
            assert found.distance == pytest.approx(expected.distance, abs=1e-9)
        else:
            assert found.distance <= 0.0


def test_moving_both_bodies_together_keeps_the_clearance():
    rng = np.random.default_rng(7)
    mesh = Mesh(*random_solid(rng, "torus"))
    proxy, pose = ConvexProxy(Cylinder(0.1, 0.4)), random_pose(rng, 1.0, square=False)
    still = mesh_clearance(proxy, pose, MeshObstacle(mesh, np.eye(4)))
    for _ in range(5):
        shift = random_pose(rng, 3.0, square=False)
        found = mesh_clearance(proxy, shift @ pose, MeshObstacle(mesh, shift))
        assert found.distance == pytest.approx(still.distance, abs=1e-9)


def test_an_obstacle_that_is_no_solid_is_refused():
    vertices, faces = box_triangles(np.ones(3))
    with pytest.raises(InputError, match="3 of its 18 edges are open"):
        MeshObstacle(Mesh(vertices, faces[1:]), np.eye(4))
    with pytest.raises(ModelError, match="pose"):
        MeshObstacle(Mesh(vertices, faces), np.eye(4) * 2.0)


@pytest.mark.parametrize("tolerance", [0.0, -1.0, math.nan, 0.1])
def test_a_tolerance_without_sense_is_refused(tolerance):
    with pytest.raises(ModelError, match="tolerance"):
        ConvexProxy(Sphere(0.1), tolerance)


def coal_models(*solids):
    coal = pytest.importorskip("coal")
    models = []
    for vertices, faces in solids:
        model = coal.BVHModelOBBRSS()
        model.beginModel(len(faces), len(vertices))
        for a, b, c in np.asarray(vertices)[faces]:
            model.addTriangle(a, b, c)
        model.endModel()
        models.append(model)
    return models


@pytest.mark.parametrize("square", [False, True], ids=["turned", "square"])
def test_clearance_of_boxes_and_hulls_from_meshes_equals_that_of_coal(square):
    coal = pytest.importorskip("coal")
    rng = np.random.default_rng(11)
    checked = 0
    for _ in range(40):
        solid = random_solid(rng, SOLIDS[rng.integers(5)])
        if square:
            size = rng.uniform(0.1, 0.4, 3)
            shape, body = Box(size), box_triangles(size)
        else:
            body = hull_mesh(rng.normal(size=(15, 3)) * 0.1)
            shape = Hull(body[0])
        pose = random_pose(rng, 0.8, square=square)
        first, second = coal_models(body, solid)
        request, result = coal.DistanceRequest(), coal.DistanceResult()
        true = coal.distance(
            first,
            coal.Transform3s(pose[:3, :3], pose[:3, 3]),
            second,
            coal.Transform3s(),
            request,
            result,
        )
        if true < 1e-6 or winding(pose[:3, 3], solid[0][solid[1]]) > 0.5:
            continue
        if winding(solid[0][0], moved(pose, body[0])[body[1]]) > 0.5:
            continue
        checked += 1
        found = mesh_clearance(ConvexProxy(shape), pose, MeshObstacle(Mesh(*solid), np.eye(4)))
        assert found.distance == pytest.approx(true, abs=1e-9)
    assert checked >= 10
