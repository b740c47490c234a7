"""Fixtures of every shape, and meshes of files, come into the cell and leave it, step by step."""

import pytest
import trimesh
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFileDialog

from posopt_gui.document.project_file import project_bytes, read_project
from posopt_gui.views.setup_extras import FixtureList
from posopt_gui.views.setup_fixtures import MESH
from posopt_gui.views.setup_view import SetupView
from solver.catalog.bodies import SHAPES


@pytest.fixture
def view(qtbot, session):
    shown = SetupView(session)
    qtbot.addWidget(shown)
    shown.resize(320, 900)
    shown.show()
    shown.refresh()
    shown.section("fixtures").set_open(True)
    yield shown
    shown.path.loader.close()
    shown.fixtures.loader.close()


@pytest.fixture
def block(tmp_path):
    file = tmp_path / "vice jaw.stl"
    shape = trimesh.creation.box((200.0, 100.0, 50.0))
    shape.apply_translation((1300.0, 0.0, 25.0))
    file.write_bytes(shape.export(file_type="stl"))
    return file


def list_of(view):
    found = view.section("fixtures").extra
    assert isinstance(found, FixtureList)
    return found


def add(view, shape):
    actions = list_of(view).add_button.menu().actions()
    next(one for one in actions if one.data() == shape).trigger()


def type_into(qtbot, editor, text):
    editor.setFocus()
    editor.selectAll()
    qtbot.keyClicks(editor, text)
    qtbot.keyClick(editor, Qt.Key.Key_Return)


def wait_for_problem(qtbot, session):
    with qtbot.waitSignal(session.problem_changed, timeout=60_000):
        pass


def steps(document):
    """Labels of all steps, the last one first; the document is as before afterwards."""
    labels = []
    while document.can_undo:
        labels.append(document.undo_label)
        document.undo()
    for _ in labels:
        document.redo()
    return labels


@pytest.mark.parametrize("shape", SHAPES)
def test_a_fixture_of_each_shape_is_added_renamed_edited_and_removed(qtbot, view, session, shape):
    document = session.document
    add(view, shape)
    assert list_of(view).list.currentRow() == 2
    wait_for_problem(qtbot, session)
    assert session.problem.fixtures[2].name == f"{shape}_1"
    box = view.section("fixtures")
    type_into(qtbot, box.row("fixtures.2.name").editors[0], "wall")
    assert document.value("fixtures.2.name") == "wall"
    edited = "max_mm" if shape == "box" else "radius_mm"
    type_into(qtbot, box.row(f"fixtures.2.{edited}").editors[0], "1500")
    qtbot.mouseClick(list_of(view).remove_button, Qt.MouseButton.LeftButton)
    assert len(document.value("fixtures")) == 2
    labels = steps(document)
    assert labels[0] == "Remove fixture"
    assert labels[-1] == "Add fixture"
    assert len(labels) == 4
    document.undo()
    assert document.value("fixtures.2.name") == "wall"
    while document.can_undo:
        document.undo()
    assert not document.modified


def test_a_mesh_is_chosen_with_a_file_dialog_and_kept_in_the_project(qtbot, view, session, block):
    add(view, MESH)
    dialog = view.findChild(QFileDialog)
    assert "*.stl" in " ".join(dialog.nameFilters())
    with qtbot.waitSignal(session.state_changed, timeout=60_000):
        dialog.fileSelected.emit(str(block))
    dialog.reject()
    document = session.document
    assert document.undo_label == "Load mesh"
    assert document.value("fixtures.2") == {"name": "vice_jaw", "mesh": "vice jaw.stl"}
    assert document.state.files["vice jaw.stl"] == block.read_bytes()
    assert view.section("fixtures").row("fixtures.2.mesh").editors[0].text() == "vice jaw.stl"
    block.unlink()
    reopened = read_project(project_bytes(document.state), "other.posopt")
    body = reopened.problem().fixtures[2]
    assert body.shape.vertices.max(axis=0) == pytest.approx((1.4, 0.05, 0.05))


def test_a_mesh_leaves_the_project_with_its_fixture_and_comes_back_with_undo(
    qtbot, view, session, block
):
    document = session.document
    before = dict(document.state.files)
    with qtbot.waitSignal(session.state_changed, timeout=60_000):
        view.fixtures.load_mesh(str(block))
    list_of(view).list.setCurrentRow(2)
    qtbot.mouseClick(list_of(view).remove_button, Qt.MouseButton.LeftButton)
    assert document.state.files == before
    document.undo()
    assert "vice jaw.stl" in document.state.files
    document.undo()
    assert document.state.files == before
    assert not document.can_undo


def test_another_file_takes_the_place_of_a_mesh_in_one_step(qtbot, view, session, block, tmp_path):
    with qtbot.waitSignal(session.state_changed, timeout=60_000):
        view.fixtures.load_mesh(str(block))
    ball = tmp_path / "other" / "vice jaw.stl"
    ball.parent.mkdir()
    ball.write_bytes(trimesh.creation.icosphere(radius=80.0).export(file_type="stl"))
    row = view.section("fixtures").row("fixtures.2.mesh")
    qtbot.mouseClick(row.editors[1], Qt.MouseButton.LeftButton)
    dialog = view.findChild(QFileDialog)
    with qtbot.waitSignal(session.state_changed, timeout=60_000):
        dialog.fileSelected.emit(str(ball))
    dialog.reject()
    state = session.document.state
    assert state.value("fixtures.2.mesh") == "vice jaw_2.stl"
    assert state.files["vice jaw_2.stl"] == ball.read_bytes()
    assert "vice jaw.stl" not in state.files
    assert len(steps(session.document)) == 2


def test_a_mesh_that_is_no_body_is_refused_in_place(qtbot, view, session, tmp_path):
    broken = tmp_path / "open.obj"
    broken.write_text("v 0 0 0\nv 100 0 0\nv 0 100 0\nf 1 2 3\n")
    with qtbot.waitSignal(view.fixtures.loader.refused, timeout=60_000):
        view.fixtures.load_mesh(str(broken))
    sentence = view.section("fixtures")._sentence
    assert sentence.isVisibleTo(view)
    assert "watertight" in sentence.text() or "volume" in sentence.text()
    assert not session.document.can_undo


def test_a_mesh_that_cannot_be_used_is_marked_at_its_field(qtbot, view, session):
    fixtures = [*session.document.value("fixtures"), {"name": "jaw", "mesh": "gone.stl"}]
    session.document.set_value("fixtures", fixtures)
    wait_for_problem(qtbot, session)
    assert view.problem_key == "fixtures.2.mesh"
    view.focus_key(view.problem_key)
    assert view.section("fixtures").row("fixtures.2.mesh").error == "The file does not exist"


def test_a_box_stated_by_its_centre_is_the_same_box(qtbot, view, session):
    add(view, "box")
    wait_for_problem(qtbot, session)
    before = session.problem.fixtures[2]
    rule = view.section("fixtures").row("fixtures.2.stated_by").editors[0]
    rule.setCurrentIndex(1)
    rule.activated.emit(1)
    wait_for_problem(qtbot, session)
    assert "min_mm" not in session.document.value("fixtures.2")
    after = session.problem.fixtures[2]
    assert after.pose == pytest.approx(before.pose)
    assert after.shape.size == pytest.approx(before.shape.size)
