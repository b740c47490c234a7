"""Application, window and first plan, in an order that puts the window on screen early."""

from __future__ import annotations

import gc
import os
import sys
from pathlib import Path

from PySide6.QtCore import QCoreApplication, QSettings, Qt, QTimer
from PySide6.QtWidgets import QApplication

from posopt_gui.controllers.defects import DefectHook
from posopt_gui.controllers.file_mark import mark_of
from posopt_gui.controllers.files import Files, state_of_argument
from posopt_gui.controllers.path_import import is_path_file
from posopt_gui.controllers.recovery import Recovery
from posopt_gui.controllers.session import Session
from posopt_gui.document.document import Document
from posopt_gui.look import Look
from posopt_gui.main_window import MainWindow
from posopt_gui.qt_words import QtWords
from posopt_gui.style import prepare_fonts
from posopt_gui.workers.garbage import GarbageCollector
from solver.errors import PosoptError

SWITCH = 0.001
"""How long another thread may keep the interpreter that the window waits for [s]."""


def application() -> QApplication:
    """The one application; OpenGL views share their contexts, or a second one would crash."""
    made = QApplication.instance()
    if isinstance(made, QApplication):
        return made
    QCoreApplication.setAttribute(Qt.ApplicationAttribute.AA_ShareOpenGLContexts)
    QCoreApplication.setOrganizationName("posopt")
    QCoreApplication.setApplicationName("posopt")
    # Each call from Qt into Python waits for the threads that plan to pass on the interpreter.
    sys.setswitchinterval(SWITCH)
    created = QApplication(["posopt"])
    GarbageCollector(created).start()
    prepare_fonts()
    return created


def make_window(
    file: str | None, language: str | None, theme: str | None, settings: QSettings
) -> MainWindow:
    """The window of a cell or project; its panels are not loaded yet.

    Raises
    ------
    PosoptError
        When the file cannot be opened.
    """
    # Before it is read: what is written meanwhile is another one's.
    mark = None if file is None else mark_of(Path(file))
    state, path = state_of_argument(file)
    chosen = language or settings.value("look/language", "en", type=str)
    colours = theme or settings.value("look/theme", "light", type=str)
    look = Look(str(chosen), str(colours))
    QtWords(look)
    session = Session(Document(state), look)
    files = Files(session, settings)
    files.opened(path, mark)
    return MainWindow(session, files, Recovery(session, files), settings)


def begin(window: MainWindow, file: str | None = None) -> None:
    """Plan and fill the window that is on screen, and bring back what a run before left.

    Who names a `file` gets that file: of what was left behind only the work of the same project
    comes back, and other work stays for a start without a file.
    """

    def restore() -> None:
        # Only now can what is recovered be told; it is planned instead.
        path = window.files.path
        wanted = (file is None or path is not None) and not window.files.modified
        if wanted and window.recovery.restore(only=path):
            window.session.start()
        elif file is not None or window.files.modified:
            window.recovery.tell_kept()
        if file is not None and is_path_file(file):
            once = Qt.ConnectionType.SingleShotConnection
            window.files.path_taken.connect(window.session.plan, once)
            window.files.import_path(Path(file).absolute())

    window.ready.connect(restore)
    # The panels live as long as the window: they are not looked through again and again.
    window.ready.connect(gc.freeze)
    window.session.start()
    window.load_views_in_turns()


def run(file: str | None, language: str | None, theme: str | None, *, smoke: bool = False) -> int:
    """Open the window and run until it is closed."""
    running = application()
    settings = QSettings()
    try:
        window = make_window(file, language, theme, settings)
    except PosoptError as error:
        sys.stderr.write(f"posopt-gui: {error}\n")
        return error.exit_code
    look = window.session.look
    look.language_changed.connect(lambda: settings.setValue("look/language", look.language))
    look.theme_changed.connect(lambda: settings.setValue("look/theme", look.theme.name))
    hook = DefectHook(window.session)
    hook.install()
    window.show()
    QTimer.singleShot(0, window.close if smoke else lambda: begin(window, file))
    code = int(running.exec())
    hook.remove()
    if not window.all_ended:
        # Everything is saved, and a thread that runs on would not survive the interpreter's end.
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)
    return code
