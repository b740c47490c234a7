"""The M-20iA in plain numpy from its published D-H table, and points on the moving bodies.

Nothing of the product computes here. Sources: FANUC manual B-82874EN/06 and the public
ros-industrial description. Lengths in m, angles in rad, poses in fanuc_world.
"""

from __future__ import annotations

import itertools

import numpy as np

from solver.model.shapes import Box, Capsule, Cylinder, Sphere

# alpha_{i-1}, a_{i-1}, d_i, offset of the matrix angle.
ROWS = (
    (0.0, 0.0, 0.0, 0.0),
    (-np.pi / 2, 0.150, 0.0, -np.pi / 2),
    (0.0, 0.790, 0.0, 0.0),
    (-np.pi / 2, 0.250, 0.835, 0.0),
    (np.pi / 2, 0.0, 0.0, 0.0),
    (-np.pi / 2, 0.0, 0.0, 0.0),
)
FLANGE = 0.100
SPEEDS = np.radians([195.0, 175.0, 180.0, 360.0, 360.0, 550.0])
LINK_ORIGINS = np.array(
    [
        [0.0, 0.0, -0.525],
        [0.0, 0.0, 0.0],
        [0.150, 0.0, 0.0],
        [0.150, 0.0, 0.790],
        [0.150, 0.0, 1.040],
        [0.985, 0.0, 1.040],
        [0.985, 0.0, 1.040],
    ]
)


def frames(pendant: np.ndarray) -> list[np.ndarray]:
    """World poses of the seven D-H frames at the pendant's joints (6,)."""
    one, two, three, four, five, six = pendant
    angles = (one, two, -two - three, -four, -five, -six)
    pose, found = np.eye(4), [np.eye(4)]
    for (alpha, a, d, offset), theta in zip(ROWS, angles, strict=True):
        c, s, ca, sa = np.cos(theta + offset), np.sin(theta + offset), np.cos(alpha), np.sin(alpha)
        pose = pose @ np.array(
            [
                [c, -s, 0.0, a],
                [s * ca, c * ca, -sa, -sa * d],
                [s * sa, c * sa, ca, ca * d],
                [0.0, 0.0, 0.0, 1.0],
            ]
        )
        found.append(pose)
    return found


def tcp_pose(pendant: np.ndarray, flange_from_tcp: np.ndarray) -> np.ndarray:
    """(4, 4) pose of the TCP."""
    flange = np.eye(4)
    flange[2, 3] = FLANGE
    return frames(pendant)[6] @ flange @ flange_from_tcp


def tcp_poses(joints: np.ndarray, flange_from_tcp: np.ndarray) -> np.ndarray:
    """(m, 4, 4) poses of the TCP at joints (m, 6)."""
    return np.array([tcp_pose(row, flange_from_tcp) for row in joints])


def body_points(problem) -> list[tuple[int, np.ndarray]]:
    """(frame, (k, 4) points in that frame) of every moving body, and of the TCP."""
    at_zero = frames(np.zeros(6))
    flange = np.eye(4)
    flange[2, 3] = FLANGE
    found = []
    for one in problem.robot_bodies:
        link = np.eye(4)
        link[:3, 3] = LINK_ORIGINS[one.link]
        local = np.linalg.inv(at_zero[one.link]) @ link @ one.body.pose
        found.append((one.link, surface_points(one.body.shape) @ local.T))
    found += [
        (6, surface_points(one.body.shape) @ (flange @ one.body.pose).T)
        for one in problem.tool.bodies
    ]
    tcp = (flange @ problem.tool.tcp)[:, 3]
    return [*[(frame, points) for frame, points in found if frame > 0], (6, tcp[None])]


def surface_points(shape) -> np.ndarray:
    """(k, 4) extreme points of a shape, in its own frame."""
    ring = [(np.cos(a), np.sin(a), 0.0) for a in np.linspace(0.0, 2 * np.pi, 12, endpoint=False)]
    ball = np.array([*ring, *np.roll(ring, 1, axis=1), *np.roll(ring, 2, axis=1)])
    if isinstance(shape, Box):
        points = np.array(list(itertools.product((-0.5, 0.5), repeat=3))) * shape.size
    elif isinstance(shape, Sphere):
        points = shape.radius * ball
    else:
        assert isinstance(shape, Capsule | Cylinder)
        cap = ball if isinstance(shape, Capsule) else np.array(ring)
        end = np.array([0.0, 0.0, shape.length / 2])
        points = np.vstack([shape.radius * cap + end, shape.radius * cap - end])
    return np.column_stack([points, np.ones(len(points))])


def placed_points(points: list[tuple[int, np.ndarray]], pendant: np.ndarray) -> np.ndarray:
    """(k, 3) world positions of all points."""
    poses = frames(pendant)
    return np.vstack([(local @ poses[frame].T)[:, :3] for frame, local in points])


def numeric_jacobian(pendant: np.ndarray, flange_from_tcp: np.ndarray) -> np.ndarray:
    """(6, 6) central differences of the TCP: rows of velocity, then of angular velocity."""
    step = 1e-6
    columns = []
    here = tcp_pose(pendant, flange_from_tcp)[:3, :3]
    for joint in range(6):
        change = np.zeros(6)
        change[joint] = step
        ahead, behind = (tcp_pose(pendant + sign * change, flange_from_tcp) for sign in (1.0, -1.0))
        rate = (ahead - behind) / (2.0 * step)
        spin = rate[:3, :3] @ here.T
        columns.append([*rate[:3, 3], spin[2, 1], spin[0, 2], spin[1, 0]])
    return np.array(columns).T
