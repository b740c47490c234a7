"""A dimensioned drawing of an H section, as lines and texts on a sheet of paper.

The sheet's x runs right and its y down, both in pixels; the section is drawn upright, its height
along the sheet's y. Proportions are true.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from solver.model.workpiece import BeamSection
from solver.transforms import FloatArray
from solver.units import MM_PER_M

ARC_POINTS: Final = 9
"""Points of a quarter arc, its ends included."""

MARGIN: Final = (58.0, 30.0, 62.0, 14.0)
"""Free space left, above, right and below the section for its dimensions [px]."""

GAP: Final = 4.0
"""Between the section and where an extension line begins [px]."""

OUTSIDE: Final = 24.0
"""Length of an arrow that points at a narrow dimension from outside [px]."""

Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Dimension:
    """One dimension: arrows from `start` to `end`, its extension lines and its text.

    Attributes
    ----------
    start, end : points
        Ends of the dimension line.
    extensions : tuple of pairs of points
        Lines from the section to the ends.
    text, value : str
        Symbol and number [mm].
    anchor : point
        Middle of the text's edge that faces the line.
    side : str
        Where the text lies from its anchor: 'left', 'right' or 'above'.
    inward : bool
        Whether the arrows stand outside and point inward.
    arrows : int
        Arrows of the line: 2, or 1 at its start for a leader.
    """

    start: Point
    end: Point
    extensions: tuple[tuple[Point, Point], ...]
    text: str
    value: str
    anchor: Point
    side: str
    inward: bool = False
    arrows: int = 2


@dataclass(frozen=True, slots=True, eq=False)
class Drawing:
    """A section on a sheet: (n, 2) outline [px], centre lines and dimensions."""

    outline: FloatArray
    centre_lines: tuple[tuple[Point, Point], ...]
    dimensions: tuple[Dimension, ...]
    scale: float


def section_outline(section: BeamSection) -> FloatArray:
    """(n, 2) outline of a section: y across the flanges, z along the height [mm], not closed."""
    width, height, web, flange, root = (
        value * MM_PER_M
        for value in (section.width, section.height, section.web, section.flange, section.root)
    )
    inner = height / 2.0 - flange
    quarter = [(web / 2.0, 0.0)]
    if root > 0.0:
        for angle in np.linspace(0.0, math.pi / 2.0, ARC_POINTS):
            across = web / 2.0 + root * (1.0 - math.cos(angle))
            quarter.append((across, inner - root * (1.0 - math.sin(angle))))
    else:
        quarter.append((web / 2.0, inner))
    quarter += [(width / 2.0, inner), (width / 2.0, height / 2.0)]
    first = np.array(quarter)
    half = np.vstack([first, first[::-1] * (-1.0, 1.0)])
    return np.vstack([half, half[::-1] * (1.0, -1.0)])


def beam_drawing(section: BeamSection, width: float, height: float) -> Drawing:
    """Draw a section as large as a sheet of width x height [px] takes it with its dimensions."""
    left, above, right, below = MARGIN
    room = (max(width - left - right, 10.0), max(height - above - below, 10.0))
    size = (section.width * MM_PER_M, section.height * MM_PER_M)
    scale = min(room[0] / size[0], room[1] / size[1])
    centre = np.array([left + room[0] / 2.0, above + room[1] / 2.0])
    outline = centre + section_outline(section) * (scale, -scale)
    half = np.array(size) / 2.0 * scale
    sheet = _Sheet(section, scale, (float(centre[0]), float(centre[1])), half)
    over = 6.0
    lines = (
        ((sheet.x - half[0] - over, sheet.y), (sheet.x + half[0] + over, sheet.y)),
        ((sheet.x, sheet.y - half[1] - over), (sheet.x, sheet.y + half[1] + over)),
    )
    return Drawing(outline, lines, sheet.dimensions(), scale)


class _Sheet:
    """Places the dimensions of one section."""

    def __init__(self, section: BeamSection, scale: float, centre: Point, half: FloatArray) -> None:
        self.x, self.y = centre
        self._left, self._right = self.x - float(half[0]), self.x + float(half[0])
        self._top, self._bottom = self.y - float(half[1]), self.y + float(half[1])
        self._section, self._scale = section, scale * MM_PER_M

    def dimensions(self) -> tuple[Dimension, ...]:
        found = [self._height(), self._width(), self._web(), self._flange()]
        return (*found, self._root()) if self._section.root > 0.0 else tuple(found)

    def _height(self) -> Dimension:
        x = self._left - 16.0
        extensions = tuple(((self._left - GAP, y), (x - GAP, y)) for y in (self._top, self._bottom))
        return Dimension((x, self._top), (x, self._bottom), extensions, "H",
                         _mm(self._section.height), (x - GAP, self.y), "left")  # fmt: skip

    def _width(self) -> Dimension:
        y = self._top - 12.0
        extensions = tuple(((x, self._top - GAP), (x, y - GAP)) for x in (self._left, self._right))
        return Dimension((self._left, y), (self._right, y), extensions, "B",
                         _mm(self._section.width), (self.x, y - 2.0), "above")  # fmt: skip

    def _web(self) -> Dimension:
        half = self._section.web * self._scale / 2.0
        y = self.y + 0.42 * (self._bottom - self.y)
        # The text stands left of the web, inside the section.
        return Dimension((self.x - half, y), (self.x + half, y), (), "tw",
                         _mm(self._section.web), (self.x - half - OUTSIDE, y), "left",
                         inward=True)  # fmt: skip

    def _flange(self) -> Dimension:
        x = self._right + 14.0
        inner = self._bottom - self._section.flange * self._scale
        extensions = tuple(((self._right + GAP, y), (x + GAP, y)) for y in (inner, self._bottom))
        return Dimension((x, inner), (x, self._bottom), extensions, "tf",
                         _mm(self._section.flange), (x + 8.0, (inner + self._bottom) / 2.0),
                         "right", inward=True)  # fmt: skip

    def _root(self) -> Dimension:
        root = self._section.root * self._scale
        inner = self._top + self._section.flange * self._scale
        cosine = math.cos(math.pi / 4.0)
        x = self.x + self._section.web * self._scale / 2.0 + root * (1.0 - cosine)
        y = inner + root * (1.0 - cosine)
        end = (x + 30.0, y + 30.0)
        return Dimension((x, y), end, (), "r", _mm(self._section.root), (end[0] + GAP, end[1]),
                         "right", arrows=1)  # fmt: skip


def _mm(length: float) -> str:
    return f"{length * MM_PER_M:.10g}"
