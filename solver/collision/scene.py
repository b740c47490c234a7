"""The collision scene of a problem: every body packed for the kernels, and who is checked how.

Rules between a moving and a fixed body:

- *clearance*: the distance counts in the clearance d of the pose, and must be positive;
- *margin*: the distance must exceed a threshold of its own and does not enter d
  (near and contact bodies of the tool);
- a contact body may enter the group that its pass touches, to its stated depth.

Pairs of the robot and its tool among themselves ('self') have one margin. Neighbours that
always touch are no pairs.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from solver.collision.distance import pack_shape
from solver.collision.packed import PackedBodies, PackedScene
from solver.kinematics.arm import link_offsets
from solver.model.problem import PlanningProblem
from solver.model.robot import FLOOR_GROUP, TOOL_GROUP
from solver.model.shapes import (
    Body,
    Box,
    Capsule,
    ConvexShape,
    Cylinder,
    Hull,
    Mesh,
    Sphere,
    ToolRole,
)
from solver.transforms import FloatArray, IntArray, inverse, rigid

if TYPE_CHECKING:
    from solver.collision.mesh_distance import MeshObstacle
    from solver.collision.mesh_proxy import ConvexProxy

NO_PAIR, CLEARANCE, MARGIN, CONTACT = 0, 1, 2, 3
NO_TOUCH = -1


@dataclass(frozen=True, slots=True, eq=False)
class BodyLabel:
    """Whose body a row is: `owner` is robot, tool, workpiece or fixture; `role` of tool bodies."""

    owner: str
    group: str
    name: str
    role: ToolRole | None = None

    @property
    def is_floor(self) -> bool:
        """Whether this is the floor; its name is reserved among fixtures."""
        return self.owner == "fixture" and self.name == FLOOR_GROUP

    def __str__(self) -> str:
        return self.group if self.group == self.name else f"{self.group} ({self.name})"


@dataclass(frozen=True, slots=True)
class MeshRule:
    """How moving body `row` is checked against mesh number `mesh`; lengths in [m]."""

    row: int
    mesh: int
    rule: int
    threshold: float
    depth: float
    touch_group: int

    @property
    def counts(self) -> bool:
        """Whether the distance counts in the clearance d."""
        return self.rule == CLEARANCE


@dataclass(frozen=True, eq=False)
class CollisionScene:
    """The packed scene with the names behind its rows.

    `shapes` are those of the moving bodies. `meshes` are the fixed triangle meshes with their
    pose in fanuc_world; they are no rows of the packed scene and are checked apart.
    `touch_names` gives the number of each group.
    """

    packed: PackedScene
    moving: tuple[BodyLabel, ...]
    fixed: tuple[BodyLabel, ...]
    shapes: tuple[ConvexShape, ...]
    meshes: tuple[tuple[BodyLabel, Mesh, FloatArray], ...]
    mesh_rules: tuple[MeshRule, ...]
    touch_names: tuple[str, ...]

    @cached_property
    def mesh_obstacles(self) -> tuple[MeshObstacle, ...]:
        """The meshes with their search structures, made once."""
        # python-fcl and trimesh are loaded only where a scene holds meshes.
        from solver.collision.mesh_distance import MeshObstacle  # noqa: PLC0415

        return tuple(MeshObstacle(mesh, pose) for _, mesh, pose in self.meshes)

    @cached_property
    def mesh_proxies(self) -> tuple[ConvexProxy, ...]:
        """Polyhedra that contain the moving bodies, for distances to meshes."""
        from solver.collision.mesh_proxy import ConvexProxy  # noqa: PLC0415

        return tuple(ConvexProxy(shape) for shape in self.shapes)

    def touch_number(self, group: str) -> int:
        """The number of a workpiece group, -1 for none."""
        return self.touch_names.index(group) if group in self.touch_names else NO_TOUCH

    @property
    def pair_count(self) -> int:
        """Number of body pairs that a pose is checked for."""
        return (
            int(np.count_nonzero(self.packed.rule))
            + len(self.packed.self_pairs)
            + len(self.mesh_rules)
        )


def build_scene(problem: PlanningProblem) -> CollisionScene:
    """Pack the robot's chosen bodies, the tool, the workpiece and the fixtures of a problem."""
    moving = _moving_bodies(problem)
    fixed, meshes, clusters = _fixed_bodies(problem)
    touch_names = problem.workpiece.groups
    labels = [label for label, *_ in moving]
    fixed_labels = [label for label, _, _ in fixed]
    tool = {body.body.name: body for body in problem.tool.bodies}
    rule = np.zeros((len(moving), len(fixed)), np.int64)
    threshold = np.zeros((len(moving), len(fixed)))
    depth = np.zeros(len(moving))
    for row, label in enumerate(labels):
        if label.role is ToolRole.CONTACT:
            depth[row] = tool[label.name].depth
        for column, other in enumerate(fixed_labels):
            if _are_neighbours(problem, label, other):
                continue
            rule[row, column] = _rule_of(label)
            if label.role in (ToolRole.NEAR, ToolRole.CONTACT):
                threshold[row, column] = tool[label.name].margin
    touch = [touch_names.index(x.group) if x.owner == "workpiece" else -1 for x in fixed_labels]
    boxes = [_enclosing_box([fixed[i] for i in range(a, b)]) for a, b in clusters]
    packed = PackedScene(
        frame=np.array([frame for _, frame, _, _ in moving], np.int64),
        radius=np.array([_radius(shape) for _, _, shape, _ in moving]),
        tool=sum(label.owner == "robot" for label in labels),
        moving=_pack([(shape, pose) for _, _, shape, pose in moving]),
        fixed=_pack([(shape, pose) for _, shape, pose in fixed]),
        bound=_pack([_simple_bound(shape, pose) for _, shape, pose in fixed]),
        cluster_half=np.array([half for half, _ in boxes]).reshape(-1, 3),
        cluster_rotation=np.array([pose[:3, :3] for _, pose in boxes]).reshape(-1, 3, 3),
        cluster_position=np.array([pose[:3, 3] for _, pose in boxes]).reshape(-1, 3),
        cluster_start=np.array([a for a, _ in clusters], np.int64),
        cluster_stop=np.array([b for _, b in clusters], np.int64),
        cluster_rules=np.array(
            [[bool(rule[m, a:b].any()) for a, b in clusters] for m in range(len(moving))]
        ).reshape(len(moving), len(clusters)),
        rule=rule,
        threshold=threshold,
        touch_group=np.array(touch, np.int64),
        depth=depth,
        widest=np.where(rule > CLEARANCE, threshold, -np.inf).max(axis=1, initial=-np.inf),
        self_pairs=_self_pairs(problem, labels),
        self_margin=problem.settings.self_margin or 0.0,
    )
    mesh_rules = _mesh_rules(problem, labels, meshes)
    shapes = tuple(shape for _, _, shape, _ in moving)
    return CollisionScene(
        packed, tuple(labels), tuple(fixed_labels), shapes, meshes, mesh_rules, touch_names
    )


