import json

import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDropEvent, QWheelEvent
from PySide6.QtWidgets import QApplication

from posopt_gui.document.project import ProjectState, state_of_cell
from posopt_gui.views.beam_drawing_view import BeamDrawingView
from posopt_gui.views.setup_extras import PathFileBox
from posopt_gui.views.setup_view import SetupView


@pytest.fixture
def view(qtbot, session):
    shown = SetupView(session)
    qtbot.addWidget(shown)
    shown.resize(320, 900)
    shown.show()
    shown.refresh()
    yield shown
    shown.path.loader.close()
    shown.fixtures.loader.close()


def opened(view, section, key):
    view.section(section).set_open(True)
    return view.section(section).row(key)


def type_into(qtbot, editor, text, key=Qt.Key.Key_Return):
    editor.setFocus()
    editor.selectAll()
    qtbot.keyClicks(editor, text)
    if key is not None:
        qtbot.keyClick(editor, key)


def wheel(editor):
    place = QPointF(editor.rect().center())
    event = QWheelEvent(
        place, editor.mapToGlobal(place), QPoint(), QPoint(0, 120),
        Qt.MouseButton.NoButton, Qt.KeyboardModifier.NoModifier,
        Qt.ScrollPhase.NoScrollPhase, False,
    )  # fmt: skip
    QApplication.sendEvent(editor, event)


def wait_for_problem(qtbot, session):
    with qtbot.waitSignal(session.problem_changed, timeout=60_000):
        pass


def test_showing_a_cell_writes_nothing(qtbot, view, session):
    names = list(view._boxes)
    view.set_open_sections(tuple(names))
    assert view.open_sections() == tuple(names)
    assert not session.document.can_undo
    assert not session.document.modified


def test_enter_applies_a_number_in_the_unit_of_its_key(qtbot, view, session):
    row = opened(view, "limits", "settings.safety_distance_mm")
    type_into(qtbot, row.editors[0], "62.5")
    assert session.document.value("settings.safety_distance_mm") == 62.5
    assert session.document.undo_label == "Safety distance"


def test_escape_leaves_a_number_as_it_was(qtbot, view, session):
    row = opened(view, "limits", "settings.safety_distance_mm")
    type_into(qtbot, row.editors[0], "62.5", Qt.Key.Key_Escape)
    assert session.document.value("settings.safety_distance_mm") == 50.0
    assert row.editors[0].text() == "50.0 mm"


def test_words_and_nothing_are_no_numbers(qtbot, view, session):
    row = opened(view, "limits", "settings.safety_distance_mm")
    for text in ("abc", "-", "1e", ""):
        type_into(qtbot, row.editors[0], text)
        if not text:
            qtbot.keyClick(row.editors[0], Qt.Key.Key_Delete)
            qtbot.keyClick(row.editors[0], Qt.Key.Key_Return)
        assert session.document.value("settings.safety_distance_mm") == 50.0


def test_one_number_of_several_leaves_the_others_exact(qtbot, view, session):
    session.document.set_value("beam.wpr_deg", [90.123456789012, 0.0, 90.0])
    row = opened(view, "placement", "beam.wpr_deg")
    type_into(qtbot, row.editors[2], "45")
    assert session.document.value("beam.wpr_deg") == [90.123456789012, 0.0, 45.0]


def test_the_wheel_turns_a_number_only_in_focus(qtbot, view, session):
    editor = opened(view, "limits", "settings.safety_distance_mm").editors[0]
    wheel(editor)
    assert session.document.value("settings.safety_distance_mm") == 50.0
    qtbot.waitUntil(lambda: (view.activateWindow(), editor.setFocus(), editor.hasFocus())[2])
    wheel(editor)
    assert session.document.value("settings.safety_distance_mm") == 55.0


