"""What is typed but not yet applied counts before something is done with the inputs."""

from __future__ import annotations

from PySide6.QtWidgets import QAbstractSpinBox, QApplication, QWidget

from posopt_gui.views.choice_edit import ChoiceEdit
from posopt_gui.views.number_edit import NumberEdit
from posopt_gui.views.text_edit import TextEdit


def apply_typed(window: QWidget) -> None:
    """Apply what the editor with the keyboard holds, as leaving it would."""
    editor: QWidget | None = QApplication.focusWidget() or window.focusWidget()
    while editor is not None:
        if isinstance(editor, NumberEdit | TextEdit | ChoiceEdit):
            editor.commit()
            return
        if isinstance(editor, QAbstractSpinBox):
            editor.interpretText()
            return
        editor = editor.parentWidget()
