"""What cannot be opened or saved: one sentence with its place, and nothing is lost."""

import os
import shutil
import signal
import sys
from contextlib import contextmanager
from pathlib import Path

import pytest
from PySide6.QtCore import QSettings
from PySide6.QtWidgets import QFileDialog

from posopt_gui.controllers.files import Choice, Files, NoQuestions
from posopt_gui.dialogs.file_questions import FileQuestions
from posopt_gui.document.project_file import load_project, project_bytes, save_project
from solver.catalog.names import resource_folder

posix = pytest.mark.skipif(sys.platform == "win32", reason="needs a POSIX system")


class Person(NoQuestions):
    def __init__(self):
        self.choice, self.name, self.asked = Choice.CANCEL, "", []

    def unsaved(self, name):
        self.asked.append(name)
        return self.choice

    def open_name(self, _folder):
        return self.name

    def save_name(self, _proposal, _suffix):
        return self.name


@pytest.fixture
def files(session, tmp_path, monkeypatch):
    settings = QSettings(str(tmp_path / "settings.ini"), QSettings.Format.IniFormat)
    monkeypatch.setattr(session, "start", lambda: None)
    made = Files(session, settings, Person())
    made.said = []
    session.message.connect(made.said.append)
    yield made
    assert made.ended()


def change(files, value=40.0):
    files._session.document.set_value("settings.safety_distance_mm", value)


def raw(text):
    return lambda path, state: path.write_bytes(text)


def project(change):
    return lambda path, state: path.write_bytes(change(project_bytes(state)))


def folder(path, _state):
    path.mkdir()


def loop(path, _state):
    path.symlink_to(path)


def pipe(path, _state):
    os.mkfifo(path)


def sparse(size):
    def make(path, _state):
        with path.open("wb") as file:
            file.truncate(size)

    return make


CSV = b"x,y,z,nx,ny,nz\n"
REFUSED = {
    "empty.posopt": (raw(b""), "line 1, column 1"),
    "garbage.posopt": (raw(bytes(range(1, 256))), "line"),
    "cut.posopt": (project(lambda data: data[:-40]), "line"),
    "utf16.posopt": (project(lambda data: data.decode().encode("utf-16")), "line 1, column 1"),
    "latin1.posopt": (raw(b'{\n"format": "\xe9"}'), "line 2"),
    "nan.posopt": (project(lambda data: data.replace(b"-200.0", b"NaN", 1)), "NaN"),
    "twice.posopt": (project(lambda data: data.replace(b"{", b'{"pins": [],', 1)), "twice"),
    "newer.posopt": (project(lambda data: data.replace(b'n": 2', b'n": 3', 1)), "version '3'"),
    "unknown.posopt": (project(lambda data: data.replace(b"{", b'{"hue": 1,', 1)), "unknown key"),
    "huge.posopt": (sparse(300 * 2**20), "300 MB"),
    "folder.posopt": (folder, "no file"),
    "loop.posopt": (loop, "cannot be read"),
    "pipe.posopt": (pipe, "no file"),
    "missing.posopt": (lambda path, state: None, "cannot be read"),
    "empty.toml": (raw(b""), "is no cell"),
    "robot.toml": (raw(b"[robot]\n"), "is no cell"),
    "broken.toml": (raw(b"[cell]\nname = \n"), "line 2, column 8"),
    "latin1.toml": (raw(b'[cell]\ntitle = "\xe9"\n'), "line 2, column 10"),
    "huge.toml": (sparse(6 * 2**20), "5 MB"),
    "folder.toml": (folder, "folder"),
    "loop.toml": (loop, "cannot be read"),
    "pipe.toml": (pipe, "no regular file"),
    "word.csv": (raw(b"# frame: beam\n" + CSV + b"0,0,zero,0,0,1\n"), "line 3, column 3"),
    "utf16.csv": (raw((CSV + b"0,0,0,0,0,1\n").decode().encode("utf-16")), "line 1, column 1"),
    "huge.csv": (sparse(65 * 2**20), "bytes"),
    "folder.csv": (folder, "directory"),
    "loop.csv": (loop, "cannot be read"),
    "pipe.csv": (pipe, "no regular file"),
    "twice.json": (raw(b'{"passes": [],\n "passes": []}'), "line 2, column 2"),
    "picture.png": (raw(b"\x89PNG\r\n"), "is no project"),
}


@posix
@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_opened_is_one_sentence_and_keeps_the_work(
    qtbot, files, session, tmp_path, name
):
    make, words = REFUSED[name]
    change(files)
    state = session.document.state
    make(tmp_path / name, state)
    files.open_file(tmp_path / name)
    qtbot.waitUntil(lambda: bool(files.said), timeout=20_000)
    said = files.said[-1]
    assert said.severity == "error"
    assert name in said.text
    assert words in said.text
    assert "\n" not in said.text
    assert len(said.text) < 400
    assert session.document.state is state
    assert session.document.can_undo
    assert (files.path, files.recent, files.ask.asked) == (None, (), [])


@posix
@pytest.mark.skipif(hasattr(os, "geteuid") and os.geteuid() == 0, reason="root may read all")
@pytest.mark.parametrize("suffix", [".posopt", ".toml", ".csv"])
def test_what_may_not_be_read_is_one_sentence(qtbot, files, session, tmp_path, suffix):
    path = tmp_path / f"mine{suffix}"
    path.write_bytes(b"{}")
    path.chmod(0)
    files.open_file(path)
    qtbot.waitUntil(lambda: bool(files.said), timeout=20_000)
    assert "ermission" in files.said[-1].text


