"""Oracles for the distance of convex bodies; none shares code with the kernels.

Plain numpy support values give a separating-plane bound, which no distance can fall below; coal
and a convex programme give the distance itself.
"""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

SPHERE, CAPSULE, CYLINDER, BOX, HULL = range(5)
NAMES = ("sphere", "capsule", "cylinder", "box", "hull")
KIND_PAIRS = list(itertools.combinations_with_replacement(range(5), 2))
PAIR_NAMES = [f"{NAMES[a]}-{NAMES[b]}" for a, b in KIND_PAIRS]
CORNERS = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))


class Bodies(NamedTuple):
    """Bodies of one kind: size (n, 3), vertices (n, k, 3), rotation (n, 3, 3), position (n, 3)."""

    kind: int
    size: np.ndarray
    vertices: np.ndarray
    rotation: np.ndarray
    position: np.ndarray

    def body(self, i):
        """Kind, size, vertices, rotation and position of one body."""
        return self.kind, self.size[i], self.vertices[i], self.rotation[i], self.position[i]

    def rows(self, chosen):
        """The bodies of the chosen rows."""
        return Bodies(self.kind, *(part[chosen] for part in self[1:]))


def random_bodies(rng, kind, count, *, aligned):
    """Bodies from millimetres to a metre; aligned ones stand square, mostly on a common grid."""
    size = 10.0 ** rng.uniform(-2.5, 0.0, (count, 3))
    position = rng.uniform(-1.5, 1.5, (count, 3)) * 10.0 ** rng.uniform(-1.0, 0.3, (count, 1))
    if aligned:
        turns = np.round(Rotation.create_group("O").as_matrix())
        rotation = turns[rng.integers(24, size=count)]
        on_grid = rng.random(count) < 0.7
        size[on_grid] = np.ceil(size[on_grid] * 10.0) / 10.0
        position[on_grid] = np.round(position[on_grid], 1)
        in_plane = rng.random((count, 3)) < 0.2
        position[in_plane] = 0.0
    else:
        rotation = Rotation.random(count, random_state=rng).as_matrix()
    vertices = np.zeros((count, 0, 3))
    if kind == HULL:
        corners = CORNERS if aligned else rng.normal(size=(count, 8, 3))
        vertices = corners * size[:, None, :]
        size = np.stack([np.linalg.norm(vertices, axis=2).max(axis=1)] * 3, axis=1)
    keep = {SPHERE: (1, 0, 0), CAPSULE: (1, 1, 0), CYLINDER: (1, 1, 0), HULL: (1, 0, 0)}
    size = size * keep.get(kind, (1, 1, 1))
    return Bodies(kind, size, vertices, np.ascontiguousarray(rotation), position)


def reach(bodies, directions):
    """Largest value of direction . x over each body, for directions (n, 3)."""
    local = np.einsum("nji,nj->ni", bodies.rotation, directions)
    offset = np.einsum("ni,ni->n", directions, bodies.position)
    size = bodies.size
    if bodies.kind == SPHERE:
        return offset + size[:, 0] * np.linalg.norm(local, axis=1)
    if bodies.kind == CAPSULE:
        return offset + size[:, 0] * abs(local[:, 2]) + size[:, 1] * np.linalg.norm(local, axis=1)
    if bodies.kind == CYLINDER:
        across = np.hypot(local[:, 0], local[:, 1])
        return offset + size[:, 0] * abs(local[:, 2]) + size[:, 1] * across
    if bodies.kind == BOX:
        return offset + np.einsum("ni,ni->n", size, abs(local))
    return offset + np.einsum("nki,ni->nk", bodies.vertices, local).max(axis=1)


def plane_gap(bodies_a, bodies_b, directions):
    """Gap between two parallel planes square to unit directions (B to A) that part the bodies."""
    return -reach(bodies_a, -directions) - reach(bodies_b, directions)


