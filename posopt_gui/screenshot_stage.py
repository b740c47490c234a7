"""A window that pictures are taken of: it waits until all is drawn, and grabs what is seen."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QEvent, QPoint, QPointF, QRect, QSettings, Qt, QTimer
from PySide6.QtGui import QImage, QMouseEvent, QPainter, QRegion
from PySide6.QtWidgets import QApplication, QWidget

from posopt_gui.controllers.files import Files, state_of_argument
from posopt_gui.controllers.recovery import Recovery
from posopt_gui.controllers.session import Session
from posopt_gui.document.document import Document
from posopt_gui.document.project import ProjectState
from posopt_gui.look import Look
from posopt_gui.main_window import MainWindow
from posopt_gui.start import application
from posopt_gui.views.map_interaction import Cell
from posopt_gui.views.scene_view import SceneView

PATIENCE = 300.0
"""How long a plan, a check or a drawing may take [s]; the first one compiles the kernels."""

QUIET = 0.15
"""How long nothing may happen before a picture is taken [s]."""


OVERLAYS = {"hint", "map_card"}
"""Names of what lies over the whole window."""


class Stage:
    """One window with settings of its own, in the size, theme and language that are asked for."""

    def __init__(self, folder: Path, cell: str | None = None) -> None:
        self.application: QApplication = application()
        self.settings = QSettings(str(folder / "settings.ini"), QSettings.Format.IniFormat)
        self.settings.clear()
        self.programs = folder / "programs"
        self.programs.mkdir()
        # Where a person's own work may lie is not looked at.
        state, _ = state_of_argument(cell)
        self.session = Session(Document(state), Look())
        files = Files(self.session, self.settings)
        recovery = Recovery(self.session, files, folder / "recovery")
        self.window = MainWindow(self.session, files, recovery, self.settings)
        self.window.show()
        self.window.load_views()
        self.window.hints.close_all()
        self.session.start()
        self.plan_ready()

    def close(self) -> None:
        """Close the window, whatever was changed."""
        self.session.document.mark_saved()
        self.window.close()
        self.run_for(QUIET)

    def wait(self, condition: Callable[[], object], what: str) -> None:
        """Let the window work until a condition holds.

        Raises
        ------
        TimeoutError
            When it does not come to hold in time.
        """
        end = time.monotonic() + PATIENCE
        while not condition():
            if time.monotonic() > end:
                raise TimeoutError(f"no picture: {what} did not come")
            self.run_for(0.02)

    def run_for(self, seconds: float) -> None:
        """Let the window work for a while."""
        end = time.monotonic() + seconds
        # An event of its own wakes the loop up at the end.
        QTimer.singleShot(int(1000 * seconds), lambda: None)
        while time.monotonic() < end:
            self.application.processEvents()
            self.application.sendPostedEvents(None, QEvent.Type.DeferredDelete.value)

    def plan_ready(self) -> None:
        """Wait for plan, check and everything that is worked out of them."""
        session, window = self.session, self.window
        self.wait(lambda: session.problem is not None, "the problem")
        self.wait(lambda: not session.planning and not session.stale, "the plan")
        if session.sequence is not None and (session.answer is None or session.answer.sequence):
            self.wait(lambda: session.report is not None, "the check")
            self.wait(lambda: window.curves.comparison.tracks, "the references")
            self.wait(lambda: window.map.pointing.explains, "the explanations")
        self.drawn()

    def drawn(self) -> None:
        """Wait for all that the window still has to do, and for the 3D view, where there is one."""
        scene, turns = self.window.scene, self.session.turns
        self.run_for(QUIET)
        # Until another look is there, the window holds what it shows.
        self.wait(lambda: not (turns.waiting or self.window.look_switch.going_on), "the look")
        if scene.canvas is not None and self.session.problem is not None:
            self.wait(lambda: scene.drawn, "the 3D view")
        self.run_for(QUIET)

    def open(self, state: ProjectState) -> None:
        """Begin with other inputs and plan them."""
        self.session.open(state)
        self.session.start()
        self.plan_ready()

    def replan(self) -> None:
        """Plan the inputs as they are."""
        self.session.plan()
        self.wait(lambda: not self.session.planning, "the plan")
        self.plan_ready()

    def look(self, theme: str, language: str, size: tuple[int, int]) -> None:
        """Give the window another look."""
        look, window = self.session.look, self.window
        look.set_theme(theme)
        look.set_language(language)
        if window.size().toTuple() != size:
            window.resize(*size)
            self.run_for(QUIET)
            window.places.share_width()
            window.places.share_height()
        self.drawn()
        if window.scene.canvas is not None and not window.scene.tools.shown["bodies"]:
            window.scene.fit()
        self.run_for(QUIET)

    def hold_line(self, waypoint: int, lean: float) -> None:
        """Take hold of the map's line at a waypoint (from 0) and drag it to a lean [deg]."""
        canvas = self.window.map.canvas
        model = canvas.model
        if model is None:
            return
        start = canvas.place_of(Cell(waypoint, model.row_of(float(canvas.line[waypoint]))))
        end = canvas.place_of(Cell(waypoint, model.row_of(lean)))
        left, none = Qt.MouseButton.LeftButton, Qt.MouseButton.NoButton
        self._mouse(QEvent.Type.MouseMove, start, none, none)
        self._mouse(QEvent.Type.MouseButtonPress, start, left, left)
        for part in (0.5, 1.0):
            place = QPoint(end.x(), round(start.y() + part * (end.y() - start.y())))
            self._mouse(QEvent.Type.MouseMove, place, none, left)
            self.run_for(QUIET)

    def point_at(self, waypoint: int, lean: float) -> None:
        """Point at a cell of the map."""
        canvas = self.window.map.canvas
        if canvas.model is not None:
            place = canvas.place_of(Cell(waypoint, canvas.model.row_of(lean)))
            none = Qt.MouseButton.NoButton
            self._mouse(QEvent.Type.MouseMove, place, none, none)
            self.run_for(3 * QUIET)

    def let_go(self) -> None:
        """Give up what is dragged, and point at nothing."""
        canvas = self.window.map.canvas
        if not self.window.map.leave():
            QApplication.sendEvent(canvas, QEvent(QEvent.Type.Leave))
        self.wait(lambda: self.session.answer is None, "the plan without the pin")

    def _mouse(
        self, kind: QEvent.Type, place: QPoint, button: Qt.MouseButton, held: Qt.MouseButton
    ) -> None:
        port = self.window.map.canvas.viewport()
        local = QPointF(place)
        spot = QPointF(port.mapToGlobal(local))
        plain = Qt.KeyboardModifier.NoModifier
        QApplication.sendEvent(port, QMouseEvent(kind, local, spot, button, held, plain))


def picture(widget: QWidget) -> QImage:
    """What a widget shows, with what lies over it, and with the 3D view as OpenGL has drawn it.

    `QWidget.grab` loses the words in an OpenGL view, so that the view's own picture is drawn
    over it, and what lies over the view once more over that.
    """
    window = widget.window()
    image = window.grab().toImage()
    painter = QPainter(image)
    for scene in window.findChildren(SceneView):
        canvas = scene.canvas
        if canvas is None or not canvas.isValid() or not scene.isVisibleTo(window):
            continue
        painter.drawImage(canvas.mapTo(window, QPoint()), canvas.grabFramebuffer())
        above = [one for one in scene.children() if one is not canvas]
        above += [one for one in window.children() if one.objectName() in OVERLAYS]
        for one in above:
            if isinstance(one, QWidget) and one.isVisibleTo(window):
                place = one.mapTo(window, QPoint())
                # Without the ground that Qt would draw below rounded corners.
                one.render(painter, place, QRegion(), QWidget.RenderFlag.DrawChildren)
    painter.end()
    if widget is window:
        return image
    scale = image.devicePixelRatio()
    corner = widget.mapTo(window, QPoint()) * scale
    size = widget.size() * scale
    return image.copy(QRect(corner, size))
