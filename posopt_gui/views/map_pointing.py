"""Pointing at the map: the outline of the cell, the session's hover, and the card."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QPoint, QTimer

from posopt_gui.controllers.session import Hover, Session
from posopt_gui.viewmodels.map_colours import Layer
from posopt_gui.viewmodels.map_model import Reading
from posopt_gui.viewmodels.map_readings import card
from posopt_gui.views.map_canvas import MapCanvas, class_colour
from posopt_gui.views.map_extras import MapExtras
from posopt_gui.views.map_interaction import Cell
from posopt_gui.views.map_shown import Shown
from posopt_gui.views.map_widgets import HoverCard

if TYPE_CHECKING:
    from solver.candidates.explain import Explanation

QUICK = 0.010
"""Longest explanation that is asked for while the mouse moves [s]."""

PATIENCE = 80
"""How long the mouse has to rest before a slower one is asked for [ms]."""


class Pointing(QObject):
    """Shows what stands under the mouse, at once from the arrays, completely when it is known."""

    def __init__(
        self, session: Session, canvas: MapCanvas, shown: Shown, extras: MapExtras, parent: QObject
    ) -> None:
        super().__init__(parent)
        self._session, self._canvas, self._shown = session, canvas, shown
        self._extras = extras
        self.card = HoverCard(canvas)
        self.cell: Cell | None = None
        self._mouse = QPoint()
        self._explaining = False
        self._slowest = 0.0
        self._explained: tuple[Reading, Explanation] | None = None
        self._told: Reading | None = None
        self._rest = QTimer(self)
        self._rest.setSingleShot(True)
        self._rest.setInterval(PATIENCE)
        self._rest.timeout.connect(self._explain_at_rest)
        canvas.pointed.connect(self.point)
        extras.explaining.connect(self._explain_from_now)
        session.hover_changed.connect(self._show_hover)
        session.kept_changed.connect(self.show_kept)

    @property
    def reading(self) -> Reading | None:
        """What stands under the mouse."""
        return self._shown.reading(self.cell)

    @property
    def explains(self) -> bool:
        """Whether the card is complete at once."""
        return self._explaining

    def forget(self) -> None:
        """The cells are others: what was explained no longer counts."""
        self._explained = None
        self._explaining = False
        self._slowest = 0.0
        self.point(None, QPoint())

    def point(self, cell: Cell | None, mouse: QPoint) -> None:
        """Point at a cell, None at nothing."""
        self._mouse = mouse
        same = cell == self.cell
        self.cell = cell
        reading = self._told = self.reading
        if reading is None:
            self._rest.stop()
            self.card.hide()
            if not same:
                self._session.set_hover(None)
            return
        if same and self.card.isVisible():
            self.card.place(mouse)
            return
        self._session.set_hover(
            Hover(reading.waypoint, reading.orientation, reading.slot, reading.turn)
        )
        if self._explaining and self._slowest <= QUICK:
            self._explain(reading)
        elif self._explaining:
            self._rest.start()
        self._show_card(reading)

    def point_again(self) -> None:
        """Point at what stands under the resting mouse now, if that is something else."""
        if self.cell is not None and self.card.isVisible() and self.reading != self._told:
            cell, self.cell = self.cell, None
            self.point(cell, self._mouse)

    def _explain_from_now(self) -> None:
        self._explaining = True
        self._explain_at_rest()

    def _explain_at_rest(self) -> None:
        reading = self.reading
        if reading is not None:
            self._explain(reading)
            self._show_card(reading)

    def _explain(self, reading: Reading) -> None:
        from solver.candidates.explain import explain  # noqa: PLC0415 - numba

        model = self._shown.model
        if model is None:
            return
        candidates = model.candidates
        lean, lead, spin = map(float, candidates.orientations[reading.orientation])
        begin = time.perf_counter()
        found = explain(
            candidates.problem, reading.waypoint, lean, reading.branch, lead=lead, spin=spin,
            turn=reading.turn or 0, scene=candidates.scene,
        )  # fmt: skip
        # A single slow answer, as while a plan is being made, is forgotten again.
        self._slowest = max(0.8 * self._slowest, time.perf_counter() - begin)
        self._explained = (reading, found)

    def _show_card(self, reading: Reading) -> None:
        model = self._shown.model
        if model is None or reading is None:
            return
        known = self._explained
        explanation = known[1] if known is not None and known[0] == reading else None
        words = card(model, reading, self._values(reading), explanation, self._session.look.tr)
        colours = self._shown.colours
        self.card.show_card(words, class_colour(reading.kind, colours), colours.theme, self._mouse)

    def _values(self, reading: Reading) -> dict[Layer, float]:
        """What is known of the node without a computation."""
        model = self._shown.model
        if reading.node is None or model is None:
            return {}
        values = model.known_values(reading.node)
        if self._shown.extra_cost is not None:
            values[Layer.EXTRA_COST] = float(self._shown.extra_cost[reading.node])
        for scheme, order in self._extras.known.orders.items():
            values[Layer(f"expanded {scheme.value}")] = float(order[reading.node])
        return values

    def _show_hover(self, hover: Hover | None) -> None:
        self._canvas.show_outline(self._cell_of(hover), self._shown.colours)

    def show_kept(self, *_: object) -> None:
        """Mark the candidate that was chosen to be looked at."""
        self._canvas.show_kept(self._cell_of(self._session.kept), self._shown.colours)

    def _cell_of(self, candidate: Hover | None) -> Cell | None:
        """Where a candidate stands on the map, None where it does not."""
        model = self._shown.model
        if candidate is None or model is None or not candidate.stands_in(model.candidates):
            return None
        return Cell(candidate.waypoint, model.row_of_orientation(candidate.orientation))
