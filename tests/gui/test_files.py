import json
from pathlib import Path

import pytest
from PySide6.QtCore import QSettings
from PySide6.QtGui import QImage

from posopt_gui.controllers.files import (
    RECENT_KEY,
    RECENT_LIMIT,
    Choice,
    Files,
    NoQuestions,
    state_of_argument,
    with_suffix,
)
from posopt_gui.document.project_file import load_project, save_project
from solver.catalog.names import resource_folder
from solver.errors import InputError


class Answers(NoQuestions):
    """A person who answers as told, and remembers what was asked."""

    def __init__(self, choice=Choice.CANCEL, name=""):
        self.choice, self.name, self.asked = choice, name, []

    def unsaved(self, name):
        self.asked.append(("unsaved", name))
        return self.choice

    def open_name(self, folder):
        self.asked.append(("open", folder))
        return self.name

    def save_name(self, proposal, suffix):
        self.asked.append(("save", proposal, suffix))
        return self.name


@pytest.fixture
def settings(tmp_path):
    return QSettings(str(tmp_path / "settings.ini"), QSettings.Format.IniFormat)


@pytest.fixture
def files(session, settings, monkeypatch):
    # What is opened is planned elsewhere; here it is only counted.
    starts = []
    monkeypatch.setattr(session, "start", lambda: starts.append(1))
    made = Files(session, settings, Answers())
    made.starts, made.said = starts, []
    session.message.connect(made.said.append)
    yield made
    assert made.ended()


def change(files, value=40.0):
    files._session.document.set_value("settings.safety_distance_mm", value)


def test_a_saved_project_is_opened_again_as_it_was(files, session, tmp_path):
    change(files)
    state = session.document.state
    files.ask.name = str(tmp_path / "work")
    assert files.save()
    assert files.path == tmp_path / "work.posopt"
    assert not files.modified
    assert files.new()
    assert session.document.state != state
    assert files.open_file(tmp_path / "work.posopt")
    assert session.document.state == state
    assert not files.modified
    assert files.name == "work"
    assert len(files.starts) == 2


def test_saving_a_named_project_asks_nothing(files, tmp_path):
    files.ask.name = str(tmp_path / "work.posopt")
    assert files.save()
    asked = len(files.ask.asked)
    change(files)
    assert files.save()
    assert len(files.ask.asked) == asked
    assert load_project(files.path).value("settings.safety_distance_mm") == 40.0


@pytest.mark.parametrize("choice", list(Choice))
def test_unsaved_work_is_left_only_as_the_person_says(files, session, tmp_path, choice):
    change(files)
    files.ask.choice, files.ask.name = choice, str(tmp_path / "kept.posopt")
    state = session.document.state
    assert files.new() is (choice is not Choice.CANCEL)
    assert files.ask.asked[0] == ("unsaved", "groove_hw300")
    assert (tmp_path / "kept.posopt").exists() is (choice is Choice.SAVE)
    assert (session.document.state == state) is (choice is Choice.CANCEL)


def test_a_save_that_is_given_up_or_fails_keeps_the_work(files, session, tmp_path):
    change(files)
    files.ask.choice = Choice.SAVE
    for name in ("", str(tmp_path / "none" / "work.posopt")):
        files.ask.name = name
        assert not files.may_close()
        assert files.modified
    assert files.said[-1].severity == "error"


def test_unmodified_work_is_left_without_a_question(files):
    assert files.may_close()
    assert files.new()
    assert files.ask.asked == []


def test_the_title_follows_name_and_changes(qtbot, files, tmp_path):
    assert files.name == "groove_hw300"
    with qtbot.waitSignal(files.title_changed):
        change(files)
    assert files.modified
    files.ask.name = str(tmp_path / "work.posopt")
    with qtbot.waitSignal(files.title_changed):
        files.save()
    assert (files.name, files.modified) == ("work", False)
    files._session.document.undo()
    assert files.modified


def test_recent_files_are_the_last_ten_without_repetition(files, settings, tmp_path, session):
    paths = [tmp_path / f"{number}.posopt" for number in range(RECENT_LIMIT + 2)]
    for path in (*paths, paths[5]):
        save_project(session.document.state, path)
        assert files.open_file(path)
    assert files.recent[0] == paths[5]
    assert len(files.recent) == len(set(files.recent)) == RECENT_LIMIT
    settings.sync()
    again = QSettings(settings.fileName(), QSettings.Format.IniFormat)
    assert Files(session, again).recent == files.recent
    files.clear_recent()
    assert files.recent == ()


@pytest.mark.parametrize("text", ["", "no json", "{}", "[1, null]", '"a"', "[[]]"])
def test_a_damaged_recent_list_is_an_empty_one(files, settings, text):
    settings.setValue(RECENT_KEY, text)
    assert files.recent == ()


def test_a_recent_file_that_is_gone_is_forgotten(files, session, tmp_path):
    path = tmp_path / "a.posopt"
    save_project(session.document.state, path)
    assert files.open_file(path)
    path.unlink()
    assert not files.open_file(path)
    assert path not in files.recent


