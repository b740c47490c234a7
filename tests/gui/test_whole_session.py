"""A whole session as a person does it, through the actions and panels of the window."""

import math

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from window_helpers import (
    Hand,
    choose,
    opened,
    person,
    plan,
    settle,
    type_number,
    wait,
)

from posopt_gui.viewmodels.export_model import ExportStage
from solver.io.ls_reader import read_program_file
from solver.model.settings import Scheme

SAME = 1e-12


@pytest.fixture
def window(qapp, tmp_path):
    with opened(tmp_path) as made:
        made.session.start()
        wait(lambda: made.session.report is not None)
        yield made


def lean_at(window, waypoint):
    return math.degrees(window.session.sequence.angles[waypoint, 0])


def use_hw250(window):
    """HW250 with a line on its web, and the ball above the plate."""
    choose(window, "beam.section", "HW250")
    choose(window, "path.kind", "line")
    type_number(window, "path.line.lift_mm", "8")
    settle(window)


def test_from_the_default_cell_to_a_program_that_is_read_back(window, tmp_path, qapp):  # noqa: PLR0915 - one session, as a person would go through it
    session, actions, mouse = window.session, window.actions_table, Hand(window)
    assert session.result.clearance_met

    use_hw250(window)
    assert session.stale
    type_number(window, "beam.position_xy_mm", "880")
    assert session.document.value("beam.position_xy_mm") == [880.0, -200.0]

    before = session.result
    actions["plan"].trigger()
    assert session.planning
    assert actions["stop"].isEnabled()
    actions["stop"].trigger()
    assert not session.planning
    settle(window)
    assert session.result is before
    assert session.stale
    actions["chinese"].trigger()
    plan(window)
    assert session.result is not before
    assert not session.stale
    assert session.result.problem.workpiece.section.name == "HW250"
    assert session.result.clearance_met

    mouse.click(20, lean_at(window, 20))
    assert session.cursor == 20
    free = session.sequence
    target = lean_at(window, 20) - 4.0
    mouse.move(20, target)
    window.map.pin_hovered()
    wait(lambda: session.answer is not None)
    assert lean_at(window, 20) == pytest.approx(target)
    actions["dark"].trigger()
    held = lean_at(window, 35)
    mouse.drag(35, held, held - 3.0, held - 6.0, held - 8.0)
    settle(window)
    assert lean_at(window, 35) == pytest.approx(held - 8.0)
    assert len(session.document.state.pins) == 2
    pinned = session.sequence
    for _ in range(2):
        actions["undo"].trigger()
    settle(window)
    assert session.sequence is free
    for _ in range(2):
        actions["redo"].trigger()
    settle(window)
    assert np.array_equal(session.sequence.nodes, pinned.nodes)

    actions["compare"].trigger()
    wait(lambda: not session.planning)
    settle(window)
    assert set(session.result.sequences) == set(Scheme)
    assert np.array_equal(session.sequence.nodes, pinned.nodes)
    actions["chinese"].trigger()
    actions["dark"].trigger()
    assert session.look.language == "en"

    play(window)
    target = export(window, tmp_path)
    positions = read_program_file(target).positions.values()
    written = np.array([one.joints_deg for one in positions])
    path = np.degrees(session.sequence.pendant)
    assert len(written) >= len(path)
    missed = [np.abs(written - one).max(axis=1).min() for one in path]
    assert max(missed) <= 0.5e-3 + 1e-9

    person(window).name = str(tmp_path / "work")
    actions["save"].trigger()
    assert not session.document.modified
    kept, state = session.sequence, session.document.state
    assert reopened(window, tmp_path / "work.posopt", state, kept)


def play(window):
    session = window.session
    session.set_cursor(0)
    QTest.keyClick(window.map, Qt.Key.Key_Space)
    playback = window.timeline.playback
    assert playback.playing
    playback.set_speed(4.0)
    wait(lambda: session.place > 0.5)
    QTest.keyClick(window.map, Qt.Key.Key_Space)
    assert not playback.playing
    QTest.keyClick(window.map, Qt.Key.Key_End)
    assert session.cursor == session.waypoints - 1


def export(window, folder):
    window.actions_table["export"].trigger()
    dialog = window._dialogs["export"]
    target = folder / "HW250.LS"
    dialog.form.path.selectAll()
    QTest.keyClicks(dialog.form.path, str(target))
    wait(dialog.export_button.isEnabled)
    assert dialog.exporter.situation.stage is ExportStage.PASSED
    dialog.export_button.click()
    wait(lambda: dialog.exporter.situation.written is not None)
    dialog.close_button.click()
    return target


def reopened(window, path, state, sequence):
    """In this window and in another one the same project gives the same sequence."""
    window.actions_table["new"].trigger()
    wait(lambda: window.session.report is not None)
    assert window.session.document.state != state
    person(window).name = str(path)
    window.actions_table["open"].trigger()
    wait(lambda: window.session.report is not None)
    assert window.session.document.state == state
    assert np.array_equal(window.session.sequence.pendant, sequence.pendant)
    with opened(path.parent, path) as other:
        other.session.start()
        wait(lambda: other.session.report is not None)
        assert other.session.document.state == state
        assert np.array_equal(other.session.sequence.pendant, sequence.pendant)
    return True
