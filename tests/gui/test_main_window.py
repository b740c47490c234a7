"""The window as a whole: its frame, what is dropped on it, how it looks, what it says."""

import gc
import sys
import time
from collections import Counter
from pathlib import Path

import pytest
from PySide6.QtCore import QEvent, QObject, QSettings, Qt, QUrl
from PySide6.QtGui import QKeySequence
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from window_helpers import (
    CELLS,
    EXAMPLES,
    close_window,
    drop,
    make_window,
    opened,
    own_data_folder,
    person,
    plan,
    press,
    settle,
    type_number,
    wait,
)  # fmt: skip

from posopt_gui import start
from posopt_gui.actions import ACTIONS
from posopt_gui.controllers.defects import DefectHook
from posopt_gui.controllers.files import state_of_argument
from posopt_gui.document.project_file import save_project
from posopt_gui.event_loop import EventLoopGaps
from posopt_gui.i18n import texts
from posopt_gui.views.one_flush import OneFlush
from solver.errors import InputError

SMALL = CELLS / "groove_paper.toml"


@pytest.fixture(scope="module")
def shared(qapp, tmp_path_factory):
    """One window with a planned cell for all tests here that leave it as it was."""
    with opened(tmp_path_factory.mktemp("window"), SMALL) as made:
        made.session.start()
        wait(lambda: made.session.report is not None)
        yield made


@pytest.fixture
def window(shared):
    yield shared
    document = shared.session.document
    while document.can_undo:
        document.undo()
    shared.session.look.set_language("en")
    shared.session.look.set_theme("light")
    shared.session.turns.finish()
    settle(shared)


@pytest.fixture
def said(window):
    messages = []
    window.session.message.connect(messages.append)
    yield messages
    window.session.message.disconnect(messages.append)


def test_the_frame_is_there_before_the_panels(qapp, tmp_path):
    settings = QSettings(str(tmp_path / "settings.ini"), QSettings.Format.IniFormat)
    with own_data_folder(tmp_path):
        made = start.make_window(str(SMALL), None, None, settings)
    made.show()
    QTest.qWait(1)
    assert made.menuBar().actions()
    assert made.actions_table["plan"].isEnabled()
    assert not hasattr(made, "map")
    assert not made.actions_table["export"].isEnabled()
    ready = []
    made.ready.connect(lambda: ready.append(1))
    start.begin(made)
    assert ready == []
    wait(lambda: ready)
    assert ready == [1]
    wait(lambda: made.session.result is not None)
    assert made.actions_table["export"].isEnabled()
    assert not made.files.modified
    assert made.close()
    made.deleteLater()


def test_every_action_has_words_and_a_tip_in_both_languages(window):
    known = texts("zh_CN")
    for spec in ACTIONS:
        assert spec.text in known, spec.text
        assert spec.tip in known, spec.tip
    for language in ("zh_CN", "en"):
        window.session.look.set_language(language)
        window.session.turns.finish()
        for action in window.actions_table.by_name.values():
            assert action.text()
            assert action.toolTip()


def test_no_key_means_two_things(window):
    actions = {one for menu in window._menus.values() for one in menu.actions()}
    counted = Counter(
        one.shortcut().toString(QKeySequence.SequenceFormat.PortableText)
        for one in actions
        if not one.shortcut().isEmpty()
    )
    assert counted
    assert [keys for keys, count in counted.items() if count > 1] == []


def test_actions_follow_what_can_be_done(window):
    table, session = window.actions_table, window.session
    assert table["export"].isEnabled()
    assert not table["stop"].isEnabled()
    assert not table["undo"].isEnabled()
    assert not table["clear_wishes"].isEnabled()
    session.pin(20, float(session.sequence.angles[20, 0]))
    assert table["undo"].isEnabled()
    assert table["clear_wishes"].isEnabled()
    assert "*" in window.windowTitle()
    table["undo"].trigger()
    assert table["redo"].isEnabled()
    assert "*" not in window.windowTitle()
    table["plan"].trigger()
    assert table["stop"].isEnabled()
    table["stop"].trigger()
    assert not table["stop"].isEnabled()


def test_map_curves_and_slider_share_one_axis_and_one_cursor(window):
    session, curve = window.session, window.curves.clearance_plot
    window.map.canvas.setXRange(5.0, 15.0, padding=0.0)
    assert curve.getViewBox().viewRange()[0] == pytest.approx([5.0, 15.0])
    window.map.canvas.fit()
    session.set_place(11.5)
    assert window.map.canvas._cursor.value() == pytest.approx(12.5)
    assert curve._cursor.value() == pytest.approx(12.5)
    slider = window.timeline._slider
    assert slider.value() / slider.maximum() == pytest.approx(11.5 / (session.waypoints - 1))


