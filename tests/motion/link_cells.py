"""Cells with two passes and fixtures in the way, and an oracle of what is free on a move.

The oracle follows a move by itself: linear in the joints, or the TCP on a line with scipy's
rotations and the product's inverse for the joints in between, which must arrive at the stated
ones. Distances are coal's, on the bodies of tests/integration/cell_oracle.py, which shares no
code with the product. Pairs whose bounding boxes and spheres are far apart are passed over.
"""

from __future__ import annotations

import importlib.util
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

import solver
from solver.kinematics.arm import inverse
from solver.model.program import MotionKind, Move, Speed, rounded_joints
from solver.model.program_settings import LinkSettings
from solver.model.shapes import Body, Box
from solver.model.toolpath import Role
from solver.pipeline.planning import plan
from solver.transforms import rigid

_spec = importlib.util.spec_from_file_location(
    "cell_oracle_of_links", Path(__file__).parents[1] / "integration" / "cell_oracle.py"
)
cell_oracle = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(cell_oracle)

HOME = np.radians([0.0, -30.0, 20.0, 0.0, -70.0, 0.0])
REACH = np.array([2.6, 2.3, 1.7, 0.75, 0.75, 0.75])
"""More than any point of arm and tool is from each joint's axis [m]."""


def two_passes(problem, first, second):
    """The groove in two passes: its `first` waypoints, and those from `second` on."""
    one = problem.toolpath.passes[0]
    left = replace(one, poses=one.poses[:first], roles=one.roles[:first], name="left")
    right = replace(one, poses=one.poses[second:], roles=one.roles[second:], name="right")
    return replace(problem, toolpath=problem.toolpath.with_passes((left, right)))


def contact_moves(rows, first_waypoint):
    """Contact moves as a program has them."""
    return tuple(
        Move(row, Speed.duration(0.6), MotionKind.JOINT, 100, waypoint=first_waypoint + index)
        for index, row in enumerate(rows)
    )


def with_links(problem, *fixtures, **settings):
    """The problem with links and more fixtures."""
    program = replace(problem.program, links=LinkSettings(**settings))
    return replace(problem, program=program, fixtures=(*problem.fixtures, *fixtures))


def box(name, low, high):
    """A fixture between two corners in the floor frame [m]."""
    low, high = np.array(low), np.array(high)
    return Body(name, Box(high - low), rigid(position=(low + high) / 2))


class Groove:
    """The groove on HW300 in two passes with its planned joints."""

    def __init__(self, first=12, second=38):
        whole = solver.load_cell("groove_hw300")
        joints = rounded_joints(plan(whole).sequence.pendant)
        self.problem = two_passes(whole, first, second)
        self.joints = (joints[:first], joints[second:])
        self.contact = (contact_moves(joints[:first], 0), contact_moves(joints[second:], first))


def tcp(pendant):
    """TCP pose in the floor frame by the oracle's D-H product."""
    return cell_oracle.tcp_of(pendant)


def positions(moves):
    """(n, 3) TCP positions in the floor frame."""
    return np.array([tcp(move.joints)[:3, 3] for move in moves])


def followed(problem, start, move, step):
    """Joints along a move, no body travelling farther than `step` between two of them."""
    count = int(np.ceil(np.abs(move.joints - start) @ REACH / step)) + 1
    shares = np.linspace(0.0, 1.0, count + 1)
    if move.kind is MotionKind.JOINT:
        yield from start + shares[:, None] * (move.joints - start)
        return
    one, other = tcp(start), tcp(move.joints)
    turned = Slerp([0.0, 1.0], Rotation.from_matrix([one[:3, :3], other[:3, :3]]))(shares)
    joints = start
    for share, rotation in zip(shares, turned.as_matrix(), strict=True):
        pose = rigid(rotation, (1 - share) * one[:3, 3] + share * other[:3, 3])
        solutions = inverse(problem.robot, problem.fanuc_world_from_floor @ pose, problem.tool.tcp)
        joints = min(solutions.joints, key=lambda row: np.abs(row - joints).sum())
        yield joints
    assert np.abs(joints - move.joints).max() < np.radians(0.002)


