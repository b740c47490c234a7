"""Joint speeds in whole percent do not hold a feed, and the prediction says by how much."""

import math
from dataclasses import replace

import numpy as np
import pytest

from solver.catalog import load_cell
from solver.model.program import Speed, rounded_joints
from solver.model.settings import Scheme
from solver.pipeline.planning import plan
from solver.pipeline.program_building import contact_moves, program_with
from solver.pipeline.program_check import inspect_moves

# Slowest and fastest mean TCP speed [mm/s] of a move, measured for each rounding of the percent.
RANGES = {
    ("exact", round): (33.38, 65.99),
    ("f", round): (33.38, 65.99),
    ("f2", round): (33.38, 65.99),
    ("exact", math.ceil): (50.50, 74.66),
    ("f", math.ceil): (56.14, 68.21),
    ("f2", math.ceil): (50.50, 74.66),
    ("exact", math.floor): (25.25, 49.78),
    ("f", math.floor): (28.07, 34.11),
    ("f2", math.floor): (25.25, 49.78),
}


@pytest.fixture(scope="module")
def result():
    return plan(load_cell("groove_paper"), compare=(Scheme.F, Scheme.F2))


def share_needed(joints, positions, feed, speeds):
    """Share of its speed that the fastest joint needs for the distance at the feed."""
    seconds = np.linalg.norm(np.diff(positions, axis=0), axis=1) / feed
    return (np.abs(np.diff(joints, axis=0)) / speeds / seconds[:, None]).max(axis=1)


def feed_report(result, scheme, how=None):
    """Feed check and predictions, with contact moves in percent where `how` rounds them."""
    problem = result.problem
    sequence = result.sequences[Scheme(scheme)]
    joints = rounded_joints(sequence.pendant)
    ((first, *moves),) = contact_moves(problem, joints)
    if how is not None:
        positions = problem.toolpath.poses[:, :3, 3]
        shares = share_needed(joints, positions, 0.05, problem.robot.speeds)
        speeds = [Speed.percent(float(max(1, how(100.0 * share)))) for share in shares]
        moves = [replace(move, speed=one) for move, one in zip(moves, speeds, strict=True)]
    program = program_with(problem, "GROOVEP", (first, *moves), sequence.least_clearance)
    report = inspect_moves(problem, program, 0.0)
    (check,) = [one for one in report.checks if one.name == "feed"]
    return check, report.feeds


@pytest.mark.parametrize("scheme", ["exact", "f", "f2"])
def test_whole_percent_at_50_mm_s_run_at_33_to_66_mm_s(result, scheme):
    check, feeds = feed_report(result, scheme, round)
    assert not check.passed
    slowest = min(line.prediction.slowest for line in feeds) * 1000.0
    fastest = max(line.prediction.fastest for line in feeds) * 1000.0
    assert 33.0 < slowest < 34.0
    assert 65.5 < fastest < 66.5
    assert f"predicted {slowest:.1f} to {fastest:.1f} mm/s, asked 50 mm/s" in check.detail
    assert "49 contact moves in %" in check.detail


@pytest.mark.parametrize(("scheme", "how"), RANGES)
def test_no_rounding_of_the_percent_holds_the_feed(result, scheme, how):
    check, feeds = feed_report(result, scheme, how)
    assert not check.passed
    means = [line.prediction.mean * 1000.0 for line in feeds]
    assert (min(means), max(means)) == pytest.approx(RANGES[scheme, how], abs=0.01)


@pytest.mark.parametrize(("scheme", "how"), RANGES)
def test_the_mean_speed_is_length_over_the_time_of_the_slowest_joint(result, scheme, how):
    """Figured without sampling: the TCP's way is hardly longer than its chord."""
    _, feeds = feed_report(result, scheme, how)
    problem = result.problem
    joints = rounded_joints(result.sequences[Scheme(scheme)].pendant)
    positions = problem.toolpath.poses[:, :3, 3]
    chords = np.linalg.norm(np.diff(positions, axis=0), axis=1)
    at_full_speed = (np.abs(np.diff(joints, axis=0)) / problem.robot.speeds).max(axis=1)
    for line, chord, full in zip(feeds, chords, at_full_speed, strict=True):
        percent = max(1, how(100.0 * full / (chord / 0.05)))
        seconds = 100.0 * full / percent
        assert line.prediction.mean == pytest.approx(chord / seconds, rel=5e-3)


@pytest.mark.parametrize("scheme", ["exact", "f", "f2"])
def test_the_default_post_holds_the_asked_feed(result, scheme):
    check, feeds = feed_report(result, scheme)
    assert check.passed
    assert all(line.held and not line.in_percent for line in feeds)
    assert min(line.prediction.slowest for line in feeds) > 0.045
    assert max(line.prediction.fastest for line in feeds) < 0.055


def test_a_feed_that_the_joints_cannot_hold_names_the_joint_and_the_best_feed(result):
    problem = result.problem
    slow = replace(problem.robot, speeds=problem.robot.speeds * [1, 1, 1, 1, 1, 0.004])
    limited = replace(result, problem=replace(problem, robot=slow))
    check, feeds = feed_report(limited, "exact")
    assert not check.passed
    missed = [line for line in feeds if not line.held]
    assert missed
    assert all(line.prediction.joint == 5 for line in missed)
    assert "J6 allows at most" in check.detail
    best = missed[0].prediction.best
    turn = np.abs(np.diff(rounded_joints(result.sequence.pendant), axis=0))[missed[0].move, 5]
    chord = np.linalg.norm(problem.toolpath.poses[1, :3, 3] - problem.toolpath.poses[0, :3, 3])
    assert best == pytest.approx(chord / (turn / slow.speeds[5]), rel=5e-3)