def test_a_cursor_through_all_plots_paints_the_window_once(window):
    flush = window.findChild(OneFlush)
    QTest.qWait(50)
    for place in (3.0, 4.0, 5.0):
        before = flush.count
        window.session.set_place(place)
        wait(lambda before=before: flush.count > before)
        # The 3D panel asks for one of its own when it has drawn.
        assert flush.count - before <= 2
        QTest.qWait(20)


def test_a_wrong_value_is_a_sentence_at_its_field_and_the_plan_stays(window):
    session = window.session
    result = session.result
    type_number(window, "settings.safety_distance_mm", "-5")
    wait(lambda: session.problem_error is not None)
    row = window.setup.section("limits").row("settings.safety_distance_mm")
    assert "at least 0" in row.error
    assert session.result is result
    assert session.stale


def test_a_beam_that_the_path_does_not_fit_is_refused_with_a_sentence(window):
    session = window.session
    state, _ = state_of_argument("groove_hw300")
    session.document.edit("Cell", state.with_value("beam.section", "HW200"))
    wait(lambda: session.problem_error is not None)
    settle(window)
    assert "enters the steel of beam HW200" in str(session.problem_error)
    assert window.setup._problem.isVisibleTo(window)
    assert "HW200" in window.setup._problem.text() + window.setup._problem.toolTip()
    session.document.set_value("beam.section", "HW250")
    wait(lambda: session.problem is not None)
    told = []
    session.message.connect(told.append)
    plan(window)
    session.message.disconnect(told.append)
    assert session.result is None
    assert "no feasible pose" in told[-1].text
    session.document.undo()
    session.document.undo()
    plan(window)


MALFORMED = {
    "broken.posopt": b"{",
    "deep.posopt": b"[" * 100_000,
    "other.posopt": b'{"format": "posopt-project", "version": 99}',
    "nan.posopt": b'{"format": "posopt-project", "version": 1, "cell": {"a": NaN}}',
    "broken.toml": b"[[",
    "binary.toml": bytes(range(256)),
    "broken.csv": b"x,y\n1,\n",
    "empty.csv": b"",
    "nan.csv": b"x,y,z,nx,ny,nz\nnan,0,0,0,0,1\n0,0,0,0,0,1\n",
    "half.ls": b"/PROG A\n/MN\n",
    "none.json": b"null",
    "picture.png": b"\x89PNG\r\n",
    "no_suffix": b"",
}


@pytest.mark.parametrize("name", MALFORMED)
def test_what_is_dropped_and_cannot_be_used_is_told_and_changes_nothing(
    window, said, tmp_path, name
):
    file = tmp_path / name
    file.write_bytes(MALFORMED[name])
    state, result = window.session.document.state, window.session.result
    assert drop(window, QUrl.fromLocalFile(str(file)))
    wait(lambda: said)
    assert said[-1].severity == "error"
    assert "Traceback" not in said[-1].text
    assert "\n" not in said[-1].text
    assert window.session.document.state is state
    assert window.session.result is result


def test_drops_that_are_no_files_are_left_alone(window, said, tmp_path):
    state = window.session.document.state
    assert not drop(window)
    assert not drop(window, QUrl("https://example.org/path.csv"))
    assert not drop(window, QUrl())
    for file in (tmp_path, tmp_path / "missing.csv", tmp_path / ("x" * 300 + ".posopt")):
        drop(window, QUrl.fromLocalFile(str(file)))
    wait(lambda: len(said) >= 3)
    assert window.session.document.state is state
    assert all(one.severity == "error" for one in said)


def test_a_dropped_path_is_a_step_that_undo_takes_back(window, said):
    before = window.session.document.state
    state, _ = state_of_argument("groove_hw300")
    window.session.document.edit("Cell", state.with_value("path.feed_mm_s", 30.0))
    assert drop(window, QUrl.fromLocalFile(str(EXAMPLES / "groove_hw300.csv")))
    wait(lambda: said)
    assert said[-1].severity == "info"
    window.session.document.undo()
    window.session.document.undo()
    assert window.session.document.state is before


def test_language_and_theme_reach_everything_and_leave_nothing_behind(window):
    look = window.session.look

    def there_and_back():
        for language, theme in (("zh_CN", "dark"), ("en", "light")):
            look.set_language(language)
            look.set_theme(theme)
            settle(window)
        gc.collect()
        return len(QApplication.allWidgets())

    before = there_and_back()
    look.set_language("zh_CN")
    window.session.turns.finish()
    assert window.actions_table["plan"].text() == texts("zh_CN")["Plan"]
    assert window.tabs.tabText(0) == texts("zh_CN")["Curves"]
    assert window.tabs.tabText(1) == texts("zh_CN")["Results"]
    assert there_and_back() == before


class Paints(QObject):
    """Counts what is painted anywhere."""

    def __init__(self):
        super().__init__()
        self.count = 0

    def eventFilter(self, watched, event):  # noqa: N802 - Qt's name
        self.count += event.type() == QEvent.Type.Paint
        return False


