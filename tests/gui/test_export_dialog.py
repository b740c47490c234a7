import threading
from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import QObject, Qt, Signal
from PySide6.QtWidgets import QPushButton

from posopt_gui.controllers.report import picture_bytes, report_of
from posopt_gui.dialogs.export_dialog import ExportDialog
from posopt_gui.look import Look
from posopt_gui.viewmodels.export_model import ExportForm, ExportStage, check_rows
from posopt_gui.workers.turns import Turns
from solver.io.ls_reader import read_program_file

SETTLED = {ExportStage.REFUSED, ExportStage.PASSED, ExportStage.FAULT}
REASON = "Trial run in T1 without a tool"


class StillSession(QObject):
    """Stands for a session with a plan that is made already."""

    result_changed = Signal()
    problem_changed = Signal()
    stale_changed = Signal(bool)
    planning_changed = Signal(bool)
    answering_changed = Signal(bool)
    opened = Signal()

    def __init__(self, result):
        super().__init__()
        self.look, self.turns = Look(parent=self), Turns(self)
        self.result = self.chosen_result = result
        self.sequence = result.sequence if result is not None else None
        self.answer, self.stale, self.planning = None, False, False
        self.answering = False
        self.plans, self.cursor, self.said = 0, None, []

    @property
    def settled_result(self):
        return None if self.stale or self.answering else self.chosen_result

    def plan(self):
        self.plans += 1

    def set_cursor(self, waypoint):
        self.cursor = waypoint

    def say(self, message):
        self.said.append(message)


@pytest.fixture(scope="module")
def result():
    """The plan of the last ten waypoints of the default cell."""
    import solver

    problem = solver.load_cell("groove_hw300")
    whole = problem.toolpath.passes[0]
    short = replace(whole, poses=whole.poses[-10:], roles=whole.roles[-10:], events={})
    toolpath = problem.toolpath.with_passes((short,))
    return solver.plan(replace(problem, toolpath=toolpath))


@pytest.fixture(scope="module")
def near(result):
    """The same plan where 80 mm were asked, which it does not keep."""
    settings = replace(result.problem.settings, safety_distance=0.08)
    return replace(result, problem=replace(result.problem, settings=settings), clearance_met=False)


@pytest.fixture
def opened(qtbot, tmp_path):
    dialogs = []

    def show(result, **changes):
        session = StillSession(result)
        for name, value in changes.items():
            setattr(session, name, value)
        dialog = ExportDialog(session)
        qtbot.addWidget(dialog)
        dialog.exporter.set_folder(tmp_path)
        dialog.replaces = lambda _: False
        dialog.show()
        dialogs.append(dialog)
        return dialog

    yield show
    for dialog in dialogs:
        assert dialog.shut_down()


@pytest.fixture
def settle(qtbot):
    def wait(dialog):
        def settled():
            now = dialog.exporter.situation
            return now.stage in SETTLED and now.order_fault is not None

        qtbot.waitUntil(settled, timeout=30_000)
        return dialog.exporter.situation

    return wait


def written(qtbot, dialog, button):
    with qtbot.waitSignal(dialog.exporter.written, timeout=30_000) as caught:
        qtbot.mouseClick(button, Qt.MouseButton.LeftButton)
    return caught.args[0]


def test_the_preview_is_what_is_written_and_can_be_read_back(
    qtbot, opened, settle, result, tmp_path
):
    dialog = opened(result)
    assert not dialog.export_button.isEnabled()
    assert settle(dialog).stage is ExportStage.PASSED
    shown = dialog.preview.toPlainText()
    program = written(qtbot, dialog, dialog.export_button)
    path = tmp_path / "GROOVE.LS"
    assert program.path == path
    assert path.read_text("ascii").splitlines() == shown.splitlines()
    assert len(read_program_file(path).positions) == program.report.positions
    assert "GROOVE.LS" in dialog.note.text()


def test_every_other_format_is_written_with_its_suffix(qtbot, opened, settle, result, tmp_path):
    dialog = opened(result)
    for number, suffix in ((1, ".LS"), (2, ".csv"), (3, ".json")):
        dialog.form.format.setCurrentIndex(number)
        dialog.form.format.activated.emit(number)
        assert settle(dialog).stage is ExportStage.PASSED
        dialog.replaces = lambda _: True
        shown = dialog.preview.toPlainText()
        program = written(qtbot, dialog, dialog.export_button)
        assert program.path == tmp_path / f"GROOVE{suffix}"
        assert program.path.read_text("ascii").splitlines() == shown.splitlines()


