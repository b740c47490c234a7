"""Wishes on the map: dragging the line, pinning, forbidding and taking both back."""

from __future__ import annotations

import html
import textwrap
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QPoint
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QMenu

from posopt_gui.controllers.session import Hover, Message, Session
from posopt_gui.viewmodels.map_colours import CLASS_LABELS
from posopt_gui.viewmodels.map_model import Reading
from posopt_gui.viewmodels.map_readings import degrees, price_words
from posopt_gui.viewmodels.trouble_model import reason_words
from posopt_gui.views.map_canvas import MapCanvas
from posopt_gui.views.map_header import MapHeader
from posopt_gui.views.map_interaction import Cell
from posopt_gui.views.map_pointing import Pointing
from posopt_gui.views.map_shown import Shown
from posopt_gui.views.map_widgets import HoverCard
from solver.model.wishes import Region

if TYPE_CHECKING:
    from collections.abc import Callable

REASON_WIDTH = 54
"""Most characters in a line of the reason why there is no sequence."""

ROUNDING = 1e-6
"""Slack of a region's bounds [rad]."""


class Wishes(QObject):
    """Turns what the mouse and the keys mean into wishes of the session."""

    def __init__(
        self,
        session: Session,
        canvas: MapCanvas,
        header: MapHeader,
        shown: Shown,
        pointing: Pointing,
    ) -> None:
        super().__init__(canvas)
        self._session, self._canvas, self._header = session, canvas, header
        self._shown, self._pointing = shown, pointing
        self._tr = session.look.tr
        self.price = HoverCard(canvas)
        self._held: Cell | None = None
        self._following = object()
        self._mouse = QPoint()
        self._menu: QMenu | None = None
        canvas.clicked.connect(self._go)
        canvas.double_clicked.connect(self._pin_cell)
        canvas.line_near.connect(self._show_grip)
        canvas.line_dragged.connect(self._drag)
        canvas.line_dropped.connect(self._drop)
        canvas.area_drawn.connect(self._draw_area)
        canvas.menu_wanted.connect(self._show_menu)

    @property
    def busy(self) -> bool:
        """Whether anything is being dragged, or the next drag forbids."""
        return self._canvas.dragging or self._header.forbid_button.isChecked()

    @property
    def leaves(self) -> bool:
        """Whether Escape gives anything up here."""
        return self.busy or self._session.kept is not None

    @property
    def _branch(self) -> int | None:
        page = self._header.page
        return page.branch if page is not None else None

    @property
    def _turn(self) -> int | None:
        page = self._header.page
        return page.turn if page is not None else None

    def _lean(self, row: int) -> float:
        """Lean of a row of cells as the candidates hold it [rad]."""
        model = self._shown.model
        if model is None:
            return 0.0
        others = len(model.leads) * len(model.spins)
        return float(model.candidates.orientations[row * others, 0])

    def _go(self, cell: Cell) -> None:
        """Look at a pose; one that the sequence does not pass stays until the place changes."""
        candidate, sequence = self._candidate(cell), self._session.sequence
        self._session.set_cursor(cell.waypoint)
        passed = candidate is not None and candidate == self._passed(cell.waypoint)
        looked = candidate if sequence is not None and not passed else None
        if looked is None:
            self._session.keep(None)
        else:
            self._session.look_at(looked)

    def _candidate(self, cell: Cell) -> Hover | None:
        """What stands in a cell on the shown page."""
        found = self._shown.reading(cell)
        if found is None:
            return None
        return Hover(found.waypoint, found.orientation, found.slot, found.turn)

    def _passed(self, waypoint: int) -> Hover | None:
        """What the shown sequence passes at a waypoint."""
        sequence, model = self._session.sequence, self._shown.model
        # The nodes are numbers among the candidates of that plan alone.
        if self._session.result is not self._shown.result or sequence is None or model is None:
            return None
        if not 0 <= waypoint < len(sequence.nodes):
            return None
        node = int(sequence.nodes[waypoint])
        _, orientation, slot, turn = map(int, model.candidates.nodes.candidate[node])
        return Hover(waypoint, orientation, slot, turn)

    def _show_grip(self, waypoint: int | None) -> None:
        model = self._shown.model
        line = self._canvas.line
        if waypoint is None or model is None or waypoint >= len(line):
            self._canvas.show_handle(None, self._shown.colours)
            return
        cell = Cell(waypoint, model.row_of(float(line[waypoint])))
        self._canvas.show_handle(cell, self._shown.colours)

    def _drag(self, cell: Cell, mouse: QPoint) -> None:
        """Ask what it would cost to pass here; the answer comes with the session's signal."""
        if not self._shown.holds(cell):
            return
        self._mouse = mouse
        changed = cell != self._held
        self._held = cell
        self._pointing.point(None, mouse)
        self._canvas.show_handle(cell, self._shown.colours, held=True)
        if changed:
            self._session.set_cursor(cell.waypoint)
            self._session.keep(None)
            lean = self._lean(cell.row)
            self._session.preview_pin(cell.waypoint, lean, self._branch, self._turn)
        self.show_price()

    def show_price(self) -> None:
        """Show beside the mouse where the line is held and what that costs."""
        model, held = self._shown.model, self._held
        if held is None or model is None or not self._shown.holds(held):
            return
        # The line follows the hand first; then, in turns of their own, all other views.
        self._session.turns.ask(self._following, self._follow)
        theme = self._shown.colours.theme
        place = self._tr("Waypoint {number}", number=held.waypoint + 1)
        lean = self._tr("lean {value}", value=degrees(float(model.leans[held.row])))
        answer = self._session.answer
        words, colour = "…", theme.text
        if answer is not None and answer.sequence is None:
            words, colour = self._no_sequence(answer.reason), theme.error
        elif answer is not None:
            words = price_words(answer.price, self._shown.plan_cost, self._tr)
            words = self._tr("cost {price}", price=words)
        self.price.show_text(f"{place} · {lean}<br>{words}", self._mouse, colour)

    def _no_sequence(self, reason: str) -> str:
        """That there is none, and why, in lines that are not too long."""
        lines = textwrap.wrap(reason_words(reason, self._tr), REASON_WIDTH)
        words = "<br>".join(map(html.escape, lines))
        tone = self._shown.colours.theme.text
        plain = f'<span style="font-weight:normal; color:{tone}">{words}</span>'
        return f"{self._tr('no sequence')}<br>{plain}"

    def _follow(self) -> None:
        """Have all views look at the pose that is held."""
        held = self._held
        if held is None or self._shown.model is None or not self._shown.holds(held):
            return
        passed = self._passed(held.waypoint)
        answer = self._session.answer
        answered = answer is not None and answer.sequence is not None
        if passed is not None and answered:
            # An answer to where the hand was before is not looked at.
            here = self._shown.model.row_of_orientation(passed.orientation) == held.row
            passed = passed if here else None
        self._session.set_hover(passed if answered and passed else self._candidate(held))

    def _drop(self, cell: Cell) -> None:
        self._let_go()
        if self._shown.holds(cell):
            self._session.pin(cell.waypoint, self._lean(cell.row), self._branch, self._turn)
        else:
            self._session.end_preview()

    def _let_go(self) -> None:
        self._held = None
        self._session.turns.forget(self._following)
        self._session.set_hover(None)
        self.price.hide()
        self._canvas.show_handle(None, self._shown.colours)

    def give_up(self, *_: object) -> None:
        """Give up what is under way: the cells that it was meant for are others now."""
        self._canvas.leave()
        self._canvas.show_rubber(None, None, self._shown.colours)
        self._canvas.show_handle(None, self._shown.colours)
        if self._menu is not None:
            self._menu.close()
        if self._held is not None:
            self._let_go()
            self._session.end_preview()

    def leave(self) -> bool:
        """Give up what is being dragged or drawn; False where nothing is."""
        was = self._canvas.leave()
        self._canvas.show_rubber(None, None, self._shown.colours)
        if self._held is not None:
            self._let_go()
            self._session.end_preview()
        if self._session.kept is not None:
            self._session.keep(None)
            was = True
        if self._header.forbid_button.isChecked():
            self._header.forbid_button.setChecked(False)
            was = True
        return was

    def pin_hovered(self) -> None:
        """Pin the pose under the mouse."""
        reading = self._pointing.reading
        if reading is not None:
            self._pin(reading)

    def _pin_cell(self, cell: Cell) -> None:
        self._pointing.point(cell, self._canvas.place_of(cell))
        self.pin_hovered()

    def _pin(self, reading: Reading) -> None:
        if reading.turn is None:
            self._refuse(reading)
            return
        lean = self._lean(reading.row)
        self._session.keep(None)
        self._session.pin(reading.waypoint, lean, reading.branch, reading.turn)

    def _refuse(self, reading: Reading) -> None:
        text = self._tr(
            "Waypoint {number} cannot be pinned at lean {lean}: {verdict}.",
            number=reading.waypoint + 1, lean=degrees(reading.lean),
            verdict=self._tr(CLASS_LABELS[reading.kind]),
        )  # fmt: skip
        self._session.say(Message("warning", text, reading.waypoint))

    def unpin_here(self) -> None:
        """Take away the pin of the waypoint under the mouse, or at the cursor."""
        cell = self._pointing.cell
        self._session.unpin(cell.waypoint if cell is not None else self._session.cursor)

    def _draw_area(self, first: Cell, other: Cell, done: bool) -> None:
        self._pointing.point(None, QPoint())
        if not (self._shown.holds(first) and self._shown.holds(other)):
            return
        if not done:
            self._canvas.show_rubber(first, other, self._shown.colours)
            return
        self._canvas.show_rubber(None, None, self._shown.colours)
        self._header.forbid_button.setChecked(False)
        self._session.forbid(self.region(first, other))

    def region(self, first: Cell, other: Cell) -> Region:
        """The region between two cells, on the branch of the page that is shown."""
        low, high = sorted((first.row, other.row))
        begin, end = sorted((first.waypoint, other.waypoint))
        return Region(
            begin, end, self._lean(low) - ROUNDING, self._lean(high) + ROUNDING, self._branch
        )

    def regions_at(self, cell: Cell) -> list[int]:
        """Numbers of the forbidden regions that hold a cell on the shown page."""
        lean = self._lean(cell.row)
        return [
            number
            for number, one in enumerate(self._session.document.state.regions)
            if one.first <= cell.waypoint <= one.last
            and one.low <= lean <= one.high
            and (one.branch is None or self._branch in {None, one.branch})
        ]

    def menu(self, cell: Cell | None) -> QMenu:
        """The menu of a cell."""
        menu = QMenu(self._canvas)
        if cell is not None:
            self._fill_cell_menu(menu, cell)
            menu.addSeparator()
        state = self._session.document.state
        clear = self._add(menu, self._tr("Clear all pins and regions"), self._session.clear_wishes)
        clear.setEnabled(bool(state.pins or state.regions))
        self._add(menu, self._tr("Show all"), self._canvas.fit)
        return menu

    def _fill_cell_menu(self, menu: QMenu, cell: Cell) -> None:
        """Each entry does what it says, whatever the map shows by then."""
        reading, number = self._shown.reading(cell), cell.waypoint + 1
        if reading is None:
            return
        exact, region = self._lean(cell.row), self.region(cell, cell)
        lean = degrees(reading.lean)
        words = self._tr("Go to waypoint {number}", number=number)
        self._add(menu, words, lambda: self._session.set_cursor(cell.waypoint))
        menu.addSeparator()
        pose = self._add(menu, self._tr("Pin this pose"), lambda: self._pin(reading))
        pose.setEnabled(reading.node is not None)
        any_branch = self._add(
            menu, self._tr("Pin lean {lean}, any branch", lean=lean),
            lambda: self._session.pin(cell.waypoint, exact),
        )  # fmt: skip
        any_branch.setEnabled(reading.node is not None)
        pinned = any(one.waypoint == cell.waypoint for one in self._session.document.state.pins)
        if pinned:
            words = self._tr("Unpin waypoint {number}", number=number)
            self._add(menu, words, lambda: self._session.unpin(cell.waypoint))
        self._add(menu, self._tr("Forbid this pose"), lambda: self._session.forbid(region))
        regions = self._session.document.state.regions
        for place in self.regions_at(cell):
            words = self._tr("Allow this region again")
            self._add(menu, words, partial(self._allow, regions[place]))

    def _allow(self, region: Region) -> None:
        """Take a region away, wherever it stands among the others by now."""
        regions = self._session.document.state.regions
        if region in regions:
            self._session.allow(regions.index(region))

    def _add(self, menu: QMenu, text: str, run: Callable[[], object]) -> QAction:
        action = QAction(text, menu)
        action.triggered.connect(lambda *_: run())
        menu.addAction(action)
        return action

    def _show_menu(self, cell: Cell | None, place: QPoint) -> None:
        menu = self._menu = self.menu(cell)
        menu.aboutToHide.connect(self._forget_menu)
        menu.aboutToHide.connect(menu.deleteLater)
        menu.popup(place)

    def _forget_menu(self) -> None:
        self._menu = None
