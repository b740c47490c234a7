import json
import os
import random
import subprocess
import sys
import time
from pathlib import Path

import pytest
from PySide6.QtCore import QSettings

from posopt_gui.controllers.file_lock import FileLock
from posopt_gui.controllers.files import Files
from posopt_gui.controllers.recovery import Recovery, read_recovered
from posopt_gui.controllers.session import Session
from posopt_gui.document.document import Document
from posopt_gui.document.project_file import project_bytes
from solver.errors import InputError

ROOT = Path(__file__).parents[2]


@pytest.fixture
def window(qtbot, tmp_path, planned_state):
    """Makes windows that share one folder, and ends those that were not ended or killed."""
    made = []

    def make(state=planned_state):
        session = Session(Document(state))
        settings = QSettings(str(tmp_path / "s.ini"), QSettings.Format.IniFormat)
        files = Files(session, settings)
        recovery = Recovery(session, files, tmp_path / "recovery")
        recovery.said = []
        session.message.connect(recovery.said.append)
        made.append((session, files, recovery))
        return session, files, recovery

    yield make
    for session, files, recovery in made:
        recovery.end()
        assert files.ended()
        assert session.close()


def left_behind(recovery, qtbot):
    """Write a copy, then give the lock up without a proper end, as a crash does."""
    recovery.save()
    qtbot.waitUntil(recovery.file.exists, timeout=10_000)
    recovery._pool.wait(5_000)
    data = recovery.file.read_bytes()
    recovery.end()
    recovery.file.parent.mkdir(exist_ok=True)
    recovery.file.write_bytes(data)
    return recovery.file


def change(session, value):
    session.document.set_value("settings.safety_distance_mm", value)


def test_unchanged_work_leaves_nothing(window, tmp_path):
    _, _, recovery = window()
    recovery.save()
    assert not (tmp_path / "recovery").exists()


def test_a_change_is_copied_when_the_person_pauses(qtbot, window):
    session, _, recovery = window()
    recovery._idle.setInterval(20)
    change(session, 41.0)
    qtbot.waitUntil(recovery.file.exists, timeout=10_000)
    found = read_recovered(recovery.file.read_bytes(), "copy")
    assert found.state == session.document.state
    assert found.path is None


def test_changes_without_a_pause_are_copied_all_the_same(qtbot, window):
    session, _, recovery = window()
    recovery._idle.setInterval(3_600_000)
    recovery._interval.setInterval(20)
    change(session, 42.0)
    qtbot.waitUntil(recovery.file.exists, timeout=10_000)


def test_saved_work_takes_its_copy_away(qtbot, window, tmp_path):
    session, files, recovery = window()
    change(session, 43.0)
    recovery.save()
    qtbot.waitUntil(recovery.file.exists, timeout=10_000)
    assert files._save(tmp_path / "work.posopt")
    qtbot.waitUntil(lambda: not recovery.file.exists(), timeout=10_000)


def test_a_proper_end_leaves_nothing(qtbot, window, tmp_path):
    session, _, recovery = window()
    change(session, 44.0)
    recovery.save()
    assert recovery.end()
    assert list((tmp_path / "recovery").iterdir()) == []
    _, _, other = window()
    assert not other.restore()


def test_work_of_a_run_that_did_not_end_is_recovered_with_its_file(qtbot, window, tmp_path):
    session, files, recovery = window()
    assert files._save(tmp_path / "work.posopt")
    change(session, 45.0)
    old = left_behind(recovery, qtbot)
    other, other_files, restored = window()
    assert restored.restore()
    assert other.document.state == session.document.state
    assert other_files.path == tmp_path / "work.posopt"
    assert other_files.modified
    assert restored.said[-1].severity == "warning"
    # The copy of the run before is given up only for a copy of this one.
    qtbot.waitUntil(lambda: not old.exists(), timeout=10_000)
    assert restored.file.exists()


def test_work_of_a_window_that_is_open_is_left_to_it(qtbot, window):
    session, _, recovery = window()
    change(session, 46.0)
    recovery.save()
    qtbot.waitUntil(recovery.file.exists, timeout=10_000)
    other, _, second = window()
    assert not second.restore()
    change(other, 47.0)
    second.save()
    qtbot.waitUntil(second.file.exists, timeout=10_000)
    assert second.file != recovery.file
    found = [read_recovered(one.file.read_bytes(), "a").state for one in (recovery, second)]
    assert found == [session.document.state, other.document.state]


def test_each_window_recovers_another_work(qtbot, window):
    values = []
    for value in (48.0, 49.0):
        session, _, recovery = window()
        change(session, value)
        left_behind(recovery, qtbot)
    for _ in range(2):
        session, _, recovery = window()
        assert recovery.restore()
        values.append(session.document.value("settings.safety_distance_mm"))
    assert sorted(values) == [48.0, 49.0]
    assert not window()[2].restore()


