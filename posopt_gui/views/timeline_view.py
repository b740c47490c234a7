"""The playback bar: slider below the plots, play and step, pace and loop."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, QSignalBlocker, QSize, Qt
from PySide6.QtGui import (
    QAction,
    QColor,
    QIcon,
    QKeySequence,
    QPainter,
    QPainterPath,
    QPen,
    QPixmap,
    QPolygonF,
)
from PySide6.QtWidgets import QHBoxLayout, QLabel, QToolButton, QVBoxLayout, QWidget

from posopt_gui.controllers.playback import SPEEDS, PlaybackController
from posopt_gui.controllers.session import Session
from posopt_gui.views.place_slider import STEPS, ClickSlider, SliderRow
from posopt_gui.views.quiet_editors import QuietCombo
from posopt_gui.views.refresh import Refresh

ICON = 20
"""Side of an icon [px]."""


def _triangle(left: float, right: float) -> QPolygonF:
    return QPolygonF([QPointF(left, 4.0), QPointF(right, 10.0), QPointF(left, 16.0)])


def media_icon(kind: str, colour: str) -> QIcon:
    """An icon 'play', 'pause', 'back', 'forward', 'start', 'end' or 'loop' in a colour."""
    scale = 3
    pixmap = QPixmap(QSize(ICON * scale, ICON * scale))
    pixmap.fill(Qt.GlobalColor.transparent)
    painter = QPainter(pixmap)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.scale(scale, scale)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(QColor(colour))
    if kind == "loop":
        _paint_loop(painter, QColor(colour))
    elif kind == "pause":
        painter.drawRect(QRectF(5.0, 4.0, 3.5, 12.0))
        painter.drawRect(QRectF(11.5, 4.0, 3.5, 12.0))
    else:
        if kind in ("back", "start"):
            painter.translate(ICON, 0.0)
            painter.scale(-1.0, 1.0)
        if kind == "play":
            painter.drawPolygon(_triangle(5.5, 16.0))
        elif kind in ("back", "forward"):
            painter.drawPolygon(_triangle(7.5, 16.0))
            painter.drawRect(QRectF(4.0, 4.0, 2.0, 12.0))
        else:
            painter.drawPolygon(_triangle(4.0, 13.0))
            painter.drawRect(QRectF(14.0, 4.0, 2.2, 12.0))
    painter.end()
    pixmap.setDevicePixelRatio(scale)
    return QIcon(pixmap)


def _paint_loop(painter: QPainter, colour: QColor) -> None:
    path = QPainterPath()
    path.arcMoveTo(QRectF(4.0, 4.0, 12.0, 12.0), 60.0)
    path.arcTo(QRectF(4.0, 4.0, 12.0, 12.0), 60.0, 290.0)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.setPen(QPen(colour, 1.9))
    painter.drawPath(path)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(colour)
    painter.drawPolygon(QPolygonF([QPointF(11.0, 1.6), QPointF(16.9, 4.4), QPointF(11.9, 8.4)]))


class TimelineView(QWidget):
    """The bar; its actions carry the keys and can be put into menus."""

    def __init__(
        self,
        session: Session,
        playback: PlaybackController | None = None,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._session = session
        self._tr = session.look.tr
        self.playback = playback or PlaybackController(session, self)
        self._make_actions()
        self._slider = ClickSlider()
        self._slider_row = SliderRow(self._slider)
        self._count = QLabel()
        self._clock = QLabel()
        self._speed = QuietCombo()
        for speed in SPEEDS:
            self._speed.addItem(f"{speed:g}×", speed)
        self._speed.setCurrentIndex(SPEEDS.index(1.0))
        self._lay_out()
        self._connect()
        self.retranslate()
        self.retheme()
        self._on_times()

    @property
    def actions_for_menu(self) -> tuple[QAction, ...]:
        """Play, one back, one forward, first, last, loop."""
        return (self._play, self._back, self._forward, self._start, self._end, self._loop)

    def _make_actions(self) -> None:
        playback = self.playback

        def action(key: Qt.Key | None) -> QAction:
            made = QAction(self)
            if key is not None:
                made.setShortcut(QKeySequence(key))
            self.addAction(made)
            return made

        self._play = action(Qt.Key.Key_Space)
        self._back = action(Qt.Key.Key_Left)
        self._forward = action(Qt.Key.Key_Right)
        self._start = action(Qt.Key.Key_Home)
        self._end = action(Qt.Key.Key_End)
        self._loop = action(None)
        self._loop.setCheckable(True)
        self._play.triggered.connect(playback.toggle)
        self._back.triggered.connect(playback.step_back)
        self._forward.triggered.connect(playback.step_forward)
        self._start.triggered.connect(playback.to_start)
        self._end.triggered.connect(playback.to_end)
        self._loop.toggled.connect(playback.set_loop)

    def _lay_out(self) -> None:
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 2, 0, 2)
        column.setSpacing(0)
        column.addWidget(self._slider_row)
        row = QHBoxLayout()
        row.setContentsMargins(8, 0, 8, 0)
        row.setSpacing(2)
        column.addLayout(row)
        for action in (self._start, self._back, self._play, self._forward, self._end):
            row.addWidget(self._button(action))
        row.addStretch(1)
        for label, widest in ((self._count, "0000/0000"), (self._clock, "")):
            label.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
            label.setMinimumWidth(label.fontMetrics().horizontalAdvance(widest))
            row.addWidget(label)
            row.addSpacing(8)
        row.addWidget(self._speed)
        row.addWidget(self._button(self._loop))

    def _button(self, action: QAction) -> QToolButton:
        button = QToolButton()
        button.setDefaultAction(action)
        button.setIconSize(QSize(ICON, ICON))
        button.setAutoRaise(True)
        return button

    def _connect(self) -> None:
        session, playback = self._session, self.playback
        self._slider.valueChanged.connect(self._on_slider)
        self._slider.sliderPressed.connect(playback.pause)
        self._slider.sliderReleased.connect(playback.settle)
        self._speed.currentIndexChanged.connect(
            lambda index: playback.set_speed(self._speed.itemData(index))
        )
        playback.playing_changed.connect(self._on_playing)
        playback.times_changed.connect(self._on_times)
        playback.speed_changed.connect(self._on_speed)
        playback.loop_changed.connect(self._loop.setChecked)
        session.place_changed.connect(self._on_place)
        session.look.language_changed.connect(Refresh(session, self.retranslate, self).next_turn)
        session.look.theme_changed.connect(Refresh(session, self.retheme, self).next_turn)

    def retranslate(self) -> None:
        """Set all texts again."""
        tr = self._tr
        for action, text in (
            (self._back, tr("Previous waypoint")),
            (self._forward, tr("Next waypoint")),
            (self._start, tr("First waypoint")),
            (self._end, tr("Last waypoint")),
            (self._loop, tr("Loop")),
        ):
            self._name(action, text)
        self._name_play()
        self._speed.setToolTip(tr("Pace of the playback"))
        self._speed.setAccessibleName(tr("Pace of the playback"))
        self._slider.setAccessibleName(tr("Place on the path"))
        self._slider.setToolTip(tr("Place on the path"))
        self._clock.setToolTip(
            tr(
                "Time from the path length and the feed, and between passes straight at joint "
                "speed; approach, retract and ramps are in the estimated cycle"
            )
        )
        self._count.setToolTip(tr("Waypoint"))
        self._on_place(self._session.place)

    def retheme(self) -> None:
        """Set all colours again."""
        colour = self._session.look.theme.text
        for action, kind in (
            (self._back, "back"),
            (self._forward, "forward"),
            (self._start, "start"),
            (self._end, "end"),
            (self._loop, "loop"),
        ):
            action.setIcon(media_icon(kind, colour))
        self._name_play()

    def _name(self, action: QAction, text: str) -> None:
        action.setText(text)
        keys = action.shortcut().toString(QKeySequence.SequenceFormat.NativeText)
        action.setToolTip(f"{text} ({keys})" if keys else text)

    def _name_play(self) -> None:
        playing = self.playback.playing
        self._name(self._play, self._tr("Pause") if playing else self._tr("Play"))
        theme = self._session.look.theme
        self._play.setIcon(media_icon("pause" if playing else "play", theme.accent))

    def _on_playing(self, playing: bool) -> None:
        self._name_play()

    def _on_speed(self, speed: float) -> None:
        index = self._speed.findData(speed)
        if index >= 0:
            self._speed.setCurrentIndex(index)

    def _on_times(self) -> None:
        count = self._session.waypoints
        with QSignalBlocker(self._slider):
            self._slider_row.set_count(count)
        for action in self.actions_for_menu:
            action.setEnabled(count > 1)
        self._slider.setEnabled(count > 1)
        self._on_place(self._session.place)

    def _on_slider(self, value: int) -> None:
        self._session.set_place(value / STEPS)

    def _on_place(self, place: float) -> None:
        with QSignalBlocker(self._slider):
            self._slider.setValue(round(place * STEPS))
        count = self._session.waypoints
        shown = self._session.cursor + 1 if count else 0
        self._count.setText(f"{shown}/{count}")
        now, whole = f"{self.playback.time:.1f}", f"{self.playback.duration:.1f}"
        self._clock.setText(self._clock_words(now, whole))
        widest = self._clock.fontMetrics().horizontalAdvance(self._clock_words(whole, whole))
        self._clock.setMinimumWidth(widest)

    def _clock_words(self, now: str, whole: str) -> str:
        if self.playback.linked:
            return self._tr("Contact and links {now} / {whole} s", now=now, whole=whole)
        return self._tr("Contact {now} / {whole} s", now=now, whole=whole)
