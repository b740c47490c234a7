"""Checks of given postures: clearance with its bodies and points, at exported joints."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from solver.candidates.kernels_candidates import pose_of_joints
from solver.candidates.meshes import MeshChecker
from solver.collision.scene import CollisionScene
from solver.model.program import rounded_joints
from solver.model.robot import Robot
from solver.transforms import FloatArray, IntArray


@dataclass(frozen=True, slots=True, eq=False)
class PostureChecks:
    """Checks of k postures, in their order.

    `status` (k,) is FREE, HIT, MARGIN_BROKEN or SELF_BROKEN of `kernels_scene`; `clearance`
    (k,) [m]; `bodies` the names of the nearest pair; `points` (k, 2, 3) its nearest points in
    fanuc_world [m].
    """

    status: IntArray
    clearance: FloatArray
    bodies: tuple[tuple[str, str], ...]
    points: FloatArray


def check_postures(
    robot: Robot, scene: CollisionScene, pendant: FloatArray, touch: NDArray[np.int64]
) -> PostureChecks:
    """Check pendant joints (k, 6) [rad], rounded to the export's decimals first.

    `touch` (k,) is the number of the workpiece group that each pass touches, -1 for none.
    """
    return check_exact_postures(robot, scene, rounded_joints(pendant), touch)


def check_exact_postures(
    robot: Robot, scene: CollisionScene, pendant: FloatArray, touch: NDArray[np.int64]
) -> PostureChecks:
    """Check pendant joints (k, 6) [rad] as they are; see `check_postures`."""
    model = pendant @ robot.model_from_pendant.T
    arm = np.array(robot.arm_lengths)
    status, clearance, nearest, points = pose_of_joints(arm, scene.packed, model, touch)
    moving, fixed = [str(body) for body in scene.moving], [str(body) for body in scene.fixed]
    names = [(moving[m], fixed[f]) if m >= 0 else ("", "") for m, f in nearest.tolist()]
    if scene.meshes:
        MeshChecker(scene).refine(arm, model, touch, status, clearance, names, points)
    return PostureChecks(status, clearance, tuple(names), points)
