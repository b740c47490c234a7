"""Forward and inverse kinematics of a robot, in pendant joints and FANUC's world frame."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from solver.errors import InputError
from solver.kinematics import kernels_arm
from solver.kinematics.configuration import config_string
from solver.model.robot import JOINTS, Robot
from solver.model.settings import BRANCHES, Turns
from solver.transforms import FloatArray, IntArray, rigid
from solver.transforms import inverse as inverse_transform
from solver.units import DEG_PER_RAD, TURN

FRAMES = JOINTS + 1
RIGID_TOLERANCE = 1e-9
"""How far a pose's axes may be from unit length and square to each other."""


@dataclass(frozen=True, slots=True, eq=False)
class Branches:
    """The eight branches of one or many poses, limits aside.

    Attributes
    ----------
    joints : (..., 8, 6) array
        Pendant joints, each in (-pi, pi] [rad]; NaN where the arm cannot reach. Branch number
        = 4 back + 2 minus_root + (sin theta5 < 0).
    found : (..., 8) bool array
        Which branches reach the pose.
    """

    joints: FloatArray
    found: NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class Solutions:
    """All joint vectors within the limits that put the robot into one pose.

    Ascending in branch, and within a branch ascending in J1, then J2, ... then J6.

    Attributes
    ----------
    joints : (k, 6) array
        Pendant joints [rad].
    branch : (k,) array
        Branch numbers, 0 to 7.
    config : tuple of k strings
        FANUC CONFIG strings.
    reached : (8,) bool array
        Which branches reach the pose when limits are left aside.
    """

    joints: FloatArray
    branch: IntArray
    config: tuple[str, ...]
    reached: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.branch)


def model_from_pendant(robot: Robot, joints: ArrayLike) -> FloatArray:
    """(..., 6) model (D-H) angles of (..., 6) pendant joints [rad]."""
    return _joint_vectors(joints) @ robot.model_from_pendant.T


def pendant_from_model(robot: Robot, angles: ArrayLike) -> FloatArray:
    """(..., 6) pendant joints of (..., 6) model (D-H) angles [rad]; turns are kept."""
    return _joint_vectors(angles) @ robot.pendant_from_model.T


def forward_frames(robot: Robot, joints: ArrayLike) -> FloatArray:
    """Place the modified D-H frames at pendant joints.

    Parameters
    ----------
    robot : Robot
        Whose geometry and pendant convention.
    joints : (..., 6) array
        Pendant joints [rad].

    Returns
    -------
    (..., 7, 4, 4) array
        fanuc_world_from_frame: the base, then frames 1 to 6; the sixth is the wrist centre.
    """
    angles = model_from_pendant(robot, joints)
    rows = np.ascontiguousarray(angles.reshape(-1, JOINTS))
    frames = np.empty((len(rows), FRAMES, 3, 4))
    kernels_arm.forward_many(np.array(robot.arm_lengths), rows, frames)
    result = np.zeros((len(rows), FRAMES, 4, 4))
    result[:, :, :3, :] = frames
    result[:, :, 3, 3] = 1.0
    return result.reshape(*angles.shape[:-1], FRAMES, 4, 4)


def forward(robot: Robot, joints: ArrayLike, tool_tcp: ArrayLike | None = None) -> FloatArray:
    """Pose of the flange, or of the TCP, of pendant joints.

    Parameters
    ----------
    robot : Robot
        Whose geometry and pendant convention.
    joints : (..., 6) array
        Pendant joints [rad].
    tool_tcp : (4, 4) array, optional
        flange_from_tcp.

    Returns
    -------
    (..., 4, 4) array
        fanuc_world_from_flange, or fanuc_world_from_tcp.
    """
    wrist = forward_frames(robot, joints)[..., 6, :, :]
    pose: FloatArray = wrist @ _wrist_from_target(robot, tool_tcp)
    return pose


def forward_links(robot: Robot, joints: ArrayLike) -> FloatArray:
    """Link frames, which carry the robot's bodies, of pendant joints.

    Parameters
    ----------
    robot : Robot
        Whose geometry and pendant convention.
    joints : (..., 6) array
        Pendant joints [rad].

    Returns
    -------
    (..., 7, 4, 4) array
        fanuc_world_from_link; link 0 is the floor frame.
    """
    links: FloatArray = forward_frames(robot, joints) @ link_offsets(robot)
    return links


