"""Arguments and conversions that `posopt fk` and `posopt ik` share: rows, tools and poses."""

from __future__ import annotations

import argparse

import numpy as np

from solver.cli.arguments import six_numbers
from solver.cli.csv_rows import read_rows
from solver.transforms import FloatArray, rigid, rotation_from_wpr, wpr_from_rotation
from solver.units import DEG, DEG_PER_RAD, MM, MM_PER_M


def add_row_arguments(parser: argparse.ArgumentParser, flag: str, metavar: str, what: str) -> None:
    """Declare the robot, the source of rows of six numbers, and the tool."""
    parser.add_argument("robot", metavar="ROBOT", help="name or TOML file of a robot")
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument(flag, dest="row", metavar=metavar, help=what)
    source.add_argument("--csv", metavar="F", help=f"a CSV file with {metavar} a row")
    parser.add_argument("--tool", metavar="X,Y,Z,W,P,R", help="flange to TCP; without, the flange")


def rows_of(options: argparse.Namespace, flag: str) -> FloatArray:
    """(n, 6) rows of the command line or of its CSV file."""
    if options.csv:
        return read_rows(options.csv)
    return np.array([six_numbers(options.row, flag)])


def tool_of(options: argparse.Namespace) -> FloatArray | None:
    """flange_from_tcp (4, 4) of the command line, None without one."""
    if options.tool is None:
        return None
    return pose_from_xyzwpr(np.array(six_numbers(options.tool, "--tool")))


def pose_from_xyzwpr(values: FloatArray) -> FloatArray:
    """(4, 4) transform of X Y Z [mm] and W P R [deg]."""
    w, p, r = values[3:] * DEG
    return rigid(rotation_from_wpr(w, p, r), values[:3] * MM)


def xyzwpr(pose: FloatArray) -> FloatArray:
    """(6,) X Y Z [mm] and W P R [deg] of a transform; -0 becomes 0."""
    angles = np.array(wpr_from_rotation(pose[:3, :3])) * DEG_PER_RAD
    return np.round(np.concatenate([pose[:3, 3] * MM_PER_M, angles]), 9) + 0.0
