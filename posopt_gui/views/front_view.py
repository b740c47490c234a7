"""The tab 'Front': what clearance costs, as a picture in which a click takes a plan."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QHideEvent, QShowEvent
from PySide6.QtWidgets import (
    QHBoxLayout,
    QLabel,
    QProgressBar,
    QPushButton,
    QStackedWidget,
    QVBoxLayout,
    QWidget,
)

from posopt_gui.controllers.front import Front
from posopt_gui.controllers.session import Session
from posopt_gui.viewmodels.front_model import cost_words, point_words, summary
from posopt_gui.viewmodels.number_words import decimal
from posopt_gui.views.front_plot import FrontPlot
from posopt_gui.views.refresh import Refresh
from posopt_gui.views.shell_parts import ElidedLabel
from solver.units import MM_PER_M

DIMMED = 0.45
"""Opacity of what is no longer true."""


class FrontView(QWidget):
    """Picture, a line that says what is pointed at, and a sentence where there is nothing."""

    def __init__(
        self, session: Session, front: Front | None = None, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self._session = session
        self._tr = session.look.tr
        self.front = front or Front(session, self)
        self.words = ElidedLabel()
        self.knee_button, self.stop_button = QPushButton(), QPushButton()
        self.again_button = QPushButton()
        self._bar = QProgressBar()
        self._sentence = QLabel()
        self._plot: FrontPlot | None = None
        self._stack = QStackedWidget()
        self._lay_out()
        self._connect()
        self.retheme()
        self.retranslate()

    @property
    def plot(self) -> FrontPlot:
        """The picture; it is made when it is first looked at."""
        if self._plot is None:
            self._plot = FrontPlot()
            self._plot.pointed.connect(self._on_pointed)
            self._plot.taken.connect(self.front.take)
            self._stack.addWidget(self._plot)
            self._plot.set_theme(self._session.look.theme)
            self._name_plot(self._plot)
        return self._plot

    def _lay_out(self) -> None:
        self._bar.setFixedSize(120, 8)
        self._bar.setTextVisible(False)
        self._bar.setRange(0, 1)
        line = QHBoxLayout()
        line.setContentsMargins(10, 4, 8, 2)
        line.setSpacing(10)
        line.addWidget(self.words, 1)
        for widget in (self._bar, self.stop_button, self.knee_button):
            line.addWidget(widget)
        empty = QWidget()
        column = QVBoxLayout(empty)
        self._sentence.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._sentence.setWordWrap(True)
        column.addStretch(1)
        column.addWidget(self._sentence)
        column.addWidget(self.again_button, 0, Qt.AlignmentFlag.AlignHCenter)
        column.addStretch(1)
        self._stack.addWidget(empty)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addLayout(line)
        column.addWidget(self._stack, 1)

    def _connect(self) -> None:
        session, front = self._session, self.front
        self.knee_button.clicked.connect(self._take_knee)
        self.stop_button.clicked.connect(front.stop)
        self.again_button.clicked.connect(front.ask)
        front.changed.connect(self.refresh)
        front.progress.connect(self._on_progress)
        session.result_changed.connect(self.refresh)
        session.stale_changed.connect(self.refresh)
        session.look.language_changed.connect(Refresh(session, self.retranslate, self).next_turn)
        session.look.theme_changed.connect(Refresh(session, self.retheme, self).next_turn)

    def retranslate(self) -> None:
        """Set all texts again."""
        tr = self._tr
        if self._plot is not None:
            self._name_plot(self._plot)
        self.knee_button.setText(tr("Take the knee"))
        self.knee_button.setToolTip(
            tr("Plan with the point from which on clearance becomes dearer; undo takes it back")
        )
        self.stop_button.setText(tr("Stop"))
        self.stop_button.setToolTip(tr("Give up working out the front"))
        self.again_button.setText(tr("Work out the front"))
        self._bar.setAccessibleName(tr("Progress of the front"))
        self.refresh()

    def _name_plot(self, plot: FrontPlot) -> None:
        tr = self._tr
        plot.setLabel("bottom", tr("least clearance, mm"))
        plot.setAccessibleName(tr("Front of clearance against joint motion"))
        keys = tr("A click takes a plan; arrow keys go from point to point, Enter takes one.")
        plot.setAccessibleDescription(keys)

    def retheme(self) -> None:
        """Set all colours again."""
        if self._plot is not None:
            self._plot.set_theme(self._session.look.theme)
        self.refresh()

    def showEvent(self, event: QShowEvent) -> None:  # noqa: N802 - Qt's name
        """Work the front out while it is looked at."""
        super().showEvent(event)
        self.front.want(True)
        self.refresh()

    def hideEvent(self, event: QHideEvent) -> None:  # noqa: N802 - Qt's name
        """Nobody looks at it any more."""
        super().hideEvent(event)
        self.front.want(False)

    def refresh(self, *_: object) -> None:
        """Draw the front as it is known, and say how things stand."""
        front, model = self.front, self.front.model
        if not self.isVisible():
            return
        if model is None:
            self._stack.setCurrentIndex(0)
        self._sentence.setText(self._reason())
        self.again_button.setVisible(front.stopped and self._session.result is not None)
        self._bar.setVisible(front.busy)
        self.stop_button.setVisible(front.busy)
        self.knee_button.setVisible(model is not None and model.knee is not None)
        self.knee_button.setEnabled(not front.stale)
        if model is not None:
            safety = self._safety()
            name = self._tr("safety distance {value} mm", value=decimal(safety or 0.0, 2))
            self.plot.set_words(self._tr("knee"), self._tr("plan"), name, self._tr(", "))
            self.plot.setLabel("left", cost_words(model, self._tr))
            self.plot.set_model(model, front.present, safety)
            self._stack.setCurrentWidget(self.plot)
            self.plot.getPlotItem().setOpacity(DIMMED if front.stale else 1.0)
        self._say()

    def _safety(self) -> float | None:
        result = self._session.result
        return result.problem.settings.safety_distance * MM_PER_M if result is not None else None

    def _reason(self) -> str:
        """Why there is no picture."""
        session, front = self._session, self.front
        if front.busy:
            return self._tr("The front is being worked out…")
        if session.result is None:
            return self._tr("There is no plan.")
        if session.stale or front.stale:
            return self._tr("Inputs changed. Plan to update.")
        if front.stopped:
            return self._tr("The front was stopped.")
        return self._tr("No sequence exists.")

    def _say(self) -> None:
        """The line above the picture."""
        front, model = self.front, self.front.model
        index = self._plot.index if self._plot is not None else None
        if model is None:
            self.words.tell("")
        elif front.busy or front.stale or front.stopped:
            self.words.tell(self._reason(), self._session.look.theme.warning)
        elif index is None:
            self.words.tell(summary(model, self._tr))
        else:
            words = " · ".join(point_words(model, index, front.present, self._tr))
            self.words.tell(words)
            self.plot.setAccessibleDescription(words)

    def _on_pointed(self, index: int) -> None:
        model = self.front.model
        if index < 0 or model is None:
            self.plot.point_at(None)
        else:
            self.plot.point_at(index, point_words(model, index, None, self._tr)[0])
        self._say()

    def _on_progress(self, done: int, total: int) -> None:
        self._bar.setRange(0, total)
        self._bar.setValue(done)

    def _take_knee(self) -> None:
        model = self.front.model
        if model is not None and model.knee is not None:
            self.front.take(model.knee)
