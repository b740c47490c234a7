"""Geometric Jacobian and the manipulability that follows from it."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from solver.kinematics import kernels_arm
from solver.kinematics.arm import forward, forward_frames, model_from_pendant
from solver.model.robot import JOINTS, Robot
from solver.transforms import FloatArray


def jacobian(robot: Robot, joints: ArrayLike, tool_tcp: ArrayLike | None = None) -> FloatArray:
    """Geometric Jacobian of the flange, or of the TCP, for the pendant's joints.

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
    (..., 6, 6) array
        Columns belong to J1..J6; rows 0 to 2 are the point's velocity [m/rad], rows 3 to 5 the
        angular velocity [rad/rad], both in fanuc_world.
    """
    frames = forward_frames(robot, joints)
    point = forward(robot, joints, tool_tcp)[..., :3, 3]
    axes = frames[..., 1:, :3, 2]
    arms = point[..., np.newaxis, :] - frames[..., 1:, :3, 3]
    linear = np.swapaxes(np.cross(axes, arms), -1, -2)
    of_model = np.concatenate([linear, np.swapaxes(axes, -1, -2)], axis=-2)
    result: FloatArray = of_model @ robot.model_from_pendant
    return result


def manipulability(jacobian: FloatArray) -> FloatArray:
    """Yoshikawa measure sqrt(det(J J^T)) of square Jacobians.

    Parameters
    ----------
    jacobian : (..., 6, 6) array
        Geometric Jacobians; linear rows in [m/rad].

    Returns
    -------
    (...) array
        The measure [m^3]; zero at a singular configuration.

    Notes
    -----
    Section 3.1 of the paper. For a square Jacobian the measure equals ``|det J|``.
    """
    result: FloatArray = np.abs(np.linalg.det(jacobian))
    return result


def posture_manipulability(robot: Robot, joints: ArrayLike) -> FloatArray:
    """Evaluate the closed form of the manipulability at pendant joints (..., 6) [rad].

    Returns
    -------
    (...) array
        |a2 (s2 F3 - c2 F1)| |R| |s5| [m^3], with F1 = a3 s23 + d4 c23, F3 = a3 c23 - d4 s23 and
        R = a1 + a2 s2 + F1. Joints 1, 4 and 6 and the tool have no part in it.

    Notes
    -----
    Section 3.1 of the paper. This is the measure for model angles; it holds for the pendant's
    joints too where their convention keeps volumes (determinant +-1), as FANUC's does.
    """
    angles = model_from_pendant(robot, joints)
    rows = np.ascontiguousarray(angles.reshape(-1, JOINTS))
    measures = np.empty(len(rows))
    kernels_arm.manipulability_many(np.array(robot.arm_lengths), rows, measures)
    return measures.reshape(angles.shape[:-1])
