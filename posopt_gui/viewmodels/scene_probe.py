"""What a pose touches: the nearest two points with their distance, and the contact patches."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np

from posopt_gui.viewmodels.number_words import clearance_mm
from solver.candidates.explain import collision_margins
from solver.candidates.generate import touch_numbers
from solver.candidates.outcomes import Outcome
from solver.candidates.postures import check_exact_postures
from solver.collision.distance import PackedShape, pack_shape
from solver.collision.kernels_distance import convex_distance
from solver.collision.scene import CollisionScene
from solver.kinematics.arm import forward
from solver.model.problem import PlanningProblem
from solver.model.shapes import Body, Mesh, Sphere, ToolRole
from solver.model.tool import ToolBody
from solver.transforms import FloatArray
from solver.units import MM

TOUCHING = 0.5 * MM
"""A contact body nearer than this to its workpiece body is drawn as touching it [m]."""

ROUNDING = 1e-6
"""Depth beyond the allowed one that the estimate of a depth may be off by [m]."""

PATCH_SHARE = 1.3
"""Radius of the drawn patch of a ball over the ball's: the true one would hide under it."""

PLAIN_PATCH = 10.0 * MM
"""Radius of the drawn patch of any other contact body [m]."""


class Touch(Enum):
    """What a contact body does where it meets steel."""

    GROUND = "ground"
    """It touches the body of its pass, not deeper than allowed."""

    TOO_DEEP = "too deep"
    """It enters the body of its pass deeper than allowed."""

    ANOTHER = "another"
    """It enters a body that it must not touch."""


@dataclass(frozen=True, slots=True, eq=False)
class ContactPatch:
    """Where a contact body of the tool meets a body: `point` and unit `normal` (3,).

    `radius` is to be drawn; `depth` is how far it enters, negative where it stays away [m].
    """

    touch: Touch
    group: str
    point: FloatArray
    normal: FloatArray
    radius: float
    depth: float


@dataclass(frozen=True, slots=True, eq=False)
class PoseReport:
    """Clearance [m], never over-stated, its two bodies and nearest points (2, 3); the patches.

    `points` is None where nothing counts in the clearance.
    """

    clearance: float
    bodies: tuple[str, str]
    points: FloatArray | None
    patches: tuple[ContactPatch, ...]

    @property
    def millimetres(self) -> str:
        """The clearance for people, rounded down."""
        return f"{clearance_mm(self.clearance)} mm"


class PoseProbe:
    """Measures poses of one problem."""

    def __init__(self, problem: PlanningProblem, scene: CollisionScene) -> None:
        self.problem, self.scene = problem, scene
        self._touch = touch_numbers(problem, scene)
        self._contacts = [
            (one, _Placed(one.body, one.body.group))
            for one in problem.tool.bodies
            if one.role is ToolRole.CONTACT and not isinstance(one.body.shape, Mesh)
        ]
        floor = problem.fanuc_world_from_floor
        piece = floor @ problem.workpiece.placement
        fixed = [(one, piece, one.group) for one in problem.workpiece.bodies]
        fixed += [(one, floor, "") for one in problem.fixtures]
        self._fixed = [
            _Placed(one, group, parent)
            for one, parent, group in fixed
            if not isinstance(one.shape, Mesh)
        ]

    @property
    def quick(self) -> bool:
        """Whether a pose takes well under a millisecond; with meshes it takes several."""
        return not self.scene.meshes

    def prepare(self) -> None:
        """Have the kernels ready for poses that collide too."""
        self._deepest(np.zeros(6), 0, np.full((2, 3), np.nan))

    def measure(self, joints: FloatArray, waypoint: int) -> PoseReport:
        """Measure a pose of pendant joints (6,) [rad] on the pass of a waypoint."""
        touch = self._touch[waypoint : waypoint + 1]
        checks = check_exact_postures(self.problem.robot, self.scene, joints[None], touch)
        clearance, points = float(checks.clearance[0]), checks.points[0]
        bodies = checks.bodies[0]
        if clearance <= 0.0:
            # Where bodies meet, the check of postures stops; a person asks how deep they are.
            clearance, bodies, points = self._deepest(joints, waypoint, points)
        known = bool(np.isfinite(points).all()) and any(bodies)
        patches = self._patches(joints, waypoint)
        return PoseReport(clearance, bodies, points if known else None, patches)

    def _deepest(
        self, joints: FloatArray, waypoint: int, points: FloatArray
    ) -> tuple[float, tuple[str, str], FloatArray]:
        """Signed clearance of a pose that collides, with its two bodies and nearest points."""
        robot = self.problem.robot
        model = robot.model_from_pendant @ joints
        arm, touch = np.array(robot.arm_lengths), int(self._touch[waypoint])
        clearance, margins = collision_margins(self.scene, arm, model, touch)
        for one in margins:
            if one.filter is Outcome.COLLISION:
                moving, _, fixed = one.subject.partition(" and ")
                return clearance, (moving, fixed), points if one.points is None else one.points
        return clearance, ("", ""), points

    def _patches(self, joints: FloatArray, waypoint: int) -> tuple[ContactPatch, ...]:
        number = int(self.problem.toolpath.pass_index[waypoint])
        touches = self.problem.toolpath.passes[number].touches
        flange = forward(self.problem.robot, joints)
        patches: list[ContactPatch] = []
        for contact, body in self._contacts:
            pose = flange @ body.pose
            found = [
                _patch(contact, body, pose, fixed, fixed.group == touches != "")
                for fixed in self._fixed
            ]
            patches += [one for one in found if one is not None]
        return tuple(patches)


class _Placed:
    """A convex body with its pose in the parent frame, ready for the distance kernel."""

    def __init__(self, body: Body, group: str, parent: FloatArray | None = None) -> None:
        if isinstance(body.shape, Mesh):
            raise TypeError(f"body {body.name!r} is a mesh")
        self.name, self.group = body.group, group
        self.shape: PackedShape = pack_shape(body.shape)
        self.ball = body.shape.radius if isinstance(body.shape, Sphere) else 0.0
        self.pose = body.pose if parent is None else parent @ body.pose


def _gap(body: _Placed, pose: FloatArray, fixed: _Placed) -> tuple[float, FloatArray]:
    """Signed distance [m] of a placed body from a fixed one, and the fixed one's point."""
    witness = np.zeros((2, 3))
    a, b = body.shape, fixed.shape
    gap = convex_distance(
        a.kind,
        a.size,
        a.vertices,
        np.ascontiguousarray(pose[:3, :3]),
        np.ascontiguousarray(pose[:3, 3]),
        b.kind,
        b.size,
        b.vertices,
        np.ascontiguousarray(fixed.pose[:3, :3]),
        np.ascontiguousarray(fixed.pose[:3, 3]),
        witness,
    )
    return float(gap), witness[1]


def _patch(
    contact: ToolBody, body: _Placed, pose: FloatArray, fixed: _Placed, own: bool
) -> ContactPatch | None:
    """The patch of a contact body on a fixed one; `own` says that its pass touches that one."""
    gap, point = _gap(body, pose, fixed)
    if gap > (TOUCHING if own else 0.0):
        return None
    if not own:
        touch = Touch.ANOTHER
    else:
        touch = Touch.TOO_DEEP if -gap > contact.depth + ROUNDING else Touch.GROUND
    away = pose[:3, 3] - point
    size = float(np.linalg.norm(away))
    normal = away / size if size > 0.0 else -pose[:3, 2]
    radius = PATCH_SHARE * body.ball if body.ball else PLAIN_PATCH
    return ContactPatch(touch, fixed.name, point, normal, radius, -gap)