def test_a_failed_check_leaves_no_way_but_a_reason(qtbot, opened, settle, near, tmp_path):
    dialog = opened(near)
    assert settle(dialog).stage is ExportStage.REFUSED
    assert not dialog.export_button.isEnabled()
    assert dialog.checks.item(0, 0).text() == "FAILED"
    override = dialog.form.override
    assert not override.isEnabled()
    dialog.form.reason.setFocus()
    qtbot.keyClicks(dialog.form.reason, REASON[:9])
    settle(dialog)
    assert not override.isEnabled()
    qtbot.keyClicks(dialog.form.reason, REASON[9:])
    qtbot.waitUntil(override.isEnabled, timeout=10_000)
    qtbot.waitUntil(lambda: "OVERRIDE" in dialog.preview.toPlainText(), timeout=10_000)
    assert dialog.focusWidget() is dialog.form.reason
    shown = dialog.preview.toPlainText()
    program = written(qtbot, dialog, override)
    assert program.path == tmp_path / "GROOVE_OVR.LS"
    assert program.path.read_text("ascii").splitlines() == shown.splitlines()
    assert [one.name for one in tmp_path.iterdir()] == ["GROOVE_OVR.LS"]
    stamped = "".join(
        one.removeprefix("OVERRIDE ")
        for one in read_program_file(program.path).remarks
        if one.startswith("OVERRIDE ")
    )
    assert stamped == REASON


def test_a_reason_in_chinese_is_refused_with_a_sentence(qtbot, opened, settle, near):
    dialog = opened(near)
    settle(dialog)
    dialog.exporter.set_reason("只是没有装刀具的试运行而已")
    qtbot.waitUntil(lambda: bool(dialog.exporter.situation.reason_fault), timeout=10_000)
    assert not dialog.form.override.isEnabled()
    assert "pinyin" in dialog.form.reason_hint.text()


def test_a_lower_clearance_can_be_accepted_but_not_more_than_is_kept(opened, settle, near):
    dialog = opened(near)
    settle(dialog)
    assert dialog.form.accept.isVisible()
    dialog.form.accept.setChecked(True)
    assert settle(dialog).stage is ExportStage.PASSED
    assert "ACCEPTED CLEARANCE" in dialog.preview.toPlainText()
    dialog.form.clearance.setValue(79.0)
    assert settle(dialog).stage is ExportStage.REFUSED


def test_simplifying_drops_positions(opened, settle, result):
    dialog = opened(result)
    before = settle(dialog).draft.report.positions
    dialog.form.simplify.setChecked(True)
    now = settle(dialog)
    assert now.stage is ExportStage.PASSED
    assert now.draft.report.positions < before


def test_a_click_on_a_line_goes_to_its_waypoint(opened, settle, result):
    dialog = opened(result)
    checks = check_rows(settle(dialog).draft.report.checks, dialog._session.look.tr)
    rows = [check.waypoint for check in checks]
    row = next(number for number, waypoint in enumerate(rows) if waypoint is not None)
    dialog.checks.clicked.emit(dialog.checks.model().index(row, 4))
    assert dialog._session.cursor == rows[row]


def test_a_stale_plan_is_said_and_planning_offered(qtbot, opened, settle, result):
    dialog = opened(result)
    settle(dialog)
    session = dialog._session
    session.stale = True
    session.stale_changed.emit(True)
    assert dialog.exporter.situation.stage is ExportStage.STALE
    assert not dialog.export_button.isEnabled()
    assert dialog.banner.plan_button.isVisible()
    qtbot.mouseClick(dialog.banner.plan_button, Qt.MouseButton.LeftButton)
    assert session.plans == 1
    dialog.exporter.export()
    assert not dialog.exporter.situation.writing


def test_without_a_plan_nothing_can_be_exported(opened):
    dialog = opened(None)
    assert dialog.exporter.situation.stage is ExportStage.EMPTY
    assert not dialog.export_button.isEnabled()
    assert not dialog.form.override.isVisible()


def test_a_file_that_cannot_be_written_is_told_beside_its_field(opened, settle, result, tmp_path):
    dialog = opened(result)
    settle(dialog)
    for path, words in (
        (str(tmp_path / "none" / "A.LS"), "no folder"),
        (str(tmp_path / "1 A.LS"), "a program name"),
        (str(tmp_path / "A.csv"), "ends in"),
        ("", "ends in"),
        ("a\0b.LS", ""),
    ):
        dialog.exporter.set_path(path)
        settle(dialog)
        assert dialog.form.path_fault.isVisible(), path
        assert words in dialog.form.path_fault.text()
        assert not dialog.export_button.isEnabled()


def test_an_existing_file_is_replaced_only_when_the_person_says_so(
    qtbot, opened, settle, result, tmp_path
):
    path = tmp_path / "GROOVE.LS"
    path.write_text("mine")
    dialog = opened(result)
    settle(dialog)
    asked = []
    dialog.replaces = lambda target: bool(asked.append(target))
    qtbot.mouseClick(dialog.export_button, Qt.MouseButton.LeftButton)
    assert asked == [path]
    assert path.read_text() == "mine"
    dialog.replaces = lambda _: True
    written(qtbot, dialog, dialog.export_button)
    assert path.read_text().startswith("/PROG")


