"""The directed graph as a map: waypoints across, lean up, and the sequence as a line to drag."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QEvent, QSignalBlocker, Qt, Signal
from PySide6.QtGui import QAction, QImage, QKeyEvent, QKeySequence, QPainter
from PySide6.QtWidgets import QProgressBar, QVBoxLayout, QWidget

from posopt_gui.controllers.session import Session
from posopt_gui.viewmodels.map_colours import Layer, Scale
from posopt_gui.viewmodels.map_lines import CONSTANT
from posopt_gui.viewmodels.map_model import Cells, MapModel
from posopt_gui.views.map_canvas import MapCanvas
from posopt_gui.views.map_extras import MapExtras
from posopt_gui.views.map_header import MapHeader
from posopt_gui.views.map_items import qcolour
from posopt_gui.views.map_legend import show_legend
from posopt_gui.views.map_overlays import Overlays
from posopt_gui.views.map_palette import palette
from posopt_gui.views.map_pointing import Pointing
from posopt_gui.views.map_shown import Shown
from posopt_gui.views.map_widgets import LegendStrip
from posopt_gui.views.map_wishes import Wishes
from posopt_gui.views.refresh import Refresh
from solver.model.settings import Scheme
from solver.transforms import FloatArray

if TYPE_CHECKING:
    from solver.candidates.generate import CandidateSet

MANY_NODES = 100_000
"""Nodes above which pages are worked out off the window's thread: more take over 20 ms."""


