"""The whole window and its dialogs in Chinese show no English word, and decimals have points."""

import re

import pytest
from PySide6.QtCore import QAbstractListModel, QCoreApplication, Qt
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractItemView,
    QComboBox,
    QGroupBox,
    QLabel,
    QLineEdit,
    QMenu,
    QTabBar,
    QTextBrowser,
    QWidget,
)
from window_helpers import CELLS, opened, settle, wait

from posopt_gui.viewmodels.form_types import rows_of
from posopt_gui.viewmodels.path_preview import examine
from solver.io.importers import Source
from solver.model.scheme import Scheme

NAMES = {
    # files, formats, programs, units and words of the controller
    "posopt", "mm", "kg", "deg", "ms", "rad", "CSV", "JSON", "LS", "OpenGL", "glTF", "min", "sec",
    "English", "exact", "TOML", "URDF", "fanuc", "joint", "cartesian", "Enter", "Esc", "Ctrl",
    # frames, groups, faces and schemes by the names that files give them
    "fanuc_world", "floor", "beam", "flange", "web", "wpr", "full", "paper", "left", "right",
    "top", "bottom", "inner", "outer", "edge", "fillet", "none", "spindle", "dwell", "call", "off",
    "on", "do", "com", "px", "tw", "tf", "csv", "json", "line", "pass", "touches",
    "Shift", "Space", "Left", "Right", "Home", "End",
    "nx", "ny", "nz", "tx", "ty", "tz", "qw", "qx", "qy", "qz",
}  # fmt: skip
FILE = re.compile(r"[\w./-]*[_./-][\w./-]+|\.\w+|[0-9a-f]{12}")
HTML = re.compile(r"<[^>]*>|&\w+;")


@pytest.fixture(scope="module")
def shared(qapp, tmp_path_factory):
    with opened(tmp_path_factory.mktemp("window"), CELLS / "groove_paper.toml") as made:
        made.session.look.set_language("zh_CN")
        made.session.turns.finish()
        made.session.set_compared(tuple(Scheme))
        made.session.start()
        wait(lambda: made.session.report is not None)
        made.setup.set_open_sections(tuple(made.setup._boxes))
        settle(made)
        yield made


@pytest.fixture
def window(shared):
    yield shared
    while shared.session.document.can_undo:
        shared.session.document.undo()
    settle(shared)


def texts_of(top):
    """Every text that a window can show: words, tips, lists, tables, menus and names."""
    for one in [top, *top.findChildren(QWidget)]:
        # Parts that Qt makes for itself are in its own translation.
        if isinstance(one, QTextBrowser) or one.objectName().startswith(("qt_", "Scroll")):
            continue
        yield one.toolTip(), one
        yield one.accessibleName(), one
        yield one.windowTitle(), one
        yield from ((text, one) for text in own_texts(one))
        for action in one.actions():
            yield from ((text, one) for text in (action.text(), action.toolTip()))


def own_texts(one):
    if isinstance(one, QLabel | QAbstractButton):
        yield one.text()
    elif isinstance(one, QGroupBox | QMenu):
        yield one.title()
    elif isinstance(one, QComboBox):
        yield from (one.itemText(row) for row in range(one.count()))
    elif isinstance(one, QLineEdit):
        yield one.placeholderText()
    elif isinstance(one, QTabBar):
        yield from (one.tabText(row) for row in range(one.count()))
    elif isinstance(one, QAbstractItemView) and one.model() is not None:
        yield from cells_of(one.model())


def cells_of(model):
    columns = 1 if isinstance(model, QAbstractListModel) else model.columnCount()
    for row in range(min(model.rowCount(), 60)):
        for column in range(columns):
            for role in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.ToolTipRole):
                yield str(model.index(row, column).data(role) or "")
    for column in range(columns):
        yield str(model.headerData(column, Qt.Orientation.Horizontal) or "")


def left_over(text):
    """English words in a text: no name of a file, cell, frame or unit."""
    bare = FILE.sub(" ", HTML.sub(" ", text))
    words = re.findall(r"[A-Za-z]*[a-z]{2,}", bare)
    return [word for word in words if word not in NAMES]


