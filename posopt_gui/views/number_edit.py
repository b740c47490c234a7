"""A number with its unit: Enter applies, Escape leaves, the wheel turns it only in focus."""

from __future__ import annotations

import math

from PySide6.QtCore import QLocale, Qt, Signal
from PySide6.QtGui import QFocusEvent, QHideEvent, QKeyEvent, QValidator, QWheelEvent
from PySide6.QtWidgets import QDoubleSpinBox, QWidget

from posopt_gui.viewmodels.number_words import in_figures
from posopt_gui.viewmodels.typed_numbers import LIMIT, Refusal, read_number

ABSENT = -2.0 * LIMIT

RELATIVE = 1e-9
"""A number that its kept decimals miss by a larger share is shown in figures, as 1e-12 is."""

DECIMALS = 9
"""Decimals that are kept; those beyond the shown ones appear only where they are not zero."""

TYPED = "0123456789.,+-−eE '’_\u00a0\u2009\u202f．，－＋０１２３４５６７８９"
"""What can be typed or pasted: numbers as other programs write them, so that they are answered."""


class NumberEdit(QDoubleSpinBox):
    """A number that may also be absent, and that may lie out of its range.

    What is typed is taken as it is: the inputs are judged as a whole, and a wrong value is
    answered by a sentence at its place. Arrow keys and wheel stay within the range. A text that
    is no number stays, and is not applied, until another number or Escape replaces it.

    Signals: `entered(number)` when a person has changed it (None: absent), `focused()`,
    `refused(refusal)` where a text is not taken, with None once it is gone.
    """

    entered = Signal(object)
    focused = Signal()
    refused = Signal(object)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._shown_decimals = 1
        self._low, self._high = -LIMIT, LIMIT
        self._unset = ""
        self._number: float | None = 0.0
        self._refusal: Refusal | None = None
        self.setLocale(QLocale.c())
        self.setKeyboardTracking(False)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setDecimals(DECIMALS)
        # The minimum stands for an absent number, which Qt shows in words of its own.
        self.setRange(ABSENT, LIMIT)
        self.setSpecialValueText(" ")
        self.setAlignment(Qt.AlignmentFlag.AlignRight)
        self.setMinimumWidth(40)

    @property
    def number(self) -> float | None:
        """The number that is shown; None where there is none."""
        return self._number

    @property
    def refusal(self) -> Refusal | None:
        """The text that stands there without being applied; None where there is none."""
        return self._refusal

    def set_form(self, decimals: int, step: float, low: float | None, high: float | None) -> None:
        """Set how many decimals are shown, what an arrow changes and how far it goes."""
        self._shown_decimals = decimals
        self._low = -LIMIT if low is None else low
        self._high = LIMIT if high is None or math.isinf(high) else high
        self.setSingleStep(step)

    def set_unset(self, words: str) -> None:
        """Set the words that stand for an absent number."""
        self._unset = words
        self.setSpecialValueText(self._shown() if self._refusal else words or " ")

    def show_number(self, number: float | None) -> None:
        """Show a number without saying that it was entered; a refused text stays over the same."""
        other = number != self._number
        if other:
            self._set_refusal(None)
        self._number = number
        self.blockSignals(True)
        self.setValue(ABSENT if number is None else number)
        self._show_text()
        if other:
            self.lineEdit().deselect()
        self.blockSignals(False)

    def commit(self) -> None:
        """Apply what was typed, as Enter does."""
        text = self.lineEdit().text()
        if self._is_absent(text):
            self._take(None)
        elif not self._bare(text):
            self.restore()
        elif text != self._shown():
            found = read_number(self._bare(text))
            if isinstance(found, Refusal):
                self._set_refusal(found)
            else:
                self._take(found)

    def restore(self) -> None:
        """Show the number again, whatever was typed."""
        self._set_refusal(None)
        self.show_number(self._number)

    def textFromValue(self, value: float) -> str:  # noqa: N802 - Qt's name
        """Return what Qt is to show: the number, or over it a refused text."""
        return self._refusal.text if self._refusal is not None else self._figures(value)

    def _figures(self, value: float) -> str:
        """Return the number with point decimals, no more of them than it needs."""
        if abs(round(value, DECIMALS) - value) > RELATIVE * abs(value):
            return in_figures(value)
        text = f"{value:.{DECIMALS}f}".rstrip("0")
        whole, _, fraction = text.partition(".")
        if len(fraction) < self._shown_decimals:
            fraction = fraction.ljust(self._shown_decimals, "0")
        shown = f"{whole}.{fraction}" if fraction else whole
        return shown.removeprefix("-") if float(shown) == 0.0 else shown

    def valueFromText(self, text: str) -> float:  # noqa: N802 - Qt's name
        """Return the number that a text states."""
        number = self._parsed(text)
        return self.value() if number is None else number

    def validate(self, text: str, position: int) -> tuple[QValidator.State, str, int]:
        """Let anything be typed that can become a number."""
        bare = self._bare(text)
        if self._is_absent(text):
            return QValidator.State.Acceptable, text, position
        if self._parsed(text) is not None:
            return QValidator.State.Acceptable, text, position
        if self._unset.startswith(bare):
            return QValidator.State.Intermediate, text, position
        allowed = all(mark in TYPED for mark in bare)
        state = QValidator.State.Intermediate if allowed else QValidator.State.Invalid
        return state, text, position

    def fixup(self, text: str) -> str:
        """Leave a text that is no number as it is; Qt would drop its commas."""
        return text

    def stepBy(self, steps: int) -> None:  # noqa: N802 - Qt's name
        """Change the number by steps, within its range; what was typed is taken first."""
        typed = self._parsed(self.lineEdit().text())
        start = typed if typed is not None else self._number
        if start is None:
            start = max(self._low, 0.0) - (self.singleStep() if steps > 0 else 0.0)
        wanted = round(start + steps * self.singleStep(), DECIMALS)
        # From out of the range a step leads back to it, never farther out.
        if steps > 0:
            self._take(min(max(wanted, self._low), max(self._high, start)))
        else:
            self._take(max(min(wanted, self._high), min(self._low, start)))
        self.selectAll()

    def stepEnabled(self) -> QDoubleSpinBox.StepEnabledFlag:  # noqa: N802 - Qt's name
        """Say which way a step is left."""
        up, down = self.StepEnabledFlag.StepUpEnabled, self.StepEnabledFlag.StepDownEnabled
        number = self._number
        enabled = self.StepEnabledFlag.StepNone
        if number is None or number < self._high:
            enabled |= up
        if number is not None and number > self._low:
            enabled |= down
        return enabled

    def wheelEvent(self, event: QWheelEvent) -> None:  # noqa: N802 - Qt's name
        """Turn the number only in focus; else the panel scrolls."""
        if self.hasFocus():
            super().wheelEvent(event)
        else:
            event.ignore()

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 - Qt's name
        """Enter applies; Escape shows the old number again and leaves."""
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.commit()
            self.selectAll()
            event.accept()
            return
        if event.key() == Qt.Key.Key_Escape:
            self.restore()
            self.clearFocus()
            event.accept()
            return
        super().keyPressEvent(event)

    def focusInEvent(self, event: QFocusEvent) -> None:  # noqa: N802 - Qt's name
        """Tell that the field is being edited, and select its number."""
        super().focusInEvent(event)
        self._show_text()
        if event.reason() in (Qt.FocusReason.TabFocusReason, Qt.FocusReason.BacktabFocusReason):
            self.selectAll()
        self.focused.emit()

    def focusOutEvent(self, event: QFocusEvent) -> None:  # noqa: N802 - Qt's name
        """Apply what was typed."""
        self.commit()
        super().focusOutEvent(event)
        self._show_text()

    def hideEvent(self, event: QHideEvent) -> None:  # noqa: N802 - Qt's name
        """Keep a refused text, over which Qt writes the number."""
        super().hideEvent(event)
        self._show_text()

    def _bare(self, text: str) -> str:
        return text.removeprefix(self.prefix()).removesuffix(self.suffix()).strip()

    def _parsed(self, text: str) -> float | None:
        found = read_number(self._bare(text))
        return None if isinstance(found, Refusal) else found

    def _shown(self) -> str:
        if self._refusal is not None:
            return f"{self.prefix()}{self._refusal.text}{self.suffix()}"
        return self._text(self._number)

    def _show_text(self) -> None:
        if self.lineEdit().text() != self._shown():
            self.lineEdit().setText(self._shown())

    def _set_refusal(self, refusal: Refusal | None) -> None:
        if refusal != self._refusal:
            self._refusal = refusal
            self.setSpecialValueText(self._shown() if refusal else self._unset or " ")
            self.refused.emit(refusal)

    def _is_absent(self, text: str) -> bool:
        return bool(self._unset) and self._bare(text) in ("", self._unset)

    def _text(self, number: float | None) -> str:
        if number is None:
            return self._unset or " "
        return f"{self.prefix()}{self._figures(number)}{self.suffix()}"

    def _take(self, number: float | None) -> None:
        before = self._number
        self._set_refusal(None)
        self.show_number(number)
        if number != before:
            self.entered.emit(number)
