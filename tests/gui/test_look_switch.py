"""Another theme or language while the window is open: all of it, at once, and right."""

import pytest
from PySide6.QtCore import QEvent, QObject, QPoint
from PySide6.QtGui import QColor, QImage
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QComboBox
from window_helpers import CELLS, field, opened, settle, wait

from posopt_gui.controllers.files import state_of_argument
from posopt_gui.i18n import texts
from posopt_gui.style import STYLED, in_windows, of_all_themes, style_sheet
from posopt_gui.theme import DARK, LIGHT
from posopt_gui.views import look_switch
from posopt_gui.views.setup_style import setup_style

SMALL = CELLS / "groove_paper.toml"
OTHER = CELLS / "groove_hw300.toml"


@pytest.fixture(scope="module")
def shared(qapp, tmp_path_factory):
    """One window with a planned cell for all tests here."""
    with opened(tmp_path_factory.mktemp("window"), SMALL) as made:
        # Where panels are at their smallest the layout depends on what was before.
        made.resize(1400, 950)
        made.places.share_height()
        made.session.start()
        wait(lambda: made.session.report is not None)
        steady(made)
        yield made


@pytest.fixture
def window(shared):
    shared.setFocus()
    switched(shared, "light", "en")
    yield shared
    shared.tabs.setCurrentIndex(0)
    switched(shared, "light", "en")


def switched(window, theme=None, language=None):
    """Choose a look and wait until it is on screen."""
    if theme is not None:
        window.session.look.set_theme(theme)
    if language is not None:
        window.session.look.set_language(language)
    wait(lambda: not window.look_switch.going_on)
    steady(window)


def seen(widget) -> QImage:
    return widget.grab().toImage().convertToFormat(QImage.Format.Format_RGB32)


def steady(window) -> QImage:
    """What a window shows once all that is worked out beside it has come."""
    settle(window)
    same, last = 0, seen(window)
    while same < 4:
        QTest.qWait(30)
        now = seen(window)
        same, last = (same + 1 if now == last else 0), now
    return last


def styled_by_qt(window, *widgets):
    """Pictures of widgets that Qt itself has styled with the plain sheet of the window's theme."""
    application, theme = QApplication.instance(), window.session.look.theme
    own = window.setup.styleSheet()
    window.setProperty(STYLED, "")
    try:
        application.setStyleSheet(style_sheet(theme))
        window.setup.setStyleSheet(setup_style(theme))
        steady(window)
        return [seen(one) for one in widgets]
    finally:
        window.setProperty(STYLED, theme.name)
        application.setStyleSheet(of_all_themes(style_sheet))
        window.setup.setStyleSheet(own)
        QTest.qWait(20)


@pytest.mark.parametrize("theme", ["dark", "light"])
def test_a_switched_window_looks_as_one_that_qt_has_styled_anew(window, theme):
    switched(window, "light" if theme == "dark" else "dark")
    switched(window, theme)
    found = seen(window)
    assert [found] == styled_by_qt(window, window)
    corner = found.pixelColor(window._bar.mapTo(window, QPoint(2, 2)))
    assert corner == QColor(window.session.look.theme.window)


def test_what_was_hidden_while_the_theme_changed_is_right_when_it_is_shown(window):
    dialog = window.export_dialog()
    section = window.setup.section("limits")
    section.set_open(True)
    section.set_open(False)
    switched(window, "dark")
    section.set_open(True)
    window.tabs.setCurrentIndex(1)
    dialog.show()
    steady(window)
    parts = (window.results, window.setup, dialog.form, window)
    found = [seen(one) for one in parts]
    assert found == styled_by_qt(window, *parts)
    dialog.hide()
    section.set_open(False)


def test_switching_there_and_back_at_once_leaves_it_as_it_was(window):
    before = seen(window)
    look = window.session.look
    look.set_theme("dark")
    look.set_language("zh_CN")
    QApplication.processEvents()
    look.set_theme("light")
    look.set_language("en")
    switched(window)
    assert seen(window) == before
    assert window.updatesEnabled()


def test_a_project_opened_while_the_look_changes_gets_the_new_look(qapp, tmp_path):
    with opened(tmp_path, SMALL) as window:
        session = window.session
        session.look.set_theme("dark")
        session.look.set_language("zh_CN")
        QApplication.processEvents()
        assert window.look_switch.going_on
        session.open(state_of_argument(str(OTHER))[0])
        wait(lambda: session.problem is not None and not window.look_switch.going_on)
        steady(window)
        assert window.updatesEnabled()
        assert window.tabs.tabText(0) == texts("zh_CN")["Curves"]
        assert window.setup.section("beam")._header.button.text() == texts("zh_CN")["Beam"]
        panels = (window.setup, window.menuBar(), window.inspector)
        found = [seen(one) for one in panels]
        assert found == styled_by_qt(window, *panels)


class Paints(QObject):
    """Counts the paintings of a window."""

    count = 0

    def eventFilter(self, watched, event):  # noqa: N802 - Qt's name
        self.count += event.type() == QEvent.Type.Paint and watched.isWidgetType()
        return False


@pytest.mark.parametrize("changed", [{"theme": "dark"}, {"language": "zh_CN"}])
def test_no_half_of_the_window_is_painted_in_the_old_look(window, changed):
    paints = Paints()
    QApplication.instance().installEventFilter(paints)
    look, during = window.session.look, []
    if "theme" in changed:
        look.set_theme(changed["theme"])
    else:
        look.set_language(changed["language"])
    while window.look_switch.going_on:
        QApplication.processEvents()
        if window.look_switch.going_on:
            during.append(paints.count)
    assert len(during) > 5
    assert not any(during)
    wait(lambda: paints.count > 0)
    QApplication.instance().removeEventFilter(paints)


def test_a_window_whose_work_never_ends_is_painted_all_the_same(window, monkeypatch):
    monkeypatch.setattr(look_switch, "PATIENCE", 0.2)
    session = window.session

    def again():
        session.turns.ask("endless", again)

    again()
    session.look.set_theme("dark")
    wait(window.updatesEnabled)
    assert session.turns.waiting
    session.turns.forget("endless")


def test_the_list_that_is_searched_by_typing_has_the_colours_too(window):
    switched(window, "dark")
    row = field(window, "beam.section")
    editor = row.editors[0]
    assert isinstance(editor, QComboBox)
    editor._offer_all()
    popup = editor.completer().popup()
    wait(popup.isVisible)
    colour = seen(popup).pixelColor(popup.width() // 2, popup.height() - 4)
    popup.hide()
    assert colour in (QColor(DARK.surface), QColor(DARK.selection))


def test_every_rule_of_a_theme_is_kept_and_bound_to_its_windows():
    plain, bound = style_sheet(DARK), in_windows(style_sheet(DARK), DARK)
    assert plain.count("{") == bound.count("{") > 50
    declarations = [one.split("}")[0].split() for one in plain.split("{")[1:]]
    assert declarations == [one.split("}")[0].split() for one in bound.split("{")[1:]]
    selectors = [one.split("}")[-1] for one in bound.split("{")[:-1]]
    for several in selectors:
        assert all(one.strip().startswith("QMainWindow[") for one in several.split(","))
    assert of_all_themes(style_sheet).startswith(style_sheet(LIGHT))
