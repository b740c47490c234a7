"""What is exported and reported is the plan of the inputs and wishes as they are, or nothing."""

# ruff: noqa: F811 - fixtures of the dialog's other tests are used here

import threading

import pytest
from test_export_dialog import REASON, near, opened, result, settle  # noqa: F401

from posopt_gui.controllers import export as export_jobs
from posopt_gui.controllers import session as session_jobs
from posopt_gui.controllers.export import Exporter
from posopt_gui.dialogs.export_dialog import ExportDialog
from posopt_gui.document.document import Document
from posopt_gui.document.project import state_of_cell
from posopt_gui.viewmodels.export_model import ExportForm, ExportStage
from solver.errors import InputError, Place
from solver.io.ls_reader import read_program_file
from solver.model.wishes import Region
from solver.units import DEG

PATIENCE = 60_000


class Gate:
    """Holds a job back until it is opened."""

    def __init__(self, job):
        self.job, self.event, self.held = job, threading.Event(), threading.Event()

    def __call__(self, *arguments, **options):
        self.held.set()
        assert self.event.wait(60.0)
        return self.job(*arguments, **options)

    def open(self):
        self.event.set()


@pytest.fixture
def gated(monkeypatch):
    """Hold a job of a module back; all are let go of at the end."""
    gates = []

    def hold(module, name):
        gate = Gate(getattr(module, name))
        monkeypatch.setattr(module, name, gate)
        gates.append(gate)
        return gate

    hold.gates = gates
    yield hold
    for gate in gates:
        gate.open()


@pytest.fixture
def small(qtbot):
    """A session that has planned the small cell."""
    session = session_jobs.Session(Document(state_of_cell("groove_paper")))
    with qtbot.waitSignal(session.result_changed, timeout=180_000):
        session.start()
    yield session
    assert session.close()


@pytest.fixture
def dialog(qtbot, small, gated, tmp_path):
    """The export dialog of that session, ready to write."""
    made = ExportDialog(small)
    qtbot.addWidget(made)
    made.exporter.set_folder(tmp_path)
    made.replaces = lambda _: True
    made.show()
    qtbot.waitUntil(made.export_button.isEnabled, timeout=PATIENCE)
    yield made
    for gate in gated.gates:
        gate.open()
    assert made.shut_down()


def shown_wish(session):
    """A region that forbids what the sequence passes in the middle."""
    middle = session.waypoints // 2
    lean = float(session.sequence.angles[middle, 0])
    return Region(middle, middle, lean - 1.0 * DEG, lean + 1.0 * DEG)


def try_to_export(dialog):
    dialog.export_button.click()
    dialog.exporter.export()
    dialog.exporter.export(override=True)


def test_a_wish_that_is_not_answered_yet_is_never_exported_without_it(
    qtbot, small, dialog, gated, tmp_path
):
    gate = gated(session_jobs, "answered_by")
    old = small.sequence
    small.forbid(shown_wish(small))
    assert small.answering
    assert small.settled_result is None
    assert dialog.exporter.situation.stage is ExportStage.ANSWERING
    assert not dialog.export_button.isEnabled()
    try_to_export(dialog)
    assert not dialog.exporter.situation.writing
    with qtbot.waitSignal(small.result_changed, timeout=PATIENCE):
        gate.open()
    assert not small.answering
    assert small.sequence is not old
    qtbot.waitUntil(dialog.export_button.isEnabled, timeout=PATIENCE)
    with qtbot.waitSignal(dialog.exporter.written, timeout=PATIENCE) as caught:
        dialog.export_button.click()
    assert [one.name for one in tmp_path.iterdir()] == [caught.args[0].path.name]
    read = read_program_file(caught.args[0].path)
    joints = [position.joints_deg for position in read.positions.values()]
    middle = small.waypoints // 2
    wished = small.sequence.pendant[middle] / DEG
    unwished = old.pendant[middle] / DEG
    assert min(abs(wished - one).max() for one in joints) < 0.01
    assert min(abs(unwished - one).max() for one in joints) > 0.01


def test_undo_and_redo_of_a_wish_are_answered_before_anything_is_exported(
    qtbot, small, dialog, gated
):
    with qtbot.waitSignal(small.result_changed, timeout=PATIENCE):
        small.forbid(shown_wish(small))
    qtbot.waitUntil(dialog.export_button.isEnabled, timeout=PATIENCE)
    for step in (small.document.undo, small.document.redo):
        gate = gated(session_jobs, "answered_by")
        step()
        assert dialog.exporter.situation.stage is ExportStage.ANSWERING
        try_to_export(dialog)
        assert not dialog.exporter.situation.writing
        with qtbot.waitSignal(small.result_changed, timeout=PATIENCE):
            gate.open()
        qtbot.waitUntil(dialog.export_button.isEnabled, timeout=PATIENCE)