@contextmanager
def full_disk(size):
    """Writing beyond a size fails as on a full disk."""
    import resource

    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, handler)


@posix
def test_a_full_disk_keeps_the_old_file_and_the_work(files, session, tmp_path):
    path = tmp_path / "work.posopt"
    files.ask.name = str(path)
    assert files.save()
    whole = path.read_bytes()
    change(files)
    with full_disk(2000):
        assert not files.save()
    assert files.modified
    assert path.read_bytes() == whole
    assert [one.name for one in tmp_path.glob(".posopt-*")] == []
    assert files.said[-1].severity == "error"
    assert "work.posopt: cannot be written" in files.said[-1].text
    assert files.save()
    assert not files.modified


def test_a_folder_that_vanished_keeps_the_work(files, session, tmp_path):
    path = tmp_path / "gone" / "work.posopt"
    path.parent.mkdir()
    files.ask.name = str(path)
    assert files.save()
    change(files)
    shutil.rmtree(path.parent)
    assert not files.save()
    assert files.modified
    assert files.path == path
    assert "does not exist" in files.said[-1].text
    files.ask.choice, files.ask.name = Choice.SAVE, str(path)
    assert not files.may_close()
    assert files.modified


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="writes into /proc")
def test_a_place_that_takes_no_files_keeps_the_work(files):
    change(files)
    files.ask.name = str(Path("/proc") / "work.posopt")
    assert not files.save_as()
    assert files.modified
    assert files.path is None
    assert "cannot be written" in files.said[-1].text


WAYS = {
    "new": lambda files, path: files.new(),
    "open": lambda files, path: files.open(),
    "recent": lambda files, path: files.open_file(path),
    "drop": lambda files, path: files.drop(path),
    "close": lambda files, path: files.may_close(),
}


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("choice", list(Choice))
def test_every_way_out_of_unsaved_work_asks(files, session, tmp_path, way, choice):
    other = tmp_path / "other.posopt"
    save_project(session.document.state.with_value("cell.name", "other"), other)
    change(files)
    state = session.document.state
    kept = tmp_path / "kept.posopt"
    files.ask.choice = choice
    files.ask.open_name = lambda _: str(other)
    files.ask.save_name = lambda *_: str(kept)
    assert WAYS[way](files, other) is (choice is not Choice.CANCEL)
    assert files.ask.asked == ["groove_hw300"]
    if choice is Choice.SAVE:
        assert load_project(kept) == state
    else:
        assert not kept.exists()
    if choice is Choice.CANCEL:
        assert session.document.state is state
        assert files.modified


def test_a_path_that_is_opened_is_taken_like_a_dropped_one(qtbot, files, session):
    files.ask.name = str(resource_folder() / "examples" / "groove_hw300.csv")
    change(files)
    with qtbot.waitSignal(files.path_taken, timeout=20_000):
        assert files.open()
    assert session.document.value("path.file") == "groove_hw300.csv"
    assert session.document.value("settings.safety_distance_mm") == 40.0
    # It is a step that can be undone, so nothing had to be asked.
    assert files.ask.asked == []
    assert files.path is None
    session.document.undo()
    assert session.document.can_undo


def test_a_path_takes_the_place_of_the_path_alone(qtbot, files, session, tmp_path):
    robot = tmp_path / "own.toml"
    robot.write_bytes((resource_folder() / "robots" / "fanuc_m20ia.toml").read_bytes())
    session.document.set_value("robot.model", str(robot))
    path = tmp_path / "other.csv"
    path.write_bytes((resource_folder() / "examples" / "groove_hw300.csv").read_bytes())
    with qtbot.waitSignal(files.path_taken, timeout=20_000):
        assert files.open_file(path)
    assert set(session.document.state.files) == {"own.toml", "other.csv"}


def test_saving_over_a_file_asks_about_the_name_with_its_ending(qtbot, session, tmp_path):
    (tmp_path / "work.posopt").write_bytes(b"old")
    typed = iter([str(tmp_path / "work"), str(tmp_path / "other"), ""])
    asked = []
    questions = FileQuestions(None, session.look)

    def typed_name(*_, **__):
        return next(typed), ""

    def may_replace(path):
        asked.append(path.name)
        return False

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(QFileDialog, "getSaveFileName", typed_name)
        patch.setattr(questions, "may_replace", may_replace)
        assert questions.save_name("work", ".posopt") == str(tmp_path / "other.posopt")
        assert asked == ["work.posopt"]
        assert questions.save_name("work", ".posopt") == ""
    assert (tmp_path / "work.posopt").read_bytes() == b"old"


def test_the_dialog_offers_all_that_can_be_opened(session):
    shown = []

    def chosen(_parent, _title, _folder, kinds):
        shown.append(kinds)
        return "", ""

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(QFileDialog, "getOpenFileName", chosen)
        assert FileQuestions(None, session.look).open_name("") == ""
    for ending in ("posopt", "toml", "csv", "txt", "tsv", "json", "ls", "LS"):
        assert f"*.{ending}" in shown[0]
