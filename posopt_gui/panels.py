"""The panels of the window: loaded off its thread, built one in each turn of the event loop."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from posopt_gui.main_window import MainWindow
    from posopt_gui.views.curve_plots import PlotStock

MODULES: Final = (
    "pyqtgraph",
    "posopt_gui.views.setup_view",
    "posopt_gui.dialogs.setup_dialogs",
    "posopt_gui.views.inspector_view",
    "posopt_gui.views.timeline_view",
    "posopt_gui.views.scene_view",
    "posopt_gui.views.scene_canvas",
    "posopt_gui.views.map_view",
    "posopt_gui.views.curves_view",
    "posopt_gui.views.results_view",
    "posopt_gui.views.front_view",
    "posopt_gui.views.hint_spots",
)
"""What the panels need and what takes long to load, in the order in which they are built."""

Step = Callable[[], object]


def load_modules() -> None:
    """Load what the panels need; on a worker's thread, so that the window lives meanwhile."""
    for name in MODULES:
        # What cannot be loaded says so where it is used: without OpenGL the rest works.
        with contextlib.suppress(ImportError, OSError):
            import_module(name)


def building_steps(window: MainWindow) -> Iterator[Step]:
    """Everything that has to be done to fill a window, in small pieces."""
    for build in (_setup, _inspector, _timeline, _scene, _map):
        yield partial(build, window)
    from posopt_gui.views.curve_plots import PlotStock  # noqa: PLC0415
    from posopt_gui.views.curves_view import GAUGED, PLAIN  # noqa: PLC0415

    stock = PlotStock(window.session.look.theme)
    for _ in range(GAUGED):
        yield partial(stock.make, gauged=True)
    for _ in range(PLAIN):
        yield partial(stock.make, gauged=False)
    yield partial(_curves, window, stock)
    for build in (_results, _front, _tabs):
        yield partial(build, window)
    for number, view in enumerate((window.scene, window.map, window.tabs)):
        yield partial(window.places.put_middle, number, view)
    yield window.panels_built


def _setup(window: MainWindow) -> None:
    from posopt_gui.dialogs.setup_dialogs import SetupDialogs  # noqa: PLC0415
    from posopt_gui.views.setup_view import SetupView  # noqa: PLC0415

    window.setup = SetupView(window.session)
    window.setup_dialogs = SetupDialogs(window.session, window.setup)
    window.places.put("Setup", window.setup)


def _inspector(window: MainWindow) -> None:
    from posopt_gui.views.inspector_view import InspectorView  # noqa: PLC0415

    window.inspector = InspectorView(window.session)
    window.places.put("Inspector", window.inspector)


def _timeline(window: MainWindow) -> None:
    from posopt_gui.views.timeline_view import TimelineView  # noqa: PLC0415

    window.timeline = TimelineView(window.session)
    window.places.put("Playback", window.timeline)


def _scene(window: MainWindow) -> None:
    from posopt_gui.views.scene_view import SceneView  # noqa: PLC0415

    window.scene = SceneView(window.session)


def _map(window: MainWindow) -> None:
    from posopt_gui.views.map_view import MapView  # noqa: PLC0415

    window.map = MapView(window.session)


def _curves(window: MainWindow, stock: PlotStock) -> None:
    from posopt_gui.views.curves_view import CurvesView  # noqa: PLC0415

    window.curves = CurvesView(window.session, stock=stock)


def _results(window: MainWindow) -> None:
    from posopt_gui.views.results_view import ResultsView  # noqa: PLC0415

    window.results = ResultsView(window.session, window.curves.comparison)


def _front(window: MainWindow) -> None:
    from posopt_gui.views.front_view import FrontView  # noqa: PLC0415

    window.front = FrontView(window.session)


def _tabs(window: MainWindow) -> None:
    for view in (window.curves, window.results, window.front):
        window.tabs.addTab(view, "")
