"""Signed distance of two convex bodies: the certificate that every clearance rests on.

Separated bodies: the distance is exact within 1e-6 m and is not over-stated, because what is
returned is a separating-plane bound or a closed form. Overlapping bodies: the result is not
positive; it is exact for a rounded core (sphere, capsule) whose core stays outside, otherwise
the depth is an estimate that is not under-stated.
"""

import math

from solver.collision.kernels_bound import quick_lower_bound
from solver.collision.kernels_closed import (
    point_in_box,
    point_in_cylinder,
    segment_to_box,
    segment_to_segment,
)
from solver.collision.kernels_depth import overlap, refined
from solver.collision.kernels_gjk import GAP, TOUCH, gjk
from solver.collision.kernels_shapes import (
    BOX,
    CAPSULE,
    CYLINDER,
    HULL,
    SPHERE,
    body_numbers,
    core_radius,
    dot,
    minus,
    norm,
    placed,
    rotation_numbers,
    row_of_rotations,
    row_of_vectors,
    scaled,
    simple_reach,
    simple_support,
    turned_back,
    vector_numbers,
)
from solver.kernel import inline_kernel, kernel

__all__ = ["convex_distance", "numbers_distance", "quick_lower_bound", "row_distance"]

STALLED = 1e-8
"""A bracket wider than this says that rounding stopped the search early [m]."""

UNDECIDED, SEPARATED, OVERLAPPING = 0, 1, 2

ROUNDING = 1e-12
"""Gaps of cores below this are held for touching [m]."""


@inline_kernel
def _relative(p, position_a, q, position_b):
    """Rotation (nine, row by row) and position of A in the frame of B."""
    x, y, z = minus(position_a, position_b)
    t = (
        q[0] * x + q[3] * y + q[6] * z,
        q[1] * x + q[4] * y + q[7] * z,
        q[2] * x + q[5] * y + q[8] * z,
    )
    r = (
        q[0] * p[0] + q[3] * p[3] + q[6] * p[6],
        q[0] * p[1] + q[3] * p[4] + q[6] * p[7],
        q[0] * p[2] + q[3] * p[5] + q[6] * p[8],
        q[1] * p[0] + q[4] * p[3] + q[7] * p[6],
        q[1] * p[1] + q[4] * p[4] + q[7] * p[7],
        q[1] * p[2] + q[4] * p[5] + q[7] * p[8],
        q[2] * p[0] + q[5] * p[3] + q[8] * p[6],
        q[2] * p[1] + q[5] * p[4] + q[8] * p[7],
        q[2] * p[2] + q[5] * p[5] + q[8] * p[8],
    )
    return r, t


@inline_kernel
def _onto(b, x, y, z):
    """Nearest point of a sphere's or capsule's core, a cylinder or a box B to a point."""
    kind, sx, sy, sz, _, _ = b
    if kind == BOX:
        return point_in_box(x, y, z, sx, sy, sz)
    if kind == CYLINDER:
        return point_in_cylinder(x, y, z, sx, sy)
    if kind == CAPSULE:
        return 0.0, 0.0, min(max(z, -sx), sx)
    return 0.0, 0.0, 0.0


@inline_kernel
def _axes_nearest(a, r, t, b):
    """Nearest points of A's point or axis and of B, where a cylinder B stands for its axis.

    Against a point, a cylinder B stands for itself.
    """
    if a[0] == SPHERE:
        return t, _onto(b, t[0], t[1], t[2])
    if b[0] == BOX:
        s = segment_to_box(t[0], t[1], t[2], r[2], r[5], r[8], a[1], b[1], b[2], b[3])
        pa = (t[0] + s * r[2], t[1] + s * r[5], t[2] + s * r[8])
        return pa, point_in_box(pa[0], pa[1], pa[2], b[1], b[2], b[3])
    s, w = segment_to_segment(t[0], t[1], t[2], r[2], r[5], r[8], a[1], 0.0, 0.0, 1.0, b[1])
    return (t[0] + s * r[2], t[1] + s * r[5], t[2] + s * r[8]), (0.0, 0.0, w)


@inline_kernel
def _closed_form(a, r, t, b, cutoff):
    """Try the closed forms: (verdict, gap of the cores, direction from B to A, witnesses).

    Undecided, the direction is a good first guess for the search.
    """
    if a[0] > CYLINDER or b[0] == HULL:
        return UNDECIDED, 0.0, t, t, t
    pa, pb = _axes_nearest(a, r, t, b)
    between = minus(pa, pb)
    length = norm(between)
    if not length > TOUCH:  # so that a pose that is not a number ends as an overlap
        return OVERLAPPING, 0.0, t, t, t
    n = scaled(1.0 / length, between)
    if a[0] == SPHERE or (a[0] == CAPSULE and b[0] != CYLINDER):
        return SEPARATED, length, n, pa, pb
    # the direction between the axes serves flat ends too, unless an end is nearest
    x, y, z = turned_back(r, n)
    bound = dot(n, t) - simple_reach(a, -x, -y, -z) - simple_reach(b, n[0], n[1], n[2])
    pa = placed(r, t, simple_support(a, -x, -y, -z))
    pb = _onto(b, pa[0], pa[1], pa[2])
    if bound > TOUCH and (bound > cutoff or norm(minus(pa, pb)) - bound < GAP):
        return SEPARATED, bound, n, pa, pb
    return UNDECIDED, 0.0, n, t, t


