"""A strip of the plan's numbers: each with its name above it."""

from __future__ import annotations

from collections.abc import Sequence as Rows

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QGridLayout, QLabel, QWidget

from posopt_gui.theme import LIGHT, Theme
from posopt_gui.viewmodels.results_model import Total
from posopt_gui.views.result_tables import tabular

SPACING = 18
"""Room between two numbers [px]."""

LEAST_WIDTH = 240


class TotalsStrip(QWidget):
    """Numbers side by side; one that stands for a waypoint can be clicked.

    Where there is no room for all, the last ones are left out; the inspector has them too.
    """

    waypoint_wanted = Signal(int)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._theme: Theme = LIGHT
        self._totals: tuple[Total, ...] = ()
        self._sentence = ""
        self._waypoint = "{number}"
        self._old = False
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(10, 8, 10, 6)
        self._grid.setHorizontalSpacing(SPACING)
        self._grid.setSizeConstraint(QGridLayout.SizeConstraint.SetNoConstraint)
        self._grid.setVerticalSpacing(1)
        self._names: list[QLabel] = []
        self._values: list[QLabel] = []
        self._empty = QLabel()
        self._stale = QLabel()
        self._stale.hide()

    @property
    def texts(self) -> dict[str, str]:
        """What is shown, by its name."""
        return {one.label: one.value for one in self._totals}

    def set_theme(self, theme: Theme) -> None:
        """Set all colours again."""
        self._theme = theme
        self._show()

    def set_totals(
        self, totals: Rows[Total], sentence: str = "", waypoint: str = "{number}"
    ) -> None:
        """Show numbers, or a sentence instead; `waypoint` names the {number} of a link."""
        self._totals, self._sentence, self._waypoint = tuple(totals), sentence, waypoint
        self._show()

    def set_stale(self, stale: bool, words: str) -> None:
        """Say that the numbers are those of older inputs."""
        self._stale.setText(words)
        self._stale.setVisible(stale and bool(self._totals))
        self._old = stale
        self._show()

    def minimumSizeHint(self) -> QSize:  # noqa: N802 - Qt's name
        """The window must not become wider because of the numbers."""
        return QSize(LEAST_WIDTH, super().minimumSizeHint().height())

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        """Show as many numbers as there is room for."""
        super().resizeEvent(event)
        self._fit()

    def _fit(self) -> None:
        beside = (self._stale, self._empty)
        room = (
            self.width()
            - 20
            - sum(
                one.sizeHint().width() + SPACING
                for one in beside
                if not one.isHidden() and one.text()
            )
        )
        for index, (name, value) in enumerate(zip(self._names, self._values, strict=True)):
            room -= max(name.sizeHint().width(), value.sizeHint().width()) + SPACING
            shown = index < len(self._totals) and (room + SPACING >= 0 or index == 0)
            name.setVisible(shown)
            value.setVisible(shown)

    def _show(self) -> None:
        while len(self._names) < len(self._totals):
            self._add()
        columns = len(self._names) + 1
        for column in range(columns):
            # What stretched with fewer numbers would keep a gap behind its own.
            self._grid.setColumnStretch(column, 0)
        self._grid.addWidget(self._empty, 0, columns)
        self._grid.addWidget(self._stale, 1, columns)
        self._grid.setColumnStretch(columns, 1)
        self._empty.setText(self._sentence)
        self._empty.setVisible(bool(self._sentence))
        self._stale.setStyleSheet(f"color: {self._theme.warning}; font-weight: 600;")
        colours = {
            "good": self._theme.good, "near": self._theme.warning, "bad": self._theme.error,
        }  # fmt: skip
        for index, (name, value) in enumerate(zip(self._names, self._values, strict=True)):
            if index >= len(self._totals):
                break
            total = self._totals[index]
            name.setText(total.label)
            name.setStyleSheet(f"color: {self._theme.muted};")
            colour = colours.get(total.state, self._theme.text)
            link = self._theme.accent
            if self._old:
                colour = link = self._theme.muted
            text = total.value
            if total.waypoint is not None:
                words = self._waypoint.format(number=total.waypoint + 1)
                text += (
                    f' <a href="{total.waypoint}" style="color:{link};'
                    f'text-decoration:none">{words}</a>'
                )
            value.setText(text)
            value.setStyleSheet(f"color: {colour}; font-weight: 600;")
            value.setAccessibleName(f"{total.label} {total.value}")
        self._fit()

    def _add(self) -> None:
        column = len(self._names)
        name, value = QLabel(), QLabel()
        value.setFont(tabular(self.font()))
        value.setTextFormat(Qt.TextFormat.RichText)
        value.setTextInteractionFlags(Qt.TextInteractionFlag.TextBrowserInteraction)
        value.linkActivated.connect(lambda link: self.waypoint_wanted.emit(int(link)))
        self._grid.addWidget(name, 0, column)
        self._grid.addWidget(value, 1, column)
        self._names.append(name)
        self._values.append(value)
