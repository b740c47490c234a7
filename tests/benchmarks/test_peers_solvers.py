"""Inverse kinematics and distances beside their peers: the errors are computed, and real."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from solver.benchmarks import peers_distance, peers_kinematics
from solver.benchmarks.peers_bracket import bracket, outside, posed, reach
from solver.benchmarks.peers_distance import time_distances
from solver.benchmarks.peers_kinematics import time_kinematics
from solver.benchmarks.peers_pairs import random_pairs
from solver.catalog import load_cell
from solver.collision.kernels_shapes import BOX, CAPSULE, CYLINDER, HULL, SPHERE

CORNERS = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
NONE = np.zeros((0, 3))


@pytest.fixture(scope="module", autouse=True)
def short_measurements():
    """One run of each is enough here: no time is looked at."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(peers_kinematics, "LEAST_TIME", 0.0)
        yield


@pytest.fixture(scope="module")
def cell():
    return load_cell("groove_hw300")


@pytest.fixture(scope="module")
def distances(cell):
    pytest.importorskip("coal")
    return time_distances(cell, 1, small=True)


def test_both_solvers_give_the_same_branches_of_the_cell(cell):
    rows = time_kinematics(cell, 1, small=True)
    assert len(rows) == 4
    for row in rows:
        assert row.unmatched == 0
        assert row.solutions == 8 * row.poses
        assert row.difference < 1e-9
        assert row.residual < 1e-9


def test_a_solution_that_the_other_solver_lacks_is_counted():
    ours = [np.array([[0.1] * 6, [0.2] * 6])]
    theirs = [np.array([[0.1 + 2.0 * np.pi] * 6, [0.2] * 5 + [0.21]])]
    apart = np.concatenate(list(peers_kinematics._differences(ours, theirs)))
    np.testing.assert_allclose(apart, [0.0, 0.01], atol=1e-12)
    nothing = [np.empty((0, 6))]
    assert next(peers_kinematics._differences(ours, nothing)).tolist() == [np.inf, np.inf]


def test_without_py_opw_kinematics_its_row_says_so(cell, monkeypatch):
    monkeypatch.setattr(peers_kinematics, "installed", lambda _: False)
    rows = time_kinematics(cell, 1, small=True)
    assert [row.per_pose is None for row in rows] == [False, False, True]
    assert "not installed" in rows[-1].note


def test_our_distances_are_within_the_proven_bounds_and_python_fcl_is_not(distances):
    assert {row.pairs_of for row in distances} == {
        "groove_hw300, 2 postures",
        "standing square",
        "turned at random",
    }
    for row in distances:
        assert row.pairs > 50
        assert row.known_to < 1e-6
        if row.method.startswith("posopt"):
            assert row.overstated == 0
            assert row.over < 1e-9
            assert row.under < 1.1e-6
    square = {row.method: row for row in distances if row.pairs_of == "standing square"}
    assert square["python-fcl, one pair a call"].overstated > 0


def test_python_fcl_over_states_unit_boxes_side_by_side_as_its_issue_508_says():
    unit, home = np.full(3, 0.5), np.zeros(3)
    pair = (
        posed(BOX, unit, NONE, np.eye(3), home),
        posed(BOX, unit, NONE, np.eye(3), np.array([0.0, 4.0, 0.0])),
    )
    ours = peers_distance._ours([pair])()
    bounds = [bracket(*pair, ours.points)]
    assert bounds[0] == pytest.approx((3.0, 3.0), abs=1e-12)
    fcl = peers_distance._fcl([pair])()
    over, under, count = peers_distance._errors(fcl.distance, bounds, np.array([True]))
    assert over == pytest.approx(0.1623, abs=1e-3)
    assert (under, count) == (0.0, 1)


def test_a_peer_that_is_not_installed_has_a_row_all_the_same(monkeypatch):
    monkeypatch.setattr(peers_distance, "installed", lambda package: package != "coal")
    rows = peers_distance._time_set(random_pairs(9, square=True), 1)
    assert [row.method.partition(",")[0] for row in rows] == ["posopt", "python-fcl", "coal"]
    assert [row.per_pair is None for row in rows] == [False, False, True]
    assert "not installed" in rows[-1].note


