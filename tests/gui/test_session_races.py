"""What comes in an unlucky order: undo while a plan is made, stop while checks run."""

import threading

import pytest
from PySide6.QtWidgets import QLabel, QMainWindow

from posopt_gui.controllers import session as session_module
from posopt_gui.controllers.session_jobs import checked_by, planned_by
from posopt_gui.viewmodels.verdicts import gate_words
from posopt_gui.views.inspector_view import InspectorView
from posopt_gui.views.status_line import StatusLine
from solver.errors import RefusedError

MINUTE = 60_000


class Held:
    """Work that waits for `go`, as if the machine were slow; `begun` tells that it waits."""

    def __init__(self, work):
        self._work = work
        self.begun, self.go = threading.Event(), threading.Event()

    def __call__(self, *given):
        self.begun.set()
        while not self.go.wait(0.01):
            if given[-1].cancelled():
                break
        return self._work(*given)


@pytest.fixture
def slow_plan(monkeypatch):
    held = Held(planned_by)
    yield held, lambda: monkeypatch.setattr(session_module, "planned_by", held)
    held.go.set()


def test_undo_while_planning_keeps_the_plan_that_fits_again(planned, qtbot, slow_plan):
    """The plan for the inputs that were left replaced the valid one, which then was stale."""
    held, hold = slow_plan
    result = planned.result
    hold()
    planned.document.set_value("settings.safety_distance_mm", 60.0)
    planned.plan()
    qtbot.waitUntil(held.begun.is_set, timeout=MINUTE)
    planned.document.undo()
    assert not planned.stale
    held.go.set()
    qtbot.waitUntil(lambda: not planned.planning, timeout=MINUTE)
    assert planned.result is result
    assert not planned.stale
    qtbot.waitUntil(lambda: planned.report is not None, timeout=MINUTE)


def test_a_plan_of_inputs_that_fail_and_were_left_takes_nothing_away(planned, qtbot, slow_plan):
    held, hold = slow_plan
    result = planned.result
    hold()
    planned.document.set_value("settings.lean_deg", [80.0, 85.0, 1.0])
    planned.plan()
    qtbot.waitUntil(held.begun.is_set, timeout=MINUTE)
    planned.document.undo()
    held.go.set()
    qtbot.waitUntil(lambda: not planned.planning, timeout=MINUTE)
    assert planned.result is result
    assert planned.plan_error is None


def test_stopping_a_plan_brings_back_the_checks_that_it_broke_off(planned, qtbot, slow_plan):
    """The verdict of the program never came back."""
    held, hold = slow_plan
    planned._report = None
    hold()
    planned.plan()
    qtbot.waitUntil(held.begun.is_set, timeout=MINUTE)
    planned.stop()
    qtbot.waitUntil(lambda: planned.report is not None, timeout=MINUTE)
    assert not planned.report.failed


def test_checks_that_cannot_be_completed_have_failed(planned, qtbot, monkeypatch):
    """'Not checked yet.' stood there for good."""

    def broken(*_given):
        raise RefusedError("the link from pass 1 to pass 2 is not free")

    qtbot.waitUntil(lambda: planned.report is not None, timeout=MINUTE)
    monkeypatch.setattr(session_module, "checked_by", broken)
    planned.pin(20, float(planned.sequence.angles[20, 0]))
    qtbot.waitUntil(lambda: planned.check_error is not None, timeout=MINUTE)
    assert planned.report is None
    assert gate_words(None, lambda text, **_: text)[1] == "bad"
    monkeypatch.setattr(session_module, "checked_by", checked_by)
    planned.clear_wishes()
    qtbot.waitUntil(lambda: planned.report is not None, timeout=MINUTE)
    assert planned.check_error is None


def test_checks_that_cannot_be_completed_are_shown_as_failed(planned, qtbot, monkeypatch):
    window = QMainWindow()
    qtbot.addWidget(window)
    line, inspector = StatusLine(planned, window.statusBar()), InspectorView(planned)
    qtbot.addWidget(inspector)
    inspector.show()

    def broken(*_given):
        raise RefusedError("the link from pass 1 to pass 2 is not free")

    monkeypatch.setattr(session_module, "checked_by", broken)
    planned.pin(20, float(planned.sequence.angles[20, 0]))
    qtbot.waitUntil(lambda: planned.check_error is not None, timeout=MINUTE)
    assert line.gate.text() == "✕ Program: the checks could not be completed"
    assert not line.gate.isHidden()
    shown = lambda: " ".join(one.text() for one in inspector.gate.findChildren(QLabel))  # noqa: E731
    qtbot.waitUntil(lambda: "pass 1 to pass 2 is not free" in shown(), timeout=MINUTE)
    assert "Not checked yet." not in shown()
