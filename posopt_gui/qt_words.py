"""Words of Qt's own parts, such as file dialogs and context menus, in the window's language."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication, QLibraryInfo, QObject, QTranslator

from posopt_gui.look import Look


class QtWords(QObject):
    """Installs Qt's own translation of the chosen language, and takes it away for English."""

    def __init__(self, look: Look) -> None:
        super().__init__(look)
        self._look = look
        self._translator: QTranslator | None = None
        look.language_changed.connect(self._follow)
        self._follow()

    def _follow(self) -> None:
        if self._translator is not None:
            QCoreApplication.removeTranslator(self._translator)
            self._translator = None
        language = self._look.language
        if language == "en":
            return
        made = QTranslator(self)
        folder = QLibraryInfo.path(QLibraryInfo.LibraryPath.TranslationsPath)
        # Where Qt has no words for a language its parts stay English.
        if made.load(f"qtbase_{language}", folder):
            QCoreApplication.installTranslator(made)
            self._translator = made
