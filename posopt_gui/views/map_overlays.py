"""What lies over the cells: lines, wishes, bands, edges, and the sentence on top."""

from __future__ import annotations

from dataclasses import replace

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
from posopt_gui.viewmodels.trouble_model import Trouble, trouble_of
from posopt_gui.viewmodels.verdicts import plan_note
from posopt_gui.viewmodels.wish_words import beyond_path, wishes_on_path
from posopt_gui.views.map_canvas import MapCanvas
from posopt_gui.views.map_extras import MapExtras
from posopt_gui.views.map_header import MapHeader
from posopt_gui.views.map_pointing import Pointing
from posopt_gui.views.map_shown import Shown
from posopt_gui.views.map_widgets import LegendStrip, Notice


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
        row: LegendStrip,
    ) -> None:
        self._session, self._canvas, self._header = session, canvas, header
        self._shown, self._extras, self._pointing = shown, extras, pointing
        self._tr = session.look.tr
        self.bands: tuple[Band, ...] = ()
        self.lines: tuple[MapLine, ...] = ()
        self.notice = Notice(row)
        self._told_of: int | None = None
        self.notice.clicked.connect(self._go_to_what_is_told)
        self.notice.acted.connect(self._take_away)

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
        self._told_of = self.bands[0].waypoint if self.bands else None
        if trouble is not None:
            self.notice.tell("error", *self._trouble_words(trouble))
        elif session.stale and not session.planning:
            self.notice.tell("warning", tr("Inputs have changed; plan to update (F5)"))
        elif session.result is None and not session.planning:
            self.notice.tell("info", tr("There is no plan yet"))
        else:
            self._tell_worth()

    def _tell_worth(self) -> None:
        """Say where the plan keeps less than was asked; a good plan needs no words."""
        result, sequence = self._session.result, self._session.sequence
        said = plan_note(result, sequence, self._tr) if result and sequence else None
        if said is not None and said.severity == "warning":
            self._told_of = said.waypoint
            self.notice.tell(said.severity, said.text)
        else:
            self.notice.hide()

    def _trouble_words(self, trouble: Trouble) -> tuple[str, str]:
        """What is told in one line, and what is offered; the inspector tells all of it."""
        session, tr = self._session, self._tr
        if session.problem_error is not None or session.plan_error is not None:
            causes = () if session.plan_error is not None else trouble.causes[:1]
            return " ".join([trouble.headline, *(cause.text for cause in causes)]), ""
        state = session.document.state
        beyond = beyond_path(state.pins, state.regions, session.waypoints)
        if beyond is not None and not session.previewing:
            several = len(beyond.pins) + len(beyond.regions) > 1
            return beyond.words(tr), tr("Take them away") if several else tr("Take it away")
        pinned = any(one.waypoint == self._told_of for one in state.pins)
        offer = ""
        if pinned and self._told_of is not None and not session.previewing:
            offer = tr("Unpin waypoint {number}", number=self._told_of + 1)
        return " ".join(cause.text for cause in trouble.causes[:1]), offer

    def _take_away(self) -> None:
        """Take away what the notice offers to."""
        session = self._session
        state, count = session.document.state, session.waypoints
        if beyond_path(state.pins, state.regions, count) is not None:
            pins, regions = wishes_on_path(state.pins, state.regions, count)
            changed = replace(state, pins=pins, regions=regions)
            session.document.edit("Take away what lies beyond the path", changed)
        elif self._told_of is not None:
            session.unpin(self._told_of)

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

    def _go_to_what_is_told(self) -> None:
        if self._told_of is not None:
            self._session.set_cursor(self._told_of)