def assert_chinese(top, known=frozenset()):
    found = {}
    for text, one in texts_of(top):
        words = [word for word in left_over(text) if word not in known]
        if words:
            found[text] = f"{type(one).__name__} {one.objectName()}"
    assert not found, "\n".join(f"{text!r}: {place}" for text, place in found.items())
    for text, _ in texts_of(top):
        assert not re.search(r"\d,\d(?!\d\d)", text), text
        assert not re.search(r"(?<![\d.])[-−]0(\.0*)?(?![\d.])", HTML.sub(" ", text)), text


def test_the_window_shows_no_english_word(window):
    names = {str(one["name"]) for one in rows_of(window.session.document.state.cell, "fixtures")}
    for tabs in (window.tabs, window.curves.tabs, window.results.tabs):
        for row in range(tabs.count()):
            tabs.setCurrentIndex(row)
            settle(window)
    assert_chinese(window, names)


def test_every_way_to_state_the_inputs_shows_no_english_word(window):
    document = window.session.document
    form = window.setup.form
    for key, value in (
        ("beam.standard", "free"), ("placement.rule", "centre"), ("path.kind", "line"),
        ("path.kind", "parametric"), ("settings.self_check", False), ("accuracy", None),
        ("program.links", True), ("path.orientation", True),
    ):  # fmt: skip
        field = window.setup.form.field(key)
        if field is None:
            continue
        window.setup._on_edited(field, value)
        settle(window)
        assert_chinese(window.setup)
        document.undo()
    for shape in ("box", "sphere", "cylinder", "capsule"):
        window.setup.fixtures.add(shape)
        settle(window)
        assert_chinese(window.setup, {shape})
        document.undo()
    settle(window)
    assert form is not None


def test_wrong_inputs_are_told_without_an_english_word(window):
    document = window.session.document
    for key, value in (
        ("settings.safety_distance_mm", -1.0), ("beam.section", "HW999"), ("beam.length_mm", "x"),
        ("settings.lean_deg", [5.0, -5.0, 1.0]), ("robot.model", "other"),
        ("path.file", "gone.csv"),
        ("program.name", "lower case"), ("program.date", "tomorrow"), ("beam.frame", "sky"),
        ("settings.unknown", 1), ("robot.windows_deg", {"J1": [5.0, 1.0]}), ("fixtures", 3),
    ):  # fmt: skip
        document.set_value(key, value)
        settle(window)
        if window.session.problem_error is not None:
            shown = {"custom", "lower", "case", "tomorrow", "sky", "gone", "other", "unknown"}
            shown |= {"branches", "scheme", "seed", "steps", "turns", "weights"}
            shown |= {"section", "frame", "lean", "name", "date", "length", "file", "model"}
            assert_chinese(window.setup, shown)
            assert_chinese(window.inspector, shown)
            assert_chinese(window.statusBar(), shown)
        document.undo()
    settle(window)
    assert window.session.problem_error is None


def test_the_parts_of_qt_speak_the_language_too(window):
    look = window.session.look
    assert QCoreApplication.translate("QPlatformTheme", "Cancel") == "取消"
    look.set_language("en")
    assert QCoreApplication.translate("QPlatformTheme", "Cancel") == "Cancel"
    look.set_language("zh_CN")


def test_the_export_dialog_shows_no_english_word(window):
    window.show_export()
    dialog = window.export_dialog()
    wait(lambda: dialog.exporter.situation.current, 60.0)
    assert_chinese(dialog, {"tmp", "programs"})
    dialog.close()


def test_the_dialogs_of_setup_show_no_english_word(window):
    window.setup.placement_wanted.emit()
    dialog = window.setup_dialogs.placement
    assert_chinese(dialog)
    dialog.set_points([[762.0, -700.0, 225.0], [770.7, 300.0, 225.0], [766.4, -200.0, 75.0]])
    assert_chinese(dialog)
    dialog.set_points([[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    assert_chinese(dialog)
    dialog.close()
    state = window.session.document.state
    table = b"nummer;pos_a;pos_b;pos_c\n1;0;13;40\n2;20;13;45\n"
    source = Source("seam.csv", table)
    window.setup.path.questions.emit(examine(source, state.cell, folder=state.folder))
    assert_chinese(window.setup_dialogs.path, {"nummer", "pos", "seam", "feed", "pass", "role",
                                               "events", "lean", "lead", "spin"})  # fmt: skip
    window.setup_dialogs.path.close()
