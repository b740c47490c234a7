"""Table of the measures of each joint and the gains over the references."""

from __future__ import annotations

import math
from collections.abc import Sequence as Rows

from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QFont
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHeaderView,
    QTableWidget,
    QTableWidgetItem,
    QWidget,
)

from posopt_gui.theme import LIGHT, Theme
from posopt_gui.viewmodels.curves_model import MeasureRow
from posopt_gui.views.result_tables import copy_selection, tabular


class MeasuresTable(QTableWidget):
    """Rows of measures under their headings, joints as columns."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(0, 6, parent)
        self._theme: Theme = LIGHT
        self._rows: list[MeasureRow] = []
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setShowGrid(False)
        self.setHorizontalHeaderLabels([f"J{joint}" for joint in range(1, 7)])
        self.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.Stretch)
        self.horizontalHeader().setDefaultAlignment(
            Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        )
        self.verticalHeader().setSectionResizeMode(QHeaderView.ResizeMode.Fixed)
        self.verticalHeader().setDefaultSectionSize(22)
        copy_selection(self)

    def set_theme(self, theme: Theme) -> None:
        """Set all colours again."""
        self._theme = theme
        self.set_rows(self._rows)

    def set_rows(self, rows: Rows[MeasureRow]) -> None:
        """Show these rows."""
        self._rows = list(rows)
        self.setRowCount(len(self._rows))
        for number, row in enumerate(self._rows):
            label = row.label if row.heading else f"   {row.label}"
            header = self.verticalHeaderItem(number)
            if header is None or header.text() != label:
                header = QTableWidgetItem(label)
                font = QFont(self.font())
                font.setBold(row.heading)
                header.setFont(font)
                self.setVerticalHeaderItem(number, header)
            for column in range(6):
                self._fill(number, column, row)

    def _fill(self, number: int, column: int, row: MeasureRow) -> None:
        item = self.item(number, column)
        if item is None:
            item = QTableWidgetItem()
            item.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
            item.setFont(tabular(self.font()))
            self.setItem(number, column, item)
        item.setText(row.texts[column] if row.texts else "")
        gain = row.gains[column] if row.gains else math.nan
        colour = self._theme.text
        if math.isfinite(gain) and abs(gain) >= 0.005:
            colour = self._theme.good if gain < 0.0 else self._theme.warning
        item.setForeground(QColor(colour))
        item.setBackground(QColor(self._theme.raised if row.heading else self._theme.surface))
