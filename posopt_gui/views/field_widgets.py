"""One row of a form: label, editor with its unit, and a sentence where the value is wrong."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QAction
from PySide6.QtWidgets import (
    QGridLayout,
    QLabel,
    QSizePolicy,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from posopt_gui.viewmodels.form_types import Field, Kind, Note, range_of
from posopt_gui.viewmodels.number_words import in_figures, with_unit
from posopt_gui.viewmodels.typed_numbers import Refusal, refusal_words
from posopt_gui.views.choice_edit import ChoiceEdit
from posopt_gui.views.flag_edit import FlagEdit
from posopt_gui.views.number_edit import NumberEdit
from posopt_gui.views.text_edit import TextEdit

Translate = Callable[..., str]

LABEL_WIDTH = 108
"""Width of the labels, so that the editors of a section stand under each other [px]."""


def note_text(translate: Translate, note: Note) -> str:
    """The sentence of a note in the chosen language."""
    return translate(note.text, **dict(note.values))


class FieldRow(QWidget):
    """Label, editor and sentence of one field.

    Signals: `edited(value)` when a person has changed the value, `focused()`, `file_wanted()`,
    `refused_changed()` when a typed text is not taken, or gone again.
    """

    edited = Signal(object)
    file_wanted = Signal()
    focused = Signal()
    refused_changed = Signal()

    def __init__(self, field: Field, translate: Translate, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.field = field
        self._tr = translate
        self._value: Any = None
        self._error = self._said = ""
        self._label = QLabel(self)
        self._label.setWordWrap(True)
        self._label.setFixedWidth(LABEL_WIDTH)
        self._sentence = QLabel(self)
        self._sentence.setObjectName("sentence")
        self._sentence.setWordWrap(True)
        self._sentence.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self._sentence.hide()
        self._reset = QAction(self)
        self._reset.triggered.connect(lambda: self._take(self.field.default))
        self._label.addAction(self._reset)
        self._label.setContextMenuPolicy(Qt.ContextMenuPolicy.ActionsContextMenu)
        self._grid = QGridLayout()
        self._grid.setContentsMargins(0, 0, 0, 0)
        self._grid.setHorizontalSpacing(6)
        self._grid.setVerticalSpacing(3)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(2)
        layout.addLayout(self._grid)
        layout.addWidget(self._sentence)
        self.editors: list[QWidget] = []
        self._build()
        self.set_field(field)

    @property
    def structure(self) -> tuple[object, ...]:
        """What the widgets of the row depend on."""
        return structure(self.field)

    @property
    def error(self) -> str:
        """The sentence that is shown."""
        return self._said

    @property
    def refusal(self) -> Refusal | None:
        """What was typed and is not taken; None where all is."""
        found = (one.refusal for one in self.editors if isinstance(one, NumberEdit))
        return next((one for one in found if one is not None), None)

    def forget_typed(self) -> None:
        """Show the value again in place of what was not taken."""
        for editor in self.editors:
            if isinstance(editor, NumberEdit) and editor.refusal is not None:
                editor.restore()

    def set_field(self, field: Field) -> None:
        """Take a field of the same structure: other range, default, choices."""
        self.field = field
        self.retranslate()

    def retranslate(self) -> None:
        """Set every text again."""
        field = self.field
        unit = with_unit("", field.unit).strip()
        text = self._tr(field.label)
        if unit and field.kind is Kind.NUMBERS:
            text += f" [{unit}]"
        if field.kind is Kind.FLAG:
            self._check.setText(text)
        else:
            self._label.setText(text)
        self._reset.setText(self._tr("Back to the default"))
        self._reset.setEnabled(not field.required and field.apply is None)
        tip = self.tip()
        name = ", ".join(part for part in (text, self.range_text()) if part)
        for widget in (self._label, *self.editors):
            widget.setToolTip(tip)
        for number, editor in enumerate(self.editors):
            part = f", {self._tr(field.parts[number])}" if number < len(field.parts) else ""
            editor.setAccessibleName(name + part)
        if field.kind is Kind.FILE:
            self._browse.setToolTip(self._tr("Choose a file"))
            self._browse.setAccessibleName(f"{text}: {self._tr('Choose a file')}")
        self._set_forms()
        self._show()
        self._show_sentence()

    def range_text(self) -> str:
        """The range in words."""
        note = range_of(self.field)
        return note_text(self._tr, note) if note is not None else ""

    def default_text(self) -> str:
        """The default in words; '' where there is none."""
        field = self.field
        value = field.default
        if field.unset:
            return self._tr("Empty: {words}", words=self._tr(field.unset))
        if field.required or value is None or field.apply is not None or value in ("", []):
            return ""
        if field.kind is Kind.FLAG:
            shown = self._tr("on") if value != field.off else self._tr("off")
        elif field.kind is Kind.CHOICE:
            shown = next((self._choice(one)[1] for one in field.choices if one.value == value), "")
        elif isinstance(value, list):
            numbers = (one for one in value if isinstance(one, int | float))
            shown = ", ".join(map(in_figures, numbers))
        else:
            shown = in_figures(value) if isinstance(value, float) else str(value)
        shown = with_unit(shown, field.unit) if shown else ""
        return self._tr("Default: {value}", value=shown) if shown else ""

    def tip(self) -> str:
        """What the field says, its range and its default."""
        numbers = " · ".join(one for one in (self.range_text(), self.default_text()) if one)
        return "\n".join(line for line in (self._tr(self.field.tip), numbers) if line)

    def show_value(self, value: Any) -> None:
        """Show a value without saying that it was entered."""
        self._value = value
        self._show()

    def set_error(self, sentence: str) -> None:
        """Mark the value as wrong with a sentence; '' takes the mark away."""
        self._error = sentence
        self._show_sentence()

    def _on_refused(self) -> None:
        self._show_sentence()
        self.refused_changed.emit()

    def refusal_text(self) -> str:
        """Why a typed text is not taken; '' where all is."""
        refusal = self.refusal
        if refusal is None:
            return ""
        open_above = self.field.low is not None and self.field.high is None
        bounds = "" if open_above else self.range_text()
        return refusal_words(refusal, bounds, self._tr, with_unit("", self.field.unit))

    def _show_sentence(self) -> None:
        sentence = self.refusal_text() or self._error
        if sentence == self._said:
            return
        self._said = sentence
        self._sentence.setText(sentence)
        self._sentence.setVisible(bool(sentence))
        for editor in self.editors:
            editor.setProperty("wrong", bool(sentence))
            editor.style().unpolish(editor)
            editor.style().polish(editor)

    def focus_editor(self, part: int = 0) -> None:
        """Put the keyboard into the editor."""
        if self.editors:
            self.editors[min(part, len(self.editors) - 1)].setFocus(Qt.FocusReason.OtherFocusReason)

    def _build(self) -> None:
        builders = {
            Kind.NUMBER: self._build_number,
            Kind.INTEGER: self._build_number,
            Kind.NUMBERS: self._build_numbers,
            Kind.CHOICE: self._build_choice,
            Kind.FLAG: self._build_flag,
            Kind.TEXT: self._build_text,
            Kind.WORDS: self._build_text,
            Kind.FILE: self._build_file,
            Kind.SUBSET: self._build_subset,
        }
        builders[self.field.kind]()

    def _beside(self, editor: QWidget) -> None:
        editor.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self._grid.addWidget(self._label, 0, 0)
        self._grid.addWidget(editor, 0, 1)
        self._grid.setColumnStretch(1, 1)
        self.editors.append(editor)

    def _build_number(self) -> None:
        editor = NumberEdit(self)
        editor.entered.connect(self._take)
        editor.refused.connect(self._on_refused)
        editor.focused.connect(self.focused)
        self._beside(editor)

    def _build_numbers(self) -> None:
        count = self.field.count
        columns = 2 if count == 2 else 3
        self._label.setMinimumWidth(0)
        self._label.setMaximumWidth(16_777_215)
        beside = count == 2
        if beside:
            self._label.setFixedWidth(LABEL_WIDTH)
        self._grid.addWidget(self._label, 0, 0, 1, 1 if beside else columns)
        for number in range(count):
            editor = NumberEdit(self)
            editor.setProperty("slim", True)
            editor.entered.connect(lambda value, at=number: self._take_part(at, value))
            editor.refused.connect(self._on_refused)
            editor.focused.connect(self.focused)
            row, column = divmod(number, columns)
            column += 1 if beside else 0
            self._grid.addWidget(editor, row if beside else row + 1, column)
            self._grid.setColumnStretch(column, 1)
            self.editors.append(editor)

    def _build_choice(self) -> None:
        editor = ChoiceEdit(self.field.searchable, self)
        editor.chosen.connect(self._take)
        editor.focused.connect(self.focused)
        self._beside(editor)

    def _build_flag(self) -> None:
        self._label.hide()
        self._check = FlagEdit(self)
        self._check.clicked.connect(self._take)
        self._check.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self._grid.addWidget(self._check, 0, 0)
        self.editors.append(self._check)

    def _build_text(self) -> None:
        editor = TextEdit(self)
        editor.entered.connect(self._take_text)
        editor.focused.connect(self.focused)
        self._beside(editor)

    def _build_file(self) -> None:
        self._build_text()
        self._browse = QToolButton(self)
        self._browse.setObjectName("browse")
        self._browse.setText("…")
        self._browse.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self._browse.clicked.connect(self.file_wanted)
        self._grid.addWidget(self._browse, 0, 2)
        self.editors.append(self._browse)

    def _build_subset(self) -> None:
        self._label.setMinimumWidth(0)
        self._label.setMaximumWidth(16_777_215)
        self._grid.addWidget(self._label, 0, 0, 1, 4)
        for number, choice in enumerate(self.field.choices):
            button = QToolButton(self)
            button.setCheckable(True)
            button.setObjectName("subset")
            button.setText(choice.label)
            button.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
            button.clicked.connect(self._take_subset)
            self._grid.addWidget(button, 1 + number // 4, number % 4)
            self.editors.append(button)

    def _choice(self, one: Any) -> tuple[Any, str, str]:
        label = one.label if one.plain else self._tr(one.label)
        return one.value, label, self._tr(one.detail) if one.detail else ""

    def _set_forms(self) -> None:
        field = self.field
        for number, editor in enumerate(self.editors):
            if isinstance(editor, ChoiceEdit):
                editor.set_choices([self._choice(one) for one in field.choices])
            elif isinstance(editor, NumberEdit):
                decimals = 0 if field.kind is Kind.INTEGER else field.decimals
                low = field.low
                if low is not None and field.above:
                    low += field.step
                editor.set_form(decimals, field.step, low, field.high)
                editor.set_unset(self._tr(field.unset) if field.unset else "")
                if field.kind is Kind.NUMBERS:
                    part = self._tr(field.parts[number])
                    # 'from' and 'to' alone stand in their order; all others are named.
                    named = field.count > 2 or field.parts[0] != "from"
                    editor.setPrefix(f"{part} " if named else "")
                elif field.unit:
                    editor.setSuffix(with_unit("", field.unit))

    def _show(self) -> None:
        field, value = self.field, self._value
        if field.kind in (Kind.NUMBER, Kind.INTEGER):
            self._show_number(self.editors[0], value)
        elif field.kind is Kind.NUMBERS:
            values = value if isinstance(value, list) else []
            for number, editor in enumerate(self.editors):
                self._show_number(editor, values[number] if number < len(values) else None)
        elif field.kind is Kind.CHOICE:
            self.editors[0].show_value(value)  # type: ignore[attr-defined]
        elif field.kind is Kind.FLAG:
            self._check.setChecked(bool(value))
        elif field.kind is Kind.SUBSET:
            chosen = value if isinstance(value, list) else []
            for choice, button in zip(field.choices, self.editors, strict=True):
                button.setChecked(choice.value in chosen)  # type: ignore[attr-defined]
        else:
            words = value if isinstance(value, list) else [value or ""]
            self.editors[0].show_text(", ".join(map(str, words)))  # type: ignore[attr-defined]

    @staticmethod
    def _show_number(editor: QWidget, value: Any) -> None:
        number = isinstance(value, int | float) and not isinstance(value, bool)
        editor.show_number(float(value) if number else None)  # type: ignore[attr-defined]

    def _take(self, value: Any) -> None:
        if self.field.kind is Kind.INTEGER and isinstance(value, float) and value.is_integer():
            value = int(value)
        self._value = value
        self.edited.emit(value)

    def _take_part(self, number: int, value: float | None) -> None:
        values = list(self._value) if isinstance(self._value, list) else []
        values += [0.0] * (self.field.count - len(values))
        values[number] = value
        self._take(values)

    def _take_text(self, text: str) -> None:
        if self.field.kind is Kind.WORDS:
            self._take([part.strip() for part in text.split(",") if part.strip()])
        else:
            self._take(text)

    def _take_subset(self) -> None:
        chosen = zip(self.field.choices, self.editors, strict=True)
        self._take([one.value for one, button in chosen if button.isChecked()])  # type: ignore[attr-defined]


def structure(field: Field) -> tuple[object, ...]:
    """What the widgets of a field's row depend on; the same for fields that can share a row."""
    subset = field.choices if field.kind is Kind.SUBSET else ()
    return field.key, field.kind, field.count, field.searchable, subset
