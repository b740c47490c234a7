from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import solver
from posopt_gui.viewmodels.curves_model import (
    PLAN,
    axis_place,
    axis_ticks,
    broken,
    compared_tracks,
    feed_curve,
    first_of_passes,
    free_side,
    joint_range,
    joint_words,
    limit_words,
    measure_rows,
    percent,
    place_on_path,
    sequence_track,
)
from posopt_gui.viewmodels.reference_nodes import reference_nodes
from solver.model.settings import Sweep

DEG = np.pi / 180.0


def english(text, **values):
    return text.format(**values)


def coarse(name):
    problem = solver.load_cell(name)
    lean = Sweep(-25.0 * DEG, 25.0 * DEG, 5.0 * DEG)
    settings = replace(problem.settings, lean=lean, safety_distance=0.03)
    return solver.plan(replace(problem, settings=settings))


@pytest.fixture(scope="module", params=["groove_hw300", "zigzag_hw250"])
def result(request):
    return coarse(request.param)


def cost_of(result, nodes):
    model = result.candidates.nodes.model[nodes]
    return np.sum(np.abs(np.diff(model, axis=0)) / result.problem.robot.cost_ranges)


def test_drawn_references_are_the_sequences_that_the_solver_measured(result):
    from solver.analysis.references import constant_lean, nominal_lean, random_lean

    for one in (nominal_lean(result), constant_lean(result), random_lean(result, draws=1)):
        nodes = reference_nodes(result, one)
        if not one.found:
            assert nodes is None
            continue
        assert result.candidates.nodes.candidate[nodes, 0].tolist() == list(
            range(len(result.problem.toolpath))
        )
        assert cost_of(result, nodes) == pytest.approx(one.joint_cost, rel=1e-12)
        assert result.candidates.nodes.clearance[nodes].min() == one.least_clearance


def test_a_track_holds_the_sequence_in_millimetres_and_degrees(result):
    track = sequence_track(result.problem, result.sequence)
    assert track.name == PLAN
    np.testing.assert_allclose(track.joints, np.rad2deg(result.sequence.pendant))
    np.testing.assert_allclose(track.clearance, 1000.0 * result.sequence.clearance)


def test_steps_are_moves_within_a_pass_and_missing_where_a_link_leads(result):
    track = sequence_track(result.problem, result.sequence)
    starts = {0, *first_of_passes(result.problem)}
    assert len(starts) == len(result.problem.toolpath.passes)
    for waypoint in range(len(track.steps)):
        if waypoint in starts:
            assert np.isnan(track.steps[waypoint]).all()
        else:
            moved = result.sequence.pendant[waypoint] - result.sequence.pendant[waypoint - 1]
            np.testing.assert_allclose(track.steps[waypoint], np.abs(np.rad2deg(moved)))


def test_all_references_of_the_result_are_drawn_over_every_waypoint(result):
    tracks = compared_tracks(result)
    found = [one.kind.name for one in solver.references(result) if one.found]
    assert [one.name for one in tracks] == found
    assert all(len(one.joints) == len(result.problem.toolpath) for one in tracks)


def test_table_of_measures_holds_the_relative_change_against_each_reference(result):
    plan, tracks = sequence_track(result.problem, result.sequence), compared_tracks(result)
    rows = measure_rows(plan, tracks, english)
    block = len(tracks) + 2
    assert len(rows) == 4 * block
    amplitude = rows[block : 2 * block]
    assert amplitude[0].heading
    spans = np.rad2deg(np.ptp(result.sequence.pendant, axis=0))
    assert amplitude[1].texts == tuple(f"{value:.2f}" for value in spans)
    for row, other in zip(amplitude[2:], tracks, strict=True):
        if other.name == "RANDOM":
            continue
        expected = spans / np.ptp(other.joints, axis=0) - 1.0
        moving = np.ptp(other.joints, axis=0) > 1e-9
        np.testing.assert_allclose(np.array(row.gains)[moving], expected[moving], atol=1e-9)


