"""A number with its unit: Enter applies, Escape leaves, the wheel turns it only in focus."""

from __future__ import annotations

import math

from PySide6.QtCore import QLocale, Qt, Signal
from PySide6.QtGui import QFocusEvent, QKeyEvent, QValidator, QWheelEvent
from PySide6.QtWidgets import QDoubleSpinBox, QWidget

LIMIT = 1e9
"""Magnitudes beyond this cannot be typed."""

ABSENT = -2.0 * LIMIT

DECIMALS = 9
"""Decimals that are kept; those beyond the shown ones appear only where they are not zero."""


class NumberEdit(QDoubleSpinBox):
    """A number that may also be absent, and that may lie out of its range.

    What is typed is taken as it is: the inputs are judged as a whole, and a wrong value is
    answered by a sentence at its place. Arrow keys and wheel stay within the range.

    Signals: `entered(number)` when a person has changed it (None: absent), `focused()`.
    """

    entered = Signal(object)
    focused = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._shown_decimals = 1
        self._low, self._high = -LIMIT, LIMIT
        self._unset = ""
        self._number: float | None = 0.0
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

    def set_form(self, decimals: int, step: float, low: float | None, high: float | None) -> None:
        """Set how many decimals are shown, what an arrow changes and how far it goes."""
        self._shown_decimals = decimals
        self._low = -LIMIT if low is None else low
        self._high = LIMIT if high is None or math.isinf(high) else high
        self.setSingleStep(step)

    def set_unset(self, words: str) -> None:
        """Set the words that stand for an absent number."""
        self._unset = words
        self.setSpecialValueText(words or " ")

    def show_number(self, number: float | None) -> None:
        """Show a number without saying that it was entered."""
        other = number != self._number
        self._number = number
        self.blockSignals(True)
        self.setValue(ABSENT if number is None else number)
        if self.lineEdit().text() != self._text(number):
            self.lineEdit().setText(self._text(number))
        if other:
            self.lineEdit().deselect()
        self.blockSignals(False)

    def textFromValue(self, value: float) -> str:  # noqa: N802 - Qt's name
        """Return the number with point decimals, no more of them than it needs."""
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
        allowed = all(mark in "0123456789.,+-eE" for mark in bare)
        state = QValidator.State.Intermediate if allowed else QValidator.State.Invalid
        return state, text, position

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
            self._commit()
            self.selectAll()
            event.accept()
            return
        if event.key() == Qt.Key.Key_Escape:
            self._restore()
            self.clearFocus()
            event.accept()
            return
        super().keyPressEvent(event)

    def focusInEvent(self, event: QFocusEvent) -> None:  # noqa: N802 - Qt's name
        """Tell that the field is being edited, and select its number."""
        super().focusInEvent(event)
        if event.reason() in (Qt.FocusReason.TabFocusReason, Qt.FocusReason.BacktabFocusReason):
            self.selectAll()
        self.focused.emit()

    def focusOutEvent(self, event: QFocusEvent) -> None:  # noqa: N802 - Qt's name
        """Apply what was typed."""
        self._commit()
        super().focusOutEvent(event)

    def _bare(self, text: str) -> str:
        return text.removeprefix(self.prefix()).removesuffix(self.suffix()).strip()

    def _parsed(self, text: str) -> float | None:
        try:
            number = float(self._bare(text).replace(",", "."))
        except ValueError:
            return None
        return number if math.isfinite(number) and abs(number) <= LIMIT else None

    def _commit(self) -> None:
        text = self.lineEdit().text()
        if self._is_absent(text):
            self._take(None)
            return
        number = self._parsed(text)
        if number is None:
            self._restore()
        elif text != self._text(self._number):
            self._take(number)

    def _is_absent(self, text: str) -> bool:
        return bool(self._unset) and self._bare(text) in ("", self._unset)

    def _text(self, number: float | None) -> str:
        if number is None:
            return self.specialValueText()
        return f"{self.prefix()}{self.textFromValue(number)}{self.suffix()}"

    def _restore(self) -> None:
        self.show_number(self._number)

    def _take(self, number: float | None) -> None:
        before = self._number
        self.show_number(number)
        if number != before:
            self.entered.emit(number)
