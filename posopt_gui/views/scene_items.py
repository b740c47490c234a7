"""Drawn items of the 3D panel: solids, flat shadows, see-through bodies, lines and labels."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyqtgraph.opengl as gl
from numpy.typing import NDArray
from OpenGL import GL
from pyqtgraph.opengl.items.GLMeshItem import DirtyFlag
from pyqtgraph.opengl.shaders import FragmentShader, ShaderProgram, VertexShader
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QMatrix4x4, QPainter, QVector3D

from posopt_gui.viewmodels.surface_mesh import ShadedMesh
from solver.transforms import FloatArray

Rgba = tuple[float, float, float, float]
"""Red, green, blue and opacity, 0 to 1."""

AXIS_COLOURS: tuple[Rgba, ...] = (
    (0.84, 0.25, 0.20, 1.0),
    (0.20, 0.62, 0.28, 1.0),
    (0.20, 0.42, 0.86, 1.0),
)
"""Of x, y and z."""

GOOD_PATCH: Rgba = (0.0, 0.85, 0.62, 0.75)
BAD_PATCH: Rgba = (0.90, 0.10, 0.08, 0.85)
EDGE_COLOUR: Rgba = (0.0, 0.0, 0.0, 0.45)

SHADOW_DEPTH, LINE_DEPTH, GHOST_DEPTH, MARK_DEPTH, LABEL_DEPTH = -1, 5, 10, 15, 20
"""Order of drawing: what is see-through after what is solid, labels last."""

SOLID = {
    GL.GL_DEPTH_TEST: True,
    GL.GL_BLEND: False,
    GL.GL_CULL_FACE: True,
    GL.GL_POLYGON_OFFSET_FILL: True,
    # Solids stand back a little, so that lines on them are not broken.
    "glPolygonOffset": (2.0, 2.0),
}
FLAT = {**SOLID, GL.GL_CULL_FACE: False, "glPolygonOffset": (3.0, 3.0)}
SEE_THROUGH = {
    # Before a solid with the same face, so that they do not flicker, and behind their edges.
    GL.GL_POLYGON_OFFSET_FILL: True,
    "glPolygonOffset": (1.0, 1.0),
    GL.GL_DEPTH_TEST: True,
    GL.GL_BLEND: True,
    GL.GL_CULL_FACE: True,
    "glBlendFuncSeparate": (
        GL.GL_SRC_ALPHA,
        GL.GL_ONE_MINUS_SRC_ALPHA,
        GL.GL_ONE,
        GL.GL_ONE_MINUS_SRC_ALPHA,
    ),
}
PATCH = {**SEE_THROUGH, GL.GL_CULL_FACE: False, "glPolygonOffset": (-2.0, -2.0)}
ON_TOP = {**SEE_THROUGH, GL.GL_DEPTH_TEST: False, GL.GL_CULL_FACE: False}

LIFT = 3e-4
"""How far a patch is drawn off its surface [m]."""

_VERTEX = """
    uniform mat4 u_mvp;
    uniform mat3 u_normal;
    attribute vec4 a_position;
    attribute vec3 a_normal;
    attribute vec4 a_color;
    varying vec4 v_color;
    varying vec3 v_normal;
    void main() {
        v_normal = u_normal * a_normal;
        v_color = a_color;
        gl_Position = u_mvp * a_position;
    }
"""
_FRAGMENT = """
    #ifdef GL_ES
    precision mediump float;
    #endif
    varying vec4 v_color;
    varying vec3 v_normal;
    void main() {
        vec3 n = normalize(v_normal);
        float key = max(dot(n, normalize(vec3(-0.45, 0.75, 0.60))), 0.0);
        float fill = max(dot(n, normalize(vec3(0.80, 0.10, 0.45))), 0.0);
        float shine = pow(max(dot(n, normalize(vec3(-0.25, 0.42, 0.90))), 0.0), 40.0);
        float light = 0.56 + 0.42 * key + 0.22 * fill;
        gl_FragColor = vec4(v_color.rgb * light + 0.10 * shine, v_color.a);
    }
"""


def solid_shader() -> ShaderProgram:
    """Light from the upper left of the camera, a weaker one from the right, and some shine."""
    return ShaderProgram("posopt solid", [VertexShader(_VERTEX), FragmentShader(_FRAGMENT)])


def rgba(colour: str, opacity: float = 1.0) -> Rgba:
    """A colour '#RRGGBB' as numbers."""
    plain = QColor(colour)
    return plain.redF(), plain.greenF(), plain.blueF(), opacity


def transform(pose: FloatArray) -> QMatrix4x4:
    """A (4, 4) pose as Qt takes it."""
    return QMatrix4x4(*pose.ravel().tolist())


def flattened(floor: float) -> FloatArray:
    """(4, 4) projection onto the floor, for light from above and a little from the side."""
    matrix = np.eye(4)
    matrix[0, 2], matrix[1, 2] = -0.18, -0.12
    matrix[:2, 3] = -matrix[:2, 2] * floor
    matrix[2] = (0.0, 0.0, 0.0, floor)
    return matrix


class MeshItem(gl.GLMeshItem):
    """A shaded mesh; `colour` replaces the mesh's own, without a shader it is drawn flat."""

    def __init__(
        self,
        mesh: ShadedMesh,
        *,
        shader: ShaderProgram | None,
        options: dict[Any, Any],
        colour: Rgba | None = None,
    ) -> None:
        super().__init__(shader=shader, glOptions=options)
        self._mesh = mesh
        self._own_colours = colour is None
        if colour is not None:
            self.setColor(colour)

    def parseMeshData(self) -> DirtyFlag:  # noqa: N802 - pyqtgraph's name
        """Hand over the arrays as they are: normals and colours are ready."""
        if self.vertexes is not None:  # type: ignore[has-type]
            return DirtyFlag(0)
        self.vertexes, self.normals = self._mesh.corners, self._mesh.normals
        self.colors = np.ascontiguousarray(self._mesh.colours) if self._own_colours else None
        dirty = DirtyFlag.POSITION | DirtyFlag.NORMAL
        return dirty | DirtyFlag.COLOR if self._own_colours else dirty


