"""Results: totals, waypoints, schemes side by side, messages."""

from __future__ import annotations

from PySide6.QtCore import QModelIndex, QSize, QSortFilterProxyModel, Qt
from PySide6.QtGui import QColor, QFont, QResizeEvent, QShowEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QFrame,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QTableView,
    QTableWidget,
    QTableWidgetItem,
    QTabWidget,
    QVBoxLayout,
    QWidget,
)

from posopt_gui.controllers.comparison import Comparison
from posopt_gui.controllers.pose_facts import NearestBodies
from posopt_gui.controllers.session import Message, Session
from posopt_gui.viewmodels.results_model import candidate_counts, notes, scheme_table, totals
from posopt_gui.viewmodels.trouble_model import plan_words, trouble_of
from posopt_gui.viewmodels.verdicts import Note
from posopt_gui.viewmodels.waypoint_table import WaypointTable
from posopt_gui.views.refresh import Refresh
from posopt_gui.views.result_tables import copy_selection, pad_cells, sign_icon, tabular
from posopt_gui.views.totals_strip import TotalsStrip
from posopt_gui.views.waypoint_model import SORT_ROLE, WaypointModel

MESSAGES = 200
"""Most messages that are kept."""

WAYPOINT_ROLE = Qt.ItemDataRole.UserRole

SIGNS = {"error": "✕", "warning": "!", "info": "i"}


