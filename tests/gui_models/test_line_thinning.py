"""Lines, bars and columns over more waypoints than there are pixels."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from posopt_gui.viewmodels.curves_model import move_steps
from posopt_gui.viewmodels.line_thinning import (
    STRAIGHT,
    drawn_points,
    grouped_ranges,
    tallest_of_groups,
)
from posopt_gui.viewmodels.map_colours import CLASS_RANK, CellClass
from posopt_gui.viewmodels.map_columns import worst_of_columns


def screen(count, width):
    return np.linspace(0.0, width, count)


@settings(max_examples=60, deadline=None)
@given(st.integers(2, 6000), st.integers(50, 1500), st.integers(0, 2**32 - 1))
def test_a_thinned_line_reaches_every_extreme_of_each_column(count, width, seed):
    x = screen(count, width)
    y = 100.0 * np.random.default_rng(seed).random(count)
    kept = drawn_points(x, y)
    assert kept[0] == 0
    assert kept[-1] == count - 1
    assert np.all(np.diff(kept) > 0)
    assert y[kept].max() >= y.max() - STRAIGHT
    assert y[kept].min() <= y.min() + STRAIGHT
    # What is drawn over a column of pixels is what all of its points would have covered.
    for column in range(0, width, 37):
        own = np.flatnonzero((x >= column) & (x <= column + 1))
        near = (x[kept] >= column - 1.0) & (x[kept] <= column + 2.0)
        if len(own) > 2:
            assert y[kept][near].max() >= y[own].max() - STRAIGHT
            assert y[kept][near].min() <= y[own].min() + STRAIGHT


@settings(max_examples=60, deadline=None)
@given(st.integers(2, 1500), st.integers(0, 2**32 - 1), st.floats(0.01, 50.0))
def test_with_a_pixel_for_each_point_no_point_lies_off_the_drawn_line(count, seed, rough):
    x = screen(count, 3.0 * count)
    y = np.cumsum(rough * np.random.default_rng(seed).standard_normal(count))
    kept = drawn_points(x, y)
    assert np.abs(np.interp(x, x[kept], y[kept]) - y).max() <= STRAIGHT + 1e-9


def test_a_single_point_that_stands_out_of_five_thousand_is_drawn():
    y = np.full(5000, 40.0)
    y[3217] = 3.0
    kept = drawn_points(screen(5000, 700.0), y)
    assert 3217 in kept
    assert len(kept) < 50


def test_a_straight_line_needs_few_points_and_a_bent_one_its_corner():
    x = screen(1001, 900.0)
    assert len(drawn_points(x, 0.3 * x)) < 12
    bent = np.where(x < 450.0, 0.0, x - 450.0)
    drawn = drawn_points(x, bent)
    assert np.abs(np.interp(x, x[drawn], bent[drawn]) - bent).max() <= STRAIGHT


@pytest.mark.parametrize("gap", [[100], [0], [4999], [100, 101, 2500]])
def test_a_line_stays_interrupted_where_it_was(gap):
    y = np.sin(np.arange(5000.0) / 300.0) * 50.0
    y[gap] = np.nan
    kept = drawn_points(screen(5000, 800.0), y)
    broken = np.isnan(y[kept])
    for place in gap:
        if not np.isnan(y[max(place - 1, 0)]) or place == 0:
            assert place in kept
    for place in np.flatnonzero(np.isnan(y)):
        # The neighbours on both sides are the last and the first point of their parts.
        after = kept[kept > place]
        before = kept[kept < place]
        if len(after) and len(before):
            assert broken[(kept >= before[-1]) & (kept <= after[0])].any()


def test_points_where_another_part_begins_are_kept():
    y = np.zeros(3000)
    kept = drawn_points(screen(3000, 600.0), y, np.array([700, 1900]))
    assert {699, 700, 1899, 1900} <= set(kept.tolist())


def test_of_the_bars_in_a_column_the_tallest_is_drawn():
    x = np.arange(1.0, 5001.0)
    top = np.full(5000, 0.02)
    top[4932] = 2.4
    kept, groups = tallest_of_groups(x, top, 8)
    assert 4932 in kept
    assert np.array_equal(groups, np.unique(x // 8))
    assert np.array_equal(np.floor(x[kept] / 8), groups)


def test_a_column_of_ranges_covers_each_of_them():
    rng = np.random.default_rng(3)
    x = np.sort(rng.choice(5000, 2000, replace=False)).astype(float)
    low = rng.random(2000)
    high = low + rng.random(2000)
    groups, least, greatest = grouped_ranges(x, low, high, 6)
    for number, group in enumerate(groups):
        own = np.floor(x / 6) == group
        assert least[number] == low[own].min()
        assert greatest[number] == high[own].max()
    assert set(groups) == set(np.floor(x / 6))


def test_a_column_of_the_map_shows_the_worst_of_its_waypoints():
    rng = np.random.default_rng(5)
    kinds = rng.integers(0, len(CellClass), (103, 7)).astype(np.uint8)
    worst = worst_of_columns(kinds, 10, outcome=True)
    values = worst_of_columns(kinds, 10, outcome=False)
    assert worst.shape == values.shape == (11, 7)
    for column in range(11):
        own = kinds[10 * column : 10 * column + 10]
        assert np.array_equal(CLASS_RANK[worst[column]], CLASS_RANK[own].min(axis=0))
        assert np.array_equal(values[column], own.min(axis=0))


def test_one_waypoint_a_column_changes_nothing():
    kinds = np.random.default_rng(6).integers(0, len(CellClass), (40, 5)).astype(np.uint8)
    assert np.array_equal(worst_of_columns(kinds, 1, outcome=True), kinds)
    assert np.array_equal(worst_of_columns(kinds, 1, outcome=False), kinds)


def test_the_asked_feed_is_one_line_until_it_changes_or_a_move_is_missing():
    x, y = move_steps(np.array([2.0, 3.0, 4.0, 7.0]), np.array([20.0, 20.0, 30.0, 30.0]))
    gaps = np.flatnonzero(np.isnan(y))
    parts = [part[~np.isnan(part)].tolist() for part in np.split(y, gaps)]
    assert parts == [[20.0] * 4, [30.0] * 2, [30.0] * 2]
    assert x[~np.isnan(y)].tolist() == [1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 6.0, 7.0]
