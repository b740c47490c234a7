"""Panning and zooming the map with each tab of the curves, for the benchmark of the window."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from posopt_gui.main_window import MainWindow

PANS, ZOOMS = 60, 30
CURVES: Final = ("joints", "clearance", "manipulability", "step", "feed")
"""The tabs with a plot over the waypoints, in their order."""

ZOOM: Final = 0.9
"""What one turn of the wheel leaves of the width."""


def pan_and_zoom(
    window: MainWindow, frame: Callable[[Callable[[], object]], float], rest: Callable[[], object]
) -> dict[str, list[float]]:
    """How long each frame takes [s], by what is done.

    `frame` does a thing and returns how long it took until it was painted; `rest` lets a tab that
    has been opened be drawn. The width of the view is half of the path, and while zooming the
    whole of it to a twentieth.
    """
    canvas, tabs = window.map.canvas, window.curves.tabs
    count = float(window.session.waypoints)

    def show(low: float, width: float) -> None:
        canvas.setXRange(0.5 + low, 0.5 + low + width, padding=0.0)

    found: dict[str, list[float]] = {}
    for index, name in enumerate(CURVES):
        tabs.setCurrentIndex(index)
        rest()
        found[f"frame: panning the map, {name}"] = [
            frame(lambda step=step: show(0.4 * count * step / PANS, 0.5 * count))  # type: ignore[misc]
            for step in range(PANS)
        ]
        widths = [count * ZOOM**step for step in range(ZOOMS)]
        found[f"frame: zooming the map, {name}"] = [
            frame(lambda width=width: show(0.4 * (count - width), width))  # type: ignore[misc]
            for width in widths
        ]
        canvas.fit()
    tabs.setCurrentIndex(0)
    rest()
    return found
