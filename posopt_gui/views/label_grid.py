"""A grid of labels whose rows are exchanged often; labels are made once and used again."""

from __future__ import annotations

import re
from collections.abc import Sequence as Rows
from dataclasses import dataclass
from typing import Final

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QGridLayout, QLabel, QSizePolicy, QWidget

from posopt_gui.views.result_tables import tabular


@dataclass(frozen=True, slots=True)
class Text:
    """A text in a colour, with what is `beside` it and a line `below` it in another one."""

    words: str
    colour: str
    right: bool = False
    beside: str = ""
    below: str = ""
    below_colour: str = ""

    @property
    def html(self) -> str:
        """As rich text."""
        words = f'<span style="color:{self.colour}">{self.words}</span>'
        beside = f' <span style="color:{self.below_colour}">{self.beside}</span>'
        return words + beside if self.beside else words

    @property
    def html_below(self) -> str:
        """The smaller line as rich text."""
        return f'<span style="color:{self.below_colour}">{self.below}</span>'


ONE_LINE = 30
"""Most characters of words that stand in one line."""

CHINESE: Final = "国"
"""A character that is as high as any other of its kind."""

_TAGS = re.compile("<[^>]*>")


class LabelGrid(QWidget):
    """Rows of texts; the second column takes the room that is left, and wraps."""

    link_activated = Signal(str)

    def __init__(self, columns: int, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._columns = columns
        self._labels: list[list[QLabel]] = []
        self._below: list[QLabel] = []
        self._rows: tuple[tuple[Text, ...], ...] = ()
        self._line = QLabel(CHINESE).sizeHint().height()
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(0, 2, 0, 2)
        self._grid.setHorizontalSpacing(8)
        self._grid.setVerticalSpacing(2)
        self._grid.setColumnStretch(1, 1)

    @property
    def texts(self) -> list[list[str]]:
        """The words that are shown."""
        return [[one.words for one in row] for row in self._rows]

    def set_rows(self, rows: Rows[tuple[Text, ...]]) -> None:
        """Show these rows."""
        if tuple(rows) == self._rows:
            return
        self._rows = tuple(rows)
        while len(self._labels) < len(self._rows):
            self._add()
        # Rows of Latin letters alone would stand closer to each other.
        words = "".join(row[0].words + row[1].words for row in self._rows)
        line = self._line if re.search("[\u4e00-\u9fff]", words) else 0
        for index, (labels, below) in enumerate(zip(self._labels, self._below, strict=True)):
            shown = index < len(self._rows)
            lower = next((one for one in self._rows[index] if one.below), None) if shown else None
            self._grid.setRowMinimumHeight(2 * index, line if shown else 0)
            self._grid.setRowMinimumHeight(2 * index + 1, line if lower is not None else 0)
            below.setVisible(lower is not None)
            if lower is not None:
                below.setText(lower.html_below)
            height = Qt.AlignmentFlag.AlignTop
            if shown and len(_TAGS.sub("", self._rows[index][1].words)) <= ONE_LINE:
                # Chinese lines are higher than those of numbers: they share their middle.
                height = Qt.AlignmentFlag.AlignVCenter
            for column, label in enumerate(labels):
                label.setVisible(shown)
                if shown:
                    text = self._rows[index][column]
                    label.setText(text.html)
                    side = Qt.AlignmentFlag.AlignRight if text.right else Qt.AlignmentFlag.AlignLeft
                    label.setAlignment(side | height)

    def _add(self) -> None:
        row = []
        for column in range(self._columns):
            label = QLabel()
            label.setFont(tabular(self.font()))
            label.setTextFormat(Qt.TextFormat.RichText)
            label.setWordWrap(column == 1)
            if column == 1:
                label.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
                label.setTextInteractionFlags(Qt.TextInteractionFlag.TextBrowserInteraction)
                label.linkActivated.connect(self.link_activated)
            self._grid.addWidget(label, 2 * len(self._labels), column)
            row.append(label)
        below = QLabel()
        below.setTextFormat(Qt.TextFormat.RichText)
        below.setWordWrap(True)
        self._grid.addWidget(below, 2 * len(self._labels) + 1, 1, 1, self._columns - 1)
        self._labels.append(row)
        self._below.append(below)
