"""What was typed and then forgotten, guessed or overwritten: each fault has its test."""

import pytest
from map_mouse import LEFT
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from window_helpers import CELLS, close_window, field, make_window, person, press, settle, wait

from posopt_gui.controllers.files import Choice
from posopt_gui.document.project_file import load_project
from posopt_gui.views.number_edit import NumberEdit

SAFETY = "settings.safety_distance_mm"
NAME = "program.name"


@pytest.fixture(scope="module")
def planned_window(tmp_path_factory):
    made = make_window(tmp_path_factory.mktemp("typing"), CELLS / "groove_paper.toml")
    made.session.start()
    wait(lambda: made.session.result is not None)
    settle(made)
    yield made
    assert close_window(made)


@pytest.fixture
def window(planned_window):
    """The window with its first inputs, planned, and nothing typed."""
    before = planned_window.session.document.state
    yield planned_window
    planned_window.setup.forget_typed()
    planned_window.session.document.edit("Back", before)
    settle(planned_window)


def typed(window, key, text):
    """Type without Enter."""
    editor = field(window, key).editors[0]
    editor.setFocus()
    editor.selectAll()
    QTest.keyClicks(editor, text)
    return editor


def pasted(window, key, text):
    editor = field(window, key).editors[0]
    editor.setFocus()
    editor.selectAll()
    QApplication.clipboard().setText(text)
    QTest.keyClick(editor, Qt.Key.Key_V, Qt.KeyboardModifier.ControlModifier)
    return editor


def click(window, action):
    QTest.mouseClick(window._bar.widgetForAction(window.actions_table[action]), LEFT)


def planned_distance(window):
    wait(lambda: not window.session.planning)
    settle(window)
    return window.session.result.problem.settings.safety_distance


@pytest.mark.parametrize("by", ["click", "F5"])
def test_plan_forgot_a_number_that_was_typed_without_enter(window, by):
    editor = typed(window, SAFETY, "61")
    click(window, "plan") if by == "click" else press(editor, "F5")
    assert planned_distance(window) == pytest.approx(0.061)
    assert window.session.document.value(SAFETY) == 61.0
    assert not window.session.stale


def test_plan_forgot_a_text_that_was_typed_without_enter(window):
    press(typed(window, NAME, "OTHER"), "F5")
    wait(lambda: not window.session.planning)
    settle(window)
    assert window.session.document.value(NAME) == "OTHER"
    assert window.session.result.problem.program.name == "OTHER"


@pytest.mark.parametrize("by", ["click", "Ctrl+S"])
def test_save_forgot_a_number_that_was_typed_without_enter(window, tmp_path, by):
    person(window).name = str(tmp_path / "work.posopt")
    window.files.save_as()
    editor = typed(window, SAFETY, "63")
    click(window, "save") if by == "click" else press(editor, by)
    assert load_project(tmp_path / "work.posopt").cell["settings"]["safety_distance_mm"] == 63.0
    assert not window.session.document.modified


def test_closing_lost_a_number_that_was_typed_without_enter_unasked(window):
    window.session.document.mark_saved()
    typed(window, SAFETY, "67")
    person(window).choice = Choice.CANCEL
    person(window).asked.clear()
    assert not window.close()
    assert person(window).asked == ["unsaved"]
    assert window.session.document.value(SAFETY) == 67.0


def test_undo_by_click_takes_back_what_is_being_typed(window):
    before = window.session.document.value(SAFETY)
    window.session.document.set_value(NAME, "OTHER", "Name")
    editor = typed(window, SAFETY, "69")
    click(window, "undo")
    assert window.session.document.value(SAFETY) == before
    assert editor.number == before
    assert window.session.document.value(NAME) == "OTHER"


@pytest.mark.parametrize("text", ["1,000", "1.000,5", "1 000", "1'000", "1_000", "1e", "--3"])
def test_a_number_with_separators_was_guessed_or_thrown_away_silently(window, text):
    row, before = field(window, SAFETY), window.session.document.value(SAFETY)
    editor = pasted(window, SAFETY, text)
    press(editor, "Return")
    assert window.session.document.value(SAFETY) == before
    assert editor.text() == f"{text} mm"
    assert row.error == f"{text} is not taken; write 1000.5: a point for decimals, no separators."
    # Neither leaving the field nor another language nor a change elsewhere hides it.
    field(window, NAME).editors[0].setFocus()
    window.session.look.set_language("zh_CN")
    window.session.turns.finish()
    assert row.error == f"{text} 未被采用；请写成 1000.5：小数用点号，不用分隔符。"
    window.session.look.set_language("en")
    window.session.turns.finish()
    window.session.document.set_value(NAME, "OTHER", "Name")
    assert editor.text() == f"{text} mm"
    press(editor, "Escape")
    assert editor.text() == f"{before:.1f} mm"
    assert row.error == ""


def test_a_number_too_large_was_thrown_away_silently(window):
    row, before = field(window, SAFETY), window.session.document.value(SAFETY)
    press(typed(window, SAFETY, "5e9"), "Return")
    assert window.session.document.value(SAFETY) == before
    assert row.editors[0].text() == "5e9 mm"
    # What is said has an end above, also where the field has none of its own.
    bounds = "Up to 1,000,000,000 mm either way"
    assert row.error == f"5e9 is not taken, it is out of range. {bounds}."


@pytest.mark.parametrize("left", [False, True])
def test_a_plan_was_made_without_the_number_that_stands_there_refused(window, left):
    said = []
    window.session.message.connect(said.append)
    result = window.session.result
    editor = typed(window, SAFETY, "1,000")
    if left:
        field(window, NAME).editors[0].setFocus()
    for action in ("plan", "export", "report", "compare"):
        window.actions_table[action].trigger()
        assert not window.session.planning, action
    assert window.session.result is result
    assert not window._dialogs
    assert {one.text for one in said} == {field(window, SAFETY).error}
    assert editor.hasFocus()
    window.actions_table["compare"].trigger()
    press(typed(window, SAFETY, "52"), "Return")
    assert field(window, SAFETY).error == ""
    window.actions_table["plan"].trigger()
    assert planned_distance(window) == pytest.approx(0.052)


def test_a_refused_text_does_not_come_along_into_another_project(window):
    editor = typed(window, SAFETY, "1,000")
    press(editor, "Return")
    window.files.begun.emit()
    assert window.setup.refused_row() is None
    assert "1,000" not in editor.text()


@pytest.mark.parametrize(
    ("text", "number"),
    [("1,5", 1.5), ("0,125", 0.125), ("１２．５", 12.5), ("−3", -3.0), ("1e3", 1e3)],
)
def test_what_can_mean_one_number_only_is_taken(qtbot, text, number):
    editor = NumberEdit()
    qtbot.addWidget(editor)
    editor.lineEdit().setText(text)
    with qtbot.waitSignal(editor.entered) as entered:
        editor.commit()
    assert entered.args == [number]


@pytest.mark.parametrize(("number", "text"), [(1e-12, "1e-12"), (0.1 + 0.2, "0.3"), (0.0, "0.0")])
def test_a_tiny_number_was_shown_as_zero(qtbot, number, text):
    editor = NumberEdit()
    qtbot.addWidget(editor)
    editor.show_number(number)
    assert editor.text() == text
