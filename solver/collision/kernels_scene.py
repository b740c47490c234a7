"""Kernels that check one pose of the whole scene: clearance, margins and self pairs."""

import numpy as np
from numba import njit

from solver.collision.kernels_distance import convex_distance, quick_lower_bound

FREE = 0
HIT = 1
MARGIN_BROKEN = 2
SELF_BROKEN = 3

_CLEARANCE = 1
_CONTACT = 3
_BOX = 3


@njit(cache=True, nogil=True)
def place_bodies(scene, frames, rotations, positions):
    """Poses of all moving bodies in fanuc_world from the (7, 3, 4) D-H frames."""
    for m in range(scene.frame.shape[0]):
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


@njit(cache=True, nogil=True)
def pair_threshold(scene, m, f, touch):
    """Least allowed distance of a margin or contact pair when the pass touches group `touch`."""
    if scene.rule[m, f] == _CONTACT and touch >= 0 and scene.touch_group[f] == touch:
        return -scene.depth[m]
    return scene.threshold[m, f]


@njit(cache=True, nogil=True)
def fixed_distance(scene, rotations, positions, m, f, witness):
    """Certified distance of moving body m to fixed body f."""
    moving, fixed = scene.moving, scene.fixed
    return convex_distance(
        moving.kind[m],
        moving.size[m],
        moving.vertices[moving.start[m] : moving.stop[m]],
        rotations[m],
        positions[m],
        fixed.kind[f],
        fixed.size[f],
        fixed.vertices[fixed.start[f] : fixed.stop[f]],
        fixed.rotation[f],
        fixed.position[f],
        witness,
    )


@njit(cache=True, nogil=True)
def self_distance(scene, rotations, positions, a, b, witness):
    """Certified distance of two moving bodies."""
    moving = scene.moving
    return convex_distance(
        moving.kind[a],
        moving.size[a],
        moving.vertices[moving.start[a] : moving.stop[a]],
        rotations[a],
        positions[a],
        moving.kind[b],
        moving.size[b],
        moving.vertices[moving.start[b] : moving.stop[b]],
        rotations[b],
        positions[b],
        witness,
    )


@njit(cache=True, nogil=True)
def _fixed_bound(scene, rotations, positions, m, f):
    return quick_lower_bound(
        scene.moving.kind[m],
        scene.moving.size[m],
        rotations[m],
        positions[m],
        scene.bound.kind[f],
        scene.bound.size[f],
        scene.bound.rotation[f],
        scene.bound.position[f],
    )


@njit(cache=True, nogil=True)
def _cluster_bound(scene, rotations, positions, m, c):
    return quick_lower_bound(
        scene.moving.kind[m],
        scene.moving.size[m],
        rotations[m],
        positions[m],
        _BOX,
        scene.cluster_half[c],
        scene.cluster_rotation[c],
        scene.cluster_position[c],
    )


@njit(cache=True, nogil=True)
def check_pose(scene, frames, touch, rotations, positions, witness, nearest, points):
    """Outcome and clearance of one pose; stops at the first pair that is out.

    `rotations` (m, 3, 3), `positions` (m, 3) and `witness` (2, 3) are work space; `nearest`
    (2,) receives the rows of the clearance pair and `points` (2, 3) its nearest points.
    Returns the outcome and the clearance d [m] (inf when no pair counts in d). Moving bodies
    are taken from the tool backwards, since the tool is what most often touches first.
    """
    place_bodies(scene, frames, rotations, positions)
    best = np.inf
    nearest[0] = -1
    nearest[1] = -1
    for m in range(scene.frame.shape[0] - 1, -1, -1):
        for c in range(scene.cluster_start.shape[0]):
            if not scene.cluster_rules[m, c]:
                continue
            bound = _cluster_bound(scene, rotations, positions, m, c)
            for f in range(scene.cluster_start[c], scene.cluster_stop[c]):
                rule = scene.rule[m, f]
                if rule == 0:
                    continue
                if rule == _CLEARANCE:
                    if bound >= best or _fixed_bound(scene, rotations, positions, m, f) >= best:
                        continue
                    d = fixed_distance(scene, rotations, positions, m, f, witness)
                    if d < best:
                        best = d
                        nearest[0] = m
                        nearest[1] = f
                        points[:] = witness
                        if best <= 0.0:
                            return HIT, best
                else:
                    least = pair_threshold(scene, m, f, touch)
                    if bound > least or _fixed_bound(scene, rotations, positions, m, f) > least:
                        continue
                    if fixed_distance(scene, rotations, positions, m, f, witness) <= least:
                        return MARGIN_BROKEN, np.nan
    for p in range(scene.self_pairs.shape[0]):
        a, b = scene.self_pairs[p, 0], scene.self_pairs[p, 1]
        bound = quick_lower_bound(
            scene.moving.kind[a],
            scene.moving.size[a],
            rotations[a],
            positions[a],
            scene.moving.kind[b],
            scene.moving.size[b],
            rotations[b],
            positions[b],
        )
        if bound > scene.self_margin:
            continue
        if self_distance(scene, rotations, positions, a, b, witness) <= scene.self_margin:
            return SELF_BROKEN, np.nan
    return FREE, best


@njit(cache=True, nogil=True)
def all_distances(scene, frames, rotations, positions, fixed, among, fixed_points, among_points):
    """Distances of every pair with a rule: `fixed` (m, f), `among` (p,), points (.., 2, 3).

    Pairs without a rule are left as they are. Nothing stops early: this is for explanations.
    """
    place_bodies(scene, frames, rotations, positions)
    for m in range(scene.frame.shape[0]):
        for f in range(scene.rule.shape[1]):
            if scene.rule[m, f] != 0:
                fixed[m, f] = fixed_distance(
                    scene, rotations, positions, m, f, fixed_points[m, f]
                )
    for p in range(scene.self_pairs.shape[0]):
        a, b = scene.self_pairs[p, 0], scene.self_pairs[p, 1]
        among[p] = self_distance(scene, rotations, positions, a, b, among_points[p])