class ResultsView(QWidget):
    """Everything about the plan in numbers and sentences; a line selects its waypoint."""

    def __init__(
        self,
        session: Session,
        comparison: Comparison | None = None,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._session = session
        self._tr = session.look.tr
        self.comparison = comparison or Comparison(session, self)
        self._nearest = NearestBodies(session, self)
        self._said: list[Note] = []
        self._fitted: tuple[object, ...] | None = None
        self.totals = TotalsStrip()
        self._counts = QLabel()
        self.model = WaypointModel(tabular(self.font()))
        self.sorted = QSortFilterProxyModel(self)
        self.table = QTableView()
        self.schemes = QTableWidget()
        self.messages = QListWidget()
        self.tabs = QTabWidget()
        self._copy = QPushButton()
        self._lay_out()
        self._connect()
        self.retranslate()
        self.retheme()

    def _lay_out(self) -> None:
        self.sorted.setSourceModel(self.model)
        self.sorted.setSortRole(SORT_ROLE)
        self.table.setModel(self.sorted)
        self.table.setSortingEnabled(True)
        self.table.sortByColumn(0, Qt.SortOrder.AscendingOrder)
        self.table.setAlternatingRowColors(True)
        self.table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.table.setHorizontalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.table.setShowGrid(False)
        self.table.verticalHeader().hide()
        self.table.verticalHeader().setDefaultSectionSize(22)
        self.schemes.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.schemes.setShowGrid(False)
        self.schemes.setAlternatingRowColors(True)
        self.schemes.verticalHeader().setDefaultSectionSize(24)
        self.schemes.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.Stretch)
        copy_selection(self.schemes)
        pad_cells(self.table)
        pad_cells(self.schemes)
        self.copy_action = copy_selection(self.table)
        self._copy.clicked.connect(self.copy_action.trigger)
        self.messages.setWordWrap(True)
        self.messages.setSpacing(2)
        self.messages.setIconSize(QSize(16, 16))
        self.tabs.setDocumentMode(True)
        self.tabs.tabBar().setDrawBase(False)
        for page in (self.table, self.schemes, self.messages):
            page.setFrameShape(QFrame.Shape.NoFrame)
            self.tabs.addTab(page, "")
        self.tabs.setCornerWidget(self._copy)
        foot = QHBoxLayout()
        foot.setContentsMargins(8, 2, 8, 4)
        foot.addWidget(self._counts, 1)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(2)
        column.addWidget(self.totals)
        column.addWidget(self.tabs, 1)
        column.addLayout(foot)

    def _connect(self) -> None:
        session = self._session
        self.table.doubleClicked.connect(self._on_row)
        self.table.activated.connect(self._on_row)
        self.messages.itemActivated.connect(self._on_message)
        self.messages.itemClicked.connect(self._on_message)
        self.totals.waypoint_wanted.connect(session.set_cursor)
        self.tabs.currentChanged.connect(self._on_tab)
        self._nearest.changed.connect(self._show_waypoints)
        self.comparison.changed.connect(self._show_schemes)
        session.result_changed.connect(Refresh(session, self._on_result, self).soon)
        session.problem_changed.connect(self._show_messages)
        session.check_changed.connect(Refresh(session, self._on_check, self).soon)
        session.message.connect(self._on_said)
        session.stale_changed.connect(self._on_stale)
        session.look.language_changed.connect(Refresh(session, self.retranslate, self).next_turn)
        session.look.theme_changed.connect(Refresh(session, self.retheme, self).next_turn)

    def retranslate(self) -> None:
        """Set all texts again."""
        tr = self._tr
        self.tabs.tabBar().setAccessibleName(tr("Results"))
        self.tabs.setTabText(0, tr("Waypoints"))
        self.tabs.setTabText(1, tr("Schemes"))
        self._copy.setText(tr("Copy table"))
        self._copy.setToolTip(tr("Copy the selected rows, or all, as tab-separated text (Ctrl+C)"))
        self.table.setToolTip(tr("Double-click a row to look at its waypoint"))
        for widget, name in (
            (self.table, tr("Waypoints")),
            (self.schemes, tr("Schemes")),
            (self.messages, tr("Messages")),
        ):
            widget.setAccessibleName(name)
        self._on_result()
        self.model.retranslate()

    def retheme(self) -> None:
        """Set all colours again."""
        theme = self._session.look.theme
        self.totals.set_theme(theme)
        self._counts.setStyleSheet(f"color: {theme.muted};")
        self._show_schemes()
        self._show_messages()

    def _on_result(self) -> None:
        result, sequence = self._session.result, self._session.sequence
        shown = result is not None and sequence is not None
        self._counts.setText(candidate_counts(result, self._tr) if shown and result else "")
        self._show_totals()
        self._show_waypoints()
        self._show_schemes()
        self._show_messages()
        self._on_stale()

    def showEvent(self, event: QShowEvent) -> None:  # noqa: N802 - Qt's name
        """Show what came while this was hidden."""
        super().showEvent(event)
        self._show_waypoints()
        self._show_schemes()

    def _on_check(self) -> None:
        self._show_totals()
        self._show_messages()

    def _on_stale(self, *_: object) -> None:
        self.totals.set_stale(self._session.stale, self._tr("Inputs changed. Plan to update."))

    def _on_tab(self, index: int) -> None:
        self._copy.setVisible(index == 0)
        self._show_waypoints()
        self._show_schemes()

    def _show_totals(self) -> None:
        session = self._session
        if session.result is None or session.sequence is None:
            self.totals.set_totals((), self._tr("There is no plan."))
            return
        found = totals(session.result, session.sequence, session.answer, session.report, self._tr)
        self.totals.set_totals(found, waypoint=self._tr("waypoint {number}"))

    def _show_waypoints(self) -> None:
        if self.tabs.currentIndex() != 0 or not self.isVisible():
            return
        result, sequence = self._session.result, self._session.sequence
        if result is None or sequence is None:
            self.model.set_table(None)
            return
        self._nearest.ask()
        shown = WaypointTable(result, sequence, self._nearest.names, self._tr)
        self.model.set_table(shown)
        fitted = (shown.columns, bool(self._nearest.names), self._session.look.language)
        if fitted != self._fitted and (self._nearest.names or self._fitted is None):
            self._fitted = fitted
            self.table.resizeColumnsToContents()
            # Room for the sign of the order beside the short head.
            self.table.setColumnWidth(0, max(self.table.columnWidth(0), 64))

    def _show_schemes(self) -> None:
        result = self._session.result
        if self.tabs.currentIndex() != 1 or not self.isVisible():
            return
        if result is None:
            self.schemes.setRowCount(0)
            return
        shown = scheme_table(result, self._session.answer, self.comparison.tracks, self._tr)
        self.schemes.setColumnCount(len(shown.heads))
        self.schemes.setRowCount(len(shown.rows))
        self.schemes.setHorizontalHeaderLabels(list(shown.heads))
        self.schemes.setVerticalHeaderLabels([label for label, _ in shown.rows])
        for row, (_, texts) in enumerate(shown.rows):
            for column, text in enumerate(texts):
                item = QTableWidgetItem(text)
                item.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
                font = tabular(self.font())
                if (row, column) in shown.best:
                    font.setWeight(QFont.Weight.Bold)
                    item.setForeground(QColor(self._session.look.theme.good))
                item.setFont(font)
                self.schemes.setItem(row, column, item)
        self._fit_schemes()

    def _fit_schemes(self) -> None:
        """Make the columns equally wide where that cuts nothing."""
        header, labels = self.schemes.horizontalHeader(), self.schemes.verticalHeader()
        columns = range(header.count())
        widest = max(
            (max(header.sectionSizeHint(one), self.schemes.sizeHintForColumn(one))
             for one in columns), default=0,
        )  # fmt: skip
        # The labels of the rows may be new, and the viewport not be laid out for them yet.
        room = self.schemes.width() - labels.sizeHint().width() - self._bar_width()
        modes = QHeaderView.ResizeMode
        fits = room >= widest * header.count()
        header.setSectionResizeMode(modes.Stretch if fits else modes.ResizeToContents)

    def _bar_width(self) -> int:
        return self.schemes.verticalScrollBar().sizeHint().width()

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        """Share the room among the columns anew."""
        super().resizeEvent(event)
        self._fit_schemes()

    def _on_said(self, message: Message) -> None:
        self._said.insert(0, Note(message.severity, message.text, message.waypoint))
        del self._said[MESSAGES:]
        self._show_messages()

    def _show_messages(self) -> None:
        session = self._session
        trouble = trouble_of(
            session.problem_error,
            session.plan_error,
            session.answer,
            self._tr,
            session.document.state.cell,
        )
        found = notes(session.result, session.sequence, session.report, trouble, self._tr)
        derived = {one.text for one in found}
        said = [one for one in self._said if one.text not in derived and not self._is_plan(one)]
        shown = sorted([*said, *found], key=lambda one: list(SIGNS).index(one.severity))
        theme = session.look.theme
        colours = {"error": theme.error, "warning": theme.warning, "info": theme.muted}
        icons = {name: sign_icon(sign, colours[name]) for name, sign in SIGNS.items()}
        self.messages.clear()
        for one in shown:
            item = QListWidgetItem(icons[one.severity], one.text)
            if one.severity == "error":
                item.setForeground(QColor(theme.error))
            item.setData(WAYPOINT_ROLE, one.waypoint)
            if one.waypoint is not None:
                words = self._tr("Go to waypoint {number}", number=one.waypoint + 1)
                item.setToolTip(words)
            self.messages.addItem(item)
        urgent = sum(one.severity != "info" for one in shown)
        title = self._tr("Messages")
        self.tabs.setTabText(2, f"{title} ({urgent})" if urgent else title)

    def _is_plan(self, note: Note) -> bool:
        """Whether a message repeats the plan's own error, which the notes say in full."""
        error = self._session.plan_error
        return error is not None and note.text == plan_words(error, self._tr)

    def _on_row(self, index: QModelIndex) -> None:
        self._session.set_cursor(self.sorted.mapToSource(index).row())

    def _on_message(self, item: QListWidgetItem) -> None:
        waypoint = item.data(WAYPOINT_ROLE)
        if waypoint is not None:
            self._session.set_cursor(waypoint)
