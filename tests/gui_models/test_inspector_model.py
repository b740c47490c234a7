import re
from dataclasses import replace

import numpy as np
import pytest

import solver
from posopt_gui.i18n import translated
from posopt_gui.viewmodels.inspector_model import (
    candidate_pose,
    candidate_sheet,
    clearance_words,
    filter_rows,
    joint_bars,
    sequence_pose,
    sequence_sheet,
)
from posopt_gui.viewmodels.project_files import PROJECT
from posopt_gui.viewmodels.trouble_model import reason_words, trouble_of
from solver.candidates.outcomes import Outcome
from solver.errors import InputError, Place, PlanningError
from solver.model.settings import StepLimits, Sweep
from solver.pipeline.replanning import Pin, Region, replan

DEG = np.pi / 180.0


def english(text, **values):
    return text.format(**values)


def chinese(text, **values):
    return translated("zh_CN", text).format(**values)


def number(text):
    return float(text.replace("−", "-").rstrip("°").split()[0])


def with_settings(problem, **changes):
    return replace(problem, settings=replace(problem.settings, **changes))


@pytest.fixture(scope="module")
def problem():
    lean = Sweep(-25.0 * DEG, 25.0 * DEG, 5.0 * DEG)
    return with_settings(solver.load_cell("groove_hw300"), lean=lean, safety_distance=0.04)


@pytest.fixture(scope="module")
def result(problem):
    return solver.plan(problem)


def explained(result, pose):
    return solver.explain(
        result.problem, pose.waypoint, pose.lean, pose.branch, lead=pose.lead, spin=pose.spin,
        turn=pose.turn, scene=result.candidates.scene,
    )  # fmt: skip


@pytest.mark.parametrize("waypoint", [0, 16, 49])
def test_the_explained_pose_is_the_sequences_own(result, waypoint):
    explanation = explained(result, sequence_pose(result.sequence, waypoint))
    np.testing.assert_allclose(explanation.joints, result.sequence.pendant[waypoint], atol=1e-9)
    assert all(row.state == "good" for row in filter_rows(result.problem, explanation, english))


def test_the_sheet_of_the_plan_counts_from_one_and_shows_the_pendants_joints(result):
    sheet = sequence_sheet(result, result.sequence, 16, english)
    assert sheet.title == "Waypoint 17/50"
    assert sheet.verdict == "feasible"
    shown = [number(one.words) for one in sheet.joints]
    np.testing.assert_allclose(shown, np.rad2deg(result.sequence.pendant[16]), atol=0.0051)
    facts = dict(sheet.facts)
    assert number(facts["Lean"]) == pytest.approx(np.rad2deg(result.sequence.angles[16, 0]))
    config = solver.config_string(result.problem.robot, result.sequence.pendant[16])
    assert facts["CONFIG"] == config


def test_a_pose_under_the_safety_distance_says_so(result):
    stricter = replace(result, problem=with_settings(result.problem, safety_distance=1.0))
    sheet = sequence_sheet(stricter, result.sequence, 16, english)
    assert sheet.near
    assert sheet.verdict == "under the safety distance"
    explanation = explained(result, sequence_pose(result.sequence, 16))
    rows = filter_rows(stricter.problem, explanation, english)
    row = next(one for one in rows if one.name == "Clearance")
    assert row.state == "near"
    assert number(row.margin) == pytest.approx(1000 * explanation.clearance - 1000, abs=0.11)


def place_of(result, outcome):
    return tuple(map(int, np.argwhere(result.candidates.outcome == outcome)[0]))


@pytest.mark.parametrize("outcome", [Outcome.COLLISION, Outcome.JOINT_LIMIT])
def test_a_rejected_candidate_shows_which_filter_it_fails(result, outcome):
    waypoint, orientation, slot = place_of(result, outcome)
    pose = candidate_pose(result, waypoint, orientation, slot, None)
    explanation = explained(result, pose)
    sheet = candidate_sheet(result, pose, orientation, slot, explanation, english)
    assert sheet.outcome is outcome
    rows = filter_rows(result.problem, explanation, english)
    states = [(row.state, one.passed) for row, one in zip(rows, explanation.filters, strict=True)]
    assert all((state == "bad") == (not passed) for state, passed in states)
    assert any(state == "bad" for state, _ in states)