def convex_programme(one, other):
    """Distance of two polyhedra (k, 3) of vertices: least length over mixtures of vertices."""
    k = len(one)
    points = np.concatenate([one, -other]).T
    found = minimize(
        lambda x: float((points @ x) @ (points @ x)),
        np.concatenate([np.full(k, 1.0 / k), np.full(len(other), 1.0 / len(other))]),
        jac=lambda x: 2.0 * points.T @ (points @ x),
        bounds=[(0.0, 1.0)] * (k + len(other)),
        constraints=[
            {"type": "eq", "fun": lambda x: x[:k].sum() - 1.0},
            {"type": "eq", "fun": lambda x: x[k:].sum() - 1.0},
        ],
        method="SLSQP",
        options={"ftol": 1e-16, "maxiter": 500},
    )
    return float(np.linalg.norm(points @ found.x))


@pytest.mark.parametrize("seed", range(6))
def test_the_bounds_hold_the_distance_that_a_convex_programme_finds(seed):
    random = np.random.default_rng(seed)
    turns = Rotation.random(2, random_state=random).as_matrix()
    size, away = random.uniform(0.1, 0.5, 3), np.array([1.6, 0.4, -0.3])
    hull = random.uniform(-0.4, 0.4, (10, 3))
    box = posed(BOX, size, NONE, turns[0], np.zeros(3))
    other = posed(HULL, np.zeros(3), hull, turns[1], away)
    points = peers_distance._ours([(box, other)])().points
    low, high = bracket(box, other, points)
    expected = convex_programme((CORNERS * size) @ turns[0].T, hull @ turns[1].T + away)
    assert low - 1e-7 <= expected <= high + 1e-7
    assert high - low < 1e-6


def test_bounds_from_points_that_are_not_the_nearest_are_wide_but_hold():
    ball = posed(SPHERE, np.array([0.5, 0.0, 0.0]), NONE, np.eye(3), np.zeros(3))
    far = posed(SPHERE, np.array([0.5, 0.0, 0.0]), NONE, np.eye(3), np.array([3.0, 0.0, 0.0]))
    poor = (np.array([0.0, 0.5, 0.0]), np.array([3.0, -0.5, 0.0]))
    low, high = bracket(ball, far, [poor])
    assert low < 2.0 < high
    assert high == pytest.approx(np.hypot(3.0, 1.0))
    assert bracket(ball, far, []) == (0.0, np.inf)


@pytest.mark.parametrize(
    ("kind", "size"),
    [
        (SPHERE, (0.3, 0.0, 0.0)),
        (CAPSULE, (0.4, 0.2, 0.0)),
        (CYLINDER, (0.4, 0.2, 0.0)),
        (BOX, (0.2, 0.3, 0.4)),
        (HULL, (0.0, 0.0, 0.0)),
    ],
)
def test_no_point_within_a_body_is_outside_or_beyond_its_reach(kind, size):
    random = np.random.default_rng(3)
    vertices = CORNERS * (0.2, 0.3, 0.4) if kind == HULL else NONE
    turn = Rotation.random(random_state=random).as_matrix()
    body = posed(kind, np.array(size), vertices, turn, np.array([0.1, 0.2, 0.3]))
    farthest = []
    directions = random.normal(size=(40, 3))
    for direction in directions / np.linalg.norm(directions, axis=1)[:, None]:
        ray = np.linspace(0.0, 1.0, 2001)[:, None] * direction + body.position
        inside = np.array([outside(body, point) for point in ray]) <= 1e-12
        assert inside[0]
        assert not inside[-1]
        last = ray[inside][-1]
        assert direction @ last <= reach(body, direction) + 1e-9
        farthest.append(np.linalg.norm(last - body.position))
    bound = {SPHERE: 0.3, CAPSULE: 0.6}.get(kind, float(np.linalg.norm((0.2, 0.3, 0.4))))
    assert max(farthest) <= bound + 1e-9
