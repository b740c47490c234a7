"""The plot of the map with everything that lies on its cells."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QColor, QImage, QPen
from PySide6.QtWidgets import QWidget

from posopt_gui.viewmodels.map_colours import CellClass, Layer, Scale
from posopt_gui.viewmodels.map_columns import worst_of_columns
from posopt_gui.viewmodels.map_lines import (
    BEFORE,
    CHOSEN,
    CONSTANT,
    Band,
    MapLine,
    end_words,
    places_apart,
    runs,
)
from posopt_gui.viewmodels.map_model import Cells, MapModel
from posopt_gui.views.curve_plots import GAUGE, LEFT_AXIS
from posopt_gui.views.map_interaction import Cell, MapPlot
from posopt_gui.views.map_items import (
    Area,
    AreasItem,
    CellsItem,
    LettersItem,
    image_of,
    qcolour,
)
from posopt_gui.views.map_line_items import (
    NO_BREAKS,
    LineName,
    LineNamesItem,
    LinesItem,
    Stroke,
)
from posopt_gui.views.map_palette import MapPalette
from solver.model.settings import Scheme
from solver.model.wishes import Pin, Region
from solver.transforms import FloatArray
from solver.units import DEG_PER_RAD

BOTTOM_AXIS = 38
"""Height of the numbers and the words below the cells [px]."""

DIMMED = 0.35
"""Opacity of a result whose inputs have changed."""

LINE_SHIFT = 4.0
"""How far a line is drawn below one of the same leans [px]."""

EDGE_ROOM = 0.03
"""Share of the height above and below the cells: a line at the last lean lies on their edge."""

LEAST_WAYPOINTS = 4.0
"""Fewest waypoints that can be zoomed in to."""

_DASHES = {
    Scheme.F.value: Qt.PenStyle.DashLine,
    Scheme.F1.value: Qt.PenStyle.DotLine,
    Scheme.F2.value: Qt.PenStyle.DashDotLine,
    CONSTANT: Qt.PenStyle.DashDotDotLine,
}


class MapCanvas(MapPlot):
    """Cells, lines, pins, regions and bands; it is told what to show and asks nobody."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._model: MapModel | None = None
        self._outlined: Cell | None = None
        self._cells = CellsItem()
        self._letters = LettersItem()
        self._regions, self._bands, self._outline = AreasItem(), AreasItem(), AreasItem()
        self._rubber, self._kept = AreasItem(), AreasItem()
        self._edges = pg.PlotCurveItem(connect="pairs", antialias=False)
        self._passes: list[pg.InfiniteLine] = []
        self._names = LineNamesItem()
        self._cursor = pg.InfiniteLine(angle=90, movable=False)
        self._pins = pg.ScatterPlotItem(symbol="d", size=14, pxMode=True)
        self._handle = pg.ScatterPlotItem(symbol="o", size=10, pxMode=True)
        self._lines = LinesItem()
        layers = (
            self._cells, self._letters, self._edges, self._regions, self._bands, self._cursor,
            self._lines, self._names, self._rubber, self._kept, self._outline, self._pins,
            self._handle,
        )  # fmt: skip
        for number, item in enumerate(layers):
            item.setZValue(10.0 * number)
            self.addItem(item, ignoreBounds=True)
        plot = self.getPlotItem()
        plot.getAxis("left").setWidth(LEFT_AXIS)
        plot.setContentsMargins(0.0, 0.0, float(GAUGE), 0.0)
        plot.getAxis("bottom").setHeight(BOTTOM_AXIS)
        for name in ("left", "bottom"):
            plot.getAxis(name).enableAutoSIPrefix(False)

    def retheme(self, colours: MapPalette) -> None:
        """Colours of the ground and the axes."""
        theme = colours.theme
        self.setBackground(theme.plot)
        for name in ("left", "bottom"):
            axis = self.getPlotItem().getAxis(name)
            axis.setPen(theme.border)
            axis.setTextPen(theme.muted)
        self._cursor.setPen(pg.mkPen(theme.accent, width=1.5))

    def set_model(self, model: MapModel | None) -> None:
        """Take the grid of other candidates; the view stays where the grid stays."""
        before = self._model
        self._model = model
        if model is None:
            self.set_cells(0, np.empty(0))
            return
        self.set_cells(model.waypoints, model.leans)
        frame = self.room()
        self.getViewBox().setLimits(
            xMin=frame.left(), xMax=frame.right(), yMin=frame.top(), yMax=frame.bottom(),
            minXRange=min(LEAST_WAYPOINTS, frame.width()),
            minYRange=min(4.0 * model.lean_step, frame.height()),
            maxXRange=frame.width(), maxYRange=frame.height(),
        )  # fmt: skip
        if (
            before is None
            or before.waypoints != model.waypoints
            or not np.array_equal(before.leans, model.leans)
        ):
            self.fit()

    @property
    def model(self) -> MapModel | None:
        """The grid that is shown."""
        return self._model

    @property
    def outlined(self) -> Cell | None:
        """The cell that is outlined."""
        return self._outlined

    def frame(self) -> QRectF:
        """The rectangle of all cells."""
        if self._model is None:
            return QRectF(0.5, -0.5, 1.0, 1.0)
        step = self._model.lean_step
        low = float(self._model.leans[0]) - step / 2.0
        return QRectF(0.5, low, float(self._model.waypoints), step * self._model.rows)

    def room(self) -> QRectF:
        """All cells with some room above and below them, that is shown at most."""
        frame = self.frame()
        edge = max(EDGE_ROOM * frame.height(), frame.height() / max(len(self._leans), 1) / 2.0)
        return frame.adjusted(0.0, -edge, 0.0, edge) if self._model is not None else frame

    def fit(self) -> None:
        """Show all cells."""
        self.getViewBox().setRange(self.room(), padding=0.0)

    def show_cells(self, cells: Cells | None, scale: Scale | None, colours: MapPalette) -> None:
        """Show a page."""
        ground = qcolour(colours.theme.plot, 60)
        if cells is None:
            self._cells.set_cells(None, QRectF(), ground)
            self._letters.set_cells(None, QRectF(), {})
            return
        indices, table = cells.indices(scale), colours.table(cells.layer)
        outcome = cells.layer is Layer.OUTCOME

        def columns(each: int) -> QImage:
            return image_of(worst_of_columns(indices, each, outcome=outcome), table)

        self._cells.set_cells(image_of(indices, table), self.frame(), ground, columns)
        letters = {
            kind: qcolour(letter_colour(colour, 150)) for kind, colour in colours.classes.items()
        }
        kind = cells.kind if cells.layer is Layer.OUTCOME else None
        self._letters.set_cells(kind, self.frame(), letters)

    def dim(self, dimmed: bool) -> None:
        """Show cells and lines as what is no longer true."""
        for item in (self._cells, self._letters, self._names, self._lines):
            item.setOpacity(DIMMED if dimmed else 1.0)

    def show_lines(
        self,
        lines: Sequence[MapLine],
        pages: Sequence[np.ndarray],
        colours: MapPalette,
        tr: Callable[[str], str] = str,
    ) -> None:
        """Show lines, the chosen one first; `pages` (n,) tell where each is on this page."""
        strokes, names = [], []
        model = self._model
        branches = model.candidates.branches if model is not None else np.empty(0, np.int64)
        called, apart = end_words(lines, branches, tr), places_apart(lines)
        for number, (line, shown) in enumerate(zip(lines, pages, strict=True)):
            pen = line_pen(line.key, number == 0, colours)
            breaks = model.branch_breaks(line.candidate[:, 2]) if model is not None else NO_BREAKS
            shift = LINE_SHIFT * apart[number]
            strokes.append(Stroke(line.waypoint, line.lean, shown, pen, shift, breaks))
            names.append(LineName(called[number], line.waypoint, line.lean, pen))
        # The chosen line lies over the others, and so is drawn last.
        casing, warning = qcolour(colours.theme.plot, 190), QColor(colours.theme.warning)
        self._lines.set_strokes(strokes[::-1], casing, warning)
        ground = qcolour(colours.theme.surface, 225)
        self._names.set_names(names, ground, QColor(colours.theme.text))
        self.set_line(lines[0].lean if lines else np.empty(0))

    def show_passes(self, starts: Iterable[int], colours: MapPalette) -> None:
        """Part the passes; `starts` are the first waypoints (from 0) of all but the first."""
        for line in self._passes:
            self.removeItem(line)
        pen = pg.mkPen(colours.theme.muted, width=1.5)
        self._passes = [
            pg.InfiniteLine(pos=start + 0.5, angle=90, movable=False, pen=pen) for start in starts
        ]
        for line in self._passes:
            line.setZValue(25.0)
            self.addItem(line, ignoreBounds=True)

    def show_edges(self, x: FloatArray, y: FloatArray, colours: MapPalette) -> None:
        """Show edges as pairs of points."""
        self._edges.setPen(pg.mkPen(qcolour(colours.theme.text, 150), width=1))
        self._edges.setData(x, y)

    def show_pins(self, pins: Sequence[Pin], shown: Sequence[bool], colours: MapPalette) -> None:
        """Show pins as diamonds; those that belong to another page are hollow."""
        theme = colours.theme
        pen = pg.mkPen(theme.plot, width=1.5)
        hollow = pg.mkPen(theme.accent, width=2.0)
        self._pins.setData(
            [
                {
                    "pos": (pin.waypoint + 1.0, pin.lean * DEG_PER_RAD),
                    "brush": pg.mkBrush(theme.accent if here else theme.plot),
                    "pen": pen if here else hollow,
                }
                for pin, here in zip(pins, shown, strict=True)
            ]
        )

    def show_handle(self, cell: Cell | None, colours: MapPalette, *, held: bool = False) -> None:
        """Show where the line can be, or is, taken hold of."""
        if cell is None or self._model is None:
            self._handle.setData([])
            return
        theme = colours.theme
        self._handle.setData(
            [(cell.waypoint + 1.0)], [float(self._model.leans[cell.row])],
            symbol="d" if held else "o", size=16 if held else 10,
            brush=pg.mkBrush(theme.accent if held else theme.plot),
            pen=pg.mkPen(theme.plot if held else theme.line, width=2.0),
        )  # fmt: skip

    def show_regions(
        self, regions: Sequence[Region], shown: Sequence[bool], colours: MapPalette
    ) -> None:
        """Show forbidden regions, hatched; those of another branch faintly."""
        theme = colours.theme
        self._regions.set_areas(
            [
                Area(
                    self._region_rect(region),
                    qcolour(theme.plot, 120 if here else 40),
                    qcolour(theme.error, 230 if here else 70),
                    qcolour(theme.error, 255 if here else 90),
                    width=1.5,
                )
                for region, here in zip(regions, shown, strict=True)
            ]
        )

    def _region_rect(self, region: Region) -> QRectF:
        half = self._model.lean_step / 2.0 if self._model is not None else 0.5
        low, high = region.low * DEG_PER_RAD - half, region.high * DEG_PER_RAD + half
        return QRectF(region.first + 0.5, low, region.last - region.first + 1.0, high - low)

    def show_rubber(self, first: Cell | None, other: Cell | None, colours: MapPalette) -> None:
        """Show the rectangle that is being drawn between two cells."""
        if first is None or other is None or self._model is None:
            self._rubber.set_areas(())
            return
        a, b = self.cell_rect(first), self.cell_rect(other)
        error = colours.theme.error
        self._rubber.set_areas(
            [Area(a.united(b), qcolour(error, 30), qcolour(error, 160), qcolour(error), width=1.5)]
        )

    def show_bands(self, bands: Sequence[Band], colours: MapPalette) -> None:
        """Show the layers, and gaps between layers, that break the sequence."""
        frame, error = self.frame(), colours.theme.error
        areas = []
        for first, last, gap in runs(bands):
            left, wide = (first + 1.1, 0.8) if gap else (first + 0.5, last - first + 1.0)
            rect = QRectF(left, frame.top(), wide, frame.height())
            areas.append(Area(rect, qcolour(error, 120), None, qcolour(error)))
        self._bands.set_areas(areas)

    def show_cursor(self, place: float) -> None:
        """Show the place of the playback, in waypoints from 0."""
        self._cursor.setValue(place + 1.0)

    def show_outline(self, cell: Cell | None, colours: MapPalette) -> None:
        """Show which cell is pointed at."""
        self._outlined = cell
        if cell is None or self._model is None:
            self._outline.set_areas(())
            return
        theme = colours.theme
        area = Area(
            self.cell_rect(cell), outline=QColor(theme.text), casing=QColor(theme.plot), width=2.0
        )
        self._outline.set_areas([area])

    def show_kept(self, cell: Cell | None, colours: MapPalette) -> None:
        """Show which cell was chosen to be looked at."""
        if cell is None or self._model is None:
            self._kept.set_areas(())
            return
        theme = colours.theme
        fill, line = qcolour(theme.accent, 150), QColor(theme.accent)
        area = Area(self.cell_rect(cell), fill, None, line, QColor(theme.plot), width=3.0)
        self._kept.set_areas([area])

    def cell_rect(self, cell: Cell) -> QRectF:
        """The rectangle of a cell in the plot."""
        frame = self.frame()
        high = frame.height() / max(len(self._leans), 1)
        return QRectF(cell.waypoint + 0.5, frame.top() + cell.row * high, 1.0, high)


def line_pen(key: str, chosen: bool, colours: MapPalette) -> QPen:
    """The pen of a line: the chosen one full, every other with its own pattern."""
    theme = colours.theme
    colour = QColor(theme.line)
    if chosen:
        pen = QPen(colour, 2.0)
    elif key == BEFORE:
        pen = QPen(QColor(theme.muted), 1.5)
    else:
        pen = QPen(colour, 1.5, _DASHES.get(key, Qt.PenStyle.SolidLine))
    pen.setCosmetic(True)
    if key in {CHOSEN}:
        pen.setColor(QColor(theme.line))
    return pen


def letter_colour(colour: tuple[int, int, int, int], opacity: int) -> tuple[int, int, int, int]:
    """Black or white, whichever stands out from a colour."""
    bright = 0.299 * colour[0] + 0.587 * colour[1] + 0.114 * colour[2]
    tone = 0 if bright > 110.0 else 255
    return tone, tone, tone, opacity


def class_colour(kind: CellClass, colours: MapPalette) -> QColor:
    """Colour of a class for marks in texts."""
    return qcolour(colours.classes[kind])
