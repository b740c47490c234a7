"""What is drawn on the map: cells, letters, areas, and the names of lines."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pyqtgraph as pg
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QBrush, QColor, QFont, QImage, QPainter, QPen, QTransform

from posopt_gui.viewmodels.map_colours import (
    CLASS_LETTERS,
    ByteArray,
    CellClass,
    Colour,
)
from posopt_gui.views.plot_painting import view_key

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
    """The cells as one image; only what is visible is drawn.

    Where there are more waypoints than pixels, `columns` makes an image of the worst of so many
    neighbouring waypoints: by itself a painter would leave most of them out.
    """

    def __init__(self) -> None:
        super().__init__()
        self._image: QImage | None = None
        self._columns: Callable[[int], QImage] | None = None
        self._narrow: tuple[int, QImage | None] = (1, None)
        self._rect = QRectF()
        self._grid = QColor()

    def set_cells(
        self,
        image: QImage | None,
        rect: QRectF,
        grid: QColor,
        columns: Callable[[int], QImage] | None = None,
    ) -> None:
        """Show an image over a rectangle of the plot; `grid` parts large cells."""
        if rect != self._rect:
            self.prepareGeometryChange()
        self._columns, self._narrow = columns, (1, None)
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
        image, each = self._drawn_image(self._image)
        wide = each * self._rect.width() / self._image.width()
        high = self._rect.height() / self._image.height()
        seen = view.viewRect().intersected(self._rect)
        left = math.floor((seen.left() - self._rect.left()) / wide)
        low = math.floor((seen.top() - self._rect.top()) / high)
        # The last of several waypoints in a column may stand for fewer than the others.
        last = self._rect.width() / wide
        right = min(float(math.ceil((seen.right() - self._rect.left()) / wide)), last)
        top = min(math.ceil((seen.bottom() - self._rect.top()) / high), image.height())
        if right <= left or top <= low:
            return
        source = QRectF(left, low, right - left, top - low)
        target = QRectF(
            self._rect.left() + left * wide, self._rect.top() + low * high,
            source.width() * wide, source.height() * high,
        )  # fmt: skip
        painter.drawImage(target, image, source)
        self._draw_grid(painter, target, wide, high)

    def _drawn_image(self, image: QImage) -> tuple[QImage, int]:
        """The image that is drawn, and how many waypoints each of its columns stands for."""
        pixel = self.pixelVectors()[0]
        across = self._rect.width() / image.width()
        across = across / pixel.length() if pixel is not None else 1.0
        each = math.ceil(1.0 / across - 1e-9)
        if each <= 1 or self._columns is None:
            return image, 1
        if each != self._narrow[0]:
            self._narrow = each, self._columns(each)
        return self._narrow[1] or image, each

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
        self._key: object = None
        self._letters: list[tuple[CellClass, QRectF]] = []

    def set_cells(
        self, kind: ByteArray | None, rect: QRectF, colours: dict[CellClass, QColor]
    ) -> None:
        """Mark the classes (n, m) that have a letter."""
        if rect != self._rect:
            self.prepareGeometryChange()
        self._kind, self._rect, self._colours = kind, rect, colours
        self._key = None
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
        transform = painter.transform()
        key = view_key(transform, view.viewRect())
        if key != self._key:
            # Most paintings are of the same letters: under the mouse only the card moves.
            size = pixel[0].length(), pixel[1].length()
            seen = view.viewRect().intersected(self._rect)
            self._key, self._letters = key, self._placed(self._kind, seen, transform, size)
        painter.resetTransform()
        font = QFont(painter.font())
        font.setPixelSize(11)
        font.setBold(True)
        painter.setFont(font)
        for own, box in self._letters:
            painter.setPen(self._colours[own])
            painter.drawText(box, Qt.AlignmentFlag.AlignCenter, CLASS_LETTERS[own])
        painter.setTransform(transform)

    def _placed(
        self, kind: ByteArray, seen: QRectF, transform: QTransform, pixel: tuple[float, float]
    ) -> list[tuple[CellClass, QRectF]]:
        """The letters that are seen, and where they stand on the screen; a pixel is that large."""
        wide, high = self._rect.width() / kind.shape[0], self._rect.height() / kind.shape[1]
        size = wide / pixel[0], high / pixel[1]
        step = [_power_of_two(LETTER_STEP[axis] / size[axis]) for axis in (0, 1)]
        room = [math.ceil(LETTER_ROOM[axis] / size[axis] - 0.5) for axis in (0, 1)]
        first = int((seen.left() - self._rect.left()) / wide) // step[0] * step[0]
        last = int((seen.right() - self._rect.left()) / wide) + 1
        bottom = int((seen.top() - self._rect.top()) / high)
        top = int((seen.bottom() - self._rect.top()) / high) + 1
        places: list[tuple[CellClass, int, int]] = []
        for row in range(bottom // step[1] * step[1], top, step[1]):
            shift = step[0] // 2 if row // step[1] % 2 else 0
            for column in range(first + shift, last, step[0]):
                own = _letter_at(kind, column, row, room)
                if own is not None:
                    places.append((own, column, row))
        marked = {own for own, _, _ in places}
        across = range(first, min(last, kind.shape[0]), max(step[0] // 2, 1))
        for own in _classes(kind[across.start : across.stop : across.step, bottom:top]) - marked:
            # An area that lies between the rows has letters along its own middle.
            held = kind[across.start : across.stop : across.step, bottom:top] == own
            row = bottom + _roomiest(held, room[1])
            places += [
                (own, column, row)
                for column in across
                if _letter_at(kind, column, row, room) is own
            ]
        return [(own, self._box(transform, column, row)) for own, column, row in places]

    def _box(self, transform: QTransform, column: int, row: int) -> QRectF:
        """The place of a cell's letter on the screen."""
        assert self._kind is not None
        wide = self._rect.width() / self._kind.shape[0]
        high = self._rect.height() / self._kind.shape[1]
        left, low = self._rect.left(), self._rect.top()
        place = transform.map(QPointF(left + (column + 0.5) * wide, low + (row + 0.5) * high))
        return QRectF(place.x() - 10.0, place.y() - 10.0, 20.0, 20.0)


def _letter_at(kind: ByteArray, column: int, row: int, room: list[int]) -> CellClass | None:
    """The class of a cell, if it has a letter and enough of its own around it."""
    if not room[0] <= column < kind.shape[0] - room[0]:
        return None
    if not room[1] <= row < kind.shape[1] - room[1]:
        return None
    own = CellClass(int(kind[column, row]))
    if not CLASS_LETTERS[own]:
        return None
    near = kind[column - room[0] : column + room[0] + 1, row - room[1] : row + room[1] + 1]
    return own if bool((near == own).all()) else None


def _classes(kind: ByteArray) -> set[CellClass]:
    """The classes with a letter that occur."""
    found = (CellClass(int(one)) for one in np.flatnonzero(np.bincount(kind.ravel())))
    return {one for one in found if CLASS_LETTERS[one]}


def _roomiest(held: NDArray[np.bool_], room: int) -> int:
    """The row in which most columns (n, m) hold a class, and `room` rows below and above too."""
    free = held.copy()
    for away in range(1, room + 1):
        free[:, away:] &= held[:, :-away]
        free[:, :-away] &= held[:, away:]
        free[:, :away] = free[:, -away:] = False
    return int(free.sum(axis=0).argmax())


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
