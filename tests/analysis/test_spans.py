"""Passes are found again among a program's positions, whatever lies between them."""

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest

from solver.analysis.spans import find_spans
from solver.catalog import load_cell

MM = 1e-3


@pytest.fixture(scope="module")
def problem():
    return load_cell("zigzag_hw250")


def waypoints(problem):
    """Positions of the passes' waypoints in fanuc_world, one array for each pass."""
    ends = np.cumsum([len(one) for one in problem.toolpath.passes])[:-1]
    return np.split(problem.waypoint_poses[:, :3, 3], ends)


def between(one, other, count=3, height=60 * MM):
    """Positions of a link: up, across and down again."""
    share = np.linspace(0.0, 1.0, count)[:, None]
    return one + share * (other - one) + np.array([0.0, 0.0, height])


def program(passes):
    """Home, the passes with links between them, and home; and where each pass begins."""
    home = np.array([[0.5, 0.5, 1.0]])
    parts, starts = [home], []
    for number, one in enumerate(passes):
        if number:
            parts.append(between(passes[number - 1][-1], one[0]))
        starts.append(sum(map(len, parts)))
        parts.append(one)
    return np.concatenate([*parts, home]), starts


def test_each_pass_has_the_positions_that_were_made_for_it(problem):
    passes = waypoints(problem)
    positions, starts = program(passes)
    for span, one, start in zip(find_spans(problem, positions), passes, starts, strict=True):
        assert (span.first, span.last) == (start, start + len(one) - 1)
        assert span.arc.tolist() == list(range(len(one)))
        assert span.distance.max() == 0.0


def test_dropped_waypoints_are_told_from_the_ones_that_are_kept(problem):
    passes = waypoints(problem)
    kept = [[0, 1, 7, 20, 24], [0, 24], [0, 3, 4, 5, 23, 24]]
    fewer = [one[rows] for one, rows in zip(passes, kept, strict=True)]
    positions, starts = program(fewer)
    for span, rows, start in zip(find_spans(problem, positions), kept, starts, strict=True):
        assert (span.first, span.last) == (start, start + len(rows) - 1)
        assert span.arc.tolist() == rows
        assert span.share.tolist() == [0.0] * len(rows)


def test_positions_between_two_waypoints_have_their_share(problem):
    passes = waypoints(problem)
    one = passes[1]
    middle = 0.25 * one[4] + 0.75 * one[5]
    passes[1] = np.concatenate([one[:3], [middle], one[20:]])
    positions, _ = program(passes)
    span = find_spans(problem, positions)[1]
    assert span.arc[3] == pytest.approx(4.75, abs=1e-9)
    assert span.distance[3] == pytest.approx(0.0, abs=1e-12)


def test_a_position_off_the_path_has_its_distance(problem):
    passes = waypoints(problem)
    passes[0] = passes[0].copy()
    along = passes[0][1] - passes[0][0]
    square = np.cross(along, [0.0, 0.0, 1.0])
    passes[0][10] += 2 * MM * square / np.linalg.norm(square)
    positions, _ = program(passes)
    span = find_spans(problem, positions)[0]
    assert span.distance[10] == pytest.approx(2 * MM, abs=1e-9)
    assert np.delete(span.distance, 10).max() == 0.0


def test_the_ends_are_the_nearest_in_all_that_come_in_this_order(problem):
    """Against every choice of six positions in ascending order."""
    passes = waypoints(problem)
    ends = np.array([one[row] for one in passes for row in (0, -1)])
    random = np.random.default_rng(11)
    for _ in range(20):
        positions = ends[random.integers(0, 6, 9)] + random.normal(0.0, 0.05, (9, 3))
        spans = find_spans(problem, positions)
        found = [row for span in spans for row in (span.first, span.last)]
        away = np.linalg.norm(positions[:, None] - ends[None], axis=2)
        best = min(
            sum(away[row, end] for end, row in enumerate(one)) for one in combinations(range(9), 6)
        )
        assert sum(away[row, end] for end, row in enumerate(found)) == pytest.approx(best)


def test_too_few_positions_follow_no_path(problem):
    positions, _ = program(waypoints(problem))
    assert find_spans(problem, positions[:5]) is None
    assert find_spans(problem, positions[:6]) is not None


def test_passes_in_another_order_lie_far_from_their_positions(problem):
    passes = waypoints(problem)
    positions, _ = program([passes[1], passes[0], passes[2]])
    assert max(span.distance.max() for span in find_spans(problem, positions)) > 50 * MM


def test_a_pass_that_is_driven_backward_lies_far_from_its_positions(problem):
    passes = waypoints(problem)
    positions, _ = program([passes[0][::-1], passes[1], passes[2]])
    assert max(span.distance.max() for span in find_spans(problem, positions)) > 50 * MM


def test_a_pass_of_one_waypoint_has_one_position(problem):
    passes = problem.toolpath.passes
    single = replace(passes[1], poses=passes[1].poses[:1], roles=passes[1].roles[:1])
    toolpath = problem.toolpath.with_passes((passes[0], single, passes[2]))
    changed = replace(problem, toolpath=toolpath)
    positions, starts = program(waypoints(changed))
    spans = find_spans(changed, positions)
    assert (spans[1].first, spans[1].last) == (starts[1], starts[1])
    assert spans[2].waypoint == len(passes[0]) + 1
