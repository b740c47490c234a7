"""A path file that arrives: asked about, told of, looked for where files are."""

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFileDialog, QLineEdit, QVBoxLayout, QWidget

from posopt_gui.controllers import folders
from posopt_gui.views.choice_edit import ChoiceEdit
from posopt_gui.views.setup_view import SetupView
from solver.catalog.names import resource_folder

POINTS = "x,y,z,w,p,r\n0,13,40,0,60,-90\n20,13,45,0,60,-90\n"


@pytest.fixture
def view(qtbot, session):
    shown = SetupView(session)
    qtbot.addWidget(shown)
    shown.resize(320, 500)
    shown.show()
    shown.refresh()
    yield shown
    shown.path.loader.close()
    shown.fixtures.loader.close()


def test_a_file_without_a_frame_is_asked_about(qtbot, view, session, tmp_path):
    file = tmp_path / "plain.csv"
    file.write_text(POINTS)
    with qtbot.waitSignal(view.path_questions, timeout=60_000) as asked:
        view.load_path(str(file))
    assert not asked.args[0].frame_said
    assert asked.args[0].toolpath is not None
    assert not session.document.can_undo


def test_what_a_path_file_holds_is_said_and_its_section_comes_in_sight(
    qtbot, view, session, tmp_path
):
    file = tmp_path / "seam.csv"
    file.write_text("# frame: beam\n" + POINTS)
    said = []
    session.message.connect(lambda message: said.append(message.text))
    with qtbot.waitSignal(view.path.loaded, timeout=60_000):
        view.load_path(str(file))
    assert said[-1] == "seam.csv: 2 waypoints, 1 pass, frame beam"
    box = view.section("path")
    assert box.opened
    qtbot.waitUntil(lambda: 0 <= box.mapTo(view, box.rect().topLeft()).y() < 100)


def test_a_path_is_never_looked_for_in_the_installation(view, session, tmp_path):
    assert str(resource_folder()) in session.document.state.folder
    assert view.path.folder == str(folders.first_folder())
    view.load_path(str(tmp_path / "missing.csv"))
    assert view.path.folder == str(tmp_path)
    view.path.choose()
    dialog = view.findChild(QFileDialog)
    assert dialog.directory().absolutePath() == str(tmp_path)
    dialog.close()


def test_the_first_click_into_a_searched_list_selects_all_and_opens_it(qtbot):
    window = QWidget()
    qtbot.addWidget(window)
    edit, other = ChoiceEdit(searchable=True), QLineEdit()
    layout = QVBoxLayout(window)
    layout.addWidget(other)
    layout.addWidget(edit)
    edit.set_choices([(name, name, "") for name in ("HW250", "HW300", "HEA200")])
    edit.show_value("HW300")
    with qtbot.waitExposed(window):
        window.show()
    window.activateWindow()
    other.setFocus()
    qtbot.waitUntil(other.hasFocus)
    line = edit.lineEdit()
    qtbot.mouseClick(line, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: edit.completer().popup().isVisible())
    assert edit.completer().completionCount() == 3
    assert line.selectedText() == "HW300"
    chosen = []
    edit.chosen.connect(chosen.append)
    qtbot.keyClicks(line, "HW250")
    edit.completer().popup().hide()
    qtbot.keyClick(line, Qt.Key.Key_Return)
    assert chosen == ["HW250"]
