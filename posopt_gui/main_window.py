"""The main window: puts the panels together and connects them; nothing is computed here."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QSettings, QTimer, Signal
from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDropEvent
from PySide6.QtWidgets import (
    QLabel,
    QMainWindow,
    QTabWidget,
    QToolButton,
    QWidget,
)

from posopt_gui.actions import Actions
from posopt_gui.controllers.session import CLOSING_TIME, Message, Session
from posopt_gui.dialogs.file_questions import FileQuestions
from posopt_gui.panels import building_steps, load_modules
from posopt_gui.views.look_switch import LookSwitch
from posopt_gui.views.one_flush import OneFlush
from posopt_gui.views.places import Places
from posopt_gui.views.refresh import Refresh
from posopt_gui.views.shell_parts import RecentMenu
from posopt_gui.views.status_line import StatusLine
from posopt_gui.views.tool_bar import ToolBar
from posopt_gui.views.typed import apply_typed
from posopt_gui.workers.jobs import JobLine, end_all
from posopt_gui.workers.threads import JobThreads
from solver.model.scheme import Scheme

if TYPE_CHECKING:
    from posopt_gui.controllers.files import Files
    from posopt_gui.controllers.recovery import Recovery
    from posopt_gui.dialogs.export_dialog import ExportDialog
    from posopt_gui.dialogs.setup_dialogs import SetupDialogs
    from posopt_gui.views.curves_view import CurvesView
    from posopt_gui.views.front_view import FrontView
    from posopt_gui.views.guide_window import GuideWindow
    from posopt_gui.views.hints import Hints
    from posopt_gui.views.inspector_view import InspectorView
    from posopt_gui.views.map_view import MapView
    from posopt_gui.views.results_view import ResultsView
    from posopt_gui.views.scene_view import SceneView
    from posopt_gui.views.setup_view import SetupView
    from posopt_gui.views.timeline_view import TimelineView

TITLE = "posopt"
SCHEMES = (Scheme.EXACT, Scheme.F, Scheme.F1, Scheme.F2)


class MainWindow(QMainWindow):
    """Shell first; the panels, plots and the 3D view follow once it is on screen."""

    ready = Signal()

    # Built once the frame is on screen, see posopt_gui.panels.
    setup: SetupView
    setup_dialogs: SetupDialogs
    inspector: InspectorView
    timeline: TimelineView
    scene: SceneView
    map: MapView
    curves: CurvesView
    results: ResultsView
    front: FrontView
    hints: Hints

    def __init__(
        self, session: Session, files: Files, recovery: Recovery, settings: QSettings
    ) -> None:
        super().__init__()
        self.session, self.files, self.recovery = session, files, recovery
        self.files.ask = FileQuestions(self, session.look)
        self._settings = settings
        self._tr = session.look.tr
        self.look_switch = LookSwitch(self, session)
        self._views: list[QWidget] = []
        self.guide: GuideWindow | None = None
        self._dialogs: dict[str, ExportDialog] = {}
        self.setMinimumSize(1024, 680)
        self.resize(1440, 900)
        self.setAcceptDrops(True)
        OneFlush(self)
        self.actions_table = Actions(self, session.look)
        self._menus = self.actions_table.fill(self.menuBar())
        self._recent = RecentMenu(self)
        self._menus["File"].insertMenu(self.actions_table["save"], self._recent)
        self._bar = ToolBar(self, self.actions_table, SCHEMES)
        self.addToolBar(self._bar)
        self._make_status_bar()
        self.places = Places(self, settings)
        self.tabs = QTabWidget()
        self.tabs.setDocumentMode(True)
        self.tabs.tabBar().setDrawBase(False)
        self.all_ended = True
        self._pool = JobThreads(1, self)
        self._loads = JobLine(self._pool, self)
        self._loads.done.connect(self._build_in_turns)
        self._connect()
        self.retranslate()
        self.retheme()

    def _make_status_bar(self) -> None:
        bar = self.statusBar()
        self.status = StatusLine(self.session, bar)
        self.status.checks_wanted.connect(self.show_export)
        self._units, self._languages = QLabel("mm · °"), QToolButton()
        self._languages.clicked.connect(self.actions_table["chinese"].trigger)
        for widget in (self._units, self._languages):
            bar.addPermanentWidget(widget)

    def load_views(self) -> None:
        """Build all panels at once."""
        for step in building_steps(self):
            step()

    def load_views_in_turns(self) -> None:
        """Build the panels while the window lives; `ready` says when all are there.

        Plots and OpenGL are loaded on a thread of their own, after the window shows.
        """
        self._loads.submit(lambda _: load_modules())

    def _build_in_turns(self) -> None:
        """Ask for one panel after the other: what is asked for meanwhile comes between them."""
        turns, steps = self.session.turns, building_steps(self)

        def go_on() -> None:
            step = next(steps, None)
            if step is not None:
                step()
                turns.ask("panel", go_on)

        turns.ask("panel", go_on)

    def panels_built(self) -> None:
        """Connect the panels with each other and with the shell."""
        from posopt_gui.views.hint_spots import make_hints  # noqa: PLC0415 - loads the plots

        self.places.settle()
        self._views = [
            self.setup, self.inspector, self.timeline, self.scene, self.map, self.curves,
            self.results, self.front,
        ]  # fmt: skip
        self._link_axes()
        self._fill_menus()
        self.inspector.key_wanted.connect(self._show_field)
        self.files.begun.connect(self.setup.forget_typed)
        self.files.path_refused.connect(lambda path, _: self.setup.load_path(str(path)))
        self.retranslate()
        button = self._bar.widgetForAction(self.actions_table["export"])
        self.hints = make_hints(self, self.session, self._settings, self.setup, self.map, button)
        self.ready.emit()

    def _fill_menus(self) -> None:
        """Put the panels' own actions, with their keys, into the menus."""
        tools = self.scene.tools
        for menu, actions in (
            ("Plan", self.map.actions_for_menu),
            ("Plan", self.timeline.actions_for_menu),
            ("View", [*tools.camera_actions, tools.fit_action]),
            ("View", list(tools.part_actions.values())),
        ):
            self._menus[menu].addSeparator()
            self._menus[menu].addActions(list(actions))
        self._menus["View"].addSeparator()
        self._menus["View"].addActions(self.places.actions)

    def _show_recent(self) -> None:
        files = self.files
        self._recent.show_files(files.recent, files.open_file, files.clear_recent, self._tr)

    def _show_field(self, key: str) -> None:
        self.places.show("Setup")
        self.setup.focus_key(key)

    def _link_axes(self) -> None:
        """One x axis for the map and the curves."""
        self.map.x_range_changed.connect(self.curves.set_x_range)
        self.curves.x_range_changed.connect(self.map.set_x_range)

    def _connect(self) -> None:
        session, look = self.session, self.session.look
        self.actions_table.connect(
            {
                "new": self.files.new,
                "open": self.files.open,
                "save": self.files.save,
                "save_as": self.files.save_as,
                "export": self.show_export,
                "report": self.save_report,
                "quit": self.close,
                "undo": self._undo,
                "redo": session.document.redo,
                "clear_wishes": session.clear_wishes,
                "plan": self._plan,
                "stop": session.stop,
                "live": self._set_live,
                "compare": self._set_compared,
                "dark": lambda on: look.set_theme("dark" if on else "light"),
                "chinese": lambda on: look.set_language("zh_CN" if on else "en"),
                "reset_layout": self.places.reset,
                "guide": self.open_guide,
                "about": self.show_about,
            }
        )
        self.actions_table["dark"].setChecked(look.theme.dark)
        self.actions_table["chinese"].setChecked(look.language == "zh_CN")
        self._bar.scheme.activated.connect(self._choose_scheme)
        session.planning_changed.connect(self._on_planning)
        session.state_changed.connect(self._on_state)
        session.document.history_changed.connect(self._on_state)
        for changed in (
            session.result_changed, session.stale_changed, session.answering_changed
        ):  # fmt: skip
            changed.connect(self._on_result)
        self.files.title_changed.connect(self._on_title)
        self.files.typed_wanted.connect(lambda: apply_typed(self))
        self.files.recent_changed.connect(self._show_recent)
        look.language_changed.connect(Refresh(session, self.retranslate, self).next_turn)
        look.theme_changed.connect(Refresh(session, self.retheme, self).next_turn)
        self._on_planning(False)
        self._on_state()

    def retranslate(self) -> None:
        """Set all words of the shell again; the panels do it for themselves."""
        self.actions_table.retranslate()
        self.places.retranslate(self._tr)
        if self._views:
            self.tabs.tabBar().setAccessibleName(self._tr("Curves and results"))
            self.tabs.setTabText(0, self._tr("Curves"))
            self.tabs.setTabText(1, self._tr("Results"))
            self.tabs.setTabText(2, self._tr("Front"))
        self._bar.retranslate(self.session.look)
        self._languages.setText("English" if self.session.look.language == "zh_CN" else "中文")
        self._languages.setToolTip(self._tr("Change the language"))
        self._show_recent()
        self._on_state()
        self._on_title()
        self._on_result()

    def retheme(self) -> None:
        """Draw the shell's own icons in the colours of the theme; LookSwitch does all else."""
        self.places.retheme(self.session.look.theme)

    def export_dialog(self) -> ExportDialog:
        """The export dialog; it is made when it is first asked for."""
        from posopt_gui.dialogs.export_dialog import ExportDialog  # noqa: PLC0415

        dialog = self._dialogs.get("export")
        if dialog is None:
            dialog = self._dialogs["export"] = ExportDialog(self.session, self)
            dialog.report_requested.connect(self.save_report)
        return dialog

    def show_export(self) -> None:
        """Open the export dialog, or bring it to the front."""
        if not self.apply_typed():
            return
        self.hints.close("export")
        dialog = self.export_dialog()
        dialog.exporter.set_folder(self.files.folder)
        dialog.show()
        dialog.raise_()
        dialog.activateWindow()

    def save_report(self) -> None:
        """Write the HTML report with pictures of the panels."""
        if not self.apply_typed():
            return
        pictures = {
            "map": self.map.grab_image(),
            "curves": self.curves.grab().toImage(),
            "scene": self.scene.grab_image(),
        }
        dialog = self._dialogs.get("export")
        form = dialog.exporter.form_of_plan if dialog is not None else None
        self.files.save_report(pictures, form)

    def open_guide(self) -> None:
        """Show the user guide."""
        from posopt_gui.views.guide_window import GuideWindow  # noqa: PLC0415

        file = self.files.guide()
        if not file:
            return
        if self.guide is None:
            self.guide = GuideWindow(self.session.look, self)
        self.guide.open(Path(file))
        self.guide.show()
        self.guide.raise_()

    def show_about(self) -> None:
        """Say what this is and what it is not."""
        words = (
            "posopt plans on the nominal model of a cell. A checked program still has to be "
            "verified on the robot, in T1, by a person."
        )
        self.session.say(Message("info", self._tr(words)))

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:  # noqa: N802 - Qt's name
        """Take files."""
        if any(url.isLocalFile() for url in event.mimeData().urls()):
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:  # noqa: N802 - Qt's name
        """Open a project or a cell, or take a path file into the project."""
        paths = [url.toLocalFile() for url in event.mimeData().urls() if url.isLocalFile()]
        if paths:
            event.acceptProposedAction()
            QTimer.singleShot(0, lambda: self.files.drop(paths[0]))

    def closeEvent(self, event: QCloseEvent) -> None:  # noqa: N802 - Qt's name
        """Ask about unsaved work, keep the layout, and wait for what still runs."""
        if not self.files.may_close():
            event.ignore()
            return
        if self._views:
            self.places.save()
        for dialog in self._dialogs.values():
            dialog.shut_down()
            dialog.close()
        self.recovery.end()
        self.session.turns.clear()
        # A window may be closed before all of its panels are built.
        if hasattr(self, "setup"):
            self.setup.path.loader.close()
            self.setup.fixtures.loader.close()
        if hasattr(self, "map"):
            self.map.extras.close()
        if hasattr(self, "front"):
            self.front.front.close()
        self.session.close()
        self.all_ended = end_all(self, self.session, patience=CLOSING_TIME)
        self.files.ended()
        event.accept()

    def apply_typed(self) -> bool:
        """Apply what is being typed; False where a field holds a text that is not taken."""
        apply_typed(self)
        row = self.setup.refused_row() if self._views else None
        if row is not None:
            self.session.say(Message("warning", row.refusal_text()))
            self._show_field(row.field.key)
        return row is None

    def _undo(self) -> None:
        apply_typed(self)
        self.session.document.undo()

    def _plan(self) -> None:
        if self.apply_typed():
            self.session.plan()

    def _set_live(self, on: bool) -> None:
        self.session.live = on
        apply_typed(self)
        if on and self.session.stale:
            self._plan()

    def _set_compared(self, on: bool) -> None:
        self.session.set_compared(SCHEMES if on else (Scheme.EXACT, Scheme.F2))
        self._plan()

    def _choose_scheme(self, row: int) -> None:
        self.session.document.set_value("settings.scheme", SCHEMES[row].value, "Scheme")
        self._plan()

    def _on_planning(self, busy: bool) -> None:
        self.actions_table["stop"].setEnabled(busy)

    def _on_state(self) -> None:
        document = self.session.document
        for name, can, label in (
            ("undo", document.can_undo, document.undo_label),
            ("redo", document.can_redo, document.redo_label),
        ):
            self.actions_table[name].setEnabled(can)
            self.actions_table.say_what(name, self._tr(label) if label else "")
        state = document.state
        self.actions_table["clear_wishes"].setEnabled(bool(state.pins or state.regions))
        self._bar.show_scheme(document.value("settings.scheme"))
        self._on_title()

    def _on_title(self) -> None:
        mark = "*" if self.session.document.modified else ""
        self.setWindowTitle(f"{self.files.name}{mark} - {TITLE}")

    def _on_result(self, *_: object) -> None:
        session = self.session
        self.actions_table["export"].setEnabled(session.result is not None)
        settled = session.settled_result is not None
        self.actions_table["report"].setEnabled(settled and bool(self._views))
