"""What makes triangles a solid: welding, closed edges, one winding, bodies, inside and outside."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np

from solver.errors import InputError, Place
from solver.model.shapes import Mesh
from solver.transforms import FloatArray, IntArray
from solver.units import MM, MM_PER_M

MAX_TRIANGLES: Final = 2_000_000
MAX_BODIES: Final = 1_000
SMALLEST_EXTENT: Final = 1.0 * MM
"""A mesh whose longest side is shorter [m] is taken for a mistake in the unit."""

LARGEST_EXTENT: Final = 50.0
"""A mesh whose longest side is longer [m] is taken for a mistake in the unit."""

THINNEST: Final = 1e-6
"""Mean thickness 2 V / A [m] below which a closed surface encloses nothing."""

CHUNK: Final = 1 << 18
"""Rows handled at once where temporary arrays would otherwise be large."""


class Bodies(NamedTuple):
    """The closed pieces of a mesh: `label` (m,) of every face, signed `volume` (n,) [m^3]."""

    label: IntArray
    volume: FloatArray


class TriangleField(NamedTuple):
    """Triangles `corners` (m, 3, 3) and the box `low`, `high` (m, 3) of each [m]."""

    corners: FloatArray
    low: FloatArray
    high: FloatArray


def triangle_field(corners: FloatArray) -> TriangleField:
    """Triangles (m, 3, 3) with their boxes, for many questions about inside and outside."""
    return TriangleField(corners, corners.min(axis=1), corners.max(axis=1))


def closed_mesh(
    vertices: FloatArray, faces: IntArray, place: Place | None = None
) -> tuple[Mesh, Bodies]:
    """Make a solid from triangles, or say in one sentence why they are none.

    Equal vertices are welded, triangles that have collapsed to a line between two vertices are
    dropped, and a mesh that is inside out as a whole is turned.

    Parameters
    ----------
    vertices : (k, 3) array
        Positions [m].
    faces : (m, 3) integer array
        Rows of `vertices`.
    place : Place, optional
        Named in the error.

    Returns
    -------
    Mesh, Bodies
        The solid, and the separate closed pieces of its surface.

    Raises
    ------
    InputError
        Empty, not finite, of absurd size, with open or inconsistently wound edges, flat, or
        with single bodies inside out.
    """
    vertices = np.asarray(vertices, dtype=np.float64).reshape(-1, 3)
    faces = np.asarray(faces, dtype=np.int64).reshape(-1, 3)
    _check_numbers(vertices, faces, place)
    vertices, faces = _weld(vertices, faces)
    if len(faces) == 0:
        raise InputError("the mesh encloses no volume: every triangle is a point or line", place)
    _check_extent(vertices, place)
    pairs = _check_edges(faces, place)
    bodies = split_bodies(vertices, faces, pairs)
    if len(bodies.volume) > MAX_BODIES:
        raise InputError(
            f"the mesh falls into {len(bodies.volume)} bodies, expected at most {MAX_BODIES}", place
        )
    if bodies.volume[np.argmax(np.abs(bodies.volume))] < 0.0:
        faces = faces[:, ::-1]
        bodies = Bodies(bodies.label, -bodies.volume)
    _check_volume(vertices, faces, bodies, place)
    return Mesh(vertices, faces), bodies


def _check_numbers(vertices: FloatArray, faces: IntArray, place: Place | None) -> None:
    if len(faces) == 0 or len(vertices) == 0:
        raise InputError("the mesh holds no triangles", place)
    if len(faces) > MAX_TRIANGLES:
        raise InputError(
            f"the mesh has {len(faces)} triangles, expected at most {MAX_TRIANGLES}", place
        )
    bad = np.flatnonzero(~np.isfinite(vertices).all(axis=1))
    if len(bad):
        raise InputError(
            f"{len(bad)} vertices of the mesh are not finite (first: vertex {bad[0] + 1})", place
        )
    if faces.min() < 0 or faces.max() >= len(vertices):
        outside = int(faces.max() if faces.max() >= len(vertices) else faces.min())
        raise InputError(
            f"a triangle names vertex {outside + 1} but the mesh has {len(vertices)} vertices",
            place,
        )


def _weld(vertices: FloatArray, faces: IntArray) -> tuple[FloatArray, IntArray]:
    """Merge equal vertices, drop unused ones and the triangles that name a vertex twice."""
    vertices = vertices + 0.0  # turns -0.0 into 0.0
    order = np.lexsort(vertices.T)
    ordered = vertices[order]
    fresh = np.ones(len(order), dtype=bool)
    fresh[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    new_row = np.empty(len(order), dtype=np.int64)
    new_row[order] = np.cumsum(fresh) - 1
    faces = new_row[faces]
    a, b, c = faces.T
    faces = faces[(a != b) & (b != c) & (c != a)]
    used, renumbered = np.unique(faces, return_inverse=True)
    return ordered[fresh][used], renumbered.reshape(-1, 3).astype(np.int64)


def _check_extent(vertices: FloatArray, place: Place | None) -> None:
    extent = float(np.ptp(vertices, axis=0).max())
    if not SMALLEST_EXTENT <= extent <= LARGEST_EXTENT:
        raise InputError(
            f"the mesh is {extent * MM_PER_M:g} mm long, expected {SMALLEST_EXTENT * MM_PER_M:g} "
            f"to {LARGEST_EXTENT * MM_PER_M:g} mm; is its unit right?",
            place,
        )


def _check_edges(faces: IntArray, place: Place | None) -> IntArray:
    """Return the (p, 2) pairs of faces that share an edge of two; refuse what is not closed.

    Where more than two triangles meet at an edge (bodies that touch), as many must run one way
    as the other.
    """
    start = faces.ravel()
    end = np.roll(faces, -1, axis=1).ravel()
    forward = start < end
    width = int(faces.max()) + 1
    key = np.where(forward, start * width + end, end * width + start)
    order = np.argsort(key, kind="stable")
    key = key[order]
    first = np.flatnonzero(np.concatenate(([True], key[1:] != key[:-1])))
    count = np.diff(np.append(first, len(key)))
    balance = np.add.reduceat(np.where(forward[order], 1, -1), first)
    unclosed = int((count % 2 == 1).sum())
    if unclosed:
        raise InputError(
            f"the mesh is not watertight: {unclosed} of its {len(first)} edges are open", place
        )
    unbalanced = int((balance != 0).sum())
    if unbalanced:
        raise InputError(
            f"the triangles are wound inconsistently along {unbalanced} of the mesh's "
            f"{len(first)} edges",
            place,
        )
    face = order // 3
    plain = first[count == 2]
    return np.column_stack([face[plain], face[plain + 1]])


def split_bodies(vertices: FloatArray, faces: IntArray, pairs: IntArray) -> Bodies:
    """Label the faces that hang together over `pairs` (p, 2) of neighbours; volumes [m^3]."""
    label = np.arange(len(faces))
    a, b = pairs.T
    while True:
        lower = np.minimum(label[a], label[b])
        hooked = label.copy()
        np.minimum.at(hooked, label[a], lower)
        np.minimum.at(hooked, label[b], lower)
        hooked = np.minimum(hooked, hooked[label])
        hooked = hooked[hooked]
        if np.array_equal(hooked, label):
            break
        label = hooked
    _, label = np.unique(label, return_inverse=True)
    centre = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    p, q, r = (vertices[faces[:, corner]] - centre for corner in range(3))
    parts = np.einsum("ij,ij->i", p, np.cross(q, r)) / 6.0
    volume = np.bincount(label, weights=parts).astype(np.float64)
    return Bodies(label.astype(np.int64), volume)


def _check_volume(
    vertices: FloatArray, faces: IntArray, bodies: Bodies, place: Place | None
) -> None:
    """Refuse a flat mesh, and a body that is inside out without being a cavity of another."""
    triangles = vertices[faces]
    across = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    area = np.bincount(bodies.label, weights=0.5 * np.linalg.norm(across, axis=1))
    thick = 2.0 * np.abs(bodies.volume) >= THINNEST * area
    if not thick.any():
        raise InputError("the mesh encloses no volume: its surface is flat", place)
    inverted = np.flatnonzero(thick & (bodies.volume < 0.0))
    if len(inverted) == 0:
        return
    outward = triangles[bodies.volume[bodies.label] > 0.0]
    _, first_face = np.unique(bodies.label, return_index=True)
    points = vertices[faces[first_face[inverted], 0]]
    astray = int((winding_numbers(points, outward) < 0.5).sum())
    if astray:
        raise InputError(
            f"{astray} of the mesh's {len(bodies.volume)} bodies are inside out "
            "(negative volume, and no cavity of another body)",
            place,
        )


def winding_numbers(points: FloatArray, triangles: FloatArray) -> FloatArray:
    """How often closed surfaces wind around points: 0 outside, 1 inside, more where they overlap.

    Parameters
    ----------
    points : (k, 3) array
        Points off the surface [m].
    triangles : (m, 3, 3) array
        Corners of closed, outward wound surfaces [m].

    Returns
    -------
    (k,) array
        Sum of the signed solid angles (Van Oosterom and Strackee 1983) over 4 pi; a whole
        number but for rounding.
    """
    totals = np.zeros(len(points))
    for row, point in enumerate(points):
        for start in range(0, len(triangles), CHUNK):
            a, b, c = np.moveaxis(triangles[start : start + CHUNK] - point, 1, 0)
            la, lb, lc = (np.sqrt(np.einsum("ij,ij->i", v, v)) for v in (a, b, c))
            ab, bc, ca = (np.einsum("ij,ij->i", u, v) for u, v in ((a, b), (b, c), (c, a)))
            spat = np.einsum("ij,ij->i", a, np.cross(b, c))
            totals[row] += np.arctan2(spat, la * lb * lc + ab * lc + bc * la + ca * lb).sum()
    return totals / (2.0 * math.pi)


def is_inside(point: FloatArray, field: TriangleField) -> bool:
    """Whether a point (3,) off the surface lies inside closed, outward wound triangles.

    Counts the signed crossings of a ray along an axis; where a ray grazes an edge the next
    axis is tried, and after the third the solid angles decide.
    """
    for axis in (2, 0, 1):
        crossings = _ray_crossings(point, field, axis)
        if crossings is not None:
            return crossings > 0
    return bool(winding_numbers(point[None], field.corners)[0] > 0.5)


def _ray_crossings(point: FloatArray, field: TriangleField, axis: int) -> int | None:
    """Signed crossings of the ray from `point` along +axis; None where one is undecided."""
    u, v = (axis + 1) % 3, (axis + 2) % 3
    met = field.high[:, axis] >= point[axis]
    for across in (u, v):
        met &= (field.low[:, across] <= point[across]) & (field.high[:, across] >= point[across])
    local = field.corners[met] - point
    if len(local) == 0:
        return 0
    a, b, c = local[:, 0], local[:, 1], local[:, 2]
    areas = np.column_stack(
        [p[:, u] * q[:, v] - p[:, v] * q[:, u] for p, q in ((b, c), (c, a), (a, b))]
    )
    blur = 1e-12 * float(np.abs(local[:, :, [u, v]]).max()) ** 2
    above, below = areas > blur, areas < -blur
    pierced = above.all(axis=1) | below.all(axis=1)
    passed = above.any(axis=1) & below.any(axis=1)
    if not (pierced | passed).all():
        return None
    weights = areas[pierced]
    total = weights.sum(axis=1)
    height = np.einsum("ij,ij->i", weights, local[pierced][:, :, axis]) / total
    if len(height) and np.abs(height).min() <= 1e-9 * float(np.abs(local).max()):
        return None
    return int(np.sign(total[height > 0.0]).sum())
