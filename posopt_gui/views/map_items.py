"""What is drawn on the map: cells, letters, areas, and the names of lines."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QBrush, QColor, QFont, QImage, QPainter, QPen

from posopt_gui.viewmodels.map_colours import (
    CLASS_LETTERS,
    ByteArray,
    CellClass,
    Colour,
)

TILE_SIZE = 6.0
"""Least width and height of a cell at which the cells are drawn apart [px]."""

LETTER_STEP = (78.0, 44.0)
"""About how far the letters stand from each other [px]."""

LETTER_ROOM = (7.0, 7.0)
"""Half the size of what a letter needs within its area [px]."""


def qcolour(colour: Colour | str, opacity: int | None = None) -> QColor:
    """A colour of Qt."""
    made = QColor(colour) if isinstance(colour, str) else QColor(*colour)
    if opacity is not None:
        made.setAlpha(opacity)
    return made


def image_of(indices: ByteArray, table: ByteArray) -> QImage:
    """An image of cells (n, m): waypoints across, leans up from the first row."""
    pixels = np.ascontiguousarray(table[indices.T])
    height, width = pixels.shape[:2]
    image = QImage(pixels.data, width, height, 4 * width, QImage.Format.Format_RGBA8888)
    return image.convertToFormat(QImage.Format.Format_RGB32)


class CellsItem(pg.GraphicsObject):
    """The cells as one image; only what is visible is drawn."""

    def __init__(self) -> None:
        super().__init__()
        self._image: QImage | None = None
        self._rect = QRectF()
        self._grid = QColor()

    def set_cells(self, image: QImage | None, rect: QRectF, grid: QColor) -> None:
        """Show an image over a rectangle of the plot; `grid` parts large cells."""
        if rect != self._rect:
            self.prepareGeometryChange()
        self._image, self._rect, self._grid = image, rect, grid
        self.update()

    def boundingRect(self) -> QRectF:  # noqa: N802 - Qt's name
        """The whole rectangle."""
        return self._rect

    def paint(self, painter: QPainter, *_: Any) -> None:
        """Draw the visible part."""
        view = self.getViewBox()
        if self._image is None or view is None or self._rect.isEmpty():
            return
        wide = self._rect.width() / self._image.width()
        high = self._rect.height() / self._image.height()
        seen = view.viewRect().intersected(self._rect)
        left = math.floor((seen.left() - self._rect.left()) / wide)
        low = math.floor((seen.top() - self._rect.top()) / high)
        right = min(math.ceil((seen.right() - self._rect.left()) / wide), self._image.width())
        top = min(math.ceil((seen.bottom() - self._rect.top()) / high), self._image.height())
        if right <= left or top <= low:
            return
        source = QRectF(left, low, right - left, top - low)
        target = QRectF(
            self._rect.left() + left * wide, self._rect.top() + low * high,
            source.width() * wide, source.height() * high,
        )  # fmt: skip
        painter.drawImage(target, self._image, source)
        self._draw_grid(painter, target, wide, high)

    def _draw_grid(self, painter: QPainter, target: QRectF, wide: float, high: float) -> None:
        pixel = self.pixelVectors()
        if pixel[0] is None or pixel[1] is None:
            return
        across, up = wide / pixel[0].length(), high / pixel[1].length()
        pen = QPen(self._grid)
        pen.setCosmetic(True)
        painter.setPen(pen)
        if min(across, up) < TILE_SIZE:
            return
        for x in np.arange(target.left(), target.right() + wide / 2.0, wide):
            painter.drawLine(QPointF(x, target.top()), QPointF(x, target.bottom()))
        for y in np.arange(target.top(), target.bottom() + high / 2.0, high):
            painter.drawLine(QPointF(target.left(), y), QPointF(target.right(), y))


class LettersItem(pg.GraphicsObject):
    """A pattern of letters over the areas of the outcomes, at an even distance on the screen."""

    def __init__(self) -> None:
        super().__init__()
        self._kind: ByteArray | None = None
        self._rect = QRectF()
        self._colours: dict[CellClass, QColor] = {}

    def set_cells(
        self, kind: ByteArray | None, rect: QRectF, colours: dict[CellClass, QColor]
    ) -> None:
        """Mark the classes (n, m) that have a letter."""
        if rect != self._rect:
            self.prepareGeometryChange()
        self._kind, self._rect, self._colours = kind, rect, colours
        self.update()

    def boundingRect(self) -> QRectF:  # noqa: N802 - Qt's name
        """The whole rectangle."""
        return self._rect

    def paint(self, painter: QPainter, *_: Any) -> None:
        """Draw the letters of the visible areas that have room for them."""
        view = self.getViewBox()
        pixel = self.pixelVectors()
        if self._kind is None or view is None or pixel[0] is None or pixel[1] is None:
            return
        kind = self._kind
        wide, high = self._rect.width() / kind.shape[0], self._rect.height() / kind.shape[1]
        size = wide / pixel[0].length(), high / pixel[1].length()
        seen = view.viewRect().intersected(self._rect)
        transform = painter.transform()
        painter.resetTransform()
        font = QFont(painter.font())
        font.setPixelSize(11)
        font.setBold(True)
        painter.setFont(font)
        step = [_power_of_two(LETTER_STEP[axis] / size[axis]) for axis in (0, 1)]
        room = [math.ceil(LETTER_ROOM[axis] / size[axis] - 0.5) for axis in (0, 1)]
        first = int((seen.left() - self._rect.left()) / wide) // step[0] * step[0]
        lowest = int((seen.top() - self._rect.top()) / high) // step[1] * step[1]
        for row in range(lowest, int((seen.bottom() - self._rect.top()) / high) + 1, step[1]):
            shift = step[0] // 2 if row // step[1] % 2 else 0
            last = int((seen.right() - self._rect.left()) / wide) + 1
            for column in range(first + shift, last, step[0]):
                self._draw(painter, transform, column, row, room, (wide, high))
        painter.setTransform(transform)

    def _draw(
        self,
        painter: QPainter,
        transform: Any,
        column: int,
        row: int,
        room: list[int],
        cell: tuple[float, float],
    ) -> None:
        kind = self._kind
        if kind is None or column >= kind.shape[0] or row >= kind.shape[1]:
            return
        if column < room[0] or row < room[1]:
            return
        near = kind[column - room[0] : column + room[0] + 1, row - room[1] : row + room[1] + 1]
        if near.shape != (2 * room[0] + 1, 2 * room[1] + 1):
            return
        own = CellClass(int(kind[column, row]))
        letter = CLASS_LETTERS[own]
        if not letter or not (near == own).all():
            return
        place = transform.map(
            QPointF(
                self._rect.left() + (column + 0.5) * cell[0],
                self._rect.top() + (row + 0.5) * cell[1],
            )
        )
        painter.setPen(self._colours[own])
        box = QRectF(place.x() - 10.0, place.y() - 10.0, 20.0, 20.0)
        painter.drawText(box, Qt.AlignmentFlag.AlignCenter, letter)


def _power_of_two(cells: float) -> int:
    return int(2 ** max(0, round(math.log2(max(cells, 1.0)))))


@dataclass(frozen=True, slots=True, eq=False)
class Area:
    """A rectangle of the plot with a fill, a pattern and an outline."""

    rect: QRectF
    fill: QColor | None = None
    pattern: QColor | None = None
    outline: QColor | None = None
    casing: QColor | None = None
    width: float = 1.0


class AreasItem(pg.GraphicsObject):
    """Rectangles that are at least two pixels wide at any zoom."""

    def __init__(self, bounds: QRectF | None = None) -> None:
        super().__init__()
        self._areas: tuple[Area, ...] = ()
        self._bounds = bounds or QRectF()

    def set_areas(self, areas: Sequence[Area]) -> None:
        """Show other areas."""
        self.prepareGeometryChange()
        self._areas = tuple(areas)
        self._bounds = QRectF()
        for area in areas:
            self._bounds = self._bounds.united(area.rect)
        self.update()

    def boundingRect(self) -> QRectF:  # noqa: N802 - Qt's name
        """All areas, with room for the outline."""
        if self._bounds.isEmpty():
            return self._bounds
        pixel = self.pixelVectors()
        x = 4.0 * pixel[0].length() if pixel[0] is not None else 0.0
        y = 4.0 * pixel[1].length() if pixel[1] is not None else 0.0
        return self._bounds.adjusted(-x, -y, x, y)

    def paint(self, painter: QPainter, *_: Any) -> None:
        """Draw every area in pixels of the screen."""
        transform = painter.transform()
        painter.resetTransform()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
        for area in self._areas:
            rect = transform.mapRect(area.rect)
            if rect.width() < 2.0:
                rect = QRectF(rect.center().x() - 1.0, rect.top(), 2.0, rect.height())
            if area.fill is not None:
                painter.fillRect(rect, area.fill)
            if area.pattern is not None:
                painter.fillRect(rect, QBrush(area.pattern, Qt.BrushStyle.BDiagPattern))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            if area.casing is not None:
                painter.setPen(QPen(area.casing, area.width + 2.0))
                painter.drawRect(rect)
            if area.outline is not None:
                painter.setPen(QPen(area.outline, area.width))
                painter.drawRect(rect)
        painter.setTransform(transform)

    def viewTransformChanged(self) -> None:  # noqa: N802 - pyqtgraph's name
        """The room for outlines depends on the zoom."""
        self.prepareGeometryChange()
