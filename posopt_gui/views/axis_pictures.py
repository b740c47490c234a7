"""Numbers and ticks of plots, drawn before the plots are painted."""

from __future__ import annotations

from collections.abc import Iterator

import pyqtgraph as pg
from PySide6.QtGui import QImage, QPainter
from PySide6.QtWidgets import QWidget


def plots_on_screen(window: QWidget) -> Iterator[pg.GraphicsView]:
    """The plots in a window that can be seen."""
    return (plot for plot in window.findChildren(pg.GraphicsView) if plot.isVisible())


def draw_axes(plot: pg.GraphicsView) -> None:
    """Let the axes of a plot make their pictures now; painting then only shows them.

    An axis makes its picture when it is painted first after a change, and needs no more to know
    for it. Where all plots have changed, that takes as long as all the rest of the painting.
    """
    plot.scene().prepareForPaint()
    nowhere = QImage(1, 1, QImage.Format.Format_ARGB32)
    painter = QPainter(nowhere)
    for item in plot.scene().items():
        if isinstance(item, pg.AxisItem) and item.isVisible() and item.picture is None:
            item.paint(painter, None, None)
    painter.end()
