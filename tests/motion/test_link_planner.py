import itertools
from dataclasses import replace

import link_cells as cells
import numpy as np
import pytest

from solver.model.program import MotionKind, Move, Speed, rounded_joints
from solver.motion import link_planner
from solver.motion.link_checks import MoveChecker
from solver.motion.link_planner import plan_link
from solver.units import MM

CLEARANCE = 15.0 * MM
DENSE = 1.8 * MM
WALL = cells.box("wall", (0.85, -0.23, 0.61), (1.4, -0.22, 1.4))
ROOF = cells.box("roof", (0.5, -0.7, 1.45), (1.4, 0.3, 1.47))
START = np.radians([-26.4, -9.3, -25.5, -9.2, -50.1, 31.3])
"""Withdrawn from the web on one side of the wall; `END` is on its other side."""

END = np.radians([-3.1, -13.4, -25.1, -1.1, -48.9, 3.7])


@pytest.fixture(scope="module")
def problem():
    return cells.with_links(cells.Groove().problem, WALL, ROOF)


@pytest.fixture(scope="module")
def checker(problem):
    return MoveChecker.of(problem, CLEARANCE)


def assert_free(problem, way, oracle):
    for one, other in itertools.pairwise(way):
        move = Move(other, Speed.percent(20.0))
        for joints in cells.followed(problem, one, move, DENSE):
            assert cells.within_limits(problem, joints)
            assert oracle.lack(joints, CLEARANCE, touches_web=False) <= 2e-6


def length(way):
    return sum(np.abs(other - one) @ cells.REACH for one, other in itertools.pairwise(way))


def test_the_direct_way_is_not_free_and_the_planned_one_is(problem, checker):
    coal = pytest.importorskip("coal", reason="the distance oracle has wheels for Linux alone")
    start, end = rounded_joints(START), rounded_joints(END)
    assert checker.obstruction(start, end, MotionKind.JOINT) is not None
    way = [start, *plan_link(checker, start, end, (1,))]
    assert len(way) > 2
    assert np.array_equal(way[-1], end)
    assert all(np.array_equal(joints, rounded_joints(joints)) for joints in way)
    assert_free(problem, way, cells.FreeOracle(coal, [WALL, ROOF]))


def test_every_seed_gives_a_short_way_and_always_the_same(checker):
    start, end = rounded_joints(START), rounded_joints(END)
    direct = length([start, end])
    ways = {}
    for seed in range(3):
        way, again = (plan_link(checker, start, end, (seed, 3)) for _ in range(2))
        assert [joints.tobytes() for joints in way] == [joints.tobytes() for joints in again]
        assert length([start, *way]) < 4.0 * direct
        assert len(way) <= 6
        ways[seed] = np.array(way).tobytes()
    assert len(set(ways.values())) > 1


def test_a_way_stays_inside_narrow_windows(problem):
    low, high = np.radians([-40, -60, -60, -60, -100, -60]), np.radians([10, 5, 10, 60, -20, 60])
    narrow = replace(problem, joint_windows=np.column_stack([low, high]))
    way = plan_link(MoveChecker.of(narrow, CLEARANCE), START, END, (2,))
    assert way is not None
    assert all(cells.within_limits(narrow, joints) for joints in way)


def test_without_a_free_way_the_search_ends_within_its_bounds(problem):
    # Within the windows the arm reaches past the pillar in every posture.
    low, high = np.radians([-40, -20, -45, -200, -140, -270]), np.radians([60, 5, 5, 200, 140, 270])
    pillar = cells.box("pillar", (0.55, 0.45, 0.0), (0.65, 0.55, 3.0))
    blocked = replace(
        problem,
        fixtures=(*problem.fixtures[:-2], pillar),
        joint_windows=np.column_stack([low, high]),
    )
    away = np.radians([60.0, -10.0, -20.0, 0.0, -60.0, 0.0])
    counted = Counting.of(blocked, CLEARANCE)
    assert counted.free_postures(np.array([END, away])).all()
    assert plan_link(counted, END, away, (1,)) is None
    most = link_planner.POSTURE_LIMIT + link_planner.EXTENSION / min(link_planner.EDGE_STEPS)
    assert counted.postures[0] <= len(link_planner.EDGE_STEPS) * (most + 1)


class Counting(MoveChecker):
    """A checker that counts the postures it is asked for."""

    postures = [0]  # noqa: RUF012 - the base is frozen

    def free_postures(self, joints, spare=0.0):
        self.postures[0] += len(joints)
        return super().free_postures(joints, spare)


def test_a_start_beside_the_end_needs_no_detour(checker):
    start = rounded_joints(START)
    end = rounded_joints(START + np.radians([0.5, -0.5, 0.0, 0.0, 1.0, 0.0]))
    way = plan_link(checker, start, end, (1,))
    assert len(way) == 1
    assert np.array_equal(way[0], end)
