"""What tables of numbers share: tabular figures, copying as tab-separated text."""

from __future__ import annotations

from PySide6.QtCore import QModelIndex, QPersistentModelIndex, QRectF, Qt
from PySide6.QtGui import (
    QAction,
    QColor,
    QFont,
    QGuiApplication,
    QIcon,
    QKeySequence,
    QPainter,
    QPen,
    QPixmap,
)
from PySide6.QtWidgets import QStyledItemDelegate, QStyleOptionViewItem, QTableView


def tabular(font: QFont) -> QFont:
    """The font with figures of one width."""
    made = QFont(font)
    if hasattr(made, "setFeature"):  # Qt 6.7 and later
        made.setFeature(QFont.Tag("tnum"), 1)
    return made


def selection_as_tsv(table: QTableView) -> str:
    """The selected rows, or all where none is, with the heads of their columns."""
    model = table.model()
    rows = sorted({index.row() for index in table.selectionModel().selectedIndexes()})
    if not rows:
        rows = list(range(model.rowCount()))
    columns = [c for c in range(model.columnCount()) if not table.isColumnHidden(c)]
    horizontal, vertical = Qt.Orientation.Horizontal, Qt.Orientation.Vertical
    named = table.verticalHeader().isVisibleTo(table)
    head = [str(model.headerData(column, horizontal) or "") for column in columns]
    lines = ["\t".join(["", *head] if named else head).replace("\n", " ")]
    for row in rows:
        cells = [str(model.index(row, c, QModelIndex()).data() or "") for c in columns]
        name = [str(model.headerData(row, vertical) or "").strip()] if named else []
        lines.append("\t".join([*name, *cells]))
    # Spreadsheets read the plain minus only.
    return "\n".join(lines).replace("−", "-") + "\n"


def pad_cells(table: QTableView) -> None:
    """Keep a number and the text beside it apart."""
    table.setItemDelegate(_Padded(table))


class _Padded(QStyledItemDelegate):
    """Draws cells with room to both sides."""

    def initStyleOption(  # noqa: N802 - Qt's name
        self, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex
    ) -> None:
        """Shrink the place of the text, while the background fills the cell."""
        super().initStyleOption(option, index)
        option.text = f" {option.text} "


def sign_icon(sign: str, colour: str) -> QIcon:
    """A sign in a circle."""
    side, scale = 16, 3
    pixmap = QPixmap(side * scale, side * scale)
    pixmap.fill(Qt.GlobalColor.transparent)
    painter = QPainter(pixmap)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.scale(scale, scale)
    painter.setPen(QPen(QColor(colour), 1.4))
    painter.drawEllipse(QRectF(1.0, 1.0, side - 2.0, side - 2.0))
    font = QFont(QGuiApplication.font())
    font.setPixelSize(11)
    font.setBold(True)
    painter.setFont(font)
    painter.drawText(QRectF(0.0, 0.0, side, side), Qt.AlignmentFlag.AlignCenter, sign)
    painter.end()
    pixmap.setDevicePixelRatio(scale)
    return QIcon(pixmap)


def copy_selection(table: QTableView) -> QAction:
    """Let Ctrl+C copy the table's selection as tab-separated text; returns the action."""
    action = QAction(table)
    action.setShortcut(QKeySequence(QKeySequence.StandardKey.Copy))
    action.setShortcutContext(Qt.ShortcutContext.WidgetWithChildrenShortcut)
    action.triggered.connect(lambda: QGuiApplication.clipboard().setText(selection_as_tsv(table)))
    table.addAction(action)
    return action