def test_the_clearance_names_both_bodies_and_is_rounded_down(result):
    pose = sequence_pose(result.sequence, 16)
    explanation = explained(result, pose)
    words = clearance_words(result.problem, explanation, english)
    assert " against " in words.bodies
    assert number(words.value) <= 1000.0 * explanation.clearance
    assert words.state == "good"
    assert clearance_words(result.problem, None, english) is None


def test_bars_mark_joints_near_their_limits(problem):
    low, high = problem.joint_limits[:, 0], problem.joint_limits[:, 1]
    joints = (low + high) / 2.0
    assert [one.state for one in joint_bars(problem, joints)] == ["good"] * 6
    assert [one.share for one in joint_bars(problem, joints)] == pytest.approx([0.5] * 6)
    joints[1], joints[4] = low[1] + 2.0 * DEG, high[4] + 1.0 * DEG
    states = [one.state for one in joint_bars(problem, joints)]
    assert states == ["good", "near", "good", "good", "bad", "good"]
    assert joint_bars(problem, joints)[4].share == 1.0


def test_no_trouble_where_nothing_is_wrong(result):
    assert trouble_of(None, None, None, english) is None
    assert trouble_of(None, None, replan(result), english) is None


def test_blocked_waypoints_name_constraint_amount_and_advice(problem):
    blocked = with_settings(problem, lean=Sweep(-60.0 * DEG, -40.0 * DEG, 5.0 * DEG))
    with pytest.raises(PlanningError) as caught:
        solver.plan(blocked)
    trouble = trouble_of(None, caught.value, None, english)
    first = caught.value.empty[0]
    assert "50 waypoints" in trouble.headline
    assert [one.waypoint for one in trouble.causes] == [one.waypoint for one in caught.value.empty]
    assert f"Waypoint {first.waypoint + 1}:" in trouble.causes[0].text
    assert f"misses {-first.missed.margin:.1f} mm" in trouble.causes[0].text
    assert trouble.advice.startswith("Try ")
    assert trouble.advice.endswith(".")
    # In Chinese a number has its counter behind it, and words stand without blanks.
    said = trouble_of(None, caught.value, None, chinese)
    assert re.search(r"（.+ \d+ 个）", said.causes[0].text)
    assert not re.search("[\u4e00-\u9fff] [\u4e00-\u9fff]", said.advice)


def test_steps_that_are_too_large_name_joint_step_and_limit(problem):
    bounds = StepLimits(joints=np.full(6, 0.001 * DEG))
    with pytest.raises(PlanningError) as caught:
        solver.plan(with_settings(problem, steps=bounds))
    trouble = trouble_of(None, caught.value, None, english)
    gap = caught.value.cut.gaps[0]
    assert trouble.causes[0].waypoint == gap.gap
    assert f"J{gap.joint} would have to step by {np.rad2deg(gap.step):.2f}°" in (
        trouble.causes[0].text
    )


def test_impossible_wishes_name_their_layer(result):
    for pins, regions in (
        ((), (Region(20, 21, -1.0, 1.0),)),
        ((Pin(30, 0.123456),), ()),
    ):
        answer = replan(result, pins, regions)
        assert answer.sequence is None
        trouble = trouble_of(None, None, answer, english)
        assert trouble.causes[0].waypoint == answer.layer
        assert f"aypoint {answer.layer + 1}" in trouble.causes[0].text
        # The sentence was recognised, so that it can be translated.
        assert not re.search("[a-z]{2}", reason_words(answer.reason, chinese))


def test_wrong_inputs_lead_to_their_field():
    error = InputError("must run upward", Place(PROJECT, key="fixtures[1].min_mm"))
    cell = {"fixtures": [{"name": "left"}, {"name": "right", "shape": "box"}]}
    trouble = trouble_of(error, None, None, english, cell)
    assert trouble.key == "fixtures.1.min_mm"
    assert trouble.causes[0].text == "Fixtures, right, Lower corner: must run upward"
