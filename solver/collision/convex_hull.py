"""Faces of a convex hull by gift wrapping: slow for thousands of vertices, sturdy for flat faces.

Every face is found with all the vertices in its plane, so a tessellated disc or a box with
rounding noise gives one polygon and not a fan of slivers.
"""

from __future__ import annotations

import math
from collections import deque
from typing import Final

import numpy as np

from solver.errors import ModelError
from solver.transforms import FloatArray, IntArray

NO_HULL: Final = "no closed convex hull was found: its vertices are all but flat"

FLATNESS: Final = (1e-9, 1e-7, 1e-6, 1e-5, 1e-11)
"""Vertices this near to a face, relative to the hull's size, belong to it; tried in turn, since
noise of the same size as one of them can leave the faces without a common edge."""


def hull_triangles(vertices: FloatArray) -> tuple[IntArray, FloatArray]:
    """Triangles of the convex hull of `vertices` (k, 3), outward wound.

    Returns
    -------
    (m, 3) integer array, (k, 3) array
        Rows of the returned vertices, and those vertices: the given ones, scaled by what the
        found faces cut off (a few 1e-9, at most 2e-4), so that the polyhedron contains every
        given vertex.

    Raises
    ------
    ModelError
        No closed hull was found: the vertices are all but flat or all but equal.
    """
    vertices = np.asarray(vertices, dtype=np.float64)
    size = float(np.ptp(vertices, axis=0).max())
    for flatness in FLATNESS:
        rows = _distinct(vertices, flatness * size)
        faces = _wrap(vertices[rows], flatness * size)
        corners = [(f[0], f[i], f[i + 1]) for f in faces for i in range(1, len(f) - 1)]
        if corners:
            triangles = rows[np.array(corners)]
            scale, centre = _growth(vertices, triangles)
            if scale is not None:
                return triangles, centre + (vertices - centre) * scale
    raise ModelError(NO_HULL)


def _distinct(vertices: FloatArray, distance: float) -> IntArray:
    """Rows of vertices that are further than `distance` from every row kept before them."""
    kept: list[int] = []
    for row, vertex in enumerate(vertices):
        if not kept or np.abs(vertices[kept] - vertex).max(axis=1).min() > distance:
            kept.append(row)
    return np.array(kept, dtype=np.int64)


def _growth(vertices: FloatArray, triangles: IntArray) -> tuple[float | None, FloatArray]:
    """Scale about a centre after which the triangles hold all vertices; None: they do not close."""
    corners = vertices[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(normals, axis=1)
    centre = vertices[np.unique(triangles)].mean(axis=0)
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    there = {(int(a), int(b)) for a, b in edges}
    closed = len(there) == len(edges) and all((b, a) in there for a, b in there)
    if not closed or not (area > 0.0).all():
        return None, centre
    normals /= area[:, None]
    offsets = np.einsum("ij,ij->i", normals, corners[:, 0])
    outside = max(0.0, float((vertices @ normals.T - offsets).max()))
    depth = float((offsets - normals @ centre).min())
    if not outside <= 1e-4 * depth:
        return None, centre
    return 1.0 + 2.0 * outside / depth, centre


def _wrap(points: FloatArray, flat: float) -> list[list[int]]:
    """Polygons (rows of `points`, outward wound) of the hull's faces."""
    faces: list[list[int]] = []
    done: set[tuple[int, int]] = set()
    first = _first_face(points, flat)
    waiting = deque([first])
    limit = 4 * len(points)
    while waiting and len(faces) <= limit:
        face, normal = waiting.popleft()
        edges = list(zip(face, face[1:] + face[:1], strict=True))
        if any(edge in done for edge in edges):
            continue
        faces.append(face)
        done.update(edges)
        for a, b in edges:
            if (b, a) not in done:
                waiting.append(_next_face(points, points[a], points[b], normal, flat))
    return faces


def _first_face(points: FloatArray, flat: float) -> tuple[list[int], FloatArray]:
    start = points[np.lexsort((points[:, 2], points[:, 1], points[:, 0]))[0]]
    left = np.array([-1.0, 0.0, 0.0])
    normal = _supporting_normal(points, start, np.array([0.0, 1.0, 0.0]), left, flat)
    face = _polygon(points, start, normal, flat)
    if len(face) >= 3:
        return face, normal
    ends = points[face] if len(face) == 2 else points[[face[0], face[0]]]
    return _next_face(points, ends[0], ends[1], normal, flat)


def _next_face(
    points: FloatArray, a: FloatArray, b: FloatArray, normal: FloatArray, flat: float
) -> tuple[list[int], FloatArray]:
    """Return the face across the edge from `a` to `b` of the face with outward `normal`."""
    along = (b - a) / max(float(np.linalg.norm(b - a)), 1e-300)
    turned = _supporting_normal(points, a, along, normal, flat)
    return _polygon(points, a, turned, flat), turned


def _supporting_normal(
    points: FloatArray, start: FloatArray, along: FloatArray, normal: FloatArray, flat: float
) -> FloatArray:
    """Turn the plane with `normal` about the line until it meets points again."""
    outward = np.cross(along, normal)
    local = points - start
    u, v = local @ outward, local @ normal
    away = np.hypot(u, v) > flat
    angle = np.where(away, np.arctan2(np.minimum(v, 0.0), u), -math.inf)
    angle[away & (v >= -flat) & (u < 0.0)] = -math.pi
    turn = float(angle.max())
    if math.isinf(turn):
        raise ModelError(NO_HULL)
    return math.cos(turn) * normal - math.sin(turn) * outward


def _polygon(points: FloatArray, start: FloatArray, normal: FloatArray, flat: float) -> list[int]:
    """Corners, anticlockwise about `normal`, of the points in the plane (monotone chain)."""
    rows = np.flatnonzero(np.abs((points - start) @ normal) <= flat)
    axis = np.eye(3)[np.argmin(np.abs(normal))]
    right = np.cross(axis, normal)
    right /= np.linalg.norm(right)
    up = np.cross(normal, right)
    local = points[rows] - start
    # turned by no special angle, so that no edge runs across x, where noise would decide the order
    local = local @ np.column_stack([0.79 * right + 0.613 * up, 0.79 * up - 0.613 * right])
    order = np.lexsort((local[:, 1], local[:, 0]))
    chain: list[int] = []
    for sequence in (order, order[::-1]):
        part: list[int] = []
        for row in sequence:
            while len(part) >= 2 and not _bends_left(local, (part[-2], part[-1], row), flat):
                part.pop()
            part.append(int(row))
        chain += part[:-1]
    return [int(rows[row]) for row in chain]


def _bends_left(local: FloatArray, rows: tuple[int, int, int], flat: float) -> bool:
    """Whether the way over three rows of `local` (k, 2) turns left by more than `flat`."""
    a, b, c = local[list(rows)]
    cross = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    return bool(cross > flat * math.hypot(c[0] - a[0], c[1] - a[1]))
