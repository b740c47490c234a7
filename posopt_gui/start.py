"""Application, window and first plan, in an order that puts the window on screen early."""

from __future__ import annotations

import sys

from PySide6.QtCore import QCoreApplication, QSettings, Qt, QTimer
from PySide6.QtWidgets import QApplication

from posopt_gui.controllers.defects import DefectHook
from posopt_gui.controllers.files import Files, state_of_argument
from posopt_gui.controllers.recovery import Recovery
from posopt_gui.controllers.session import Session
from posopt_gui.document.document import Document
from posopt_gui.look import Look
from posopt_gui.main_window import MainWindow
from posopt_gui.style import prepare_fonts
from solver.errors import PosoptError


def application() -> QApplication:
    """The one application; OpenGL views share their contexts, or a second one would crash."""
    made = QApplication.instance()
    if isinstance(made, QApplication):
        return made
    QCoreApplication.setAttribute(Qt.ApplicationAttribute.AA_ShareOpenGLContexts)
    QCoreApplication.setOrganizationName("posopt")
    QCoreApplication.setApplicationName("posopt")
    created = QApplication(["posopt"])
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
    state, path = state_of_argument(file)
    chosen = language or settings.value("look/language", "en", type=str)
    colours = theme or settings.value("look/theme", "light", type=str)
    session = Session(Document(state), Look(str(chosen), str(colours)))
    files = Files(session, settings)
    files.opened(path)
    return MainWindow(session, files, Recovery(session, files), settings)


def begin(window: MainWindow) -> None:
    """Fill the window that is on screen, bring back what a run before left, and plan."""
    window.load_views()
    # Only now can what is recovered be told.
    window.recovery.restore(only=window.files.path)
    window.session.start()


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
    QTimer.singleShot(0, window.close if smoke else lambda: begin(window))
    code = int(running.exec())
    hook.remove()
    return code
