import json
from dataclasses import replace

import numpy as np
import pytest

from solver.analysis.references import ReferenceKind, references
from solver.analysis.report import result_document, summary
from solver.catalog import load_cell
from solver.cli.output import plain
from solver.errors import Cancelled
from solver.model.settings import CostWeights, EdgeCost, Scheme, StepLimits
from solver.pipeline.planning import plan
from solver.units import DEG, MM


@pytest.fixture(scope="module")
def problem():
    return load_cell("groove_hw300")


@pytest.fixture(scope="module")
def result(problem):
    return plan(problem, compare=(Scheme.F2,))


def test_every_layer_holds_five_nodes_above_the_safety_distance(result):
    nodes = result.candidates.nodes
    kept = nodes.clearance >= 50.0 * MM
    layer = nodes.candidate[kept, 0]
    assert np.bincount(layer, minlength=50).min() >= 5


def test_the_optimum_keeps_50_mm_and_lies_inside_the_lean_range(result):
    sequence = result.sequence
    assert result.clearance_met
    assert sequence.least_clearance >= 50.0 * MM
    assert np.abs(sequence.angles[:, 0]).max() < 25.0 * DEG
    assert sequence.joint_cost == pytest.approx(0.33, abs=0.005)


def test_extra_cost_is_zero_on_the_sequence_and_nowhere_negative(result):
    assert result.extra_cost[result.sequence.nodes].max() < 1e-12
    assert np.nanmin(result.extra_cost) >= 0.0


def test_references_tell_the_price_of_safety(result):
    nominal, constant, random = references(result)
    assert nominal.kind is ReferenceKind.NOMINAL
    assert not nominal.keeps_clearance
    assert nominal.least_clearance > 0.0
    assert constant.keeps_clearance
    assert constant.joint_cost > result.sequence.joint_cost
    assert random.joint_cost > constant.joint_cost


def test_same_cell_gives_the_same_sequence_and_report(problem, result):
    again = plan(problem, compare=(Scheme.F2,))
    assert np.array_equal(again.sequence.nodes, result.sequence.nodes)
    assert json.dumps(plain(result_document(again))) == json.dumps(plain(result_document(result)))
    assert summary(again) == summary(result)


class CancelAfter:
    def __init__(self, reports):
        self.left = reports

    def report(self, stage, done, total):
        self.left -= 1

    def cancelled(self):
        return self.left <= 0


@pytest.mark.parametrize("reports", [1, 3, 12, 14])
def test_planning_stops_when_asked(problem, reports):
    with pytest.raises(Cancelled):
        plan(problem, CancelAfter(reports))


def test_weights_and_squared_edges_change_the_optimum_as_they_should(problem, result):
    def planned(**changes):
        return plan(replace(problem, settings=replace(problem.settings, **changes))).sequence

    wide = planned(weights=CostWeights(clearance=5.0))
    assert wide.mean_clearance > result.sequence.mean_clearance
    upright = planned(weights=CostWeights(lean=5.0))
    assert np.abs(upright.angles[:, 0]).sum() < np.abs(result.sequence.angles[:, 0]).sum()
    smooth = planned(edge_cost=EdgeCost.SQUARED)
    second = np.abs(np.diff(smooth.model, 2, axis=0)).max()
    assert second <= np.abs(np.diff(result.sequence.model, 2, axis=0)).max()


def test_step_limits_are_kept(problem, result):
    largest = np.abs(np.diff(result.sequence.angles[:, 0])).max()
    assert largest > 0.0
    steps = StepLimits(joints=np.full(6, 1.3 * DEG), lean=1.0 * DEG, at_feed=True)
    sequence = plan(replace(problem, settings=replace(problem.settings, steps=steps))).sequence
    assert np.abs(np.diff(sequence.pendant, axis=0)).max() <= 1.3 * DEG + 1e-12
    assert sequence.joint_cost >= result.sequence.joint_cost - 1e-12