def outside(bodies, points):
    """How far points (n, 3) are outside their body along its worst constraint [m]."""
    local = np.einsum("nji,nj->ni", bodies.rotation, points - bodies.position)
    size = bodies.size
    if bodies.kind == SPHERE:
        return np.linalg.norm(local, axis=1) - size[:, 0]
    if bodies.kind == CAPSULE:
        beyond = np.maximum(abs(local[:, 2]) - size[:, 0], 0.0)
        return np.linalg.norm(np.c_[local[:, :2], beyond], axis=1) - size[:, 1]
    if bodies.kind == CYLINDER:
        across = np.hypot(local[:, 0], local[:, 1]) - size[:, 1]
        return np.maximum(across, abs(local[:, 2]) - size[:, 0])
    if bodies.kind == BOX:
        return (abs(local) - size).max(axis=1)
    faces = [ConvexHull(vertices).equations for vertices in bodies.vertices]
    return np.array([(f[:, :3] @ x + f[:, 3]).max() for f, x in zip(faces, local, strict=True)])


def coal_distances(coal, bodies_a, bodies_b):
    """Signed distances by coal, asked for 1e-9."""
    request = coal.DistanceRequest()
    request.enable_signed_distance = True
    request.gjk_tolerance = 1e-9
    request.gjk_max_iterations = 1000
    found = np.empty(len(bodies_a.size))
    for i in range(len(found)):
        shape_a, place_a = _coal_body(coal, bodies_a, i)
        shape_b, place_b = _coal_body(coal, bodies_b, i)
        found[i] = coal.distance(shape_a, place_a, shape_b, place_b, request, coal.DistanceResult())
    return found


def _coal_body(coal, bodies, i):
    x, y, z = bodies.size[i]
    if bodies.kind == HULL:
        points = coal.StdVec_Vec3s()
        points.extend(list(bodies.vertices[i]))
        shape = coal.Convex.convexHull(points, False, "")
    else:
        shape = (
            lambda: coal.Sphere(x),
            lambda: coal.Capsule(y, 2 * x),
            lambda: coal.Cylinder(y, 2 * x),
            lambda: coal.Box(2 * x, 2 * y, 2 * z),
        )[bodies.kind]()
    return shape, coal.Transform3s(bodies.rotation[i], bodies.position[i])


def programme_distance(body_a, body_b):
    """Distance of two bodies (kind, size, vertices, rotation, position) by convex programming.

    Least |x_a - x_b|^2 over points of the bodies, by sequential least squares; a hull's point
    is a mixture of its vertices, a capsule's or sphere's a point of its core.
    """
    free_a, map_a, limits_a, rounds_a, radius_a = _programme_body(*body_a)
    free_b, map_b, limits_b, rounds_b, radius_b = _programme_body(*body_b)
    k = len(free_a)
    scale = max(np.linalg.norm(body_a[4] - body_b[4]), 1e-3)

    def between(x):
        return (map_a[0] @ x[:k] + map_a[1] - map_b[0] @ x[k:] - map_b[1]) / scale

    def gradient(x):
        return 2.0 * np.concatenate([between(x) @ map_a[0], -(between(x) @ map_b[0])]) / scale

    constraints = [{"type": kind, "fun": lambda x, f=f: f(x[:k])} for kind, f in rounds_a]
    constraints += [{"type": kind, "fun": lambda x, f=f: f(x[k:])} for kind, f in rounds_b]
    solution = minimize(
        lambda x: between(x) @ between(x),
        np.concatenate([free_a, free_b]),
        jac=gradient,
        bounds=limits_a + limits_b,
        constraints=constraints,
        method="SLSQP",
        options={"ftol": 1e-18, "maxiter": 500},
    )
    return float(np.linalg.norm(between(solution.x)) * scale - radius_a - radius_b)


def _programme_body(kind, size, vertices, rotation, position):
    """Start, affine map to the world, bounds, further constraints and rounding radius."""
    x, y, _ = size
    if kind == SPHERE:
        return np.zeros(1), (np.zeros((3, 1)), position), [(0.0, 0.0)], [], x
    if kind == CAPSULE:
        return np.zeros(1), (rotation[:, 2:], position), [(-x, x)], [], y
    if kind == CYLINDER:
        rim = [("ineq", lambda p: 1.0 - (p[0] ** 2 + p[1] ** 2) / y**2)]
        return np.zeros(3), (rotation, position), [(-y, y), (-y, y), (-x, x)], rim, 0.0
    if kind == BOX:
        return np.zeros(3), (rotation, position), [(-h, h) for h in size], [], 0.0
    count = len(vertices)
    total = [("eq", lambda p: p.sum() - 1.0)]
    start = np.full(count, 1.0 / count)
    return start, (rotation @ vertices.T, position), [(0.0, 1.0)] * count, total, 0.0
