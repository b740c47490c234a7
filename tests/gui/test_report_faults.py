"""A report is saved of the plan of the inputs and wishes as they are, or not at all."""

# ruff: noqa: F811 - fixtures of the export's tests are used here

from PySide6.QtCore import QSettings
from test_export_faults import PATIENCE, gated, small  # noqa: F401
from window_helpers import CELLS, wait
from window_helpers import opened as opened_window

from posopt_gui.controllers import session as session_jobs
from posopt_gui.controllers.files import Files, NoQuestions
from solver.model.wishes import Region
from solver.units import DEG


class Namer(NoQuestions):
    """A person who names every file the same, and counts how often they were asked."""

    def __init__(self, name):
        self.name, self.asked = name, 0

    def save_name(self, _proposal, _suffix):
        self.asked += 1
        return self.name


def test_no_report_is_saved_of_a_plan_without_the_wishes_or_inputs_as_they_are(
    qtbot, small, gated, tmp_path
):
    person = Namer(str(tmp_path / "a.html"))
    settings = QSettings(str(tmp_path / "kept.ini"), QSettings.Format.IniFormat)
    files = Files(small, settings, person)
    said = []
    small.message.connect(said.append)

    def refused():
        before = len(said)
        assert small.settled_result is None
        assert not files.save_report({})
        assert not person.asked
        return len(said) == before + 1 and "No report is saved" in said[-1].text

    gate = gated(session_jobs, "answered_by")
    small.forbid(Region(1, 1, -180.0 * DEG, 180.0 * DEG))
    assert refused()
    with qtbot.waitSignal(small.result_changed, timeout=PATIENCE):
        gate.open()
    assert small.answer.sequence is None
    assert not small.answering
    assert small.chosen_result is None
    assert refused()
    with qtbot.waitSignal(small.result_changed, timeout=PATIENCE):
        small.document.undo()
    with qtbot.waitSignal(small.result_changed, timeout=PATIENCE):
        small.preview_pin(2, float(small.sequence.angles[2, 0]))
    assert refused()
    with qtbot.waitSignal(small.result_changed, timeout=PATIENCE):
        small.end_preview()
    small.document.set_value("settings.safety_distance_mm", 55.0)
    assert refused()
    small.document.undo()
    with qtbot.waitSignal(files.report_saved, timeout=PATIENCE):
        assert files.save_report({})
    assert person.asked == 1
    assert files.ended()


def test_the_report_of_the_window_waits_for_a_plan_of_inputs_and_wishes_as_they_are(
    tmp_path, gated
):
    with opened_window(tmp_path, CELLS / "groove_paper.toml") as window:
        session, report = window.session, window.actions_table["report"]
        session.start()
        wait(lambda: session.result is not None)
        assert report.isEnabled()
        gate = gated(session_jobs, "answered_by")
        session.forbid(Region(1, 1, -180.0 * DEG, 180.0 * DEG))
        assert not report.isEnabled()
        gate.open()
        wait(lambda: session.answer is not None)
        assert not session.answering
        assert not report.isEnabled()
        session.document.undo()
        wait(lambda: session.answer is None)
        assert report.isEnabled()
        session.document.set_value("settings.safety_distance_mm", 55.0)
        assert not report.isEnabled()
        session.document.undo()
        assert report.isEnabled()
