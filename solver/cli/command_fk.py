"""`posopt fk`: flange or TCP poses of pendant joints."""

from __future__ import annotations

import argparse

import numpy as np

from solver.cli.arguments import six_numbers
from solver.cli.csv_rows import read_rows
from solver.cli.output import emit_json, say
from solver.transforms import FloatArray, rigid, rotation_from_wpr, wpr_from_rotation
from solver.units import DEG, DEG_PER_RAD, MM, MM_PER_M

HELP = "forward kinematics: poses in fanuc_world of pendant joints"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of this command."""
    parser.add_argument("robot", metavar="ROBOT", help="name or TOML file of a robot")
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--joints", metavar="J1,..,J6", help="six joints in degrees")
    source.add_argument("--csv", metavar="F", help="a CSV file with six joints a row")
    parser.add_argument("--tool", metavar="X,Y,Z,W,P,R", help="flange to TCP; without, the flange")


def run(options: argparse.Namespace) -> int:
    """Compute and print."""
    from solver.catalog import load_robot
    from solver.kinematics.arm import forward
    from solver.kinematics.configuration import config_string

    robot = load_robot(options.robot)
    rows = (
        read_rows(options.csv)
        if options.csv
        else np.array([six_numbers(options.joints, "--joints")])
    )
    tool = (
        None
        if options.tool is None
        else pose_from_xyzwpr(np.array(six_numbers(options.tool, "--tool")))
    )
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


def pose_from_xyzwpr(values: FloatArray) -> FloatArray:
    """(4, 4) transform of X Y Z [mm] and W P R [deg]."""
    w, p, r = values[3:] * DEG
    return rigid(rotation_from_wpr(w, p, r), values[:3] * MM)


def xyzwpr(pose: FloatArray) -> FloatArray:
    """(6,) X Y Z [mm] and W P R [deg] of a transform; -0 becomes 0."""
    angles = np.array(wpr_from_rotation(pose[:3, :3])) * DEG_PER_RAD
    return np.round(np.concatenate([pose[:3, 3] * MM_PER_M, angles]), 9) + 0.0
