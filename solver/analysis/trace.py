"""Everything that a program's motion passes through, sampled once for all checks.

The controller's motion between two positions is followed in samples so fine that no point of
the robot or the tool moves more than 2 mm from one to the next.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solver.analysis.polyline import project
from solver.analysis.spans import Span, find_spans
from solver.collision.scene import CollisionScene, build_scene
from solver.kinematics.arm import forward
from solver.model.problem import PlanningProblem
from solver.model.program import JointProgram
from solver.motion.sweep import Sweep, sweep
from solver.motion.trajectory import MotionError, Way, body_reach, sampled_way
from solver.progress import Monitor, SilentMonitor, checkpoint
from solver.transforms import FloatArray, IntArray, rotation_vector, rotations_about

NO_SPAN = -1


@dataclass(frozen=True, slots=True, eq=False)
class Piece:
    """How a contact move follows its piece of the path, at its samples.

    `away` (m,) is the distance of the TCP from the path [m]; `angles` (m, 3) are lean, lead and
    spin against the reference there [rad]. `missed` is the largest distance of a waypoint
    within the piece from the moved TCP [m]; `passing` (p, 6) are the sampled joints [rad] that
    pass those waypoints.
    """

    away: FloatArray
    angles: FloatArray
    missed: float
    passing: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class ProgramTrace:
    """A program with its motion.

    Attributes
    ----------
    spans : tuple of Span
        The positions of each pass.
    span_of : (n,) array
        Number of the pass of each position, -1 for none.
    contact : (n - 1,) array of bool
        Which moves follow the path: those between two positions of one pass.
    touch : (n - 1,) array
        Workpiece group that contact bodies may touch on each move, -1 for none. They may on
        contact moves, and on the moves that come onto the face and leave it.
    ways, sweeps : tuples of n - 1
        Samples of each move, and how near the bodies come there.
    pieces : mapping of move number to Piece
        For contact moves.
    """

    problem: PlanningProblem
    program: JointProgram
    scene: CollisionScene
    reach: FloatArray
    poses: FloatArray
    spans: tuple[Span, ...]
    span_of: IntArray
    contact: np.ndarray[tuple[int], np.dtype[np.bool_]]
    touch: IntArray
    ways: tuple[Way, ...]
    sweeps: tuple[Sweep, ...]
    pieces: dict[int, Piece]

    def waypoint_of(self, position: int) -> int | None:
        """Number of the waypoint at or before a position, None away from the path."""
        number = int(self.span_of[position])
        if number == NO_SPAN:
            return None
        span = self.spans[number]
        return span.waypoint + int(span.segment[position - span.first])

    def place(self, move: int) -> str:
        """Words for where a move ends: its line in the file, or its number."""
        return self.program.moves[move].source or f"position {move + 1}"


def trace(
    problem: PlanningProblem, program: JointProgram, monitor: Monitor | None = None
) -> ProgramTrace | str:
    """Follow a program's motion, or say in a sentence why that is not possible."""
    monitor = monitor or SilentMonitor()
    joints = program.joints
    if not len(joints):
        return "the program holds no position"
    if not np.isfinite(joints).all():
        return "a joint is not a number"
    scene = build_scene(problem)
    reach = body_reach(problem, scene)
    poses = forward(problem.robot, joints, problem.tool.tcp)
    spans = find_spans(problem, poses[:, :3, 3])
    if spans is None:
        return f"{len(joints)} positions cannot follow {len(problem.toolpath.passes)} passes"
    span_of = np.full(len(joints), NO_SPAN, dtype=np.int64)
    for span in spans:
        span_of[span.first : span.last + 1] = span.number
    contact = (span_of[1:] == span_of[:-1]) & (span_of[1:] != NO_SPAN)
    touch = _touch(problem, scene, span_of)
    ways, sweeps, pieces = [], [], {}
    for move in range(len(joints) - 1):
        checkpoint(monitor, "check", move, len(joints) - 1)
        target = program.moves[move + 1]
        words = f"the move to {target.source or f'position {move + 2}'}"
        try:
            way = sampled_way(
                problem.robot, problem.tool.tcp, reach, target.kind,
                joints[move], joints[move + 1], move=words,
            )  # fmt: skip
        except MotionError as error:
            return str(error)
        ways.append(way)
        sweeps.append(sweep(problem, scene, way, int(touch[move])))
        if contact[move]:
            span = spans[span_of[move]]
            low, high = span.arc[move - span.first : move - span.first + 2]
            path = problem.waypoint_poses[span.waypoint : span.waypoint + len(span.which)]
            pieces[move] = follow(problem, path, float(low), float(high), way)
    return ProgramTrace(
        problem, program, scene, reach, poses, spans, span_of, contact, touch,
        tuple(ways), tuple(sweeps), pieces,
    )  # fmt: skip


def _touch(problem: PlanningProblem, scene: CollisionScene, span_of: IntArray) -> IntArray:
    groups = [scene.touch_number(one.touches) for one in problem.toolpath.passes]
    touch = np.full(max(len(span_of) - 1, 0), -1, dtype=np.int64)
    for move in range(len(touch)):
        before, after = int(span_of[move]), int(span_of[move + 1])
        # From one pass straight into another the tool would have to be lifted in between.
        if before == after != NO_SPAN or (before == NO_SPAN) != (after == NO_SPAN):
            touch[move] = groups[max(before, after)]
    return touch


def follow(problem: PlanningProblem, path: FloatArray, low: float, high: float, way: Way) -> Piece:
    """Compare a contact move with the piece of the path from its start to its end.

    `path` (n, 4, 4) holds fanuc_world_from_reference of a pass's waypoints; `low` and `high`
    are places on it, as segment + share.
    """
    begin = int(np.floor(low))
    nodes = np.arange(begin, max(min(int(np.ceil(high)), len(path) - 1), begin) + 1)
    piece = path[nodes]
    samples = way.poses(problem.robot, problem.tool.tcp)
    moved = samples[:, :3, 3]
    near = project(moved, piece[:, :3, 3])
    inner = np.flatnonzero((nodes > low) & (nodes < high))
    missed, passing = 0.0, np.empty((0, 6))
    if len(inner):
        passed = project(piece[inner, :3, 3], moved)
        missed = float(passed.distance.max())
        passing = way.joints[np.minimum(passed.segment + (passed.share > 0.5), len(way) - 1)]
    angles = _angles(piece[:, :3, :3], samples[:, :3, :3], near.segment, near.share)
    return Piece(near.distance, angles, missed, passing)


def _angles(
    reference: FloatArray, tool: FloatArray, segment: IntArray, share: FloatArray
) -> FloatArray:
    """(m, 3) lean, lead, spin of tool orientations against the turning reference [rad]."""
    if len(reference) == 1:
        return tool_angles(reference[0], tool)
    turned = np.empty_like(tool)
    for number in range(len(reference) - 1):
        rows = segment == number
        vector = rotation_vector(reference[number].T @ reference[number + 1])
        turned[rows] = reference[number] @ rotations_about(vector, share[rows])
    return tool_angles(turned, tool)


def tool_angles(reference: FloatArray, tool: FloatArray) -> FloatArray:
    """(..., 3) lean, lead and spin [rad] of tool against reference orientations (..., 3, 3)."""
    relative = np.swapaxes(reference, -1, -2) @ tool
    lead = np.arcsin(np.clip(-relative[..., 1, 2], -1.0, 1.0))
    lean = np.arctan2(relative[..., 0, 2], relative[..., 2, 2])
    spin = np.arctan2(relative[..., 1, 0], relative[..., 1, 1])
    return np.stack([lean, lead, spin], axis=-1)
