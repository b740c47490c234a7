"""Where the hints of the first run point, and what closes them by being done."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QSettings
from PySide6.QtWidgets import QWidget

from posopt_gui.controllers.session import Session
from posopt_gui.views.hints import Hints, Side, Spot
from posopt_gui.views.map_interaction import Cell
from posopt_gui.views.map_view import MapView
from posopt_gui.views.setup_view import SetupView

BEAM_KEY = "beam.section"

CHOICE = 96
"""Height of the head of the section Beam and of the fields of standard and section [px]."""


def make_hints(
    window: QWidget,
    session: Session,
    settings: QSettings,
    setup: SetupView,
    map_view: MapView,
    export: QWidget,
) -> Hints:
    """The hints of a window; they begin once the first plan is there."""
    first_beam = session.document.value(BEAM_KEY)

    def beam() -> Spot | None:
        if session.result is None or not setup.isVisible():
            return None
        box = setup.section("beam")
        # Below the choice, over the drawing: beside it the hint would hide a third of the 3D view.
        height = min(box.height() // 2, CHOICE)
        place = QPoint(setup.width() // 2, box.mapTo(setup, QPoint(0, height)).y())
        return Spot(setup, place, Side.BELOW) if 0 < place.y() < setup.height() else None

    def line() -> Spot | None:
        canvas = map_view.canvas
        model = map_view.shown.model
        if session.result is None or model is None or not len(canvas.line):
            return None
        waypoint = int(0.45 * len(canvas.line))
        row = model.row_of(float(canvas.line[waypoint]))
        place = canvas.place_of(Cell(waypoint, row)) + QPoint(0, 5)
        return Spot(canvas, place, Side.BELOW) if canvas.rect().contains(place) else None

    def end() -> Spot | None:
        if session.result is None or not export.isVisible():
            return None
        return Spot(export, QPoint(export.width() // 2, export.height() + 2), Side.BELOW)

    hints = Hints(window, session.look, settings, {"beam": beam, "line": line, "export": end})

    def on_state() -> None:
        if session.document.value(BEAM_KEY) != first_beam:
            hints.close("beam")
        if session.document.state.pins:
            hints.close("line")

    session.state_changed.connect(on_state)
    session.result_changed.connect(hints.refresh_soon)
    return hints