def link_offsets(robot: Robot) -> FloatArray:
    """(7, 4, 4) constant transforms frame_from_link between D-H frames and link frames.

    With all pendant joints at zero every link frame is parallel to fanuc_world; its origin
    lies on the joint's axis, and at the wrist centre for links 5 and 6.
    """
    a1, a2, a3, d4 = robot.arm_lengths
    origins = np.array(
        [
            [0.0, 0.0, -robot.world_height],
            [0.0, 0.0, 0.0],
            [a1, 0.0, 0.0],
            [a1, 0.0, a2],
            [a1, 0.0, a2 + a3],
            [a1 + d4, 0.0, a2 + a3],
            [a1 + d4, 0.0, a2 + a3],
        ]
    )
    links = np.stack([rigid(position=origin) for origin in origins])
    offsets: FloatArray = inverse_transform(forward_frames(robot, np.zeros(JOINTS))) @ links
    return offsets


def all_branches(robot: Robot, poses: ArrayLike, tool_tcp: ArrayLike | None = None) -> Branches:
    """All eight branches of one or many poses, irrespective of limits.

    Parameters
    ----------
    robot : Robot
        Whose geometry and pendant convention.
    poses : (..., 4, 4) array
        fanuc_world_from_flange, or fanuc_world_from_tcp when `tool_tcp` is given.
    tool_tcp : (4, 4) array, optional
        flange_from_tcp.

    Raises
    ------
    InputError
        A pose is not finite or not a rigid transform.

    Notes
    -----
    Section 3.1 of the paper, derived again. At a singularity the free angle is chosen:
    theta1 = 0 (pi at the back) with the wrist centre on the J1 axis, theta4 = 0 (pi for
    sin theta5 < 0) with joints 4 and 6 in line.
    """
    targets = _rigid_poses(poses)
    wrists = targets @ inverse_transform(_wrist_from_target(robot, tool_tcp))
    rows = np.ascontiguousarray(wrists.reshape(-1, 4, 4)[:, :3, :])
    angles = np.empty((len(rows), BRANCHES, JOINTS))
    found = np.empty((len(rows), BRANCHES), dtype=np.bool_)
    kernels_arm.inverse_many(np.array(robot.arm_lengths), rows, angles, found)
    shape = targets.shape[:-2]
    joints = principal(angles @ robot.pendant_from_model.T)
    return Branches(joints.reshape(*shape, BRANCHES, JOINTS), found.reshape(*shape, BRANCHES))


def inverse(
    robot: Robot,
    pose: ArrayLike,
    tool_tcp: ArrayLike | None = None,
    turns: Turns = Turns.ALL,
    *,
    limits: ArrayLike | None = None,
    elbow_limits: ArrayLike | None = None,
) -> Solutions:
    """Every joint vector within the limits that reaches a pose.

    Parameters
    ----------
    robot : Robot
        Whose geometry, pendant convention and limits.
    pose : (4, 4) array
        fanuc_world_from_flange, or fanuc_world_from_tcp when `tool_tcp` is given.
    tool_tcp : (4, 4) array, optional
        flange_from_tcp.
    turns : Turns
        Every +-360 deg representative inside the limits, or only the one in (-180, 180] deg.
    limits : (6, 2) array, optional
        Of the pendant's joints [rad]; the robot's own when left out.
    elbow_limits : (2,) array, optional
        Of J2 + J3 [rad]; the robot's own when left out.

    Raises
    ------
    InputError
        The pose is not finite or not a rigid transform.
    """
    bounds = robot.limits if limits is None else np.array(limits, dtype=np.float64)
    elbow = robot.elbow_limits if elbow_limits is None else np.array(elbow_limits, np.float64)
    branches = all_branches(robot, np.asarray(pose, dtype=np.float64).reshape(4, 4), tool_tcp)
    rows: list[FloatArray] = []
    numbers: list[int] = []
    for branch in np.flatnonzero(branches.found):
        inside = representatives(branches.joints[branch], bounds, turns)
        bend = inside[:, 1] + inside[:, 2]
        tolerance = kernels_arm.LIMIT_TOLERANCE
        inside = inside[(bend >= elbow[0] - tolerance) & (bend <= elbow[1] + tolerance)]
        rows.append(inside)
        numbers.extend([int(branch)] * len(inside))
    joints = np.concatenate(rows) if rows else np.empty((0, JOINTS))
    return Solutions(
        joints=joints,
        branch=np.array(numbers, dtype=np.int64),
        config=tuple(config_string(robot, row) for row in joints),
        reached=branches.found,
    )


