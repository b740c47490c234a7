"""The mouse on the map: hovering, clicking, dragging the line, forbidding a rectangle."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt, Signal
from PySide6.QtGui import QMouseEvent
from PySide6.QtWidgets import QGraphicsSceneResizeEvent, QGraphicsSceneWheelEvent, QWidget

from posopt_gui.views.plot_painting import follow_at_once
from solver.transforms import FloatArray

GRAB_DISTANCE = 9.0
"""How near to the line the mouse takes hold of it [px]."""

CLICK_DISTANCE = 4
"""How far the mouse may move during a click [px]."""


class Drag(Enum):
    """What a pressed button does."""

    NONE = 0
    PAN = 1
    LINE = 2
    AREA = 3


@dataclass(frozen=True, slots=True)
class Cell:
    """A cell: waypoint from 0 and row of the leans."""

    waypoint: int
    row: int


class LeanAxis(pg.AxisItem):
    """An axis whose numbers have a true minus."""

    def tickStrings(  # noqa: N802 - pyqtgraph's name
        self, values: list[float], scale: float, spacing: float
    ) -> list[str]:
        """Numbers as they are said everywhere else."""
        return [one.replace("-", "−") for one in super().tickStrings(values, scale, spacing)]


class WaypointAxis(pg.AxisItem):
    """An axis of whole numbers."""

    def tickSpacing(  # noqa: N802 - pyqtgraph's name
        self, *ends_and_size: float
    ) -> list[tuple[float, float]]:
        """No ticks between waypoints."""
        spacing = super().tickSpacing(*ends_and_size)
        return [(step, offset) for step, offset in spacing if step >= 1.0] or [(1.0, 0.0)]

    def resizeEvent(  # noqa: N802 - Qt's name
        self, event: QGraphicsSceneResizeEvent | None = None
    ) -> None:
        """Keep the title inside: pyqtgraph lets it stand out, and cuts high characters off."""
        super().resizeEvent(event)
        title = self.label
        lowest = self.size().height() - title.boundingRect().height() + 2.0
        title.setY(min(title.y(), lowest))


class MapBox(pg.ViewBox):
    """A view whose wheel zooms waypoints; with Ctrl both axes, with Shift the leans."""

    def wheelEvent(  # noqa: N802 - Qt's name
        self, event: QGraphicsSceneWheelEvent, axis: int | None = None
    ) -> None:
        """Zoom; over an axis that axis alone."""
        keys = event.modifiers()
        if axis is None and keys & Qt.KeyboardModifier.ShiftModifier:
            axis = 1
        elif axis is None and not keys & Qt.KeyboardModifier.ControlModifier:
            axis = 0
        super().wheelEvent(event, axis)


class MapPlot(pg.PlotWidget):
    """A plot of cells that says what the mouse means on it."""

    pointed = Signal(object, QPoint)
    """The cell under the mouse, None outside; and where the mouse is."""

    clicked = Signal(object)
    double_clicked = Signal(object)
    line_near = Signal(object)
    """The waypoint whose place of the line the mouse could take hold of, None for none."""

    line_dragged = Signal(object, QPoint)
    line_dropped = Signal(object)
    area_drawn = Signal(object, object, bool)
    """Two opposite cells, and whether the button was let go."""

    menu_wanted = Signal(object, QPoint)

    def __init__(self, parent: QWidget | None = None) -> None:
        axes = {"bottom": WaypointAxis(orientation="bottom"), "left": LeanAxis(orientation="left")}
        super().__init__(parent, viewBox=MapBox(enableMenu=False), axisItems=axes, enableMenu=False)
        self.hideButtons()
        follow_at_once(self.getViewBox())
        self.viewport().setMouseTracking(True)
        self.forbidding = False
        self.draggable = True
        self._leans: FloatArray = np.empty(0)
        self._line: FloatArray = np.empty(0)
        self._waypoints = 0
        self._drag = Drag.NONE
        self._pressed = QPoint()
        self._moved = False
        self._start: Cell | None = None
        self._button = Qt.MouseButton.NoButton

    @property
    def dragging(self) -> bool:
        """Whether the line or a rectangle is being dragged."""
        return self._drag in {Drag.LINE, Drag.AREA} and self._moved

    @property
    def line(self) -> FloatArray:
        """Lean of the line that can be dragged, by waypoint [deg]."""
        return self._line

    def set_cells(self, waypoints: int, leans: FloatArray) -> None:
        """The grid of cells: number of waypoints and leans [deg]."""
        self._waypoints, self._leans = waypoints, leans

    def set_line(self, lean: FloatArray) -> None:
        """The line that can be dragged: lean [deg] by waypoint, empty for none."""
        self._line = lean

    def leave(self) -> bool:
        """Give up what is being dragged; False where nothing is."""
        was = self._drag in {Drag.LINE, Drag.AREA}
        if was:
            self._drag, self._start = Drag.NONE, None
        return was

    def cell_at(self, place: QPoint) -> Cell | None:
        """The cell under a place of the widget."""
        if not len(self._leans):
            return None
        view = self.getViewBox()
        scene = self.mapToScene(place)
        if not view.sceneBoundingRect().contains(scene):
            return None
        point = view.mapSceneToView(scene)
        waypoint = round(point.x()) - 1
        half = 0.5 * abs(self._leans[-1] - self._leans[0]) / max(len(self._leans) - 1, 1)
        low, high = self._leans[0] - half, self._leans[-1] + half
        if not (0 <= waypoint < self._waypoints and low <= point.y() <= high):
            return None
        return Cell(waypoint, self._row(point.y()))

    def place_of(self, cell: Cell) -> QPoint:
        """Where the middle of a cell is on the widget."""
        view = self.getViewBox()
        point = QPointF(cell.waypoint + 1.0, float(self._leans[cell.row]))
        place: QPoint = self.mapFromScene(view.mapViewToScene(point))
        return place

    def line_at(self, place: QPoint) -> int | None:
        """The waypoint at which the line can be taken hold of from a place."""
        cell = self.cell_at(place)
        if cell is None or cell.waypoint >= len(self._line) or not self.draggable:
            return None
        view = self.getViewBox()
        point = view.mapSceneToView(self.mapToScene(place))
        pixel = view.viewPixelSize()
        lean = np.interp(point.x() - 1.0, np.arange(len(self._line)), self._line)
        return cell.waypoint if abs(point.y() - lean) <= GRAB_DISTANCE * pixel[1] else None

    def _row(self, lean: float) -> int:
        return int(np.abs(self._leans - lean).argmin())

    def _clamped(self, place: QPoint) -> Cell:
        point = self.getViewBox().mapSceneToView(self.mapToScene(place))
        waypoint = min(max(round(point.x()) - 1, 0), self._waypoints - 1)
        return Cell(waypoint, self._row(point.y()))

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 - Qt's name
        """Take hold of the line or a corner of a rectangle; else the plot is panned."""
        place = event.position().toPoint()
        if self._drag is not Drag.NONE:
            return
        self._pressed, self._moved, self._button = place, False, event.button()
        cell = self.cell_at(place)
        left = event.button() == Qt.MouseButton.LeftButton
        right = event.button() == Qt.MouseButton.RightButton
        grabbed = self.line_at(place) if left and not self.forbidding else None
        if right or (left and self.forbidding):
            self._drag, self._start = (Drag.AREA, cell) if cell is not None else (Drag.NONE, None)
            event.accept()
        elif grabbed is not None:
            self._drag, self._start = Drag.LINE, Cell(grabbed, self._row(self._line[grabbed]))
            event.accept()
        else:
            self._drag = Drag.PAN
            super().mousePressEvent(event)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802 - Qt's name
        """Drag what is held, or point."""
        place = event.position().toPoint()
        far = (place - self._pressed).manhattanLength() >= CLICK_DISTANCE
        if self._drag is not Drag.NONE and far:
            self._moved = True
        if self._drag is Drag.LINE and self._start is not None:
            if self._moved:
                cell = Cell(self._start.waypoint, self._clamped(place).row)
                self.line_dragged.emit(cell, place)
        elif self._drag is Drag.AREA and self._start is not None:
            if self._moved:
                self.area_drawn.emit(self._start, self._clamped(place), False)
        else:
            super().mouseMoveEvent(event)
            panning = self._drag is Drag.PAN and self._moved
            self.pointed.emit(None if panning else self.cell_at(place), place)
            self._show_grab(place)

    def _show_grab(self, place: QPoint) -> None:
        if self._drag is not Drag.NONE:
            return
        grabbed = self.line_at(place) if not self.forbidding else None
        shape = Qt.CursorShape.ArrowCursor
        if self.forbidding:
            shape = Qt.CursorShape.CrossCursor
        elif grabbed is not None:
            shape = Qt.CursorShape.SizeVerCursor
        if self.viewport().cursor().shape() != shape:
            self.viewport().setCursor(shape)
        self.line_near.emit(grabbed)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:  # noqa: N802 - Qt's name
        """Let go."""
        place = event.position().toPoint()
        drag, start, self._drag = self._drag, self._start, Drag.NONE
        if drag in {Drag.NONE, Drag.PAN}:
            super().mouseReleaseEvent(event)
        if drag is Drag.NONE or event.button() != self._button:
            return
        cell = self.cell_at(place)
        if not self._moved:
            if event.button() == Qt.MouseButton.RightButton:
                self.menu_wanted.emit(cell, event.globalPosition().toPoint())
            elif event.button() == Qt.MouseButton.LeftButton and cell is not None:
                self.clicked.emit(cell)
        elif drag is Drag.LINE and start is not None:
            self.line_dropped.emit(Cell(start.waypoint, self._clamped(place).row))
        elif drag is Drag.AREA and start is not None:
            self.area_drawn.emit(start, self._clamped(place), True)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:  # noqa: N802 - Qt's name
        """Pin."""
        cell = self.cell_at(event.position().toPoint())
        if event.button() == Qt.MouseButton.LeftButton and cell is not None:
            self.double_clicked.emit(cell)
        event.accept()

    def leaveEvent(self, event: QEvent) -> None:  # noqa: N802 - Qt's name
        """Nothing is under the mouse any more."""
        super().leaveEvent(event)
        if self._drag is Drag.NONE:
            self.pointed.emit(None, QPoint())
            self.line_near.emit(None)
