import dataclasses
import tomllib
from enum import Enum

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from posopt_gui.viewmodels.cell_edits import (
    with_face,
    with_frame,
    with_measure,
    with_path_kind,
    with_rule,
    with_section,
    with_spacing,
    with_standard,
)
from posopt_gui.viewmodels.cell_facts import FREE, Catalogue, facts_of
from posopt_gui.viewmodels.cell_form import cell_form, put
from posopt_gui.viewmodels.fixture_edits import with_new_fixture, without_fixture
from posopt_gui.viewmodels.form_types import Kind, at
from solver.catalog.cells import load_cell, read_cell
from solver.catalog.names import resource_folder
from solver.catalog.toml_reader import Table
from solver.errors import InputError
from solver.model.settings import Sweep

CELLS = resource_folder() / "cells"


@pytest.fixture(scope="module")
def catalogue():
    return Catalogue()


def shipped(name):
    return tomllib.loads((CELLS / f"{name}.toml").read_text(encoding="utf-8"))


def problem_of(cell):
    return read_cell(Table(cell, str(CELLS / "cell.toml")))


def plain(value):
    """Nested tuples of a model, so that two of them can be compared."""
    if isinstance(value, Sweep):
        value = value.angles()
    if isinstance(value, np.ndarray):
        return tuple(value.ravel().round(12).tolist())
    if isinstance(value, float):
        return round(value, 12)
    if dataclasses.is_dataclass(value):
        return tuple(plain(getattr(value, one.name)) for one in dataclasses.fields(value))
    if isinstance(value, tuple | list):
        return tuple(plain(one) for one in value)
    return value.value if isinstance(value, Enum) else value


def stated_keys(cell, prefix=""):
    for key, value in cell.items():
        if isinstance(value, dict):
            yield from stated_keys(value, f"{prefix}{key}.")
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            for number, one in enumerate(value):
                yield from stated_keys(one, f"{prefix}{key}.{number}.")
        else:
            yield f"{prefix}{key}"


@pytest.mark.parametrize("name", ["groove_hw300", "groove_paper", "zigzag_hw250"])
def test_every_value_of_a_shipped_cell_has_a_field(catalogue, name):
    cell = shipped(name)
    fixtures = range(max(1, len(at(cell, "fixtures", []))))
    keys = {
        field.key
        for number in fixtures
        for one in cell_form(cell, catalogue, fixture=number).sections
        for field in one.fields
    }
    # What the path file's box and the switches of the form write is no field of its own.
    written_otherwise = {"path.file", "settings.self_margin_mm"}
    missing = {
        key
        for key in stated_keys(cell)
        if key not in keys | written_otherwise and not key.startswith(("assumptions", "sources."))
    }
    assert missing == set()


def test_stated_defaults_are_those_of_the_solver(catalogue):
    cell = with_path_kind(shipped("groove_hw300"), "line")
    cell["settings"] = {}
    cell["program"] = {"links": {}}
    del cell["path"]["feed_mm_s"]
    del cell["beam"]["fillets"], cell["cell"]["floor"]
    form = cell_form(cell, catalogue)
    stated = cell
    names = []
    for section in form.sections:
        for field in section.fields:
            if field.apply is None and field.read is None and field.default not in (None, []):
                names.append(field.key)
                value = field.default
                if field.kind is Kind.FLAG:
                    value = field.on if value != field.off else field.off
                stated = put(stated, field.key, value)
    assert {"settings.safety_distance_mm", "program.links.lead_in_mm", "beam.root_mm"} <= {*names}
    left_out, with_all = problem_of(cell), problem_of(stated)
    assert len(names) > 55
    for part in ("settings", "program", "accuracy", "joint_limits", "fixtures"):
        assert plain(getattr(with_all, part)) == plain(getattr(left_out, part)), part
    assert with_all.toolpath.passes[0].feed == left_out.toolpath.passes[0].feed
    for name in ("height", "width", "web", "flange", "root"):
        assert getattr(with_all.workpiece.section, name) == getattr(
            left_out.workpiece.section, name
        )


def ranged_fields(catalogue):
    cells = [shipped("groove_hw300"), shipped("groove_paper"), shipped("zigzag_hw250")]
    facts = facts_of(cells[2], catalogue)
    cells[2] = with_path_kind(cells[2], "parametric")
    cells[0] = with_standard(cells[0], FREE, catalogue, facts)
    for cell in cells:
        for section in cell_form(cell, catalogue).sections:
            for field in section.fields:
                if field.kind in (Kind.NUMBER, Kind.INTEGER):
                    yield cell, field


