"""Kernels that solve, filter and expand candidates, a range of tool poses at a time."""

import math

import numpy as np

from solver.collision.kernels_scene import (
    FREE,
    check_bodies,
    check_self,
    place_bodies,
)
from solver.kernel import kernel
from solver.kinematics.kernels_arm import (
    forward_frames,
    inverse_branches,
    manipulability,
    representatives,
)

_FEASIBLE = 0
_UNREACHABLE = 1
_JOINT_LIMIT = 2
_SINGULAR = 3
_COLLISION = 4
_UNKNOWN = -1
_TURN = 2.0 * math.pi
_TOLERANCE = 1e-12


@kernel
def to_pendant(convention, model, pendant):
    """Pendant joints in (-pi, pi] of model angles; `convention` is pendant_from_model (6, 6)."""
    for r in range(6):
        angle = 0.0
        for c in range(6):
            angle += convention[r, c] * model[c]
        angle -= _TURN * math.ceil((angle - math.pi) / _TURN)
        pendant[r] = angle


@kernel
def elbow_fits(joints, elbow):
    """Whether J2 + J3 lies inside the elbow's bounds."""
    angle = joints[1] + joints[2]
    return elbow[0] - _TOLERANCE <= angle <= elbow[1] + _TOLERANCE


@kernel
def kept_representatives(pendant, limits, elbow, principal_only, space):
    """Representatives inside limits and elbow bounds, moved to the front of `space`."""
    count = representatives(pendant, limits, principal_only, space)
    kept = 0
    for k in range(count):
        if elbow_fits(space[k], elbow):
            if kept != k:
                space[kept] = space[k]
            kept += 1
    return kept


@kernel
def multiply(a, b, out):
    """Product of two (3, 4) rigid transforms."""
    for r in range(3):
        for c in range(4):
            out[r, c] = a[r, 0] * b[0, c] + a[r, 1] * b[1, c] + a[r, 2] * b[2, c]
        out[r, 3] += a[r, 3]


@kernel
def evaluate_poses(
    begin,
    end,
    waypoints,
    reference_from_wrist,
    touch,
    arm,
    convention,
    limits,
    elbow,
    principal_only,
    eta,
    scene,
    branches,
    joints,
    outcome,
    clearance,
    turns,
    space,
):
    """Evaluate tool poses begin..end-1; pose p is waypoint p // o with orientation p % o.

    `waypoints` (n, 3, 4), `reference_from_wrist` (o, 3, 4), `touch` (n,). Fills `joints`
    (n, o, b, 6) with model angles of the principal pendant representative, `outcome` and
    `turns` (n, o, b) and `clearance` (n, o, b) [m], nan where it was not needed.
    """
    orientations = reference_from_wrist.shape[0]
    bodies = scene.frame.shape[0]
    wrist = np.empty((3, 4))
    solved = np.empty((8, 6))
    found = np.empty(8, np.bool_)
    frames = np.empty((7, 3, 4))
    pendant = np.empty(6)
    rotations = np.empty((bodies, 3, 3))
    positions = np.empty((bodies, 3))
    witness = np.empty((2, 3))
    points = np.empty((2, 3))
    nearest = np.empty(2, np.int64)
    for p in range(begin, end):
        n, o = p // orientations, p % orientations
        multiply(waypoints[n], reference_from_wrist[o], wrist)
        inverse_branches(arm, wrist, solved, found)
        # The tool's pose is that of the wrist: one check serves all branches.
        tool_status, tool_clearance = _UNKNOWN, np.inf
        for b in range(branches.shape[0]):
            branch = branches[b]
            clearance[n, o, b] = np.nan
            turns[n, o, b] = 0
            joints[n, o, b, :] = solved[branch]
            if not found[branch]:
                outcome[n, o, b] = _UNREACHABLE
                continue
            to_pendant(convention, solved[branch], pendant)
            count = kept_representatives(pendant, limits, elbow, principal_only, space)
            turns[n, o, b] = count
            if count == 0:
                outcome[n, o, b] = _JOINT_LIMIT
                continue
            if manipulability(arm, solved[branch]) <= eta:
                outcome[n, o, b] = _SINGULAR
                continue
            status, d = tool_status, tool_clearance
            # First the tool, if no branch of this pose has come so far, then the robot.
            for stage in range(2):
                if stage == 0:
                    if tool_status != _UNKNOWN:
                        continue
                    frames[6] = wrist
                    first, last, best = scene.tool, bodies, np.inf
                elif status != FREE:
                    break
                else:
                    forward_frames(arm, solved[branch], frames)
                    first, last, best = 0, scene.tool, tool_clearance
                place_bodies(scene, first, last, frames, rotations, positions)
                status, d = check_bodies(
                    scene,
                    first,
                    last,
                    touch[n],
                    best,
                    rotations,
                    positions,
                    witness,
                    nearest,
                    points,
                )
                if stage == 0:
                    tool_status, tool_clearance = status, d
            if status == FREE:
                status = check_self(scene, rotations, positions, witness)
                d = d if status == FREE else np.nan
            clearance[n, o, b] = d
            outcome[n, o, b] = _FEASIBLE if status == 0 else _COLLISION + status - 1


