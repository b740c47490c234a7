"""Predicted speed of the TCP against the asked feed, from the program's check."""

from __future__ import annotations

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QShowEvent
from PySide6.QtWidgets import QLabel, QPushButton, QStackedWidget, QVBoxLayout, QWidget

from posopt_gui.controllers.session import Session
from posopt_gui.viewmodels.curves_model import FeedCurve, feed_curve, feed_words, move_steps
from posopt_gui.views.column_bars import ColumnBars
from posopt_gui.views.curve_plots import WaypointPlot
from posopt_gui.views.plot_painting import CurveLine


class FeedPanel(QStackedWidget):
    """The plot, or a sentence that says what is missing."""

    def __init__(
        self, session: Session, plot: WaypointPlot | None = None, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self._session = session
        self._tr = session.look.tr
        self._curve: FeedCurve | None = None
        self._items: list[pg.GraphicsObject] = []
        self.plot = plot or WaypointPlot()
        self._sentence = QLabel()
        self._sentence.setWordWrap(True)
        self._sentence.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.button = QPushButton()
        self.button.clicked.connect(session.check)
        empty = QWidget()
        column = QVBoxLayout(empty)
        column.addStretch(1)
        column.addWidget(self._sentence)
        column.addWidget(self.button, 0, Qt.AlignmentFlag.AlignHCenter)
        column.addStretch(1)
        self.addWidget(empty)
        self.addWidget(self.plot)

    @property
    def curve(self) -> FeedCurve | None:
        """What is drawn."""
        return self._curve

    def retranslate(self) -> None:
        """Set all texts again."""
        self.plot.setLabel("left", self._tr("TCP speed, mm/s"))
        self.plot.setLabel("bottom", self._tr("Waypoint"))
        self.button.setText(self._tr("Check the program"))
        self.update_report()

    def showEvent(self, event: QShowEvent) -> None:  # noqa: N802 - Qt's name
        """Draw what came while this was hidden."""
        super().showEvent(event)
        self.update_report()

    def update_report(self) -> None:
        """Draw what the check predicts, as soon as it is looked at."""
        report = self._session.report
        if not self.isVisible():
            return
        self._curve = feed_curve(report)
        for item in self._items:
            self.plot.removeItem(item)
        self._items = []
        if self._curve is None:
            self._say(report is not None)
            self.setCurrentIndex(0)
            return
        self.setCurrentIndex(1)
        self._draw(self._curve)
        self.show_readout(self._session.cursor)

    def _say(self, checked: bool) -> None:
        has_plan = self._session.sequence is not None
        if not has_plan:
            words = self._tr("There is no plan.")
        elif checked:
            words = self._tr("The motion could not be followed, so no feed is predicted.")
        else:
            words = self._tr("The feed is predicted when the program is checked.")
        self._sentence.setText(words)
        self.button.setVisible(has_plan and not checked)

    def _draw(self, curve: FeedCurve) -> None:
        theme = self._session.look.theme
        tolerance = self._tolerance()
        steps, asked = move_steps(curve.waypoint, curve.asked)
        for share, pen in (
            (0.0, pg.mkPen(QColor(theme.muted), width=1.2, style=Qt.PenStyle.DashLine)),
            (-tolerance, pg.mkPen(QColor(theme.warning), width=1.0, style=Qt.PenStyle.DotLine)),
            (tolerance, pg.mkPen(QColor(theme.warning), width=1.0, style=Qt.PenStyle.DotLine)),
        ):
            line = CurveLine()
            line.set_pen(pen)
            line.set_points(steps, asked * (1.0 + share))
            self._add(line)
        words = self._tr("feed tolerance ±{share} %", share=f"{100.0 * tolerance:g}")
        self.plot.set_beyond(f"∙∙∙∙ {words}" if tolerance else "", theme.warning)
        for held, colour in ((True, theme.accent), (False, theme.error)):
            chosen = curve.held == held
            if not chosen.any():
                continue
            edges = np.column_stack([curve.slowest[chosen], curve.fastest[chosen]])
            bars = ColumnBars(0.92, stacked=False)
            bars.set_bars(curve.waypoint[chosen] - 0.5, edges, [QColor(colour)], outline=2.0)
            self._add(bars)
        room = 1.0 + 1.6 * tolerance
        low = min(float(curve.slowest.min()), float(curve.asked.min()) / room)
        high = max(float(curve.fastest.max()), float(curve.asked.max()) * room)
        span = max(high - low, 1e-3)
        self.plot.setYRange(low - 0.1 * span, high + 0.35 * span, padding=0.0)

    def _tolerance(self) -> float:
        result = self._session.result
        return result.problem.program.feed_tolerance if result is not None else 0.0

    def _add(self, item: pg.GraphicsObject) -> None:
        self.plot.addItem(item, ignoreBounds=True)
        self._items.append(item)

    def show_readout(self, waypoint: int) -> None:
        """Say the feed of the move to a waypoint (from 0)."""
        curve = self._curve
        if curve is None:
            return
        found = np.flatnonzero(curve.waypoint == waypoint + 1)
        number = self._tr("waypoint {number}", number=waypoint + 1)
        if not len(found):
            self.plot.set_readout(number)
            return
        row = int(found[0])
        self.plot.set_readout(f"{number} · {feed_words(self._tr, curve, row)}")