class FreeOracle(cell_oracle.CellOracle):
    """What a posture lacks of clearance, margins and self distances, by coal."""

    def __init__(self, coal, fixtures=()):
        super().__init__(coal, cell_oracle.FULL)
        for fixture in fixtures:
            shape = coal.Box(*map(float, fixture.shape.size))
            solid = cell_oracle.Solid(fixture.name, "fixture", -1, shape, fixture.pose)
            self.fixed.append((solid, self._place(fixture.pose)))
        self.radius = [self._radius(solid) for solid in self.moving]
        boxes = [self._bounds(solid) for solid, _ in self.fixed]
        self.low, self.high = (np.array(corners) for corners in zip(*boxes, strict=True))

    def _radius(self, solid):
        """Radius of a sphere about the body's origin that contains it."""
        solid.shape.computeLocalAABB()
        centre = np.asarray(solid.shape.aabb_center).ravel()
        return float(np.linalg.norm(centre) + solid.shape.aabb_radius)

    def _bounds(self, solid):
        """Corners of the box along the floor's axes that contains a fixed body."""
        if isinstance(solid.shape, self.coal.Halfspace):
            return np.full(3, -np.inf), np.array([np.inf, np.inf, 0.0])
        assert np.array_equal(solid.pose[:3, :3], np.eye(3))
        solid.shape.computeLocalAABB()
        local = solid.shape.aabb_local
        corners = np.array([local.min_, local.max_]).reshape(2, 3) + solid.pose[:3, 3]
        return corners[0], corners[1]

    def lack(self, pendant, clearance, *, touches_web):
        """The most that any pair lacks of its distance [m], negative or 0 when all is kept."""
        links = cell_oracle.links_of(pendant)
        poses = [links[solid.link] @ solid.pose for solid in self.moving]
        places = [self._place(pose) for pose in poses]
        worst = -np.inf
        for row, solid in enumerate(self.moving):
            centre = poses[row][:3, 3]
            beside = np.maximum(np.maximum(self.low - centre, centre - self.high), 0.0)
            near = np.linalg.norm(beside, axis=1) - self.radius[row]
            for column in np.flatnonzero(near < clearance + 1e-3):
                other, other_place = self.fixed[column]
                if frozenset((solid.owner, other.owner)) in cell_oracle.TOUCHING:
                    continue
                least = clearance
                if solid.name in {"shank", "ball"}:
                    touching = solid.name == "ball" and other.name == "web" and touches_web
                    least = -cell_oracle.DEPTH if touching else cell_oracle.NEAR
                gap = self._gap(solid.shape, places[row], other.shape, other_place)
                worst = max(worst, least - gap)
        for one, two in self.own_pairs:
            away = np.linalg.norm(poses[one][:3, 3] - poses[two][:3, 3])
            if away - self.radius[one] - self.radius[two] > cell_oracle.SELF + 1e-3:
                continue
            gap = self._gap(
                self.moving[one].shape, places[one], self.moving[two].shape, places[two]
            )
            worst = max(worst, cell_oracle.SELF - gap)
        return worst


def may_touch(before, move):
    """Whether a move is the one onto the face or the one off it."""
    return (before.role is Role.CONTACT) != (move.role is Role.CONTACT)


def within_limits(problem, joints):
    """Whether a posture is inside the joint limits and the elbow's bound of the oracle."""
    low, high = problem.joint_limits.T
    low = np.maximum(low, cell_oracle.LOWER)
    high = np.minimum(high, cell_oracle.UPPER)
    bend = joints[1] + joints[2]
    inside = (joints >= low - 1e-9) & (joints <= high + 1e-9)
    return bool(inside.all()) and cell_oracle.ELBOW[0] <= bend <= cell_oracle.ELBOW[1]
