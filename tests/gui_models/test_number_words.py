"""Numbers as the window says them: never a negative zero, and ° for deg."""

import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from posopt_gui.viewmodels.check_figures import check_figure
from posopt_gui.viewmodels.check_sentences import sentence
from posopt_gui.viewmodels.number_words import (
    body_words,
    clearance_mm,
    copied_decimal,
    decimal,
    in_figures,
    plain_words,
    signed,
    typeset,
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
    spoken = sentence(said, lambda text, **values: text.format(**values) if values else text)
    assert spoken == typeset(shown)


@pytest.mark.parametrize(
    ("said", "shown"),
    [
        ("J1 is -170 to 170 deg; some reach +-185 deg", "J1 is −170 to 170°; some reach ±185°"),
        ("at (-3.0, -0.0)", "at (−3.0, 0.0)"),
        ("GROOVE-2.LS of 26-01-01", "GROOVE-2.LS of 26-01-01"),
    ],
)
def test_numbers_that_are_read_have_a_true_minus(said, shown):
    assert typeset(said) == shown


@pytest.mark.parametrize(
    ("name", "shown"),
    [
        ("flange_top", "upper flange"),
        ("flange_bottom (flange_bottom_1)", "lower flange 1"),
        ("forearm (forearm_hub)", "forearm hub"),
    ],
)
def test_flanges_are_called_as_the_trade_calls_them(name, shown):
    assert body_words(name, str) == shown


def test_details_of_the_checks_call_bodies_as_the_inspector_does():
    said = sentence(
        "nose against flange_top at waypoint 48 (GROOVE.LS:91)",
        lambda text, **values: text.format(**values) if values else text,
    )
    assert said == "nose against upper flange at waypoint 48 (GROOVE.LS:91)"


def test_lengths_of_the_checks_have_a_decimal():
    assert check_figure("50", "mm", str) == "50.0 mm"
    assert check_figure("0.0199", "mm", str) == "0.0199 mm"
    assert check_figure("36", "positions", str) == "36 positions"


def test_a_placement_of_three_points_says_no_negative_zero():
    # What the dialog makes of an angle that is a rounding below zero.
    assert ", ".join(decimal(one, 3) for one in np.array([89.981, -1e-9, 0.0])) == (
        "89.981, 0.000, 0.000"
    )


def test_a_degree_sign_follows_without_a_blank():
    assert with_unit("7", "deg") == "7°"
    assert with_unit("7", "mm") == "7 mm"
    assert with_unit("7", "") == "7"
