"""What a window begins with: the named file, a path, what a killed run left; and its guide."""

import os
import signal
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import pytest
from PySide6.QtCore import QSettings, QUrl
from window_helpers import (
    CELLS,
    EXAMPLES,
    Person,
    close_window,
    make_window,
    opened,
    own_data_folder,
    plan,
    settle,
    type_number,
)
from window_helpers import (
    wait as wait_long,
)

from posopt_gui import start
from posopt_gui.dialogs.path_dialog import PathDialog
from posopt_gui.document.project_file import save_project

ROOT = Path(__file__).parents[2]
SMALL = CELLS / "groove_paper.toml"
DISTANCE = "settings.safety_distance_mm"


def wait(condition):
    wait_long(condition, 60.0)


def left_behind(folder, value, project=None):
    """Leave unsaved work as a crash does: a copy whose lock nobody holds."""
    window = make_window(folder, project or SMALL)
    window.session.document.set_value(DISTANCE, value)
    window.recovery.save()
    wait(window.recovery.file.exists)
    data, file = window.recovery.file.read_bytes(), window.recovery.file
    assert close_window(window)
    kept = file.with_name(f"{value}.recovery")
    kept.write_bytes(data)
    return kept


@contextmanager
def started(folder, file=None):
    """A window as the command starts it, and what it said until its panels were there."""
    settings = QSettings(str(folder / "settings.ini"), QSettings.Format.IniFormat)
    named = str(file) if file is not None else None
    with own_data_folder(folder):
        window = start.make_window(named, None, None, settings)
    window.files.ask = Person()
    said, ready = [], []
    window.session.message.connect(said.append)
    window.ready.connect(lambda: ready.append(1))
    window.show()
    start.begin(window, named)
    wait(lambda: ready)
    settle(window)
    window.hints.close_all()
    try:
        yield window, [one.text for one in said]
    finally:
        assert close_window(window)


def test_a_named_cell_is_opened_and_left_over_work_stays(qapp, tmp_path):
    kept = left_behind(tmp_path, 43.0)
    with started(tmp_path, SMALL) as (window, said):
        assert window.session.document.value(DISTANCE) != 43.0
        assert not window.files.modified
        assert kept.exists()
        assert [one for one in said if "Unsaved work of groove_paper is kept" in one]
        assert "Unsaved work of groove_paper is kept" in window.status.words.text()
    assert kept.exists()
    with started(tmp_path) as (window, _):
        assert window.session.document.value(DISTANCE) == 43.0
        assert window.files.modified
        assert "recovered" in window.status.words.text()


def test_a_named_project_gets_its_own_work_and_no_other(qapp, tmp_path):
    from posopt_gui.controllers.files import state_of_argument

    state, _ = state_of_argument(str(SMALL))
    mine, other = tmp_path / "mine.posopt", tmp_path / "other.posopt"
    for path in (mine, other):
        save_project(state, path)
    kept = left_behind(tmp_path, 47.0, other)
    with started(tmp_path, mine) as (window, said):
        assert window.windowTitle().startswith("mine ")
        assert window.session.document.state == state
        assert kept.exists()
        assert [one for one in said if "Unsaved work of other is kept" in one]
    with started(tmp_path, other) as (window, said):
        assert window.session.document.value(DISTANCE) == 47.0
        assert window.windowTitle().startswith("other*")
        assert [one for one in said if "Unsaved work of other was recovered" in one]


def test_a_named_path_is_taken_into_the_default_cell_and_planned(qapp, tmp_path):
    path = tmp_path / "mine.csv"
    path.write_bytes((EXAMPLES / "groove_hw300.csv").read_bytes())
    with started(tmp_path, path) as (window, _):
        wait(lambda: window.session.document.value("path.file") == "mine.csv")
        settle(window)
        assert window.session.result is not None
        assert not window.session.stale
        assert len(window.session.result.problem.toolpath) == 50
        window.session.document.undo()
        assert window.session.document.value("path.file") == "groove_hw300.csv"


def test_a_named_path_with_unknown_columns_asks_for_them(qapp, tmp_path):
    path = tmp_path / "mine.csv"
    path.write_text("east;north;up\n1;2;3\n4;5;6\n", encoding="utf-8")
    with started(tmp_path, path) as (window, _):
        wait(lambda: window.findChildren(PathDialog))
        (dialog,) = window.findChildren(PathDialog)
        assert dialog.isVisible()
        assert dialog._preview.titles == ("east", "north", "up")
        assert window.session.document.value("path.file") == "groove_hw300.csv"


