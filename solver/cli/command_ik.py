"""`posopt ik`: every joint vector inside the limits that reaches a pose."""

from __future__ import annotations

import argparse

import numpy as np

from solver.cli.output import emit_json, say
from solver.cli.poses import add_row_arguments, pose_from_xyzwpr, rows_of, tool_of
from solver.transforms import FloatArray
from solver.units import DEG_PER_RAD

HELP = "inverse kinematics: all joint solutions of poses in fanuc_world"
NO_SOLUTION = 3


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of this command."""
    add_row_arguments(parser, "--pose", "X,Y,Z,W,P,R", "a pose in fanuc_world, mm and deg")


def run(options: argparse.Namespace) -> int:
    """Solve and print; exit code 3 when a pose has no solution."""
    from solver.catalog import load_robot
    from solver.kinematics.arm import inverse

    robot = load_robot(options.robot)
    rows, tool = rows_of(options, "--pose"), tool_of(options)
    results = []
    for row in rows:
        found = inverse(robot, pose_from_xyzwpr(row), tool)
        results.append(
            {
                "pose": row,
                "solutions": [
                    {"branch": int(branch), "config": config, "joints_deg": _degrees(joints)}
                    for joints, branch, config in zip(
                        found.joints, found.branch, found.config, strict=True
                    )
                ],
            }
        )
    if options.as_json:
        emit_json(
            {"format": "posopt-ik", "version": 1, "robot": robot.name, "results": results},
            options.as_json,
        )
    if options.as_json != "-":
        _print(results)
    return 0 if all(one["solutions"] for one in results) else NO_SOLUTION


def _degrees(joints: FloatArray) -> FloatArray:
    """Joints in degrees to 1e-9, without a negative zero."""
    degrees: FloatArray = np.round(joints * DEG_PER_RAD, 9) + 0.0
    return degrees


def _print(results: list[dict]) -> None:  # type: ignore[type-arg]
    for index, one in enumerate(results, start=1):
        if len(results) > 1:
            say(f"pose {index}")
        if not one["solutions"]:
            say("  no solution inside the reach and the limits")
        for solution in one["solutions"]:
            joints = "  ".join(f"{value:9.4f}" for value in solution["joints_deg"])
            say(f"  branch {solution['branch']}  {joints} deg  {solution['config']}")
