from dataclasses import replace

import numpy as np
import pytest

from solver.catalog import load_cell
from solver.costs.nodes import node_terms, path_shares
from solver.costs.steps import gap_times, gaps
from solver.io.importers import resample
from solver.model.settings import CostWeights, StepLimits
from solver.units import DEG


@pytest.fixture(scope="module")
def problem():
    return load_cell("groove_hw300")


def with_settings(problem, **changes):
    return replace(problem, settings=replace(problem.settings, **changes))


def two_passes(problem):
    one = problem.toolpath.passes[0]
    first = replace(one, poses=one.poses[:20], roles=one.roles[:20])
    second = replace(one, poses=one.poses[20:], roles=one.roles[20:], lean=10.0 * DEG)
    return replace(problem, toolpath=problem.toolpath.with_passes((first, second)))


def test_shares_sum_to_one_and_ends_count_half(problem):
    shares = path_shares(problem.toolpath.passes)
    assert shares.sum() == pytest.approx(1.0)
    assert shares[0] == pytest.approx(shares[1] / 2)


def test_a_finer_path_does_not_cost_more(problem):
    """The paper's penalty grows with the number of points; these terms do not."""
    weighted = with_settings(problem, weights=CostWeights(clearance=2.0, lean=1.0))
    fine = replace(weighted, toolpath=resample(weighted.toolpath, 0.003))
    assert len(fine.toolpath) > 3 * len(weighted.toolpath)

    def total(one):
        count = len(one.toolpath)
        angles = np.tile([5.0 * DEG, 0.0, 0.0], (count, 1))
        return node_terms(one, np.arange(count), angles, np.full(count, 0.04)).sum()

    assert total(fine) == pytest.approx(total(weighted), rel=1e-9)


def test_terms_are_continuous_at_the_comfort_clearance_and_zero_beyond(problem):
    weighted = with_settings(problem, weights=CostWeights(clearance=2.0, comfort=0.1))
    clearance = np.array([0.1 - 1e-9, 0.1, 0.2])
    terms = node_terms(weighted, np.array([3, 3, 3]), np.zeros((3, 3)), clearance)
    assert terms[0] < 1e-12
    assert np.all(terms[1:] == 0.0)


def test_deviation_is_measured_from_each_pass_nominal_lean(problem):
    weighted = with_settings(two_passes(problem), weights=CostWeights(lean=1.0))
    angles = np.tile([10.0 * DEG, 0.0, 0.0], (2, 1))
    terms = node_terms(weighted, np.array([5, 30]), angles, np.ones(2))
    assert terms[0] > 0.0
    assert terms[1] == pytest.approx(0.0, abs=1e-18)


def test_time_at_the_feed_is_unknown_over_a_link(problem):
    times = gap_times(two_passes(problem))
    assert np.flatnonzero(np.isnan(times)).tolist() == [19]
    feed = problem.toolpath.passes[0].feed
    positions = problem.toolpath.poses[:2, :3, 3]
    assert times[0] == pytest.approx(np.linalg.norm(positions[1] - positions[0]) / feed)


def test_gaps_carry_link_rules_between_passes_and_speeds_within(problem):
    limits = StepLimits(
        joints=np.full(6, 5.0 * DEG),
        link_joints=np.full(6, 90.0 * DEG),
        lean=2.0 * DEG,
        at_feed=True,
    )
    linked = with_settings(two_passes(problem), steps=limits, weights=CostWeights(link=0.25))
    rules = gaps(linked)
    assert rules.weight[19] == 0.25
    assert np.allclose(rules.steps[19], 90.0 * DEG)
    assert np.isinf(rules.lean[19])
    assert rules.weight[0] == 1.0
    assert rules.lean[0] == pytest.approx(2.0 * DEG)
    by_speed = problem.robot.speeds * gap_times(problem)[0]
    assert np.allclose(rules.steps[0], np.minimum(5.0 * DEG, by_speed))
    assert not gaps(problem).bounded or np.isfinite(gaps(problem).steps).any()
