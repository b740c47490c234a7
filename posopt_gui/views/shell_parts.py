"""Small parts of the window's frame: a line of words that may be too long, titles of panels."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QAction, QColor, QIcon, QPainter, QPaintEvent, QPalette, QPen, QPixmap
from PySide6.QtWidgets import (
    QDockWidget,
    QHBoxLayout,
    QLabel,
    QMenu,
    QSizePolicy,
    QToolButton,
    QWidget,
)

from posopt_gui.theme import Theme

ICON = 14
"""Side of a title's icon [px]."""


class ElidedLabel(QLabel):
    """One line of words; what there is no room for is in the tool tip.

    A plain label would keep the window as wide as the longest sentence.
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.setTextFormat(Qt.TextFormat.PlainText)

    def tell(self, text: str, colour: str = "") -> None:
        """Show a sentence, in a colour where one is given."""
        self.setStyleSheet(f"color: {colour};" if colour else "")
        self.setText(text)
        self.setToolTip(text)

    def minimumSizeHint(self) -> QSize:  # noqa: N802 - Qt's name
        """Only the height counts."""
        return QSize(0, super().minimumSizeHint().height())

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 - Qt's name
        """Draw as many words as there is room for."""
        painter = QPainter(self)
        painter.setPen(self.palette().color(QPalette.ColorRole.WindowText))
        room = self.contentsRect()
        one_line = " ".join(self.text().split())
        words = self.fontMetrics().elidedText(one_line, Qt.TextElideMode.ElideRight, room.width())
        painter.drawText(room, int(Qt.AlignmentFlag.AlignVCenter), words)


def title_icon(kind: str, colour: str) -> QIcon:
    """An icon 'float' or 'close' in a colour."""
    scale = 3
    pixmap = QPixmap(QSize(ICON, ICON) * scale)
    pixmap.fill(Qt.GlobalColor.transparent)
    painter = QPainter(pixmap)
    painter.scale(scale, scale)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setPen(QPen(QColor(colour), 1.2))
    if kind == "close":
        painter.drawLine(QPointF(3.5, 3.5), QPointF(10.5, 10.5))
        painter.drawLine(QPointF(3.5, 10.5), QPointF(10.5, 3.5))
    else:
        painter.drawRect(QRectF(2.5, 5.0, 6.5, 6.5))
        painter.drawPolyline([QPointF(5.0, 5.0), QPointF(5.0, 2.5), QPointF(11.5, 2.5),
                              QPointF(11.5, 9.0), QPointF(9.0, 9.0)])  # fmt: skip
    painter.end()
    pixmap.setDevicePixelRatio(scale)
    return QIcon(pixmap)


class PanelTitle(QWidget):
    """Title of a panel at the window's side: its name, and buttons to float and to close it."""

    def __init__(self, dock: QDockWidget) -> None:
        super().__init__(dock)
        self._words = QLabel()
        self._words.setObjectName("panelTitle")
        self._buttons = {"float": QToolButton(), "close": QToolButton()}
        row = QHBoxLayout(self)
        row.setContentsMargins(12, 5, 8, 5)
        row.setSpacing(2)
        row.addWidget(self._words, 1)
        for button in self._buttons.values():
            button.setObjectName("panelButton")
            button.setIconSize(QSize(ICON, ICON))
            button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
            row.addWidget(button)
        self._buttons["float"].clicked.connect(lambda: dock.setFloating(not dock.isFloating()))
        self._buttons["close"].clicked.connect(dock.close)
        dock.windowTitleChanged.connect(self._words.setText)
        self._words.setText(dock.windowTitle())

    def retranslate(self, tr: Callable[..., str]) -> None:
        """Set the tool tips; the name is the panel's own."""
        for name, text in (
            ("float", tr("Take the panel out of the window, or put it back")),
            ("close", tr("Close the panel; the menu View opens it again")),
        ):
            self._buttons[name].setToolTip(text)
            self._buttons[name].setAccessibleName(text)

    def retheme(self, theme: Theme) -> None:
        """Draw the icons in the theme's colour."""
        for name, button in self._buttons.items():
            button.setIcon(title_icon(name, theme.muted))


class RecentMenu(QMenu):
    """Files that were opened or saved before, and a way to forget them."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)

    def show_files(
        self,
        files: tuple[Path, ...],
        open_file: Callable[[Path], object],
        forget: Callable[[], object],
        tr: Callable[..., str],
    ) -> None:
        """List the files, the last one first."""
        self.clear()
        self.setTitle(tr("Open recent"))
        self.setEnabled(bool(files))
        for number, path in enumerate(files):
            key = f"&{number + 1}  " if number < 9 else ""
            action = QAction(key + path.name.replace("&", "&&"), self)
            action.setToolTip(str(path))
            action.triggered.connect(lambda _=False, one=path: open_file(one))
            self.addAction(action)
        self.setToolTipsVisible(True)
        self.addSeparator()
        clear = QAction(tr("Clear the list"), self)
        clear.triggered.connect(lambda _=False: forget())
        self.addAction(clear)
