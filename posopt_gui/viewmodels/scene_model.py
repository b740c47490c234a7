"""What the 3D panel draws, as arrays: cell, path, trail, ghost, frames. All in fanuc_world [m]."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from posopt_gui.viewmodels.body_mesh import beam_surface, body_surface
from posopt_gui.viewmodels.robot_mesh import link_meshes
from posopt_gui.viewmodels.surface_mesh import (
    Colour,
    ShadedMesh,
    Surface,
    merged,
    moved,
    shaded,
)
from solver.candidates.outcomes import Outcome
from solver.model.robot import FLOOR_GROUP, JOINTS
from solver.model.shapes import ToolRole
from solver.transforms import FloatArray, inverse
from solver.units import DEG, MM

if TYPE_CHECKING:
    from solver.analysis.result import PlanningResult
    from solver.model.problem import PlanningProblem

TOOL_COLOURS: Mapping[ToolRole, Colour] = {
    ToolRole.CLEARANCE: (92, 114, 138, 255),
    ToolRole.NEAR: (196, 203, 210, 255),
    ToolRole.CONTACT: (0, 158, 115, 255),
}
STEEL: Colour = (158, 166, 175, 255)
FIXTURE: Colour = (104, 112, 121, 255)
BOUNDING: Colour = (30, 144, 200, 70)

NORMAL_LENGTH = 30.0 * MM
"""Length of a drawn surface normal [m]."""

TRAIL_STEPS = 6
"""Most drawn pieces of the TCP's way between two waypoints."""

TRAIL_PIECES = 6000
"""Most drawn pieces of a whole trail, but for one between any two waypoints."""

CABLE_WORDS = ("cable", "dress", "hose")
"""A body whose group has one of these words in its name models the cable package."""

TOOL_CARRIER = JOINTS
"""The link that carries the tool."""


@dataclass(frozen=True, slots=True, eq=False)
class PathLines:
    """The path: waypoints (n, 3) and lines (2 n, 3) from them against the tool's z [m]."""

    points: FloatArray
    normals: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class CellModel:
    """The cell for drawing.

    Attributes
    ----------
    problem : PlanningProblem
        What it was made of.
    links : mapping of link number to mesh
        In link frames.
    tool : mesh or None
        In the frame of the sixth link.
    fixed : mesh
        Workpiece and fixtures in fanuc_world.
    bounding : mapping of link number to mesh
        Robot and tool as collision checking sees them, in link frames.
    path : PathLines
    floor : float
        Height of the floor in fanuc_world [m].
    bounds : (k, 3) array
        Corners of path, workpiece and fixtures.
    cables : bool
        Whether a cable package is modelled.
    """

    problem: PlanningProblem
    links: Mapping[int, ShadedMesh]
    tool: ShadedMesh | None
    fixed: ShadedMesh
    bounding: Mapping[int, ShadedMesh]
    path: PathLines
    floor: float
    bounds: FloatArray
    cables: bool

    @property
    def rest(self) -> FloatArray:
        """(6,) pendant joints [rad] where there is no plan: the home posture."""
        links = self.problem.program.links
        home = None if links is None else links.home
        return np.array([0.0, 0.0, 0.0, 0.0, -90.0 * DEG, 0.0]) if home is None else home

    def links_at(self, joints: FloatArray) -> FloatArray:
        """(7, 4, 4) fanuc_world_from_link at pendant joints (6,) [rad]."""
        from solver.kinematics.arm import forward_links  # noqa: PLC0415 - numba

        return forward_links(self.problem.robot, joints)

    def points_at(self, joints: FloatArray) -> FloatArray:
        """(k, 3) points around everything at pendant joints (6,) [rad]."""
        poses = self.links_at(joints)
        parts = [_placed(mesh, poses[link]) for link, mesh in self.links.items()]
        if self.tool is not None:
            parts.append(_placed(self.tool, poses[TOOL_CARRIER]))
        return np.concatenate([self.bounds, *parts])


def cell_model(problem: PlanningProblem) -> CellModel:
    """Build the meshes of a problem; some tens of milliseconds."""
    robot = problem.robot
    from solver.kinematics.arm import link_offsets  # noqa: PLC0415 - numba

    offsets = link_offsets(robot)
    link_from_flange = inverse(offsets[TOOL_CARRIER]) @ robot.flange
    tool = [
        moved(body_surface(one.body.shape, TOOL_COLOURS[one.role]), one.body.pose)
        for one in problem.tool.bodies
    ]
    fixed = shaded(merged(_fixed_surfaces(problem)))
    path = path_lines(problem)
    groups = {one.body.group for one in problem.robot_bodies}
    bounds = np.concatenate([_placed(fixed, np.eye(4)), path.points, path.normals])
    return CellModel(
        problem=problem,
        links=link_meshes(robot, problem.bodies),
        tool=shaded(moved(merged(tool), link_from_flange)) if tool else None,
        fixed=fixed,
        bounding=_bounding_meshes(problem, link_from_flange),
        path=path,
        floor=-robot.world_height,
        bounds=bounds,
        cables=any(word in group for word in CABLE_WORDS for group in groups),
    )


def _fixed_surfaces(problem: PlanningProblem) -> list[Surface]:
    world_from_floor = problem.fanuc_world_from_floor
    piece = problem.workpiece
    world_from_piece = world_from_floor @ piece.placement
    if piece.section is not None:
        surfaces = [beam_surface(piece.section, piece.length, STEEL)]
    else:
        surfaces = [moved(body_surface(one.shape, STEEL), one.pose) for one in piece.bodies]
    surfaces = [moved(one, world_from_piece) for one in surfaces]
    for body in problem.fixtures:
        if body.name != FLOOR_GROUP:
            surfaces.append(moved(body_surface(body.shape, FIXTURE), world_from_floor @ body.pose))
    return surfaces