def test_lines_are_interrupted_before_each_later_pass():
    values = np.array([1.0, 2.0, 3.0, 4.0, 5.0])
    x, y = broken(values, [2, 4])
    assert x.tolist() == [1, 2, 2.5, 3, 4, 4.5, 5]
    assert np.isnan(y[[2, 5]]).all()
    assert y[~np.isnan(y)].tolist() == values.tolist()
    same, whole = broken(values, [])
    assert same.tolist() == [1, 2, 3, 4, 5]
    assert whole is values


@given(st.floats(0.0, 49.0))
def test_a_place_on_the_axis_leads_back_to_the_place_on_the_path(place):
    assert place_on_path(axis_place(place), 50) == pytest.approx(place)


@given(st.floats(-1e4, 1e4), st.integers(0, 60))
def test_no_place_on_the_axis_leads_off_the_path(axis, count):
    assert 0.0 <= place_on_path(axis, count) <= max(count - 1, 0)


finite = st.floats(-180.0, 180.0)


@given(st.lists(finite, min_size=1, max_size=9), st.floats(0.0, 0.5), st.booleans())
def test_a_joints_axis_holds_all_its_values_below_the_words(values, headroom, whole):
    limits = np.array([-180.0, 180.0])
    low, high = joint_range([np.array(values)], limits, whole=whole, headroom=headroom)
    top = high - headroom * (high - low)
    assert low < min(values)
    assert max(values) < top
    if whole:
        assert low < -180.0
        assert top > 180.0


@given(finite, st.floats(4.0, 400.0), st.integers(1, 8))
def test_axis_numbers_are_few_and_round_and_within_the_axis(low, span, most):
    ticks = axis_ticks(low, low + span, most)
    assert 1 <= len(ticks) <= most
    assert all(low - 1e-6 * span <= one <= low + span * (1 + 1e-6) for one in ticks)
    assert all(one == pytest.approx(round(one, 1), abs=1e-9) for one in ticks)
    steps = np.diff(ticks)
    assert np.allclose(steps, steps[:1].sum() if len(steps) else 0.0)


@given(st.lists(finite, min_size=2, max_size=12), st.floats(0.1, 0.5))
def test_words_are_put_where_the_curves_left_part_does_not_run(values, height):
    low, high = -200.0, 200.0
    side = free_side([np.array(values)], low, high, part=1.0, height=height)
    shares = (np.array(values) - low) / (high - low)
    if side == "top":
        assert shares.max() < 1.0 - height
    elif side == "bottom":
        assert shares.min() > height
    else:
        assert shares.max() >= 1.0 - height
        assert shares.min() <= height


def test_the_nearer_limit_counts_for_what_is_left():
    words = limit_words(english, 3, -170.5, np.array([-185.0, 273.12]))
    assert words == "J3 −170.50°, limits −185.00° to 273.12°, 14.50° left"
    assert joint_words(3, -170.5) == "<b>J3</b> −170.50°"


@pytest.mark.parametrize(
    ("share", "words"),
    [(-0.9, "−90 %"), (0.077, "+8 %"), (-0.001, "0 %"), (float("nan"), "–"), (21.4, "×22")],
)
def test_relative_changes_read_as_percent(share, words):
    assert percent(share) == words


def line(place, move, slowest, held=True):
    prediction = SimpleNamespace(slowest=slowest, fastest=slowest + 0.001, joint=4)
    return SimpleNamespace(place=place, move=move, asked=0.02, prediction=prediction, held=held)


def test_feeds_stand_at_the_waypoint_that_their_move_leads_to():
    feeds = (line("waypoint 2 (A.LS line 12)", 3, 0.019), line("waypoint 5 (x)", 4, 0.01, False))
    curve = feed_curve(SimpleNamespace(feeds=feeds))
    assert curve.waypoint.tolist() == [2.0, 5.0]
    np.testing.assert_allclose(curve.slowest, [19.0, 10.0])
    np.testing.assert_allclose(curve.asked, [20.0, 20.0])
    assert curve.held.tolist() == [True, False]
    assert curve.joint.tolist() == [5, 5]


def test_without_a_check_there_is_no_feed():
    assert feed_curve(None) is None
    assert feed_curve(SimpleNamespace(feeds=())) is None