def test_work_of_a_named_project_alone_is_recovered(qtbot, window, tmp_path):
    session, files, recovery = window()
    assert files._save(tmp_path / "a.posopt")
    change(session, 54.0)
    left_behind(recovery, qtbot)
    _, _, other = window()
    assert not other.restore(only=tmp_path / "b.posopt")
    assert other.restore(only=tmp_path / "a.posopt")


def test_a_damaged_copy_is_put_aside_and_said(window, tmp_path):
    folder = tmp_path / "recovery"
    folder.mkdir()
    copies = {"a": b"", "b": b"{", "c": os.urandom(50), "d": b'{"format": "posopt-recovery"}',
              "e": json.dumps({"format": "posopt-recovery", "version": 1, "file": "",
                               "project": "{"}).encode()}  # fmt: skip
    for name, data in copies.items():
        (folder / f"{name}.recovery").write_bytes(data)
    session, _, recovery = window()
    before = session.document.state
    assert not recovery.restore()
    assert session.document.state is before
    assert sorted(one.name for one in folder.glob("*.damaged")) == [
        f"{name}.damaged" for name in copies
    ]
    assert {one.severity for one in recovery.said} == {"warning"}
    assert len(recovery.said) == len(copies)


def test_a_folder_that_cannot_be_written_is_said_once(qtbot, window, tmp_path):
    (tmp_path / "recovery").write_text("a file")
    session, _, recovery = window()
    for value in (51.0, 52.0):
        change(session, value)
        recovery.save()
    assert [one.severity for one in recovery.said] == ["warning"]
    assert not recovery.restore()


def test_copies_are_written_off_the_windows_thread(monkeypatch, qtbot, window):
    import threading

    from posopt_gui.controllers import recovery as module

    threads = []
    write = module.write_atomically

    def noted(path, data):
        threads.append(threading.current_thread())
        write(path, data)

    monkeypatch.setattr(module, "write_atomically", noted)
    session, _, recovery = window()
    change(session, 53.0)
    recovery.save()
    qtbot.waitUntil(recovery.file.exists, timeout=10_000)
    assert threading.main_thread() not in threads


def test_what_is_no_copy_is_one_sentence(planned_state):
    whole = {"format": "posopt-recovery", "version": 1, "file": "/a.posopt",
             "project": project_bytes(planned_state).decode()}  # fmt: skip
    assert read_recovered(json.dumps(whole).encode(), "a").state == planned_state
    wrong = [{**whole, key: value} for key in whole for value in (None, 7, [], {})]
    documents = [one for one in wrong if one["file"] == "/a.posopt"]
    texts = [json.dumps(one) for one in documents]
    for text in (*texts, "[]", "1", "null", "NaN", "[" * 100_000, '"a"'):
        with pytest.raises(InputError) as caught:
            read_recovered(text.encode(), "a")
        assert "\n" not in str(caught.value)


def test_a_lock_has_one_owner(tmp_path):
    path = tmp_path / "a.lock"
    one, other = FileLock(path), FileLock(path)
    assert one.take()
    assert not other.take()
    one.give_back()
    assert not path.exists()
    assert other.take()
    other.give_back()


RUN = """
import sys
from pathlib import Path
from PySide6.QtCore import QCoreApplication, QSettings, QTimer
from posopt_gui.controllers.files import Files
from posopt_gui.controllers.recovery import Recovery
from posopt_gui.controllers.session import Session
from posopt_gui.document.document import Document
from posopt_gui.document.project import ProjectState

application = QCoreApplication([])
folder = Path(sys.argv[1])
session = Session(Document(ProjectState({"cell": {"name": "a"}})))
files = Files(session, QSettings(str(folder / "s.ini"), QSettings.Format.IniFormat))
recovery = Recovery(session, files, folder / "recovery")
session._build = lambda: None
session._timer.stop()
session._timer.timeout.disconnect()
count = 0

def edit():
    global count
    count += 1
    session.document.set_value("cell.name", f"n{count}" * 2000, f"{count}")
    recovery.save()
    if recovery.file.exists() and count > 3:
        print("ready", flush=True)

timer = QTimer()
timer.timeout.connect(edit)
timer.start(1)
application.exec()
"""


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGKILL")
def test_work_of_a_killed_process_is_recovered_whole(qtbot, window, tmp_path):
    instants = random.Random(3)
    for number in range(3):
        command = [sys.executable, "-c", RUN, str(tmp_path)]
        with subprocess.Popen(command, stdout=subprocess.PIPE, cwd=ROOT) as running:
            assert running.stdout is not None
            assert running.stdout.readline().strip() == b"ready"
            time.sleep(instants.uniform(0.0, 0.02))
            running.kill()
        session, _, recovery = window()
        assert recovery.restore(), number
        name = session.document.value("cell.name")
        assert name == name[: len(name) // 2000] * 2000
        assert recovery.end()
