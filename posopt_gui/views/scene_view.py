"""The 3D panel: the cell at the place that is looked at, with its tools and notes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, Qt, QTimer
from PySide6.QtGui import QHideEvent, QImage, QPainter, QResizeEvent, QShowEvent
from PySide6.QtWidgets import QFileDialog, QLabel, QStackedLayout, QWidget

from posopt_gui.controllers.session import Message, Session
from posopt_gui.viewmodels.error_words import error_words
from posopt_gui.viewmodels.scene_jobs import build_cell, build_probe
from posopt_gui.views.camera import CLOSE_UP, FIELD_OF_VIEW, PRESETS, Camera, close_up_of, fitted
from posopt_gui.views.opengl import is_available
from posopt_gui.views.picture_file import save_picture
from posopt_gui.views.refresh import Refresh
from posopt_gui.views.scene_ghost import SceneGhost
from posopt_gui.views.scene_looked import Looked
from posopt_gui.views.scene_tools import SceneTools
from posopt_gui.workers.jobs import JobLine
from posopt_gui.workers.threads import JobThreads
from solver.errors import PosoptError
from solver.transforms import FloatArray

if TYPE_CHECKING:
    from posopt_gui.viewmodels.scene_model import CellModel
    from posopt_gui.viewmodels.scene_probe import PoseProbe, PoseReport
    from posopt_gui.views.scene_canvas import SceneCanvas
    from solver.analysis.result import Sequence

NO_OPENGL = (
    "The cell cannot be shown in 3D, because OpenGL is not available here; everything else works."
)
LOADING = "The cell is being drawn."


class SceneView(QWidget):
    """Shows the session's cell, plan, place and hovered candidate in 3D.

    Without OpenGL it shows a sentence instead, and everything else goes on.
    """

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.session = session
        self._tr = session.look.tr
        self._canvas: SceneCanvas | None = None
        self._cell: CellModel | None = None
        self._probe: PoseProbe | None = None
        self._looked = Looked(session)
        self._failure = ""
        self._fitted = self._fitted_to_plan = False
        self._fitted_camera: Camera | None = None
        self._refit = Refresh(session, self.fit, self)
        self._pool = JobThreads(1, self)
        self._cells = JobLine(self._pool, self)
        self._cells.done.connect(self._cell_built)
        self._cells.failed.connect(self._build_failed)
        self._probes = JobLine(session.follow_ups, self, self._probe_built, self._probe_failed)
        self._sentence = QLabel(self)
        self._sentence.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._sentence.setWordWrap(True)
        self._sentence.setMargin(24)
        self._layout = QStackedLayout(self)
        self._layout.addWidget(self._sentence)
        self._tools = SceneTools(self)
        self._note = QLabel(self)
        self._note.setObjectName("sceneNote")
        self._note.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setMinimumSize(320, 220)
        self._connect()
        self._prepare()
        self.retheme()
        self.retranslate()

    def _prepare(self) -> None:
        """Say at once where there is no OpenGL."""
        if not is_available():
            self._fail("no context")

    def _connect(self) -> None:
        session, tools = self.session, self._tools
        session.problem_changed.connect(self._on_problem)
        results = Refresh(session, self._on_result, self)
        session.result_changed.connect(results.soon)
        session.stale_changed.connect(results.soon)
        session.place_changed.connect(self._on_place)
        session.kept_changed.connect(self._on_place)
        self._ghost = SceneGhost(session, self, self._looked)
        session.look.language_changed.connect(Refresh(session, self.retranslate, self).next_turn)
        session.look.theme_changed.connect(Refresh(session, self.retheme, self).next_turn)
        tools.preset_chosen.connect(self.look_from)
        tools.fit_asked.connect(self.fit)
        tools.picture_asked.connect(self._ask_picture)
        tools.shown_changed.connect(self._on_shown)

    # ---- what the window asks

    @property
    def canvas(self) -> SceneCanvas | None:
        """The drawing, None where there is no OpenGL or nothing was shown yet."""
        return self._canvas

    @property
    def tools(self) -> SceneTools:
        """The bar with the camera and what is shown; its actions can stand in a menu."""
        return self._tools

    @property
    def drawn(self) -> bool:
        """Whether the session's cell is on the canvas."""
        cell = self._cell
        return (
            self._canvas is not None and cell is not None and (cell.problem is self.session.problem)
        )

    @property
    def report(self) -> PoseReport | None:
        """Clearance and contact of the shown pose, where they are known."""
        return self._looked.report

    @property
    def ghost_report(self) -> PoseReport | None:
        """The same of the ghost."""
        return self._looked.ghost_report

    def retranslate(self) -> None:
        """Set all texts again."""
        self._tools.retranslate(self._tr)
        self.setAccessibleName(self._tr("3D view of the cell"))
        self._show_sentence()
        self._show_note()

    def retheme(self) -> None:
        """Set all colours again."""
        theme = self.session.look.theme
        self.setStyleSheet(
            f"SceneView {{ background: {theme.scene}; }}"
            f"SceneView > QLabel {{ color: {theme.muted}; background: {theme.scene}; }}"
            f"QLabel#sceneNote {{ color: {theme.text}; background: {theme.surface};"
            f" border: 1px solid {theme.border}; border-radius: 4px; padding: 3px 7px; }}"
        )
        self._tools.retheme(theme)
        if self._canvas is not None:
            self._canvas.retheme(theme)
            self._on_result()

    def grab_image(self) -> QImage:
        """What is seen, with its notes."""
        canvas = self._canvas
        self._ghost.catch_up()
        image = canvas.grabFramebuffer() if canvas is not None and canvas.isValid() else QImage()
        if image.isNull():
            return self.grab().toImage()
        if self._note.isVisible():
            painter = QPainter(image)
            painter.drawPixmap(QPointF(self._note.pos()), self._note.grab())
            painter.end()
        return image

    def save_picture(self, file: Path) -> bool:
        """Write what is seen to a picture file; says in the session how that went."""
        said = save_picture(self.grab_image(), file, self._tr)
        self.session.say(said)
        return said.severity != "error"

    def look_from(self, preset: str) -> None:
        """Move the camera to a preset."""
        canvas, cell = self._canvas, self._cell
        if canvas is None or cell is None:
            return
        if preset == CLOSE_UP:
            planned = self._sequence() is not None
            canvas.set_camera(close_up_of(cell, self._joints(cell), planned=planned))
            return
        azimuth, elevation = PRESETS[preset]
        self._fit(azimuth, elevation)

    def fit(self) -> None:
        """Show everything from where the camera looks."""
        if self._canvas is not None:
            camera = self._canvas.camera
            self._fit(camera.azimuth, camera.elevation)

    def _fit(self, azimuth: float, elevation: float) -> None:
        canvas, cell = self._canvas, self._cell
        if canvas is not None and cell is not None:
            corners = cell.points_at(self._joints(cell))
            above = min((self._tools.height() + 12) / max(canvas.height(), 1), 0.4)
            camera = fitted(corners, azimuth, elevation, canvas.aspect, FIELD_OF_VIEW, above)
            canvas.set_camera(camera)
            self._fitted_camera = canvas.camera

    # ---- the canvas

    def showEvent(self, event: QShowEvent) -> None:  # noqa: N802 - Qt's name
        """Begin to draw once the window is on screen."""
        super().showEvent(event)
        if self._canvas is None and not self._failure:
            QTimer.singleShot(0, self, self._make_canvas)
        elif self._canvas is not None and self._cell is None:
            self._on_problem()

    def hideEvent(self, event: QHideEvent) -> None:  # noqa: N802 - Qt's name
        """Forget the ghost."""
        super().hideEvent(event)
        if self._canvas is not None:
            self._canvas.show_ghost(None)

    def _make_canvas(self) -> None:
        if self._canvas is not None or self._failure:
            return
        try:
            from posopt_gui.views.scene_canvas import SceneCanvas  # noqa: PLC0415 - loads OpenGL
        except (ImportError, OSError) as error:
            self._fail(str(error))
            return

        canvas = SceneCanvas(self.session.look.theme, self)
        canvas.failed.connect(self._fail, Qt.ConnectionType.QueuedConnection)
        canvas.waypoint_clicked.connect(self.session.set_cursor)
        canvas.show_parts(self._tools.shown)
        self._canvas = canvas
        self._layout.addWidget(canvas)
        self._layout.setCurrentWidget(canvas)
        for overlay in (self._tools, self._note):
            overlay.raise_()
        QTimer.singleShot(0, self, self._check_canvas)
        self._on_problem()
        self._on_result()

    def _check_canvas(self) -> None:
        """A context that could not be made shows only once the canvas is on screen."""
        canvas = self._canvas
        if canvas is not None and canvas.isVisible() and not canvas.isValid():
            canvas.update()
            QTimer.singleShot(300, self, self._judge_canvas)

    def _judge_canvas(self) -> None:
        canvas = self._canvas
        if canvas is not None and canvas.isVisible() and not canvas.isValid():
            self._fail("no context")

    def _fail(self, why: str) -> None:
        self._failure = why or "unknown"
        canvas, self._canvas = self._canvas, None
        if canvas is not None:
            self._layout.removeWidget(canvas)
            canvas.hide()
            canvas.deleteLater()
        self._layout.setCurrentWidget(self._sentence)
        self._tools.setVisible(False)
        self._show_sentence()
        self._show_note()

    def _show_sentence(self) -> None:
        self._sentence.setText(self._tr(NO_OPENGL if self._failure else LOADING))

    # ---- the session

    def _on_problem(self) -> None:
        problem = self.session.problem
        if self._canvas is None:
            return
        if problem is None:
            self._cells.stop()
            self._show_note()
            return
        self._cells.submit(lambda _: build_cell(problem))

    def _cell_built(self, cell: CellModel) -> None:
        self._cell = cell
        if self._canvas is None:
            return
        self._canvas.show_cell(cell)
        if not self._fitted:
            self._fitted = True
            self._on_place()
            self.look_from("Overview")
        self._on_result()

    def _build_failed(self, error: object) -> None:
        if isinstance(error, PosoptError):
            self.session.say(Message("warning", error_words(error, self.session.look.tr)))
        else:
            words = "The cell cannot be drawn: {reason}"
            text = f"{type(error).__name__}: {error}"
            self.session.say(Message("warning", self._tr(words, reason=text)))

    def _on_result(self) -> None:
        canvas, cell = self._canvas, self._cell
        if canvas is None or cell is None:
            return
        result, sequence = self.session.result, self._sequence()
        if result is None or sequence is None:
            canvas.show_trail(None)
            self._probe = None
        else:
            from posopt_gui.viewmodels.scene_model import tcp_trail  # noqa: PLC0415

            trail = tcp_trail(result.problem, sequence.pendant)
            canvas.show_trail(trail, dimmed=self.session.stale)
            self._fit_to_plan(canvas)
            if self._probe is None or self._probe.problem is not result.problem:
                self._probe = None
                self._probes.submit(lambda _: build_probe(result))
        self._on_place()

    def _fit_to_plan(self, canvas: SceneCanvas) -> None:
        """The arm at work is lower than at home: come nearer, unless somebody has looked around."""
        if not self._fitted_to_plan and self._fitted:
            self._fitted_to_plan = True
            if self._fitted_camera is not None and canvas.camera.same_as(self._fitted_camera):
                QTimer.singleShot(0, self, self.fit)

    def _probe_built(self, probe: PoseProbe) -> None:
        result = self.session.result
        if result is not None and probe.problem is result.problem:
            self._probe = probe
            self._looked.measure_ghost(probe)
            self._on_place()

    def _probe_failed(self, error: object) -> None:
        self._build_failed(error)

    def _on_place(self) -> None:
        canvas, cell = self._canvas, self._cell
        if canvas is None or cell is None:
            return
        canvas.show_pose(self._joints(cell))
        points = cell.path.points
        cursor = self.session.cursor
        canvas.show_current(points[cursor] if cursor < len(points) else None)
        self._looked.measure(cell, self._probe)
        self.show_report()

    def measure_ghost(self) -> None:
        """Measure the ghost, and draw that instead of what was measured of the pose."""
        self._looked.measure_ghost(self._probe)
        self.show_report()

    def show_report(self) -> None:
        """Draw what was measured."""
        canvas, cell = self._canvas, self._cell
        if canvas is not None and cell is not None:
            required = cell.problem.settings.safety_distance
            canvas.show_report(self._looked.shown_report, required=required)
        self._show_note()

    def _on_shown(self) -> None:
        if self._canvas is not None:
            self._canvas.show_parts(self._tools.shown)
        self._show_note()

    def _sequence(self) -> Sequence | None:
        return self.session.sequence

    def _joints(self, cell: CellModel) -> FloatArray:
        """(6,) the solid pose."""
        return self._looked.joints(cell)

    # ---- notes

    def _show_note(self) -> None:
        lines = self._looked.notes(self._cell)
        self._note.setText("\n".join(lines))
        self._note.setVisible(bool(lines) and self._canvas is not None)
        self._note.adjustSize()
        self._lay_out()

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        """Keep the bar in its corner and the notes in theirs."""
        super().resizeEvent(event)
        fitted_before = self._fitted_camera
        self._lay_out()
        # What nobody has turned or moved since it was fitted stays fitted.
        if self._canvas is not None and fitted_before is not None:
            seen = self._canvas.camera
            if seen.same_as(fitted_before):
                self._refit.next_turn()

    def _lay_out(self) -> None:
        self._tools.fit_into(self.width() - 16)
        self._tools.move(self.width() - self._tools.width() - 8, 8)
        self._note.move(8, self.height() - self._note.height() - 8)

    def _ask_picture(self) -> None:
        title = self._tr("Save the picture")
        name, _ = QFileDialog.getSaveFileName(self, title, "cell.png", "PNG (*.png)")
        if name:
            file = Path(name)
            self.save_picture(file if file.suffix else file.with_suffix(".png"))
