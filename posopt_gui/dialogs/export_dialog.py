"""The export dialog: checks, preview of the text, and the file that is written."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Final

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtGui import QHideEvent, QShowEvent
from PySide6.QtWidgets import (
    QDialog,
    QFileDialog,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QSplitter,
    QVBoxLayout,
    QWidget,
)

from posopt_gui.controllers.export import Exporter
from posopt_gui.controllers.files import with_suffix
from posopt_gui.controllers.session import Message, Session
from posopt_gui.dialogs.check_table import CheckTable
from posopt_gui.dialogs.export_form import ExportFormPanel
from posopt_gui.dialogs.export_style import style_sheet
from posopt_gui.dialogs.file_questions import FileQuestions
from posopt_gui.dialogs.program_preview import ProgramPreview
from posopt_gui.dialogs.verdict_banner import VerdictBanner
from posopt_gui.viewmodels.export_model import ExportStage, ExportView, export_view, format_of
from posopt_gui.views.quiet_editors import QuietCombo
from posopt_gui.views.refresh import Refresh

SIZE: Final = (1240, 780)
LEAST_SIZE: Final = (960, 620)
MARGIN: Final = 14


class ExportDialog(QDialog):
    """A window of its own beside the main one; nothing in it waits for the solver.

    `report_requested` asks for the HTML report of what is shown. `replaces` answers whether an
    existing file may be replaced, and `chooses` names a file; both are questions to the person.
    """

    report_requested = Signal()

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._tr = session.look.tr
        self.exporter = Exporter(session, self)
        self.replaces: Callable[[Path], bool] = FileQuestions(self, session.look).may_replace
        self.chooses: Callable[[Path, str], str] = self._ask_path
        self._files: tuple[tuple[str, str], ...] = ()
        self.setModal(False)
        self.setWindowFlag(Qt.WindowType.WindowMaximizeButtonHint, True)
        self.setSizeGripEnabled(True)
        self._make_parts()
        self._lay_out()
        self._connect()
        self.setMinimumSize(*LEAST_SIZE)
        self.resize(*SIZE)
        self.retranslate()
        self.retheme()

    def _make_parts(self) -> None:
        look = self._session.look
        self.banner = VerdictBanner(look)
        self.checks = CheckTable(look)
        self.preview = ProgramPreview(look)
        self.form = ExportFormPanel(look)
        self._checks_title, self._preview_title = QLabel(), QLabel()
        for title in (self._checks_title, self._preview_title):
            title.setObjectName("paneTitle")
        self.file_choice = QuietCombo()
        self.note = QLabel()
        self.note.setWordWrap(True)
        self.note.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.report_button, self.close_button = QPushButton(), QPushButton()
        self.export_button = QPushButton()
        self.export_button.setObjectName("primary")
        for button in (self.report_button, self.close_button, self.export_button):
            button.setAutoDefault(False)

    def _lay_out(self) -> None:
        splitter = QSplitter(Qt.Orientation.Horizontal)
        splitter.addWidget(_column(self._checks_title, self.checks))
        splitter.addWidget(_column(self._preview_title, self.preview, self.file_choice))
        splitter.setSizes([820, 380])
        splitter.setHandleWidth(MARGIN)
        splitter.setStretchFactor(0, 3)
        splitter.setStretchFactor(1, 2)
        splitter.setChildrenCollapsible(False)
        footer = QHBoxLayout()
        footer.addWidget(self.note, 1)
        for button in (self.report_button, self.close_button, self.export_button):
            footer.addWidget(button)
        page = QVBoxLayout(self)
        page.setContentsMargins(MARGIN, MARGIN, MARGIN, MARGIN)
        page.setSpacing(10)
        page.addWidget(self.banner)
        page.addWidget(splitter, 1)
        page.addWidget(self.form)
        page.addLayout(footer)

    def _connect(self) -> None:
        exporter, form = self.exporter, self.form
        exporter.changed.connect(self.refresh)
        exporter.progress.connect(self.banner.show_progress)
        form.post_chosen.connect(exporter.set_post)
        form.path_typed.connect(exporter.set_path)
        form.simplify_chosen.connect(exporter.set_simplify)
        form.clearance_chosen.connect(exporter.set_accepted)
        form.reason_typed.connect(exporter.set_reason)
        form.browse_wanted.connect(self._browse)
        form.override_wanted.connect(lambda: self._export(override=True))
        self.banner.plan_wanted.connect(self._session.plan)
        self.checks.waypoint_chosen.connect(self._session.set_cursor)
        self.checks.line_chosen.connect(self._show_line)
        self.file_choice.currentIndexChanged.connect(self._show_file)
        self.report_button.clicked.connect(self.report_requested)
        self.close_button.clicked.connect(self.hide)
        self.export_button.clicked.connect(self._export)
        session = self._session
        session.look.language_changed.connect(Refresh(session, self.retranslate, self).next_turn)
        session.look.theme_changed.connect(Refresh(session, self.retheme, self).next_turn)

    def retranslate(self) -> None:
        """Set all texts in the chosen language."""
        tr = self._tr
        self.setWindowTitle(tr("Export the program"))
        self._checks_title.setText(tr("Checks"))
        self._preview_title.setText(tr("Preview"))
        self.file_choice.setAccessibleName(tr("File of the program"))
        self.report_button.setText(tr("Report…"))
        self.report_button.setToolTip(tr("Save a page with pictures, checks and settings"))
        self.close_button.setText(tr("Close"))
        self.export_button.setText(tr("Export"))
        self.export_button.setToolTip(tr("Write the program, read it back and check it again"))
        for part in (self.banner, self.checks, self.preview, self.form):
            part.retranslate()
        self.refresh()

    def retheme(self) -> None:
        """Set the colours again."""
        self.setStyleSheet(style_sheet(self._session.look.theme))
        for part in (self.checks, self.preview):
            part.retheme()
        self.refresh()

    def refresh(self) -> None:
        """Show the exporter's situation."""
        now = self.exporter.situation
        view = export_view(now, self._tr)
        self.banner.show_view(view)
        self.checks.show_rows(view.rows, old=view.old)
        self._show_files(view)
        self.form.show_form(now, view)
        self.note.setText(view.note)
        self.note.setProperty("tone", view.note_tone)
        self.note.style().polish(self.note)
        self.export_button.setEnabled(view.can_export)
        self.report_button.setEnabled(view.stage in {ExportStage.PASSED, ExportStage.REFUSED})

    def _show_files(self, view: ExportView) -> None:
        if view.files == self._files:
            return
        self._files = view.files
        chosen = max(self.file_choice.currentIndex(), 0)
        with QSignalBlocker(self.file_choice):
            self.file_choice.clear()
            self.file_choice.addItems([name for name, _ in view.files])
            self.file_choice.setCurrentIndex(min(chosen, len(view.files) - 1))
        self.file_choice.setVisible(len(view.files) > 1)
        self._show_file()

    def _show_file(self) -> None:
        index = self.file_choice.currentIndex()
        self.preview.show_text(self._files[index][1] if 0 <= index < len(self._files) else "")

    def _show_line(self, name: str, line: int) -> None:
        """Mark the line that a check names, in whichever part of the program it is."""
        names = [one for one, _ in self._files]
        if name in names:
            self.file_choice.setCurrentIndex(names.index(name))
            self.preview.show_line(line)

    def _export(self, _checked: bool = False, *, override: bool = False) -> None:
        target = self.exporter.target(override=override)
        program = self.exporter.program
        if target.exists() and not self.replaces(target):
            return
        if self.exporter.program == program:
            self.exporter.export(override=override)
            return
        words = "The program changed while you were asked: look at it and export it again."
        self._session.say(Message("warning", self._tr(words)))

    def _browse(self) -> None:
        form = self.exporter.form
        path = self.chooses(Path(form.path), format_of(form.post).suffix)
        if path:
            self.exporter.set_path(path)

    def _ask_path(self, proposal: Path, suffix: str) -> str:
        # Whether a file may be replaced is asked when it is written.
        option = QFileDialog.Option.DontConfirmOverwrite
        title, kinds = self._tr("File of the program"), f"*{suffix} (*{suffix})"
        path, _ = QFileDialog.getSaveFileName(self, title, str(proposal), kinds, options=option)
        return str(with_suffix(Path(path), suffix)) if path else ""

    def shut_down(self) -> bool:
        """Cancel everything and wait for it; call it before the application ends."""
        return self.exporter.close()

    def showEvent(self, event: QShowEvent) -> None:  # noqa: N802 - Qt's name
        """Begin to draft."""
        super().showEvent(event)
        self.exporter.set_active(True)

    def hideEvent(self, event: QHideEvent) -> None:  # noqa: N802 - Qt's name
        """Stop drafting while nobody looks."""
        super().hideEvent(event)
        self.exporter.set_active(False)


def _column(title: QLabel, body: QWidget, beside: QWidget | None = None) -> QWidget:
    """A titled pane; `beside` stands at the right of the title."""
    pane = QWidget()
    layout = QVBoxLayout(pane)
    layout.setContentsMargins(0, 0, 0, 0)
    layout.setSpacing(4)
    head = QHBoxLayout()
    head.addWidget(title, 1)
    if beside is not None:
        head.addWidget(beside)
        beside.hide()
    layout.addLayout(head)
    layout.addWidget(body, 1)
    return pane
