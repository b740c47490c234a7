"""Candidates of a problem: waypoint x lean x lead x spin x branch x turn, filtered."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from solver.candidates.kernels_candidates import evaluate_poses, expand_nodes
from solver.candidates.meshes import MeshChecker
from solver.candidates.outcomes import Outcome
from solver.collision.scene import CollisionScene, build_scene
from solver.errors import Cancelled, ModelError
from solver.kinematics.arm import representative_capacity
from solver.model.problem import PlanningProblem
from solver.model.settings import PlanningSettings, Turns
from solver.progress import COMPILING, Monitor, SilentMonitor, checkpoint
from solver.transforms import (
    FloatArray,
    IntArray,
    inverse,
    rigid,
    rotation_x,
    rotation_y,
    rotation_z,
)

POSES_PER_CALL = 256
"""Tool poses a kernel call evaluates, so that it returns within some 20 ms."""

EXPANDED_PER_CALL = 16 * POSES_PER_CALL
"""Tool poses whose nodes a kernel call writes."""

CANDIDATE_LIMIT = 4_000_000
"""Most branch candidates of one problem; each takes about 75 bytes."""


@dataclass(frozen=True, slots=True, eq=False)
class Nodes:
    """Feasible candidates in order of waypoint, orientation, branch and turn.

    `candidate` (k, 4) holds waypoint, orientation, branch slot and turn of every node;
    `model` and `pendant` (k, 6) its joints [rad]; `clearance` (k,) [m]; `offsets` (n + 1,)
    the first node of every waypoint.
    """

    candidate: NDArray[np.int32]
    model: FloatArray
    pendant: FloatArray
    clearance: FloatArray
    offsets: IntArray

    def __len__(self) -> int:
        return len(self.clearance)


@dataclass(frozen=True, slots=True, eq=False)
class CandidateSet:
    """Every candidate of a problem with its outcome; rejected ones are kept.

    Attributes
    ----------
    orientations : (o, 3) array
        Lean, lead, spin of each orientation [rad], lean slowest.
    branches : (b,) array
        Branch number of each slot.
    joints : (n, o, b, 6) array
        Model angles of each branch [rad].
    outcome : (n, o, b) array
        Values of :class:`Outcome`.
    turns : (n, o, b) array
        Number of representatives inside the limits.
    clearance : (n, o, b) array
        Clearance d [m]; nan where an earlier filter rejected.
    """

    problem: PlanningProblem
    scene: CollisionScene
    orientations: FloatArray
    branches: IntArray
    joints: FloatArray
    outcome: NDArray[np.uint8]
    turns: NDArray[np.uint8]
    clearance: FloatArray
    nodes: Nodes

    def counts(self) -> dict[Outcome, int]:
        """Number of branch candidates of every outcome."""
        found = np.bincount(self.outcome.ravel(), minlength=len(Outcome))
        return {outcome: int(found[outcome]) for outcome in Outcome}

    @property
    def lean(self) -> FloatArray:
        """(k,) lean of every node [rad]."""
        lean: FloatArray = self.orientations[self.nodes.candidate[:, 1], 0]
        return lean


def kernels_are_cached() -> bool:
    """Whether the compiled kernels are at hand, so that the first call does not compile them."""
    folder = Path(evaluate_poses.stats.cache_path)
    return bool(evaluate_poses.signatures) or any(folder.glob("*.evaluate_poses-*.nbi"))


def orientations(settings: PlanningSettings) -> FloatArray:
    """(o, 3) lean, lead and spin of all orientations, lean slowest [rad]."""
    grid = np.meshgrid(
        settings.lean.angles(), settings.lead.angles(), settings.spin.angles(), indexing="ij"
    )
    angles: FloatArray = np.column_stack([axis.ravel() for axis in grid])
    return angles


def tool_rotation(lean: float, lead: float, spin: float) -> FloatArray:
    """(3, 3) reference_from_tool: Ry(lean) Rx(lead) Rz(spin)."""
    return rotation_y(lean) @ rotation_x(lead) @ rotation_z(spin)


def reference_from_wrist(problem: PlanningProblem, angles: FloatArray) -> FloatArray:
    """(o, 3, 4) pose of the wrist in the waypoint's reference frame for every orientation."""
    tcp_from_wrist = inverse(problem.robot.flange @ problem.tool.tcp)
    return np.array([(rigid(tool_rotation(*row)) @ tcp_from_wrist)[:3] for row in angles])


def touch_numbers(problem: PlanningProblem, scene: CollisionScene) -> IntArray:
    """(n,) number of the workpiece group that each waypoint's pass touches, -1 for none."""
    numbers = [scene.touch_number(one.touches) for one in problem.toolpath.passes]
    return np.array(numbers, np.int64)[problem.toolpath.pass_index]