def test_a_failed_writing_is_said_and_leaves_nothing(qtbot, opened, settle, result, tmp_path):
    dialog = opened(result)
    settle(dialog)
    (tmp_path / "GROOVE.LS").mkdir()
    dialog.replaces = lambda _: True
    qtbot.mouseClick(dialog.export_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: bool(dialog.exporter.situation.write_fault), timeout=30_000)
    assert not dialog.exporter.situation.writing
    assert list((tmp_path / "GROOVE.LS").iterdir()) == []
    assert dialog._session.said[-1].severity == "error"


def test_drafts_are_made_off_the_windows_thread_and_only_while_it_is_seen(
    monkeypatch, opened, settle, result
):
    from solver.pipeline import programming

    made, threads = programming.draft_program, []

    def noted(*arguments):
        threads.append(threading.current_thread())
        return made(*arguments)

    monkeypatch.setattr(programming, "draft_program", noted)
    dialog = opened(result)
    settle(dialog)
    assert threads
    assert threading.main_thread() not in threads
    dialog.hide()
    count = len(threads)
    dialog._session.result_changed.emit()
    assert not dialog.exporter._timer.isActive()
    assert len(threads) == count


def test_another_plan_makes_another_draft(opened, settle, result, near):
    dialog = opened(result)
    assert settle(dialog).stage is ExportStage.PASSED
    session = dialog._session
    session.result = session.chosen_result = near
    session.result_changed.emit()
    assert dialog.exporter.situation.stage is ExportStage.CHECKING
    assert settle(dialog).stage is ExportStage.REFUSED


def test_enter_in_a_field_exports_nothing(qtbot, opened, settle, result, tmp_path):
    dialog = opened(result)
    settle(dialog)
    assert not [one for one in dialog.findChildren(QPushButton) if one.isDefault()]
    qtbot.keyClick(dialog.form.path, Qt.Key.Key_Return)
    assert not dialog.exporter.situation.writing
    assert list(tmp_path.iterdir()) == []


def test_language_and_theme_change_while_it_is_open(opened, settle, result):
    dialog = opened(result)
    settle(dialog)
    look = dialog._session.look
    look.set_language("zh_CN")
    look.set_theme("dark")
    dialog._session.turns.finish()
    assert dialog.export_button.text() == "导出"
    assert dialog.checks.item(0, 0).text() == "通过"
    assert look.theme.surface in dialog.styleSheet()
    look.set_language("en")
    dialog._session.turns.finish()
    assert dialog.export_button.text() == "Export"
    fields = (dialog.form.path, dialog.form.reason, dialog.form.clearance, dialog.form.tolerance)
    assert all(one.accessibleName() for one in (dialog.checks, dialog.preview, *fields))


def test_closing_while_writing_waits_for_it(qtbot, opened, settle, result, tmp_path):
    dialog = opened(result)
    settle(dialog)
    qtbot.mouseClick(dialog.export_button, Qt.MouseButton.LeftButton)
    dialog.close()
    assert dialog.shut_down()
    left = [one.name for one in tmp_path.iterdir()]
    assert left in ([], ["GROOVE.LS"])


def test_the_report_of_a_form_states_its_reason(qapp, near, tmp_path):
    from PySide6.QtGui import QImage

    from solver.progress import SilentMonitor

    image = QImage(8, 6, QImage.Format.Format_RGB32)
    image.fill(0x336699)
    pictures = {"map": picture_bytes(image), "scene": picture_bytes(QImage())}
    form = ExportForm("csv", str(tmp_path / "A.csv"), reason=REASON)
    path = tmp_path / "a.html"
    assert report_of(near, path, pictures, "en", form, SilentMonitor()) == path
    page = path.read_text("utf-8")
    assert REASON in page
    assert "A_OVR.csv" in page
    assert page.count("<img") == 1
    again = report_of(near, tmp_path / "b.html", pictures, "en", form, SilentMonitor())
    assert Path(again).read_bytes() == path.read_bytes()


def test_the_dialog_follows_a_real_session_through_pins(qtbot, planned, tmp_path, settle):
    dialog = ExportDialog(planned)
    qtbot.addWidget(dialog)
    dialog.exporter.set_folder(tmp_path)
    dialog.show()
    assert settle(dialog).stage is ExportStage.PASSED
    before = dialog.preview.toPlainText()
    lean = planned.result.problem.settings.lean.angles()[30]
    with qtbot.waitSignal(planned.result_changed, timeout=30_000):
        planned.pin(20, float(lean))
    settle(dialog)
    assert planned.answer is not None
    if planned.answer.sequence is not None:
        assert dialog.preview.toPlainText() != before
    else:
        assert dialog.exporter.situation.stage is ExportStage.BLOCKED
    assert dialog.shut_down()