@kernel
def _searched(a, vertices_a, r, t, b, vertices_b, verdict, n, cutoff, wants_depth):
    """Gap of the cores, direction and witnesses where no closed form has them."""
    overlapping = verdict == OVERLAPPING
    if not overlapping:
        bound, n, pa, pb, overlapping = gjk(a, vertices_a, r, t, b, vertices_b, n, cutoff)
        if bound > 0.0:
            if bound <= cutoff and norm(minus(pa, pb)) > bound + STALLED:
                return refined(a, vertices_a, r, t, b, vertices_b, bound, n)
            return bound, n, pa, pb
    if overlapping and not wants_depth:
        return -TOUCH, n, t, t
    bound, n, pa, pb = overlap(a, vertices_a, r, t, b, vertices_b, n)
    return (bound if bound > ROUNDING else min(bound, 0.0)), n, pa, pb


@inline_kernel
def _into_world(q, position, p, factor, n, witness, row):
    """Write the point p + factor n of B's frame into a row of the witnesses."""
    x, y, z = p[0] + factor * n[0], p[1] + factor * n[1], p[2] + factor * n[2]
    witness[row, 0] = q[0] * x + q[1] * y + q[2] * z + position[0]
    witness[row, 1] = q[3] * x + q[4] * y + q[5] * z + position[1]
    witness[row, 2] = q[6] * x + q[7] * y + q[8] * z + position[2]


@kernel
def numbers_distance(
    a,
    vertices_a,
    rotation_a,
    position_a,
    b,
    vertices_b,
    rotation_b,
    position_b,
    cutoff,
    wants_depth,
    witness,
):
    """Signed distance of two bodies given as numbers; see `convex_distance` and `row_distance`."""
    row_a, row_b = 0, 1
    if a[0] > b[0]:
        # the closed forms and the frame of B expect the kinds in rising order
        a, b = b, a
        rotation_a, rotation_b = rotation_b, rotation_a
        position_a, position_b = position_b, position_a
        row_a, row_b = 1, 0
    r, t = _relative(rotation_a, position_a, rotation_b, position_b)
    radius_a, radius_b = core_radius(a), core_radius(b)
    core_cutoff = max(cutoff + radius_a + radius_b, 0.0)
    verdict, gap, n, pa, pb = _closed_form(a, r, t, b, core_cutoff)
    if verdict != SEPARATED:
        if row_a == 1:
            vertices_a, vertices_b = vertices_b, vertices_a
        gap, n, pa, pb = _searched(
            a, vertices_a, r, t, b, vertices_b, verdict, n, core_cutoff, wants_depth
        )
    _into_world(rotation_b, position_b, pa, -radius_a, n, witness, row_a)
    _into_world(rotation_b, position_b, pb, radius_b, n, witness, row_b)
    return gap - radius_a - radius_b


@kernel
def convex_distance(
    kind_a,
    size_a,
    vertices_a,
    rotation_a,
    position_a,
    kind_b,
    size_b,
    vertices_b,
    rotation_b,
    position_b,
    witness,
):
    """Signed distance [m] of two posed convex bodies; `witness` (2, 3) gets the nearest points.

    Parameters
    ----------
    kind_a, kind_b : int
        SPHERE, CAPSULE, CYLINDER, BOX or HULL of `kernels_shapes`.
    size_a, size_b : (3,) arrays
        Sphere: radius; capsule and cylinder: half length, radius; box: half extents [m].
    vertices_a, vertices_b : (k, 3) arrays
        Vertices of a hull in its body frame [m]; anything for other kinds.
    rotation_a, rotation_b : (3, 3) arrays
        World_from_body.
    position_a, position_b : (3,) arrays
        Origin of each body in the world [m].
    witness : (2, 3) array
        Receives the nearest points of A and B in the world frame [m]; of bodies that overlap,
        their deepest points, as far apart as the depth.

    Returns
    -------
    float
        Separated: a lower bound of the distance, at most 1e-6 m below it. Touching or
        overlapping: not positive, minus an upper bound of the depth.
    """
    everything = math.inf
    return numbers_distance(
        body_numbers(kind_a, size_a, vertices_a.shape[0]),
        vertices_a,
        rotation_numbers(rotation_a),
        vector_numbers(position_a),
        body_numbers(kind_b, size_b, vertices_b.shape[0]),
        vertices_b,
        rotation_numbers(rotation_b),
        vector_numbers(position_b),
        everything,
        everything > 0.0,  # a plain bool: a literal True would compile all of this twice
        witness,
    )


@inline_kernel
def row_distance(
    bodies_a,
    rotations_a,
    positions_a,
    i,
    bodies_b,
    rotations_b,
    positions_b,
    j,
    cutoff,
    wants_depth,
    witness,
):
    """Signed distance [m] of body i of one set and body j of another, without slicing arrays.

    The sets are tuples of arrays with the fields kind (k,), size (k, 3), start (k,), stop (k,)
    and vertices (v, 3), where a hull owns the rows start to stop; rotations are (k, 3, 3),
    positions (k, 3). A result above `cutoff` is a sound lower bound and perhaps no more, with
    witnesses that may not be the nearest; `math.inf` asks for the distance in every case.
    Without `wants_depth` an overlap of cores is told by its sign alone, several times faster.
    """
    return numbers_distance(
        (
            bodies_a.kind[i],
            bodies_a.size[i, 0],
            bodies_a.size[i, 1],
            bodies_a.size[i, 2],
            bodies_a.start[i],
            bodies_a.stop[i],
        ),
        bodies_a.vertices,
        row_of_rotations(rotations_a, i),
        row_of_vectors(positions_a, i),
        (
            bodies_b.kind[j],
            bodies_b.size[j, 0],
            bodies_b.size[j, 1],
            bodies_b.size[j, 2],
            bodies_b.start[j],
            bodies_b.stop[j],
        ),
        bodies_b.vertices,
        row_of_rotations(rotations_b, j),
        row_of_vectors(positions_b, j),
        cutoff,
        wants_depth,
        witness,
    )