def usable_cores() -> int:
    """Cores that this process may run on."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def generate(
    problem: PlanningProblem, monitor: Monitor | None = None, *, threads: int | None = None
) -> CandidateSet:
    """Solve and filter every candidate of the problem.

    The kernels run on `threads` threads, by default one a core; the result is the same to the bit.
    """
    threads = usable_cores() if threads is None else threads
    monitor = monitor or SilentMonitor()
    settings = problem.settings
    compiles = not kernels_are_cached()
    if compiles:
        monitor.report(COMPILING, 0, 1)
    scene = build_scene(problem)
    angles = orientations(settings)
    branches = np.array(settings.branches, np.int64)
    shape = (len(problem.toolpath), len(angles), len(branches))
    if np.prod(shape, dtype=np.float64) > CANDIDATE_LIMIT:
        raise ModelError(
            f"{shape[0]} waypoints x {shape[1]} orientations x {shape[2]} branches are more than "
            f"{CANDIDATE_LIMIT:,} candidates; use a larger step or fewer branches"
        )
    touch = touch_numbers(problem, scene)
    joints = np.empty((*shape, 6))
    outcome = np.empty(shape, np.uint8)
    turns = np.empty(shape, np.uint8)
    clearance = np.empty(shape)
    local = reference_from_wrist(problem, angles)
    world = np.ascontiguousarray(problem.waypoint_poses[:, :3])
    robot = problem.robot
    limits = np.ascontiguousarray(problem.joint_limits)
    capacity = representative_capacity(problem.joint_limits)
    principal = settings.turns is Turns.PRINCIPAL
    arm = np.array(robot.arm_lengths)
    convention = robot.pendant_from_model

    def evaluate(begin: int, end: int) -> None:
        evaluate_poses(
            begin,
            end,
            world,
            local,
            touch,
            arm,
            convention,
            limits,
            robot.elbow_limits,
            principal,
            settings.manipulability,
            scene.packed,
            branches,
            joints,
            outcome,
            clearance,
            turns,
            np.empty((capacity, 6)),
        )

    poses = shape[0] * shape[1]
    _in_pieces("candidates", poses, POSES_PER_CALL, evaluate, monitor, threads, quiet=compiles)
    if scene.meshes:
        MeshChecker(scene).apply(joints, touch, arm, outcome, clearance, monitor)
    nodes = _expand(problem, joints, outcome, turns, clearance, monitor, threads)
    for array in (joints, outcome, turns, clearance):
        array.setflags(write=False)
    return CandidateSet(problem, scene, angles, branches, joints, outcome, turns, clearance, nodes)


def _in_pieces(
    stage: str,
    total: int,
    size: int,
    work: Callable[[int, int], None],
    monitor: Monitor,
    threads: int,
    *,
    quiet: bool = False,
) -> None:
    """Call `work` with the begin and end of pieces of 0..total, each of which stands alone.

    The first piece runs in the calling thread, which compiles what is not compiled yet; with
    `quiet` the stage is told only once it has returned, so that what was told before stays true.
    """
    begins = range(0, total, size)
    if quiet and monitor.cancelled():
        raise Cancelled
    if threads < 2 or len(begins) < 3:
        for begin in begins:
            if begin or not quiet:
                checkpoint(monitor, stage, begin, total)
            work(begin, min(begin + size, total))
        return
    if not quiet:
        checkpoint(monitor, stage, 0, total)
    work(0, size)
    pool = ThreadPoolExecutor(min(threads, len(begins) - 1))
    try:
        waiting = [pool.submit(work, begin, min(begin + size, total)) for begin in begins[1:]]
        for begin, piece in zip(begins[1:], waiting, strict=True):
            checkpoint(monitor, stage, begin, total)
            piece.result()
    finally:
        pool.shutdown(cancel_futures=True)


def _expand(
    problem: PlanningProblem,
    joints: FloatArray,
    outcome: NDArray[np.uint8],
    turns: NDArray[np.uint8],
    clearance: FloatArray,
    monitor: Monitor,
    threads: int,
) -> Nodes:
    kept = np.where(outcome == Outcome.FEASIBLE, turns, 0)
    per_pose = kept.sum(axis=2, dtype=np.int64)
    # The first node of every tool pose, and so of every piece of work.
    first = np.concatenate([[0], np.cumsum(per_pose)]).astype(np.int64)
    offsets = first[:: outcome.shape[1]].copy()
    count = int(offsets[-1])
    model, pendant = np.empty((count, 6)), np.empty((count, 6))
    node_clearance = np.empty(count)
    candidate = np.empty((count, 4), np.int32)
    robot = problem.robot
    capacity = representative_capacity(problem.joint_limits)
    limits = np.ascontiguousarray(problem.joint_limits)

    def expand(begin: int, end: int) -> None:
        expand_nodes(
            begin,
            end,
            joints,
            outcome,
            clearance,
            robot.pendant_from_model,
            robot.model_from_pendant,
            limits,
            robot.elbow_limits,
            problem.settings.turns is Turns.PRINCIPAL,
            np.empty((capacity, 6)),
            int(first[begin]),
            model,
            pendant,
            node_clearance,
            candidate,
        )

    poses = outcome.shape[0] * outcome.shape[1]
    _in_pieces("nodes", poses, EXPANDED_PER_CALL, expand, monitor, threads)
    for array in (model, pendant, node_clearance, candidate, offsets):
        array.setflags(write=False)
    return Nodes(candidate, model, pendant, node_clearance, offsets)
