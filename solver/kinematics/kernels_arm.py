"""Compiled forward and inverse kinematics of an arm with a spherical wrist.

Angles are model (modified D-H) angles [rad] unless a name says pendant; lengths in [m].
``arm`` is always (4,): a1, a2, a3, d4. Symbols follow section 3.1 of the paper:
u = (c1 c23, s1 c23, -s23), x3 = (c1 s23, s1 s23, c23), e = (s1, -c1, 0).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from solver.kernel import kernel
from solver.transforms import FloatArray
from solver.units import TURN

BoolArray = NDArray[np.bool_]

REACH_TOLERANCE = 1e-12
"""How far |K| may exceed rho, and still be the stretched or folded arm [m].

It covers the rounding of a wrist centre some metres away (below 1e-14 m) a hundred times over;
the clamped solution misses such a wrist centre by about as much.
"""

SHOULDER_TOLERANCE = 1e-12
"""Distance of the wrist centre from the J1 axis below which theta1 is free [m]."""

WRIST_TOLERANCE = 1e-10
"""|sin theta5| below which theta4 is free; the orientation error is no larger than this."""

LIMIT_TOLERANCE = 1e-12
"""How far a representative may lie outside a limit [rad]; it covers the adding of turns."""

ANGLE_BOUND = 1e6
"""Limits and angles beyond this are refused [rad]: adding turns would lose their meaning."""


@kernel
def _wrapped(angle: float) -> float:
    """`angle` from (-3 pi, 3 pi) moved to (-pi, pi]."""
    if angle > math.pi:
        return angle - TURN
    if angle <= -math.pi:
        return angle + TURN
    return angle


@kernel
def _opposite(angle: float) -> float:
    """`angle` from (-pi, pi] half a turn further, in (-pi, pi]."""
    return angle - math.pi if angle > 0.0 else angle + math.pi


@kernel
def forward_frames(arm: FloatArray, joints: FloatArray, frames: FloatArray) -> None:
    """Fill `frames` (7, 3, 4) with fanuc_world_from_frame of the D-H frames.

    Frame 0 is the base (identity); frame i turns with joint i; frame 6 is the wrist centre.
    """
    a1, a2, a3, d4 = arm[0], arm[1], arm[2], arm[3]
    c1, s1 = math.cos(joints[0]), math.sin(joints[0])
    c2, s2 = math.cos(joints[1]), math.sin(joints[1])
    c23, s23 = math.cos(joints[1] + joints[2]), math.sin(joints[1] + joints[2])
    c4, s4 = math.cos(joints[3]), math.sin(joints[3])
    c5, s5 = math.cos(joints[4]), math.sin(joints[4])
    c6, s6 = math.cos(joints[5]), math.sin(joints[5])

    for row in range(3):
        for column in range(4):
            frames[0, row, column] = 1.0 if row == column else 0.0

    frames[1, 0, 0], frames[1, 0, 1], frames[1, 0, 2], frames[1, 0, 3] = c1, -s1, 0.0, 0.0
    frames[1, 1, 0], frames[1, 1, 1], frames[1, 1, 2], frames[1, 1, 3] = s1, c1, 0.0, 0.0
    frames[1, 2, 0], frames[1, 2, 1], frames[1, 2, 2], frames[1, 2, 3] = 0.0, 0.0, 1.0, 0.0

    # Columns of frame 2: x along the upper arm, z along the J2 axis.
    frames[2, 0, 0], frames[2, 0, 1], frames[2, 0, 2] = c1 * s2, c1 * c2, -s1
    frames[2, 1, 0], frames[2, 1, 1], frames[2, 1, 2] = s1 * s2, s1 * c2, c1
    frames[2, 2, 0], frames[2, 2, 1], frames[2, 2, 2] = c2, -s2, 0.0
    frames[2, 0, 3], frames[2, 1, 3], frames[2, 2, 3] = a1 * c1, a1 * s1, 0.0

    reach = a1 + a2 * s2
    frames[3, 0, 0], frames[3, 0, 1], frames[3, 0, 2] = c1 * s23, c1 * c23, -s1
    frames[3, 1, 0], frames[3, 1, 1], frames[3, 1, 2] = s1 * s23, s1 * c23, c1
    frames[3, 2, 0], frames[3, 2, 1], frames[3, 2, 2] = c23, -s23, 0.0
    frames[3, 0, 3], frames[3, 1, 3], frames[3, 2, 3] = c1 * reach, s1 * reach, a2 * c2

    reach += a3 * s23 + d4 * c23
    wx, wy, wz = c1 * reach, s1 * reach, a2 * c2 + a3 * c23 - d4 * s23
    ux, uy, uz = c1 * c23, s1 * c23, -s23
    x4x, x4y, x4z = c4 * c1 * s23 + s4 * s1, c4 * s1 * s23 - s4 * c1, c4 * c23
    y4x, y4y, y4z = c4 * s1 - s4 * c1 * s23, -c4 * c1 - s4 * s1 * s23, -s4 * c23
    frames[4, 0, 0], frames[4, 0, 1], frames[4, 0, 2], frames[4, 0, 3] = x4x, y4x, ux, wx
    frames[4, 1, 0], frames[4, 1, 1], frames[4, 1, 2], frames[4, 1, 3] = x4y, y4y, uy, wy
    frames[4, 2, 0], frames[4, 2, 1], frames[4, 2, 2], frames[4, 2, 3] = x4z, y4z, uz, wz

    x5x, x5y, x5z = c5 * x4x + s5 * ux, c5 * x4y + s5 * uy, c5 * x4z + s5 * uz
    ax, ay, az = c5 * ux - s5 * x4x, c5 * uy - s5 * x4y, c5 * uz - s5 * x4z
    frames[5, 0, 0], frames[5, 0, 1], frames[5, 0, 2], frames[5, 0, 3] = x5x, ax, -y4x, wx
    frames[5, 1, 0], frames[5, 1, 1], frames[5, 1, 2], frames[5, 1, 3] = x5y, ay, -y4y, wy
    frames[5, 2, 0], frames[5, 2, 1], frames[5, 2, 2], frames[5, 2, 3] = x5z, az, -y4z, wz

    frames[6, 0, 0], frames[6, 0, 1] = c6 * x5x + s6 * y4x, c6 * y4x - s6 * x5x
    frames[6, 1, 0], frames[6, 1, 1] = c6 * x5y + s6 * y4y, c6 * y4y - s6 * x5y
    frames[6, 2, 0], frames[6, 2, 1] = c6 * x5z + s6 * y4z, c6 * y4z - s6 * x5z
    frames[6, 0, 2], frames[6, 1, 2], frames[6, 2, 2] = ax, ay, az
    frames[6, 0, 3], frames[6, 1, 3], frames[6, 2, 3] = wx, wy, wz


@kernel
def inverse_branches(
    arm: FloatArray, wrist: FloatArray, joints: FloatArray, found: BoolArray
) -> None:
    """Fill `joints` (8, 6) and `found` (8,) with the eight branches of one wrist pose.

    `wrist` (3, 4) is fanuc_world_from_wrist, the sixth D-H frame. Branch number
    = 4 back + 2 minus_root + (sigma < 0): front or back of the J1 axis, root of theta2, sign of
    sin theta5. Angles are in (-pi, pi] (theta5 in [-pi, pi]); the row of a branch that the arm
    cannot reach holds NaN, and no other row does.

    Free angles: theta1 = 0 in front and pi at the back with the wrist centre on the J1 axis;
    theta4 = 0 for sigma > 0 and pi for sigma < 0 with joints 4 and 6 in line.
    """
    a1, a2, a3, d4 = arm[0], arm[1], arm[2], arm[3]
    forearm = a3 * a3 + d4 * d4
    wx, wy, wz = wrist[0, 3], wrist[1, 3], wrist[2, 3]
    radius = math.hypot(wx, wy)
    if radius < SHOULDER_TOLERANCE:
        front, c1, s1 = 0.0, 1.0, 0.0
    else:
        front, c1, s1 = _wrapped(math.atan2(wy, wx)), wx / radius, wy / radius

    # Components of the wrist's axes n, o, a along (c1, s1, 0) and along e.
    nr, ne, nz = (
        wrist[0, 0] * c1 + wrist[1, 0] * s1,
        wrist[0, 0] * s1 - wrist[1, 0] * c1,
        wrist[2, 0],
    )
    or_, oe, oz = (
        wrist[0, 1] * c1 + wrist[1, 1] * s1,
        wrist[0, 1] * s1 - wrist[1, 1] * c1,
        wrist[2, 1],
    )
    ar, ae, az = (
        wrist[0, 2] * c1 + wrist[1, 2] * s1,
        wrist[0, 2] * s1 - wrist[1, 2] * c1,
        wrist[2, 2],
    )
    radial = wx * c1 + wy * s1

    for back in range(2):
        theta1 = front
        if back == 1:
            theta1 = _opposite(front)
            radial = -radial
            nr, ne, or_, oe, ar, ae = -nr, -ne, -or_, -oe, -ar, -ae
        k1, k3 = radial - a1, wz
        rho2 = k1 * k1 + k3 * k3
        rho = math.sqrt(rho2)
        reach = (rho2 + a2 * a2 - forearm) / (2.0 * a2)
        # Written so that a NaN counts as out of reach.
        if not abs(reach) <= rho + REACH_TOLERANCE:
            for branch in range(4 * back, 4 * back + 4):
                found[branch] = False
                for joint in range(6):
                    joints[branch, joint] = np.nan
            continue
        b1, b3 = k1, k3
        if rho < REACH_TOLERANCE:
            # The wrist centre on the J2 axis (arms with a2^2 = a3^2 + d4^2): theta2 is free.
            b1, b3, rho, rho2, reach = 1.0, 0.0, 1.0, 1.0, 0.0
        root = 0.0
        if abs(reach) < rho:
            root = math.sqrt((rho - reach) * (rho + reach))
        else:
            reach = math.copysign(rho, reach)
        bearing = math.atan2(b3, b1)
        rise = math.atan2(reach, root)

        for minus in range(2):
            if minus == 0:
                theta2 = _wrapped(rise - bearing)
            else:
                root = -root
                theta2 = _wrapped(math.pi - rise - bearing)
            s2 = (reach * b1 - root * b3) / rho2
            c2 = (root * b1 + reach * b3) / rho2
            l1, l3 = k1 - a2 * s2, k3 - a2 * c2
            s23, c23 = a3 * l1 - d4 * l3, a3 * l3 + d4 * l1
            length = math.sqrt(s23 * s23 + c23 * c23)
            s23, c23 = s23 / length, c23 / length
            theta3 = _wrapped(math.atan2(s23, c23) - theta2)

            p, q, c5 = -ae, -(ar * s23 + az * c23), ar * c23 - az * s23
            s5 = math.sqrt(p * p + q * q)
            if s5 < WRIST_TOLERANCE:
                s5, s4, c4, theta4 = 0.0, 0.0, 1.0, 0.0
            else:
                s4, c4, theta4 = p / s5, q / s5, _wrapped(math.atan2(p, q))
            theta5 = math.atan2(s5, c5)
            # n . y4 = s6 and o . y4 = c6. The paper's atan2(-o . u, n . u) is the same angle,
            # but close to the wrist singularity its rounding does not match that of theta4.
            s6 = c4 * ne - s4 * (nr * s23 + nz * c23)
            c6 = c4 * oe - s4 * (or_ * s23 + oz * c23)
            theta6 = _wrapped(math.atan2(s6, c6))

            branch = 4 * back + 2 * minus
            for flip in range(2):
                joints[branch + flip, 0] = theta1
                joints[branch + flip, 1] = theta2
                joints[branch + flip, 2] = theta3
                found[branch + flip] = True
            joints[branch, 3] = theta4
            joints[branch, 4] = theta5
            joints[branch, 5] = theta6
            joints[branch + 1, 3] = _opposite(theta4)
            joints[branch + 1, 4] = -theta5
            joints[branch + 1, 5] = _opposite(theta6)


@kernel
def manipulability(arm: FloatArray, joints: FloatArray) -> float:
    """|a2 (s2 F3 - c2 F1)| |R| |s5| [m^3], which equals sqrt(det(J J^T)); section 3.1."""
    a1, a2, a3, d4 = arm[0], arm[1], arm[2], arm[3]
    c2, s2 = math.cos(joints[1]), math.sin(joints[1])
    c23, s23 = math.cos(joints[1] + joints[2]), math.sin(joints[1] + joints[2])
    f1, f3 = a3 * s23 + d4 * c23, a3 * c23 - d4 * s23
    reach = a1 + a2 * s2 + f1
    measure: float = abs(a2 * (s2 * f3 - c2 * f1) * reach * math.sin(joints[4]))
    return measure


@kernel
def representatives(
    pendant: FloatArray, limits: FloatArray, principal_only: bool, out: FloatArray
) -> int:
    """Write every +-360 deg representative of `pendant` (6,) inside `limits` (6, 2) to `out`.

    Order: ascending in J1, then J2, ... then J6, so J6 runs fastest. A value may lie outside a
    limit by `LIMIT_TOLERANCE`. With `principal_only`, only the representative with every joint
    in (-pi, pi], if it lies inside the limits. Returns the count; -1 when `out` has
    too few rows (`solver.kinematics.arm.representative_capacity` tells how many suffice) or an
    angle is not finite or beyond `ANGLE_BOUND`; the rows of `out` then mean nothing.
    """
    count = 1
    for joint in range(6):
        low = limits[joint, 0] - LIMIT_TOLERANCE
        high = limits[joint, 1] + LIMIT_TOLERANCE
        value = pendant[joint]
        # Written so that a NaN is refused.
        if not (abs(low) < ANGLE_BOUND and abs(high) < ANGLE_BOUND and abs(value) < ANGLE_BOUND):
            return -1
        lowest = 0.0
        if principal_only:
            value -= TURN * math.ceil((value - math.pi) / TURN)
            if value <= -math.pi:
                value += TURN
            turns = 1 if low <= value <= high else 0
        else:
            # One turn too early, then up to the limit: the quotient's rounding cannot cost one.
            turn = math.floor((low - value) / TURN)
            while value + TURN * turn < low:
                turn += 1.0
            lowest = turn
            while value + TURN * turn <= high:
                turn += 1.0
            turns = int(turn - lowest)
        if turns == 0:
            return 0
        if count * turns > out.shape[0]:
            return -1
        # Every row so far becomes `turns` rows, from the last one backwards, in place.
        for row in range(count - 1, -1, -1):
            for k in range(turns - 1, -1, -1):
                target = row * turns + k
                for done in range(joint):
                    out[target, done] = out[row, done]
                out[target, joint] = value + TURN * (lowest + k)
        count *= turns
    return count


@kernel
def forward_many(arm: FloatArray, joints: FloatArray, frames: FloatArray) -> None:
    """Fill `frames` (k, 7, 3, 4) with the `forward_frames` of every row of `joints` (k, 6)."""
    for row in range(joints.shape[0]):
        forward_frames(arm, joints[row], frames[row])


@kernel
def inverse_many(arm: FloatArray, wrists: FloatArray, joints: FloatArray, found: BoolArray) -> None:
    """Fill `joints` (k, 8, 6) and `found` (k, 8) from every row of `wrists` (k, 3, 4)."""
    for row in range(wrists.shape[0]):
        inverse_branches(arm, wrists[row], joints[row], found[row])


@kernel
def manipulability_many(arm: FloatArray, joints: FloatArray, out: FloatArray) -> None:
    """Fill `out` (k,) with the `manipulability` of every row of `joints` (k, 6)."""
    for row in range(joints.shape[0]):
        out[row] = manipulability(arm, joints[row])
