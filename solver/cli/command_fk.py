"""`posopt fk`: flange or TCP poses of pendant joints."""

from __future__ import annotations

import argparse

from solver.cli.output import emit_json, say
from solver.cli.poses import add_row_arguments, rows_of, tool_of, xyzwpr
from solver.units import DEG

HELP = "forward kinematics: poses in fanuc_world of pendant joints"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of this command."""
    add_row_arguments(parser, "--joints", "J1,..,J6", "six joints in degrees")


def run(options: argparse.Namespace) -> int:
    """Compute and print."""
    from solver.catalog import load_robot
    from solver.kinematics.arm import forward
    from solver.kinematics.configuration import config_string

    robot = load_robot(options.robot)
    rows, tool = rows_of(options, "--joints"), tool_of(options)
    joints = rows * DEG
    poses = forward(robot, joints, tool)
    results = [
        {"joints_deg": row, "pose": xyzwpr(pose), "config": config_string(robot, angles)}
        for row, pose, angles in zip(rows, poses, joints, strict=True)
    ]
    if options.as_json:
        emit_json(
            {"format": "posopt-fk", "version": 1, "robot": robot.name, "results": results},
            options.as_json,
        )
    if options.as_json != "-":
        for one in results:
            values = one["pose"]
            say(
                "X {:.4f}  Y {:.4f}  Z {:.4f} mm  W {:.4f}  P {:.4f}  R {:.4f} deg  ".format(
                    *values
                )
                + str(one["config"])
            )
    return 0