def test_arrow_keys_stay_within_the_range(qtbot, view, session):
    editor = opened(view, "cost", "settings.heuristic_weight").editors[0]
    for _ in range(5):
        qtbot.keyClick(editor, Qt.Key.Key_Up)
    assert session.document.value("settings.heuristic_weight") == 1.0
    assert session.document.undo_label == "Heuristic weight"
    session.document.undo()
    assert session.document.value("settings.heuristic_weight") == 0.9


def test_an_emptied_optional_number_is_no_longer_stated(qtbot, view, session):
    editor = opened(view, "program", "program.payload").editors[0]
    assert editor.text() == "1"
    editor.setFocus()
    editor.selectAll()
    qtbot.keyClick(editor, Qt.Key.Key_Delete)
    qtbot.keyClick(editor, Qt.Key.Key_Return)
    assert session.document.value("program.payload") is None
    assert editor.text() == "not selected"
    type_into(qtbot, editor, "3")
    assert session.document.value("program.payload") == 3
    assert isinstance(session.document.value("program.payload"), int)


def test_fields_follow_undo_and_redo_without_a_step_of_their_own(qtbot, view, session):
    row = opened(view, "limits", "settings.safety_distance_mm")
    type_into(qtbot, row.editors[0], "70")
    session.document.undo()
    assert row.editors[0].text() == "50.0 mm"
    assert session.document.can_redo
    session.document.redo()
    assert row.editors[0].text() == "70.0 mm"
    assert not session.document.can_redo


def test_a_wrong_value_is_marked_in_place_and_reached_by_a_click(qtbot, view, session):
    row = opened(view, "limits", "settings.safety_distance_mm")
    type_into(qtbot, row.editors[0], "-5")
    wait_for_problem(qtbot, session)
    assert session.problem_error is not None
    assert row.error == "Expected at least 0 in mm, found −5.0"
    assert row._sentence.isVisibleTo(view)
    assert view.problem_key == "settings.safety_distance_mm"
    view.section("limits").set_open(False)
    assert view._problem.isVisibleTo(view)
    qtbot.mouseClick(view._problem, Qt.MouseButton.LeftButton)
    assert view.section("limits").opened
    session.document.undo()
    wait_for_problem(qtbot, session)
    assert row.error == ""
    assert not view._problem.isVisibleTo(view)


def test_focus_of_a_key_in_a_list_reaches_its_part(qtbot, view, session):
    view.focus_key("fixtures.1.max_mm.2")
    row = view.section("fixtures").row("fixtures.1.max_mm")
    qtbot.waitUntil(lambda: (view.activateWindow(), row.editors[2].hasFocus())[1])
    assert row.editors[2].text() == "Z 450.0"


def test_another_beam_is_one_step_and_its_drawing_follows(qtbot, view, session):
    row = opened(view, "beam", "beam.section")
    drawing = view.section("beam").extra
    assert isinstance(drawing, BeamDrawingView)
    type_into(qtbot, row.editors[0].lineEdit(), "hw 250")
    assert session.document.value("beam.section") == "HW250"
    assert drawing.section.height == 0.25
    assert "H 250" in drawing.accessibleName()
    session.document.undo()
    assert not session.document.can_undo
    assert drawing.section.height == 0.3
    assert row.editors[0].currentText() == "HW300"


def test_free_dimensions_take_the_place_of_the_section(qtbot, view, session):
    row = opened(view, "beam", "beam.standard")
    row.editors[0].setCurrentIndex(row.editors[0].findText("Free dimensions"))
    row.editors[0].activated.emit(row.editors[0].currentIndex())
    box = view.section("beam")
    assert box.row("beam.section") is None
    type_into(qtbot, box.row("beam.height_mm").editors[0], "420")
    assert session.document.value("beam.height_mm") == 420.0
    assert box.extra.section.height == pytest.approx(0.42)


def test_branches_are_chosen_by_their_letters(qtbot, view, session):
    row = opened(view, "lean", "settings.branches")
    assert [button.text() for button in row.editors][:2] == ["NUT", "FUT"]
    for button in row.editors[1:]:
        qtbot.mouseClick(button, Qt.MouseButton.LeftButton)
    assert session.document.value("settings.branches") == [0]


