"""The map's colours, scales and labels against their meaning."""

import json
import math
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import posopt_gui
from posopt_gui.theme import THEMES
from posopt_gui.viewmodels.map_colours import (
    CLASS_LABELS,
    CLASS_LETTERS,
    FIRST_INDEX,
    LAYER_LABELS,
    NO_VALUE_INDEX,
    REJECTED_INDEX,
    VIRIDIS,
    CellClass,
    Layer,
    Scale,
    class_table,
    colour_of,
    gradient,
    scale_table,
)
from posopt_gui.viewmodels.map_lines import (
    LINE_NAMES,
)
from posopt_gui.viewmodels.map_model import (
    extra_cost_scale,
)
from posopt_gui.viewmodels.map_readings import price_words
from posopt_gui.views.map_palette import palette
from solver.model.settings import Scheme

SCHEMES = (Scheme.EXACT, Scheme.F, Scheme.F1, Scheme.F2)
VALUED = (Layer.CLEARANCE, Layer.MANIPULABILITY, Layer.LIMIT_MARGIN, Layer.EXTRA_COST)


@settings(max_examples=60, deadline=None)
@given(
    low=st.floats(-1e3, 1e3), span=st.floats(1e-6, 1e4), knee=st.sampled_from([0.0, 0.01, 1.0]),
    reverse=st.booleans(), values=st.lists(st.floats(-2e4, 2e4), min_size=2, max_size=20),
)  # fmt: skip
def test_a_scale_keeps_the_order_of_values(low, span, knee, reverse, values):
    scale = Scale(low, low + span, "mm", reverse=reverse, knee=knee)
    ordered = np.sort(np.array(values))
    indices = scale.indices(ordered).astype(int)
    steps = np.diff(indices)
    assert (steps <= 0).all() if reverse else (steps >= 0).all()
    assert indices.min() >= FIRST_INDEX
    ends = scale.indices(np.array([low, low + span])).tolist()
    assert sorted(ends) == [FIRST_INDEX, 255]
    assert (scale.indices(np.array([np.nan, np.inf])) == NO_VALUE_INDEX).all()


@pytest.mark.parametrize("high", [1e-3, 0.7, 5.8, 27.0, 485.0, 1e5])
def test_ticks_of_the_extra_cost_stand_where_their_numbers_are_and_apart(high):
    scale = extra_cost_scale(high)
    ticks = scale.ticks()
    assert len(ticks) >= 3
    assert ticks[0].text.strip("0.") == ""
    for tick in ticks:
        value = float(tick.text.replace(",", ""))
        assert tick.share == pytest.approx(float(scale.place(np.array([value]))[0]))
    shares = [tick.share for tick in ticks]
    assert min(np.diff(shares)) >= 0.1


@pytest.mark.parametrize(("low", "high"), [(0.0, 95.3), (10.65, 88.0), (0.01, 0.41), (3.0, 3.0)])
def test_ticks_of_a_linear_scale_are_round_and_inside(low, high):
    scale = Scale(low, high, "mm", 3)
    for tick in scale.ticks():
        assert low - 1e-9 <= float(tick.text) <= high + 1e-9
        assert 0.0 <= tick.share <= 1.0
    assert 1 <= len(scale.ticks()) <= 8


def test_every_outcome_has_a_colour_of_its_own_in_both_themes_and_a_letter():
    letters = [letter for letter in CLASS_LETTERS.values() if letter]
    assert len(letters) == len(set(letters)) == len(CellClass) - 1
    for theme in THEMES.values():
        table = palette(theme).table(Layer.OUTCOME).astype(int)
        for one in CellClass:
            for other in CellClass:
                if one < other:
                    assert np.abs(table[one] - table[other]).sum() > 60, (theme.name, one, other)


def test_colour_tables_hold_what_they_were_made_of():
    assert colour_of("#0A10FF") == (10, 16, 255, 255)
    table = class_table({CellClass.COLLISION: (1, 2, 3, 255)})
    assert table[CellClass.COLLISION].tolist() == [1, 2, 3, 255]
    scale = scale_table(VIRIDIS, (9, 9, 9, 255), (8, 8, 8, 255))
    assert scale[REJECTED_INDEX].tolist() == [9, 9, 9, 255]
    assert scale[NO_VALUE_INDEX].tolist() == [8, 8, 8, 255]
    assert scale[FIRST_INDEX].tolist() == list(colour_of(VIRIDIS[0]))
    assert scale[255].tolist() == list(colour_of(VIRIDIS[-1]))
    bright = gradient(VIRIDIS, 64) @ np.array([0.299, 0.587, 0.114, 0.0])
    assert (np.diff(bright) > 0.0).all()


def plain(text, **values):
    return text.format(**values)


def test_prices_are_told_absolutely_and_as_a_share():
    assert price_words(0.0366, 0.3318, plain) == "+0.0366 (+11.0 %)"
    assert price_words(math.inf, 0.3, plain) == "no sequence"


def test_every_text_of_the_map_is_translated():
    folder = Path(posopt_gui.__file__).parent
    known = {}
    for file in (folder.parent / "resources/translations/zh_CN").glob("*.json"):
        known |= json.loads(file.read_text(encoding="utf-8"))
    wanted = {*CLASS_LABELS.values(), *LAYER_LABELS.values(), *LINE_NAMES.values()}
    for file in [*folder.glob("views/map_*.py"), *folder.glob("viewmodels/map_*.py")]:
        source = file.read_text(encoding="utf-8")
        wanted |= {m[1] for m in re.finditer(r"\btr\(\s*\"([^\"]+)\"", source)}
        wanted |= {m[1] for m in re.finditer(r"_tr\(\s*\"([^\"]+)\"", source)}
    missing = sorted(text for text in wanted if text not in known)
    assert missing == []
    for text in wanted:
        names = set(re.findall(r"{(\w+)}", text))
        assert names == set(re.findall(r"{(\w+)}", known[text])), text