def test_wishes_that_no_answer_came_to_are_never_exported_without_them(
    qtbot, small, dialog, monkeypatch
):
    def broken(*_):
        raise InputError("no answer")

    monkeypatch.setattr(session_jobs, "answered_by", broken)
    with qtbot.waitSignal(small.message, timeout=PATIENCE):
        small.forbid(shown_wish(small))
    assert not small._wishes.busy
    assert small.answering
    try_to_export(dialog)
    assert not dialog.exporter.situation.writing
    small.document.undo()
    assert small.answering
    monkeypatch.undo()


def test_a_pin_that_is_being_dragged_is_not_exported(qtbot, small, dialog):
    told = []
    small.answering_changed.connect(told.append)
    with qtbot.waitSignal(small.result_changed, timeout=PATIENCE):
        small.preview_pin(2, float(small.sequence.angles[2, 0]))
    assert small.answering
    assert dialog.exporter.situation.stage is ExportStage.ANSWERING
    try_to_export(dialog)
    assert not dialog.exporter.situation.writing
    with qtbot.waitSignal(small.result_changed, timeout=PATIENCE):
        small.end_preview()
    assert told == [True, False]
    qtbot.waitUntil(dialog.export_button.isEnabled, timeout=PATIENCE)


def test_a_dragged_pin_counts_once_it_was_let_go_of(qtbot, small):
    lean = float(small.sequence.angles[2, 0])
    with qtbot.waitSignal(small.result_changed, timeout=PATIENCE):
        small.preview_pin(2, lean)
    small.pin(2, lean)
    qtbot.waitUntil(lambda: not small.answering, timeout=PATIENCE)
    assert small.settled_result is not None
    assert small.settled_result.sequence is small.answer.sequence


def test_inputs_that_changed_while_it_was_written_are_told_beside_the_file(
    qtbot, small, dialog, gated
):
    gate = gated(export_jobs, "_write")
    dialog.export_button.click()
    assert gate.held.wait(60.0)
    small.document.set_value("settings.safety_distance_mm", 55.0)
    with qtbot.waitSignal(dialog.exporter.written, timeout=PATIENCE):
        gate.open()
    assert dialog.exporter.situation.stage is ExportStage.STALE
    assert "another program" in dialog.note.text()
    assert dialog.note.property("tone") == "warning"
    small.document.undo()
    qtbot.waitUntil(dialog.export_button.isEnabled, timeout=PATIENCE)
    assert dialog.note.text().endswith("was written, read back and checked.")
    assert dialog.note.property("tone") == "good"


@pytest.mark.parametrize("change", ["wish", "path", "post"])
def test_a_wish_name_or_format_that_changed_while_it_was_written_is_told_beside_the_file(
    qtbot, small, dialog, gated, tmp_path, change
):
    gate = gated(export_jobs, "_write")
    dialog.export_button.click()
    assert gate.held.wait(60.0)
    if change == "wish":
        small.forbid(shown_wish(small))
    elif change == "path":
        dialog.exporter.set_path(str(tmp_path / "B.LS"))
    else:
        dialog.exporter.set_post("fanuc-cartesian")
    with qtbot.waitSignal(dialog.exporter.written, timeout=PATIENCE) as caught:
        gate.open()
    assert "another program" in dialog.note.text()
    qtbot.waitUntil(dialog.export_button.isEnabled, timeout=PATIENCE)
    assert caught.args[0].path.name in dialog.note.text()
    assert "another program" in dialog.note.text()


def test_a_project_opened_while_a_program_is_written_does_not_take_it_for_its_own(
    qtbot, small, dialog, gated
):
    gate = gated(export_jobs, "_write")
    dialog.export_button.click()
    assert gate.held.wait(60.0)
    small.open(small.document.state.with_value("program.name", "OTHER"))
    with qtbot.waitSignal(dialog.exporter.written, timeout=PATIENCE):
        gate.open()
    with qtbot.waitSignal(small.result_changed, timeout=180_000):
        small.start()
    qtbot.waitUntil(dialog.export_button.isEnabled, timeout=PATIENCE)
    assert "OTHER" in dialog.form.path.text()
    assert "OTHER" not in dialog.note.text()
    assert "another program" in dialog.note.text()