def test_values_out_of_the_stated_range_are_refused_at_their_field(catalogue):
    tried = set()
    for cell, field in ranged_fields(catalogue):
        wrong = []
        if field.low is not None:
            wrong.append(field.low if field.above else field.low - max(field.step, 1.0))
        if field.high is not None:
            wrong.append(field.high + max(field.step, 1.0))
        for value in wrong:
            if (field.key, value) in tried:
                continue
            tried.add((field.key, value))
            number = int(value) if field.kind is Kind.INTEGER else value
            broken = put(cell, field.key, number)
            with pytest.raises(InputError) as caught:
                problem_of(broken)
            key = caught.value.place.key.replace("[", ".").replace("]", "")
            form = cell_form(broken, catalogue)
            section = next(one for one in form.sections if field in one.fields)
            found, found_field = form.place_of(key)
            assert found == section.name, (field.key, number, str(caught.value))
            assert found_field in ("", field.key), (field.key, number, str(caught.value))
    assert len(tried) > 60


def test_an_error_inside_a_list_belongs_to_the_field_of_the_list(catalogue):
    form = cell_form(shipped("groove_hw300"), catalogue, fixture=1)
    assert form.place_of("settings.lean_deg.2") == ("lean", "settings.lean_deg")
    assert form.place_of("fixtures.1.max_mm.2") == ("fixtures", "fixtures.1.max_mm")
    assert form.place_of("fixtures.0.max_mm.2") == ("fixtures", "")
    assert form.place_of("program.links.before.0") == ("links", "program.links.before")
    assert form.place_of("beam") == ("beam", "")
    assert form.place_of("path") == ("path", "")
    assert form.place_of(None) == ("", "")


@pytest.mark.parametrize("name", ["HW250", "HEB300", "HEA120"])
def test_another_section_lies_where_the_solver_lays_it(catalogue, name):
    cell = with_path_kind(shipped("groove_hw300"), "line")
    ours = problem_of(with_section(cell, name)).workpiece
    theirs = read_cell(Table(cell, str(CELLS / "cell.toml")), beam=name).workpiece
    assert ours.name == theirs.name
    np.testing.assert_allclose(ours.placement, theirs.placement, atol=1e-12)


def test_another_standard_takes_its_nearest_section(catalogue):
    cell = shipped("groove_hw300")
    facts = facts_of(cell, catalogue)
    heb = next(one for one in catalogue.series if one.startswith("HEB"))
    assert at(with_standard(cell, heb, catalogue, facts), "beam.section") == "HEB300"


def test_free_dimensions_begin_with_those_of_the_section(catalogue):
    cell = with_path_kind(shipped("groove_hw300"), "line")
    free = with_standard(cell, FREE, catalogue, facts_of(cell, catalogue))
    before, after = problem_of(cell).workpiece.section, problem_of(free).workpiece.section
    assert plain(after)[1:6] == pytest.approx(plain(before)[1:6])
    named = with_section(free, "HW250")
    assert not {"height_mm", "width_mm", "web_mm", "flange_mm", "root_mm"} & set(named["beam"])


@pytest.mark.parametrize("rule", ["centre", "lower_edge"])
@pytest.mark.parametrize("frame", ["floor", "fanuc_world"])
def test_a_placement_stated_otherwise_is_the_same_placement(catalogue, rule, frame):
    cell = with_path_kind(shipped("groove_hw300"), "line")
    cell = put(cell, "beam.wpr_deg", [85.0, 3.0, 80.0])
    before = problem_of(cell).workpiece.placement
    changed = with_frame(cell, frame, facts_of(cell, catalogue))
    changed = with_rule(changed, rule, facts_of(changed, catalogue))
    assert ("lower_edge_mm" in changed["beam"]) == (rule == "lower_edge")
    after = problem_of(changed).workpiece.placement
    np.testing.assert_allclose(after, before, atol=1e-9)


def test_a_line_measured_otherwise_is_the_same_line(catalogue):
    cell = shipped("groove_paper")
    facts = facts_of(cell, catalogue)
    before = problem_of(cell).toolpath.poses
    offsets = with_measure(cell, "offsets", facts)
    assert "from_offset_mm" in offsets["path"]["line"]
    np.testing.assert_allclose(problem_of(offsets).toolpath.poses, before, atol=1e-9)
    shares = with_measure(offsets, "shares", facts)
    np.testing.assert_allclose(problem_of(shares).toolpath.poses, before, atol=1e-9)


