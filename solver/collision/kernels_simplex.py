"""The point of a simplex nearest to the origin, as weights of its corners.

Weights are clamped to be a convex combination whatever the rounding, so that the point always
belongs to the simplex; a weight of exactly zero drops the corner.
"""

from solver.kernel import kernel

FLAT = 1e-20
"""Squared sine below which a corner counts as lying in the plane of the others."""


@kernel
def edge_weight(a, b):
    """Weight of b at the point of edge ab nearest to the origin."""
    ex, ey, ez = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    square = ex * ex + ey * ey + ez * ez
    along = -(a[0] * ex + a[1] * ey + a[2] * ez)
    if along <= 0.0 or square <= 0.0:
        return 0.0
    if along >= square:
        return 1.0
    return along / square


@kernel
def _edge_square(a, b, weight):
    x = a[0] + weight * (b[0] - a[0])
    y = a[1] + weight * (b[1] - a[1])
    z = a[2] + weight * (b[2] - a[2])
    return x * x + y * y + z * z


@kernel
def triangle_weights(a, b, c):
    """Weights (wa, wb, wc) and squared distance of the point of abc nearest to the origin."""
    ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    vx, vy, vz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    # signed areas of the triangles that the projected origin makes with each edge
    of_c = (
        nx * (a[1] * uz - a[2] * uy) + ny * (a[2] * ux - a[0] * uz) + nz * (a[0] * uy - a[1] * ux)
    )
    of_b = (
        nx * (vy * a[2] - vz * a[1]) + ny * (vz * a[0] - vx * a[2]) + nz * (vx * a[1] - vy * a[0])
    )
    ex, ey, ez = c[0] - b[0], c[1] - b[1], c[2] - b[2]
    of_a = (
        nx * (b[1] * ez - b[2] * ey) + ny * (b[2] * ex - b[0] * ez) + nz * (b[0] * ey - b[1] * ex)
    )
    if of_a > 0.0 and of_b > 0.0 and of_c > 0.0:
        inverse = 1.0 / (of_a + of_b + of_c)
        wa, wb, wc = of_a * inverse, of_b * inverse, of_c * inverse
        x = wa * a[0] + wb * b[0] + wc * c[0]
        y = wa * a[1] + wb * b[1] + wc * c[1]
        z = wa * a[2] + wb * b[2] + wc * c[2]
        return wa, wb, wc, x * x + y * y + z * z
    best = 1e300
    wa, wb, wc = 1.0, 0.0, 0.0
    if of_c <= 0.0:
        w = edge_weight(a, b)
        best = _edge_square(a, b, w)
        wa, wb, wc = 1.0 - w, w, 0.0
    if of_b <= 0.0:
        w = edge_weight(a, c)
        square = _edge_square(a, c, w)
        if square < best:
            best = square
            wa, wb, wc = 1.0 - w, 0.0, w
    if of_a <= 0.0:
        w = edge_weight(b, c)
        square = _edge_square(b, c, w)
        if square < best:
            best = square
            wa, wb, wc = 0.0, 1.0 - w, w
    return wa, wb, wc, best


@kernel
def _is_outside(a, b, c, d):
    """Whether the origin is beyond the plane abc as seen from d, or d is next to that plane."""
    ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    vx, vy, vz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    wx, wy, wz = d[0] - a[0], d[1] - a[1], d[2] - a[2]
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    origin = -(nx * a[0] + ny * a[1] + nz * a[2])
    corner = nx * wx + ny * wy + nz * wz
    scale = (nx * nx + ny * ny + nz * nz) * (wx * wx + wy * wy + wz * wz)
    return origin * corner <= 0.0 or corner * corner <= FLAT * scale


@kernel
def tetrahedron_weights(a, b, c, d):
    """Weights of the nearest point of abcd; (1, 1, 1, 1) when the origin is strictly inside."""
    wa, wb, wc, wd = 1.0, 1.0, 1.0, 1.0
    best = 1e300
    if _is_outside(a, b, c, d):
        x, y, z, square = triangle_weights(a, b, c)
        if square < best:
            best = square
            wa, wb, wc, wd = x, y, z, 0.0
    if _is_outside(a, b, d, c):
        x, y, z, square = triangle_weights(a, b, d)
        if square < best:
            best = square
            wa, wb, wc, wd = x, y, 0.0, z
    if _is_outside(a, c, d, b):
        x, y, z, square = triangle_weights(a, c, d)
        if square < best:
            best = square
            wa, wb, wc, wd = x, 0.0, y, z
    if _is_outside(b, c, d, a):
        x, y, z, square = triangle_weights(b, c, d)
        if square < best:
            best = square
            wa, wb, wc, wd = 0.0, x, y, z
    return wa, wb, wc, wd
