"""What lies over the cells: lines, wishes, bands, edges, and the sentence on top."""

from __future__ import annotations

import numpy as np

from posopt_gui.controllers.session import Session
from posopt_gui.viewmodels.map_lines import (
    Band,
    MapLine,
    answer_bands,
    drawn_alike,
    error_bands,
    node_edges,
    sequence_lines,
)
from posopt_gui.viewmodels.trouble_model import trouble_of
from posopt_gui.views.map_canvas import MapCanvas
from posopt_gui.views.map_extras import MapExtras
from posopt_gui.views.map_header import MapHeader
from posopt_gui.views.map_pointing import Pointing
from posopt_gui.views.map_shown import Shown
from posopt_gui.views.map_widgets import Notice


class Overlays:
    """Brings the state of the session over the cells; each part can be shown anew by itself."""

    def __init__(
        self,
        session: Session,
        canvas: MapCanvas,
        header: MapHeader,
        shown: Shown,
        extras: MapExtras,
        pointing: Pointing,
    ) -> None:
        self._session, self._canvas, self._header = session, canvas, header
        self._shown, self._extras, self._pointing = shown, extras, pointing
        self._tr = session.look.tr
        self.bands: tuple[Band, ...] = ()
        self.lines: tuple[MapLine, ...] = ()
        self.notice = Notice(canvas)
        self.notice.clicked.connect(self._go_to_band)

    def show_all(self) -> None:
        """Show everything anew."""
        self.show_lines()
        self.show_wishes()
        self.show_bands()
        self.show_edges()

    def show_lines(self) -> None:
        """Show the chosen sequence and those to compare."""
        shown, session = self._shown, self._session
        if shown.result is None or shown.model is None:
            self.lines = ()
            self._canvas.show_lines((), (), shown.colours)
            return
        known = self._extras.known
        constant = known.constant[0] if known.constant else None
        found = sequence_lines(
            shown.result, session.answer, self._header.lines, constant, known.paths
        )
        spins = len(shown.model.spins)
        self.lines, pages = drawn_alike(found, shown.choice, spins, len(shown.model.leads) * spins)
        self._canvas.show_lines(self.lines, pages, shown.colours, self._tr)
        first = self.lines[0].candidate
        self._header.set_plan_page(int(first[0, 2]), int(first[0, 3]))

    def show_wishes(self) -> None:
        """Show pins and forbidden regions."""
        state, page = self._session.document.state, self._header.page
        pins = [
            page is None or (one.branch in {None, page.branch} and one.turn in {None, page.turn})
            for one in state.pins
        ]
        regions = [page is None or one.branch in {None, page.branch} for one in state.regions]
        self._canvas.show_pins(state.pins, pins, self._shown.colours)
        self._canvas.show_regions(state.regions, regions, self._shown.colours)

    def show_bands(self) -> None:
        """Show what breaks the sequence."""
        session, shown = self._session, self._shown
        self.bands = answer_bands(session.answer)
        if session.result is None and session.plan_error is not None:
            empty = shown.model.empty_layers if shown.model is not None else ()
            self.bands = error_bands(session.plan_error, (int(one) for one in empty))
        self._canvas.show_bands(self.bands, shown.colours)
        self.show_state()

    def show_state(self, *_: object) -> None:
        """Dim what is no longer true, and say in a sentence how things stand."""
        session, tr = self._session, self._tr
        self._canvas.dim(session.stale)
        self._canvas.draggable = not session.stale and session.result is not None
        cell = session.document.state.cell
        trouble = trouble_of(session.problem_error, session.plan_error, session.answer, tr, cell)
        if trouble is not None:
            # Why a plan failed is long, and the inspector tells it in full.
            causes = () if session.plan_error is not None else trouble.causes[:1]
            words = [trouble.headline, *(cause.text for cause in causes)]
            self.notice.tell("error", " ".join(words))
        elif session.stale and not session.planning:
            self.notice.tell("warning", tr("Inputs have changed; plan to update (F5)"))
        elif session.result is None and not session.planning:
            self.notice.tell("info", tr("There is no plan yet"))
        else:
            self.notice.hide()

    def show_edges(self, *_: object) -> None:
        """Show the edges of the node under the mouse, or of the sequence at the cursor."""
        shown = self._shown
        x, y = np.empty(0), np.empty(0)
        node = self._node_of_edges() if self._header.edges_action.isChecked() else None
        if node is not None and shown.result and shown.cells and shown.model:
            row = shown.model.row_of_node(node)
            x, y = node_edges(shown.result.graph, shown.cells, shown.model.leans, node, row)
        self._canvas.show_edges(x, y, shown.colours)

    def _node_of_edges(self) -> int | None:
        reading, sequence = self._pointing.reading, self._session.sequence
        if reading is not None:
            return reading.node
        return int(sequence.nodes[self._session.cursor]) if sequence is not None else None

    def _go_to_band(self) -> None:
        if self.bands:
            self._session.set_cursor(self.bands[0].waypoint)
