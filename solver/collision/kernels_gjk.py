"""GJK on the cores of two convex bodies, stopped by its own certificate.

Every direction n that is tried gives a separating-plane bound: the cores are at least
`min over A of n.x - max over B of n.x` apart. What is returned is the best of these bounds, so
that stopping early, for whatever reason, can only under-state the distance.

A pair is `a, vertices_a, r, t, b, vertices_b`: the bodies as numbers, and the rotation (nine)
and position (three) of A in the frame of B, in which everything here is.
"""

import math

from solver.collision.kernels_shapes import (
    core_reach,
    core_support,
    dot,
    minus,
    norm,
    placed,
    scaled,
    turned_back,
)
from solver.collision.kernels_simplex import edge_weight, tetrahedron_weights, triangle_weights
from solver.kernel import kernel

GAP = 1e-9
"""Width of the bracket between bound and witness at which the search stops [m]."""

TOUCH = 1e-10
"""Witnesses nearer than this count as touching [m]."""

MOST_STEPS = 80


@kernel
def support_of_first(a, vertices_a, r, t, n):
    """Point of the core of A farthest against n."""
    x, y, z = turned_back(r, n)
    return placed(r, t, core_support(a, vertices_a, -x, -y, -z))


@kernel
def separation(a, vertices_a, r, t, b, vertices_b, n):
    """Signed gap of the cores along the unit direction n, from B to A."""
    x, y, z = turned_back(r, n)
    reach_a = core_reach(a, vertices_a, -x, -y, -z)
    return dot(n, t) - reach_a - core_reach(b, vertices_b, n[0], n[1], n[2])


@kernel
def _blend(wa, wb, wc, a, b, c):
    return (
        wa * a[0] + wb * b[0] + wc * c[0],
        wa * a[1] + wb * b[1] + wc * c[1],
        wa * a[2] + wb * b[2] + wc * c[2],
    )


@kernel
def gjk(a, vertices_a, r, t, b, vertices_b, start, cutoff):
    """Distance of two cores, from any first guess `start` of the direction from B to A.

    Returns (bound, n, point of A, point of B, inside): the certified lower bound of the
    distance, the unit direction it holds for, the witnesses, and whether the cores were seen to
    overlap. The search ends when the bound exceeds `cutoff`. A bound that is not positive says
    that no separation was found.
    """
    length = norm(start)
    n = scaled(1.0 / length, start) if length > 0.0 else (0.0, 0.0, 1.0)
    best, best_n = -math.inf, n
    # corners of the simplex in A - B, and the points of A behind them
    zero = (0.0, 0.0, 0.0)
    y0, y1, y2, y3 = zero, zero, zero, zero
    a0, a1, a2, a3 = zero, zero, zero, zero
    w1, w2 = 0.0, 0.0
    v, near = zero, zero
    count = 0
    inside = False
    distance = math.inf
    for _ in range(MOST_STEPS):
        pa = support_of_first(a, vertices_a, r, t, n)
        y = minus(pa, core_support(b, vertices_b, n[0], n[1], n[2]))
        bound = dot(n, y)
        if bound > best:
            best, best_n = bound, n
        if distance - best < GAP:
            break
        # put the new corner first, then keep the corners that carry the nearest point
        y3, y2, y1, y0 = y2, y1, y0, y
        a3, a2, a1, a0 = a2, a1, a0, pa
        w0, w1, w2, w3 = 1.0, 0.0, 0.0, 0.0
        if count == 1:
            w1 = edge_weight(y0, y1)
            w0 = 1.0 - w1
        elif count == 2:
            w0, w1, w2, _ = triangle_weights(y0, y1, y2)
        elif count == 3:
            w0, w1, w2, w3 = tetrahedron_weights(y0, y1, y2, y3)
            if w0 + w1 > 1.5:
                inside = True
                break
        while w0 == 0.0:
            y0, y1, y2 = y1, y2, y3
            a0, a1, a2 = a1, a2, a3
            w0, w1, w2, w3 = w1, w2, w3, 0.0
        if w1 == 0.0:
            y1, y2 = y2, y3
            a1, a2 = a2, a3
            w1, w2, w3 = w2, w3, 0.0
            if w1 == 0.0:
                y1, a1, w1, w2 = y2, a2, w2, 0.0
        if w2 == 0.0:
            y2, a2, w2 = y3, a3, w3
        count = 1 + (w1 != 0.0) + (w2 != 0.0)
        step = _blend(w0, w1, w2, y0, y1, y2)
        length = norm(step)
        if length >= distance:
            break
        v, near, distance = step, _blend(w0, w1, w2, a0, a1, a2), length
        if length <= TOUCH or best > cutoff:
            break
        n = scaled(1.0 / length, v)
    return best, best_n, near, minus(near, v), inside
