"""A lower bound of the distance of two convex bodies at the price of a few products."""

import math

from solver.collision.kernels_shapes import (
    BOX,
    HULL,
    SPHERE,
    rotation_numbers,
    row_of_rotations,
    row_of_vectors,
    vector_numbers,
)
from solver.kernel import inline_kernel, kernel


@kernel
def _skeleton(kind, size):
    """Half extents of a box and the radius about it that together contain the body."""
    if kind == BOX:
        return size[0], size[1], size[2], 0.0
    if kind in (SPHERE, HULL):
        return 0.0, 0.0, 0.0, size[0]
    return 0.0, 0.0, size[0], size[1]


@kernel
def numbers_lower_bound(kind_a, size_a, p, position_a, kind_b, size_b, q, position_b):
    """Bound the distance for sizes (3), rotations (9) and positions (3) given as numbers.

    Body A's skeleton is boxed in the frame of B (of A when only A is a box); two boxes that
    stand alike have a closed distance, which is shortened by both radii.
    """
    if kind_a == BOX and kind_b != BOX:
        kind_a, kind_b = kind_b, kind_a
        size_a, size_b = size_b, size_a
        p, q = q, p
        position_a, position_b = position_b, position_a
    ax, ay, az, radius_a = _skeleton(kind_a, size_a)
    bx, by, bz, radius_b = _skeleton(kind_b, size_b)
    x = position_a[0] - position_b[0]
    y = position_a[1] - position_b[1]
    z = position_a[2] - position_b[2]
    total = 0.0
    for k in range(3):
        u, v, w = q[k], q[3 + k], q[6 + k]
        excess = abs(u * x + v * y + w * z) - (bx if k == 0 else (by if k == 1 else bz))
        if az != 0.0:
            excess -= az * abs(u * p[2] + v * p[5] + w * p[8])
        if ax != 0.0:
            excess -= ax * abs(u * p[0] + v * p[3] + w * p[6])
            excess -= ay * abs(u * p[1] + v * p[4] + w * p[7])
        if excess > 0.0:
            total += excess * excess
    return math.sqrt(total) - radius_a - radius_b


@kernel
def quick_lower_bound(
    kind_a, size_a, rotation_a, position_a, kind_b, size_b, rotation_b, position_b
):
    """Return a number [m] that does not exceed the distance of two posed bodies.

    For culling. Sizes and positions are (3,) arrays, rotations (3, 3), as in `convex_distance`.
    """
    return numbers_lower_bound(
        kind_a,
        vector_numbers(size_a),
        rotation_numbers(rotation_a),
        vector_numbers(position_a),
        kind_b,
        vector_numbers(size_b),
        rotation_numbers(rotation_b),
        vector_numbers(position_b),
    )


@inline_kernel
def row_lower_bound(
    kinds_a, sizes_a, rotations_a, positions_a, i, kinds_b, sizes_b, rotations_b, positions_b, j
):
    """`quick_lower_bound` of row i and row j of arrays of bodies, without slicing them."""
    return numbers_lower_bound(
        kinds_a[i],
        row_of_vectors(sizes_a, i),
        row_of_rotations(rotations_a, i),
        row_of_vectors(positions_a, i),
        kinds_b[j],
        row_of_vectors(sizes_b, j),
        row_of_rotations(rotations_b, j),
        row_of_vectors(positions_b, j),
    )
