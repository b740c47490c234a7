"""Resampling keeps the polyline, its corners, roles and events, and never joins passes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation, Slerp

from solver.errors import InputError
from solver.io.importers import resample
from solver.io.importers.resampling import slerp
from solver.model.toolpath import Event, EventKind, Frame, Pass, Role, Toolpath
from solver.transforms import rotation_z


def toolpath(*positions: np.ndarray, rotations: np.ndarray | None = None) -> Toolpath:
    passes = []
    for number, points in enumerate(positions):
        poses = np.tile(np.eye(4), (len(points), 1, 1))
        poses[:, :3, 3] = points
        if rotations is not None:
            poses[:, :3, :3] = rotations
        roles = (Role.CONTACT,) * len(points)
        passes.append(Pass(poses, roles, 0.05, touches="web", lean=0.1, name=str(number)))
    return Toolpath(tuple(passes), Frame.BEAM, "source")


def length(points: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


points = st.lists(st.tuples(*[st.floats(-0.3, 0.3)] * 3), min_size=2, max_size=6).map(np.array)
separate = points.filter(lambda p: np.linalg.norm(np.diff(p, axis=0), axis=1).min() > 1e-3)


@given(separate, separate, st.floats(0.005, 2.0))
@settings(max_examples=60, deadline=None)
def test_gaps_keep_the_step_and_passes_keep_length_and_ends(
    first: np.ndarray, second: np.ndarray, step: float
) -> None:
    result = resample(toolpath(first, second), step)
    assert len(result.passes) == 2
    assert result.frame is Frame.BEAM
    for given_points, one in zip((first, second), result.passes, strict=True):
        gaps = np.linalg.norm(np.diff(one.positions, axis=0), axis=1)
        assert gaps.max() <= step * (1 + 1e-9)
        assert gaps.min() > 0.0
        assert length(one.positions) == pytest.approx(length(given_points), rel=1e-6)
        np.testing.assert_array_equal(one.positions[[0, -1]], given_points[[0, -1]])
        assert (one.feed, one.touches, one.lean) == (0.05, "web", 0.1)


def test_a_straight_pass_takes_even_steps_whatever_its_points_were() -> None:
    given_points = np.array([[x, 0.0, 0.0] for x in (0.0, 0.001, 0.013, 0.4, 0.47, 1.0)])
    one = resample(toolpath(given_points), 0.03).passes[0]
    gaps = np.diff(one.positions[:, 0])
    assert len(gaps) == 34
    np.testing.assert_allclose(gaps, 1.0 / 34.0, atol=1e-12)


def test_an_arc_of_many_small_turns_is_not_cut() -> None:
    angles = np.linspace(0.0, math.pi / 2, 4000)
    arc = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(4000)])
    one = resample(toolpath(arc), 0.5).passes[0]
    assert length(one.positions) == pytest.approx(math.pi / 2, rel=1e-6)
    assert len(one) < 4000


@given(st.lists(st.integers(0, 10_000), min_size=2, max_size=5), st.floats(0.01, 0.5))
@settings(max_examples=40, deadline=None)
def test_orientations_agree_with_the_slerp_of_an_independent_library(
    seeds: list[int], step: float
) -> None:
    rotations = Rotation.random(len(seeds), random_state=seeds[0])
    given_points = np.array([[0.1 * index, 0.0, 0.0] for index in range(len(seeds))])
    one = resample(toolpath(given_points, rotations=rotations.as_matrix()), step).passes[0]
    expected = Slerp(given_points[:, 0], rotations)(np.clip(one.positions[:, 0], 0, 0.1 * 9))
    difference = Rotation.from_matrix(one.poses[:, :3, :3]).inv() * expected
    assert np.abs(difference.magnitude()).max() < 1e-7


@pytest.mark.parametrize("angle", [0.0, 1e-12, 1e-7, 3.0, math.pi - 1e-9, math.pi])
def test_slerp_is_sound_from_no_turn_to_half_a_turn(angle: float) -> None:
    share = np.linspace(0.0, 1.0, 11)
    ends = np.array([rotation_z(0.2), rotation_z(0.2 + angle)])
    turned = slerp(ends, np.zeros(11, dtype=np.int64), share)
    turns = (Rotation.from_matrix(ends[0]).inv() * Rotation.from_matrix(turned)).magnitude()
    np.testing.assert_allclose(turns, share * angle, atol=1e-7)
    assert np.abs(turned @ turned.transpose(0, 2, 1) - np.eye(3)).max() < 1e-12


def test_events_stay_at_their_waypoints_and_roles_change_where_they_changed() -> None:
    given_points = np.array([[0.01 * index, 0.0, 0.0] for index in range(7)])
    poses = np.tile(np.eye(4), (7, 1, 1))
    poses[:, :3, 3] = given_points
    roles = (Role.APPROACH, Role.LEAD_IN, *[Role.CONTACT] * 4, Role.LEAD_OUT)
    events = {1: (Event(EventKind.SPINDLE_ON),), 4: (Event(EventKind.DWELL, value=0.5),)}
    path = Toolpath((Pass(poses, roles, 0.05, events),), Frame.BEAM)
    for step in (0.0011, 0.004, 0.5):
        one = resample(path, step).passes[0]
        found = {
            round(float(one.positions[index, 0]), 9): what for index, what in one.events.items()
        }
        assert found == {0.01: events[1], 0.04: events[4]}
        for position, role in zip(one.positions[:, 0], one.roles, strict=True):
            # A role is what the tool does on the way to a waypoint.
            assert role is roles[math.ceil(round(position / 0.01, 6))]


def test_resampling_to_the_same_step_changes_nothing() -> None:
    path = toolpath(np.array([[0.0, 0.0, 0.0], [0.3, 0.1, 0.0], [0.3, 0.5, 0.2]]))
    once = resample(path, 0.013)
    np.testing.assert_allclose(resample(once, 0.013).poses, once.poses, atol=1e-12)


def test_a_pass_of_one_point_stays_one_point() -> None:
    path = toolpath(np.zeros((1, 3)), np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]))
    assert [len(one) for one in resample(path, 0.5).passes] == [1, 3]


@pytest.mark.parametrize("step", [0.0, -1.0, math.nan, math.inf, 1e-9])
def test_a_step_that_makes_no_sense_is_refused(step: float) -> None:
    with pytest.raises(InputError, match="step"):
        resample(toolpath(np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])), step)