def _mesh_rules(
    problem: PlanningProblem,
    labels: list[BodyLabel],
    meshes: tuple[tuple[BodyLabel, Mesh, FloatArray], ...],
) -> tuple[MeshRule, ...]:
    tool = {body.body.name: body for body in problem.tool.bodies}
    groups = problem.workpiece.groups
    rules = []
    for row, label in enumerate(labels):
        for number, (other, _, _) in enumerate(meshes):
            if _are_neighbours(problem, label, other):
                continue
            body = tool.get(label.name) if label.owner == "tool" else None
            rules.append(
                MeshRule(
                    row,
                    number,
                    _rule_of(label),
                    body.margin if body else 0.0,
                    body.depth if body else 0.0,
                    groups.index(other.group) if other.owner == "workpiece" else NO_TOUCH,
                )
            )
    return tuple(rules)


def _rule_of(label: BodyLabel) -> int:
    if label.role is ToolRole.NEAR:
        return MARGIN
    if label.role is ToolRole.CONTACT:
        return CONTACT
    return CLEARANCE


def _are_neighbours(problem: PlanningProblem, one: BodyLabel, other: BodyLabel) -> bool:
    """Whether two bodies always touch; `one` moves.

    Of what stands still only the floor can be a neighbour, whatever else bears its name.
    """
    if other.owner == "workpiece" or (other.owner == "fixture" and not other.is_floor):
        return False
    names = (TOOL_GROUP if x.owner == "tool" else x.group for x in (one, other))
    return frozenset(names) in problem.robot.neighbours


def _self_pairs(problem: PlanningProblem, labels: list[BodyLabel]) -> IntArray:
    pairs = []
    if problem.settings.self_margin is not None:
        for first, one in enumerate(labels):
            for second in range(first + 1, len(labels)):
                other = labels[second]
                same = one.owner == other.owner and (
                    one.owner == "tool" or one.group == other.group
                )
                if not same and not _are_neighbours(problem, one, other):
                    pairs.append((first, second))
    return np.array(pairs, np.int64).reshape(-1, 2)


def _moving_bodies(
    problem: PlanningProblem,
) -> list[tuple[BodyLabel, int, ConvexShape, FloatArray]]:
    offsets = link_offsets(problem.robot)
    bodies = []
    for link_body in problem.robot_bodies:
        body = link_body.body
        label = BodyLabel("robot", body.group, body.name)
        pose = offsets[link_body.link] @ body.pose
        bodies.append((label, link_body.link, _convex(body), pose))
    for tool_body in problem.tool.bodies:
        body = tool_body.body
        label = BodyLabel("tool", body.group, body.name, tool_body.role)
        bodies.append((label, 6, _convex(body), problem.robot.flange @ body.pose))
    return bodies


