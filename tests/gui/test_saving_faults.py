"""Files that were overwritten or left half written: each fault has its test."""

import sys

import pytest
from map_mouse import LEFT
from PySide6.QtCore import QTimer
from PySide6.QtGui import QColor, QImage
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMessageBox
from window_helpers import CELLS, Person, close_window, make_window, person, press, wait

from posopt_gui import start
from posopt_gui.controllers.questions import Clash
from posopt_gui.dialogs.file_questions import FileQuestions
from posopt_gui.document.project_file import load_project
from posopt_gui.views.picture_file import write_picture
from solver.errors import InputError

SAFETY = "settings.safety_distance_mm"


class Careful(Person):
    """A person who is asked about a file that another window has written."""

    clash = Clash.CANCEL

    def written_meanwhile(self, name):
        self.asked.append(f"written meanwhile: {name}")
        return self.clash


@pytest.fixture
def two(tmp_path):
    """Two windows on one project."""
    one = make_window(tmp_path, CELLS / "groove_paper.toml")
    person(one).name = str(tmp_path / "shared.posopt")
    assert one.files.save_as()
    other = make_window(tmp_path, tmp_path / "shared.posopt")
    for window in (one, other):
        window.files.ask = Careful()
    yield one, other
    assert close_window(other)
    assert close_window(one)


def save_with_keys(window, value):
    window.session.document.set_value(SAFETY, value, "Safety distance")
    press_save(window)


def press_save(window):
    window.activateWindow()
    wait(window.isActiveWindow)
    press(window, "Ctrl+S")


def saved_distance(path):
    return load_project(path).cell["settings"]["safety_distance_mm"]


def test_the_second_window_overwrote_the_first_ones_work_unasked(two, tmp_path):
    one, other = two
    file = tmp_path / "shared.posopt"
    save_with_keys(one, 41.0)
    save_with_keys(one, 42.0)
    assert person(one).asked == []
    save_with_keys(other, 43.0)
    assert person(other).asked == ["written meanwhile: shared.posopt"]
    assert saved_distance(file) == 42.0
    assert other.session.document.modified
    person(other).clash = Clash.OTHER_NAME
    person(other).name = str(tmp_path / "mine.posopt")
    press_save(other)
    assert (saved_distance(file), saved_distance(tmp_path / "mine.posopt")) == (42.0, 43.0)
    assert other.files.name == "mine"


def test_a_file_that_may_be_replaced_is_asked_about_once(two, tmp_path):
    one, other = two
    save_with_keys(one, 42.0)
    person(other).clash = Clash.REPLACE
    save_with_keys(other, 43.0)
    save_with_keys(other, 44.0)
    assert person(other).asked == ["written meanwhile: shared.posopt"]
    assert saved_distance(tmp_path / "shared.posopt") == 44.0
    # Who comes back to a file that is gone writes it again, and overwrites nothing.
    (tmp_path / "shared.posopt").unlink()
    save_with_keys(one, 45.0)
    assert person(one).asked == []
    assert saved_distance(tmp_path / "shared.posopt") == 45.0


@pytest.mark.parametrize(
    ("words", "answer"),
    [("Save as…", Clash.OTHER_NAME), ("Replace", Clash.REPLACE), ("Cancel", Clash.CANCEL)],
)
def test_the_question_about_a_changed_file_has_three_answers(session, words, answer):
    seen = []

    def click():
        box = QApplication.activeModalWidget()
        assert isinstance(box, QMessageBox)
        seen.append(box.text())
        QTest.mouseClick(next(one for one in box.buttons() if one.text() == words), LEFT)

    QTimer.singleShot(0, click)
    assert FileQuestions(None, session.look).written_meanwhile("shared.posopt") is answer
    assert seen[0].startswith("shared.posopt was changed by another window or program")


@pytest.fixture
def full_disk():
    """No file can grow beyond 100 bytes, as on a disk that is full."""
    resource = pytest.importorskip("resource")
    import signal

    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, before[1]))
    yield
    resource.setrlimit(resource.RLIMIT_FSIZE, before)
    signal.signal(signal.SIGXFSZ, handler)


def picture(colour):
    image = QImage(40, 30, QImage.Format.Format_RGB32)
    for x in range(40):
        for y in range(30):
            image.setPixelColor(x, y, QColor((x * 37 + y * 91) % 256, (x * y) % 256, colour))
    return image


@pytest.mark.skipif(sys.platform.startswith("win"), reason="the limit of a file's size is POSIX")
def test_a_picture_was_left_half_written_on_a_full_disk(qapp, tmp_path, full_disk, capfd):
    file = tmp_path / "cell.png"
    with pytest.raises(InputError, match="cannot be written"):
        write_picture(picture(9), file)
    assert list(tmp_path.iterdir()) == []
    assert "libpng" not in capfd.readouterr().err


def test_a_picture_that_cannot_be_written_leaves_the_one_before(qapp, tmp_path):
    file = tmp_path / "cell.png"
    write_picture(picture(9), file)
    assert QImage(str(file)) == picture(9)
    file.with_suffix(".xyz").write_bytes(b"kept")
    with pytest.raises(InputError, match="cannot be written"):
        write_picture(picture(20), file.with_suffix(".xyz"))
    assert file.with_suffix(".xyz").read_bytes() == b"kept"


def test_what_is_written_while_a_named_project_is_read_is_asked_about(two, tmp_path, monkeypatch):
    path = tmp_path / "shared.posopt"
    read = start.state_of_argument

    def overtaken(file):
        found = read(file)
        path.write_text(path.read_text("utf-8") + "\n", "utf-8")
        return found

    monkeypatch.setattr(start, "state_of_argument", overtaken)
    third = make_window(tmp_path, path)
    third.files.ask = Careful()
    save_with_keys(third, 41.0)
    assert third.files.ask.asked == ["written meanwhile: shared.posopt"]
    assert close_window(third)
