"""Names of lines stand on no line and on no other name, against every pixel of their boxes."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from posopt_gui.viewmodels.label_places import label_places

HEIGHT = 16.0
ROOM = (0.0, 0.0, 700.0, 135.0)
X = np.linspace(0.0, 700.0, 50)


def touched(curve, box):
    """Whether a line passes a box, asked at every half pixel."""
    x = np.arange(box[0], box[0] + box[2], 0.5)
    y = np.interp(x, *curve)
    return bool(((y >= box[1]) & (y <= box[1] + HEIGHT)).any())


def test_four_lines_that_end_together_are_covered_by_no_name():
    curves = [
        (X, np.linspace(start, 30.0 + 3.0 * k, 50)) for k, start in enumerate((20, 40, 60, 80))
    ]
    widths = [70.0, 60.0, 95.0, 60.0]
    found = label_places(curves, widths, HEIGHT, ROOM)
    boxes = [(left, top, width) for (left, top), width in zip(found, widths, strict=True)]
    assert not any(touched(curve, box) for curve in curves for box in boxes)
    for number, one in enumerate(boxes):
        for other in boxes[number + 1 :]:
            apart = one[0] + one[2] <= other[0] or other[0] + other[2] <= one[0]
            assert apart or abs(one[1] - other[1]) >= HEIGHT


@settings(max_examples=60, deadline=None)
@given(
    ends=st.lists(st.floats(0.0, 135.0), min_size=1, max_size=4),
    widths=st.lists(st.floats(40.0, 180.0), min_size=4, max_size=4),
)
def test_names_stay_in_the_frame(ends, widths):
    curves = [(X, np.linspace(70.0, end, 50)) for end in ends]
    for (left, top), width in zip(
        label_places(curves, widths[: len(ends)], HEIGHT, ROOM), widths, strict=False
    ):
        assert left >= 0.0
        assert left + width <= 700.0
        assert top >= 0.0
        assert top + HEIGHT <= 135.0


@pytest.mark.parametrize("level", [1.0, 67.0, 134.0])
def test_a_single_name_stands_at_the_end_of_its_line(level):
    ((left, top),) = label_places([(X, np.full(50, level))], [80.0], HEIGHT, ROOM)
    assert left + 80.0 > 690.0
    assert min(abs(top - level), abs(top + HEIGHT - level)) < 10.0
