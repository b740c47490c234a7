"""The front that can be planned: every point is what planning gives under its minimum."""

from dataclasses import replace

import numpy as np
import pytest
from study_cells import shortened

from solver.catalog import load_cell
from solver.errors import Cancelled
from solver.model.settings import CostWeights, EdgeCost, Scheme, Sweep
from solver.pipeline.planning import layered_graph, plan, rounded_clearance
from solver.progress import SilentMonitor
from solver.search.exact import cheapest
from solver.study.pareto import front_of
from solver.study.planned_front import planned_front
from solver.units import DEG

SILENT = SilentMonitor()


def small(cell, every=5, **changes):
    problem = shortened(load_cell(cell), every)
    lean = Sweep(-25.0 * DEG, 25.0 * DEG, 2.5 * DEG)
    return plan(replace(problem, settings=replace(problem.settings, lean=lean, **changes)))


@pytest.fixture(scope="module")
def groove():
    return small("groove_hw300")


def planned_with(result, minimum):
    settings = replace(result.problem.settings, safety_distance=minimum, scheme=Scheme.EXACT)
    return plan(replace(result.problem, settings=settings))


def test_planning_with_either_end_of_a_points_minima_gives_that_very_plan(groove):
    front = planned_front(groove, 0.0, SILENT)
    assert len(front) > 8
    for one in front[:: len(front) // 4]:
        for minimum in (one.lowest, one.kept):
            found = planned_with(groove, minimum)
            assert found.clearance_met
            assert np.array_equal(found.sequence.nodes, one.sequence.nodes)
            assert found.sequence.cost == pytest.approx(one.sequence.cost, rel=1e-12)


def test_no_point_dominates_another_and_the_ends_are_those_of_the_graph(groove):
    front = planned_front(groove, 0.0, SILENT)
    kept = np.array([one.kept for one in front])
    cost = np.array([one.sequence.cost for one in front])
    assert np.all(np.diff(kept) > 0.0)
    assert np.all(np.diff(cost) > 0.0)
    assert cost[0] == cheapest(layered_graph(groove.candidates))[1]
    # A larger minimum than the last cannot be met.
    beyond = planned_with(groove, np.nextafter(kept[-1], 1.0))
    assert not beyond.clearance_met or beyond.sequence.cost == cost[-1]


def test_what_a_point_keeps_is_kept_by_its_exported_joints(groove):
    for one in planned_front(groove, 0.0, SILENT):
        rounded = rounded_clearance(groove.candidates, one.sequence.nodes)
        assert one.kept == min(one.sequence.least_clearance, rounded.min())
        assert abs(one.kept - one.sequence.least_clearance) < 1e-5


def test_without_rounding_it_is_the_front_of_the_study():
    result = small("groove_paper")
    points = [(one.kept, one.sequence.cost) for one in planned_front(result, 0.0, SILENT)]
    wanted = [(one.least_clearance, one.cost) for one in front_of(result, 0.0, SILENT)]
    # Rounding to the export's decimals moves a clearance by micrometres at most.
    costs = {round(cost, 9) for _, cost in wanted}
    assert {round(cost, 9) for _, cost in points} <= costs
    assert points[0] == pytest.approx(wanted[0], abs=1e-5)
    assert points[-1] == pytest.approx(wanted[-1], abs=1e-5)


def test_a_step_thins_the_front_and_keeps_its_ends(groove):
    whole = planned_front(groove, 0.0, SILENT)
    thin = planned_front(groove, 0.01, SILENT)
    assert 2 <= len(thin) < len(whole)
    for at in (0, -1):
        assert np.array_equal(thin[at].sequence.nodes, whole[at].sequence.nodes)
    assert np.diff([one.kept for one in thin[:-1]]).min() > 0.01


def test_the_objective_is_the_cells_own():
    result = small("groove_hw300", edge_cost=EdgeCost.SQUARED, weights=CostWeights(clearance=0.5))
    front = planned_front(result, 0.005, SILENT)
    graph = layered_graph(result.candidates)
    for one in front:
        assert one.sequence.cost == pytest.approx(graph.path_cost(one.sequence.nodes), rel=1e-9)
    assert np.all(np.diff([one.sequence.cost for one in front]) > 0.0)


class StopsAfter:
    """A monitor that cancels after so many questions."""

    def __init__(self, questions):
        self.left = questions
        self.told = []

    def report(self, stage, done, total):
        self.told.append((stage, done, total))

    def cancelled(self):
        self.left -= 1
        return self.left < 0


def test_progress_rises_and_cancelling_ends_it(groove):
    monitor = StopsAfter(10**9)
    planned_front(groove, 0.005, monitor)
    done = [part for stage, part, _ in monitor.told if stage == "front"]
    assert done == sorted(done)
    assert done[-1] == monitor.told[-1][2]
    for questions in (0, 1, 7, 40):
        with pytest.raises(Cancelled):
            planned_front(groove, 0.0, StopsAfter(questions))
