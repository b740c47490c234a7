"""Legend, colour bar and the card beside the mouse."""

from __future__ import annotations

import html
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPoint, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import (
    QColor,
    QFont,
    QFontMetricsF,
    QImage,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QResizeEvent,
)
from PySide6.QtWidgets import (
    QFrame,
    QHBoxLayout,
    QLabel,
    QSizePolicy,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from posopt_gui.theme import Theme
from posopt_gui.viewmodels.map_colours import FIRST_INDEX, ByteArray, Scale
from posopt_gui.viewmodels.map_readings import Card
from posopt_gui.views.shell_parts import ElidedLabel

CHIP = 13.0
GAP = 16.0
ROW = 22.0
BAR_WIDTH, NARROW_BAR = 240.0, 160.0
"""Length of a colour bar [px], and in a legend that is narrower than `NARROW`."""

NARROW = 800

BAR_FOOT = 27.0
"""Height of a bar with the numbers below it [px]."""

MARGIN = 8.0
LEAST_HEIGHT = 28
NOTICE_ROOM = 250.0
"""Least width [px] that the legend leaves a notice in one of its rows."""


@dataclass(frozen=True, slots=True, eq=False)
class Chip:
    """A colour with its letter and what it stands for."""

    colour: QColor
    letter: str
    letter_colour: QColor
    text: str


@dataclass(frozen=True, slots=True, eq=False)
class Bar:
    """A colour bar: its title, scale and table of colours."""

    title: str
    scale: Scale
    table: ByteArray


class LegendStrip(QWidget):
    """Colour bar and chips in one row, or in more where there is no room.

    One row always has room for a notice beside its chips, so that neither covers the other and
    nothing jumps when the notice comes and goes; `arranged` tells that this room is another one.
    """

    arranged = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._bar: Bar | None = None
        self._chips: tuple[Chip, ...] = ()
        self._text, self._border = QColor(), QColor()
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)

    def set_legend(self, bar: Bar | None, chips: Sequence[Chip], theme: Theme) -> None:
        """Show another legend."""
        self._bar, self._chips = bar, tuple(chips)
        self._text, self._border = QColor(theme.text), QColor(theme.border)
        words = [bar.title] if bar is not None else []
        self.setAccessibleDescription(", ".join(words + [chip.text for chip in chips]))
        self._fit()
        self.update()

    def sizeHint(self) -> QSize:  # noqa: N802 - Qt's name
        """As high as the rows need."""
        return QSize(200, self.minimumHeight())

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        """Chips that no longer fit go to the next row."""
        super().resizeEvent(event)
        self._fit()

    def _font(self) -> QFont:
        font = QFont(self.font())
        font.setPixelSize(11)
        return font

    def _fit(self) -> None:
        height = max(int(self.free_row().y() + ROW), LEAST_HEIGHT)
        if self._chips:
            height = max(height, int(self._places()[-1].y() + ROW))
        if height != self.minimumHeight() or height != self.maximumHeight():
            self.setFixedHeight(height)
        self.arranged.emit()

    def free_row(self) -> QRectF:
        """Where a notice covers nothing: right of the chips of a row, or a row of its own."""
        ends = {0.0: self._bar_end()}
        for chip, place in zip(self._chips, self._places(), strict=True):
            ends[place.y()] = place.x() + self._chip_width(chip) + GAP
        y, left = min(ends.items(), key=lambda one: (one[1], one[0]))
        room = self.width() - MARGIN - left
        if room < NOTICE_ROOM:
            # A whole row: below the chips, and below the numbers of a bar.
            y, left = max(ends) + (ROW if self._chips else 0.0), MARGIN
            y = max(y, BAR_FOOT) if self._bar is not None else y
            room = self.width() - MARGIN - left
        return QRectF(left, y, max(room, 80.0), ROW)

    def _bar_width(self) -> float:
        return BAR_WIDTH if self.width() >= NARROW else NARROW_BAR

    def _bar_end(self) -> float:
        if self._bar is None:
            return MARGIN
        metrics = QFontMetricsF(self._font())
        title = metrics.horizontalAdvance(self._bar.title)
        return MARGIN + title + 8.0 + self._bar_width() + 1.5 * GAP

    def _chip_width(self, chip: Chip) -> float:
        return CHIP + 5.0 + QFontMetricsF(self._font()).horizontalAdvance(chip.text)

    def _places(self) -> list[QPointF]:
        start = self._bar_end()
        x, y = start, 0.0
        places = []
        for chip in self._chips:
            width = self._chip_width(chip)
            if x + width > self.width() - MARGIN and x > start:
                x, y = start, y + ROW
            places.append(QPointF(x, y))
            x += width + GAP
        return places

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 - Qt's name
        """Draw bar and chips."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)
        painter.setFont(self._font())
        if self._bar is not None:
            self._draw_bar(painter, self._bar)
        for chip, place in zip(self._chips, self._places(), strict=True):
            self._draw_chip(painter, chip, place)

    def _draw_chip(self, painter: QPainter, chip: Chip, place: QPointF) -> None:
        box = QRectF(place.x(), place.y() + (ROW - CHIP) / 2.0, CHIP, CHIP)
        painter.setPen(self._border)
        painter.setBrush(chip.colour)
        painter.drawRoundedRect(box, 2.0, 2.0)
        if chip.letter:
            font = self._font()
            font.setBold(True)
            painter.setFont(font)
            painter.setPen(chip.letter_colour)
            painter.drawText(box, Qt.AlignmentFlag.AlignCenter, chip.letter)
            painter.setFont(self._font())
        painter.setPen(self._text)
        left = place.x() + CHIP + 5.0
        words = QRectF(left, place.y(), max(self.width() - left, 0.0), ROW)
        painter.drawText(words, Qt.AlignmentFlag.AlignVCenter, chip.text)

    def _draw_bar(self, painter: QPainter, bar: Bar) -> None:
        metrics = QFontMetricsF(self._font())
        painter.setPen(self._text)
        title = metrics.horizontalAdvance(bar.title)
        painter.drawText(QPointF(MARGIN, 15.0), bar.title)
        box = QRectF(MARGIN + title + 10.0, 2.0, self._bar_width(), 10.0)
        colours = bar.table[FIRST_INDEX:]
        row = np.ascontiguousarray((colours[::-1] if bar.scale.reverse else colours)[None])
        image = QImage(row.data, row.shape[1], 1, 4 * row.shape[1], QImage.Format.Format_RGBA8888)
        painter.drawImage(box, image)
        painter.setPen(self._border)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawRect(box)
        painter.setPen(self._text)
        free = box.left() - 30.0
        for tick in sorted(bar.scale.ticks(), key=lambda one: one.share):
            x = box.left() + tick.share * box.width()
            painter.drawLine(QPointF(x, box.bottom()), QPointF(x, box.bottom() + 3.0))
            half = metrics.horizontalAdvance(tick.text) / 2.0
            if x - half < free:
                continue
            free = x + half + 4.0
            words = QRectF(x - 30.0, box.bottom() + 3.0, 60.0, 12.0)
            painter.drawText(words, Qt.AlignmentFlag.AlignCenter, tick.text)
        if bar.scale.low < bar.scale.mark < bar.scale.high:
            share = float(bar.scale.place(np.array([bar.scale.mark]))[0])
            x = box.left() + share * box.width()
            painter.setPen(QPen(self._text, 2.0))
            painter.drawLine(QPointF(x, box.top() - 2.0), QPointF(x, box.bottom() + 4.0))


class HoverCard(QFrame):
    """What stands under the mouse; it never takes the mouse itself."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._room = parent
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setObjectName("map_card")
        self._label = QLabel(self)
        self._label.setTextFormat(Qt.TextFormat.RichText)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(10, 8, 10, 8)
        layout.addWidget(self._label)
        self.hide()

    @property
    def text(self) -> str:
        """What the card says, with its mark-up."""
        return self._label.text()

    def set_theme(self, theme: Theme) -> None:
        """Colours of the card."""
        self.setStyleSheet(
            f"#map_card {{ background: {theme.surface}; border: 1px solid {theme.border};"
            f" border-radius: 4px; }} #map_card QLabel {{ color: {theme.text};"
            " font-size: 11px; background: transparent; }"
        )

    def show_card(self, card: Card, colour: QColor, theme: Theme, mouse: QPoint) -> None:
        """Show a card beside the mouse."""
        self._label.setText(_card_html(card, colour.name(), theme))
        self.place(mouse)

    def show_text(self, text: str, mouse: QPoint, colour: str) -> None:
        """Show a short text beside the mouse."""
        self._label.setText(f'<b style="color:{colour}">{text}</b>')
        self.place(mouse)

    def place(self, mouse: QPoint) -> None:
        """Stand beside the mouse, on the side where there is room."""
        window = self._room.window()
        if self.parentWidget() is not window:
            # Over the whole window: a low map has no room for a long card.
            self.setParent(window)
        self.adjustSize()
        room, place = window.size(), self._room.mapTo(window, mouse)
        x, y = place.x() + 18, place.y() + 14
        if x + self.width() > room.width():
            x = place.x() - 18 - self.width()
        y = min(y, room.height() - self.height() - 4)
        self.move(max(x, 2), max(y, 2))
        self.show()
        self.raise_()


