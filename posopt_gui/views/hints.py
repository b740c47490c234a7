"""Three hints in place for the first run, one after the other; each closes for good."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Final

from PySide6.QtCore import QEvent, QObject, QPoint, QPointF, QRectF, QSettings, Qt, QTimer, Signal
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPaintEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from posopt_gui.look import Look

ARROW: Final = 10
"""Length of the arrow that points at the place [px]."""

WIDTH: Final = 268
MARGIN: Final = 12
KEY: Final = "hints/closed_{name}"


class Side(Enum):
    """On which side of its place a hint stands."""

    RIGHT = 0
    BELOW = 1
    ABOVE = 2


@dataclass(frozen=True, slots=True)
class Spot:
    """A place of a widget, and the side of it on which the hint stands."""

    widget: QWidget
    place: QPoint
    side: Side


FindSpot = Callable[[], Spot | None]

HINTS: Final[Mapping[str, str]] = {
    "beam": "Choose a beam here. Everything about the cell stands in this panel; each field says "
    "its unit and its range.",
    "line": "This line is the plan: one column is one waypoint. Drag the line, and the plan "
    "follows through your pin, with what it costs.",
    "export": "Export checks the program again, shows every check and its text, and only then "
    "writes the file.",
}
"""What the hints say, in the order in which they come."""


class HintBubble(QFrame):
    """A sentence with an arrow; it lies over the window and takes no keyboard focus from it."""

    closed = Signal()
    all_closed = Signal()

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setObjectName("hint")
        self._side, self._tip = Side.RIGHT, QPoint()
        self._fill, self._text = QColor(), QColor()
        self.words, self._count = QLabel(), QLabel()
        self.words.setWordWrap(True)
        self.next_button, self.all_button = QPushButton(), QPushButton()
        for button in (self.next_button, self.all_button):
            button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
            button.setAutoDefault(False)
        self.next_button.clicked.connect(self.closed)
        self.all_button.clicked.connect(self.all_closed)
        row = QHBoxLayout()
        row.addWidget(self._count, 1)
        row.addWidget(self.all_button)
        row.addWidget(self.next_button)
        self._column = QVBoxLayout(self)
        self._column.setSpacing(10)
        self._column.addWidget(self.words)
        self._column.addLayout(row)
        self.hide()

    def show_hint(self, words: str, count: str, following: str, rest: str) -> None:
        """Set what is said, which one of how many it is, and what the buttons say."""
        self.words.setText(words)
        self._count.setText(count)
        self.next_button.setText(following)
        self.all_button.setText(rest)
        self.setAccessibleName(words)

    def set_colours(self, fill: str, text: str) -> None:
        """Take the colours of a theme."""
        if (self._fill, self._text) == (QColor(fill), QColor(text)):
            # A style sheet that is set again lays the window out again, which calls for this.
            return
        self._fill, self._text = QColor(fill), QColor(text)
        self.setStyleSheet(
            f"QLabel {{ color: {text}; background: transparent; }}"
            f"QPushButton {{ color: {text}; background: transparent; border: 1px solid {text};"
            " border-radius: 4px; padding: 3px 10px; }"
            f"QPushButton:hover, QPushButton:focus {{ color: {fill}; background: {text}; }}"
        )
        self.update()

    def stand(self, tip: QPoint, side: Side) -> None:
        """Stand at a point of the parent, on that side of it, as far as there is room."""
        self._side = side
        sides = [MARGIN] * 4
        sides[{Side.RIGHT: 0, Side.BELOW: 1, Side.ABOVE: 3}[side]] += ARROW
        self._column.setContentsMargins(*sides)
        extra = ARROW if side is Side.RIGHT else 0
        width = WIDTH + extra
        height = self._column.heightForWidth(width)
        parent = self.window().rect() if (over := self.parentWidget()) is None else over.rect()
        if side is Side.RIGHT:
            left, top = tip.x(), tip.y() - 26
        else:
            left = tip.x() - width // 2
            top = tip.y() if side is Side.BELOW else tip.y() - height
        left = max(4, min(left, parent.width() - width - 4))
        top = max(4, min(top, parent.height() - height - 4))
        self.setGeometry(left, top, width, height)
        self._tip = tip - QPoint(left, top)
        self.update()

    def paintEvent(self, _event: QPaintEvent) -> None:  # noqa: N802 - Qt's name
        """Draw the ground and the arrow."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(self._fill)
        body = QRectF(self.rect())
        x, y = float(self._tip.x()), float(self._tip.y())
        arrow = QPainterPath()
        if self._side is Side.RIGHT:
            body.setLeft(ARROW)
            points = ((0.0, y), (ARROW + 1.0, y - 8.0), (ARROW + 1.0, y + 8.0))
        elif self._side is Side.BELOW:
            body.setTop(ARROW)
            points = ((x, 0.0), (x - 8.0, ARROW + 1.0), (x + 8.0, ARROW + 1.0))
        else:
            body.setBottom(body.bottom() - ARROW)
            foot = body.bottom() - 1.0
            points = ((x, foot + ARROW), (x - 8.0, foot), (x + 8.0, foot))
        arrow.moveTo(QPointF(*points[0]))
        arrow.lineTo(QPointF(*points[1]))
        arrow.lineTo(QPointF(*points[2]))
        arrow.closeSubpath()
        ground = QPainterPath()
        ground.addRoundedRect(body, 6.0, 6.0)
        painter.drawPath(ground.united(arrow))


