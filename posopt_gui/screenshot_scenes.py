"""What pictures are taken of: each scene prepares the window and says what is grabbed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from PySide6.QtWidgets import QWidget

from posopt_gui.document.project import state_of_cell
from posopt_gui.screenshot_stage import Stage
from posopt_gui.viewmodels.map_colours import Layer
from posopt_gui.viewmodels.map_lines import CONSTANT
from solver.model.settings import Scheme
from solver.model.wishes import Region
from solver.units import DEG

Act = Callable[[Stage], None]
Show = Callable[[Stage], QWidget]


def nothing(_stage: Stage) -> None:
    """Nothing has to be done."""


WAYPOINT: Final = 16
"""The waypoint, from 0, that most pictures look at."""

EVERY_LINE: Final = (*(scheme.value for scheme in Scheme), CONSTANT)

STRANGE_PATH: Final = "no;pos_a;pos_b;height;na;nb;nc\n" + "".join(
    f"{n + 1};{-400 + 16 * n};13.5;{-80 + 0.2 * n:.1f};0;1;0\n" for n in range(30)
)
"""A path whose header says nothing that is known."""

STRANGE_COLUMNS: Final = ("x", "y", "z", "nx", "ny", "nz")


@dataclass(frozen=True, slots=True)
class Scene:
    """A picture: its name and what it shows.

    `show` arranges the window in every look and says what is grabbed, `hide` takes that back;
    `begin` and `end` stand around all looks, for what has to be planned.
    """

    name: str
    tells: str
    show: Show
    hide: Act = nothing
    begin: Act = nothing
    end: Act = nothing


def _window(stage: Stage) -> QWidget:
    stage.window.places.share_height()
    stage.window.tabs.setCurrentIndex(0)
    stage.session.set_cursor(WAYPOINT)
    return stage.window


def _map(stage: Stage) -> QWidget:
    stage.window.places.share_height((3, 14, 7))
    stage.session.set_cursor(WAYPOINT)
    return stage.window.map


def _layer(layer: Layer) -> Show:
    def show(stage: Stage) -> QWidget:
        header = stage.window.map.header
        header.set_layer(layer)
        stage.run_for(0.5)
        known = stage.window.map.extras.known.orders
        if layer.scheme is not None:
            stage.wait(lambda: Scheme(layer.scheme) in known, "the order of expansion")
        return _map(stage)

    return show


def _plain_map(stage: Stage) -> None:
    stage.window.map.header.set_layer(Layer.OUTCOME)
    stage.window.map.header.set_lines([one.value for one in stage.session.compared])


def _schemes(stage: Stage) -> QWidget:
    header = stage.window.map.header
    header.set_layer(Layer.CLEARANCE)
    header.set_lines(EVERY_LINE)
    stage.run_for(1.0)
    return _map(stage)


def _dragged(stage: Stage) -> QWidget:
    found = _map(stage)
    stage.run_for(0.2)
    stage.hold_line(24, 3.0)
    return found


def _hovered(stage: Stage) -> QWidget:
    _map(stage)
    stage.run_for(0.2)
    stage.point_at(20, -6.0)
    return stage.window


def _unhovered(stage: Stage) -> None:
    stage.let_go()
    stage.session.set_hover(None)


def _wishes(stage: Stage) -> None:
    session = stage.session
    session.pin(9, 5.0 * DEG)
    session.forbid(Region(22, 31, 8.5 * DEG, 17.5 * DEG))
    stage.wait(lambda: session.answer is not None, "the answer to the wishes")
    stage.plan_ready()


def _free(stage: Stage) -> None:
    stage.session.clear_wishes()
    stage.wait(lambda: stage.session.answer is None, "the plan without wishes")
    stage.plan_ready()


def _blocked(stage: Stage) -> None:
    session = stage.session
    session.forbid(Region(28, 28, -25.0 * DEG - 1e-6, 25.0 * DEG + 1e-6))
    stage.wait(lambda: session.answer is not None, "the answer to the wishes")


def _infeasible(stage: Stage) -> None:
    stage.session.document.set_value("settings.lean_deg", [-25.0, -12.0, 1.0], "Lean")
    stage.session.plan()
    stage.wait(lambda: stage.session.plan_error is not None, "the refusal")
    stage.wait(lambda: stage.window.map.shown.model is not None, "the rejected candidates")


def _undone(stage: Stage) -> None:
    document = stage.session.document
    while document.can_undo:
        document.undo()
    stage.replan()


def _stale(stage: Stage) -> None:
    document = stage.session.document
    x, y = document.value("beam.position_xy_mm")
    document.set_value("beam.position_xy_mm", [x + 60.0, y], "Placement")
    stage.wait(lambda: stage.session.stale, "the mark of changes")
    stage.drawn()


def _scene(preset: str, *parts: str) -> Show:
    def show(stage: Stage) -> QWidget:
        scene = stage.window.scene
        stage.window.places.share_height((14, 4, 6))
        stage.session.set_cursor(WAYPOINT)
        for part in parts:
            scene.tools.show_part(part)
        stage.run_for(0.3)
        scene.look_from(preset)
        stage.run_for(0.3)
        return scene

    return show


def _plain_scene(stage: Stage) -> None:
    for part in ("bodies", "frames"):
        stage.window.scene.tools.show_part(part, shown=False)
    stage.window.scene.look_from("Overview")


def _curves(tab: int, *references: str) -> Show:
    def show(stage: Stage) -> QWidget:
        window = stage.window
        window.places.share_height((3, 7, 14))
        window.tabs.setCurrentWidget(window.curves)
        window.curves.tabs.setCurrentIndex(tab)
        window.curves.legend.set_shown(references)
        stage.session.set_cursor(WAYPOINT)
        return window.curves

    return show


def _results(tab: int) -> Show:
    def show(stage: Stage) -> QWidget:
        window = stage.window
        window.places.share_height((3, 7, 14))
        window.tabs.setCurrentWidget(window.results)
        window.results.tabs.setCurrentIndex(tab)
        return window.results

    return show


def _front(stage: Stage) -> QWidget:
    window = stage.window
    window.places.share_height((3, 7, 14))
    window.tabs.setCurrentWidget(window.front)
    front = window.front.front
    stage.wait(lambda: front.model is not None and not front.stale, "the front")
    stage.run_for(0.2)
    window.front.plot.pointed.emit(2 * len(front.model or ()) // 3)
    return window.front


def _no_front(stage: Stage) -> None:
    stage.window.front.plot.pointed.emit(-1)
    _curves_again(stage)


def _all_schemes(stage: Stage) -> None:
    stage.session.set_compared((Scheme.EXACT, Scheme.F, Scheme.F1, Scheme.F2))
    stage.replan()


def _two_schemes(stage: Stage) -> None:
    stage.session.set_compared((Scheme.EXACT, Scheme.F2))
    stage.replan()


def _curves_again(stage: Stage) -> None:
    stage.window.curves.tabs.setCurrentIndex(0)
    stage.window.curves.legend.set_shown(["NOMINAL"])
    stage.window.tabs.setCurrentIndex(0)


def _setup(*sections: str) -> Show:
    def show(stage: Stage) -> QWidget:
        stage.window.setup.set_open_sections(sections)
        return stage.window.setup

    return show


def _setup_again(stage: Stage) -> None:
    stage.window.setup.set_open_sections(("beam", "path"))


def _inspector(stage: Stage) -> QWidget:
    stage.session.set_cursor(WAYPOINT)
    return stage.window.inspector


def _export(stage: Stage) -> QWidget:
    stage.window.show_export()
    dialog = stage.window.export_dialog()
    dialog.exporter.set_folder(stage.programs)
    stage.wait(lambda: dialog.exporter.situation.current, "the draft")
    stage.run_for(0.3)
    return dialog


def _refused(stage: Stage) -> None:
    stage.session.document.set_value("settings.safety_distance_mm", 90.0, "Safety distance")
    stage.replan()


def _no_export(stage: Stage) -> None:
    stage.window.export_dialog().hide()


def _placement(stage: Stage) -> QWidget:
    import numpy as np  # noqa: PLC0415

    dialogs = stage.window.setup_dialogs
    stage.window.setup.placement_wanted.emit()
    dialog = dialogs.placement
    assert dialog is not None
    # A beam that was moved by 12 mm and turned by half a degree.
    turn = np.radians(0.5)
    along = np.array([np.sin(turn), np.cos(turn), 0.0])
    corner = np.array([1062.0, -700.0, 225.0])
    points = [corner, corner + 1000.0 * along, corner + 500.0 * along + [0.0, 0.0, -150.0]]
    dialog.set_points(np.round(points, 1))
    return dialog


def _no_placement(stage: Stage) -> None:
    dialog = stage.window.setup_dialogs.placement
    if dialog is not None:
        dialog.close()


def _columns(stage: Stage) -> QWidget:
    from posopt_gui.viewmodels.path_preview import examine  # noqa: PLC0415
    from solver.io.importers import Source  # noqa: PLC0415

    state = stage.session.document.state
    source = Source("weld_seam.csv", STRANGE_PATH.encode())
    preview = examine(source, state.cell, folder=state.folder)
    stage.window.setup.path.questions.emit(preview)
    dialog = stage.window.setup_dialogs.path
    assert dialog is not None
    for column, field in enumerate(STRANGE_COLUMNS):
        dialog.set_column(column + 1, field)
    stage.wait(dialog.accept_button.isEnabled, "the path")
    return dialog


def _no_columns(stage: Stage) -> None:
    dialog = stage.window.setup_dialogs.path
    if dialog is not None:
        dialog.close()


def _hint(name: str) -> Show:
    def show(stage: Stage) -> QWidget:
        stage.window.hints.open_only(name)
        stage.run_for(0.2)
        return _window(stage)

    return show


def _no_hints(stage: Stage) -> None:
    stage.window.hints.close_all()


def _guide(stage: Stage) -> QWidget:
    stage.window.open_guide()
    stage.run_for(0.5)
    return stage.window.guide or stage.window


def _no_guide(stage: Stage) -> None:
    if stage.window.guide is not None:
        stage.window.guide.hide()


def _passes(stage: Stage) -> None:
    stage.open(state_of_cell("zigzag_hw250"))


def _one_pass(stage: Stage) -> None:
    stage.open(state_of_cell("groove_hw300"))


SCENES: Final[tuple[Scene, ...]] = (
    Scene("window", "the whole window with the default cell, planned", _window),
    Scene("first_run", "the first of three hints in place", _hint("beam"), _no_hints),
    Scene("first_run_line", "the second hint: drag the line", _hint("line"), _no_hints),
    Scene("first_run_export", "the third hint: export", _hint("export"), _no_hints),
    Scene("map_outcome", "map by outcome", _layer(Layer.OUTCOME), _plain_map),
    Scene("map_regret", "map by extra cost", _layer(Layer.EXTRA_COST), _plain_map),
    Scene("map_clearance", "map by clearance", _layer(Layer.CLEARANCE), _plain_map),
    Scene("map_manipulability", "by manipulability", _layer(Layer.MANIPULABILITY), _plain_map),
    Scene("map_limits", "by distance to limits", _layer(Layer.LIMIT_MARGIN), _plain_map),
    Scene("map_expanded", "map by A*'s order of expansion", _layer(Layer.EXPANDED_F2), _plain_map),
    Scene("map_schemes", "the schemes' lines and the constant lean", _schemes, _plain_map),
    Scene("map_pin_dragged", "the line being dragged", _dragged, Stage.let_go),
    Scene("map_hover", "what stands under the mouse", _hovered, _unhovered),
    Scene("map_wishes", "a pin and a forbidden region, and the plan without them", _map,
          begin=_wishes, end=_free),
    Scene("map_blocked", "a layer that wishes have blocked", _map, begin=_blocked, end=_free),
    Scene("scene_overview", "the cell in 3D", _scene("Overview"), _plain_scene),
    Scene("scene_close_up", "the groove with the clearance line", _scene("Close-up"), _plain_scene),
    Scene("scene_bodies", "bounding bodies and frames", _scene("Overview", "bodies", "frames"),
          _plain_scene),
    Scene("curves_joints", "joints, before with the nominal lean and after", _curves(0, "NOMINAL"),
          _curves_again),
    Scene("curves_clearance", "clearance before and after",
          _curves(1, "NOMINAL", "CONSTANT", "RANDOM"), _curves_again),
    Scene("curves_manipulability", "manipulability", _curves(2, "NOMINAL"), _curves_again),
    Scene("curves_step", "steps of the joints", _curves(3, "NOMINAL"), _curves_again),
    Scene("curves_feed", "predicted feed", _curves(4), _curves_again),
    Scene("curves_change", "cumulative change", _curves(5, "NOMINAL", "CONSTANT", "RANDOM"),
          _curves_again),
    Scene("curves_measures", "measures and gains", _curves(6), _curves_again),
    Scene("results_waypoints", "table of waypoints", _results(0), _curves_again),
    Scene("results_schemes", "schemes side by side", _results(1), _curves_again,
          begin=_all_schemes, end=_two_schemes),
    Scene("results_messages", "messages", _results(2), _curves_again),
    Scene("front", "clearance against joint motion, a point under the mouse", _front, _no_front,
          begin=_all_schemes, end=_two_schemes),
    Scene("inspector", "a pose with its filters", _inspector),
    Scene("setup_beam", "the beam and its drawing", _setup("beam"), _setup_again),
    Scene("setup_place", "placement and fixtures", _setup("placement", "fixtures"), _setup_again),
    Scene("setup_path", "path and lean", _setup("path", "lean"), _setup_again),
    Scene("setup_limits", "limits and clearance", _setup("limits", "clearance"), _setup_again),
    Scene("setup_program", "program and links", _setup("program"), _setup_again),
    Scene("placement", "placement by three touched points", _placement, _no_placement),
    Scene("path_columns", "columns of a path file that names none", _columns, _no_columns),
    Scene("export_passed", "the export dialog, all checks passed", _export, _no_export),
    Scene("export_refused", "the export dialog, refused", _export, _no_export,
          begin=_refused, end=_undone),
    Scene("guide", "the user guide", _guide, _no_guide),
    Scene("window_stale", "inputs have changed", _window, begin=_stale, end=_undone),
    Scene("window_no_sequence", "no sequence, and why", _window, begin=_infeasible, end=_undone),
    Scene("window_passes", "three passes on two flanges and the web", _window, begin=_passes,
          end=_one_pass),
)  # fmt: skip
"""All pictures, in the order in which they are taken."""
