"""Work that is done piece by piece, and what the window leaves for later so that it stays quick."""

import os
import subprocess
import sys
from itertools import pairwise

import pytest
from PySide6.QtCore import QEvent, QObject, QSettings, QTimer
from PySide6.QtTest import QTest
from window_helpers import (
    CELLS,
    Person,
    close_window,
    opened,
    own_data_folder,
    settle,
    wait,
)

from posopt_gui import start
from posopt_gui.views.refresh import Refresh
from posopt_gui.workers.turns import Turns

SMALL = CELLS / "groove_paper.toml"


def test_between_two_pieces_the_event_loop_turns(qapp):
    turns, seen = Turns(), []
    tick = QTimer()
    tick.timeout.connect(lambda: seen.append("loop"))
    tick.start(0)
    for name in "abc":
        turns.ask(name, lambda name=name: seen.append(name))
    wait(lambda: not turns.waiting)
    wait(lambda: seen[-1] == "loop")
    tick.stop()
    assert [one for one in seen if one != "loop"] == ["a", "b", "c"]
    places = [seen.index(name) for name in "abc"]
    assert all("loop" in seen[i:j] for i, j in pairwise(places))


def test_what_is_asked_for_twice_is_done_once_and_what_is_forgotten_never(qapp):
    turns, done = Turns(), []
    turns.ask("a", lambda: done.append("old"))
    turns.ask("a", lambda: done.append("new"))
    turns.ask("b", lambda: done.append("b"))
    turns.forget("b")
    turns.finish()
    QTest.qWait(5)
    assert done == ["new"]
    assert not turns.waiting


def test_a_piece_that_asks_for_another_gets_it(qapp):
    turns, done = Turns(), []
    turns.ask("a", lambda: (done.append("a"), turns.ask("b", lambda: done.append("b"))))
    wait(lambda: done == ["a", "b"])


def test_a_view_that_is_gone_is_not_refreshed(qapp, session):
    view, done = QObject(), []
    Refresh(session, lambda: done.append(1), view).soon()
    view.deleteLater()
    qapp.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    session.turns.finish()
    assert done == []


def test_the_frame_of_the_window_needs_neither_arrays_nor_plots_nor_kernels(tmp_path):
    code = (
        "import sys\n"
        "from PySide6.QtCore import QSettings\n"
        "from posopt_gui import start\n"
        "application = start.application()\n"
        f"settings = QSettings({str(tmp_path / 's.ini')!r}, QSettings.Format.IniFormat)\n"
        "window = start.make_window(None, None, None, settings)\n"
        "window.show()\n"
        "application.processEvents()\n"
        "heavy = {'numpy', 'numba', 'scipy', 'pyqtgraph', 'OpenGL', 'trimesh'}\n"
        "print(sorted(heavy & set(sys.modules)))\n"
        "window.close()\n"
    )
    environment = {**os.environ, "XDG_DATA_HOME": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=False
    )
    assert done.stdout.strip() == "[]", done.stderr


@pytest.fixture(scope="module")
def shared(qapp, tmp_path_factory):
    with opened(tmp_path_factory.mktemp("window"), SMALL) as made:
        made.session.start()
        wait(lambda: made.session.report is not None)
        wait(lambda: made.scene.drawn or made.scene.canvas is None)
        yield made


@pytest.fixture
def drawings(shared, monkeypatch):
    """How often the 3D view is drawn."""
    canvas, done = shared.scene.canvas, []
    if canvas is None:
        pytest.skip("no OpenGL here")
    settle(shared)
    QTest.qWait(50)
    draw = canvas._draw
    monkeypatch.setattr(canvas, "_draw", lambda size: (done.append(1), draw(size)))
    return done


def test_painting_the_map_draws_the_3d_view_no_second_time(shared, drawings):
    shared.map.canvas.setXRange(3.0, 20.0, padding=0.0)
    QTest.qWait(50)
    shared.map.canvas.fit()
    shared.tabs.setCurrentIndex(1)
    QTest.qWait(50)
    shared.tabs.setCurrentIndex(0)
    assert drawings == []


def test_many_changes_of_the_place_within_a_turn_draw_the_3d_view_once(shared, drawings):
    for place in (3.0, 4.0, 5.5, 6.0):
        shared.session.set_place(place)
    wait(lambda: drawings)
    QTest.qWait(50)
    assert len(drawings) == 1


def test_while_the_line_is_dragged_only_the_map_follows_at_once(shared, monkeypatch):
    session, curves = shared.session, shared.curves
    lean = float(session.sequence.angles[20, 0])
    before = curves._plan
    answers = []
    session.result_changed.connect(lambda: answers.append(float(shared.map.canvas.line[20])))
    session.preview_pin(20, lean - 0.05)
    wait(lambda: answers)
    assert curves._plan is before
    assert not session.turns.waiting
    # Where the hand rests all follow.
    wait(lambda: curves._plan is not before)
    session.end_preview()
    settle(shared)
    assert curves._plan.joints == pytest.approx(before.joints)


def test_a_window_that_is_closed_while_its_panels_are_built_ends(qapp, tmp_path):
    settings = QSettings(str(tmp_path / "settings.ini"), QSettings.Format.IniFormat)
    with own_data_folder(tmp_path):
        window = start.make_window(str(SMALL), None, None, settings)
    window.files.ask = Person()
    window.show()
    ready = []
    window.ready.connect(lambda: ready.append(1))
    start.begin(window)
    wait(lambda: hasattr(window, "map"))
    assert ready == []
    session = window.session
    assert close_window(window)
    QTest.qWait(20)
    assert ready == []
    assert not session.turns.waiting
