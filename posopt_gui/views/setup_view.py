"""The setup panel: every input of the cell in sections that open and close."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtGui import QDragEnterEvent, QDropEvent
from PySide6.QtWidgets import (
    QLabel,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from posopt_gui.controllers.session import Session
from posopt_gui.document.project import key_of_error
from posopt_gui.style import of_all_themes
from posopt_gui.viewmodels.cell_facts import Catalogue, in_mm
from posopt_gui.viewmodels.cell_form import Form, cell_form
from posopt_gui.viewmodels.error_words import error_words
from posopt_gui.viewmodels.form_types import Field, at, rows_of
from posopt_gui.viewmodels.path_words import path_words
from posopt_gui.viewmodels.project_files import kept_files, key_of_file, path_file
from posopt_gui.views.beam_drawing_view import BeamDrawingView
from posopt_gui.views.field_widgets import FieldRow
from posopt_gui.views.refresh import Refresh
from posopt_gui.views.setup_extras import FixtureList, PathFileBox, dropped_path_file
from posopt_gui.views.setup_fixtures import SetupFixtures
from posopt_gui.views.setup_path import SetupPath
from posopt_gui.views.setup_sections import SectionBox
from posopt_gui.views.setup_style import setup_style
from solver.errors import InputError, PosoptError

WIDTH = 320
LEAST_WIDTH = 300
HINT_LINES = 4


class SetupView(QWidget):
    """All inputs of the cell, written to the document as they are edited.

    Signals: `path_questions(preview)` where a path file needs answers before it can be read, or
    a person wants to see its columns; `placement_wanted()` for the three touched points.
    """

    path_questions = Signal(object)
    placement_wanted = Signal()

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("setup")
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        self.setStyleSheet(of_all_themes(setup_style))
        self.setAcceptDrops(True)
        self.setMinimumWidth(LEAST_WIDTH)
        self._session = session
        self._tr = session.look.tr
        self._catalogue: Catalogue | None = None
        self._form: Form | None = None
        self._seen: tuple[Any, ...] = ()
        self._wrong = ""
        self._refused = ""
        self._hinted: FieldRow | None = None
        self._boxes: dict[str, SectionBox] = {}
        self.path = SetupPath(session, self)
        self.path.questions.connect(self.path_questions)
        self.path.refused.connect(self._on_refused)
        self.path.loaded.connect(self._show_path)
        self.fixtures = SetupFixtures(session, self)
        self.fixtures.chosen_changed.connect(self.refresh)
        self.fixtures.refused.connect(self._on_mesh_refused)
        self._lay_out()
        session.state_changed.connect(self.refresh)
        session.problem_changed.connect(self._show_problem)
        session.look.language_changed.connect(Refresh(session, self.retranslate, self).next_turn)
        session.look.theme_changed.connect(Refresh(session, self.retheme, self).next_turn)
        self.retheme()
        # The catalogue takes a moment to load; the window is on screen before.
        QTimer.singleShot(0, self, self.refresh)

    @property
    def form(self) -> Form | None:
        """What is shown; None before the catalogue was read."""
        return self._form

    @property
    def problem_key(self) -> str:
        """Dotted key of the value that cannot be used; '' where all can."""
        return self._wrong

    def section(self, name: str) -> SectionBox:
        """The box of a section."""
        return self._boxes[name]

    def refresh(self) -> None:
        """Follow the document."""
        state = self._session.document.state
        now = (state.cell, state.files, state.folder, self.fixtures.chosen)
        if self._form is not None and all(a is b for a, b in zip(now, self._seen, strict=True)):
            return
        if self._catalogue is None:
            self._catalogue = Catalogue()
        self.fixtures.bound(len(rows_of(state.cell, "fixtures")))
        self._seen = (*now[:3], self.fixtures.chosen)
        self._form = cell_form(
            state.cell,
            self._catalogue,
            folder=state.folder,
            files=state.files,
            fixture=self.fixtures.chosen,
        )
        self._refused = ""
        for section in self._form.sections:
            if section.name not in self._boxes:
                self._add_box(section.name)
            self._boxes[section.name].show_section(section, state.cell)
        self._show_extras()
        self._show_error()

    def refused_row(self) -> FieldRow | None:
        """The first field with a text that is not taken; None where there is none."""
        rows = (row for box in self._boxes.values() for row in box.rows.values())
        return next((row for row in rows if row.refusal is not None), None)

    def forget_typed(self) -> None:
        """Drop every text that is not taken."""
        while (row := self.refused_row()) is not None:
            row.forget_typed()

    def retranslate(self) -> None:
        """Set every text again."""
        for box in self._boxes.values():
            box.retranslate()
            if isinstance(box.extra, PathFileBox | FixtureList):
                box.extra.retranslate()
        self._show_extras()
        self._show_error()
        self._show_hint(None)
        self.setAccessibleName(self._tr("Setup"))

    def retheme(self) -> None:
        """Set every colour again."""
        drawing = self._boxes["beam"].extra if "beam" in self._boxes else None
        if isinstance(drawing, BeamDrawingView):
            drawing.set_theme(self._session.look.theme)

    def focus_key(self, key: str) -> None:
        """Open the section of a key of the cell, scroll to its field and put the keyboard there."""
        if self._form is None:
            self.refresh()
        if key.startswith("fixtures."):
            self.fixtures.choose(int(key.split(".")[1]))
        assert self._form is not None
        name, field_key = self._form.place_of(key)
        box = self._boxes.get(name)
        if box is None:
            return
        box.set_open(True)
        row = box.row(field_key)
        self._sections.activate()
        if row is None:
            self._scroll.ensureWidgetVisible(box)
            box.focus_header()
            return
        last = key.rpartition(".")[2]
        row.focus_editor(int(last) if key != field_key and last.isdecimal() else 0)
        QTimer.singleShot(0, row, lambda: self._scroll.ensureWidgetVisible(row, 0, 60))

    def open_sections(self) -> tuple[str, ...]:
        """Names of the sections that are open, to be kept for the next time."""
        return tuple(name for name, box in self._boxes.items() if box.opened)

    def set_open_sections(self, names: tuple[str, ...]) -> None:
        """Open these sections and close all others."""
        self.refresh()
        for name, box in self._boxes.items():
            box.set_open(name in names)

    def load_path(self, file: str) -> None:
        """Load a path file; where it needs answers, `path_questions` is emitted."""
        self.path.load(file)

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:  # noqa: N802 - Qt's name
        """Take path files anywhere on the panel."""
        if dropped_path_file(event):
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:  # noqa: N802 - Qt's name
        """Load the dropped file."""
        file = dropped_path_file(event)
        if file:
            event.acceptProposedAction()
            self.load_path(file)

    def _lay_out(self) -> None:
        self._problem = QPushButton(self)
        self._problem.setObjectName("problem")
        self._problem.clicked.connect(lambda: self.focus_key(self._wrong))
        self._problem.hide()
        self._whole = QLabel(self)
        self._whole.setObjectName("sentence")
        self._whole.setWordWrap(True)
        self._whole.setContentsMargins(10, 6, 10, 6)
        self._whole.hide()
        self._body = QWidget(self)
        self._body.setObjectName("setupBody")
        self._sections = QVBoxLayout(self._body)
        self._sections.setContentsMargins(0, 0, 0, 0)
        self._sections.setSpacing(0)
        self._sections.addStretch(1)
        self._scroll = QScrollArea(self)
        self._scroll.setObjectName("setupScroll")
        self._scroll.setWidgetResizable(True)
        self._scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self._scroll.setWidget(self._body)
        self._hint = QLabel(self)
        self._hint.setObjectName("hint")
        self._hint.setWordWrap(True)
        self._hint.setAlignment(Qt.AlignmentFlag.AlignTop | Qt.AlignmentFlag.AlignLeft)
        self._hint.setFixedHeight(HINT_LINES * self._hint.fontMetrics().lineSpacing() + 14)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(self._problem)
        layout.addWidget(self._whole)
        layout.addWidget(self._scroll, 1)
        layout.addWidget(self._hint)
        self._show_hint(None)

    def _add_box(self, name: str) -> None:
        assert self._form is not None
        section = self._form.section(name)
        box = SectionBox(section, self._tr, lambda: self._made_extra(name), self._body)
        box.edited.connect(self._on_edited)
        box.focused.connect(self._show_hint)
        box.toggled.connect(self._on_toggled)
        box.file_wanted.connect(self.fixtures.ask_mesh)
        self._boxes[name] = box
        self._sections.insertWidget(self._sections.count() - 1, box)
        if section.open:
            box.show_section(section, self._form.cell)
            box.set_open(True)

    def _made_extra(self, name: str) -> QWidget:
        if name == "beam":
            return BeamDrawingView(self._session.look.theme)
        if name == "placement":
            button = QPushButton()
            button.clicked.connect(self.placement_wanted)
            return button
        if name == "fixtures":
            fixtures = FixtureList(self._tr)
            fixtures.chosen.connect(self.fixtures.choose)
            fixtures.add_wanted.connect(self.fixtures.add)
            fixtures.remove_wanted.connect(self.fixtures.remove)
            return fixtures
        file = PathFileBox(self._tr)
        file.dropped.connect(self.load_path)
        file.open_wanted.connect(self.path.choose)
        file.columns_wanted.connect(self.path.ask)
        return file

    def _show_extras(self) -> None:
        if self._form is None:
            return
        for box in self._boxes.values():
            extra = box.extra
            if isinstance(extra, BeamDrawingView):
                section = self._form.facts.section
                extra.show_section(section, self._drawing_words())
            elif isinstance(extra, FixtureList):
                names = [str(one.get("name", "?")) for one in rows_of(self._form.cell, "fixtures")]
                extra.show_fixtures(names, self.fixtures.chosen)
            elif isinstance(extra, PathFileBox):
                extra.show_file(str(at(self._form.cell, "path.file", "")), self._path_words())
                extra.show_sentence(self._refused)
            elif isinstance(extra, QPushButton):
                extra.setText(self._tr("By three touched points…"))
                extra.setToolTip(
                    self._tr("Compute the placement from three points in fanuc_world.")
                )

    def _drawing_words(self) -> str:
        section = self._form.facts.section if self._form is not None else None
        if section is None:
            return self._tr("No section to draw")
        values = (section.height, section.width, section.web, section.flange, section.root)
        height, width, web, flange, root = (f"{in_mm(one):g}" for one in values)
        return self._tr(
            "Section: H {h}, B {b}, tw {tw}, tf {tf}, r {r} mm",
            h=height, b=width, tw=web, tf=flange, r=root,
        )  # fmt: skip

    def _path_words(self) -> str:
        """What the path holds; '' where it is not read."""
        problem = self._session.problem
        if problem is None:
            return ""
        return path_words(problem.toolpath, self._tr)

    def _on_edited(self, field: Field, value: Any) -> None:
        assert self._form is not None
        document = self._session.document
        if field.key == "path.kind" and value == "file" and not path_file(document.state.files):
            self._boxes["path"].show_section(self._form.section("path"), self._form.cell)
            self.path.choose()
            return
        cell = self._form.edited(field, value)
        if cell is None:
            return
        state = replace(document.state, cell=cell, files=kept_files(cell, document.state.files))
        document.edit(field.label, state, merge=f"setup:{field.key}")

    def _on_refused(self, sentence: str) -> None:
        self._refused = sentence
        box = self._boxes.get("path")
        if box is None:
            return
        if sentence and not isinstance(box.extra, PathFileBox):
            # Another kind of path is shown: the sentence stands at the section.
            box.set_error("", sentence)
        elif sentence:
            box.set_open(True)
        self._show_extras()

    def _show_path(self) -> None:
        """Open the section of the path, and scroll to it."""
        box = self._boxes.get("path")
        if box is None:
            return
        box.set_open(True)
        bar = self._scroll.verticalScrollBar()
        QTimer.singleShot(0, box, lambda: bar.setValue(box.y()))

    def _on_mesh_refused(self, key: str, sentence: str) -> None:
        name, field_key = self._form.place_of(key) if key and self._form else ("fixtures", "")
        if name in self._boxes:
            self._boxes[name].set_error(field_key, sentence)

    def _on_toggled(self, opened: bool) -> None:
        if opened:
            self._show_extras()
            self._show_error()

    def _show_problem(self) -> None:
        self._show_extras()
        self._show_error()

    def _show_error(self) -> None:
        error = self._session.problem_error
        section, field = self._place_of(error)
        sentence = error_words(error, self._tr) if error is not None else ""
        for name, box in self._boxes.items():
            box.set_error(field if name == section else "", sentence if name == section else "")
        self._problem.setVisible(error is not None)
        if error is not None:
            shown = self._form.field(field) if self._form is not None else None
            title = self._form.section(section).title if self._form and section else "Cell"
            where = self._tr(shown.label if shown is not None else title)
            text = self._tr("Cannot be used: {where}", where=where)
            self._problem.setText(text)
            self._problem.setToolTip(sentence)
        # What belongs to no section has no other place for its sentence.
        self._whole.setText("" if section else sentence)
        self._whole.setVisible(bool(sentence) and not section)

    def _place_of(self, error: PosoptError | None) -> tuple[str, str]:
        self._wrong = ""
        if not isinstance(error, InputError) or self._form is None:
            return "", ""
        key = key_of_error(error)
        if key is None and error.place is not None:
            key = key_of_file(self._form.cell, error.place.file)
        self._wrong = key or ""
        return self._form.place_of(key)

    def _show_hint(self, row: FieldRow | None) -> None:
        if row is None:
            self._hint.setText(
                self._tr("Choose a field to see what it says, its range and its default.")
            )
            return
        self._hint.setText(row.tip())
