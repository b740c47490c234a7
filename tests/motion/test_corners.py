"""Rounded corners: against the measured cuts, and no rounder than the path's tolerance allows."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from solver.catalog import load_cell
from solver.kinematics.arm import forward
from solver.model.program import MotionKind, Move, Speed
from solver.motion.corners import ROUNDINGS, USED_SHARE, corner_cut, turning, with_roundings
from solver.units import MM

RIGHT = np.pi / 2.0
POSTURE = np.radians([0.0, -20.0, 10.0, 0.0, -80.0, 0.0])


@pytest.mark.parametrize(("speed", "cut"), [(0.2, 1.9), (0.5, 4.9), (1.0, 11.1)])
def test_a_right_angle_is_cut_as_measured(speed, cut):
    assert corner_cut(RIGHT, 50, speed) == pytest.approx(cut * MM)
    assert corner_cut(RIGHT, 100, speed) == pytest.approx(2.4 * cut * MM)


@given(
    st.floats(0.0, np.pi), st.floats(0.0, np.pi), st.sampled_from(ROUNDINGS), st.floats(0.01, 3.0)
)
def test_a_sharper_corner_and_a_faster_one_are_never_cut_less(angle, more, cnt, speed):
    cut = corner_cut(angle, cnt, speed)
    assert cut >= 0.0
    assert corner_cut(min(angle + more, np.pi), cnt, speed) >= cut
    assert corner_cut(angle, cnt, speed * 1.5) >= cut
    assert corner_cut(angle, 100, speed) >= cut


def test_the_change_of_direction_is_the_angle_between_the_legs():
    legs = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0 + np.cos(0.3), np.sin(0.3), 0.0]])
    assert turning(legs) == pytest.approx(0.3)
    assert turning(np.array([legs[0], legs[1], legs[0]])) == pytest.approx(np.pi)
    assert turning(np.array([legs[0], legs[0], legs[1]])) == 0.0


def cornered(feed, tolerance):
    """A problem of this feed and tolerance, and three moves with a corner at the middle one."""
    problem = load_cell("groove_hw300")
    one = replace(problem.toolpath.passes[0], feed=feed)
    problem = replace(
        problem,
        toolpath=problem.toolpath.with_passes((one,)),
        program=replace(problem.program, path_tolerance=tolerance),
    )
    joints = (POSTURE, POSTURE + np.radians([5, 0, 0, 0, 0, 0]), POSTURE)
    moves = tuple(
        Move(row, Speed.duration(0.5), MotionKind.JOINT, 100, waypoint=number)
        for number, row in enumerate(joints)
    )
    return problem, moves


@pytest.mark.parametrize("feed", [0.005, 0.02, 0.1, 0.5])
@pytest.mark.parametrize("tolerance", [0.05, 0.5, 2.0])
def test_the_roundest_corner_that_the_tolerance_allows_is_taken(feed, tolerance):
    problem, moves = cornered(feed, tolerance * MM)
    chosen = with_roundings(problem, moves)[1].cnt
    tcp = forward(problem.robot, np.array([one.joints for one in moves]), problem.tool.tcp)
    cuts = {cnt: corner_cut(turning(tcp[:, :3, 3]), cnt, feed) for cnt in ROUNDINGS}
    allowed = [cnt for cnt, cut in cuts.items() if cut <= USED_SHARE * tolerance * MM]
    assert chosen == max(allowed, default=None)


def test_a_corner_that_cannot_be_rounded_stops():
    problem, moves = cornered(2.0, 0.05 * MM)
    assert with_roundings(problem, moves)[1].cnt is None


def test_no_corner_becomes_rounder_than_it_was_asked_to_be():
    problem, moves = cornered(0.001, 5.0 * MM)
    moves = tuple(replace(one, cnt=25) for one in moves)
    assert [one.cnt for one in with_roundings(problem, moves)] == [25, 25, 25]


def test_moves_off_the_path_keep_their_own_rounding():
    problem, moves = cornered(0.5, 0.05 * MM)
    moves = tuple(replace(one, waypoint=None) for one in moves)
    assert with_roundings(problem, moves) == moves
    assert with_roundings(problem, ()) == ()
