"""The window can be used with the keyboard alone, and tells assistive programs what is what."""

import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractItemView,
    QAbstractSlider,
    QAbstractSpinBox,
    QApplication,
    QComboBox,
    QGraphicsView,
    QHeaderView,
    QLineEdit,
    QPlainTextEdit,
    QScrollBar,
    QTabBar,
    QTextEdit,
    QWidget,
)
from shiboken6 import isValid
from window_helpers import CELLS, opened, settle, wait

from posopt_gui.viewmodels.path_preview import examine
from solver.io.importers import Source

CONTROLS = (
    QAbstractButton, QAbstractSpinBox, QComboBox, QLineEdit, QAbstractSlider, QAbstractItemView,
    QTabBar, QPlainTextEdit, QTextEdit, QGraphicsView,
)  # fmt: skip
VALUES = (QAbstractSpinBox, QComboBox, QAbstractSlider)


@pytest.fixture(scope="module")
def window(qapp, tmp_path_factory):
    with opened(tmp_path_factory.mktemp("window"), CELLS / "groove_paper.toml") as made:
        made.session.start()
        wait(lambda: made.session.report is not None)
        made.setup.set_open_sections(tuple(made.setup._boxes))
        settle(made)
        yield made


@pytest.fixture(params=["window", "export", "placement", "columns"])
def top(request, window):
    """The window and each of its dialogs, shown."""
    shown = {
        "window": lambda: window,
        "export": lambda: _export(window),
        "placement": lambda: _placement(window),
        "columns": lambda: _columns(window),
    }[request.param]()
    shown.activateWindow()
    wait(shown.isActiveWindow)
    yield shown
    if shown is not window and isValid(shown):
        shown.close()


def _export(window):
    window.show_export()
    dialog = window.export_dialog()
    wait(lambda: dialog.exporter.situation.current)
    return dialog


def _placement(window):
    window.setup.placement_wanted.emit()
    return window.setup_dialogs.placement


def _columns(window):
    state = window.session.document.state
    table = b"no;pos_a;pos_b;pos_c\n1;0;13;40\n2;20;13;45\n"
    source = Source("seam.csv", table)
    window.setup.path.questions.emit(examine(source, state.cell, folder=state.folder))
    return window.setup_dialogs.path


def controls_of(top):
    """Everything in a window that a person can work with, without the parts of other controls."""
    for one in top.findChildren(QWidget):
        own = one.window() is top and one.isVisibleTo(top)
        part = isinstance(one.parent(), (QAbstractSpinBox, QComboBox))
        inner = isinstance(one, (QScrollBar, QHeaderView))
        if own and isinstance(one, CONTROLS) and not part and not inner:
            yield one


def name_of(control):
    text = control.text() if isinstance(control, QAbstractButton) else ""
    return control.accessibleName() or text


def path_of(widget):
    names = []
    while widget is not None:
        names.append(widget.objectName() or type(widget).__name__)
        widget = widget.parentWidget()
    return " < ".join(names)


@pytest.mark.parametrize("language", ["en", "zh_CN"])
def test_every_control_has_an_accessible_name_or_a_text(window, top, language):
    window.session.look.set_language(language)
    window.session.turns.finish()
    nameless = [path_of(one) for one in controls_of(top) if not name_of(one).strip()]
    window.session.look.set_language("en")
    window.session.turns.finish()
    assert nameless == []


def test_every_enabled_control_is_reached_by_the_tabulator(top):
    # Plots and the map are looked at; their keys are those of the window.
    wanted = {
        one for one in controls_of(top) if one.isEnabled() and not isinstance(one, QGraphicsView)
    }
    missing = [path_of(one) for one in wanted if not one.focusPolicy() & Qt.FocusPolicy.TabFocus]
    assert missing == []
    first = next(iter(wanted))
    first.setFocus(Qt.FocusReason.TabFocusReason)
    reached = set()
    for _ in range(3 * len(wanted) + 50):
        now = QApplication.focusWidget()
        if now is None:
            break
        reached.add(now)
        QTest.keyClick(now, Qt.Key.Key_Tab)
    # A group of exclusive buttons is one stop of the tabulator.
    left = [path_of(one) for one in wanted - reached if not _exclusive(one)]
    assert left == []


def _exclusive(one):
    return isinstance(one, QAbstractButton) and one.autoExclusive()


def test_the_wheel_changes_no_value_without_the_focus(top):
    top.setFocus()
    changed = []
    for one in controls_of(top):
        if not isinstance(one, VALUES) or not one.isEnabled() or one.hasFocus():
            continue
        before = value_of(one)
        turn(one)
        if value_of(one) != before:
            changed.append(path_of(one))
        assert not one.hasFocus(), path_of(one)
    assert changed == []


def value_of(control):
    if isinstance(control, QComboBox):
        return control.currentIndex(), control.currentText()
    return control.text() if isinstance(control, QAbstractSpinBox) else control.value()


def turn(control):
    place = QPointF(control.rect().center())
    event = QWheelEvent(
        place, control.mapToGlobal(place), QPoint(), QPoint(0, -120), Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier, Qt.ScrollPhase.NoScrollPhase, False,
    )  # fmt: skip
    QApplication.sendEvent(control, event)
    QApplication.processEvents()


@pytest.mark.parametrize("top", ["placement", "columns"], indirect=True)
def test_escape_leaves_a_dialog_and_changes_nothing(window, top):
    document = window.session.document
    before = document.state
    QTest.keyClick(top, Qt.Key.Key_Escape)
    wait(lambda: not isValid(top) or not top.isVisible())
    assert document.state is before
