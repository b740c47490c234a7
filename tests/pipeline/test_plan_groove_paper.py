"""The reconstructed cell of the paper gives the published reconstruction's figures."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from solver.candidates.outcomes import Outcome
from solver.catalog import load_cell
from solver.model.settings import Scheme, Turns
from solver.pipeline.planning import plan
from solver.units import MM


@pytest.fixture(scope="module")
def result():
    return plan(load_cell("groove_paper"), compare=tuple(Scheme))


@pytest.fixture(scope="module")
def all_branches():
    problem = load_cell("groove_paper")
    settings = replace(problem.settings, branches=tuple(range(8)), turns=Turns.PRINCIPAL)
    return plan(replace(problem, settings=settings), compare=tuple(Scheme))


def test_nodes_are_1133_feasible_10_singular_1407_colliding(result):
    counts = result.candidates.counts()
    assert counts[Outcome.FEASIBLE] == 1133
    assert counts[Outcome.SINGULAR] == 10
    assert counts[Outcome.COLLISION] == 1407
    assert sum(counts.values()) == 2550


@pytest.mark.parametrize(
    ("scheme", "cost", "least_mm", "expanded"),
    [
        (Scheme.F, 0.32758, 10.65, 442),
        (Scheme.F1, 0.32758, 10.65, 559),
        (Scheme.F2, 0.47822, 50.03, 341),
    ],
)
def test_schemes_of_the_paper_on_branch_0(result, scheme, cost, least_mm, expanded):
    sequence = result.sequences[scheme]
    assert sequence.joint_cost == pytest.approx(cost, abs=5e-6)
    assert sequence.least_clearance == pytest.approx(least_mm * MM, abs=0.005 * MM)
    assert sequence.expanded == expanded


@pytest.mark.parametrize(
    ("scheme", "cost", "expanded"),
    [(Scheme.F, 0.32758, 442), (Scheme.F1, 0.32758, 581), (Scheme.F2, 0.47822, 417)],
)
def test_schemes_of_the_paper_on_all_branches(all_branches, scheme, cost, expanded):
    sequence = all_branches.sequences[scheme]
    assert sequence.joint_cost == pytest.approx(cost, abs=5e-6)
    assert sequence.expanded == expanded


def test_mean_clearances_of_f_and_f2(result):
    assert result.sequences[Scheme.F].mean_clearance == pytest.approx(46.75 * MM, abs=0.005 * MM)
    # Three sequences of f2 have the same cost; their mean is 56.84 or 56.94 mm.
    mean = result.sequences[Scheme.F2].mean_clearance / MM
    assert min(abs(mean - 56.84), abs(mean - 56.94)) < 0.005


def test_exact_under_the_hard_minimum_equals_f2(result):
    exact, penalised = result.sequences[Scheme.EXACT], result.sequences[Scheme.F2]
    assert result.clearance_met
    assert exact.least_clearance >= 50.0 * MM
    assert exact.joint_cost == pytest.approx(penalised.joint_cost, abs=1e-12)


def test_the_cost_is_in_model_angles(result):
    """In pendant angles f1 would be 0.31432."""
    ranges = result.problem.robot.cost_ranges
    steps = np.abs(np.diff(result.sequences[Scheme.F1].pendant, axis=0)) / ranges
    assert steps.sum() == pytest.approx(0.31432, abs=5e-6)


@pytest.mark.parametrize(
    ("beam", "least_mm"),
    [
        ("HW125", 36.5),
        ("HW150", 27.6),
        ("HW175", 22.3),
        ("HW200", 21.2),
        ("HW250", 15.9),
        ("HW350", 12.0),
    ],
)
def test_standard_search_on_the_other_beams(beam, least_mm):
    result = plan(load_cell("groove_paper", beam=beam), compare=(Scheme.F,))
    least = result.sequences[Scheme.F].least_clearance
    assert least == pytest.approx(least_mm * MM, abs=0.05 * MM)


def test_hw125_cannot_keep_the_safety_distance_and_says_so():
    result = plan(load_cell("groove_paper", beam="HW125"))
    assert not result.clearance_met
    sequence = result.sequence
    assert sequence.least_clearance == pytest.approx(result.hard_minimum, abs=1e-12)
    # No layer allows more: the best reachable minimum is the least of the layers' maxima.
    nodes = result.candidates.nodes
    best = [nodes.clearance[a:b].max() for a, b in itertools.pairwise(nodes.offsets)]
    assert result.hard_minimum == pytest.approx(min(best), abs=1e-12)