def _convex(body: Body) -> ConvexShape:
    if isinstance(body.shape, Mesh):
        raise TypeError(f"body {body.name!r}: meshes serve for workpieces and fixtures only")
    return body.shape


def _fixed_bodies(
    problem: PlanningProblem,
) -> tuple[
    list[tuple[BodyLabel, ConvexShape, FloatArray]],
    tuple[tuple[BodyLabel, Mesh, FloatArray], ...],
    list[tuple[int, int]],
]:
    world_from_floor = problem.fanuc_world_from_floor
    convex = []
    meshes = []
    clusters = []
    world_from_piece = world_from_floor @ problem.workpiece.placement
    for body in problem.workpiece.bodies:
        label = BodyLabel("workpiece", body.group, body.name)
        if isinstance(body.shape, Mesh):
            meshes.append((label, body.shape, world_from_piece @ body.pose))
        else:
            convex.append((label, body.shape, world_from_piece @ body.pose))
    groups = [label.group for label, _, _ in convex]
    for first, group in enumerate(groups):
        if first == 0 or groups[first - 1] != group:
            last = first + 1
            while last < len(groups) and groups[last] == group:
                last += 1
            clusters.append((first, last))
    for body in problem.fixtures:
        label = BodyLabel("fixture", body.group, body.name)
        if isinstance(body.shape, Mesh):
            meshes.append((label, body.shape, world_from_floor @ body.pose))
        else:
            clusters.append((len(convex), len(convex) + 1))
            convex.append((label, body.shape, world_from_floor @ body.pose))
    return convex, tuple(meshes), clusters


def _pack(bodies: list[tuple[ConvexShape, FloatArray]]) -> PackedBodies:
    packed = [pack_shape(shape) for shape, _ in bodies]
    counts = np.array([len(one.vertices) for one in packed], np.int64)
    stop = np.cumsum(counts, dtype=np.int64)
    poses = np.array([pose for _, pose in bodies]).reshape(-1, 4, 4)
    vertices = [one.vertices for one in packed if len(one.vertices)]
    return PackedBodies(
        kind=np.array([one.kind for one in packed], np.int64),
        size=np.array([one.size for one in packed]).reshape(-1, 3),
        rotation=np.ascontiguousarray(poses[:, :3, :3]),
        position=np.ascontiguousarray(poses[:, :3, 3]),
        start=stop - counts,
        stop=stop,
        vertices=np.concatenate(vertices) if vertices else np.zeros((0, 3)),
    )


def _radius(shape: ConvexShape) -> float:
    """Radius of the sphere about the body's origin that contains it [m]."""
    if isinstance(shape, Sphere):
        return shape.radius
    if isinstance(shape, Capsule):
        return shape.length / 2 + shape.radius
    if isinstance(shape, Cylinder):
        return math.hypot(shape.length / 2, shape.radius)
    corners = shape.size / 2 if isinstance(shape, Box) else shape.vertices
    return float(np.linalg.norm(corners, axis=-1).max())


def _simple_bound(shape: ConvexShape, pose: FloatArray) -> tuple[ConvexShape, FloatArray]:
    """The shape itself, or for a hull the box along its own axes that contains it."""
    if not isinstance(shape, Hull):
        return shape, pose
    low, high = shape.vertices.min(axis=0), shape.vertices.max(axis=0)
    return Box(high - low), pose @ rigid(position=(low + high) / 2)


def _enclosing_box(
    bodies: list[tuple[BodyLabel, ConvexShape, FloatArray]],
) -> tuple[FloatArray, FloatArray]:
    """Half extents and pose of a box, aligned with the first body, that contains all bodies."""
    axes = bodies[0][2]
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for _, shape, pose in bodies:
        local = inverse(axes) @ pose
        bottom, top = _extent(shape, local)
        low, high = np.minimum(low, bottom), np.maximum(high, top)
    centre = axes @ np.append((low + high) / 2, 1.0)
    pose = axes.copy()
    pose[:, 3] = centre
    return (high - low) / 2, pose


def _extent(shape: ConvexShape, pose: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Axis-aligned bounds of a posed shape (exact but for cylinders, whose rim is rounded up)."""
    rotation, centre = pose[:3, :3], pose[:3, 3]
    if isinstance(shape, Hull):
        points = shape.vertices @ rotation.T + centre
        return points.min(axis=0), points.max(axis=0)
    if isinstance(shape, Box):
        reach = np.abs(rotation) @ (shape.size / 2)
    elif isinstance(shape, Sphere):
        reach = np.full(3, shape.radius)
    else:
        reach = np.abs(rotation[:, 2]) * shape.length / 2 + shape.radius
    return centre - reach, centre + reach
