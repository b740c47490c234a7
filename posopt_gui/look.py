"""Language and theme of the window, switchable while it is open."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

from posopt_gui.i18n import LANGUAGES, translated
from posopt_gui.theme import LIGHT, THEMES, Theme


class Look(QObject):
    """The chosen language and theme; views set their texts and colours again when they change."""

    language_changed = Signal()
    theme_changed = Signal()

    def __init__(
        self, language: str = "en", theme: str = LIGHT.name, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self._language = language if language in LANGUAGES else "en"
        self._theme = THEMES.get(theme, LIGHT)

    @property
    def language(self) -> str:
        """Code of the language."""
        return self._language

    @property
    def theme(self) -> Theme:
        """The colours."""
        return self._theme

    def tr(self, text: str, /, **values: object) -> str:  # type: ignore[override]
        """The text in the chosen language; `values` fill its {names}."""
        found = translated(self._language, text)
        return found.format(**values) if values else found

    def set_language(self, language: str) -> None:
        """Change the language."""
        if language in LANGUAGES and language != self._language:
            self._language = language
            self.language_changed.emit()

    def set_theme(self, name: str) -> None:
        """Change the theme."""
        if name in THEMES and name != self._theme.name:
            self._theme = THEMES[name]
            self.theme_changed.emit()