def test_what_cannot_be_read_keeps_the_old_project(files, session, tmp_path):
    state = session.document.state
    change(files)
    changed = session.document.state
    assert changed != state
    for name, data in (
        ("a.posopt", b"{"), ("b.posopt", b""), ("c.toml", b"[["), ("d.toml", b"\xff\xfe"),
        ("e.exe", b"MZ"), ("f", b""),
    ):  # fmt: skip
        path = tmp_path / name
        path.write_bytes(data)
        assert not files.drop(path)
        assert session.document.state is changed
        assert files.said[-1].severity == "error"
        assert "\n" not in files.said[-1].text
        assert "Traceback" not in files.said[-1].text
    # Nothing was to be lost, so nothing was asked.
    assert files.ask.asked == []


def test_a_dropped_cell_is_opened_without_being_the_project_file(files, session):
    assert files.drop(str(resource_folder() / "cells" / "zigzag_hw250.toml"))
    assert files.path is None
    assert files.name == "zigzag_hw250"
    assert not files.modified
    assert set(session.document.state.files) == {"zigzag_hw250.csv"}


def test_a_dropped_path_becomes_the_projects_path_in_one_step(qtbot, files, session, tmp_path):
    own = resource_folder() / "examples" / "groove_hw300.csv"
    path = tmp_path / "Other Path.CSV"
    path.write_bytes(own.read_bytes())
    before = session.document.state
    with qtbot.waitSignal(session.state_changed, timeout=20_000):
        assert files.drop(path)
    assert session.document.value("path.file") == "Other Path.CSV"
    # The frame was said of the file before; this one states its own.
    assert session.document.value("path.frame") is None
    assert len(session.document.state.problem().toolpath) == 50
    session.document.undo()
    assert session.document.state == before


@pytest.mark.parametrize("data", [b"", b"a,b\n1,2\n", b"x,y,z\n1,2\n", b"\x00\x01", b"{}"])
@pytest.mark.parametrize("suffix", [".csv", ".json", ".ls"])
def test_a_malformed_path_is_refused_and_offered_for_a_preview(
    qtbot, files, session, tmp_path, data, suffix
):
    path = tmp_path / f"path{suffix}"
    path.write_bytes(data)
    before = session.document.state
    with qtbot.waitSignal(files.path_refused, timeout=20_000) as caught:
        assert files.drop(path)
    assert caught.args[0] == path
    assert isinstance(caught.args[1], InputError)
    assert session.document.state is before
    assert files.said[-1].severity == "error"


def test_a_path_that_is_read_while_another_project_opens_is_dropped(qtbot, files, session):
    files.drop(resource_folder() / "examples" / "zigzag_hw250.csv")
    files.new()
    state = session.document.state
    assert files.ended()
    qtbot.wait(1)
    assert session.document.state is state


def test_a_project_that_holds_what_no_file_can_is_not_marked_saved(files, tmp_path):
    change(files, float("inf"))
    files.ask.name = str(tmp_path / "work.posopt")
    assert not files.save()
    assert files.modified
    assert not (tmp_path / "work.posopt").exists()


def test_a_window_begins_with_a_project_a_cell_or_the_default(tmp_path, planned_state):
    path = tmp_path / "a.posopt"
    save_project(planned_state, path)
    assert state_of_argument(str(path)) == (planned_state, path)
    assert state_of_argument(None) == (planned_state, None)
    assert state_of_argument("groove_paper")[0].value("cell.name") == "groove_paper"
    with pytest.raises(InputError):
        state_of_argument("nowhere.posopt")


def test_nobody_to_ask_loses_nothing(session, settings):
    files = Files(session, settings)
    session.document.set_value("settings.safety_distance_mm", 41.0)
    assert not files.may_close()
    assert not files.open()
    assert not files.save()
    assert files.ended()


def test_a_suffix_is_added_and_never_replaced():
    assert with_suffix(Path("a.b"), ".posopt") == Path("a.b.posopt")
    assert with_suffix(Path("a.POSOPT"), ".posopt") == Path("a.POSOPT")


def test_the_report_is_written_with_the_given_pictures(qtbot, planned, settings, tmp_path):
    files = Files(planned, settings, Answers(name=str(tmp_path / "report")))
    image = QImage(6, 4, QImage.Format.Format_RGB32)
    image.fill(0)
    with qtbot.waitSignal(files.report_saved, timeout=30_000) as caught:
        assert files.save_report({"map": image})
    assert caught.args[0] == tmp_path / "report.html"
    page = caught.args[0].read_text("utf-8")
    assert page.startswith("<!DOCTYPE html>")
    assert page.count("<img") == 1
    assert json.loads(str(settings.value(RECENT_KEY, "[]", type=str))) == []
    assert files.ended()


def test_without_a_plan_there_is_no_report(files):
    assert not files.save_report({})
    assert files.ask.asked == []
