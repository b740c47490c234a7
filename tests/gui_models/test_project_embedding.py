"""A project carries every file that its cell names, and needs nothing besides itself."""

import json
import shutil
import struct
import tomllib
from dataclasses import replace

import numpy as np
import pytest
import trimesh

from posopt_gui.document.project import ProjectState, state_of_cell
from posopt_gui.document.project_file import load_project, project_bytes, read_project, save_project
from posopt_gui.viewmodels.project_files import PROJECT
from solver.catalog.cells import load_cell
from solver.catalog.names import resource_folder
from solver.errors import InputError
from solver.model.shapes import Mesh


@pytest.fixture
def shop(tmp_path):
    """A folder with a cell whose robot, tool, section, path and meshes are files of its own."""
    folder = tmp_path / "shop"
    for name in ("robots", "tools", "beams", "meshes/a", "meshes/b"):
        (folder / name).mkdir(parents=True)
    shipped = resource_folder()
    robot = (shipped / "robots" / "fanuc_m20ia.toml").read_text("utf-8")
    robot = robot.replace('name = "fanuc_m20ia"', 'name = "own_robot"')
    (folder / "robots" / "own.toml").write_text(robot, encoding="utf-8")
    tool = (shipped / "tools" / "paper_tool.toml").read_text("utf-8")
    tool = tool.replace('name = "paper_tool"', 'name = "own_tool"')
    # The same file name as the robot's, in another folder.
    (folder / "tools" / "own.toml").write_text(tool, encoding="utf-8")
    (folder / "beams" / "mill.toml").write_text(
        '[series]\ntitle = "Mill"\nstandard = "own"\n[[sections]]\nname = "OWN300"\n'
        "height_mm = 300\nwidth_mm = 300\nweb_mm = 10\nflange_mm = 15\nroot_mm = 13\n",
        encoding="utf-8",
    )
    trimesh.creation.box((0.1, 0.1, 0.1)).export(folder / "meshes" / "a" / "clamp.stl")
    trimesh.creation.box((0.2, 0.1, 0.1)).export(folder / "meshes" / "b" / "clamp.stl")
    split_gltf(folder / "meshes" / "stand.gltf")
    (folder / "path.csv").write_bytes((shipped / "examples" / "groove_hw300.csv").read_bytes())
    cell = (shipped / "cells" / "groove_paper.toml").read_text("utf-8")
    (folder / "cell.toml").write_text(own_cell(cell), encoding="utf-8")
    return folder


def split_gltf(path):
    """A box as glTF with its numbers in a file beside it."""
    data = trimesh.creation.box((0.3, 0.1, 0.2)).export(file_type="glb")
    size = struct.unpack_from("<I", data, 12)[0]
    tree = json.loads(data[20 : 20 + size])
    path.with_name("numbers.bin").write_bytes(data[28 + size :])
    tree["buffers"] = [{"uri": "numbers.bin", "byteLength": len(data) - 28 - size}]
    path.write_text(json.dumps(tree), encoding="utf-8")


def own_cell(text):
    state = ProjectState(tomllib.loads(text))
    for key, value in (
        ("robot.model", "robots/own.toml"),
        ("tool.model", "./tools/own.toml"),
        ("beam.section", "beams/mill.toml"),
        ("path", {"file": "path.csv", "frame": "beam"}),
        ("fixtures", [mesh_fixture("one", "meshes/a/clamp.stl", 2000.0),
                      mesh_fixture("two", "meshes/b/clamp.stl", 2500.0),
                      mesh_fixture("three", "meshes/stand.gltf", 3000.0)]),
    ):  # fmt: skip
        state = state.with_value(key, value)
    return toml(state.cell)


def mesh_fixture(name, mesh, y):
    return {"name": name, "mesh": mesh, "unit": "m", "position_mm": [0.0, y, 500.0]}


def toml(table, key=""):
    plain = [f"{name} = {json.dumps(value)}" for name, value in table.items() if is_plain(value)]
    lines = [f"[{key}]", *plain] if key else plain
    for name, value in table.items():
        inner = f"{key}.{name}" if key else name
        if isinstance(value, dict):
            lines.append(toml(value, inner))
        elif not is_plain(value):
            for row in value:
                lines += [f"[[{inner}]]", *(f"{k} = {json.dumps(v)}" for k, v in row.items())]
    return "\n".join(lines) + "\n"


def is_plain(value):
    return not isinstance(value, dict) and not (
        isinstance(value, list) and value and isinstance(value[0], dict)
    )


def same(one, other):
    """Whether two problems are the same to the last bit."""
    assert one.robot.name == other.robot.name == "own_robot"
    assert one.tool.name == other.tool.name == "own_tool"
    assert one.workpiece.name == other.workpiece.name == "OWN300"
    assert np.array_equal(one.robot.limits, other.robot.limits)
    assert np.array_equal(one.waypoint_poses, other.waypoint_poses)
    assert [body.name for body in one.fixtures] == [body.name for body in other.fixtures]
    for mine, theirs in zip(one.fixtures, other.fixtures, strict=True):
        assert np.array_equal(mine.pose, theirs.pose)
        if isinstance(mine.shape, Mesh):
            assert np.array_equal(mine.shape.vertices, theirs.shape.vertices)
            assert np.array_equal(mine.shape.faces, theirs.shape.faces)
    return True