def test_passes_spaced_otherwise_keep_their_number_of_waypoints(catalogue):
    cell = with_path_kind(shipped("groove_hw300"), "parametric")
    before = problem_of(cell).toolpath
    counted = with_spacing(cell, "points")
    assert len(problem_of(counted).toolpath) == len(before)
    assert len(problem_of(with_spacing(counted, "step")).toolpath) == len(before)


@pytest.mark.parametrize("kind", ["line", "parametric"])
def test_a_new_path_on_a_face_can_be_planned_on_any_cell(kind):
    for name in ("groove_hw300", "groove_paper", "zigzag_hw250"):
        assert len(problem_of(with_path_kind(shipped(name), kind)).toolpath) >= 50


def test_a_face_without_the_stated_edge_drops_it(catalogue):
    cell = with_path_kind(shipped("groove_hw300"), "parametric")
    moved = with_face(cell, "parametric", "flange_top_inner_left", facts_of(cell, catalogue))
    assert "edge" not in moved["path"]["parametric"]
    assert (
        with_face(cell, "parametric", "web_right", facts_of(cell, catalogue))["path"]["parametric"][
            "edge"
        ]
        == "bottom"
    )


def test_a_new_fixture_is_a_sound_box_with_a_name_of_its_own():
    cell = with_path_kind(shipped("groove_hw300"), "line")
    once, first = with_new_fixture(cell)
    twice, second = with_new_fixture(once)
    assert (first, second) == (2, 3)
    names = [one.name for one in problem_of(twice).fixtures]
    assert names == ["trestle_near", "trestle_far", "box_1", "box_2", "floor"]
    assert without_fixture(without_fixture(twice, 3), 2) == cell


def test_a_form_of_a_mesh_workpiece_has_no_section(catalogue):
    cell = shipped("groove_hw300")
    del cell["beam"]
    cell["workpiece"] = {"name": "plate", "mesh": "plate.stl", "position_mm": [1.0, 2.0, 3.0]}
    form = cell_form(cell, catalogue)
    assert form.field("beam.section") is None
    assert form.field("workpiece.position_mm").value(cell) == [1.0, 2.0, 3.0]
    kinds = [one.value for one in form.field("path.kind").choices]
    assert kinds == ["file"]


def test_a_window_as_wide_as_the_limits_is_not_stated(catalogue):
    cell = shipped("groove_hw300")
    form = cell_form(cell, catalogue)
    field = form.field("robot.windows_deg.J1")
    limits = load_cell("groove_paper").robot.limits[0] * 180.0 / np.pi
    assert field.default == pytest.approx(list(limits))
    narrow = form.edited(field, [-90.0, 90.0])
    assert narrow["robot"]["windows_deg"] == {"J1": [-90.0, 90.0]}
    assert cell_form(narrow, catalogue).edited(field, field.default)["robot"]["windows_deg"] == {}


def test_self_margin_is_left_out_by_its_flag(catalogue):
    cell = shipped("groove_hw300")
    form = cell_form(cell, catalogue)
    without = form.edited(form.field("settings.self_check"), False)
    assert without["settings"]["self_margin_mm"] is False
    assert cell_form(without, catalogue).field("settings.self_margin_mm") is None


junk = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-5, 5),
    st.floats(),
    st.text(max_size=5),
    st.lists(st.one_of(st.integers(-3, 3), st.text(max_size=3), st.none()), max_size=4),
    st.dictionaries(st.sampled_from(["line", "file", "name", "links"]), st.integers(), max_size=2),
)


@settings(max_examples=60)
@given(data=st.data())
def test_a_form_of_any_damaged_cell_can_be_made(catalogue, data):
    cell = shipped(data.draw(st.sampled_from(["groove_hw300", "groove_paper"])))
    tables = ["robot", "tool", "beam", "fixtures", "path", "settings", "program", "accuracy"]
    keys = [*tables, *stated_keys(cell)]
    for key in data.draw(st.lists(st.sampled_from(keys), min_size=1, max_size=3)):
        parent = key.rpartition(".")[0]
        if not parent or isinstance(at(cell, parent), dict):
            cell = put(cell, key, data.draw(junk))
    form = cell_form(cell, catalogue)
    for section in form.sections:
        for field in section.fields:
            field.value(cell)
