"""Paths that cross, repeat or close themselves: no lap of them may be missing."""

from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from written_programs import failed, without_move

from solver.analysis.spans import find_spans
from solver.catalog import load_cell
from solver.io.ls_program_set import read_program_set
from solver.pipeline.planning import plan
from solver.pipeline.program_check import check_program
from solver.pipeline.programming import ProgramOrder, write_program
from solver.units import MM

COUNT = 37


def eight(angle):
    """A figure of eight: it passes its middle twice."""
    return np.sin(angle), 0.5 * np.sin(2.0 * angle)


def circle(angle):
    """A circle that ends where it begins."""
    return np.cos(angle), np.sin(angle)


def to_and_fro(angle):
    """A line that is ground there, back, and there again, over the same waypoints."""
    there = np.abs((1.5 * angle / np.pi + 1.0) % 2.0 - 1.0)
    return 2.0 * there - 1.0, np.zeros_like(angle)


CURVES = (eight, circle, to_and_fro)


@cache
def planned_along(curve):
    """The plan of a curve of 40 by 30 mm about the middle of the groove's path, without leads."""
    problem = load_cell("groove_hw300")
    one = problem.toolpath.passes[0]
    poses = np.repeat(one.poses[25:26], COUNT, axis=0)
    across, up = curve(np.linspace(0.0, 2.0 * np.pi, COUNT))
    poses[:, 0, 3] += 40.0 * MM * across
    poses[:, 2, 3] += 30.0 * MM * up
    role = one.roles[25]
    toolpath = problem.toolpath.with_passes((replace(one, poses=poses, roles=(role,) * COUNT),))
    none = dict.fromkeys(("lead_in", "lead_out", "lead_in_height", "lead_out_height"), 0.0)
    program = replace(problem.program, links=replace(problem.program.links, **none))
    return plan(replace(problem, toolpath=toolpath, program=program))


@cache
def text_along(curve, post):
    """The checked program of a curve."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "GROOVE.LS"
        write_program(planned_along(curve), path, ProgramOrder(post=post))
        return path.read_bytes().decode("ascii")


def test_the_curves_do_meet_themselves():
    for curve in CURVES:
        points = planned_along(curve).problem.waypoint_poses[:, :3, 3]
        away = np.linalg.norm(points[:, None] - points[None], axis=2)
        apart = np.abs(np.subtract.outer(np.arange(COUNT), np.arange(COUNT))) > 1
        assert away[apart].min() < 1e-9


@pytest.mark.parametrize("post", ["fanuc-joint", "fanuc-cartesian"])
@pytest.mark.parametrize("curve", CURVES)
def test_the_program_holds_every_check_when_it_is_read_back(curve, post, tmp_path):
    result = planned_along(curve)
    path = tmp_path / "GROOVE.LS"
    written = write_program(result, path, ProgramOrder(post=post))
    least = result.problem.settings.safety_distance
    again = check_program(result.problem, read_program_set(path), least)
    assert [one.name for one in (*written.checks, *again) if not one.passed] == []


@pytest.mark.parametrize("curve", CURVES)
def test_every_position_is_found_at_its_own_waypoint(curve):
    """A closed path ended at its beginning, and all between counted as off the path."""
    problem = planned_along(curve).problem
    home = np.array([[0.5, 0.5, 1.0]])
    positions = np.concatenate([home, problem.waypoint_poses[:, :3, 3], home])
    (span,) = find_spans(problem, positions)
    assert (span.first, span.last) == (1, COUNT)
    assert span.arc.tolist() == list(range(COUNT))


@pytest.mark.parametrize("curve", CURVES)
def test_a_lap_that_is_left_out_is_noticed(curve):
    """The places are visited all the same, or nearly: only the order tells."""
    text = text_along(curve, "fanuc-joint")
    problem = planned_along(curve).problem
    for number in range(COUNT // 3 + 1, 2 * COUNT // 3 + 1):
        text = without_move(text, number)
    assert failed(problem, text)
