"""Placement of the beam from three points that were touched with the tool's tip."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QDialog,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from posopt_gui.controllers.session import Session
from posopt_gui.dialogs.beam_sketch import BeamSketch
from posopt_gui.viewmodels.cell_edits import with_placement
from posopt_gui.viewmodels.cell_facts import Catalogue, facts_of, in_mm
from posopt_gui.viewmodels.error_words import error_words
from posopt_gui.viewmodels.number_words import decimal
from posopt_gui.viewmodels.touched_points import (
    ENDS,
    FLANGES,
    SIDES,
    TouchedCorner,
    placement_from_points,
)
from posopt_gui.viewmodels.typed_numbers import refusal_words
from posopt_gui.views.choice_edit import ChoiceEdit
from posopt_gui.views.number_edit import NumberEdit
from posopt_gui.views.refresh import Refresh
from posopt_gui.views.setup_style import setup_style
from solver.errors import InputError
from solver.transforms import FloatArray, wpr_from_rotation
from solver.units import DEG_PER_RAD, MM

POINTS = ("1: the corner", "2: on the edge along the beam", "3: on the flange's outer face")
AXES = ("X", "Y", "Z")
UNSET = "–"


class PlacementDialog(QDialog):
    """Takes three points in fanuc_world and applies the placement that they determine."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._session = session
        self._tr = session.look.tr
        state = session.document.state
        facts = facts_of(state.cell, Catalogue(), state.folder, state.files)
        self._workpiece = facts.workpiece
        self._placement: FloatArray | None = None
        self._numbers: list[list[NumberEdit]] = []
        self._labels: list[QLabel] = []
        self._lay_out()
        session.look.language_changed.connect(Refresh(session, self.retranslate, self).next_turn)
        session.look.theme_changed.connect(Refresh(session, self.retheme, self).next_turn)
        session.state_changed.connect(self._refresh)
        self.retheme()
        self.retranslate()
        self._numbers[0][0].setFocus(Qt.FocusReason.OtherFocusReason)

    @property
    def placement(self) -> FloatArray | None:
        """fanuc_world_from_beam of the points; None where they determine none."""
        return self._placement

    @property
    def sentence(self) -> str:
        """What the points say: the placement, or why there is none."""
        return self._sentence.text()

    def set_points(self, points: FloatArray) -> None:
        """Enter (3, 3) points [mm]."""
        for row, values in zip(self._numbers, np.asarray(points), strict=True):
            for editor, value in zip(row, values, strict=True):
                editor.show_number(float(value))
        self._compute()

    def set_corner(self, corner: TouchedCorner) -> None:
        """Choose which corner point 1 is."""
        for choice, value in zip(
            self._corner, (corner.end, corner.flange, corner.side), strict=True
        ):
            choice.show_value(value)
        self._compute()

    def apply(self) -> None:
        """Place the beam, in one step that can be undone."""
        if self._placement is None:
            return
        document = self._session.document
        cell = with_placement(document.state.cell, self._placement)
        document.edit("Placement by three points", replace(document.state, cell=cell))
        self.accept()

    def retranslate(self) -> None:
        """Set every text again."""
        tr = self._tr
        self.setWindowTitle(tr("Placement by three touched points"))
        self._how.setText(
            tr(
                "Touch three points of the beam with the tip of a measured tool and enter its "
                "position in fanuc_world (user frame 0). Left is +y, top is +z of the beam."
            )
        )
        words = (
            tr("End"), tr("Flange"), tr("Side"),
        )  # fmt: skip
        for label, text in zip(self._corner_labels, words, strict=True):
            label.setText(text)
        for choice, values, text in zip(self._corner, (ENDS, FLANGES, SIDES), words, strict=True):
            choice.set_choices([(one, tr(one), "") for one in values])
            choice.setAccessibleName(text)
        for label, text, row in zip(self._labels, POINTS, self._numbers, strict=True):
            label.setText(f"{tr(text)} [mm]")
            for editor, axis in zip(row, AXES, strict=True):
                editor.setAccessibleName(f"{tr(text)} {axis}")
        self.apply_button.setText(tr("Apply"))
        self.cancel_button.setText(tr("Cancel"))
        self._compute()

    def retheme(self) -> None:
        """Set every colour again."""
        theme = self._session.look.theme
        self.setStyleSheet(setup_style(theme))
        if self._sketch is not None:
            self._sketch.set_theme(theme)

    def _lay_out(self) -> None:
        self._how = QLabel(self)
        self._how.setWordWrap(True)
        self._sentence = QLabel(self)
        self._sentence.setWordWrap(True)
        self._sentence.setMinimumHeight(3 * self._sentence.fontMetrics().height())
        self._sentence.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self._sketch: BeamSketch | None = None
        if self._workpiece is not None and self._workpiece.section is not None:
            self._sketch = BeamSketch(self._session.look.theme, self._workpiece.section, self)
        self.apply_button = QPushButton(self)
        self.apply_button.setObjectName("primary")
        self.apply_button.setDefault(True)
        self.apply_button.clicked.connect(self.apply)
        self.cancel_button = QPushButton(self)
        self.cancel_button.setAutoDefault(False)
        self.cancel_button.clicked.connect(self.reject)
        buttons = QHBoxLayout()
        buttons.addStretch(1)
        buttons.addWidget(self.cancel_button)
        buttons.addWidget(self.apply_button)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(16, 14, 16, 14)
        layout.setSpacing(10)
        layout.addWidget(self._how)
        if self._sketch is not None:
            layout.addWidget(self._sketch)
        layout.addLayout(self._corner_row())
        layout.addLayout(self._point_rows())
        layout.addWidget(self._sentence)
        layout.addLayout(buttons)
        self.setMinimumWidth(440)

    def _corner_row(self) -> QGridLayout:
        grid = QGridLayout()
        grid.setHorizontalSpacing(8)
        self._corner: list[ChoiceEdit] = []
        self._corner_labels: list[QLabel] = []
        for column, first in enumerate((ENDS[0], FLANGES[0], SIDES[0])):
            label, choice = QLabel(self), ChoiceEdit(parent=self)
            choice.show_value(first)
            choice.chosen.connect(self._compute)
            grid.addWidget(label, 0, column)
            grid.addWidget(choice, 1, column)
            grid.setColumnStretch(column, 1)
            self._corner_labels.append(label)
            self._corner.append(choice)
        return grid

    def _point_rows(self) -> QGridLayout:
        grid = QGridLayout()
        grid.setHorizontalSpacing(8)
        for number in range(3):
            label = QLabel(self)
            grid.addWidget(label, 2 * number, 0, 1, 3)
            self._labels.append(label)
            row = []
            for column, axis in enumerate(AXES):
                editor = NumberEdit(self)
                editor.setProperty("slim", True)
                editor.set_form(2, 1.0, None, None)
                editor.setPrefix(f"{axis} ")
                editor.set_unset(f"{axis} {UNSET}")
                editor.show_number(None)
                editor.entered.connect(self._compute)
                editor.refused.connect(self._compute)
                grid.addWidget(editor, 2 * number + 1, column)
                row.append(editor)
            self._numbers.append(row)
        return grid

    def _refresh(self) -> None:
        state = self._session.document.state
        self._workpiece = facts_of(state.cell, Catalogue(), state.folder, state.files).workpiece
        self._compute()

    def _compute(self) -> None:
        corner = TouchedCorner(*(choice.value for choice in self._corner))
        if self._sketch is not None:
            self._sketch.show_corner(corner)
        self._placement = None
        values = [[editor.number for editor in row] for row in self._numbers]
        if self._workpiece is None or self._workpiece.section is None:
            self._say(self._tr("The beam of the cell cannot be used yet."), False)
        elif refused := [one.refusal for row in self._numbers for one in row if one.refusal]:
            self._say(refusal_words(refused[0], "", self._tr), True)
        elif any(one is None for row in values for one in row):
            self._say(self._tr("Enter all three points."), False)
        else:
            self._compute_from(np.array(values, dtype=np.float64) * MM, corner)
        self.apply_button.setEnabled(self._placement is not None)

    def _compute_from(self, points: FloatArray, corner: TouchedCorner) -> None:
        workpiece = self._workpiece
        if workpiece is None or workpiece.section is None:
            return
        try:
            found = placement_from_points(points, corner, workpiece.section, workpiece.length)
        except InputError as error:
            self._say(error_words(error, self._tr), True)
            return
        self._placement = found
        turned = wpr_from_rotation(found[:3, :3])
        position = ", ".join(decimal(in_mm(float(one)), 2) for one in found[:3, 3])
        angles = ", ".join(decimal(one * DEG_PER_RAD, 3) for one in turned)
        self._say(
            self._tr("Centre of the beam in fanuc_world: {position} mm; W, P, R: {angles}°",
                     position=position, angles=angles), False,
        )  # fmt: skip

    def _say(self, text: str, wrong: bool) -> None:
        self._sentence.setText(text)
        self._sentence.setObjectName("sentence" if wrong else "muted")
        self._sentence.style().unpolish(self._sentence)
        self._sentence.style().polish(self._sentence)
