"""The slider over the waypoints, in one column with the map and the curves above it."""

from __future__ import annotations

from PySide6.QtCore import QRect, Qt
from PySide6.QtGui import QMouseEvent, QResizeEvent
from PySide6.QtWidgets import QSlider, QStyle, QStyleOptionSlider, QWidget

from posopt_gui.views.curve_plots import GAUGE, LEFT_AXIS

STEPS = 20
"""Positions of the slider between two waypoints."""


class ClickSlider(QSlider):
    """A slider whose handle comes to where it is clicked, and can be dragged on from there."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(Qt.Orientation.Horizontal, parent)
        self.setSingleStep(STEPS)
        self.setPageStep(5 * STEPS)

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 - Qt's name
        """Go to the place that is clicked, unless the handle is there."""
        if event.button() is Qt.MouseButton.LeftButton:
            option = self.option()
            handle = self._part(option, QStyle.SubControl.SC_SliderHandle)
            if not handle.contains(event.position().toPoint()):
                self.setSliderPosition(self.value_at(event.position().x()))
        super().mousePressEvent(event)

    def option(self) -> QStyleOptionSlider:
        """How the slider is drawn now."""
        option = QStyleOptionSlider()
        self.initStyleOption(option)
        return option

    def value_at(self, x: float) -> int:
        """The value whose handle stands in the middle of a place [px]."""
        left, span = self.way()
        return QStyle.sliderValueFromPosition(
            self.minimum(), self.maximum(), round(x - left), max(round(span), 1)
        )

    def way(self) -> tuple[float, float]:
        """Where the handle's middle is at the least value, and how far it goes [px]."""
        option = self.option()
        groove = self._part(option, QStyle.SubControl.SC_SliderGroove)
        handle = self._part(option, QStyle.SubControl.SC_SliderHandle)
        return groove.x() + handle.width() / 2.0, groove.width() - handle.width()

    def _part(self, option: QStyleOptionSlider, part: QStyle.SubControl) -> QRect:
        return self.style().subControlRect(QStyle.ComplexControl.CC_Slider, option, part, self)


class SliderRow(QWidget):
    """Puts a slider below the plots, so that each waypoint stands in its column.

    The plots show half a waypoint more at both ends. Where they are zoomed, the slider still
    reaches over the whole path.
    """

    def __init__(self, slider: ClickSlider, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._slider, self._count = slider, 0
        slider.setParent(self)
        self.setFixedHeight(slider.sizeHint().height() + 2)

    def set_count(self, count: int) -> None:
        """Range over this many waypoints."""
        self._count = count
        self._slider.setRange(0, max(count - 1, 0) * STEPS)
        self._fit()

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        """Follow the plots."""
        super().resizeEvent(event)
        self._fit()

    def _fit(self) -> None:
        first, last = self._place_of(1), self._place_of(max(self._count, 2))
        self._slider.setGeometry(0, 1, self.width(), self.height() - 2)
        start, way = self._slider.way()
        beside = self.width() - start - way
        left = round(first - start)
        self._slider.setGeometry(left, 1, round(last + beside) - left, self.height() - 2)

    def _place_of(self, number: int) -> float:
        """Where the plots have a waypoint (from 1) [px]."""
        plot = self.width() - LEFT_AXIS - GAUGE
        return LEFT_AXIS + (number - 0.5) * plot / max(self._count, 2)
