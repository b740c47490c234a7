"""The front as a picture: points to click on, the knee, the plan, and other sequences beside it."""

from __future__ import annotations

import pyqtgraph as pg
from PySide6.QtCore import QEvent, QPointF, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent
from PySide6.QtWidgets import QWidget

from posopt_gui.theme import Theme
from posopt_gui.viewmodels.front_model import FrontModel, Mark, alike, axis_range, joined, moved
from posopt_gui.views.curve_plots import GAUGE, LEFT_AXIS

REACH = 24.0
"""How near to a point the mouse must be to mean it [px]."""

STEPS = {
    Qt.Key.Key_Left: -1, Qt.Key.Key_Right: 1, Qt.Key.Key_Down: -1, Qt.Key.Key_Up: 1,
    Qt.Key.Key_PageDown: -10, Qt.Key.Key_PageUp: 10,
    Qt.Key.Key_Home: -1_000_000, Qt.Key.Key_End: 1_000_000,
}  # fmt: skip
"""How many points each key goes on."""

SIDES, ENDS = (0.06, 0.06), (0.1, 0.2)
"""Room beside, below and above the points, as shares of their range; above there stand words."""

GAP = 7.0
"""Between a point and its words [px]."""

TAKING = (Qt.Key.Key_Return, Qt.Key.Key_Enter)

SHAPES = {"f": "t1", "f1": "s", "f2": "t"}


