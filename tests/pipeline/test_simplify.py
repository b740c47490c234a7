"""Fewer positions, where every check still holds and the moved TCP stays on the path."""

from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from py_opw_kinematics import KinematicModel
from py_opw_kinematics import Robot as OpwRobot
from scipy.spatial.transform import Rotation
from written_programs import planned

from solver.analysis.references import constant_lean
from solver.catalog import load_cell
from solver.errors import InputError
from solver.io.ls_program_set import read_program_set
from solver.model.program import MotionKind, rounded_joints
from solver.model.program_settings import ContactMotion
from solver.model.settings import Sweep
from solver.model.toolpath import Event, EventKind
from solver.pipeline.planning import plan
from solver.pipeline.program_building import contact_moves
from solver.pipeline.program_check import check_program
from solver.pipeline.programming import ProgramOrder, check_order, write_program
from solver.pipeline.simplify import simplified
from solver.units import DEG, DEG_PER_RAD, MM, MM_PER_M

DENSE = 400
"""Samples of every move of the independent motion."""

M20IA = KinematicModel(
    a1=0.15,
    a2=-0.25,
    b=0.0,
    c1=0.525,
    c2=0.79,
    c3=0.835,
    c4=0.10,
    offsets=(0, 0, -90, 0, 0, 180),
    flip_axes=(False, False, True, True, True, True),
)


@cache
def constant(motion: ContactMotion):
    """The plan of the groove at the best constant lean."""
    problem = load_cell("groove_hw300")
    lean = constant_lean(planned("groove_hw300")).lean
    problem = replace(
        problem,
        settings=replace(problem.settings, lean=Sweep.fixed(lean)),
        program=replace(problem.program, contact=motion),
    )
    return plan(problem)


def tcp_of(joints):
    """TCP positions [m] in fanuc_world for pendant joints [rad], by py_opw_kinematics."""
    degrees = np.asarray(joints) * DEG_PER_RAD
    elsewhere = degrees.copy()
    elsewhere[:, 2] += degrees[:, 1]
    flange = OpwRobot(M20IA, degrees=True).batch_forward(elsewhere).as_matrix()
    return flange[:, :3, 3] + 0.41 * flange[:, :3, 2] - [0.0, 0.0, 0.525]


def away_from_line(points, line):
    """Distance of each point from a polyline, segment by segment [m]."""
    best = np.full(len(points), np.inf)
    for start, end in pairwise(line):
        along = end - start
        share = np.clip((points - start) @ along / (along @ along), 0.0, 1.0)
        foot = start + share[:, None] * along
        best = np.minimum(best, np.linalg.norm(points - foot, axis=1))
    return best


def moved_tcp(moves):
    """TCP positions of a dense motion through the moves of one pass."""
    parts = []
    share = np.linspace(0.0, 1.0, DENSE)[:, None]
    for before, move in pairwise(moves):
        if move.kind is MotionKind.LINEAR:
            one, other = tcp_of(np.array([before.joints, move.joints]))
            parts.append(one + share * (other - one))
        else:
            parts.append(tcp_of(before.joints + share * (move.joints - before.joints)))
    return np.concatenate(parts)


def fewer(result, tolerance):
    """The simplified contact moves of every pass."""
    problem = result.problem
    passes = contact_moves(problem, rounded_joints(result.sequence.pendant))
    kept = min(result.sequence.least_clearance, problem.settings.safety_distance)
    return simplified(problem, passes, tolerance, kept)


def written_checks(result, folder, **order):
    path = folder / f"{result.problem.program.name}.LS"
    written = write_program(result, path, ProgramOrder(**order))
    again = check_program(
        result.problem, read_program_set(path), result.problem.settings.safety_distance
    )
    assert all(one.passed for one in (*written.checks, *again))
    return written


def test_a_straight_pass_at_a_constant_lean_needs_two_positions(tmp_path):
    result = constant(ContactMotion.LINEAR)
    written = written_checks(result, tmp_path, simplify=0.05 * MM)
    contact = [move for move in written.program.moves if move.waypoint is not None]
    assert [move.waypoint for move in contact] == [0, 49]
    assert len(written.report.feeds) == 1


def test_joint_moves_on_a_straight_pass_need_fewer_than_fifty(tmp_path):
    result = constant(ContactMotion.JOINT)
    written = written_checks(result, tmp_path, simplify=0.5 * MM)
    contact = [move for move in written.program.moves if move.waypoint is not None]
    assert len(contact) <= 15
    assert contact[0].waypoint == 0
    assert contact[-1].waypoint == 49


@pytest.mark.parametrize("post", ["fanuc-joint", "fanuc-cartesian"])
@pytest.mark.parametrize("tolerance", [0.5, 0.2, 0.02])
def test_every_check_of_a_simplified_zigzag_passes(post, tolerance, tmp_path):
    """At 0.2 mm a waypoint that was passed came nearer than the stated clearance."""
    result = planned("zigzag_hw250")
    written = written_checks(result, tmp_path, simplify=tolerance * MM, post=post)
    assert len(written.program.moves) <= 89


@pytest.mark.parametrize("motion", ContactMotion)
@pytest.mark.parametrize("tolerance", [0.5, 0.1, 0.03])
def test_the_moved_tcp_stays_within_the_tolerance_of_the_path(motion, tolerance):
    """Followed by other kinematics in dense samples; where moves were dropped, at least."""
    result = constant(motion)
    (moves,) = fewer(result, tolerance * MM)
    path = result.problem.waypoint_poses[:, :3, 3]
    for before, move in pairwise(moves):
        if move.waypoint == before.waypoint + 1:
            continue
        tcp = moved_tcp((before, move))
        piece = path[before.waypoint : move.waypoint + 1]
        assert away_from_line(tcp, piece).max() <= tolerance * MM + 1e-9
        assert away_from_line(piece, tcp).max() <= tolerance * MM + 1e-6


