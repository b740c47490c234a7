"""The line at the bottom: what the plan is worth, what is being done, and what went wrong."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from PySide6.QtCore import QObject, Qt, QTimer, Signal
from PySide6.QtWidgets import QProgressBar, QStatusBar, QToolButton

from posopt_gui.controllers.session import Message, Session
from posopt_gui.viewmodels.trouble_model import Trouble, trouble_of
from posopt_gui.viewmodels.verdicts import gate_words, plan_note
from posopt_gui.views.shell_parts import ElidedLabel

STAGES: Final[Mapping[str, str]] = {
    "compiling": "Planning: compiling the kernels, once (up to a few minutes)",
    "candidates": "Planning: solving and filtering the poses",
    "meshes": "Planning: distances to meshes",
    "nodes": "Planning: adding full turns of the joints",
    "search": "Planning: searching the graph",
}
"""What the solver's stages are called."""


class StatusLine(QObject):
    """Puts words, progress and the verdict of the checks into a status bar; keeps them true."""

    checks_wanted = Signal()

    def __init__(self, session: Session, bar: QStatusBar) -> None:
        super().__init__(bar)
        self._session = session
        self._tr = session.look.tr
        self._kept: Message | None = None
        self._just_said = False
        self.words = ElidedLabel()
        self._progress = QProgressBar()
        self._progress.setFixedSize(180, 8)
        self._progress.setTextVisible(False)
        self.gate = QToolButton()
        self.gate.setAutoRaise(True)
        self.gate.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.gate.clicked.connect(self.checks_wanted)
        bar.addWidget(self.words, 1)
        bar.addPermanentWidget(self._progress)
        bar.addPermanentWidget(self.gate)
        session.planning_changed.connect(self._on_planning)
        session.progress.connect(self._on_progress)
        session.message.connect(self._on_message)
        session.result_changed.connect(self.refresh)
        session.problem_changed.connect(self.refresh)
        session.state_changed.connect(self._forget)
        session.stale_changed.connect(self.refresh)
        # What was said was said in the other language; how things stand is said anew.
        session.look.language_changed.connect(self._forget)
        session.look.language_changed.connect(self.refresh)
        session.look.theme_changed.connect(self.refresh)
        session.check_changed.connect(self.show_gate)
        for changed in (session.stale_changed, session.planning_changed):
            changed.connect(self.show_gate)
        session.look.language_changed.connect(self.show_gate)
        session.look.theme_changed.connect(self.show_gate)
        self.show_gate()
        self._on_planning(False)

    def show_gate(self, *_: object) -> None:
        """Say in a line whether the program passes; nothing where that is not known."""
        session = self._session
        report = session.report
        known = report is not None or session.check_error is not None
        known = known and not session.stale and not session.planning
        self.gate.setVisible(known)
        if not known:
            return
        words, state = gate_words(report, self._tr)
        theme = session.look.theme
        colour = theme.good if state == "good" else theme.error
        self.gate.setText(("✓ " if state == "good" else "✕ ") + words)
        self.gate.setAccessibleName(words)
        self.gate.setToolTip(self._tr("Show the checks of the program"))
        self.gate.setStyleSheet(f"QToolButton {{ color: {colour}; font-weight: 600; }}")

    def refresh(self, *_: object) -> None:
        """Say how things stand."""
        session = self._session
        if session.planning:
            return
        cell = session.document.state.cell
        trouble = trouble_of(
            session.problem_error, session.plan_error, session.answer, self._tr, cell
        )
        sequence = session.sequence
        if self._kept is not None:
            self._tell(self._kept)
        elif session.problem_error is not None and trouble is not None:
            self.words.tell(_in_one_line(trouble), session.look.theme.error)
        elif session.stale:
            self.words.tell(self._tr("The inputs have changed. Plan to update."))
        elif trouble is not None:
            self.words.tell(_in_one_line(trouble), session.look.theme.error)
        elif sequence is not None and session.result is not None:
            said = plan_note(session.result, sequence, self._tr)
            self._tell(Message(said.severity, said.text, said.waypoint))

    def _on_planning(self, busy: bool) -> None:
        self._progress.setVisible(busy)
        self._progress.setRange(0, 0)
        if not busy:
            self.refresh()
        elif not self._just_said:
            self._kept = None

    def _on_progress(self, stage: str, done: int, total: int) -> None:
        self._progress.setRange(0, 1000 if total else 0)
        self._progress.setValue(1000 * done // max(total, 1))
        self.words.tell(self._tr(STAGES.get(stage, "Planning…")))

    def _on_message(self, message: Message) -> None:
        session, text = self._session, message.text
        if session.plan_error is not None and text == str(session.plan_error):
            # The refusal is said in the window's language.
            self.refresh()
            return
        if message.severity != "info":
            # It stays in view until something else is done; planning at once would hide it.
            self._kept, self._just_said = message, True
            QTimer.singleShot(0, self, self._is_old)
        self._tell(message)

    def _tell(self, message: Message) -> None:
        theme = self._session.look.theme
        colours = {"error": theme.error, "warning": theme.warning}
        self.words.tell(message.text, colours.get(message.severity, ""))

    def _is_old(self) -> None:
        self._just_said = False

    def _forget(self) -> None:
        self._kept = None


def _in_one_line(trouble: Trouble) -> str:
    return " ".join([trouble.headline, *(one.text for one in trouble.causes[:1])])
