"""The front's arrays and words, without a screen."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import solver
from posopt_gui.viewmodels import front_model as module
from posopt_gui.viewmodels.front_model import (
    FrontModel,
    Mark,
    axis_range,
    cost_words,
    front_model,
    joined,
    minimum_mm,
    moved,
    point_words,
    present_mark,
    step_of,
    summary,
)
from solver.model.scheme import Scheme
from solver.model.settings import CostWeights, EdgeCost, Sweep
from solver.progress import SilentMonitor
from solver.study.planned_front import FrontPlan, planned_front

DEG = np.pi / 180.0
SILENT = SilentMonitor()


def english(text, **values):
    return text.format(**values)


@pytest.fixture(scope="module")
def result():
    problem = solver.load_cell("groove_hw300")
    settings = replace(problem.settings, lean=Sweep(-25.0 * DEG, 25.0 * DEG, 5.0 * DEG))
    return solver.plan(
        replace(problem, settings=replace(settings, safety_distance=0.04)),
        compare=(Scheme.F, Scheme.F2),
    )


@pytest.fixture(scope="module")
def model(result):
    return front_model(result, SILENT)


def made(clearance, cost, knee=None, **changes):
    count = len(cost)
    values = {
        "clearance": np.array(clearance), "cost": np.array(cost),
        "minimum": np.array(clearance), "lean": np.zeros((count, 2)), "knee": knee,
        "marks": (), "step": 0.0, "plain": True,
    }  # fmt: skip
    return FrontModel(**{**values, **changes})


def test_the_points_are_those_of_the_planned_front_in_mm(result, model):
    front = planned_front(result, 1e-6, SILENT)
    assert len(model) == len(front) > 10
    np.testing.assert_allclose(model.clearance, [1000.0 * one.kept for one in front])
    np.testing.assert_array_equal(model.cost, [one.sequence.cost for one in front])
    np.testing.assert_allclose(
        model.lean[:, 1], [np.rad2deg(one.sequence.angles[:, 0].max()) for one in front]
    )


def test_the_safety_distance_of_each_point_plans_that_very_point(result, model):
    for index in range(0, len(model), max(len(model) // 5, 1)):
        settings = replace(
            result.problem.settings,
            safety_distance=model.minimum[index] * 1e-3, scheme=Scheme.EXACT,
        )  # fmt: skip
        found = solver.plan(replace(result.problem, settings=settings))
        assert found.clearance_met
        assert found.sequence.cost == pytest.approx(model.cost[index], rel=1e-12)
        assert 1000.0 * found.sequence.least_clearance == pytest.approx(
            model.clearance[index], abs=0.02
        )
        assert model.minimum[index] <= model.clearance[index]


@given(st.floats(0.0, 0.2), st.floats(0.0, 1e-4))
def test_a_minimum_lies_between_what_gives_the_point_and_what_it_keeps(lowest, more):
    plan = FrontPlan(None, lowest, lowest + more)
    found = minimum_mm(plan) * 1e-3
    assert found <= plan.kept
    assert found >= plan.lowest or more < 1e-12


def test_where_there_is_room_a_minimum_has_two_decimals():
    assert minimum_mm(FrontPlan(None, 0.0501, 0.0508765)) == 50.87
    assert minimum_mm(FrontPlan(None, 0.0508762, 0.0508765)) == 50.8765
    assert minimum_mm(FrontPlan(None, 0.05, 0.05)) == 50.0


def test_the_stairs_rise_behind_each_point():
    x, y = made([1.0, 2.0, 4.0], [10.0, 11.0, 15.0]).stairs()
    assert list(zip(x, y, strict=True)) == [
        (1.0, 10.0), (1.0, 11.0), (2.0, 11.0), (2.0, 15.0), (4.0, 15.0),
    ]  # fmt: skip
    assert all(a <= b for a, b in pairwise(y))


def test_one_point_has_stairs_without_a_step():
    x, y = made([1.0], [10.0]).stairs()
    assert (x.tolist(), y.tolist()) == ([1.0], [10.0])


def test_the_nearest_point_is_meant_in_pixels():
    front = made([0.0, 10.0], [0.0, 1.0])
    # A pixel is 1 mm or 0.001 of cost.
    assert front.nearest((9.0, 0.0), (1.0, 0.001)) == (0, 9.0)
    assert front.nearest((9.0, 0.999), (1.0, 0.001))[0] == 1


def test_keys_begin_at_the_plan_and_stay_among_the_points():
    front = made([1.0, 2.0, 3.0], [1.0, 2.0, 4.0], knee=1)
    assert moved(front, None, 1, Mark("", 3.0, 4.0)) == 2
    assert moved(front, None, 1, Mark("", 9.0, 9.0)) == 1
    assert moved(front, 1, 1, None) == 2
    assert moved(front, 2, 10, None) == 2
    assert moved(front, 1, -1_000_000, None) == 0


def test_words_name_the_point_the_plan_and_the_knee():
    front = made([50.867, 60.0], [0.3, 0.45], knee=0)
    head, details = point_words(front, 0, Mark("", 50.87, 0.3), english)
    assert head == "50.86 mm · joint cost 0.30000"
    assert "this is the plan" in details
    assert "knee" in details
    _, details = point_words(front, 1, Mark("", 50.0, 0.3), english)
    assert "+10.00 mm and +50.0 % to the plan" in details
    assert "knee" not in details
    assert "the plan" not in point_words(front, 1, None, english)[1]


def test_the_summary_says_whether_every_point_is_there():
    assert summary(made([1.0], [1.0]), english).startswith("All 1 points")
    assert "at least 0.50 mm apart" in summary(made([1.0], [1.0], step=0.5), english)


def test_schemes_stand_beside_the_front_and_never_below_it(model):
    assert {one.name for one in model.marks} == {"f", "f2"}
    for mark in model.marks:
        reached = model.cost[model.clearance >= mark.clearance - 0.02]
        assert mark.cost >= reached.min() - 1e-9


def test_the_present_plan_is_found_among_the_points(result, model):
    mark = present_mark(model, result.sequence)
    at = model.at(mark)
    assert at is not None
    assert model.cost[at] == pytest.approx(result.sequence.cost, rel=1e-12)
    f2 = present_mark(model, result.sequences[Scheme.F2])
    assert f2.cost == pytest.approx(result.sequences[Scheme.F2].joint_cost, rel=1e-12)
    assert present_mark(model, None) is None


def test_an_objective_of_its_own_is_not_called_joint_cost(result):
    settings = result.problem.settings
    assert module.is_plain(settings)
    assert not module.is_plain(replace(settings, edge_cost=EdgeCost.SQUARED))
    assert not module.is_plain(replace(settings, weights=CostWeights(lean=0.1)))
    assert cost_words(made([1.0], [1.0], plain=False), english) == "objective"


def test_marks_in_one_place_share_a_name():
    marks = (Mark("f", 10.0, 0.3), Mark("f1", 10.0, 0.3), Mark("f2", 50.0, 0.4))
    assert [one.name for one in joined(marks)] == ["f, f1", "f2"]


def test_an_axis_shows_all_points_and_no_mark_that_is_far_away():
    low, high = axis_range(np.array([1.0, 2.0]), [2.5, 90.0])
    assert low < 1.0
    assert 2.5 < high < 4.0
    low, high = axis_range(np.array([3.0]), [])
    assert low < 3.0 < high


def test_a_large_graph_has_its_points_farther_apart(result, monkeypatch):
    assert step_of(result) == module.SAME
    monkeypatch.setattr(module, "MOST_EDGES", 70.0 * result.graph.edge_count)
    step = step_of(result)
    found = front_model(result, SILENT)
    assert found.step == pytest.approx(1000.0 * step)
    assert len(found) <= 72
    assert np.diff(found.clearance[:-1]).min() >= found.step