@pytest.mark.parametrize("hints", [False, True])
def test_an_idle_window_paints_nothing(qapp, tmp_path, hints):
    made = make_window(tmp_path, SMALL, hints=hints)
    plan(made)
    assert bool(made.hints.shown) is hints
    paints = Paints()
    qapp.installEventFilter(paints)
    # What a finished plan sets off comes to rest first.
    for _ in range(40):
        paints.count = 0
        QTest.qWait(150)
        if paints.count == 0:
            break
    qapp.removeEventFilter(paints)
    assert paints.count == 0
    assert close_window(made)


def test_the_layout_is_that_of_the_last_time_until_it_is_reset(qapp, tmp_path):
    made = make_window(tmp_path, SMALL)
    made.inspector.parentWidget().hide()
    assert close_window(made)
    made = make_window(tmp_path, SMALL)
    assert not made.inspector.isVisible()
    made.actions_table["reset_layout"].trigger()
    wait(made.inspector.isVisible)
    assert close_window(made)


def test_what_was_left_behind_is_recovered_and_told(qapp, tmp_path):
    first = make_window(tmp_path, SMALL)
    first.session.document.set_value("settings.safety_distance_mm", 43.0)
    first.recovery.save()
    wait(first.recovery.file.exists)
    left = first.recovery.file.read_bytes()
    assert close_window(first)
    first.recovery.file.with_name("left.recovery").write_bytes(left)
    with own_data_folder(tmp_path):
        settings = QSettings(str(tmp_path / "settings.ini"), QSettings.Format.IniFormat)
        second = start.make_window(None, None, None, settings)
    second.files.ask = person(first)
    second.show()
    start.begin(second)
    wait(lambda: second.session.document.value("settings.safety_distance_mm") == 43.0)
    assert second.files.modified
    assert any("recovered" in note.text for note in second.results._said)
    assert close_window(second)


def test_an_argument_names_the_project_that_is_opened(qapp, tmp_path):
    state, _ = state_of_argument(str(SMALL))
    file = tmp_path / "mine.posopt"
    save_project(state.with_value("settings.safety_distance_mm", 44.0), file)
    with opened(tmp_path, file) as made:
        assert made.windowTitle().startswith("mine")
        assert made.session.document.value("settings.safety_distance_mm") == 44.0
    with pytest.raises(InputError):
        make_window(tmp_path, tmp_path / "missing.posopt")


def test_an_exception_that_nobody_caught_is_a_sentence_and_a_log(window, said, tmp_path):
    hook = DefectHook(window.session, tmp_path / "logs" / "posopt.log")
    before = sys.excepthook
    hook.install()
    try:
        for _ in range(3):
            try:
                _ = 1 / len([])
            except ZeroDivisionError as error:
                sys.excepthook(type(error), error, error.__traceback__)
    finally:
        hook.remove()
    assert sys.excepthook is before
    # The same one is told once: a defect in drawing would come with every frame.
    assert [one.severity for one in said] == ["error"]
    assert "ZeroDivisionError: division by zero" in said[0].text
    assert str(hook.file) in said[0].text
    log = hook.file.read_text(encoding="utf-8")
    assert log.count("Traceback") == 3
    assert "test_main_window.py" in log


def test_keys_reach_the_map_the_playback_and_the_camera(window):
    session = window.session
    window.activateWindow()
    wait(window.isActiveWindow)
    window.map.setFocus()
    session.set_cursor(0)
    press(window.map, "Right")
    assert session.cursor == 1
    press(window.map, "End")
    assert session.cursor == session.waypoints - 1
    press(window.map, "Home")
    assert session.cursor == 0
    press(window.map, "X")
    assert window.map.header.forbid_button.isChecked()
    press(window.map, "Escape")
    assert not window.map.header.forbid_button.isChecked()
    # In a field the same keys belong to the text.
    editor = window.setup.section("beam").row("beam.length_mm").editors[0]
    editor.setFocus()
    wait(editor.hasFocus)
    QTest.keyClick(editor, Qt.Key.Key_End)
    assert session.cursor == 0


def test_the_gap_meter_sees_a_blocked_event_loop(qapp):
    gaps = EventLoopGaps()
    gaps.start()
    QTest.qWait(30)
    gaps.reset()
    QTest.qWait(1)
    time.sleep(0.1)
    QTest.qWait(30)
    gaps.stop()
    assert gaps.longest >= 0.08
    assert gaps.count >= 1


def test_programs_are_proposed_where_the_last_project_lies(window, tmp_path):
    window.show_export()
    exporter = window.export_dialog().exporter
    wait(lambda: exporter.form.path)
    other = tmp_path / "other"
    other.mkdir()
    assert Path(exporter.form.path).parent != other
    window.export_dialog().close()
    person(window).name = str(other / "kept.posopt")
    assert window.files.save_as()
    window.show_export()
    assert Path(exporter.form.path).parent == other
    window.export_dialog().close()
