from __future__ import annotations

import math

import numpy as np
import pytest
import trimesh
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from solver.collision.convex_hull import hull_triangles
from solver.collision.mesh_proxy import ConvexProxy
from solver.errors import ModelError
from solver.model.shapes import Box, Capsule, Cylinder, Hull, Sphere


def point_sets(rng):
    """Vertices whose hulls have the faces that make hulls hard."""
    turn = Rotation.random(random_state=rng).as_matrix()
    grid = rng.integers(-1, 2, (30, 3)).astype(float)
    yield "scattered", rng.normal(size=(rng.integers(4, 60), 3))
    yield "on a grid", rng.integers(-2, 3, (40, 3)) * 0.1
    yield "turned box", trimesh.creation.box(rng.uniform(0.01, 1.0, 3)).vertices @ turn
    sections = int(rng.integers(5, 80))
    yield "turned cylinder", trimesh.creation.cylinder(0.1, 0.4, sections).vertices @ turn
    yield "grid with noise", grid + rng.normal(size=(30, 3)) * 10.0 ** -rng.integers(6, 14)
    yield "slab", rng.normal(size=(20, 3)) * [1.0, 1.0, 1e-4]
    yield "single precision", np.float32(grid @ turn).astype(float)


@pytest.mark.parametrize("seed", range(8))
def test_the_hull_holds_every_vertex_and_has_the_volume_of_qhull(seed):
    for name, vertices in point_sets(np.random.default_rng(seed)):
        triangles, grown = hull_triangles(vertices)
        corners = grown[triangles]
        volume = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
        expected = ConvexHull(vertices)
        assert volume == pytest.approx(expected.volume, rel=1e-3), name
        assert volume >= expected.volume * (1.0 - 1e-9), name
        mesh = trimesh.Trimesh(grown, triangles, process=False)
        assert mesh.is_watertight, name
        assert mesh.is_winding_consistent, name
        beyond = ConvexHull(np.vstack([grown[np.unique(triangles)]])).equations
        assert (vertices @ beyond[:, :3].T + beyond[:, 3]).max() < 1e-9, name


@pytest.mark.parametrize(
    "vertices",
    [
        np.zeros((5, 3)),
        np.arange(12.0).reshape(4, 3),
        [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.3, 0.6, 0]],
        [[0, 0, 0], [1, 0, 1], [1, 1, 2], [0, 1, 1], [0.25, 0.5, 0.75]],
    ],
    ids=["a point", "a line", "flat", "inclined"],
)
def test_vertices_without_volume_have_no_hull(vertices):
    with pytest.raises(ModelError, match="hull"):
        hull_triangles(np.asarray(vertices, dtype=float))


def surface_points(shape, rng):
    """Points of the shape that reach furthest, in random directions."""
    direction = rng.normal(size=(4000, 3))
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    match shape:
        case Sphere(radius):
            return radius * direction
        case Capsule(radius, length):
            end = np.sign(direction[:, 2]) * length / 2
            return radius * direction + np.outer(end, [0.0, 0.0, 1.0])
        case Cylinder(radius, length):
            ring = direction[:, :2] / np.linalg.norm(direction[:, :2], axis=1)[:, None]
            return np.column_stack([radius * ring, np.sign(direction[:, 2]) * length / 2])
        case Box(size):
            return np.sign(direction) * size / 2
        case Hull(vertices):
            return vertices[np.argmax(direction @ vertices.T, axis=1)]


@pytest.mark.parametrize("tolerance", [1e-6, 2e-4, 5e-3])
@pytest.mark.parametrize(
    "shape",
    [
        Sphere(0.3),
        Capsule(0.13, 0.8),
        Cylinder(0.19, 0.5),
        Cylinder(0.002, 0.5),
        Box(np.array([0.1, 0.2, 0.3])),
        Hull(np.random.default_rng(2).normal(size=(20, 3)) * 0.2),
    ],
    ids=lambda shape: type(shape).__name__ if not isinstance(shape, float) else str(shape),
)
def test_a_proxy_contains_its_shape_and_exceeds_it_by_at_most_the_tolerance(shape, tolerance):
    proxy = ConvexProxy(shape, tolerance)
    assert 0.0 <= proxy.excess <= tolerance
    rng = np.random.default_rng(3)
    points = surface_points(shape, rng)
    outside = points @ proxy.normals.T - proxy.offsets
    assert outside.max() <= proxy.radius + 1e-12
    # the polyhedron with its radius reaches no further than the shape in any direction
    direction = rng.normal(size=(300, 3))
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    reach = (direction @ proxy.vertices.T).max(axis=1) + proxy.radius
    sampled = (direction @ surface_points(shape, rng).T).max(axis=1)
    slack = 3e-3 * math.hypot(0.3, proxy.radius)  # the samples are coarse
    assert (reach <= sampled + tolerance + slack).all()
    assert (reach >= sampled - 1e-12).all()
    assert (proxy.vertices >= proxy.low + proxy.radius - 1e-15).all()
    assert (proxy.vertices <= proxy.high - proxy.radius + 1e-15).all()
