"""Convex bodies as scalars: kinds, support points and support values.

A body is a *core* (point, segment, cylinder, box or vertices) and a rounding radius about it:
a sphere is a rounded point, a capsule a rounded segment; the others are their own core.

Kernels pass a body as plain numbers, since slicing arrays costs more than most distances do:
`body` is (kind, size x, size y, size z, first row, last row + 1 of its vertices), a rotation is
nine numbers row by row, a position three.
"""

import math

import numpy as np

from solver.kernel import kernel

SPHERE = 0
CAPSULE = 1
CYLINDER = 2
BOX = 3
HULL = 4


@kernel
def body_numbers(kind, size, count):
    """Gather the numbers of one body from its kind, its size (3,) and its count of vertices."""
    return np.int64(kind), size[0], size[1], size[2], np.int64(0), np.int64(count)


@kernel
def vector_numbers(vector):
    """Unpack a (3,) array."""
    return vector[0], vector[1], vector[2]


@kernel
def rotation_numbers(m):
    """Unpack a (3, 3) array, row by row."""
    return m[0, 0], m[0, 1], m[0, 2], m[1, 0], m[1, 1], m[1, 2], m[2, 0], m[2, 1], m[2, 2]


@kernel
def row_of_vectors(vectors, i):
    """Unpack row i of a (k, 3) array."""
    return vectors[i, 0], vectors[i, 1], vectors[i, 2]


@kernel
def row_of_rotations(m, i):
    """Unpack row i of a (k, 3, 3) array."""
    return (
        m[i, 0, 0],
        m[i, 0, 1],
        m[i, 0, 2],
        m[i, 1, 0],
        m[i, 1, 1],
        m[i, 1, 2],
        m[i, 2, 0],
        m[i, 2, 1],
        m[i, 2, 2],
    )


@kernel
def core_radius(body):
    """Return the rounding radius about the core [m]."""
    if body[0] == SPHERE:
        return body[1]
    if body[0] == CAPSULE:
        return body[2]
    return 0.0


@kernel
def simple_support(body, dx, dy, dz):
    """Point of the core farthest along d in the body's own frame, for every kind but a hull."""
    kind, sx, sy, sz, _, _ = body
    if kind == BOX:
        return math.copysign(sx, dx), math.copysign(sy, dy), math.copysign(sz, dz)
    if kind == CYLINDER:
        across = math.sqrt(dx * dx + dy * dy)
        if across > 0.0:
            return sy * (dx / across), sy * (dy / across), math.copysign(sx, dz)
        return 0.0, 0.0, math.copysign(sx, dz)
    if kind == CAPSULE:
        return 0.0, 0.0, math.copysign(sx, dz)
    return 0.0, 0.0, 0.0


@kernel
def simple_reach(body, dx, dy, dz):
    """Largest value of d . x over the core in the body's own frame, for every kind but a hull."""
    kind, sx, sy, sz, _, _ = body
    if kind == BOX:
        return sx * abs(dx) + sy * abs(dy) + sz * abs(dz)
    if kind == CYLINDER:
        return sx * abs(dz) + sy * math.sqrt(dx * dx + dy * dy)
    if kind == CAPSULE:
        return sx * abs(dz)
    return 0.0


@kernel
def core_support(body, vertices, dx, dy, dz):
    """Point of the core farthest along d, both in the body's own frame."""
    if body[0] != HULL:
        return simple_support(body, dx, dy, dz)
    best = body[4]
    reach = -math.inf
    for i in range(body[4], body[5]):
        value = dx * vertices[i, 0] + dy * vertices[i, 1] + dz * vertices[i, 2]
        if value > reach:
            reach = value
            best = i
    return vertices[best, 0], vertices[best, 1], vertices[best, 2]


@kernel
def core_reach(body, vertices, dx, dy, dz):
    """Largest value of d . x over the core, in the body's own frame."""
    if body[0] != HULL:
        return simple_reach(body, dx, dy, dz)
    x, y, z = core_support(body, vertices, dx, dy, dz)
    return dx * x + dy * y + dz * z


@kernel
def turned_back(r, n):
    """Direction n of the frame of B in the frame of A, which stands at rotation r."""
    return (
        r[0] * n[0] + r[3] * n[1] + r[6] * n[2],
        r[1] * n[0] + r[4] * n[1] + r[7] * n[2],
        r[2] * n[0] + r[5] * n[1] + r[8] * n[2],
    )


@kernel
def placed(r, t, p):
    """Point p of the frame of A in the frame of B."""
    return (
        r[0] * p[0] + r[1] * p[1] + r[2] * p[2] + t[0],
        r[3] * p[0] + r[4] * p[1] + r[5] * p[2] + t[1],
        r[6] * p[0] + r[7] * p[1] + r[8] * p[2] + t[2],
    )


@kernel
def dot(u, v):
    """Scalar product of two triples."""
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


@kernel
def norm(u):
    """Length of a triple."""
    return math.sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2])


@kernel
def minus(u, v):
    """Difference of two triples."""
    return u[0] - v[0], u[1] - v[1], u[2] - v[2]


@kernel
def scaled(factor, u):
    """Multiple of a triple."""
    return factor * u[0], factor * u[1], factor * u[2]