def test_all_files_that_a_cell_names_are_in_the_project(shop):
    state = state_of_cell(shop / "cell.toml")
    assert set(state.files) == {
        "own.toml", "own_2.toml", "mill.toml", "clamp.stl", "clamp_2.stl", "stand.gltf", "path.csv"
    }  # fmt: skip
    assert state.value("robot.model") == "own.toml"
    assert state.value("tool.model") == "own_2.toml"
    assert state.value("fixtures.1.mesh") == "clamp_2.stl"
    assert b"numbers.bin" not in state.files["stand.gltf"]
    assert same(state.problem(), load_cell(shop / "cell.toml"))


def test_a_project_opened_elsewhere_is_the_same_without_its_originals(shop, tmp_path):
    theirs = load_cell(shop / "cell.toml")
    save_project(state_of_cell(shop / "cell.toml"), tmp_path / "work.posopt")
    shutil.rmtree(shop)
    other = tmp_path / "elsewhere"
    other.mkdir()
    (tmp_path / "work.posopt").rename(other / "work.posopt")
    assert same(load_project(other / "work.posopt").problem(), theirs)


def test_a_changed_original_does_not_change_the_project(shop, tmp_path):
    theirs = load_cell(shop / "cell.toml")
    save_project(state_of_cell(shop / "cell.toml"), tmp_path / "work.posopt")
    for path in shop.rglob("*"):
        if path.is_file():
            path.write_bytes(b"something else")
    state = load_project(tmp_path / "work.posopt")
    assert same(state.problem(), theirs)
    assert same(state.with_value("cell.title", "x").with_its_files().problem(), theirs)


def test_equal_projects_have_equal_bytes_wherever_they_were_made(shop, tmp_path):
    shutil.copytree(shop, tmp_path / "copy")
    one, other = (state_of_cell(folder / "cell.toml") for folder in (shop, tmp_path / "copy"))
    assert project_bytes(one) != b""
    assert project_bytes(replace(one, folder="")) == project_bytes(replace(other, folder=""))


def test_a_project_of_the_first_version_takes_its_files_in_where_they_still_are(shop, tmp_path):
    state = state_of_cell(shop / "cell.toml")
    cell = state.with_value("robot.model", "robots/own.toml").cell
    files = {name: data for name, data in state.files.items() if name != "own.toml"}
    document = json.loads(project_bytes(replace(state, cell=cell, files=files)))
    path = tmp_path / "old.posopt"
    path.write_text(json.dumps({**document, "version": 1}), encoding="utf-8")
    loaded = load_project(path)
    assert loaded.value("robot.model") == "own.toml"
    shutil.rmtree(shop)
    assert same(loaded.problem(), state.problem())


def test_what_is_typed_later_is_taken_in_and_undone(shop):
    from posopt_gui.document.document import Document

    document = Document(state_of_cell("groove_paper"))
    before = document.state
    document.set_value("robot.model", str(shop / "robots" / "own.toml"))
    assert document.value("robot.model") == "own.toml"
    assert document.state.files["own.toml"] == (shop / "robots" / "own.toml").read_bytes()
    shutil.rmtree(shop)
    assert document.state.problem().robot.name == "own_robot"
    document.undo()
    assert document.state == before
    document.redo()
    assert document.state.problem().robot.name == "own_robot"


@pytest.mark.parametrize(
    ("key", "name"),
    [("robot.model", "gone.toml"), ("tool.model", "gone/gone.toml"), ("robot.model", "notes.toml"),
     ("beam.section", "gone.toml"), ("path", {"file": "gone.csv"})],
    ids=str,
)  # fmt: skip
def test_a_file_that_cannot_be_used_stays_a_wrong_value_of_its_field(tmp_path, key, name):
    (tmp_path / "notes.toml").write_bytes(b"root:x:0:0\n")
    state = replace(state_of_cell("groove_paper"), folder=str(tmp_path)).with_value(key, name)
    kept = state.with_its_files()
    assert kept is state
    with pytest.raises(InputError):
        kept.problem()
    assert read_project(project_bytes(kept), "a.posopt") == kept


def test_a_wrong_file_in_the_project_is_called_by_its_own_name(shop):
    state = state_of_cell(shop / "cell.toml")
    robot = state.files["own.toml"].replace(b"payload_kg", b"payload_lb")
    wrong = replace(state, files={**state.files, "own.toml": robot})
    with pytest.raises(InputError) as caught:
        wrong.problem()
    assert caught.value.place.file == "own.toml"
    with pytest.raises(InputError) as caught:
        state.with_value("settings.safety_distance_mm", -1.0).problem()
    assert caught.value.place.file == PROJECT


def test_a_project_too_large_to_be_read_again_is_not_written(monkeypatch, tmp_path):
    from posopt_gui.document import project_file

    state = state_of_cell("groove_paper")
    monkeypatch.setattr(project_file, "SIZE_LIMIT", 1000)
    path = tmp_path / "a.posopt"
    with pytest.raises(InputError, match="use smaller meshes"):
        save_project(state, path)
    assert not path.exists()