class Hints(QObject):
    """Shows the first hint that is neither closed nor without a place."""

    def __init__(
        self, window: QWidget, look: Look, settings: QSettings, spots: Mapping[str, FindSpot]
    ) -> None:
        super().__init__(window)
        self._window, self._look, self._settings = window, look, settings
        self._spots = spots
        self.bubble = HintBubble(window)
        self.bubble.closed.connect(self._close_shown)
        self.bubble.all_closed.connect(self.close_all)
        self._shown = ""
        self._later = QTimer(self)
        self._later.setSingleShot(True)
        self._later.setInterval(0)
        self._later.timeout.connect(self.refresh)
        window.installEventFilter(self)
        look.language_changed.connect(self._later.start)
        look.theme_changed.connect(self._later.start)

    @property
    def shown(self) -> str:
        """Name of the hint that is shown, '' for none."""
        return self._shown

    def is_closed(self, name: str) -> bool:
        """Whether a hint was closed, in this run or an earlier one."""
        # Without the type a new process would read the text 'false', which is true.
        return bool(self._settings.value(KEY.format(name=name), False, type=bool))

    def close(self, name: str) -> None:
        """Close a hint for good: it was read, or what it says was done."""
        if not self.is_closed(name):
            self._settings.setValue(KEY.format(name=name), True)
        if name == self._shown:
            self.refresh()

    def close_all(self) -> None:
        """Close all of them for good."""
        for name in HINTS:
            self._settings.setValue(KEY.format(name=name), True)
        self.refresh()

    def open_only(self, name: str) -> None:
        """Show one hint again, and no other one."""
        for one in HINTS:
            self._settings.setValue(KEY.format(name=one), one != name)
        self.refresh()

    def refresh(self) -> None:
        """Show what is to be shown, where it belongs."""
        names = list(HINTS)
        for number, name in enumerate(names):
            spot = None if self.is_closed(name) else self._spots[name]()
            if spot is None:
                continue
            self._shown = name
            self._show(spot, HINTS[name], number + 1, len(names))
            return
        self._shown = ""
        self.bubble.hide()

    def refresh_soon(self) -> None:
        """Refresh once the window has laid itself out."""
        self._later.start()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 - Qt's name
        """Follow the window's size."""
        if event.type() in {QEvent.Type.Resize, QEvent.Type.LayoutRequest} and self._shown:
            self._later.start()
        return super().eventFilter(watched, event)

    def _show(self, spot: Spot, words: str, number: int, count: int) -> None:
        tr, theme = self._look.tr, self._look.theme
        following = tr("Next") if number < count else tr("Got it")
        self.bubble.show_hint(tr(words), f"{number}/{count}", following, tr("Skip hints"))
        self.bubble.all_button.setVisible(number < count)
        self.bubble.set_colours(theme.accent, theme.accent_text)
        self.bubble.stand(spot.widget.mapTo(self._window, spot.place), spot.side)
        self.bubble.show()
        self.bubble.raise_()

    def _close_shown(self) -> None:
        self.close(self._shown)