class Notice(QFrame):
    """A sentence in the legend's row, in the colour of what it tells; it can be clicked.

    It stands beside the chips and covers none of them, and nothing of the map; where the row is
    too short, the rest is in the tool tip. A button beside it can offer what helps.
    """

    clicked = Signal()
    acted = Signal()

    def __init__(self, parent: LegendStrip) -> None:
        super().__init__(parent)
        self._room = parent
        self.setObjectName("map_notice")
        self._label = ElidedLabel(self)
        self.button = QToolButton(self)
        self.button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.button.clicked.connect(self.acted)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(8, 0, 4, 0)
        layout.setSpacing(8)
        layout.addWidget(self._label, 1)
        layout.addWidget(self.button)
        self._theme: Theme | None = None
        self._severity = "info"
        parent.arranged.connect(self._place)
        self.hide()

    @property
    def text(self) -> str:
        """What it says."""
        return self._label.text()

    def set_theme(self, theme: Theme) -> None:
        """Colours of the sentence."""
        self._theme = theme
        edge = {"error": theme.error, "warning": theme.warning}.get(self._severity, theme.muted)
        self.setStyleSheet(
            f"#map_notice {{ background: {theme.surface}; border: 1px solid {theme.border};"
            f" border-left: 4px solid {edge}; border-radius: 3px; }}"
            f"#map_notice QLabel {{ color: {theme.text}; background: transparent; }}"
            f"#map_notice QToolButton {{ color: {theme.accent}; border: 1px solid {theme.border};"
            f" border-radius: 3px; padding: 1px 6px; background: {theme.raised}; }}"
            f"#map_notice QToolButton:focus {{ border-color: {theme.accent}; }}"
        )

    def tell(self, severity: str, text: str, action: str = "") -> None:
        """Show a sentence, and a button where there is something to offer."""
        self.button.setVisible(bool(action))
        self.button.setText(action)
        if (severity, text) != (self._severity, self.text) and self._theme is not None:
            self._severity = severity
            self._label.tell(text)
            self.set_theme(self._theme)
        self._place()
        self.show()
        self.raise_()

    def _place(self) -> None:
        wanted = self._label.fontMetrics().horizontalAdvance(self.text) + 26
        if self.button.text():
            wanted += self.button.sizeHint().width() + 8
        free = self._room.free_row()
        width = min(wanted, int(free.width()))
        low = free.y() > 0.0
        self.setFixedSize(width, int(ROW) if low else LEAST_HEIGHT - 2)
        self.move(self._room.width() - width - int(MARGIN), int(free.y()))

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 - Qt's name
        """Go where it happened."""
        self.clicked.emit()
        event.accept()


def _card_html(card: Card, colour: str, theme: Theme) -> str:
    tell = html.escape
    rows = []
    for row in card.rows:
        tone = theme.warning if row.near else theme.text
        tone = theme.error if row.passed is False else tone
        mark = "✕ " if row.passed is False else ""
        found, margin = tell(row.value), mark + tell(row.margin)
        if not row.margin:
            found, margin = "", mark + found
        rows.append(
            f'<tr><td style="color:{theme.muted}">{tell(row.label)}</td>'
            f'<td align="right" style="color:{theme.muted}">&nbsp;&nbsp;{found}</td>'
            f'<td align="right" style="color:{tone}">&nbsp;&nbsp;{margin}</td>'
            f'<td style="color:{tone}">&nbsp;&nbsp;{tell(row.subject)}</td></tr>'
        )
    return (
        f"<b>{tell(card.title)}</b><br>"
        f'<span style="color:{colour}">■</span> {tell(card.verdict)}'
        f'<span style="color:{theme.muted}"> · {tell(card.posture)}</span>'
        f'<table cellspacing="0" cellpadding="1" style="margin-top:4px">{"".join(rows)}</table>'
    )
