"""Inverse kinematics of the cell's own tool poses, beside py-opw-kinematics."""

from __future__ import annotations

import math
import statistics
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np

from solver.benchmarks.measure import LEAST_TIME
from solver.benchmarks.peers_search import GET_PEERS, installed
from solver.candidates.generate import orientations, tool_rotation
from solver.kinematics.arm import all_branches, forward
from solver.model.problem import PlanningProblem
from solver.model.robot import Robot
from solver.transforms import FloatArray, inverse, rigid
from solver.units import TURN

OPW = "py_opw_kinematics"


@dataclass(frozen=True, slots=True)
class KinematicsTiming:
    """One way of solving poses for all branches: processor time of one pose [s], and what it gave.

    `residual` is the largest error of position [m] or of a rotation's entry over all solutions
    when the robot is moved there by our forward kinematics. `unmatched` counts solutions that
    the other solver lacks, `difference` is the largest of a joint [rad] between those that
    match; `ratio` is to ours called the same way. None where nothing was measured.
    """

    method: str
    note: str
    poses: int
    per_pose: float | None = None
    ratio: float | None = None
    solutions: int | None = None
    residual: float | None = None
    unmatched: int | None = None
    difference: float | None = None


def time_kinematics(
    problem: PlanningProblem, repeats: int, *, small: bool = False
) -> list[KinematicsTiming]:
    """Solve the flange poses of all waypoints and orientations of a cell by both solvers."""
    poses = flange_poses(problem)
    poses = poses[:: max(1, len(poses) // 60)] if small else poses
    robot = problem.robot
    ours = [found.joints[found.found] for found in (all_branches(robot, one) for one in poses)]
    at_once = median_per_item(lambda: all_branches(robot, poses), len(poses), repeats)
    singly = median_per_item(lambda: [all_branches(robot, p) for p in poses], len(poses), repeats)
    theirs = None
    rows = []
    if installed(OPW) and installed("scipy"):
        opw, targets = opw_robot(robot), opw_poses(robot, poses)
        theirs = opw_solutions(opw, targets)
        rows = [
            (
                "py-opw-kinematics, all poses in one call",
                median_per_item(lambda: opw.reach(targets), len(poses), repeats),
                at_once,
            ),
            (
                "py-opw-kinematics, one pose a call",
                median_per_item(lambda: [opw.inverse(p) for p in targets], len(poses), repeats),
                singly,
            ),
        ]
    result = [
        _row(problem, "posopt, all poses in one call", at_once, at_once, poses, ours, theirs),
        _row(problem, "posopt, one pose a call", singly, singly, poses, ours, theirs),
    ]
    if theirs is None:
        note = f"not installed: {GET_PEERS}"
        return [*result, KinematicsTiming("py-opw-kinematics", note, len(poses))]
    return result + [
        _row(problem, name, spent, base, poses, theirs, ours) for name, spent, base in rows
    ]


def _row(
    problem: PlanningProblem,
    method: str,
    per_pose: float,
    base: float,
    poses: FloatArray,
    found: list[FloatArray],
    others: list[FloatArray] | None,
) -> KinematicsTiming:
    reached = [forward(problem.robot, rows) - pose for rows, pose in zip(found, poses, strict=True)]
    unmatched = difference = None
    if others is not None:
        apart = np.concatenate(list(_differences(found, others)))
        unmatched = int(np.count_nonzero(apart > MATCH))
        difference = float(np.max(apart[apart <= MATCH], initial=0.0))
    return KinematicsTiming(
        method=method,
        note="",
        poses=len(poses),
        per_pose=per_pose,
        ratio=per_pose / base,
        solutions=sum(map(len, found)),
        residual=max(float(np.max(np.abs(one), initial=0.0)) for one in reached),
        unmatched=unmatched,
        difference=difference,
    )


MATCH = 1e-3
"""Solutions whose joints differ by no more count as the same branch [rad]."""


def _differences(found: list[FloatArray], others: list[FloatArray]) -> Iterator[FloatArray]:
    """Largest joint difference of every solution to the nearest one of the other solver [rad]."""
    for ours, theirs in zip(found, others, strict=True):
        apart = ours[:, None] - theirs[None]
        apart = np.abs(apart - TURN * np.round(apart / TURN)).max(axis=2)
        yield apart.min(axis=1, initial=math.inf)


def flange_poses(problem: PlanningProblem) -> FloatArray:
    """(k, 4, 4) fanuc_world_from_flange of every waypoint in every orientation."""
    tcp_from_flange = inverse(problem.tool.tcp)
    local = np.array(
        [rigid(tool_rotation(*row)) @ tcp_from_flange for row in orientations(problem.settings)]
    )
    poses: FloatArray = problem.waypoint_poses[:, None] @ local[None]
    return poses.reshape(-1, 4, 4)


def opw_robot(robot: Robot) -> Any:
    """The same arm in py-opw-kinematics, whose base is the floor and whose J3 is J2 + J3."""
    library = import_module(OPW)
    a1, a2, a3, d4 = robot.arm_lengths
    model = library.KinematicModel(
        a1=a1,
        a2=-a3,
        b=0.0,
        c1=robot.world_height,
        c2=a2,
        c3=d4,
        c4=float(robot.flange[2, 3]),
        offsets=(0.0, 0.0, -math.pi / 2.0, 0.0, 0.0, math.pi),
        flip_axes=(False, False, True, True, True, True),
    )
    return library.Robot(model, degrees=False)


def opw_poses(robot: Robot, poses: FloatArray) -> Any:
    """Flange poses in the floor frame, as py-opw-kinematics takes them."""
    on_floor = np.array(poses)
    on_floor[:, 2, 3] += robot.world_height
    return import_module("scipy.spatial.transform").RigidTransform.from_matrix(on_floor)


def opw_solutions(robot: Any, targets: Any) -> list[FloatArray]:
    """All solutions of every pose as pendant joints (m, 6) [rad]."""
    found = []
    for pose in targets:
        rows = np.array(robot.inverse(pose), dtype=np.float64).reshape(-1, 6)
        rows[:, 2] -= rows[:, 1]
        found.append(rows)
    return found


def median_per_item(action: Callable[[], object], items: int, repeats: int) -> float:
    """Median processor time of an action after one uncounted run, over its items [s]."""
    action()
    times: list[float] = []
    while len(times) < repeats or (sum(times) < LEAST_TIME and len(times) < 100 * repeats):
        started = time.thread_time()
        action()
        times.append(time.thread_time() - started)
    return statistics.median(times) / items
