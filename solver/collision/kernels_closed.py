"""Closed forms: nearest points between points, segments, boxes and cylinders.

Everything is in the frame of the second body; a segment is centre c, unit axis a, half length.
"""

import math

from solver.kernel import inline_kernel, kernel


@inline_kernel
def clamp(value, low, high):
    """`value` brought into [low, high]."""
    return min(max(value, low), high)


@inline_kernel
def point_in_box(x, y, z, hx, hy, hz):
    """Nearest point of a box of half extents h to a point (the point itself when inside)."""
    return clamp(x, -hx, hx), clamp(y, -hy, hy), clamp(z, -hz, hz)


@inline_kernel
def point_in_cylinder(x, y, z, half, radius):
    """Nearest point of a flat-ended cylinder about z to a point."""
    across = math.sqrt(x * x + y * y)
    if across > radius:
        return x * (radius / across), y * (radius / across), clamp(z, -half, half)
    return x, y, clamp(z, -half, half)


@inline_kernel
def _slope(x, dx, h):
    """Half the derivative of the squared excess of one coordinate over a slab."""
    if x > h:
        return (x - h) * dx
    if x < -h:
        return (x + h) * dx
    return 0.0


@kernel
def _narrow(edge, cx, cy, cz, ax, ay, az, hx, hy, hz, low, high, at_low, at_high):
    """Shorten the bracket of the zero of a rising slope at one breakpoint inside it."""
    if low < edge < high:
        slope = (
            _slope(cx + edge * ax, ax, hx)
            + _slope(cy + edge * ay, ay, hy)
            + _slope(cz + edge * az, az, hz)
        )
        if slope < 0.0:
            return edge, high, slope, at_high
        return low, edge, at_low, slope
    return low, high, at_low, at_high


@kernel
def segment_to_box(cx, cy, cz, ax, ay, az, half, hx, hy, hz):
    """Parameter in [-half, half] of the point of a segment that is nearest to a box.

    The squared distance is convex and piecewise quadratic in the parameter, with breakpoints
    where a coordinate crosses a face; its slope is monotone and piecewise linear, so that the
    zero is found exactly once no breakpoint is left inside the bracket.
    """
    low, high = -half, half
    at_low = (
        _slope(cx + low * ax, ax, hx)
        + _slope(cy + low * ay, ay, hy)
        + _slope(cz + low * az, az, hz)
    )
    if at_low > 0.0:
        return low
    at_high = (
        _slope(cx + high * ax, ax, hx)
        + _slope(cy + high * ay, ay, hy)
        + _slope(cz + high * az, az, hz)
    )
    if at_high < 0.0:
        return high
    for axis in range(3):
        if axis == 0:
            c, a, h = cx, ax, hx
        elif axis == 1:
            c, a, h = cy, ay, hy
        else:
            c, a, h = cz, az, hz
        if a != 0.0:
            inverse = 1.0 / a
            low, high, at_low, at_high = _narrow(
                (-h - c) * inverse,
                cx,
                cy,
                cz,
                ax,
                ay,
                az,
                hx,
                hy,
                hz,
                low,
                high,
                at_low,
                at_high,
            )
            low, high, at_low, at_high = _narrow(
                (h - c) * inverse,
                cx,
                cy,
                cz,
                ax,
                ay,
                az,
                hx,
                hy,
                hz,
                low,
                high,
                at_low,
                at_high,
            )
    rise = at_high - at_low
    if rise > 0.0:
        return clamp(low - at_low * ((high - low) / rise), low, high)
    return 0.5 * (low + high)


@inline_kernel
def segment_to_segment(cx, cy, cz, ax, ay, az, half_a, bx, by, bz, half_b):
    """Parameters (s, t) of the nearest points of c + s a and t b; a and b are unit vectors."""
    slant = ax * bx + ay * by + az * bz
    ac = ax * cx + ay * cy + az * cz
    bc = bx * cx + by * cy + bz * cz
    # |a x b|^2 from the cross product keeps its digits where 1 - slant^2 loses them
    nx, ny, nz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    square = nx * nx + ny * ny + nz * nz
    s = 0.0
    if square > 1e-20:
        # s = ((c x b) . (b x a)) / |a x b|^2
        ux, uy, uz = cy * bz - cz * by, cz * bx - cx * bz, cx * by - cy * bx
        s = clamp(-(ux * nx + uy * ny + uz * nz) / square, -half_a, half_a)
    else:
        s = clamp(-ac, -half_a, half_a)
    # alternate twice: exact where a clamp is active, harmless elsewhere
    t = clamp(bc + s * slant, -half_b, half_b)
    s = clamp(t * slant - ac, -half_a, half_a)
    t = clamp(bc + s * slant, -half_b, half_b)
    return s, t