def principal(joints: ArrayLike) -> FloatArray:
    """Angles of any shape moved by whole turns to (-pi, pi] [rad]; NaN stays NaN."""
    angles = np.asarray(joints, dtype=np.float64)
    wrapped = angles - TURN * np.ceil((angles - math.pi) / TURN)
    result: FloatArray = np.where(wrapped <= -math.pi, wrapped + TURN, wrapped)
    return result


def representative_capacity(limits: ArrayLike) -> int:
    """Most representatives that one posture can have inside `limits` (6, 2) [rad].

    An interval of length r holds at most floor(r / 360 deg) + 1 angles 360 deg apart.
    """
    bounds = np.asarray(limits, dtype=np.float64)
    ranges = bounds[:, 1] - bounds[:, 0] + 2.0 * kernels_arm.LIMIT_TOLERANCE
    if not np.all(np.isfinite(ranges)):
        raise InputError("joint limits must be finite to count turns within them")
    return int(np.prod(np.floor(np.maximum(ranges, -TURN) / TURN) + 1.0))


def representatives(joints: ArrayLike, limits: ArrayLike, turns: Turns = Turns.ALL) -> FloatArray:
    """Every +-360 deg representative of a joint vector inside the limits.

    Parameters
    ----------
    joints : (6,) array
        Pendant joints [rad].
    limits : (6, 2) array
        Lower and upper limits of the pendant's joints [rad].
    turns : Turns
        All representatives, or only the one with every joint in (-pi, pi].

    Returns
    -------
    (k, 6) array
        Ascending in J1, then J2, ... then J6.
    """
    bounds = np.array(limits, dtype=np.float64)
    out = np.empty((max(1, representative_capacity(bounds)), JOINTS))
    count = kernels_arm.representatives(
        np.array(joints, dtype=np.float64), bounds, turns is Turns.PRINCIPAL, out
    )
    if count < 0:
        raise InputError(
            "joint angles and limits must be finite and below "
            f"{kernels_arm.ANGLE_BOUND * DEG_PER_RAD:g} deg to count turns within them"
        )
    return out[:count]


def _joint_vectors(joints: ArrayLike) -> FloatArray:
    vectors = np.asarray(joints, dtype=np.float64)
    if vectors.ndim == 0 or vectors.shape[-1] != JOINTS:
        raise InputError(f"a joint vector has {JOINTS} angles, got an array {vectors.shape}")
    return vectors


def _wrist_from_target(robot: Robot, tool_tcp: ArrayLike | None) -> FloatArray:
    if tool_tcp is None:
        return robot.flange
    target: FloatArray = robot.flange @ _rigid_poses(tool_tcp)
    return target


def _rigid_poses(poses: ArrayLike) -> FloatArray:
    """(..., 4, 4) transforms, refused when they are not rigid."""
    targets = np.asarray(poses, dtype=np.float64)
    if targets.shape[-2:] != (4, 4):
        raise InputError(f"a pose is a 4 x 4 transform, got an array {targets.shape}")
    if not np.all(np.isfinite(targets)):
        raise InputError("a pose holds a number that is not finite")
    axes = targets[..., :3, :3]
    skewness = np.abs(np.swapaxes(axes, -1, -2) @ axes - np.eye(3)).max(initial=0.0)
    bottom = np.abs(targets[..., 3, :] - [0.0, 0.0, 0.0, 1.0]).max(initial=0.0)
    if max(skewness, bottom) > RIGID_TOLERANCE or np.any(np.linalg.det(axes) < 0.0):
        raise InputError(
            "a pose is not a rigid transform: its axes are not of unit length, square to each "
            f"other and right-handed (largest deviation {max(skewness, bottom):.2g})"
        )
    return targets
