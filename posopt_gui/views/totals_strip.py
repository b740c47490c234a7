"""A strip of the plan's numbers: each with its name above it."""

from __future__ import annotations

from collections.abc import Sequence as Rows

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QGridLayout, QLabel, QWidget

from posopt_gui.theme import LIGHT, Theme
from posopt_gui.viewmodels.results_model import Total
from posopt_gui.views.result_tables import tabular


class TotalsStrip(QWidget):
    """Numbers side by side; one that stands for a waypoint can be clicked."""

    waypoint_wanted = Signal(int)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._theme: Theme = LIGHT
        self._totals: tuple[Total, ...] = ()
        self._sentence = ""
        self._waypoint = "{number}"
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(10, 8, 10, 6)
        self._grid.setHorizontalSpacing(18)
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
        for label in (*self._names, *self._values):
            label.setEnabled(not stale)

    def _show(self) -> None:
        while len(self._names) < len(self._totals):
            self._add()
        columns = len(self._names) + 1
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
            shown = index < len(self._totals)
            name.setVisible(shown)
            value.setVisible(shown)
            if not shown:
                continue
            total = self._totals[index]
            name.setText(total.label)
            name.setStyleSheet(f"color: {self._theme.muted};")
            colour = colours.get(total.state, self._theme.text)
            text = total.value
            if total.waypoint is not None:
                words = self._waypoint.format(number=total.waypoint + 1)
                text += (
                    f' <a href="{total.waypoint}" style="color:{self._theme.accent};'
                    f'text-decoration:none">{words}</a>'
                )
            value.setText(text)
            value.setStyleSheet(f"color: {colour}; font-weight: 600;")
            value.setAccessibleName(f"{total.label} {total.value}")

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
