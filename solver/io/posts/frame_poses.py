"""The TCP's poses in a program's user frame, as the decimals of a file, and their proof."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from solver.errors import InputError, ModelError
from solver.io.posts.fanuc_text import angle_text, length_text
from solver.io.posts.joint_values import joint_degrees
from solver.io.posts.post import ANGLE_TOLERANCE, JOINT_TOLERANCE, POSITION_TOLERANCE
from solver.kinematics.arm import forward, inverse
from solver.kinematics.configuration import (
    branch_of,
    choose,
    config_string,
    configuration,
    parse_configuration,
)
from solver.model.program import JointProgram
from solver.model.robot import Robot
from solver.transforms import (
    FloatArray,
    rigid,
    rotation_angle,
    rotation_from_wpr,
    wpr_from_rotation,
)
from solver.transforms import inverse as inverse_transform
from solver.units import DEG, DEG_PER_RAD, MM, MM_PER_M


@dataclass(frozen=True, slots=True)
class FramePose:
    """X, Y, Z [mm] and W, P, R [deg] of uframe_from_tcp as texts, and the CONFIG."""

    texts: tuple[str, ...]
    config: str


def frame_poses(program: JointProgram, robot: Robot) -> tuple[FramePose, ...]:
    """Return the pose of every move, rounded to the file's decimals."""
    for number, move in enumerate(program.moves, start=1):
        try:
            joint_degrees(move)
        except ModelError as error:
            raise ModelError(f"{program.name}: position {number}: {error.message}") from error
    frame_from_world = inverse_transform(program.frame.pose)
    poses = frame_from_world @ forward(robot, program.joints, program.tool.pose)
    found = []
    for move, pose in zip(program.moves, poses, strict=True):
        place = [length_text(float(value)) for value in pose[:3, 3] * MM_PER_M]
        angles = [_turn_text(value * DEG_PER_RAD) for value in wpr_from_rotation(pose[:3, :3])]
        found.append(FramePose((*place, *angles), config_string(robot, move.joints)))
    return tuple(found)


def _turn_text(degrees: float) -> str:
    """Return an angle as text; half a turn is 180.000, whichever sign its last bit has."""
    text = angle_text(degrees)
    return "180.000" if text == "-180.000" else text


def proven_poses(program: JointProgram, robot: Robot) -> Iterator[FramePose]:
    """Yield the poses of all moves, each one solved again from its texts.

    Raises
    ------
    ModelError
        When what a controller computes from a position is not the posture that was chosen.
    """
    joints = program.joints
    tcp = forward(robot, joints, program.tool.pose)
    for number, pose in enumerate(frame_poses(program, robot), start=1):
        fault = _fault(program, robot, pose, joints[number - 1], tcp[number - 1])
        if fault:
            raise ModelError(
                f"{program.name}: position {number}: X..R with three decimals and CONFIG "
                f"'{pose.config}' do not lead back to the chosen joints: {fault}"
            )
        yield pose


def _fault(
    program: JointProgram, robot: Robot, pose: FramePose, joints: FloatArray, tcp: FloatArray
) -> str:
    """Return what is wrong with a position when it is solved again, '' when nothing is."""
    x, y, z, w, p, r = map(float, pose.texts)
    written = rigid(rotation_from_wpr(w * DEG, p * DEG, r * DEG), (x * MM, y * MM, z * MM))
    wide = np.array([-JOINT_TOLERANCE, JOINT_TOLERANCE])
    try:
        solutions = inverse(
            robot,
            program.frame.pose @ written,
            program.tool.pose,
            limits=robot.limits + wide,
            elbow_limits=robot.elbow_limits + wide,
        )
        found = choose(robot, solutions.joints, parse_configuration(pose.config))
    except InputError as error:
        return f"{error.message}; it lies near a singularity or at the edge of a turn"
    reached = forward(robot, found, program.tool.pose)
    off = float(np.linalg.norm(reached[:3, 3] - tcp[:3, 3]))
    turned = rotation_angle(reached[:3, :3].T @ tcp[:3, :3])
    if off > POSITION_TOLERANCE or turned > ANGLE_TOLERANCE:
        return f"the TCP is {off * MM_PER_M:.4f} mm and {turned * DEG_PER_RAD:.4f} deg away"
    if branch_of(robot, found) != branch_of(robot, joints):
        return "the arm is in another branch"
    if configuration(robot, found) != configuration(robot, joints):
        return f"CONFIG is {config_string(robot, found)!r}"
    joint = int(np.argmax(np.abs(found - joints)))
    apart = abs(float(found[joint] - joints[joint]))
    if apart > JOINT_TOLERANCE:
        return (
            f"J{joint + 1} is {apart * DEG_PER_RAD:.3f} deg away, more than "
            f"{JOINT_TOLERANCE * DEG_PER_RAD:g} deg, since a singularity is near"
        )
    return ""
