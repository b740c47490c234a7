"""The tool bar: files, history, planning, the scheme and the export."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QLabel, QMainWindow, QToolBar, QToolButton

from posopt_gui.actions import Actions
from posopt_gui.look import Look
from posopt_gui.views.quiet_editors import QuietCombo
from solver.model.scheme import Scheme


class ToolBar(QToolBar):
    """The actions that are used most, and the choice of the scheme."""

    def __init__(self, parent: QMainWindow, table: Actions, schemes: Sequence[Scheme]) -> None:
        super().__init__(parent)
        self._schemes = tuple(schemes)
        self.setObjectName("main")
        self.setMovable(False)
        self.setIconSize(QSize(18, 18))
        self.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextOnly)
        for group in (("open", "save"), ("undo", "redo"), ("plan", "stop")):
            for name in group:
                self.addAction(table[name])
            self.addSeparator()
        button = self.widgetForAction(table["plan"])
        if isinstance(button, QToolButton):
            button.setObjectName("primary")
        self._words, self.scheme = QLabel(), QuietCombo()
        self._words.setBuddy(self.scheme)
        for scheme in schemes:
            self.scheme.addItem(scheme.value, scheme)
        self.addWidget(self._words)
        self.addWidget(self.scheme)
        for name in ("compare", "live"):
            self.addAction(table[name])
        self.addSeparator()
        self.addAction(table["export"])
        for tool in self.findChildren(QToolButton):
            tool.setFocusPolicy(Qt.FocusPolicy.TabFocus)

    def show_scheme(self, value: object) -> None:
        """Show a scheme by its name in the cell; the first where it is none of them."""
        values = [scheme.value for scheme in self._schemes]
        self.scheme.setCurrentIndex(values.index(value) if value in values else 0)

    def retranslate(self, look: Look) -> None:
        """Set the words again."""
        self.scheme.setToolTip(look.tr("How the graph is searched; exact is proven optimal"))
        self.scheme.setAccessibleName(look.tr("Scheme"))
        self._words.setText(look.tr("Scheme"))
        for row, scheme in enumerate(self._schemes):
            self.scheme.setItemText(row, look.tr(scheme.value))
