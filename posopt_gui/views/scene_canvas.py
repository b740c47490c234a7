"""The picture of the 3D panel: a cell, a pose and what is said about it, drawn with OpenGL."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pyqtgraph as pg
import pyqtgraph.opengl as gl
from OpenGL import GL
from PySide6.QtCore import QPointF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QFont, QMouseEvent, QPainter, QWheelEvent
from PySide6.QtWidgets import QWidget

from posopt_gui.theme import Theme
from posopt_gui.viewmodels.scene_model import (
    TOOL_CARRIER,
    CellModel,
    axis_lines,
    grid_lines,
    named_frames,
)
from posopt_gui.viewmodels.scene_probe import ContactPatch, PoseReport, Touch
from posopt_gui.viewmodels.surface_mesh import ShadedMesh
from posopt_gui.views.camera import FIELD_OF_VIEW, Camera, picked
from posopt_gui.views.gl_picture import GlPicture
from posopt_gui.views.opengl import surface_format
from posopt_gui.views.scene_items import (
    AXIS_COLOURS,
    BAD_PATCH,
    EDGE_COLOUR,
    FLAT,
    GHOST_DEPTH,
    GOOD_PATCH,
    MARK_DEPTH,
    ON_TOP,
    PATCH,
    SEE_THROUGH,
    SHADOW_DEPTH,
    SOLID,
    GhostItem,
    LabelItem,
    LineItem,
    MeshItem,
    PointItem,
    Rgba,
    disc_pose,
    flattened,
    rgba,
    solid_shader,
    transform,
    unit_disc,
)
from posopt_gui.views.scene_tools import TRAILS
from solver.transforms import FloatArray

AXIS_LENGTH = 0.16
NAME_SHIFTS = ((6.0, -4.0), (6.0, -4.0), (-54.0, 4.0), (6.0, -4.0), (10.0, 34.0))
"""Where the names of fanuc_world, floor, beam, flange and TCP stand, so that two that are near
do not cover each other [pixels]."""

GRID_SPACING = 0.25
CLICK_SLACK = 4.0
"""How far the mouse may move between press and release of a click [pixels]."""


class SceneCanvas(GlPicture):
    """Draws what it is told; emits which waypoint was clicked."""

    waypoint_clicked = Signal(int)

    def __init__(self, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(surface_format(), parent)
        self.setMinimumSize(320, 220)
        self.opts["fov"] = FIELD_OF_VIEW
        self._theme = theme
        self._shader = solid_shader()
        self._cell: CellModel | None = None
        self._moving: dict[int, list[tuple[MeshItem | LineItem, bool]]] = {}
        self._cell_items: list[gl.GLGraphicsItem.GLGraphicsItem] = []
        self._bounding: dict[int, list[MeshItem | LineItem]] = {}
        self._ghost: dict[int, list[GhostItem]] = {}
        self._patches: list[MeshItem] = []
        self._joints: FloatArray | None = None
        self._shown: dict[str, bool] = {}
        self._press: QPointF | None = None
        self._make_overlays()
        self.retheme(theme)

    def sizeHint(self) -> QSize:  # noqa: N802 - Qt's name
        """A size to begin with: the base class has none."""
        return QSize(760, 460)

    def _make_overlays(self) -> None:
        """Items that live as long as the canvas."""
        accent = rgba(self._theme.accent)
        self._grid = LineItem(depth=0)
        self._path_line = LineItem(width=1.5, strip=True)
        self._normals = LineItem()
        self._path_points = PointItem(accent, 5.0)
        self._trail = LineItem(width=2.5, strip=True)
        self._current = PointItem(accent, 11.0, MARK_DEPTH)
        self._nearest = LineItem(width=2.5, options=ON_TOP, depth=MARK_DEPTH)
        self._nearest_ends = PointItem(accent, 8.0, MARK_DEPTH)
        self._nearest_ends.setGLOptions(ON_TOP)
        self._axes = LineItem(width=2.5, options=ON_TOP, depth=MARK_DEPTH)
        font = QFont(self.font())
        font.setPixelSize(15)
        font.setBold(True)
        self._distance = LabelItem(font)
        small = QFont(self.font())
        small.setPixelSize(12)
        self._names = [LabelItem(small) for _ in range(5)]
        for label, shift in zip(self._names, NAME_SHIFTS, strict=True):
            label.shift = QPointF(*shift)
        for item in (
            self._grid, self._path_line, self._normals, self._path_points, self._trail,
            self._current, self._nearest, self._nearest_ends, self._axes, self._distance,
            *self._names,
        ):  # fmt: skip
            self.addItem(item)

    def retheme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        self._theme = theme
        self.setBackgroundColor(pg.mkColor(theme.scene))
        self._path_line.setData(color=rgba(theme.line, 0.9))
        self._path_points.setData(color=rgba(theme.line))
        self._normals.setData(color=rgba(theme.line, 0.45))
        self._trail.setData(color=rgba(TRAILS[theme.dark]))
        self._current.setData(color=rgba(theme.accent))
        self._grid.setData(color=self._grid_colour())
        for label in (self._distance, *self._names):
            label.plate, label.border = QColor(theme.surface), QColor(theme.border)
            label.setData(color=QColor(theme.text))
        if self._cell is not None:
            self.show_cell(self._cell)

    def _grid_colour(self) -> Rgba:
        return rgba(self._theme.muted, 0.28)

    def _shadow_colour(self) -> Rgba:
        scene = QColor(self._theme.scene)
        return rgba((scene.darker(135) if self._theme.dark else scene.darker(116)).name())

    # ---- the cell

    def show_cell(self, cell: CellModel | None) -> None:
        """Draw another cell; the pose has to be set again."""
        for item in self._cell_items:
            self.removeItem(item)
        self._cell_items, self._moving, self._bounding = [], {}, {}
        self.show_ghost(None)
        self._ghost = {}
        self._cell = cell
        if cell is None:
            for line in (self._grid, self._path_line, self._normals, self._path_points):
                line.setData(pos=np.zeros((0, 3)))
            self.show_trail(None)
            self.show_report(None)
            return
        for link, mesh in cell.links.items():
            self._add_solid(link, mesh, edges=False)
        if cell.tool is not None:
            self._add_solid(TOOL_CARRIER, cell.tool, edges=True)
        self._add_solid(-1, cell.fixed, edges=True)
        self._place(-1, np.eye(4))
        self._grid.setData(pos=grid_lines(cell.bounds, cell.floor, GRID_SPACING))
        self._path_line.setData(pos=cell.path.points)
        self._path_points.setData(pos=cell.path.points)
        self._normals.setData(pos=cell.path.normals)
        self._make_bounding()
        if self._joints is not None:
            self.show_pose(self._joints)

    def _add_solid(self, carrier: int, mesh: ShadedMesh, *, edges: bool) -> None:
        """A solid, its shadow on the floor and, if asked, its edges."""
        solid = MeshItem(mesh, shader=self._shader, options=SOLID)
        shadow = MeshItem(mesh, shader=None, options=FLAT, colour=self._shadow_colour())
        shadow.setDepthValue(SHADOW_DEPTH)
        items: list[tuple[MeshItem | LineItem, bool]] = [(solid, False), (shadow, True)]
        if edges:
            items.append((LineItem(mesh.edges, EDGE_COLOUR, depth=1), False))
        self._moving.setdefault(carrier, []).extend(items)
        for item, _ in items:
            self.addItem(item)
            self._cell_items.append(item)

    def _place(self, carrier: int, pose: FloatArray) -> None:
        floor = self._cell.floor if self._cell is not None else 0.0
        plain, flat = transform(pose), transform(flattened(floor + 1e-3) @ pose)
        for item, shadow in self._moving.get(carrier, []):
            item.setTransform(flat if shadow else plain)

    def _make_bounding(self) -> None:
        if self._cell is None or not self._shown.get("bodies", False) or self._bounding:
            return
        for link, mesh in self._cell.bounding.items():
            body = MeshItem(mesh, shader=self._shader, options=SEE_THROUGH)
            body.setDepthValue(GHOST_DEPTH + 1)
            edges = LineItem(mesh.edges, rgba(self._theme.accent, 0.9), depth=GHOST_DEPTH + 2)
            self._bounding[link] = [body, edges]
            for item in (body, edges):
                self.addItem(item)
                self._cell_items.append(item)

    # ---- what moves

    def show_pose(self, joints: FloatArray) -> None:
        """Put robot and tool into a pose of pendant joints (6,) [rad]."""
        self._joints = joints
        if self._cell is None:
            return
        poses = self._cell.links_at(joints)
        for link in range(len(poses)):
            self._place(link, poses[link])
        if self._shown.get("bodies", False):
            for link, items in self._bounding.items():
                for item in items:
                    item.setTransform(transform(poses[link]))
        self._show_frames()

    def _show_frames(self) -> None:
        shown = self._shown.get("frames", False) and self._cell is not None
        self._axes.setVisible(shown)
        for label in self._names:
            label.setVisible(shown)
        if not shown or self._cell is None or self._joints is None:
            return
        frames = named_frames(self._cell.problem, self._joints)
        colours = np.repeat(np.array(AXIS_COLOURS, np.float32), 2, axis=0)
        self._axes.setData(
            pos=axis_lines([pose for _, pose in frames], AXIS_LENGTH),
            color=np.tile(colours, (len(frames), 1)),
        )
        for label, (name, pose) in zip(self._names, frames, strict=True):
            label.setData(pos=pose[:3, 3], text=name)

    def show_current(self, point: FloatArray | None) -> None:
        """Mark a waypoint (3,)."""
        self._current.setData(pos=np.zeros((0, 3)) if point is None else point[None])

    def show_trail(self, trail: FloatArray | None, *, dimmed: bool = False) -> None:
        """Draw the TCP's way (k, 3)."""
        colour = rgba(self._theme.muted, 0.6) if dimmed else rgba(TRAILS[self._theme.dark])
        self._trail.setData(pos=np.zeros((0, 3)) if trail is None else trail, color=colour)

    def show_ghost(self, joints: FloatArray | None, colour: Rgba = (0.5, 0.6, 0.8, 0.4)) -> None:
        """Draw a second, see-through robot in another pose, or none."""
        if joints is None or self._cell is None:
            for items in self._ghost.values():
                for item in items:
                    item.setVisible(False)
            return
        if not self._ghost:
            self._make_ghost(self._cell)
        poses = self._cell.links_at(joints)
        for link, items in self._ghost.items():
            for item in items:
                item.setColor(colour)
                item.setTransform(transform(poses[link]))
                item.setVisible(True)

    def _make_ghost(self, cell: CellModel) -> None:
        meshes = [*cell.links.items()]
        if cell.tool is not None:
            meshes.append((TOOL_CARRIER, cell.tool))
        for link, mesh in meshes:
            if link == 0:
                continue
            item = GhostItem(mesh, shader=self._shader, options=SEE_THROUGH, colour=(1, 1, 1, 1))
            item.setDepthValue(GHOST_DEPTH)
            self._ghost.setdefault(link, []).append(item)
            self.addItem(item)
            self._cell_items.append(item)

    def show_report(self, report: PoseReport | None, *, required: float = 0.0) -> None:
        """Draw the line between the nearest points with its length, and the contact patches."""
        nothing = np.zeros((0, 3))
        if report is None or report.points is None:
            self._nearest.setData(pos=nothing)
            self._nearest_ends.setData(pos=nothing)
            self._distance.setData(text="")
        else:
            colour = rgba(self._colour_of(report.clearance, required))
            self._nearest.setData(pos=report.points, color=colour)
            self._nearest_ends.setData(pos=report.points, color=colour)
            self._distance.border = QColor.fromRgbF(*colour)
            self._distance.setData(pos=report.points.mean(axis=0), text=report.millimetres)
        self._show_patches(report.patches if report is not None else ())

    def _colour_of(self, clearance: float, required: float) -> str:
        if clearance <= 0.0:
            return self._theme.error
        return self._theme.good if clearance >= required else self._theme.warning

    def _show_patches(self, patches: Sequence[ContactPatch]) -> None:
        while len(self._patches) < len(patches):
            item = MeshItem(unit_disc(), shader=None, options=SOLID, colour=GOOD_PATCH)
            item.setDepthValue(MARK_DEPTH)
            self._patches.append(item)
            self.addItem(item)
        for item in self._patches[len(patches) :]:
            item.setVisible(False)
        for item, patch in zip(self._patches, patches, strict=False):
            good = patch.touch is Touch.GROUND
            item.setColor(GOOD_PATCH if good else BAD_PATCH)
            item.setGLOptions(PATCH if good else ON_TOP)
            item.setTransform(transform(disc_pose(patch.point, patch.normal, patch.radius)))
            item.setVisible(True)

    def show_parts(self, shown: Mapping[str, bool]) -> None:
        """Switch parts on and off: path, trail, clearance, bodies, frames."""
        self._shown = dict(shown)
        for item in (self._path_line, self._normals, self._path_points):
            item.setVisible(shown.get("path", True))
        self._trail.setVisible(shown.get("trail", True))
        for part in (self._nearest, self._nearest_ends, self._distance):
            part.setVisible(shown.get("clearance", True))
        self._make_bounding()
        for items in self._bounding.values():
            for item in items:
                item.setVisible(shown.get("bodies", False))
        if self._joints is not None:
            self.show_pose(self._joints)

    # ---- camera and mouse

    @property
    def camera(self) -> Camera:
        """Where it is looked from."""
        centre = self.opts["center"]
        return Camera(
            np.array([centre.x(), centre.y(), centre.z()]),
            float(self.opts["distance"]),
            float(self.opts["azimuth"]),
            float(self.opts["elevation"]),
            float(self.opts["fov"]),
        )

    def set_camera(self, camera: Camera) -> None:
        """Look from somewhere else."""
        self.opts["fov"] = camera.field
        self.setCameraPosition(
            pos=pg.Vector(*camera.centre),
            distance=camera.distance,
            azimuth=camera.azimuth,
            elevation=camera.elevation,
        )

    @property
    def aspect(self) -> float:
        """Width over height of the picture."""
        return float(max(self.width(), 1) / max(self.height(), 1))

    def waypoint_at(self, place: QPointF) -> int | None:
        """The waypoint at a pixel."""
        if self._cell is None:
            return None
        origin, direction = self.camera.ray(place.x(), place.y(), self.width(), self.height())
        pixel = float(np.radians(self.opts["fov"])) / max(self.width(), 1)
        return picked(self._cell.path.points, origin, direction, pixel)

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 - Qt's name
        """Begin a drag or a click."""
        self._press = event.position()
        super().mousePressEvent(event)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:  # noqa: N802 - Qt's name
        """A click selects the nearest waypoint."""
        super().mouseReleaseEvent(event)
        press, self._press = self._press, None
        if press is None or event.button() is not Qt.MouseButton.LeftButton:
            return
        if (event.position() - press).manhattanLength() > CLICK_SLACK:
            return
        waypoint = self.waypoint_at(event.position())
        if waypoint is not None:
            self.waypoint_clicked.emit(waypoint)

    def wheelEvent(self, event: QWheelEvent) -> None:  # noqa: N802 - Qt's name
        """Come nearer or go away; the angle of view stays."""
        delta = event.angleDelta().y() or event.angleDelta().x()
        self.opts["distance"] = float(np.clip(self.opts["distance"] * 0.999**delta, 0.05, 40.0))
        self.update()
        event.accept()

    def paintGL(self) -> None:  # noqa: N802 - Qt's name
        """Draw; depths and colours must be writable for the screen to be cleared."""
        GL.glDepthMask(True)
        GL.glColorMask(True, True, True, True)
        super().paintGL()

    def draw_over(self, painter: QPainter) -> None:
        """Labels lie over everything else."""
        for label in (self._distance, *self._names):
            if label.visible():
                label.draw(painter)
