"""Tests of the window need a display; without one they are skipped with the reason."""

import os
import sys
from pathlib import Path

import pytest

HAS_DISPLAY = not sys.platform.startswith("linux") or bool(
    os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
)
HERE = Path(__file__).parent

if HAS_DISPLAY:
    os.environ.setdefault("QT_QPA_PLATFORM", "xcb" if sys.platform.startswith("linux") else "")
    os.environ.setdefault("LIBGL_ALWAYS_SOFTWARE", "1")
    if not os.environ["QT_QPA_PLATFORM"]:
        del os.environ["QT_QPA_PLATFORM"]
    from PySide6.QtCore import QCoreApplication, Qt

    # Before any application exists: a second OpenGL view would crash without it.
    QCoreApplication.setAttribute(Qt.ApplicationAttribute.AA_ShareOpenGLContexts)
else:
    collect_ignore_glob = ["test_*.py"]


def pytest_collection_modifyitems(items):
    for item in items:
        if not HAS_DISPLAY and HERE in Path(item.fspath).parents:
            item.add_marker(pytest.mark.skip(reason="no display: run it under xvfb-run"))


@pytest.fixture(autouse=True)
def held_widgets(monkeypatch):
    """Hold the widgets of a test until Qt has destroyed them, as a window holds its panels.

    pytest-qt refers to them weakly: between the end of a test and the closing of its widgets they
    could be collected as garbage, children before their parents, which Qt does not survive where
    a tab bar has a widget in its corner.
    """
    if not HAS_DISPLAY:
        yield
        return
    from PySide6.QtCore import QEvent
    from pytestqt.qtbot import QtBot

    held, add = [], QtBot.addWidget

    def hold(bot, widget, **options):
        held.append(widget)
        add(bot, widget, **options)

    monkeypatch.setattr(QtBot, "addWidget", hold)
    yield
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    held.clear()


@pytest.fixture(scope="session")
def qapp_args():
    return ["posopt-tests"]


@pytest.fixture(scope="session")
def planned_state():
    """Inputs of the default cell."""
    from posopt_gui.document.project import state_of_cell

    return state_of_cell("groove_hw300")


@pytest.fixture
def session(qtbot, planned_state):
    """A session with the default cell, closed afterwards."""
    from posopt_gui.controllers.session import Session
    from posopt_gui.document.document import Document

    made = Session(Document(planned_state))
    yield made
    assert made.close()


@pytest.fixture
def planned(qtbot, session):
    """A session that has planned the default cell."""
    with qtbot.waitSignal(session.result_changed, timeout=180_000):
        session.start()
    return session


@pytest.fixture(scope="package", autouse=True)
def collector(qapp):
    """Collect garbage on the window's thread alone, as the product does."""
    from posopt_gui.workers.garbage import GarbageCollector

    made = GarbageCollector(qapp)
    made.start()
    yield made
    made.stop()
