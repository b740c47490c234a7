"""A table of checks: what failed first, a click goes to the waypoint."""

from __future__ import annotations

from typing import Any, Final

from PySide6.QtCore import (
    QLocale,
    QModelIndex,
    QPersistentModelIndex,
    QSignalBlocker,
    Qt,
    QTimer,
    Signal,
)
from PySide6.QtGui import QBrush, QColor, QPalette, QResizeEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHeaderView,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QTableWidget,
    QTableWidgetItem,
    QWidget,
)

from posopt_gui.look import Look
from posopt_gui.viewmodels.export_model import CheckRow

HEADERS: Final = ("", "Check", "Value", "Limit", "Detail")
WIDTHS: Final = {1: (25, 190), 2: (19, 140), 3: (19, 140)}
"""Columns with their share of the width [%] and their largest width; the detail gets the rest."""

CHINESE_BLANK: Final = "\N{IDEOGRAPHIC SPACE}"


class VerdictDelegate(QStyledItemDelegate):
    """Words that keep their colour in a chosen row."""

    def initStyleOption(  # noqa: N802 - Qt's name
        self, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex
    ) -> None:
        """What is chosen is told by the ground alone."""
        super().initStyleOption(option, index)
        brush = index.data(Qt.ItemDataRole.ForegroundRole)
        if brush is not None:
            option.palette.setBrush(QPalette.ColorRole.HighlightedText, brush)


class FigureDelegate(QStyledItemDelegate):
    """Figures that stand on the line of the Chinese words beside them."""

    def __init__(self, look: Look, parent: QWidget) -> None:
        super().__init__(parent)
        self._look = look

    def displayText(  # noqa: N802 - Qt's name
        self, value: Any, locale: QLocale | QLocale.Language
    ) -> str:
        """A blank as high as a Chinese character makes a line of Latin letters as high."""
        text = super().displayText(value, locale)
        return f"{text}{CHINESE_BLANK}" if self._look.language == "zh_CN" else text


class CheckTable(QTableWidget):
    """Shows rows of checks.

    For a clicked row `waypoint_chosen` carries its waypoint from 0, and `line_chosen` the file
    and line of the program that it names.
    """

    waypoint_chosen = Signal(int)
    line_chosen = Signal(str, int)

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(0, len(HEADERS), parent)
        self._look = look
        self._rows: tuple[CheckRow, ...] = ()
        self._old = False
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.setVerticalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.setTabKeyNavigation(False)
        self.setShowGrid(False)
        self.setWordWrap(True)
        self.setTextElideMode(Qt.TextElideMode.ElideNone)
        self.verticalHeader().hide()
        header = self.horizontalHeader()
        header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        header.setHighlightSections(False)
        header.setStretchLastSection(True)
        header.setSectionResizeMode(0, QHeaderView.ResizeMode.ResizeToContents)
        # The last column gets its width after the others: rows are fitted when all have theirs.
        self._fitting = QTimer(self)
        self._fitting.setSingleShot(True)
        self._fitting.setInterval(0)
        self._fitting.timeout.connect(self.resizeRowsToContents)
        header.sectionResized.connect(lambda *_: self._fitting.start())
        self.setItemDelegate(FigureDelegate(look, self))
        self.setItemDelegateForColumn(0, VerdictDelegate(self))
        self.clicked.connect(self._choose)
        self.activated.connect(self._choose)

    def show_rows(self, rows: tuple[CheckRow, ...], *, old: bool) -> None:
        """Fill the table; `old` rows are dimmed, since they belong to something before."""
        if (rows, old) == (self._rows, self._old):
            return
        chosen, anew = self._chosen_name(), _outcomes(rows) != _outcomes(self._rows)
        self._rows, self._old = rows, old
        self._fill()
        self._choose_again(chosen, anew=anew)

    def _chosen_name(self) -> str:
        chosen = self.selectionModel().selectedRows()
        place = chosen[0].row() if chosen else -1
        return self._rows[place].name if 0 <= place < len(self._rows) else ""

    def _choose_again(self, name: str, *, anew: bool) -> None:
        """Keep a chosen check by its name; what newly failed is shown and chosen first."""
        names = [row.name for row in self._rows]
        failed = bool(self._rows) and not self._rows[0].passed
        place = names.index(name) if name in names else -1
        if anew and failed and not self._old:
            place = 0
        scrolled = self.verticalScrollBar().value()
        self.setCurrentIndex(QModelIndex())
        if place >= 0:
            self.selectRow(place)
        self.verticalScrollBar().setValue(0 if anew else scrolled)

    def retranslate(self) -> None:
        """Set the headers in the chosen language; the rows come with their words."""
        self.setHorizontalHeaderLabels([self._look.tr(one) if one else "" for one in HEADERS])
        self.setAccessibleName(self._look.tr("Checks of the program"))

    def retheme(self) -> None:
        """Set the colours again."""
        self._fill()

    def _fill(self) -> None:
        tip = self._look.tr("Click to go to its waypoint and its line of the program")
        self.setRowCount(len(self._rows))
        for number, row in enumerate(self._rows):
            cells = (row.word, row.name, row.value, row.limit, row.detail)
            for column, text in enumerate(cells):
                item = QTableWidgetItem(text)
                item.setForeground(self._brush(row, column))
                item.setTextAlignment(Qt.AlignmentFlag.AlignTop | Qt.AlignmentFlag.AlignLeft)
                leads = row.waypoint is not None or row.line is not None
                item.setToolTip(f"{text}\n{tip}" if leads else text)
                if column == 0 or not row.passed:
                    font = item.font()
                    font.setBold(True)
                    item.setFont(font)
                self.setItem(number, column, item)
        self.resizeRowsToContents()
        self._fitting.start()

    def _brush(self, row: CheckRow, column: int) -> QBrush:
        theme = self._look.theme
        colour = theme.text
        if self._old:
            colour = theme.muted
        elif column == 0:
            colour = theme.good if row.passed else theme.error
        return QBrush(QColor(colour))

    def _choose(self, index: QModelIndex) -> None:
        row = self._rows[index.row()]
        if row.line is not None:
            self.line_chosen.emit(row.file, row.line)
        if row.waypoint is not None:
            self.waypoint_chosen.emit(row.waypoint)

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        """Break the lines anew for another width."""
        super().resizeEvent(event)
        header, room = self.horizontalHeader(), self.viewport().width()
        with QSignalBlocker(header):
            for column, (share, widest) in WIDTHS.items():
                header.resizeSection(column, min(room * share // 100, widest))
        self.resizeRowsToContents()
        self._fitting.start()


def _outcomes(rows: tuple[CheckRow, ...]) -> tuple[tuple[str, bool], ...]:
    return tuple((row.name, row.passed) for row in rows)
