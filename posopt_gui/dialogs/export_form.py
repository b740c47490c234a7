"""Fields of the export: kind of file, name, simplifying, accepted clearance, override."""

from __future__ import annotations

import math

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtWidgets import (
    QDoubleSpinBox,
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QWidget,
)

from posopt_gui.look import Look
from posopt_gui.viewmodels.export_model import FORMATS, ExportView, Situation
from posopt_gui.views.flag_edit import FlagEdit
from posopt_gui.views.quiet_editors import QuietCombo, QuietSpinBox
from solver.units import MM, MM_PER_M


class ExportFormPanel(QFrame):
    """Says what was chosen; it never changes anything itself. Lengths in [m], None for 'not'."""

    post_chosen = Signal(str)
    path_typed = Signal(str)
    simplify_chosen = Signal(object)
    clearance_chosen = Signal(object)
    reason_typed = Signal(str)
    browse_wanted = Signal()
    override_wanted = Signal()

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._look = look
        self.setObjectName("form")
        self._make_fields()
        self._lay_out()
        self._connect()

    def _make_fields(self) -> None:
        self._format_label, self._path_label = QLabel(), QLabel()
        self._reason_label, self._clearance_label = QLabel(), QLabel()
        self.format = QuietCombo()
        self.path = QLineEdit()
        self.browse = QPushButton()
        self.path_fault = QLabel()
        self.path_fault.setWordWrap(True)
        self.path_fault.setProperty("tone", "error")
        self.simplify = FlagEdit()
        self.tolerance = _millimetres(0.01, 0.5, 0.05, 2)
        self.tolerance.setValue(0.1)
        self.accept = FlagEdit()
        self.clearance = _millimetres(0.1, 50.0, 1.0, 1)
        self.reason = QLineEdit()
        self.override = QPushButton()
        self.override.setObjectName("careful")
        self.reason_hint = QLabel()
        self.reason_hint.setWordWrap(True)
        for button in (self.browse, self.override):
            button.setAutoDefault(False)

    def _lay_out(self) -> None:
        grid = QGridLayout(self)
        grid.setContentsMargins(12, 10, 12, 10)
        grid.setHorizontalSpacing(10)
        grid.setVerticalSpacing(6)
        grid.setColumnStretch(1, 1)
        first = QHBoxLayout()
        first.addWidget(self.format, 1)
        first.addSpacing(16)
        first.addWidget(self.simplify)
        first.addWidget(self.tolerance)
        accept = QHBoxLayout()
        accept.addWidget(self.accept)
        accept.addWidget(self.clearance)
        accept.addStretch(1)
        rows: tuple[tuple[QWidget | None, object, QWidget | None], ...] = (
            (self._format_label, first, None),
            (self._path_label, self.path, self.browse),
            (None, self.path_fault, None),
            (self._clearance_label, accept, None),
            (self._reason_label, self.reason, self.override),
            (None, self.reason_hint, None),
        )
        for number, (label, body, button) in enumerate(rows):
            if label is not None:
                grid.addWidget(label, number, 0)
            width = 1 if button is not None else 2
            if isinstance(body, QWidget):
                grid.addWidget(body, number, 1, 1, width)
            elif isinstance(body, QHBoxLayout):
                grid.addLayout(body, number, 1, 1, width)
            if button is not None:
                grid.addWidget(button, number, 2)

    def _connect(self) -> None:
        self.format.activated.connect(lambda index: self.post_chosen.emit(FORMATS[index].post))
        self.path.textEdited.connect(self.path_typed)
        self.browse.clicked.connect(self.browse_wanted)
        self.simplify.toggled.connect(self._choose_simplify)
        self.tolerance.valueChanged.connect(self._choose_simplify)
        self.accept.toggled.connect(self._choose_clearance)
        self.clearance.valueChanged.connect(self._choose_clearance)
        self.reason.textEdited.connect(self.reason_typed)
        self.override.clicked.connect(self.override_wanted)

    def _choose_simplify(self) -> None:
        chosen = self.simplify.isChecked()
        self.simplify_chosen.emit(self.tolerance.value() * MM if chosen else None)

    def _choose_clearance(self) -> None:
        chosen = self.accept.isChecked()
        self.clearance_chosen.emit(self.clearance.value() * MM if chosen else None)

    def retranslate(self) -> None:
        """Set all texts in the chosen language."""
        tr = self._look.tr
        self._format_label.setText(tr("Format"))
        self._path_label.setText(tr("File"))
        self._clearance_label.setText(tr("Clearance"))
        self._reason_label.setText(tr("Override"))
        self.browse.setText(tr("Choose…"))
        self.override.setText(tr("Export with override"))
        self.override.setToolTip(tr("Write the program although checks failed"))
        self.simplify.setText(tr("Drop positions that keep the path within"))
        self.reason.setPlaceholderText(tr("Why this program may be used although checks failed"))
        chosen = max(self.format.currentIndex(), 0)
        with QSignalBlocker(self.format):
            self.format.clear()
            self.format.addItems([tr(one.label) for one in FORMATS])
            self.format.setCurrentIndex(chosen)
        for field, name in (
            (self.format, "Format"),
            (self.path, "File of the program"),
            (self.tolerance, "Tolerance for simplifying"),
            (self.clearance, "Accepted clearance"),
            (self.reason, "Reason for the override"),
        ):
            field.setAccessibleName(tr(name))
        self.tolerance.setToolTip(tr("How far the moved TCP may leave the path"))

    def show_form(self, now: Situation, view: ExportView) -> None:
        """Show the form, and which of its fields are of use."""
        form = now.form
        self.setEnabled(not now.writing)
        self.format.setCurrentIndex([one.post for one in FORMATS].index(form.post))
        if self.path.text() != form.path:
            self.path.setText(form.path)
        _mark(self.path, wrong=bool(view.path_fault))
        self.path_fault.setText(view.path_fault)
        self.path_fault.setVisible(bool(view.path_fault))
        self._show_simplify(now)
        self._show_clearance(now, view)
        if self.reason.text() != form.reason:
            self.reason.setText(form.reason)
        for part in (self._reason_label, self.reason, self.override, self.reason_hint):
            part.setVisible(view.asks_reason)
        self.reason_hint.setText(view.reason_hint)
        self.reason_hint.setProperty("tone", "error" if view.reason_wrong else "muted")
        self.reason_hint.style().polish(self.reason_hint)
        _mark(self.reason, wrong=view.reason_wrong)
        self.override.setEnabled(view.can_override)

    def _show_simplify(self, now: Situation) -> None:
        chosen = now.form.simplify
        with QSignalBlocker(self.simplify), QSignalBlocker(self.tolerance):
            self.simplify.setChecked(chosen is not None)
            if now.tolerance > 0.0:
                self.tolerance.setMaximum(now.tolerance * MM_PER_M)
            if chosen is not None:
                self.tolerance.setValue(chosen * MM_PER_M)
        self.tolerance.setEnabled(chosen is not None)

    def _show_clearance(self, now: Situation, view: ExportView) -> None:
        for part in (self._clearance_label, self.accept, self.clearance):
            part.setVisible(view.asks_clearance)
        chosen = now.form.accepted
        with QSignalBlocker(self.accept):
            self.accept.setChecked(chosen is not None)
        if not view.asks_clearance:
            return
        asked, least = now.required * MM_PER_M, _down(now.least)
        words = "Accept less than the {asked} mm asked (the plan keeps {least} mm):"
        self.accept.setText(self._look.tr(words, asked=f"{asked:g}", least=f"{least:.1f}"))
        self.clearance.setEnabled(chosen is not None)
        with QSignalBlocker(self.clearance):
            self.clearance.setMaximum(asked)
            shown = least if chosen is None else chosen * MM_PER_M
            if shown > 0.0:
                self.clearance.setValue(shown)


def _down(clearance: float) -> float:
    """A clearance [m] in mm, rounded down to 0.1 mm."""
    return math.floor(clearance * MM_PER_M * 10.0 + 1e-7) / 10.0


def _mark(field: QLineEdit, *, wrong: bool) -> None:
    if field.property("wrong") != wrong:
        field.setProperty("wrong", wrong)
        field.style().polish(field)


def _millimetres(low: float, high: float, step: float, decimals: int) -> QDoubleSpinBox:
    box = QuietSpinBox()
    box.setDecimals(decimals)
    box.setRange(low, high)
    box.setSingleStep(step)
    box.setSuffix(" mm")
    box.setAlignment(Qt.AlignmentFlag.AlignRight)
    return box
