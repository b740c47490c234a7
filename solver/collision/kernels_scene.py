"""Kernels that check one pose of the whole scene: clearance, margins and self pairs."""

import math

import numpy as np

from solver.collision.kernels_bound import row_lower_bound
from solver.collision.kernels_distance import row_distance
from solver.kernel import inline_kernel, kernel

FREE = 0
HIT = 1
MARGIN_BROKEN = 2
SELF_BROKEN = 3

ROUNDING = 1e-9
"""What culling by spheres allows for rounding [m]."""

_CLEARANCE = 1
_CONTACT = 3


@inline_kernel
def place_bodies(scene, first, last, frames, rotations, positions):
    """Poses of moving bodies first..last-1 in fanuc_world from the (7, 3, 4) D-H frames."""
    for m in range(first, last):
        f = scene.frame[m]
        for r in range(3):
            for c in range(3):
                rotations[m, r, c] = (
                    frames[f, r, 0] * scene.moving.rotation[m, 0, c]
                    + frames[f, r, 1] * scene.moving.rotation[m, 1, c]
                    + frames[f, r, 2] * scene.moving.rotation[m, 2, c]
                )
            positions[m, r] = (
                frames[f, r, 0] * scene.moving.position[m, 0]
                + frames[f, r, 1] * scene.moving.position[m, 1]
                + frames[f, r, 2] * scene.moving.position[m, 2]
                + frames[f, r, 3]
            )


@inline_kernel
def pair_threshold(scene, m, f, touch):
    """Least allowed distance of a margin or contact pair when the pass touches group `touch`."""
    if scene.rule[m, f] == _CONTACT and touch >= 0 and scene.touch_group[f] == touch:
        return -scene.depth[m]
    return scene.threshold[m, f]


@inline_kernel
def fixed_distance(scene, rotations, positions, m, f, cutoff, wants_depth, witness):
    """Certified distance of moving body m to fixed body f; only a bound above `cutoff`."""
    return row_distance(
        scene.moving,
        rotations,
        positions,
        m,
        scene.fixed,
        scene.fixed.rotation,
        scene.fixed.position,
        f,
        cutoff,
        wants_depth,
        witness,
    )


@inline_kernel
def self_distance(scene, rotations, positions, a, b, cutoff, wants_depth, witness):
    """Certified distance of two moving bodies; only a bound above `cutoff`."""
    return row_distance(
        scene.moving,
        rotations,
        positions,
        a,
        scene.moving,
        rotations,
        positions,
        b,
        cutoff,
        wants_depth,
        witness,
    )


@inline_kernel
def _fixed_bound(scene, rotations, positions, m, f):
    return row_lower_bound(
        scene.moving.kind,
        scene.moving.size,
        rotations,
        positions,
        m,
        scene.bound.kind,
        scene.bound.size,
        scene.bound.rotation,
        scene.bound.position,
        f,
    )


@inline_kernel
def _cluster_bound(scene, positions, m, c):
    """Distance of a moving body's bounding sphere to the box around a cluster, never too large."""
    dx = positions[m, 0] - scene.cluster_position[c, 0]
    dy = positions[m, 1] - scene.cluster_position[c, 1]
    dz = positions[m, 2] - scene.cluster_position[c, 2]
    total = 0.0
    for k in range(3):
        along = (
            dx * scene.cluster_rotation[c, 0, k]
            + dy * scene.cluster_rotation[c, 1, k]
            + dz * scene.cluster_rotation[c, 2, k]
        )
        beyond = abs(along) - scene.cluster_half[c, k]
        if beyond > 0.0:
            total += beyond * beyond
    return math.sqrt(total) - scene.radius[m] - ROUNDING


@inline_kernel
def check_bodies(scene, first, last, touch, best, rotations, positions, witness, nearest, points):
    """Check placed moving bodies first..last-1 against the fixed ones; stop when one is out.

    `best` is the clearance so far [m]; `witness` (2, 3) is work space; `nearest` (2,) receives
    the rows of the pair that lowers the clearance, `points` (2, 3) its nearest points. Returns
    the outcome and the clearance [m], nan when a margin is broken.
    """
    for m in range(last - 1, first - 1, -1):
        for c in range(scene.cluster_start.shape[0]):
            if not scene.cluster_rules[m, c]:
                continue
            bound = _cluster_bound(scene, positions, m, c)
            if bound >= best and bound > scene.widest[m]:
                continue
            for f in range(scene.cluster_start[c], scene.cluster_stop[c]):
                rule = scene.rule[m, f]
                if rule == 0:
                    continue
                if rule == _CLEARANCE:
                    if _fixed_bound(scene, rotations, positions, m, f) >= best:
                        continue
                    # The depth of an overlap does not matter: a hit is out in any case.
                    d = fixed_distance(scene, rotations, positions, m, f, best, best < 0.0, witness)
                    if d < best:
                        best = d
                        nearest[0] = m
                        nearest[1] = f
                        points[:] = witness
                        if best <= 0.0:
                            return HIT, best
                else:
                    least = pair_threshold(scene, m, f, touch)
                    if _fixed_bound(scene, rotations, positions, m, f) > least:
                        continue
                    deep = least < 0.0
                    d = fixed_distance(scene, rotations, positions, m, f, least, deep, witness)
                    if d <= least:
                        return MARGIN_BROKEN, np.nan
    return FREE, best


@inline_kernel
def check_self(scene, rotations, positions, witness):
    """Whether every self pair of the placed bodies keeps its margin."""
    for p in range(scene.self_pairs.shape[0]):
        a, b = scene.self_pairs[p, 0], scene.self_pairs[p, 1]
        dx = positions[a, 0] - positions[b, 0]
        dy = positions[a, 1] - positions[b, 1]
        dz = positions[a, 2] - positions[b, 2]
        spheres = scene.radius[a] + scene.radius[b] + scene.self_margin + ROUNDING
        if dx * dx + dy * dy + dz * dz > spheres * spheres:
            continue
        bound = row_lower_bound(
            scene.moving.kind,
            scene.moving.size,
            rotations,
            positions,
            a,
            scene.moving.kind,
            scene.moving.size,
            rotations,
            positions,
            b,
        )
        margin = scene.self_margin
        if bound > margin:
            continue
        deep = margin < 0.0  # never: that bodies overlap is enough to know
        if self_distance(scene, rotations, positions, a, b, margin, deep, witness) <= margin:
            return SELF_BROKEN
    return FREE


@kernel
def all_distances(scene, frames, rotations, positions, fixed, among, fixed_points, among_points):
    """Distances of every pair with a rule: `fixed` (m, f), `among` (p,), points (.., 2, 3).

    Pairs without a rule are left as they are. Nothing stops early: this is for explanations.
    """
    everything = np.inf
    deep = everything > 0.0  # a plain bool: a literal True would compile all of this again
    place_bodies(scene, 0, scene.frame.shape[0], frames, rotations, positions)
    for m in range(scene.frame.shape[0]):
        for f in range(scene.rule.shape[1]):
            if scene.rule[m, f] != 0:
                fixed[m, f] = fixed_distance(
                    scene, rotations, positions, m, f, everything, deep, fixed_points[m, f]
                )
    for p in range(scene.self_pairs.shape[0]):
        a, b = scene.self_pairs[p, 0], scene.self_pairs[p, 1]
        among[p] = self_distance(
            scene, rotations, positions, a, b, everything, deep, among_points[p]
        )
