"""The inspector: one pose in full, the plan's totals, and whether its program passes."""

from __future__ import annotations

from collections.abc import Sequence as Rows

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QFrame,
    QGraphicsOpacityEffect,
    QGridLayout,
    QLabel,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from posopt_gui.controllers.pose_facts import PoseExplainer
from posopt_gui.controllers.session import Session
from posopt_gui.viewmodels.error_words import error_words
from posopt_gui.viewmodels.export_model import waypoint_of
from posopt_gui.viewmodels.inspector_model import (
    ClearanceWords,
    FilterRow,
    Pose,
    Sheet,
    candidate_pose,
    candidate_sheet,
    clearance_words,
    filter_rows,
    sequence_pose,
    sequence_sheet,
)
from posopt_gui.viewmodels.results_model import check_words, totals
from posopt_gui.viewmodels.trouble_model import Trouble, trouble_of
from posopt_gui.viewmodels.verdicts import gate_words
from posopt_gui.views.joint_bars import JointBars
from posopt_gui.views.label_grid import LabelGrid, Text
from posopt_gui.views.refresh import Refresh
from solver.candidates.outcomes import Outcome

LEAST_WIDTH = 290
"""Width in which names and numbers of the filters stand beside each other [px]."""

PALE = 0.45
"""Opacity of what belongs to older inputs."""

STATES = {"good": "✓", "near": "!", "bad": "✕", "": ""}