def test_the_independent_kinematics_are_those_of_the_cell():
    result = planned("groove_hw300")
    away = tcp_of(result.sequence.pendant) - result.problem.waypoint_poses[:, :3, 3]
    assert np.linalg.norm(away, axis=1).max() < 1e-9
    turned = Rotation.from_matrix(result.problem.tool.tcp[:3, :3]).magnitude() * DEG_PER_RAD
    assert turned == pytest.approx(180.0)
    np.testing.assert_allclose(result.problem.tool.tcp[:3, 3], [0.0, 0.0, 0.41], atol=1e-12)


def test_no_position_is_moved_and_none_is_new():
    result = constant(ContactMotion.JOINT)
    (moves,) = fewer(result, 0.5 * MM)
    original = rounded_joints(result.sequence.pendant)
    rows = [move.waypoint for move in moves]
    assert rows == sorted(set(rows))
    for move in moves:
        assert (move.joints == original[move.waypoint]).all()


def test_a_longer_move_takes_the_time_of_its_whole_distance():
    result = constant(ContactMotion.JOINT)
    (moves,) = fewer(result, 0.5 * MM)
    step = np.linalg.norm(np.diff(result.problem.waypoint_poses[:2, :3, 3], axis=0)) / 0.02
    for before, move in pairwise(moves):
        seconds = step * (move.waypoint - before.waypoint)
        assert 0.0 <= move.speed.value - seconds < 0.0011


@pytest.mark.parametrize("motion", ContactMotion)
def test_waypoints_with_events_stay(motion):
    result = constant(motion)
    problem = result.problem
    dwell = (Event(EventKind.DWELL, "", 0.5),)
    one = replace(problem.toolpath.passes[0], events={13: dwell, 30: dwell})
    changed = replace(problem, toolpath=problem.toolpath.with_passes((one,)))
    (moves,) = fewer(replace(result, problem=changed), 0.5 * MM)
    kept = {move.waypoint: move for move in moves}
    for number in (13, 30):
        assert kept[number].events == dwell
        assert kept[number].cnt is None
    if motion is ContactMotion.LINEAR:
        assert list(kept) == [0, 13, 30, 49]


def test_a_smaller_tolerance_keeps_more_positions():
    result = constant(ContactMotion.JOINT)
    counts = [len(fewer(result, tolerance * MM)[0]) for tolerance in (0.5, 0.2, 0.05)]
    assert counts == sorted(counts)
    assert counts[0] < counts[-1]


def test_a_smaller_step_of_the_joints_keeps_more_positions():
    result = constant(ContactMotion.LINEAR)
    settings = result.problem.settings
    bound = replace(settings.steps, joints=np.full(6, 10.0 * DEG))
    limited = replace(result.problem, settings=replace(settings, steps=bound))
    (moves,) = fewer(replace(result, problem=limited), 0.5 * MM)
    joints = np.array([move.joints for move in moves])
    assert len(moves) > 2
    assert np.abs(np.diff(joints, axis=0)).max() <= 10.0 * DEG


@pytest.mark.parametrize("tolerance", [0.0, -0.1, 0.51, 5.0, float("nan"), float("inf")])
def test_a_tolerance_beyond_that_of_the_path_is_refused_before_planning(tolerance, tmp_path):
    problem = load_cell("groove_hw300")
    limit = problem.program.path_tolerance * MM_PER_M
    with pytest.raises(InputError, match=rf"path_tolerance_mm, {limit:g} mm"):
        check_order(problem, tmp_path / "GROOVE.LS", ProgramOrder(simplify=tolerance * MM))


@cache
def arc(feed):
    """The plan of an arc of 100 mm radius on the web, without leads."""
    problem = load_cell("groove_hw300")
    one = problem.toolpath.passes[0]
    poses = one.poses.copy()
    angle = np.linspace(-0.6, 0.6, len(poses))
    poses[:, :3, 3] = poses[:, :3, 3].mean(axis=0)
    poses[:, 0, 3] += 0.1 * np.sin(angle)
    poses[:, 2, 3] += 0.1 * (np.cos(angle) - 1.0)
    toolpath = problem.toolpath.with_passes((replace(one, poses=poses, feed=feed),))
    none = dict.fromkeys(("lead_in", "lead_out", "lead_in_height", "lead_out_height"), 0.0)
    links = replace(problem.program.links, **none)
    program = replace(problem.program, contact=ContactMotion.LINEAR, links=links)
    return plan(replace(problem, toolpath=toolpath, program=program))


def test_a_curve_keeps_what_it_needs():
    """A chord of an arc leaves it by r (1 - cos(angle / 2)): 0.2 mm at 7.2 deg."""
    result = arc(0.02)
    (moves,) = fewer(result, 0.2 * MM)
    path = result.problem.waypoint_poses[:, :3, 3]
    assert 9 < len(moves) < 20
    assert away_from_line(path, tcp_of(np.array([move.joints for move in moves]))).max() <= 0.2 * MM


@pytest.mark.parametrize("feed", [0.02, 0.2, 0.3])
def test_corners_between_longer_moves_are_rounded_no_more_than_allowed(feed, tmp_path):
    """At 200 mm/s a program was refused when simplified that could be written as it was."""
    result = arc(feed)
    (tmp_path / "all").mkdir()
    written_checks(result, tmp_path / "all")
    written = written_checks(result, tmp_path, simplify=0.5 * MM)
    assert len(written.program.moves) < 25
