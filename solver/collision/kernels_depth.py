"""Signed gap of two cores that touch or overlap: an estimate that never flatters.

The depth of an overlap is the least overlap over all directions. Any direction gives an upper
bound of it, so the best of a set of directions over-states the depth or meets it. For two
boxes, and for a segment and a box, the set holds every direction that can be the minimum; for
others it is a start that is then improved.
"""

import math

from solver.collision.kernels_gjk import GAP, gjk, separation
from solver.collision.kernels_shapes import HULL, dot, minus, norm, placed, scaled
from solver.kernel import kernel

IMPROVEMENTS = 8

SLACK = 1e-4
"""How far apart cores are drawn: enough for a precise direction, little next to any radius [m]."""


@kernel
def _axis(r, k):
    if k == 0:
        return r[0], r[3], r[6]
    if k == 1:
        return r[1], r[4], r[7]
    return r[2], r[5], r[8]


@kernel
def _unit_axis(k):
    return 1.0 * (k == 0), 1.0 * (k == 1), 1.0 * (k == 2)


@kernel
def _direction(number, r, t, hint):
    """Candidate direction by number: axes of B, axes of A, their products, and more."""
    if number < 3:
        return _unit_axis(number)
    if number < 6:
        return _axis(r, number - 3)
    if number < 15:
        ux, uy, uz = _unit_axis((number - 6) % 3)
        vx, vy, vz = _axis(r, (number - 6) // 3)
        return uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    if number < 17:
        return hint if number == 15 else t
    # across the axis of B or of A, for the sides of cylinders
    a = _unit_axis(2) if number == 17 else _axis(r, 2)
    return minus(t, scaled(dot(t, a), a))


@kernel
def refined(a, vertices_a, r, t, b, vertices_b, best, n):
    """Improve a direction n of signed gap `best`; returns (gap, n, point of A, point of B).

    Drawn apart along n until they are well separated, the cores have a direction between their
    nearest points whose gap is no smaller than that of n. Once it is n itself, the points drawn
    back are as far apart as the gap, and no direction next to n has a larger one.
    """
    pa, pb = t, t
    for _ in range(IMPROVEMENTS):
        draw = SLACK - 1.5 * min(best, 0.0)
        apart = (t[0] + draw * n[0], t[1] + draw * n[1], t[2] + draw * n[2])
        _, u, pa, pb, _ = gjk(a, vertices_a, r, apart, b, vertices_b, n, math.inf)
        pa = minus(pa, scaled(draw, n))
        gap = separation(a, vertices_a, r, t, b, vertices_b, u)
        if not gap > best + GAP:
            break
        best, n = gap, u
    return best, n, pa, pb


@kernel
def _middle(body, vertices):
    """Mean of a hull's vertices, the origin of every other kind."""
    x, y, z = 0.0, 0.0, 0.0
    if body[0] == HULL:
        share = 1.0 / (body[5] - body[4])
        for i in range(body[4], body[5]):
            x += share * vertices[i, 0]
            y += share * vertices[i, 1]
            z += share * vertices[i, 2]
    return x, y, z


@kernel
def overlap(a, vertices_a, r, t, b, vertices_b, hint):
    """Best signed gap found, its unit direction from B to A, and the deepest points of A and B."""
    best, n = -math.inf, (0.0, 0.0, 1.0)
    for number in range(19):
        d = _direction(number, r, t, hint)
        length = norm(d)
        if length < 1e-9:
            continue
        for sign in (1.0, -1.0):
            u = scaled(sign / length, d)
            gap = separation(a, vertices_a, r, t, b, vertices_b, u)
            if gap > best:
                best, n = gap, u
    best, n, pa, pb = refined(a, vertices_a, r, t, b, vertices_b, best, n)
    if b[0] == HULL:
        # the faces of a hull are no candidates: try what the search and the middles suggest
        middles = minus(placed(r, t, _middle(a, vertices_a)), _middle(b, vertices_b))
        for d in (hint, middles):
            length = norm(d)
            if length > 1e-9:
                u = scaled(1.0 / length, d)
                gap = separation(a, vertices_a, r, t, b, vertices_b, u)
                gap, u, qa, qb = refined(a, vertices_a, r, t, b, vertices_b, gap, u)
                if gap > best:
                    best, n, pa, pb = gap, u, qa, qb
    return best, n, pa, pb
