"""Wishes beyond the path and at other places of it, and the reasons why wishes fail."""

from dataclasses import replace

import numpy as np
import pytest

import solver
from posopt_gui.i18n import texts
from posopt_gui.viewmodels.trouble_model import reason_words
from posopt_gui.viewmodels.wish_words import (
    beyond_path,
    moved_pins,
    moved_words,
    wishes_on_path,
)
from solver.model.wishes import Pin, Region
from solver.pipeline.replanning import replan


def plain(text, **values):
    return text.format(**values)


@pytest.fixture(scope="module")
def result():
    return solver.plan(solver.load_cell("groove_hw300"))


def test_pins_and_regions_beyond_the_path_are_listed_and_taken_away():
    pins = (Pin(3, 0.1), Pin(17, 0.1), Pin(25, 0.0))
    regions = (Region(5, 40, 0.0, 1.0), Region(17, 20, 0.0, 1.0))
    found = beyond_path(pins, regions, 17)
    assert found.pins == (17, 25)
    assert found.regions == ((17, 20),)
    assert "18, 26, 18–21" in found.words(plain)
    kept = wishes_on_path(pins, regions, 17)
    assert kept == (pins[:1], regions[:1])
    assert beyond_path(*kept, 17) is None
    words = beyond_path(pins[2:], (), 17).words(plain)
    assert words == "The pin of waypoint 26 lies beyond the path, which has 17 waypoints."


@pytest.mark.parametrize(("shift", "told"), [(0.49e-3, ()), (0.51e-3, (25,))])
def test_a_pinned_waypoint_that_moved_more_than_half_a_millimetre_is_told(result, shift, told):
    before = result.problem.toolpath
    first = before.passes[0]
    poses = first.poses.copy()
    poses[25, 0, 3] += shift
    now = before.with_passes((replace(first, poses=poses), *before.passes[1:]))
    assert moved_pins(before, now, [Pin(3, 0.0), Pin(25, 0.0), Pin(4000, 0.0)]) == told
    assert moved_words((25,), plain) == (
        "Waypoint 26 is at another place of the path now; its pin holds the number."
    )


def wishes_that_fail(result):
    feasible = np.degrees(result.candidates.orientations[:, 0])
    low = float(np.radians(feasible.min()))
    lean = float(result.sequence.angles[24, 0])
    return {
        "is rejected": ([Pin(24, low)], []),
        "is none of the map's": ([Pin(24, 0.0123)], []),
        "in a forbidden region": ([Pin(24, lean)], [Region(24, 24, -1.0, 1.0)]),
        "nearer than": ([Pin(24, float(np.radians(-5.0)))], []),
        "is forbidden": ([], [Region(24, 24, -1.0, 1.0)]),
        "pin of waypoint 71 lies beyond": ([Pin(70, 0.0)], []),
        "region of waypoints 71 to 81 lies beyond": ([], [Region(70, 80, -1.0, 1.0)]),
    }


def test_every_reason_why_wishes_fail_is_said_in_chinese(result):
    known = texts("zh_CN")

    def chinese(text, **values):
        return known.get(text, text).format(**values)

    for part, (pins, regions) in wishes_that_fail(result).items():
        answer = replan(result, pins, regions)
        assert answer.sequence is None
        assert part in answer.reason
        english = reason_words(answer.reason, plain)
        assert english[:1].isupper()
        said = reason_words(answer.reason, chinese)
        letters = {word for word in said.replace("mm", "").split() if word.isascii()}
        assert not any(word.isalpha() for word in letters), said


def test_the_reasons_of_an_impossible_step_and_a_changed_branch_are_said_in_chinese():
    known = texts("zh_CN")
    for reason in (
        "no allowed step leads from waypoint 4 to waypoint 5",
        "the branch would have to change between waypoints 4 and 5, within a pass; "
        "pin poses of one branch",
        "rounded to the program's decimals, every sequence comes nearer than is kept; "
        "try other wishes",
        "waypoint 4 has no feasible pose at all",
    ):
        said = reason_words(reason, lambda text, **values: known.get(text, text).format(**values))
        assert not any(letter.isascii() and letter.isalpha() for letter in said), said
