"""Every key that a cell may state has a field in the form, so that nothing is out of reach."""

import ast
import re
import tomllib
from contextlib import suppress
from pathlib import Path

import pytest
import trimesh

from posopt_gui.viewmodels.cell_edits import (
    with_measure,
    with_path_kind,
    with_rule,
    with_spacing,
    with_standard,
)
from posopt_gui.viewmodels.cell_facts import FREE, Catalogue, facts_of
from posopt_gui.viewmodels.cell_form import cell_form, put
from posopt_gui.viewmodels.fixture_edits import with_box_rule, with_new_fixture
from posopt_gui.viewmodels.form_types import Kind, rows_of
from solver.catalog import cells
from solver.catalog.names import resource_folder
from solver.catalog.toml_reader import Table
from solver.errors import InputError

CATALOG = Path(cells.__file__).parent
READERS = (
    "cells.py", "cell_path.py", "cell_program.py", "cell_settings.py", "cell_workpiece.py",
    "bodies.py",
)  # fmt: skip
READING = {
    "boolean", "choice", "get", "has", "integer", "integers", "name", "number", "numbers",
    "optional_table", "table", "tables", "text", "texts", "_choice", "_feed", "_frame", "_joints",
    "_optional_integer", "_pattern", "_called", "_positive", "_sweep", "_events", "_window",
    "read_rotation",
}  # fmt: skip

WITHOUT_FIELD = {
    "path.file": "the path's own box chooses it",
    "settings.self_margin_mm": "a switch writes false, else it has a field",
    "assumptions": "what the numbers rest on: words of the cell's author, in no computation",
    "sources": "where the numbers come from: as the assumptions",
}

TABLES = {
    "cell", "robot", "robot.windows_deg", "tool", "beam", "workpiece", "fixtures", "path",
    "path.line", "path.parametric", "settings", "settings.weights", "settings.steps", "program",
    "program.links", "accuracy",
}  # fmt: skip


@pytest.fixture(scope="module")
def catalogue():
    return Catalogue()


def shipped():
    path = resource_folder() / "cells" / "groove_hw300.toml"
    cell = tomllib.loads(path.read_text(encoding="utf-8"))
    cell["path"] = {**cell["path"], "file": "path.csv"}
    return cell


def files():
    folder = resource_folder() / "examples"
    plate = trimesh.creation.box((400.0, 120.0, 20.0)).export(file_type="stl")
    return {"path.csv": (folder / "groove_hw300.csv").read_bytes(), "plate.stl": plate}


def variants(catalogue):
    """Cells that take every branch of the readers."""
    cell = shipped()
    facts = facts_of(cell, catalogue)
    line, passes = with_path_kind(cell, "line"), with_path_kind(cell, "parametric")
    mesh = {key: value for key, value in cell.items() if key != "beam"}
    mesh["workpiece"] = {"name": "plate", "mesh": "plate.stl", "position_mm": [900.0, 0.0, 600.0]}
    mesh["path"] = {**mesh["path"], "touches": "plate"}
    full = put(cell, "fixtures", [])
    for shape in ("box", "box", "sphere", "cylinder", "capsule"):
        full, _ = with_new_fixture(full, shape)
    full = with_box_rule(full, "fixtures.1", "centre")
    full = {**full, "fixtures": [*rows_of(full, "fixtures"), {"name": "m", "mesh": "plate.stl"}]}
    full = put(full, "program.links", {"home_deg": [0.0, -20.0, 0.0, 0.0, -90.0, 0.0]})
    full = put(full, "settings.weights", {"clearance": 0.1})
    full = put(full, "settings.steps", {"joints_deg": [9.0] * 6, "link_joints_deg": [99.0] * 6})
    return [
        cell, full, line, passes, mesh,
        with_standard(cell, FREE, catalogue, facts),
        with_rule(cell, "centre", facts),
        with_measure(line, "offsets", facts),
        with_spacing(passes, "points"),
        put(cell, "path.orientation_wpr_deg", [0.0, 150.0, 0.0]),
        put(cell, "robot.windows_deg", {"J1": [-90.0, 90.0]}),
    ]  # fmt: skip


@pytest.fixture(scope="module")
def asked(catalogue):
    """Every key that the readers ask the variants for, with numbers of lists as 'N'."""
    found = set()
    ask = Table.has

    def recorded(table, key):
        if table.file == "cell.toml":
            found.add(re.sub(r"\[\d+\]", ".N", table._path(key)))
        return ask(table, key)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Table, "has", recorded)
        for cell in variants(catalogue):
            # A path may not fit the part; what was read before is told by the first test.
            with suppress(InputError):
                cells.read_cell(Table(cell, "cell.toml"), files=files())
    # The unit of a window stands in the name of its table.
    return {key for key in found if not re.search(r"windows_deg\.J\d_deg$", key)}


@pytest.fixture(scope="module")
def fields(catalogue):
    found = {}
    for cell in variants(catalogue):
        for fixture in range(max(1, len(rows_of(cell, "fixtures")))):
            for section in cell_form(cell, catalogue, files=files(), fixture=fixture).sections:
                found |= {re.sub(r"\.\d+\.", ".N.", one.key): one for one in section.fields}
    return found


def literals():
    """Names of keys that stand in the readers."""
    for name in READERS:
        for node in ast.walk(ast.parse((CATALOG / name).read_text(encoding="utf-8"))):
            if not isinstance(node, ast.Call):
                continue
            method = isinstance(node.func, ast.Attribute)
            called = node.func.attr if method else getattr(node.func, "id", "")
            # A function of the readers takes its table before the key.
            place = 0 if method else 1
            if called in READING and len(node.args) > place:
                one = node.args[place]
                if isinstance(one, ast.Constant) and isinstance(one.value, str):
                    yield one.value


def test_every_key_of_the_readers_was_asked_for(asked):
    last = {key.rpartition(".")[2] for key in asked} | {key.split(".")[0] for key in asked}
    missing = {name for name in literals() if name not in last}
    assert missing == set()
    assert len(asked) > 130


def test_every_key_of_the_readers_has_a_field(asked, fields):
    missing = {
        key
        for key in asked
        if key not in fields
        and key not in TABLES
        and key not in WITHOUT_FIELD
        and not key.startswith("sources")
    }
    assert missing == set()


def test_every_field_writes_a_key_that_the_readers_know(asked, fields):
    unknown = {key for key, field in fields.items() if key not in asked and field.apply is None}
    assert unknown == set()


def test_every_number_of_the_form_has_its_unit_and_every_field_a_tip(fields):
    units = {"_mm_s": "mm/s", "_mm": "mm", "_deg": "deg", "_m3": "m³"}
    for key, field in fields.items():
        assert field.tip, key
        if field.kind in (Kind.NUMBER, Kind.NUMBERS) and field.apply is None:
            stem = key.replace("windows_deg.", "windows_deg_")
            wanted = next((unit for end, unit in units.items() if end in stem[-8:]), "")
            if "windows_deg" in key:
                wanted = "deg"
            assert field.unit == wanted, key
