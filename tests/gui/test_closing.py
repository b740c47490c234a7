"""Closing the window in the middle of something: no crash, nothing left running, nothing lost."""

import gc
import os
import sys
from pathlib import Path

import pytest
from PySide6.QtCore import QCoreApplication, QEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMenu
from window_helpers import (
    CELLS,
    Hand,
    close_window,
    make_window,
    opened,
    person,
    plan,
    settle,
    wait,
)

from posopt_gui.controllers.files import Choice
from posopt_gui.document.project_file import load_project
from posopt_gui.workers.threads import JobThreads
from solver.model.settings import Scheme

SMALL = CELLS / "groove_paper.toml"


def begin_nothing(window):
    pass


def begin_planning(window):
    window.session.start()
    assert window.session.planning


def begin_reading(window):
    window.session.document.set_value("settings.safety_distance_mm", 41.0)


def begin_comparing(window):
    plan(window)
    window.actions_table["compare"].trigger()
    window.map.header.set_lines([one.value for one in Scheme])
    window.tabs.setCurrentWidget(window.results)
    window.results.tabs.setCurrentIndex(1)


def begin_dragging(window):
    plan(window)
    mouse = Hand(window)
    mouse.move(20, 0.0)
    for lean in (0.1, 0.12, 0.14):
        window.session.preview_pin(20, lean)


def begin_drafting(window):
    plan(window)
    window.actions_table["export"].trigger()
    QTest.qWait(150)


def begin_playing(window):
    plan(window)
    window.timeline.playback.play()
    QTest.qWait(50)


BEGINNINGS = (
    begin_nothing, begin_planning, begin_reading, begin_comparing, begin_dragging, begin_drafting,
    begin_playing,
)  # fmt: skip


@pytest.mark.parametrize("begin", BEGINNINGS, ids=lambda one: one.__name__.removeprefix("begin_"))
def test_closing_in_the_middle_of_something_ends_it(qapp, tmp_path, begin):
    window = make_window(tmp_path, SMALL)
    told = []
    begin(window)
    session = window.session
    session.result_changed.connect(lambda: told.append("result"))
    session.check_changed.connect(lambda: told.append("check"))
    session.message.connect(lambda message: told.append(message.text))
    person(window).choice = Choice.DISCARD
    assert window.close()
    QTest.qWait(20)
    assert told == []
    assert not session._plans.busy
    # A kernel that is being loaded cannot be stopped; on a busy machine that takes its time.
    pools = [*window.findChildren(JobThreads), *session.findChildren(JobThreads)]
    wait(lambda: all(pool.wait(0) for pool in pools))
    assert told == []
    assert close_window(window)


def test_a_window_that_is_closed_before_its_panels_are_there_ends(qapp, tmp_path):
    from PySide6.QtCore import QSettings
    from window_helpers import Person, own_data_folder

    from posopt_gui import start

    settings = QSettings(str(tmp_path / "settings.ini"), QSettings.Format.IniFormat)
    with own_data_folder(tmp_path):
        window = start.make_window(str(SMALL), None, None, settings)
    window.files.ask = Person()
    window.show()
    window.session.start()
    assert close_window(window)


@pytest.mark.parametrize("choice", list(Choice))
def test_closing_with_unsaved_work_does_what_the_person_says(qapp, tmp_path, choice):
    window = make_window(tmp_path, SMALL)
    file = tmp_path / "kept.posopt"
    window.session.document.set_value("settings.safety_distance_mm", 41.0)
    state = window.session.document.state
    person(window).choice, person(window).name = choice, str(file)
    assert window.close() is (choice is not Choice.CANCEL)
    assert window.isVisible() is (choice is Choice.CANCEL)
    assert person(window).asked[0] == "unsaved"
    assert file.exists() is (choice is Choice.SAVE)
    if choice is Choice.SAVE:
        assert load_project(file) == state
    if choice is Choice.CANCEL:
        # It goes on as if nothing had been asked.
        plan(window)
        assert window.session.result is not None
    assert close_window(window)


def threads():
    """Threads of this process, those of libraries included."""
    return len(list(Path("/proc/self/task").iterdir()))


def memory():
    """Resident memory of this process [bytes]."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")


def widgets():
    """Number of widgets; the plots' own menus have no parent and stay until the process ends."""
    return sum(not isinstance(one, QMenu) for one in QApplication.allWidgets())


def open_plan_and_close(folder):
    window = make_window(folder, SMALL)
    plan(window)
    assert close_window(window)
    del window
    gc.collect()
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)


@linux
@pytest.mark.long
def test_the_threads_and_widgets_of_a_closed_window_are_gone(qapp, tmp_path):
    open_plan_and_close(tmp_path)
    before, shown = threads(), widgets()
    open_plan_and_close(tmp_path)
    wait(lambda: threads() <= before)
    assert widgets() <= shown


@linux
@pytest.mark.long
def test_200_plans_grow_neither_memory_nor_threads_nor_items(qapp, tmp_path):
    with opened(tmp_path) as window:

        def cycle(number):
            document = window.session.document
            value = 40.0 + number % 7
            document.set_value("settings.safety_distance_mm", value)
            plan(window)
            window.session.set_cursor(number % 50)
            QTest.qWait(5)
            document.undo()
            settle(window)

        for number in range(20):
            cycle(number)
        gc.collect()
        canvas = window.scene.canvas
        before = memory(), threads(), len(canvas.items), len(window.map.canvas.scene().items())
        shown = widgets()
        for number in range(200):
            cycle(number)
        gc.collect()
        print(f"200 plans: memory grew by {(memory() - before[0]) / 1e6:.1f} MB")
        assert memory() - before[0] < 60e6
        assert threads() <= before[1] + 2
        assert len(canvas.items) <= before[2]
        assert len(window.map.canvas.scene().items()) <= before[3]
        assert widgets() <= shown
