"""The letters of the outcomes are kept between paintings, and always those of what is seen."""

import numpy as np
import pytest
from PySide6.QtCore import QRectF
from PySide6.QtGui import QColor, QImage

from posopt_gui.viewmodels.map_colours import CLASS_LETTERS, CellClass
from posopt_gui.views.map_interaction import MapPlot
from posopt_gui.views.map_items import LettersItem

RECT = QRectF(0.5, -25.5, 50.0, 51.0)
LETTERED = [one for one in CellClass if CLASS_LETTERS[one]]
COLOURS = {one: QColor(200, 30, 30) for one in CellClass}


def kinds(first, second):
    made = np.full((50, 51), first, np.uint8)
    made[:, 25:] = second
    return made


@pytest.fixture
def plot(qtbot):
    def make(kind, low, high):
        view = MapPlot()
        qtbot.addWidget(view)
        view.resize(600, 300)
        item = LettersItem()
        view.addItem(item)
        item.set_cells(kind, RECT, COLOURS)
        view.getPlotItem().getViewBox().setRange(RECT, padding=0.0)
        with qtbot.waitExposed(view):
            view.show()
        view.setXRange(low, high, padding=0.0)
        return view, item

    return make


def painted(view):
    picture = view.grab().toImage().convertToFormat(QImage.Format.Format_RGB32)
    flat = np.frombuffer(picture.constBits(), np.uint8)
    return flat.reshape(picture.height(), picture.width(), 4)[..., :3].copy()


def test_letters_after_a_pan_a_zoom_and_other_cells_are_those_of_a_new_plot(plot):
    one, other = kinds(*LETTERED[:2]), kinds(LETTERED[1], LETTERED[-1])
    view, item = plot(one, 0.5, 50.5)
    before = painted(view)
    for low, high in ((10.5, 40.5), (12.0, 42.0), (0.5, 50.5), (20.5, 26.5)):
        view.setXRange(low, high, padding=0.0)
        assert np.array_equal(painted(view), painted(plot(one, low, high)[0]))
    item.set_cells(other, RECT, COLOURS)
    now = painted(view)
    assert np.array_equal(now, painted(plot(other, 20.5, 26.5)[0]))
    assert not np.array_equal(now, before)


def test_letters_are_looked_for_once_for_many_paintings_of_the_same(plot, monkeypatch):
    found = []
    placed = LettersItem._placed
    monkeypatch.setattr(
        LettersItem, "_placed", lambda self, *given: found.append(1) or placed(self, *given)
    )
    view, _ = plot(kinds(*LETTERED[:2]), 0.5, 50.5)
    painted(view)
    found.clear()
    for _ in range(5):
        view.viewport().repaint()
    assert found == []
    view.setXRange(5.5, 30.5, padding=0.0)
    painted(view)
    assert found