class MapView(QWidget):
    """Shows the session's candidates and sequences, and takes pins and forbidden regions."""

    x_range_changed = Signal(float, float)

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._tr = session.look.tr
        self._shown = Shown(palette(session.look.theme))
        self._compared: tuple[Scheme, ...] = ()
        self._actions: list[QAction] = []
        self.header = MapHeader(session.look, self)
        self.legend = LegendStrip(self)
        self.canvas = MapCanvas(self)
        self.extras = MapExtras(self)
        self.pointing = Pointing(session, self.canvas, self._shown, self.extras, self)
        self.wishes = Wishes(session, self.canvas, self.header, self._shown, self.pointing)
        self.overlays = Overlays(
            session, self.canvas, self.header, self._shown, self.extras, self.pointing, self.legend
        )
        self._bar = QProgressBar(self)
        self._lay_out()
        self._connect()
        self._make_actions()
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.canvas.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        self.canvas.setFocusProxy(self)
        self.retheme()
        self.retranslate()
        self._on_result()
        self._on_place(session.place)

    def _lay_out(self) -> None:
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        self._bar.setFixedHeight(3)
        self._bar.setTextVisible(False)
        for widget in (self.header, self.legend, self._bar, self.canvas):
            layout.addWidget(widget, 1 if widget is self.canvas else 0)
        self._on_planning(self._session.planning)

    def _connect(self) -> None:
        session, header = self._session, self.header
        session.result_changed.connect(self._on_result)
        session.state_changed.connect(self.overlays.show_wishes)
        session.problem_changed.connect(self._on_problem)
        session.stale_changed.connect(self.overlays.show_state)
        session.stale_changed.connect(self._on_stale)
        session.place_changed.connect(self._on_place)
        session.cursor_changed.connect(self.overlays.show_edges)
        session.hover_changed.connect(self.overlays.show_edges)
        session.planning_changed.connect(self._on_planning)
        session.progress.connect(self._on_progress)
        session.look.language_changed.connect(Refresh(session, self.retranslate, self).next_turn)
        session.look.theme_changed.connect(Refresh(session, self.retheme, self).next_turn)
        header.layer_changed.connect(self._show_page)
        header.choice_changed.connect(self._show_page)
        header.lines_changed.connect(self._on_lines)
        header.forbid_toggled.connect(self._on_forbid)
        header.fit_wanted.connect(self.canvas.fit)
        self.extras.changed.connect(self._on_extras)
        self.extras.candidates_found.connect(self._on_candidates)
        self.extras.model_ready.connect(self._on_model)
        self.extras.cells_ready.connect(self._on_cells)
        self.canvas.getViewBox().sigXRangeChanged.connect(
            lambda _, limits: self.x_range_changed.emit(*limits)
        )

    @property
    def plot_item(self) -> pg.PlotItem:
        """The plot over the waypoints, to link its x axis with others."""
        return self.canvas.getPlotItem()

    @property
    def shown(self) -> Shown:
        """What the map shows at the moment."""
        return self._shown

    def set_x_range(self, low: float, high: float) -> None:
        """Show these waypoints, without telling anybody."""
        with QSignalBlocker(self):
            self.canvas.setXRange(low, high, padding=0.0)

    def grab_image(self) -> QImage:
        """A picture of legend and map as they are, without what hangs on the mouse."""
        self.pointing.card.hide()
        legend, plot = self.legend.grab().toImage(), self.canvas.grab().toImage()
        image = QImage(plot.width(), legend.height() + plot.height(), QImage.Format.Format_RGB32)
        image.fill(qcolour(self._shown.colours.theme.surface))
        image.setDevicePixelRatio(plot.devicePixelRatio())
        painter = QPainter(image)
        painter.drawImage(0, 0, legend)
        painter.drawImage(0, int(legend.height() / legend.devicePixelRatio()), plot)
        painter.end()
        return image

    def pin_hovered(self) -> None:
        """Pin the pose under the mouse."""
        self.wishes.pin_hovered()

    def forbid(self) -> None:
        """Let the next drag of the left button draw a forbidden rectangle."""
        self.header.forbid_button.setChecked(True)

    def leave(self) -> bool:
        """Give up what is being dragged or drawn; False where nothing is."""
        return self.wishes.leave()

    @property
    def actions_for_menu(self) -> tuple[QAction, ...]:
        """Pin, unpin, forbid, show all."""
        return tuple(self._actions)

    def _make_actions(self) -> None:
        for key, run in (
            (Qt.Key.Key_P, self.pin_hovered),
            (Qt.Key.Key_Delete, self.wishes.unpin_here),
            (Qt.Key.Key_X, self.forbid),
            (None, self.canvas.fit),
        ):
            action = QAction(self)
            if key is not None:
                action.setShortcut(QKeySequence(key))
            # Delete belongs to whatever has the focus; P and X mean the map everywhere.
            if key == Qt.Key.Key_Delete:
                action.setShortcutContext(Qt.ShortcutContext.WidgetWithChildrenShortcut)
            action.triggered.connect(run)
            self.addAction(action)
            self._actions.append(action)

    def event(self, event: QEvent) -> bool:
        """Escape leaves what is being dragged before it stops anything else."""
        escape = isinstance(event, QKeyEvent) and event.key() == Qt.Key.Key_Escape
        if escape and event.type() == QEvent.Type.ShortcutOverride and self.wishes.leaves:
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 - Qt's name
        """Escape leaves."""
        if not (event.key() == Qt.Key.Key_Escape and self.leave()):
            super().keyPressEvent(event)

    def retheme(self) -> None:
        """Take the colours of another theme."""
        self._shown.colours = palette(self._session.look.theme)
        theme = self._shown.colours.theme
        self.canvas.retheme(self._shown.colours)
        for card in (self.pointing.card, self.wishes.price, self.overlays.notice):
            card.set_theme(theme)
        self._bar.setStyleSheet(
            f"QProgressBar {{ background: {theme.surface}; border: 0; }}"
            f"QProgressBar::chunk {{ background: {theme.accent}; }}"
        )
        self._show_page()
        self.overlays.show_all()
        self.pointing.show_kept()

    def retranslate(self) -> None:
        """Set all texts again."""
        self.header.retranslate()
        self.plot_item.setLabel("left", self._tr("Lean [°]"))
        self.plot_item.setLabel("bottom", self._tr("Waypoint"))
        words = (
            self._tr("Pin the pose under the mouse"),
            self._tr("Unpin the waypoint under the mouse"),
            self._tr("Forbid a region of the map"),
            self._tr("Show all of the map"),
        )
        for action, text in zip(self._actions, words, strict=True):
            action.setText(text)
        self.canvas.setAccessibleName(
            self._tr("Map of all poses: waypoints across, lean up; drag the line to change it")
        )
        self._show_legend()
        self.overlays.show_lines()
        self.overlays.show_bands()

    def _on_result(self) -> None:
        """Take a new plan, or only a new answer to the same one."""
        session, shown = self._session, self._shown
        fresh = session.result is not shown.result or session.result is None
        shown.result = session.result
        shown.take_extra_cost(session.answer)
        if fresh:
            self.extras.set_result(session.result)
            candidates = session.result.candidates if session.result is not None else None
            self.show_candidates(candidates)
            if session.result is None:
                self._ask_candidates()
        elif shown.layer is Layer.EXTRA_COST or not self.wishes.busy:
            # By outcome the cells do not follow the hand: only which pose stands for each changes.
            self._show_cells()
        self.overlays.show_all()
        self.wishes.show_price()
        self._on_place(session.place)

    def show_candidates(self, candidates: CandidateSet | None) -> None:
        """Show other candidates; many are prepared off the window's thread."""
        self._shown.model = self._shown.cells = None
        self.wishes.give_up()
        self.pointing.forget()
        if candidates is not None and len(candidates.nodes) > MANY_NODES:
            # Until they are ready nothing is to be pointed at: the grid before is not theirs.
            self.canvas.set_cells(0, np.empty(0))
            self.canvas.show_cells(None, None, self._shown.colours)
            self.extras.prepare(candidates)
        else:
            self._take_model(MapModel(candidates) if candidates is not None else None)

    def _take_model(self, model: MapModel | None) -> None:
        shown, session = self._shown, self._session
        shown.model = model
        self.canvas.set_model(model)
        self.header.set_model(model)
        has_exact = shown.result is not None and Scheme.EXACT in shown.result.sequences
        self.header.set_plan_known(shown.result is not None, has_exact)
        if model is not None:
            self.extras.warm(model.candidates)
        self.canvas.show_passes(() if model is None else model.pass_starts, shown.colours)
        if session.compared != self._compared:
            self._compared = session.compared
            keys = [scheme.value for scheme in session.compared]
            self.header.set_lines([*keys, *(one for one in self.header.lines if one == CONSTANT)])
        self._show_page()
        self.overlays.show_bands()

    def _ask_candidates(self) -> None:
        """A failed plan has candidates as well: they show why it failed."""
        error, problem = self._session.plan_error, self._session.problem
        if error is None:
            return
        found = getattr(error, "candidates", None)
        if found is not None:
            self._on_candidates(found)
        elif problem is not None:
            self.extras.generate(problem)

    def _on_candidates(self, candidates: CandidateSet) -> None:
        if self._session.result is None:
            self.show_candidates(candidates)

    def _on_model(self, model: MapModel) -> None:
        """Prepared candidates came; those of an older plan are not wanted any more."""
        result = self._shown.result
        if result is None or model.candidates is result.candidates:
            self._take_model(model)

    def _on_problem(self) -> None:
        if self._session.result is None and self._shown.model is None:
            self._ask_candidates()
        self.overlays.show_state()

    def _show_page(self) -> None:
        """Show what the header says."""
        shown = self._shown
        shown.layer, shown.choice = self.header.layer, self.header.choice
        self._want_extras()
        self._show_cells()
        self.overlays.show_lines()
        self.overlays.show_wishes()

    def _given(self) -> FloatArray | None:
        """Values of the nodes that a search gives."""
        layer = self._shown.layer
        if layer.scheme is not None:
            return self.extras.known.orders.get(Scheme(layer.scheme))
        return self._shown.extra_cost

    def _show_cells(self) -> None:
        shown = self._shown
        model, given = shown.model, self._given()
        if model is None:
            shown.cells = shown.scale = None
            self._draw_cells()
        elif len(model.candidates.nodes) > MANY_NODES:
            self.extras.colour(model, shown.layer, shown.choice, given)
        else:
            self._on_cells(
                (model.cells(shown.layer, shown.choice, given), model.scale(shown.layer, given))
            )

    def _on_cells(self, coloured: tuple[Cells, Scale | None]) -> None:
        self._shown.cells, self._shown.scale = coloured
        self._draw_cells()

    def _draw_cells(self) -> None:
        shown = self._shown
        self.canvas.show_cells(shown.cells, shown.scale, shown.colours)
        self._show_legend()
        self.overlays.show_edges()
        self.pointing.point_again()

    def _show_legend(self) -> None:
        known = self._given() is not None
        show_legend(self.legend, self._shown, known=known, tr=self._tr)

    def _want_extras(self) -> None:
        schemes = [Scheme(key) for key in self.header.lines if key != CONSTANT]
        known = self._shown.result.sequences if self._shown.result is not None else {}
        wanted: list[Scheme] = [
            one for one in schemes if one is not Scheme.EXACT and one not in known
        ]
        if self._shown.layer.scheme is not None:
            wanted.append(Scheme(self._shown.layer.scheme))
        self.extras.want(dict.fromkeys(wanted), constant=CONSTANT in self.header.lines)

    def _on_lines(self) -> None:
        self._want_extras()
        self.overlays.show_lines()
        self.overlays.show_edges()

    def _on_extras(self) -> None:
        if self._shown.layer.scheme is not None:
            self._show_cells()
        self.overlays.show_lines()
        self._want_extras()

    def _on_forbid(self, forbidding: bool) -> None:
        self.canvas.forbidding = forbidding
        if forbidding:
            self.setFocus()

    def _on_stale(self, stale: bool) -> None:
        if stale:
            self.wishes.give_up()

    def _on_place(self, place: float) -> None:
        self.canvas.show_cursor(place)

    def _on_planning(self, planning: bool) -> None:
        self._bar.setRange(0, 0 if planning else 1)
        self._bar.setValue(0)
        policy = self._bar.sizePolicy()
        policy.setRetainSizeWhenHidden(True)
        self._bar.setSizePolicy(policy)
        self._bar.setVisible(planning)
        self.overlays.show_state()

    def _on_progress(self, _stage: str, done: int, total: int) -> None:
        self._bar.setRange(0, max(total, 1))
        self._bar.setValue(min(done, total))