class InspectorView(QScrollArea):
    """Follows the cursor, or the candidate under the mouse."""

    key_wanted = Signal(str)

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._tr = session.look.tr
        self._explainer = PoseExplainer(self)
        self.title, self.verdict, self.subtitle = QLabel(), QLabel(), QLabel()
        self.trouble, self.stale = QLabel(), QLabel()
        self.body = QWidget()
        self.facts = LabelGrid(2)
        self.bars = JointBars()
        self.clearance, self.bodies, self.beyond = QLabel(), QLabel(), QLabel()
        self.filters = LabelGrid(4)
        self.totals = LabelGrid(2)
        self.gate = LabelGrid(2)
        self._heads: dict[str, QLabel] = {}
        self._told = False
        self._lay_out()
        self._connect()
        self.retranslate()
        self.retheme()

    def _lay_out(self) -> None:
        self.setWidgetResizable(True)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setMinimumWidth(LEAST_WIDTH)
        page = QWidget()
        whole = QVBoxLayout(page)
        whole.setContentsMargins(12, 10, 12, 10)
        whole.setSpacing(4)
        self._column = QVBoxLayout(self.body)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.setSpacing(4)
        head = QGridLayout()
        head.addWidget(self.title, 0, 0)
        head.addWidget(self.subtitle, 1, 0)
        # In a row of its own: the longest verdict is as wide as the panel.
        head.addWidget(self.verdict, 2, 0, Qt.AlignmentFlag.AlignLeft)
        font = self.title.font()
        font.setPointSizeF(1.35 * font.pointSizeF())
        font.setBold(True)
        self.title.setFont(font)
        font.setPointSizeF(1.2 * self.font().pointSizeF())
        self.clearance.setFont(font)
        for label in (
            self.trouble, self.stale, self.verdict, self.subtitle, self.bodies, self.beyond,
        ):  # fmt: skip
            label.setWordWrap(label is not self.verdict)
        self.trouble.setTextFormat(Qt.TextFormat.RichText)
        self.trouble.linkActivated.connect(self._on_link)
        for part in (self.trouble, self.stale, self.body):
            whole.addWidget(part)
        # What belongs to older inputs is pale, as are map and curves.
        self._pale = QGraphicsOpacityEffect(self.body)
        self._pale.setOpacity(PALE)
        self._pale.setEnabled(False)
        self.body.setGraphicsEffect(self._pale)
        self._column.addLayout(head)
        self._column.addWidget(self.facts)
        for key, widgets in (
            ("joints", (self.bars,)),
            ("clearance", (self.clearance, self.bodies, self.beyond)),
            ("filters", (self.filters,)),
            ("plan", (self.totals,)),
            ("gate", (self.gate,)),
        ):
            self._heads[key] = QLabel()
            self._heads[key].setIndent(0)
            self._column.addSpacing(6)
            self._column.addWidget(self._heads[key])
            for widget in widgets:
                self._column.addWidget(widget)
        self._column.addStretch(1)
        self.setWidget(page)

    def _connect(self) -> None:
        session = self._session
        for signal in (
            session.cursor_changed, session.hover_changed, session.kept_changed,
            self._explainer.explained,
        ):  # fmt: skip
            signal.connect(self._show_pose)
        everything = Refresh(session, self._show_all, self)
        for signal in (session.result_changed, session.problem_changed, session.stale_changed):
            signal.connect(everything.soon)
        session.check_changed.connect(Refresh(session, self._show_gate, self).soon)
        self.gate.link_activated.connect(self._on_link)
        self.totals.link_activated.connect(self._on_link)
        session.look.language_changed.connect(Refresh(session, self.retranslate, self).next_turn)
        session.look.theme_changed.connect(Refresh(session, self.retheme, self).next_turn)

    def retranslate(self) -> None:
        """Set all texts again."""
        tr = self._tr
        for key, text in (
            ("joints", tr("Joints within their limits")),
            ("clearance", tr("Clearance")),
            ("filters", tr("Filters with value and margin")),
            ("plan", tr("Plan")),
            ("gate", tr("Program checks")),
        ):
            self._heads[key].setText(text)
        self.bars.setAccessibleName(tr("Joints within their limits"))
        self._show_all()

    def retheme(self) -> None:
        """Set all colours again."""
        theme = self._session.look.theme
        for label in (*self._heads.values(), self.subtitle, self.beyond):
            label.setStyleSheet(f"color: {theme.muted};")
        for head in self._heads.values():
            head.setStyleSheet(
                f"color: {theme.muted}; font-weight: 600; border-top: 1px solid {theme.border};"
                "padding-top: 5px;"
            )
        self.bars.set_theme(theme)
        self._show_all()

    def _show_all(self, *_: object) -> None:
        self._show_trouble()
        self._show_stale()
        self._show_pose()
        self._show_totals()
        self._show_gate()

    def _show_trouble(self) -> None:
        session = self._session
        found = trouble_of(
            session.problem_error,
            session.plan_error,
            session.answer,
            self._tr,
            session.document.state.cell,
        )
        self.trouble.setVisible(found is not None)
        if found is not None:
            self.trouble.setText(self._trouble_html(found))
            theme = session.look.theme
            self.trouble.setStyleSheet(
                f"background: {theme.surface}; border: 1px solid {theme.error};"
                f"border-radius: 4px; padding: 8px; color: {theme.text};"
            )

    def _show_stale(self) -> None:
        """Say above everything that it belongs to older inputs, and make it pale."""
        session, theme = self._session, self._session.look.theme
        stale = session.stale and session.result is not None
        self._pale.setEnabled(stale)
        self.stale.setVisible(stale)
        self.stale.setText(self._tr("Inputs changed. Plan to update."))
        self.stale.setStyleSheet(
            f"background: {theme.surface}; border: 1px solid {theme.warning};"
            f"border-radius: 4px; padding: 8px; color: {theme.warning}; font-weight: 600;"
        )

    def _trouble_html(self, trouble: Trouble) -> str:
        theme = self._session.look.theme
        parts = [f'<b style="color:{theme.error}">{trouble.headline}</b>']
        for cause in trouble.causes:
            link = ""
            if cause.waypoint is not None:
                words = self._tr("Go to waypoint {number}", number=cause.waypoint + 1)
                link = f'<br><a href="{cause.waypoint}" style="color:{theme.accent}">{words}</a>'
            elif trouble.key is not None:
                words = self._tr("Go to the field")
                link = f'<br><a href="{trouble.key}" style="color:{theme.accent}">{words}</a>'
            parts.append(cause.text + link)
        if trouble.advice:
            parts.append(f"<i>{trouble.advice}</i>")
        return "".join(f'<p style="margin:0 0 6px 0">{part}</p>' for part in parts)

    def _looked_at(self) -> tuple[Pose, Sheet] | None:
        session = self._session
        result, hover = session.result, session.hover or session.kept
        if result is None:
            return None
        if hover is not None and hover.stands_in(result.candidates):
            pose = candidate_pose(
                result, hover.waypoint, hover.orientation, hover.branch, hover.turn
            )
            explanation = self._explainer.explanation(result, pose)
            sheet = candidate_sheet(
                result, pose, hover.orientation, hover.branch, explanation, self._tr,
                chosen=session.hover is None,
            )  # fmt: skip
            return pose, sheet
        sequence = session.sequence
        if sequence is None or session.cursor >= len(sequence.pendant):
            return None
        pose = sequence_pose(sequence, session.cursor)
        unfulfilled = session.answer is not None and session.answer.sequence is None
        return pose, sequence_sheet(
            result, sequence, session.cursor, self._tr, unfulfilled=unfulfilled
        )

    def _show_pose(self, *_: object) -> None:
        looked = self._looked_at()
        result = self._session.result
        for widget in (self.facts, self.bars, self.filters, self.verdict):
            widget.setVisible(looked is not None)
        for key in ("joints", "clearance", "filters", "plan", "gate"):
            self._heads[key].setVisible(looked is not None)
        if looked is None or result is None:
            self._explainer.forget()
            self._told = False
            self.title.setText(self._tr("No pose"))
            planning = self._session.planning
            words = self._tr("Planning…") if planning else self._tr("There is no plan.")
            self.subtitle.setText(words)
            self._show_clearance(None)
            return
        pose, sheet = looked
        self._explainer.ask(result, pose)
        explanation = self._explainer.explanation(result, pose)
        self._show_sheet(sheet)
        self._told = self._told or explanation is not None
        for key in ("clearance", "filters"):
            self._heads[key].setVisible(self._told)
        # While the next pose is being explained, the last answer stays, so that nothing jumps.
        if explanation is not None:
            self._show_clearance(clearance_words(result.problem, explanation, self._tr))
            self._show_filters(filter_rows(result.problem, explanation, self._tr))

    def _show_sheet(self, sheet: Sheet) -> None:
        theme = self._session.look.theme
        self.title.setText(sheet.title)
        self.subtitle.setText(sheet.subtitle)
        self.verdict.setText(sheet.verdict)
        good = sheet.outcome is Outcome.FEASIBLE
        colour = theme.warning if sheet.near else theme.good if good else theme.error
        self.verdict.setStyleSheet(
            f"color: {colour}; border: 1px solid {colour}; border-radius: 3px; padding: 1px 6px;"
        )
        self.facts.set_rows(
            [(Text(label, theme.muted), Text(value, theme.text)) for label, value in sheet.facts]
        )
        self.bars.set_bars(sheet.joints)

    def _colour(self, state: str) -> str:
        theme = self._session.look.theme
        colours = {"good": theme.good, "near": theme.warning, "bad": theme.error}
        return colours.get(state, theme.text)

    def _show_clearance(self, words: ClearanceWords | None) -> None:
        for label in (self.clearance, self.bodies, self.beyond):
            label.setVisible(words is not None)
        self._heads["clearance"].setVisible(words is not None)
        if words is None:
            return
        self.clearance.setText(words.value)
        self.clearance.setStyleSheet(f"color: {self._colour(words.state)};")
        self.bodies.setText(words.bodies)
        self.beyond.setText(words.beyond)

    def _show_filters(self, rows: Rows[FilterRow]) -> None:
        theme = self._session.look.theme
        shown = []
        for row in rows:
            colour = self._colour(row.state)
            margin = theme.text if row.state == "good" else colour
            # In a low window each line counts: a joint stands beside the name, and the nearest
            # bodies right above with their clearance.
            beside = row.subject if row.subject.startswith("J") else ""
            below = "" if beside or row.subject == self.bodies.text() else row.subject
            name = Text(row.name, theme.text, False, beside, below, theme.muted)
            shown.append(
                (
                    Text(STATES[row.state], colour),
                    name,
                    Text(row.value, theme.muted, right=True),
                    Text(row.margin, margin, right=True),
                )
            )
        self.filters.set_rows(shown)

    def _show_totals(self) -> None:
        session, theme = self._session, self._session.look.theme
        self.totals.setVisible(session.result is not None and session.sequence is not None)
        if session.result is None or session.sequence is None:
            return
        found = totals(session.result, session.sequence, session.answer, session.report, self._tr)
        rows = []
        for one in found:
            value = one.value
            if one.waypoint is not None:
                number = self._tr("waypoint {number}", number=one.waypoint + 1)
                value += f' <a href="{one.waypoint}" style="color:{theme.accent}">{number}</a>'
            rows.append((Text(one.label, theme.muted), Text(value, self._colour(one.state))))
        self.totals.set_rows(rows)

    def _show_gate(self) -> None:
        session, theme, tr = self._session, self._session.look.theme, self._tr
        self._show_totals()
        report = session.report
        self.gate.setVisible(session.sequence is not None)
        if session.check_error is not None:
            words, _ = gate_words(None, tr)
            reason = error_words(session.check_error, tr)
            mark = Text(STATES["bad"], theme.error)
            self.gate.set_rows(
                [
                    (mark, Text(words, theme.error)),
                    (Text("", theme.error), Text(reason, theme.text)),
                ]
            )
            return
        if report is None:
            self.gate.set_rows(
                [(Text("…", theme.muted), Text(tr("Not checked yet."), theme.muted))]
            )
            return
        failed, count = report.failed, len(report.checks)
        if failed:
            words = tr("{failed} of {count} checks failed:", failed=len(failed), count=count)
            rows = [(Text(STATES["bad"], theme.error), Text(words, theme.error))]
        else:
            words = tr("All {count} checks passed", count=count)
            rows = [(Text(STATES["good"], theme.good), Text(words, theme.good))]
        for one in failed:
            text, waypoint = check_words(one, tr), waypoint_of(one)
            if waypoint is not None:
                go = tr("Go to waypoint {number}", number=waypoint + 1)
                text += f'<br><a href="{waypoint}" style="color:{theme.accent}">{go}</a>'
            rows.append((Text("", theme.error), Text(text, theme.text)))
        self.gate.set_rows(rows)

    def _on_link(self, link: str) -> None:
        if link.isdecimal():
            self._session.set_cursor(int(link))
        else:
            self.key_wanted.emit(link)