class GhostItem(MeshItem):
    """A see-through mesh of which only the nearest surface is seen."""

    def paint(self) -> None:
        """Fill the depths first, then colour what is nearest."""
        GL.glColorMask(False, False, False, False)
        super().paint()
        GL.glColorMask(True, True, True, True)
        GL.glDepthFunc(GL.GL_LEQUAL)
        super().paint()
        GL.glDepthFunc(GL.GL_LESS)


class LineItem(gl.GLLinePlotItem):
    """Lines that may be empty: pairs of ends, or one strip."""

    def __init__(
        self,
        points: NDArray[Any] | None = None,
        colour: Rgba | NDArray[np.float32] = (0.0, 0.0, 0.0, 1.0),
        *,
        width: float = 1.0,
        strip: bool = False,
        options: dict[Any, Any] | None = None,
        depth: int = LINE_DEPTH,
    ) -> None:
        points = np.zeros((0, 3)) if points is None else points
        mode = "line_strip" if strip else "lines"
        super().__init__(
            pos=points,
            color=colour,
            width=width,
            antialias=False,
            mode=mode,
            glOptions=SEE_THROUGH if options is None else options,
        )
        self.setDepthValue(depth)

    def paint(self) -> None:
        """Draw; empty buffers cannot be bound."""
        if self.pos is not None and len(self.pos):
            super().paint()


class PointItem(gl.GLScatterPlotItem):
    """Points that may be none; `size` in pixels."""

    def __init__(self, colour: Rgba, size: float, depth: int = LINE_DEPTH) -> None:
        super().__init__(
            pos=np.zeros((0, 3)), color=colour, size=size, pxMode=True, glOptions=SEE_THROUGH
        )
        self.setDepthValue(depth)

    def paint(self) -> None:
        """Draw; empty buffers cannot be bound."""
        if self.pos is not None and len(self.pos):
            super().paint()


class LabelItem(gl.GLTextItem):
    """A text on a rounded plate beside a point."""

    def __init__(self, font: QFont) -> None:
        super().__init__(font=font, glOptions=ON_TOP)
        self.plate = QColor("white")
        self.border = QColor("black")
        self.shift = QPointF(14.0, -14.0)
        self.setDepthValue(LABEL_DEPTH)

    def paint(self) -> None:
        """Nothing: a label is painted over the finished picture."""

    def draw(self, painter: QPainter) -> None:
        """Draw the plate and the text over everything else."""
        if not self.text:
            return
        place = self.compute_projection().map(QVector3D(*(float(x) for x in self.pos)))
        metrics = QFontMetricsF(self.font)
        width, height = metrics.horizontalAdvance(self.text), metrics.height()
        corner = place.toPointF() + self.shift - QPointF(0.0, height)
        box = QRectF(corner.x(), corner.y(), width + 12.0, height + 4.0)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(self.border)
        painter.setBrush(self.plate)
        painter.drawRoundedRect(box, 4.0, 4.0)
        painter.setPen(self.color)
        painter.setFont(self.font)
        painter.drawText(box, Qt.AlignmentFlag.AlignCenter, self.text)


def unit_disc() -> ShadedMesh:
    """A flat disc of radius 1 about z."""
    angle = np.linspace(0.0, 2.0 * np.pi, 33)
    rim = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(33)])
    corners = np.stack([np.zeros_like(rim[1:]), rim[:-1], rim[1:]], axis=1).reshape(-1, 3)
    return ShadedMesh(
        corners.astype(np.float32),
        np.tile(np.array([0.0, 0.0, 1.0], np.float32), (len(corners), 1)),
        np.full((len(corners), 4), 255, np.uint8),
        np.zeros((0, 3), np.float32),
    )


def disc_pose(point: FloatArray, normal: FloatArray, radius: float) -> FloatArray:
    """(4, 4) place of the unit disc on a surface, lifted a little off it."""
    across = np.cross(normal, (1.0, 0.0, 0.0) if abs(normal[0]) < 0.8 else (0.0, 1.0, 0.0))
    across /= np.linalg.norm(across)
    pose = np.eye(4)
    pose[:3, 0], pose[:3, 1] = radius * across, radius * np.cross(normal, across)
    pose[:3, 2], pose[:3, 3] = normal, point + LIFT * normal
    return pose
