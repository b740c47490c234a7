"""The line over the checks that says where the export stands."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import (
    QFrame,
    QHBoxLayout,
    QLabel,
    QProgressBar,
    QPushButton,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from posopt_gui.look import Look
from posopt_gui.viewmodels.export_model import ExportStage, ExportView

_BUSY = {ExportStage.CHECKING, ExportStage.PLANNING, ExportStage.WRITING}


class VerdictBanner(QFrame):
    """A sentence with the colour of its meaning, a bar while something runs, and 'Plan'."""

    plan_wanted = Signal()

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._look = look
        self.setObjectName("banner")
        self.headline = QLabel()
        self.headline.setObjectName("headline")
        self.headline.setWordWrap(True)
        self.explanation = QLabel()
        self.explanation.setWordWrap(True)
        self.explanation.setProperty("tone", "muted")
        self.explanation.hide()
        self.plan_button = QPushButton()
        self.plan_button.setObjectName("primary")
        self.plan_button.setAutoDefault(False)
        self.plan_button.clicked.connect(self.plan_wanted)
        self.bar = QProgressBar()
        self.bar.setTextVisible(False)
        # The room of the bar is kept, so that nothing jumps when it comes and goes.
        policy = QSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        policy.setRetainSizeWhenHidden(True)
        self.bar.setSizePolicy(policy)
        row = QHBoxLayout()
        row.addWidget(self.headline, 1)
        row.addWidget(self.plan_button)
        page = QVBoxLayout(self)
        page.setContentsMargins(12, 10, 12, 0)
        page.setSpacing(6)
        page.addLayout(row)
        page.addWidget(self.explanation)
        page.addWidget(self.bar)

    def retranslate(self) -> None:
        """Set the button's text."""
        self.plan_button.setText(self._look.tr("Plan to update"))
        self.bar.setAccessibleName(self._look.tr("Progress"))

    def show_view(self, view: ExportView) -> None:
        """Show where the export stands."""
        self.headline.setText(view.headline)
        self.explanation.setText(view.explanation)
        self.explanation.setVisible(bool(view.explanation))
        for part in (self, self.headline):
            part.setProperty("tone", view.tone if view.tone != "muted" else "")
            part.style().polish(part)
        self.plan_button.setVisible(view.offers_plan)
        busy = view.stage in _BUSY
        if busy and not self.bar.isVisible():
            self.bar.setRange(0, 0)
        self.bar.setVisible(busy)

    def show_progress(self, _stage: str, done: int, total: int) -> None:
        """Show how much is done."""
        self.bar.setRange(0, max(total, 0))
        self.bar.setValue(done)
