"""The whole window as the product makes it, and the hands of a person who works with it."""

from __future__ import annotations

import logging
import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from map_mouse import LEFT, PLAIN, Mouse
from PySide6.QtCore import QCoreApplication, QEvent, QMimeData, QPoint, QPointF, QSettings, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent, QKeySequence
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget

from posopt_gui import start
from posopt_gui.controllers.files import Choice, NoQuestions
from posopt_gui.main_window import MainWindow
from posopt_gui.views.field_widgets import FieldRow
from posopt_gui.workers.jobs import LOG
from solver.catalog.names import resource_folder

CELLS = resource_folder() / "cells"
EXAMPLES = resource_folder() / "examples"


class Person(NoQuestions):
    """A person who answers the questions of a window as told, and remembers them."""

    def __init__(self, choice: Choice = Choice.DISCARD) -> None:
        self.choice, self.name = choice, ""
        self.asked: list[str] = []

    def unsaved(self, _name: str) -> Choice:
        self.asked.append("unsaved")
        return self.choice

    def open_name(self, _folder: str) -> str:
        self.asked.append("open")
        return self.name

    def save_name(self, _proposal: str, _suffix: str) -> str:
        self.asked.append("save")
        return self.name


def wait(condition: Callable[[], Any], seconds: float = 600.0) -> None:
    """Let the window live until something holds; the time limit is no statement about speed."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "it did not happen"
        QTest.qWait(2)


@contextmanager
def own_data_folder(folder: Path) -> Iterator[None]:
    """Keep what the product writes for its user in a folder of the test."""
    before = os.environ.get("XDG_DATA_HOME")
    os.environ["XDG_DATA_HOME"] = str(folder)
    try:
        yield
    finally:
        if before is None:
            del os.environ["XDG_DATA_HOME"]
        else:
            os.environ["XDG_DATA_HOME"] = before


def make_window(folder: Path, file: str | Path | None = None, *, hints: bool = False) -> MainWindow:
    """A window with all its panels on screen; nothing is planned yet.

    Settings and recovery lie in `folder`.
    """
    start.application()
    settings = QSettings(str(folder / "settings.ini"), QSettings.Format.IniFormat)
    with own_data_folder(folder):
        window = start.make_window(str(file) if file is not None else None, None, None, settings)
    window.files.ask = Person()
    window.resize(1100, 760)
    window.show()
    window.load_views()
    if not hints:
        window.hints.close_all()
    window.activateWindow()
    wait(window.isActiveWindow)
    return window


def person(window: MainWindow) -> Person:
    """Who answers the questions of a window."""
    assert isinstance(window.files.ask, Person)
    return window.files.ask


def close_window(window: MainWindow) -> bool:
    """Close a window without saving, and destroy it; False where it refused to close."""
    person(window).choice = Choice.DISCARD
    closed = window.close()
    # With the look goes the translation that it has given to all of Qt.
    window.session.look.deleteLater()
    window.deleteLater()
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    QApplication.processEvents()
    return closed


@contextmanager
def opened(folder: Path, file: str | Path | None = None) -> Iterator[MainWindow]:
    """A window that is closed afterwards."""
    window = make_window(folder, file)
    try:
        yield window
    finally:
        close_window(window)


def settle(window: MainWindow) -> None:
    """Wait until nothing is being read, planned, answered or checked any more."""
    session = window.session
    lines = (session._builds, session._plans, session._wishes, session._checks)
    wait(
        lambda: (
            not session._timer.isActive()
            and not any(line._running for line in lines)
            and not session.turns.waiting
        )
    )


def plan(window: MainWindow) -> None:
    """Plan with the action, and wait for what comes of it."""
    told: list[int] = []
    window.session.result_changed.connect(lambda: told.append(1))
    window.actions_table["plan"].trigger()
    wait(lambda: told and not window.session.planning)
    settle(window)


def field(window: MainWindow, key: str) -> FieldRow:
    """The row of an input, with its section open."""
    setup = window.setup
    setup.refresh()
    name, own = setup.form.place_of(key)
    setup.section(name).set_open(True)
    row = setup.section(name).row(own)
    assert row is not None, key
    return row


def type_number(window: MainWindow, key: str, text: str, part: int = 0) -> None:
    """Type a number into a field of the setup panel, and Enter."""
    editor = field(window, key).editors[part]
    editor.setFocus()
    editor.selectAll()
    QTest.keyClicks(editor, text)
    QTest.keyClick(editor, Qt.Key.Key_Return)


def choose(window: MainWindow, key: str, value: Any) -> None:
    """Choose a value from the list of a field, as a person does who clicks on it."""
    editor = field(window, key).editors[0]
    index = editor._values.index(value)
    editor.setCurrentIndex(index)
    editor.activated.emit(index)


def press(widget: QWidget, keys: str) -> None:
    """Press a key or a combination of keys."""
    stroke = QKeySequence(keys)[0]
    QTest.keyClick(widget, stroke.key(), stroke.keyboardModifiers())


def drop(widget: QWidget, *urls: QUrl) -> bool:
    """Drop URLs onto a widget as the desktop does; whether the widget wanted them."""
    data = QMimeData()
    data.setUrls(list(urls))
    place, buttons = QPoint(40, 40), LEFT
    action = Qt.DropAction.CopyAction
    enter = QDragEnterEvent(place, action, data, buttons, PLAIN)
    enter.ignore()
    QApplication.sendEvent(widget, enter)
    if not enter.isAccepted():
        return False
    QApplication.sendEvent(widget, QDropEvent(QPointF(place), action, data, buttons, PLAIN))
    QApplication.processEvents()
    return True


class Hand(Mouse):
    """The mouse over a window's map."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(QApplication.instance(), window.map)

    def drag(self, waypoint: int, *leans: float, button: Qt.MouseButton = LEFT) -> None:
        """Take hold at the first lean and let go at the last."""
        self.move(waypoint, leans[0])
        self.press(waypoint, leans[0], button)
        for lean in leans[1:]:
            self.move(waypoint, lean)
        self.release(waypoint, leans[-1], button)


@contextmanager
def logged_defects() -> Iterator[list[str]]:
    """What the product logs as defects of its own, while this is open."""
    found: list[str] = []

    class Collector(logging.Handler):
        def emit(self, record: logging.LogRecord) -> None:
            found.append(self.format(record))

    collector = Collector(logging.ERROR)
    LOG.addHandler(collector)
    try:
        yield found
    finally:
        LOG.removeHandler(collector)
