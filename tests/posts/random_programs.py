"""Random programs of a robot away from singularities, and how far one is from its read form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from ls_examples import program
from program_examples import m20ia

from solver.io.ls_reader import read_program
from solver.io.posts import POSTS, PostOptions
from solver.kinematics.arm import forward, inverse
from solver.kinematics.configuration import branch_of, choose, configuration, parse_configuration
from solver.kinematics.jacobian import posture_manipulability
from solver.model.program import JointProgram, Move, NumberedPose, Speed, rounded_joints
from solver.transforms import rigid, rotation_angle, rotation_from_wpr

LEAST_MANIPULABILITY = 0.01
"""What planning asks of a posture by default in the shipped cells [m^3]."""

EDGE = np.radians(0.05)
"""How far joints stay from their limits and from the edges of turns [rad]."""


@dataclass
class Deviation:
    """The worst of many moves: [deg], [mm], [deg] and [deg]."""

    joints: float = 0.0
    place: float = 0.0
    angle: float = 0.0
    solved_joints: float = 0.0
    moves: int = 0


def random_pose(rng, reach):
    angles = rng.uniform(-np.pi, np.pi, 3)
    return rigid(rotation_from_wpr(*angles), rng.uniform(-reach, reach, 3))


def random_postures(rng, count):
    """Postures within the limits, not singular, and not at the edge of a turn."""
    robot = m20ia()
    low, high = robot.limits[:, 0] + EDGE, robot.limits[:, 1] - EDGE
    found = np.empty((0, 6))
    while len(found) < count:
        joints = rounded_joints(rng.uniform(low, high, (4 * count, 6)))
        elbow = joints[:, 1] + joints[:, 2]
        edges = np.abs(np.abs(joints[:, [3, 5]]) - np.pi).min(axis=1)
        good = (
            (elbow > robot.elbow_limits[0] + EDGE)
            & (elbow < robot.elbow_limits[1] - EDGE)
            & (edges > EDGE)
            & (posture_manipulability(robot, joints) > LEAST_MANIPULABILITY)
        )
        found = np.concatenate([found, joints[good]])
    return found[:count]


def random_program(rng) -> JointProgram:
    moves = [
        Move(row, Speed.percent(int(rng.integers(1, 101))))
        for row in random_postures(rng, int(rng.integers(1, 5)))
    ]
    return program(
        *moves,
        frame=NumberedPose(1, random_pose(rng, 1.0)),
        tool=NumberedPose(1, random_pose(rng, 0.3)),
    )


def note_joint_form(asked: JointProgram, worst: Deviation) -> None:
    (file,) = POSTS["fanuc-joint"].render(asked, PostOptions(), m20ia())
    read = read_program(file.text, file.name).path_joints()
    worst.joints = max(worst.joints, float(np.degrees(np.abs(read - asked.joints)).max()))


def note_cartesian_form(asked: JointProgram, worst: Deviation) -> None:
    robot = m20ia()
    (file,) = POSTS["fanuc-cartesian"].render(asked, PostOptions(), robot)
    positions = read_program(file.text, file.name).path_positions()
    for move, position in zip(asked.moves, positions, strict=True):
        place, angles = position.cartesian
        pose = asked.frame.pose @ rigid(rotation_from_wpr(*angles), place)
        solutions = inverse(robot, pose, asked.tool.pose)
        config = parse_configuration(position.first.config)
        joints = choose(robot, solutions.joints, config)
        assert branch_of(robot, joints) == branch_of(robot, move.joints)
        assert config == configuration(robot, joints) == configuration(robot, move.joints)
        reached, wanted = forward(robot, np.array([joints, move.joints]), asked.tool.pose)
        off = 1000.0 * float(np.linalg.norm(reached[:3, 3] - wanted[:3, 3]))
        turned = np.degrees(rotation_angle(reached[:3, :3].T @ wanted[:3, :3]))
        apart = float(np.degrees(np.abs(joints - move.joints)).max())
        worst.place = max(worst.place, off)
        worst.angle = max(worst.angle, float(turned))
        worst.solved_joints = max(worst.solved_joints, apart)
        worst.moves += 1