def test_a_switch_makes_and_removes_a_table(qtbot, view, session):
    row = opened(view, "accuracy", "accuracy")
    qtbot.mouseClick(row.editors[0], Qt.MouseButton.LeftButton)
    assert session.document.value("accuracy") is None
    assert view.section("accuracy").row("accuracy.tcp_mm") is None
    qtbot.mouseClick(row.editors[0], Qt.MouseButton.LeftButton)
    assert session.document.value("accuracy.tcp_mm") == 0.5


def drop(widget, *paths):
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path)) for path in paths])
    event = QDropEvent(
        QPointF(5.0, 5.0), Qt.DropAction.CopyAction, data,
        Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier,
    )  # fmt: skip
    widget.dropEvent(event)


def test_a_dropped_path_file_is_one_step_with_its_bytes(qtbot, view, session, tmp_path):
    file = tmp_path / "short.csv"
    file.write_text("# frame: beam\nx,y,z,w,p,r\n0,13,40,0,60,-90\n20,13,45,0,60,-90\n")
    with qtbot.waitSignal(session.state_changed, timeout=60_000):
        drop(view, file)
    assert session.document.state.files == {"short.csv": file.read_bytes()}
    assert session.document.value("path.file") == "short.csv"
    assert session.document.value("path.touches") == "web"
    wait_for_problem(qtbot, session)
    assert len(session.problem.toolpath) == 2
    session.document.undo()
    assert not session.document.can_undo


@pytest.mark.parametrize(
    ("name", "data", "words"),
    [
        ("words.csv", b"x,y,z,w,p,r\n1,2,three,0,0,0\n2,2,3,0,0,0\n", "words.csv, line 2"),
        ("binary.csv", bytes(range(256)), "NUL byte"),
        ("empty.csv", b"", "no rows"),
        ("cut.json", b'{"format": ', "cut.json"),
        ("loop.ls", b"/PROG  X\n/MN\n 1: JMP LBL[1];\n/POS\n/END\n", "loop.ls"),
    ],
)
def test_a_malformed_drop_ends_with_one_sentence_in_place(
    qtbot, view, session, tmp_path, name, data, words
):
    file = tmp_path / name
    file.write_bytes(data)
    box = view.section("path").extra
    assert isinstance(box, PathFileBox)
    asked = []
    view.path_questions.connect(asked.append)
    drop(box, file)
    qtbot.waitUntil(lambda: box.sentence != "", timeout=60_000)
    assert words in box.sentence
    assert "\n" not in box.sentence
    assert not session.document.can_undo
    assert not asked


def test_drops_of_other_things_are_not_taken(view, tmp_path):
    other = tmp_path / "part.step"
    other.write_text("")
    drop(view, other)
    drop(view, tmp_path / "a.csv", tmp_path / "b.csv")
    assert view.section("path").extra.sentence == ""


def test_a_header_that_is_not_understood_is_asked_about(qtbot, view, session, tmp_path):
    file = tmp_path / "other.csv"
    file.write_text("Pos A,Pos B,Pos C\n0,13,40\n20,13,45\n")
    with qtbot.waitSignal(view.path_questions, timeout=60_000) as asked:
        drop(view, file)
    assert asked.args[0].titles == ("Pos A", "Pos B", "Pos C")
    assert not session.document.can_undo


def test_nothing_is_wider_than_the_panel_in_either_language(qtbot, view, session):
    view.set_open_sections(tuple(view._boxes))
    for language in ("en", "zh_CN"):
        session.look.set_language(language)
        session.turns.finish()
        qtbot.waitUntil(lambda: view._body.minimumSizeHint().width() <= 300)
        for box in view._boxes.values():
            for row in box.rows.values():
                row.layout().activate()
                room = view._scroll.viewport().width()
                assert row.minimumSizeHint().width() <= room - 20, row.field.key
    session.look.set_language("en")
    session.turns.finish()