def test_a_program_that_changed_while_its_replacing_was_asked_is_not_written(small, dialog):
    target = dialog.exporter.target()
    target.write_text("mine")
    said = []
    small.message.connect(said.append)

    def change(_):
        dialog.exporter.set_simplify(0.0001)
        return True

    dialog.replaces = change
    dialog.export_button.click()
    assert not dialog.exporter.situation.writing
    assert target.read_text() == "mine"
    assert "changed while you were asked" in said[-1].text


def test_a_draft_of_the_plan_before_is_not_taken_for_that_of_the_plan(
    qtbot,
    opened,
    settle,
    gated,
    result,
    near,
):
    gate = gated(export_jobs, "_draft")
    dialog = opened(result)
    qtbot.waitUntil(gate.held.is_set, timeout=PATIENCE)
    session = dialog._session
    session.result = session.chosen_result = near
    drafts = []
    dialog.exporter._drafts.done.connect(drafts.append)
    session.result_changed.emit()
    # Only the draft of the plan before can end: none is begun while its delay runs.
    dialog.exporter._timer.stop()
    gate.open()
    qtbot.waitUntil(lambda: dialog.exporter._drafts._running is None, timeout=PATIENCE)
    assert not drafts
    assert dialog.exporter.situation.stage is ExportStage.CHECKING
    dialog.exporter._timer.start()
    assert settle(dialog).stage is ExportStage.REFUSED


def test_name_acceptance_and_reason_of_one_project_do_not_carry_into_another(
    qtbot, small, dialog, tmp_path
):
    exporter = dialog.exporter
    exporter.set_path(str(tmp_path / "AAA.LS"))
    exporter.set_accepted(0.02)
    exporter.set_reason(REASON)
    exporter.set_simplify(0.0001)
    assert exporter.form_of_plan.reason == REASON
    small.open(small.document.state.with_value("program.name", "OTHER"))
    assert exporter.form == ExportForm()
    assert exporter.form_of_plan is None
    with qtbot.waitSignal(small.result_changed, timeout=180_000):
        small.start()
    qtbot.waitUntil(dialog.export_button.isEnabled, timeout=PATIENCE)
    assert exporter.form == ExportForm(path=str(exporter.folder / "OTHER.LS"))
    assert not dialog.form.accept.isChecked()
    assert not dialog.form.simplify.isChecked()
    assert dialog.form.reason.text() == ""


def test_an_acceptance_that_was_ticked_is_not_ticked_for_another_project(
    opened,
    settle,
    result,
    near,
):
    dialog = opened(near)
    settle(dialog)
    dialog.form.accept.setChecked(True)
    assert settle(dialog).stage is ExportStage.PASSED
    session = dialog._session
    session.result = session.chosen_result = result
    session.opened.emit()
    settle(dialog)
    assert dialog.exporter.form.accepted is None
    assert not dialog.form.accept.isChecked()
    session.result = session.chosen_result = near
    session.result_changed.emit()
    assert settle(dialog).stage is ExportStage.REFUSED
    assert not dialog.form.accept.isChecked()


def test_the_form_of_another_plan_does_not_stand_in_a_report(opened, settle, result, near):
    dialog = opened(near)
    settle(dialog)
    dialog.exporter.set_reason(REASON)
    assert dialog.exporter.form_of_plan.reason == REASON
    dialog.hide()
    assert dialog.exporter.form_of_plan.reason == REASON
    session = dialog._session
    session.result = session.chosen_result = result
    session.result_changed.emit()
    assert dialog.exporter.form_of_plan is None


def test_a_failed_writing_names_the_file(qtbot, small, dialog, monkeypatch):
    def full(_result, form, _monitor, *, override):
        raise InputError("cannot be written (File too large)", Place(form.path))

    monkeypatch.setattr(export_jobs, "_write", full)
    name = dialog.exporter.target().name
    for language, words in (("en", "cannot be written"), ("zh_CN", "无法写入")):
        small.look.set_language(language)
        small.turns.finish()
        with qtbot.waitSignal(small.message, timeout=PATIENCE) as told:
            dialog.exporter.export()
        assert name in told.args[0].text
        assert words in told.args[0].text
        assert name in dialog.note.text()


def test_an_exporter_that_nobody_looks_at_writes_nothing(small, tmp_path):
    exporter = Exporter(small)
    exporter.set_path(str(tmp_path / "A.LS"))
    exporter.export()
    assert not exporter.situation.writing
    assert exporter.close()