class FrontPlot(pg.PlotWidget):
    """Emits which point is pointed at (-1 for none) and which one is taken."""

    pointed = Signal(int)
    taken = Signal(int)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent, enableMenu=False)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMinimumHeight(110)
        plot = self.getPlotItem()
        plot.hideButtons()
        plot.getAxis("left").setWidth(LEFT_AXIS)
        plot.setContentsMargins(0.0, 4.0, float(GAUGE), 0.0)
        for name in ("left", "bottom"):
            plot.getAxis(name).enableAutoSIPrefix(False)
        plot.getViewBox().disableAutoRange()
        plot.getViewBox().sigRangeChanged.connect(self._put_safety_name)
        self._model: FrontModel | None = None
        self._present: Mark | None = None
        self._index: int | None = None
        self._words = {"knee": "", "plan": "", "safety": "", "comma": ", "}
        self._make_items()
        self.scene().sigMouseMoved.connect(self._on_move)
        self.scene().sigMouseClicked.connect(self._on_click)

    def _make_items(self) -> None:
        self._safety = pg.InfiniteLine(angle=90)
        self._line = pg.PlotDataItem()
        self._points = pg.ScatterPlotItem(size=6.0, pen=pg.mkPen(None), pxMode=True)
        self._knee = pg.ScatterPlotItem(size=15.0, brush=None, pxMode=True)
        self._marks = pg.ScatterPlotItem(size=10.0, pxMode=True)
        self._plan = pg.ScatterPlotItem(size=13.0, symbol="d", pxMode=True)
        self._ring = pg.ScatterPlotItem(size=13.0, brush=None, pxMode=True)
        for depth, item in enumerate(
            (self._safety, self._line, self._points, self._marks, self._knee, self._plan,
             self._ring)
        ):  # fmt: skip
            item.setZValue(depth)
            self.addItem(item, ignoreBounds=True)
        self._knee_name = self._text()
        self._plan_name = self._text()
        self._card = self._text()
        self._card.setZValue(40)
        self._mark_names: list[pg.TextItem] = []
        self._safety_name = self._text()

    def _text(self) -> pg.TextItem:
        item = pg.TextItem("")
        item.setZValue(30)
        item.hide()
        self.addItem(item, ignoreBounds=True)
        return item

    @property
    def index(self) -> int | None:
        """The point that is pointed at."""
        return self._index

    def set_theme(self, theme: Theme) -> None:
        """Set all colours."""
        self.setBackground(QColor(theme.plot))
        for name in ("left", "bottom"):
            axis = self.getPlotItem().getAxis(name)
            axis.setPen(pg.mkPen(QColor(theme.border)))
            axis.setTextPen(pg.mkPen(QColor(theme.muted)))
        self.getPlotItem().showGrid(x=True, y=True, alpha=0.12 if theme.dark else 0.18)
        dash = Qt.PenStyle.DashLine
        self._safety.setPen(pg.mkPen(QColor(theme.error), width=1.4, style=dash))
        self._line.setPen(pg.mkPen(QColor(theme.muted), width=1.0))
        self._points.setBrush(QColor(theme.accent))
        self._knee.setPen(pg.mkPen(QColor(theme.warning), width=2.2))
        self._plan.setBrush(QColor(theme.line))
        self._plan.setPen(pg.mkPen(QColor(theme.plot), width=1.2))
        self._marks.setBrush(QColor(theme.plot))
        self._marks.setPen(pg.mkPen(QColor(theme.muted), width=1.6))
        self._ring.setPen(pg.mkPen(QColor(theme.accent), width=2.4))
        fill = QColor(theme.raised)
        self._card.fill, self._card.border = pg.mkBrush(fill), pg.mkPen(QColor(theme.border))
        for item, colour in (
            (self._knee_name, theme.warning), (self._plan_name, theme.text),
            (self._card, theme.text), (self._safety_name, theme.error),
        ):  # fmt: skip
            item.setColor(QColor(colour))
        for item in self._mark_names:
            item.setColor(QColor(theme.muted))
        self._muted = theme.muted

    def set_words(self, knee: str, plan: str, safety: str, comma: str) -> None:
        """Name the knee, the plan and the safety distance, and say what parts names."""
        self._words = {"knee": knee, "plan": plan, "safety": safety, "comma": comma}

    def set_model(
        self, model: FrontModel | None, present: Mark | None, safety: float | None
    ) -> None:
        """Draw a front, the present plan and its safety distance [mm]; another one is framed."""
        other = model is not self._model
        self._model, self._present = model, present
        if other:
            self.point_at(None)
        if model is None:
            return
        if other:
            self._line.setData(*model.stairs())
            self._points.setData(model.clearance, model.cost)
            self.frame()
        self._draw_knee(model)
        self._draw_sequences(model, present)
        self._safety.setVisible(safety is not None)
        self._safety_name.setVisible(safety is not None)
        if safety is not None:
            self._safety.setValue(safety)
            self._safety_name.setText(self._words["safety"])
        self._put_safety_name()

    def frame(self) -> None:
        """Show all points."""
        model = self._model
        if model is None:
            return
        marks = [*model.marks, *([self._present] if self._present is not None else [])]
        x = axis_range(model.clearance, [one.clearance for one in marks], SIDES)
        y = axis_range(model.cost, [one.cost for one in marks], ENDS)
        self.getPlotItem().getViewBox().setRange(xRange=x, yRange=y, padding=0.0)

    def point_at(self, index: int | None, words: str = "") -> None:
        """Mark a point with a card that holds words; it is told to nobody."""
        self._index = index
        model = self._model
        if index is None or model is None:
            self._ring.clear()
            self._card.hide()
            return
        x, y = float(model.clearance[index]), float(model.cost[index])
        self._ring.setData([x], [y])
        self._card.setText(words)
        self._card.setVisible(bool(words))
        self._place(self._card, x, y)

    def _draw_knee(self, model: FrontModel) -> None:
        known = model.knee is not None
        at = [model.knee] if model.knee is not None else []
        self._knee.setData(model.clearance[at], model.cost[at])
        self._knee_name.setVisible(known)
        if known:
            self._knee_name.setText(self._words["knee"])
            x, y = float(model.clearance[at][0]), float(model.cost[at][0])
            self._place(self._knee_name, x, y, left=False, above=False)

    def _draw_sequences(self, model: FrontModel, present: Mark | None) -> None:
        same = [one for one in model.marks if present is not None and alike(one, present)]
        others = joined(tuple(one for one in model.marks if one not in same))
        self._marks.setData(
            [one.clearance for one in others], [one.cost for one in others],
            symbol=[SHAPES.get(one.name.split(",")[0], "o") for one in others],
        )  # fmt: skip
        while len(self._mark_names) < len(others):
            self._mark_names.append(self._text())
            self._mark_names[-1].setColor(QColor(self._muted))
        for number, item in enumerate(self._mark_names):
            item.setVisible(number < len(others))
            if number < len(others):
                item.setText(others[number].name)
                self._place(item, others[number].clearance, others[number].cost)
        self._plan_name.setVisible(present is not None)
        if present is None:
            self._plan.clear()
            return
        self._plan.setData([present.clearance], [present.cost])
        names = [self._words["plan"], *(one.name for one in same)]
        self._plan_name.setText(self._words["comma"].join(names))
        self._place(self._plan_name, present.clearance, present.cost)

    def _place(
        self, item: pg.TextItem, x: float, y: float, *, left: bool = True, above: bool = True
    ) -> None:
        """Put words beside a point: to that side of it, unless the picture ends there."""
        box, room = self.getPlotItem().getViewBox(), item.boundingRect()
        low, high = box.viewRange()[0]
        place = box.width() * (x - low) / (high - low)
        needs = room.width() + GAP
        left = place >= needs if left else place > box.width() - needs
        across, up = GAP / max(room.width(), 1.0), GAP / max(room.height(), 1.0)
        item.setAnchor((1.0 + across if left else -across, 1.0 + up if above else -up))
        item.setPos(x, y)

    def _put_safety_name(self, *_: object) -> None:
        """Write below the front, where there is never a point, and within the picture."""
        (left, right), (low, _top) = self.getPlotItem().getViewBox().viewRange()
        value = float(self._safety.value())
        near = value > right - 0.3 * (right - left)
        self._safety_name.setAnchor((1.0, 1.0) if near else (0.0, 1.0))
        self._safety_name.setPos(value, low)

    def _index_at(self, position: QPointF) -> int | None:
        box = self.getPlotItem().getViewBox()
        if self._model is None or not box.sceneBoundingRect().contains(position):
            return None
        place = box.mapSceneToView(position)
        index, away = self._model.nearest((place.x(), place.y()), box.viewPixelSize())
        return index if away <= REACH else None

    def _on_move(self, position: QPointF) -> None:
        found = self._index_at(position)
        if found != self._index:
            self.pointed.emit(-1 if found is None else found)

    def _on_click(self, event: object) -> None:
        if event.button() != Qt.MouseButton.LeftButton:  # type: ignore[attr-defined]
            return
        if event.double():  # type: ignore[attr-defined]
            return
        found = self._index_at(event.scenePos())  # type: ignore[attr-defined]
        if found is not None:
            self.taken.emit(found)

    def leaveEvent(self, event: QEvent) -> None:  # noqa: N802 - Qt's name
        """Point at nothing."""
        super().leaveEvent(event)
        if self._index is not None:
            self.pointed.emit(-1)

    def event(self, event: QEvent) -> bool:
        """Keep the keys of this picture from moving the window's waypoint."""
        asks = event.type() == QEvent.Type.ShortcutOverride
        if isinstance(event, QKeyEvent) and asks and event.key() in (*STEPS, *TAKING):
            event.accept()
            return True
        return bool(super().event(event))

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 - Qt's name
        """Move from point to point, and take one."""
        key, model = Qt.Key(event.key()), self._model
        if model is None or not len(model):
            super().keyPressEvent(event)
        elif key in STEPS:
            self.pointed.emit(moved(model, self._index, STEPS[key], self._present))
        elif key in TAKING and self._index is not None:
            self.taken.emit(self._index)
        else:
            super().keyPressEvent(event)