@pytest.mark.parametrize(
    ("name", "words"),
    [("gone.posopt", "cannot be read"), ("gone.toml", "does not exist"),
     ("gone.csv", "there is no such file"), ("no_such_cell", "no cell is called")],
)  # fmt: skip
def test_a_named_file_that_is_not_there_ends_with_a_sentence(tmp_path, name, words):
    done = subprocess.run(
        [sys.executable, "-m", "posopt_gui.app", name if "cell" in name else str(tmp_path / name)],
        cwd=ROOT,
        env={**os.environ, "XDG_DATA_HOME": str(tmp_path), "XDG_CONFIG_HOME": str(tmp_path)},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 2
    assert words in done.stderr
    assert len(done.stderr.splitlines()) == 1


RUN = """
import sys
from contextlib import contextmanager
from pathlib import Path
from PySide6.QtCore import QSettings, QTimer
from posopt_gui import start
from posopt_gui.dialogs.path_dialog import PathDialog

application = start.application()
folder, cell, organization, name = sys.argv[1:]
application.setOrganizationName(organization)
application.setApplicationName(name)
settings = QSettings(str(Path(folder) / "settings.ini"), QSettings.Format.IniFormat)
window = start.make_window(cell, None, None, settings)
window.show()

def edit():
    window.session.document.set_value("settings.safety_distance_mm", 46.0)
    window.session.pin(3, 0.05)
    window.recovery.save()
    tell()

def tell():
    if window.recovery.file.exists():
        print("ready", flush=True)
    else:
        QTimer.singleShot(10, tell)

window.ready.connect(edit)
start.begin(window, cell)
application.exec()
"""


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGKILL")
def test_the_work_of_a_window_that_was_killed_is_there_at_the_next_start(qapp, tmp_path):
    names = (qapp.organizationName(), qapp.applicationName())
    command = [sys.executable, "-c", RUN, str(tmp_path), str(SMALL), *names]
    environment = {**os.environ, "XDG_DATA_HOME": str(tmp_path)}
    with subprocess.Popen(command, stdout=subprocess.PIPE, cwd=ROOT, env=environment) as running:
        assert running.stdout is not None
        line = running.stdout.readline()
        while line and line.strip() != b"ready":
            line = running.stdout.readline()
        running.send_signal(signal.SIGKILL)
    assert running.returncode == -signal.SIGKILL
    with started(tmp_path) as (window, said):
        assert window.session.document.value(DISTANCE) == 46.0
        assert [one.waypoint for one in window.session.document.state.pins] == [3]
        assert window.files.modified
        assert [one for one in said if "was recovered" in one]


def test_planning_wrong_inputs_keeps_the_plan_dimmed_and_says_what_is_wrong(qapp, tmp_path):
    with opened(tmp_path, SMALL) as window:
        session = window.session
        plan(window)
        result, sequence = session.result, session.sequence
        type_number(window, DISTANCE, "-5")
        wait(lambda: session.problem_error is not None)
        told = []
        session.message.connect(told.append)
        for _ in range(2):
            window.actions_table["plan"].trigger()
            settle(window)
        assert session.result is result
        assert session.sequence is sequence
        assert session.stale
        assert session.plan_error is None
        sentence = told[-1].text
        assert sentence.startswith("Limits and clearance, Safety distance: ")
        assert "cell.toml" not in sentence
        for shown in (
            window.status.words.text(),
            window.map.overlays.notice.text,
            window.inspector.trouble.text(),
        ):
            assert sentence in shown
        items = window.map.canvas.getPlotItem().items
        assert any(item.opacity() < 1.0 for item in items)
        type_number(window, DISTANCE, "20")
        wait(lambda: session.problem is not None)
        plan(window)
        assert not session.stale
        assert session.result is not result
        assert sentence not in window.status.words.text()


def test_the_guide_opens_in_the_windows_language(qapp, tmp_path):
    with opened(tmp_path, SMALL) as window:
        window.session.look.set_language("en")
        window.session.turns.finish()
        window.actions_table["guide"].trigger()
        page = window.guide.page
        assert page.source().fileName() == "window.md"
        assert "The window" in page.toPlainText()
        window.session.look.set_language("zh_CN")
        window.session.turns.finish()
        assert page.source().fileName() == "window_zh_CN.md"
        assert "窗口" in page.toPlainText()
        # A line of the file that is broken between Chinese words is none in the page.
        assert "启动（在源码目录中为" in page.toPlainText()
        page.anchorClicked.emit(QUrl("robot_program.md#the-first-run"))
        assert page.source().fileName() == "robot_program.md"
        wait(lambda: page.verticalScrollBar().value() > 0)
        # A page that is not installed leaves the guide where it is.
        page.anchorClicked.emit(QUrl("../NO_SUCH.md"))
        assert page.source().fileName() == "robot_program.md"
        window.guide.close()
