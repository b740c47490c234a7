"""Chinese words and their brackets come from one font, and their rows are equally high."""

import pytest
from PySide6.QtCore import QLocale
from PySide6.QtGui import QFontDatabase, QTextLayout
from PySide6.QtWidgets import QApplication

from posopt_gui.dialogs.check_table import CheckTable
from posopt_gui.look import Look
from posopt_gui.style import CHINESE_FONTS, prepare_fonts
from posopt_gui.views.label_grid import LabelGrid, Text

WORDS = "位于路径点 50（GROOVE.LS:93）"


@pytest.fixture
def fonts(qapp):
    before = QApplication.font()
    if not any(map(QFontDatabase.hasFamily, CHINESE_FONTS)):
        pytest.skip("no Chinese font is installed")
    prepare_fonts()
    yield QApplication.font()
    QApplication.setFont(before)


def fonts_of(words, font):
    """Which font each character is drawn with."""
    layout = QTextLayout(words, font)
    layout.beginLayout()
    layout.createLine()
    layout.endLayout()
    found = {}
    for place, one in enumerate(words):
        runs = layout.glyphRuns(place, 1)
        found.setdefault(one, {run.rawFont().familyName() for run in runs})
    return found


def test_brackets_around_latin_letters_have_the_font_of_the_chinese_words(fonts):
    found = fonts_of(WORDS, fonts)
    assert found["（"] == found["）"] == found["位"]
    assert found["位"] <= set(CHINESE_FONTS)
    assert found["G"] != found["位"]


def test_figures_of_a_check_stand_on_the_line_of_the_chinese_words(fonts, qtbot):
    def ascent(words):
        layout = QTextLayout(words, fonts)
        layout.beginLayout()
        line = layout.createLine()
        layout.endLayout()
        return line.ascent()

    table = CheckTable(Look("zh_CN", "light"))
    qtbot.addWidget(table)
    shown = table.itemDelegate().displayText("50.0 mm", QLocale.c())
    assert ascent(shown) == ascent("避障间隙")
    assert shown.strip() == "50.0 mm"


def test_rows_of_latin_letters_are_as_high_as_the_chinese_ones_beside_them(fonts, qtbot):
    grid = LabelGrid(2)
    qtbot.addWidget(grid)
    words = (("构型", "0"), ("CONFIG", "N U T, 0, 0, 0"), ("J1", "5.00°"))
    grid.set_rows([(Text(one, "black"), Text(other, "black")) for one, other in words])
    grid.resize(300, grid.sizeHint().height())
    grid.show()
    tops = [row[0].geometry().center().y() for row in grid._labels]
    assert abs((tops[1] - tops[0]) - (tops[2] - tops[1])) <= 1
