"""Brute-force oracle of mesh distances in plain numpy, and random solids for the tests."""

from __future__ import annotations

import numpy as np
import trimesh
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation


def near_pairs(first, second, beyond=None):
    """Rows of triangles whose bounding balls are no further apart than some pair surely is."""
    (c, r), (d, q) = (_balls(first), _balls(second))
    apart = np.linalg.norm(c[:, None] - d[None], axis=2)
    limit = apart.min() if beyond is None else beyond
    return np.nonzero(apart - r[:, None] - q[None] <= limit + 1e-12)


def _balls(triangles):
    centre = triangles.mean(axis=1)
    return centre, np.linalg.norm(triangles - centre[:, None], axis=2).max(axis=1)


def triangle_distance(first, second):
    """Smallest distance of triangles (a, 3, 3) and (b, 3, 3) whose surfaces do not cross."""
    rows, columns = near_pairs(first, second)
    one, two = first[rows], second[columns]
    corners = range(3)
    squares = [
        _segments(one[:, i], one[:, (i + 1) % 3], two[:, j], two[:, (j + 1) % 3])
        for i in corners
        for j in corners
    ]
    squares += [_over_face(one[:, i], two) for i in corners]
    squares += [_over_face(two[:, i], one) for i in corners]
    return np.sqrt(min(square.min() for square in squares))


def surfaces_cross(first, second):
    """Whether an edge of one set of triangles passes through a face of the other."""
    rows, columns = near_pairs(first, second, beyond=0.0)
    one, two = first[rows], second[columns]
    for edges, faces in ((one, two), (two, one)):
        a, b, c = faces[:, 0], faces[:, 1], faces[:, 2]
        normal = np.cross(b - a, c - a)
        for i in range(3):
            p, q = edges[:, i], edges[:, (i + 1) % 3]
            sides = np.array(
                [(np.cross(u - p, v - p) * (q - p)).sum(-1) for u, v in ((a, b), (b, c), (c, a))]
            )
            through = (sides > 0).all(axis=0) | (sides < 0).all(axis=0)
            opposite = ((p - a) * normal).sum(-1) * ((q - a) * normal).sum(-1) < 0
            if (through & opposite).any():
                return True
    return False


def _segments(p, q, a, b):
    u, v, w = q - p, b - a, p - a
    uu, vv, uv, uw, vw = ((x * y).sum(-1) for x, y in ((u, u), (v, v), (u, v), (u, w), (v, w)))
    ends = np.minimum.reduce(
        [_to_segment(p, a, v), _to_segment(q, a, v), _to_segment(a, p, u), _to_segment(b, p, u)]
    )
    square = uu * vv - uv**2
    skew = square > 1e-14 * uu * vv
    s = (uv * vw - uw * vv) / np.where(skew, square, 1.0)
    t = (uu * vw - uv * uw) / np.where(skew, square, 1.0)
    within = skew & (s >= 0) & (s <= 1) & (t >= 0) & (t <= 1)
    inner = ((w + s[..., None] * u - t[..., None] * v) ** 2).sum(-1)
    return np.minimum(ends, np.where(within, inner, np.inf))


def _to_segment(point, start, along):
    square = (along * along).sum(-1)
    t = np.clip(((point - start) * along).sum(-1) / np.where(square > 0, square, 1.0), 0.0, 1.0)
    return ((start + t[..., None] * along - point) ** 2).sum(-1)


def _over_face(point, face):
    """Squared height over the face, infinite where the foot is outside it."""
    a, b, c = face[:, 0], face[:, 1], face[:, 2]
    normal = np.cross(b - a, c - a)
    square = (normal * normal).sum(-1)
    height = ((point - a) * normal).sum(-1) / np.where(square > 0.0, square, 1.0)
    foot = point - height[..., None] * normal
    within = np.broadcast_to(square > 0.0, height.shape).copy()
    for u, v in ((a, b), (b, c), (c, a)):
        within &= (np.cross(v - u, foot - u) * normal).sum(-1) >= 0.0
    return np.where(within, height**2 * square, np.inf)


def hull_mesh(vertices):
    """Outward triangles (m, 3, 3) of the convex hull of vertices, by Qhull."""
    hull = ConvexHull(vertices)
    corners = np.asarray(vertices)[hull.simplices]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    turned = (normals * hull.equations[:, :3]).sum(1) < 0.0
    faces = np.where(turned[:, None], hull.simplices[:, ::-1], hull.simplices)
    return np.asarray(vertices), faces


def random_solid(rng, kind):
    """Vertices and faces of a random solid about the origin, some decimetres large."""
    if kind == "box":
        made = trimesh.creation.box(rng.uniform(0.05, 0.6, 3))
    elif kind == "cylinder":
        made = trimesh.creation.cylinder(rng.uniform(0.05, 0.3), rng.uniform(0.1, 0.6), sections=16)
    elif kind == "torus":
        made = trimesh.creation.torus(0.3, 0.06, major_sections=12, minor_sections=6)
    elif kind == "beam":
        return beam_section(0.3, 0.25, 0.02, 0.8)
    else:
        return hull_mesh(rng.normal(size=(10, 3)) * 0.2)
    return np.array(made.vertices), np.array(made.faces)


def beam_section(height, width, thick, length):
    """An H-shaped prism along x: not convex, flat faces, sharp grooves."""
    outline = np.array(
        [
            [-width, -height],
            [width, -height],
            [width, -height + 2 * thick],
            [thick, -height + 2 * thick],
            [thick, height - 2 * thick],
            [width, height - 2 * thick],
            [width, height],
            [-width, height],
            [-width, height - 2 * thick],
            [-thick, height - 2 * thick],
            [-thick, -height + 2 * thick],
            [-width, -height + 2 * thick],
        ]
    )
    outline = 0.5 * outline
    web = [[0, 1, 2], [0, 2, 3], [0, 3, 10], [0, 10, 11], [3, 4, 9], [3, 9, 10]]
    cap = np.array([*web, [4, 5, 6], [4, 6, 7], [4, 7, 9], [9, 7, 8]])
    vertices = np.vstack(
        [np.column_stack([np.full(12, x), outline]) for x in (-0.5 * length, 0.5 * length)]
    )
    row, following = np.arange(12), (np.arange(12) + 1) % 12
    faces = np.vstack(
        [
            cap[:, ::-1],
            cap + 12,
            np.column_stack([row, following, following + 12]),
            np.column_stack([row, following + 12, row + 12]),
        ]
    )
    return vertices, faces


def random_pose(rng, spread, *, square):
    """A pose (4, 4) about the origin; a square one is turned by right angles, on a grid."""
    pose = np.eye(4)
    position = rng.uniform(-spread, spread, 3)
    if square:
        turns = np.round(Rotation.create_group("O").as_matrix())
        pose[:3, :3] = turns[rng.integers(24)]
        position = np.round(position, 1)
    else:
        pose[:3, :3] = Rotation.random(random_state=rng).as_matrix()
    pose[:3, 3] = position
    return pose


def moved(pose, points):
    """Points (..., 3) of the source frame in the target frame."""
    return points @ pose[:3, :3].T + pose[:3, 3]
