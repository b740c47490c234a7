"""Numbers as the window says them: never a negative zero, and ° for deg."""

import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from posopt_gui.viewmodels.check_sentences import sentence
from posopt_gui.viewmodels.number_words import (
    clearance_mm,
    copied_decimal,
    decimal,
    in_figures,
    plain_words,
    signed,
    with_unit,
)

NEGATIVE_ZERO = re.compile(r"[-−+]0(\.0*)?(?![\d.])")


@given(st.floats(-1e-3, 1e-3), st.integers(0, 4))
def test_no_number_is_a_negative_zero(value, decimals):
    shown = (decimal(value, decimals), copied_decimal(value, decimals), signed(value, decimals))
    for text in (*shown, clearance_mm(max(value, 0.0)), in_figures(-0.0)):
        assert not NEGATIVE_ZERO.fullmatch(text), text


@pytest.mark.parametrize(
    ("said", "shown"),
    [
        ("-0.000 deg at waypoint 3", "0.000° at waypoint 3"),
        ("at -0.0, 5 mm", "at 0.0, 5 mm"),
        ("-0.001 deg at waypoint 3", "-0.001° at waypoint 3"),
        ("J3 (-185 to 273.12 deg)", "J3 (-185 to 273.12°)"),
        ("26-01-01", "26-01-01"),
        ("in deg", "in deg"),
    ],
)
def test_sentences_of_the_solver_hold_no_negative_zero(said, shown):
    assert plain_words(said) == shown
    assert sentence(said, lambda text, **values: text.format(**values) if values else text) == shown


def test_a_placement_of_three_points_says_no_negative_zero():
    # What the dialog makes of an angle that is a rounding below zero.
    assert ", ".join(decimal(one, 3) for one in np.array([89.981, -1e-9, 0.0])) == (
        "89.981, 0.000, 0.000"
    )


def test_a_degree_sign_follows_without_a_blank():
    assert with_unit("7", "deg") == "7°"
    assert with_unit("7", "mm") == "7 mm"
    assert with_unit("7", "") == "7"
