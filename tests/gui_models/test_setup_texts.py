"""Every text of the setup panel has its Chinese one."""

import ast
import json
import string
from pathlib import Path

import pytest

from posopt_gui.dialogs import __file__ as dialogs_file
from posopt_gui.viewmodels.cell_edits import (
    with_face,
    with_measure,
    with_path_kind,
    with_rule,
    with_spacing,
    with_standard,
)
from posopt_gui.viewmodels.cell_facts import FREE, Catalogue, facts_of
from posopt_gui.viewmodels.cell_form import cell_form, put
from posopt_gui.viewmodels.fixture_edits import with_shape
from posopt_gui.viewmodels.form_types import range_of
from posopt_gui.viewmodels.touched_points import FLANGES, SIDES
from solver.catalog.names import resource_folder

ROOT = Path(dialogs_file).parents[1]
SOURCES = (
    "views/setup_view.py",
    "views/setup_extras.py",
    "views/setup_path.py",
    "views/setup_sections.py",
    "views/field_widgets.py",
    "dialogs/path_dialog.py",
    "dialogs/placement_dialog.py",
)
FACES = ("flange_top_inner_left", "flange_top_outer", "flange_top_edge_left", "fillet_top_left")
CHINESE = json.loads(
    (resource_folder() / "translations" / "zh_CN" / "setup.json").read_text(encoding="utf-8")
)


def variants():
    import tomllib

    catalogue = Catalogue()
    path = resource_folder() / "cells" / "groove_hw300.toml"
    cell = tomllib.loads(path.read_text(encoding="utf-8"))
    facts = facts_of(cell, catalogue)
    line, passes = with_path_kind(cell, "line"), with_path_kind(cell, "parametric")
    mesh = {key: value for key, value in cell.items() if key != "beam"}
    mesh["workpiece"] = {"name": "plate", "mesh": "plate.stl", "position_mm": [0.0, 0.0, 0.0]}
    six = [1.0] * 6
    sized = {"name": "a", "shape": "box", "centre_mm": [0.0] * 3, "size_mm": [1.0] * 3}
    cells = [
        cell, line, passes, mesh,
        with_standard(cell, FREE, catalogue, facts),
        with_rule(cell, "centre", facts),
        with_measure(line, "offsets", facts),
        with_spacing(passes, "points"),
        put(cell, "path.orientation_wpr_deg", [0.0, 0.0, 0.0]),
        put(put(cell, "settings.steps.joints_deg", six), "settings.steps.link_joints_deg", six),
        put(cell, "beam.section", "own.toml"),
        put(cell, "fixtures.0", {"name": "a", "mesh": "b.stl"}),
        put(cell, "fixtures.0", sized),
        *(with_face(passes, "parametric", one, facts) for one in FACES),
        *(with_shape(cell, "fixtures.0", one) for one in ("sphere", "cylinder", "capsule")),
    ]  # fmt: skip
    return [cell_form(one, catalogue) for one in cells]


def texts_of_forms():
    for form in variants():
        for section in form.sections:
            yield section.title
            yield from (note.text for note in section.notes)
            for field in section.fields:
                yield from (field.label, field.tip, field.unset, *field.parts)
                for choice in field.choices:
                    yield from () if choice.plain else (choice.label, choice.detail)
                note = range_of(field)
                yield note.text if note is not None else ""


def texts_of_sources():
    for name in SOURCES:
        for node in ast.walk(ast.parse((ROOT / name).read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call):
                called = getattr(node.func, "attr", getattr(node.func, "id", ""))
                first = node.args[0] if node.args else None
                if called in {"_tr", "tr"} and isinstance(first, ast.Constant):
                    yield first.value


def test_every_text_has_its_chinese_one():
    texts = {*texts_of_forms(), *texts_of_sources(), *FLANGES, *SIDES} - {""}
    assert len(texts) > 330
    assert {text for text in texts if text not in CHINESE} == set()


@pytest.mark.parametrize("text", CHINESE)
def test_a_translation_names_the_same_values(text):
    def names(template):
        return sorted(name for _, name, _, _ in string.Formatter().parse(template) if name)

    assert names(CHINESE[text]) == names(text)
