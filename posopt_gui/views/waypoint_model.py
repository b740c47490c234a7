"""The table of waypoints for Qt: sorted by number, shown as text."""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import QAbstractTableModel, QModelIndex, QPersistentModelIndex, Qt
from PySide6.QtGui import QFont

from posopt_gui.viewmodels.waypoint_table import WaypointTable

Index = QModelIndex | QPersistentModelIndex

SORT_ROLE = Qt.ItemDataRole.UserRole
"""Role of what a column is sorted by."""

NOWHERE = QModelIndex()


class WaypointModel(QAbstractTableModel):
    """Rows of a `WaypointTable`."""

    def __init__(self, font: QFont) -> None:
        super().__init__()
        self._table: WaypointTable | None = None
        self._font = font

    @property
    def table(self) -> WaypointTable | None:
        """What is shown."""
        return self._table

    def set_table(self, table: WaypointTable | None) -> None:
        """Show another sequence; the view keeps its order and its columns."""
        old = self._table
        same = old is not None and table is not None and len(old) == len(table)
        if same and old is not None and table is not None and old.columns == table.columns:
            self._table = table
            last = self.index(len(table) - 1, len(table.columns) - 1)
            self.dataChanged.emit(self.index(0, 0), last)
            return
        self.beginResetModel()
        self._table = table
        self.endResetModel()

    def retranslate(self) -> None:
        """The heads have changed."""
        # Qt crashes when it is told of heads that do not exist.
        if self.columnCount():
            self.headerDataChanged.emit(Qt.Orientation.Horizontal, 0, self.columnCount() - 1)

    def rowCount(self, parent: Index = NOWHERE) -> int:  # noqa: N802 - Qt's name
        """One row a waypoint."""
        return 0 if parent.isValid() or self._table is None else len(self._table)

    def columnCount(self, parent: Index = NOWHERE) -> int:  # noqa: N802 - Qt's name
        """Those that the cell needs."""
        return 0 if parent.isValid() or self._table is None else len(self._table.columns)

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        """Texts, and the numbers behind them."""
        table = self._table
        if table is None or not index.isValid():
            return None
        if role == Qt.ItemDataRole.DisplayRole:
            return table.text(index.row(), index.column())
        if role == SORT_ROLE:
            return table.key(index.row(), index.column())
        if role == Qt.ItemDataRole.FontRole:
            return self._font
        if role == Qt.ItemDataRole.TextAlignmentRole:
            text = table.columns[index.column()].decimals is None
            side = Qt.AlignmentFlag.AlignLeft if text else Qt.AlignmentFlag.AlignRight
            return side | Qt.AlignmentFlag.AlignVCenter
        return None

    def headerData(  # noqa: N802 - Qt's name
        self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole
    ) -> Any:
        """Heads of the columns with their units."""
        if orientation != Qt.Orientation.Horizontal or self._table is None:
            return None
        if role == Qt.ItemDataRole.DisplayRole:
            return self._table.title(section)
        if role == Qt.ItemDataRole.TextAlignmentRole:
            text = self._table.columns[section].decimals is None
            side = Qt.AlignmentFlag.AlignLeft if text else Qt.AlignmentFlag.AlignRight
            return side | Qt.AlignmentFlag.AlignVCenter
        return None