def test_every_editor_says_its_name_and_its_tip(view):
    view.set_open_sections(tuple(view._boxes))
    for box in view._boxes.values():
        for row in box.rows.values():
            for editor in row.editors:
                assert editor.accessibleName()
                assert editor.toolTip()


def test_the_tabulator_goes_through_the_fields_as_they_stand(qtbot, view):
    row = opened(view, "beam", "beam.standard")
    row.editors[0].setCurrentIndex(row.editors[0].findText("Free dimensions"))
    row.editors[0].activated.emit(row.editors[0].currentIndex())
    rows = view.section("beam").rows.values()
    editor, order = row.editors[0], []
    for _ in range(12):
        editor = editor.nextInFocusChain()
        order += [one.field.key for one in rows if editor in one.editors]
    assert order[:5] == [
        "beam.height_mm", "beam.width_mm", "beam.web_mm", "beam.flange_mm", "beam.root_mm",
    ]  # fmt: skip


def test_language_and_theme_can_be_switched_while_it_is_open(view, session):
    row = opened(view, "limits", "settings.safety_distance_mm")
    session.look.set_language("zh_CN")
    session.turns.finish()
    assert row._label.text() == "安全距离"
    assert row.editors[0].text() == "50.0 mm"
    session.look.set_theme("dark")
    session.turns.finish()
    session.look.set_language("en")
    session.turns.finish()
    assert row._label.text() == "Safety distance"


def test_a_project_with_damaged_tables_is_shown_with_its_sentence(qtbot, session):
    cell = json.loads(json.dumps(dict(session.document.state.cell)))
    cell["beam"] = 3
    cell["fixtures"] = [1, {"name": []}]
    cell["settings"]["lean_deg"] = "wide"
    session.open(ProjectState(cell))
    view = SetupView(session)
    qtbot.addWidget(view)
    view.refresh()
    view.set_open_sections(tuple(view._boxes))
    wait_for_problem(qtbot, session)
    assert view.problem_key == "beam"
    assert view.section("beam")._sentence.text() == "Expected a table, found 3"
    view.path.loader.close()


@pytest.mark.parametrize("name", ["groove_paper", "zigzag_hw250"])
def test_the_other_shipped_cells_are_shown_without_a_step(qtbot, session, name):
    session.open(state_of_cell(name))
    view = SetupView(session)
    qtbot.addWidget(view)
    view.refresh()
    view.set_open_sections(tuple(view._boxes))
    assert not session.document.can_undo
    view.path.loader.close()


def test_an_error_of_no_field_is_said_in_full_at_the_top(qtbot, view, session):
    position = session.document.value("beam.lower_edge_mm")
    assert position is not None
    # A thicker web reaches over the points of the path.
    session.document.set_value("beam.web_mm", 60.0)
    for key, value in (("height_mm", 300.0), ("width_mm", 300.0), ("flange_mm", 15.0)):
        session.document.set_value(f"beam.{key}", value)
    qtbot.waitUntil(lambda: "enters the steel" in str(session.problem_error), timeout=60_000)
    assert view._whole.isVisibleTo(view)
    assert "enters the steel of beam" in view._whole.text()
    session.look.set_language("zh_CN")
    session.turns.finish()
    assert "进入型钢" in view._whole.text()
    assert not {"the", "steel", "expected"} & set(view._whole.text().split())
    session.look.set_language("en")
    session.turns.finish()
    while session.document.can_undo:
        session.document.undo()
    wait_for_problem(qtbot, session)
    assert not view._whole.isVisibleTo(view)


def test_a_wrong_value_is_told_in_chinese(qtbot, view, session):
    session.look.set_language("zh_CN")
    session.turns.finish()
    row = opened(view, "limits", "settings.safety_distance_mm")
    type_into(qtbot, row.editors[0], "-5")
    wait_for_problem(qtbot, session)
    assert row.error == "应为不小于 0（mm），实际为 −5.0"
    session.look.set_language("en")
    session.turns.finish()
    assert row.error == "Expected at least 0 in mm, found −5.0"