@kernel
def expand_nodes(
    begin,
    end,
    joints,
    outcome,
    clearance,
    convention,
    model_from_pendant,
    limits,
    elbow,
    principal_only,
    space,
    row,
    model,
    pendant_joints,
    node_clearance,
    candidate,
):
    """Write a node per representative of every feasible branch of poses begin..end-1.

    `row` is the first node to write; `candidate` (k, 4) receives waypoint, orientation,
    branch slot and turn. Returns the next free row.
    """
    orientations, slots = outcome.shape[1], outcome.shape[2]
    pendant = np.empty(6)
    for p in range(begin, end):
        n, o = p // orientations, p % orientations
        for b in range(slots):
            if outcome[n, o, b] != _FEASIBLE:
                continue
            to_pendant(convention, joints[n, o, b], pendant)
            count = kept_representatives(pendant, limits, elbow, principal_only, space)
            for k in range(count):
                for r in range(6):
                    pendant_joints[row, r] = space[k, r]
                    angle = 0.0
                    for c in range(6):
                        angle += model_from_pendant[r, c] * space[k, c]
                    model[row, r] = angle
                node_clearance[row] = clearance[n, o, b]
                candidate[row, 0] = n
                candidate[row, 1] = o
                candidate[row, 2] = b
                candidate[row, 3] = k
                row += 1
    return row


@kernel
def pose_of_joints(arm, scene, model, touch):
    """Outcome, clearance, rows of the nearest bodies and nearest points of many postures.

    `model` (k, 6) model angles, `touch` (k,). Returns arrays of k rows.
    """
    count = model.shape[0]
    bodies = scene.frame.shape[0]
    status = np.empty(count, np.int64)
    clearance = np.empty(count)
    nearest = np.empty((count, 2), np.int64)
    points = np.full((count, 2, 3), np.nan)
    frames = np.empty((7, 3, 4))
    rotations = np.empty((bodies, 3, 3))
    positions = np.empty((bodies, 3))
    witness = np.empty((2, 3))
    begin = np.int64(0)  # a plain number: a literal would compile check_bodies once more
    for k in range(count):
        forward_frames(arm, model[k], frames)
        place_bodies(scene, begin, bodies, frames, rotations, positions)
        nearest[k] = -1
        status[k], clearance[k] = check_bodies(
            scene,
            begin,
            bodies,
            touch[k],
            np.inf,
            rotations,
            positions,
            witness,
            nearest[k],
            points[k],
        )
        if status[k] == FREE:
            status[k] = check_self(scene, rotations, positions, witness)
            if status[k] != FREE:
                clearance[k] = np.nan
    return status, clearance, nearest, points