def _bounding_meshes(
    problem: PlanningProblem, link_from_flange: FloatArray
) -> Mapping[int, ShadedMesh]:
    parts: dict[int, list[Surface]] = {}
    for one in problem.robot_bodies:
        surface = moved(body_surface(one.body.shape, BOUNDING), one.body.pose)
        parts.setdefault(one.link, []).append(surface)
    for tool in problem.tool.bodies:
        pose = link_from_flange @ tool.body.pose
        surface = moved(body_surface(tool.body.shape, BOUNDING), pose)
        parts.setdefault(TOOL_CARRIER, []).append(surface)
    return {link: shaded(merged(surfaces)) for link, surfaces in parts.items()}


def path_lines(problem: PlanningProblem) -> PathLines:
    """The waypoints with their normals: against the reference orientation's z."""
    poses = problem.waypoint_poses
    points = poses[:, :3, 3]
    ends = points - NORMAL_LENGTH * poses[:, :3, 2]
    return PathLines(points, np.stack([points, ends], axis=1).reshape(-1, 3))


def joints_at(pendant: FloatArray, place: float) -> FloatArray:
    """(6,) joints at a place between the rows of (n, 6), linear in the joints [rad]."""
    place = min(max(place, 0.0), len(pendant) - 1.0)
    row = min(int(place), len(pendant) - 2) if len(pendant) > 1 else 0
    share = place - row
    if share == 0.0:
        exact: FloatArray = pendant[row]
        return exact
    joints: FloatArray = (1.0 - share) * pendant[row] + share * pendant[row + 1]
    return joints


def tcp_trail(problem: PlanningProblem, pendant: FloatArray) -> FloatArray:
    """(k, 3) way of the TCP through a sequence of pendant joints (n, 6), moved by joint [m]."""
    steps = min(max(TRAIL_PIECES // len(pendant), 1), TRAIL_STEPS)
    count = (len(pendant) - 1) * steps + 1
    places = np.linspace(0.0, len(pendant) - 1.0, count)
    rows = np.arange(len(pendant))
    joints = np.column_stack([np.interp(places, rows, pendant[:, j]) for j in range(JOINTS)])
    from solver.kinematics.arm import forward  # noqa: PLC0415 - numba

    trail: FloatArray = forward(problem.robot, joints, problem.tool.tcp)[:, :3, 3]
    return trail


@dataclass(frozen=True, slots=True, eq=False)
class Ghost:
    """A candidate's pose: pendant joints (6,) [rad] and what became of the candidate."""

    joints: FloatArray
    outcome: Outcome


def ghost_at(result: PlanningResult, waypoint: int, orientation: int, branch: int) -> Ghost | None:
    """The pose of a cell of the map (`branch` is its slot), None where the arm cannot reach.

    Turns put every body into the same place, so that they need no pose of their own.
    """
    candidates = result.candidates
    shape = candidates.outcome.shape
    cell = (waypoint, orientation, branch)
    if any(not 0 <= index < size for index, size in zip(cell, shape, strict=True)):
        return None
    model = candidates.joints[cell]
    outcome = Outcome(int(candidates.outcome[cell]))
    if outcome is Outcome.UNREACHABLE or not np.isfinite(model).all():
        return None
    return Ghost(candidates.problem.robot.pendant_from_model @ model, outcome)


def named_frames(problem: PlanningProblem, joints: FloatArray) -> list[tuple[str, FloatArray]]:
    """Names and poses (4, 4) in fanuc_world of the frames that people work with."""
    from solver.kinematics.arm import forward  # noqa: PLC0415 - numba

    robot = problem.robot
    floor = problem.fanuc_world_from_floor
    return [
        ("fanuc_world", np.eye(4)),
        ("floor", floor),
        ("beam", floor @ problem.workpiece.placement),
        ("flange", forward(robot, joints)),
        ("TCP", forward(robot, joints, problem.tool.tcp)),
    ]


def axis_lines(poses: list[FloatArray], size: float) -> FloatArray:
    """(6 k, 3) ends of the axes x, y, z of k frames, each `size` [m] long."""
    ends = [
        point
        for pose in poses
        for axis in range(3)
        for point in (pose[:3, 3], pose[:3, 3] + size * pose[:3, axis])
    ]
    return np.array(ends)


def grid_lines(bounds: FloatArray, floor: float, spacing: float) -> FloatArray:
    """(2 k, 3) lines of the floor's grid around the robot and everything in `bounds` (m, 3)."""
    reach = np.abs(bounds[:, :2]).max(initial=1.0) + 0.5
    half = spacing * math.ceil(reach / spacing)
    ticks = np.arange(-half, half + spacing / 2.0, spacing)
    lines = []
    for tick in ticks:
        lines += [(tick, -half, floor), (tick, half, floor)]
        lines += [(-half, tick, floor), (half, tick, floor)]
    return np.array(lines)


def _placed(mesh: ShadedMesh, pose: FloatArray) -> FloatArray:
    """(k, 3) corners of a mesh, placed."""
    corners: FloatArray = mesh.corners.astype(np.float64) @ pose[:3, :3].T + pose[:3, 3]
    return corners
