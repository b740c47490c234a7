import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from posopt_gui.viewmodels.beam_drawing import ARC_POINTS, beam_drawing, section_outline
from posopt_gui.viewmodels.touched_points import (
    ENDS,
    FLANGES,
    SIDES,
    TouchedCorner,
    placement_from_points,
    points_on_beam,
)
from solver.catalog import beam_entries
from solver.errors import InputError
from solver.model.workpiece import BeamSection
from solver.transforms import rigid, rotation_from_wpr

SECTIONS = [entry.section for entry in beam_entries()]
SHEET = (290.0, 190.0)


def area(points):
    x, y = points[:, 0], points[:, 1]
    return abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2.0


@pytest.mark.parametrize("section", SECTIONS, ids=lambda one: one.name)
def test_the_outline_encloses_the_area_of_the_section(section):
    h, b, tw, tf, r = (
        1e3 * one
        for one in (section.height, section.width, section.web, section.flange, section.root)
    )
    exact = 2.0 * b * tf + (h - 2.0 * tf) * tw + (4.0 - math.pi) * r * r
    # Chords inside the air side of four quarter arcs: circular segments are added.
    angle = math.pi / 2.0 / (ARC_POINTS - 1)
    segments = 4 * (ARC_POINTS - 1) * r * r / 2.0 * (angle - math.sin(angle))
    assert area(section_outline(section)) == pytest.approx(exact + segments, rel=1e-9)


def test_a_section_without_root_has_sharp_corners():
    section = BeamSection("sharp", 0.3, 0.2, 0.008, 0.012)
    assert area(section_outline(section)) == pytest.approx(2 * 200 * 12 + 276 * 8)


@pytest.mark.parametrize("section", SECTIONS, ids=lambda one: one.name)
def test_drawing_is_to_scale_and_on_its_sheet(section):
    drawing = beam_drawing(section, *SHEET)
    low, high = drawing.outline.min(axis=0), drawing.outline.max(axis=0)
    size = high - low
    assert size[0] / size[1] == pytest.approx(section.width / section.height)
    points = [low, high]
    for one in drawing.dimensions:
        points += [one.start, one.end, one.anchor, *np.reshape(one.extensions, (-1, 2))]
    points = np.array(points)
    assert (points >= 0.0).all()
    assert (points <= SHEET).all()


def test_each_dimension_spans_what_it_says():
    section = SECTIONS[0]
    drawing = beam_drawing(section, *SHEET)
    for one in drawing.dimensions:
        if one.arrows == 2:
            length = math.dist(one.start, one.end)
            assert length / drawing.scale == pytest.approx(float(one.value))
    assert [one.text for one in drawing.dimensions] == ["H", "B", "tw", "tf", "r"]


angles = st.floats(-math.pi, math.pi)
lengths = st.floats(-3.0, 3.0)


@given(
    st.tuples(angles, angles, angles),
    st.tuples(lengths, lengths, lengths),
    st.sampled_from(ENDS),
    st.sampled_from(FLANGES),
    st.sampled_from(SIDES),
    st.sampled_from(SECTIONS),
)
def test_points_of_a_placed_beam_give_its_placement_back(wpr, position, end, flange, side, section):
    corner = TouchedCorner(end, flange, side)
    placement = rigid(rotation_from_wpr(*wpr), position)
    points = points_on_beam(corner, section, 1.0) @ placement[:3, :3].T + placement[:3, 3]
    found = placement_from_points(points, corner, section, 1.0)
    np.testing.assert_allclose(found, placement, atol=1e-9)


def test_points_of_the_sketch_lie_on_the_edge_and_the_face():
    section = SECTIONS[0]
    points = points_on_beam(TouchedCorner("+x", "bottom", "right"), section, 2.0)
    np.testing.assert_allclose(points[:, 2], -section.height / 2.0)
    np.testing.assert_allclose(points[:2, 1], -section.width / 2.0)
    assert points[0, 0] == 1.0
    assert abs(points[1, 0]) < 1.0


@pytest.mark.parametrize(
    ("second", "third", "words"),
    [
        ((0.005, 0.0, 0.0), (0.0, 0.1, 0.0), "second point lies 5.0 mm"),
        ((0.8, 0.0, 0.0), (0.5, 0.002, 0.0), "third point lies 2.0 mm"),
        ((1.2, 0.0, 0.0), (0.0, 0.1, 0.0), "only 1000 mm long"),
        ((0.8, 0.0, 0.0), (0.0, 0.9, 0.0), "mm wide"),
        ((math.nan, 0.0, 0.0), (0.0, 0.1, 0.0), "not finite"),
    ],
)
def test_points_that_cannot_be_are_refused_in_a_sentence(second, third, words):
    with pytest.raises(InputError, match=words):
        placement_from_points([(0, 0, 0), second, third], TouchedCorner(), SECTIONS[0], 1.0)
