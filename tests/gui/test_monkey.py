"""A seeded monkey at the window: whatever it does, document, plan and panels stay consistent."""

from __future__ import annotations

import random
import time
from collections import deque
from pathlib import Path

import pytest
from map_mouse import LEFT, RIGHT
from PySide6.QtCore import QEvent, QUrl
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from window_helpers import (
    CELLS,
    EXAMPLES,
    Hand,
    drop,
    field,
    logged_defects,
    opened,
    person,
    press,
    settle,
    wait,
)  # fmt: skip

from posopt_gui.controllers.playback import SPEEDS
from posopt_gui.document.document import HISTORY_LIMIT
from posopt_gui.document.project_file import save_project
from posopt_gui.viewmodels.form_types import Kind
from posopt_gui.viewmodels.map_colours import Layer
from posopt_gui.views.results_view import MESSAGES
from solver.errors import PosoptError
from solver.model.settings import Scheme
from solver.model.wishes import Region

SMALL = CELLS / "groove_paper.toml"
TYPED = ("-1", "0", "1", "0.5", "7", "45", "90", "200", "1e9", "1e300", "-1e9", "nan", "abc", "")
KEYS = ("Left", "Right", "Home", "End", "Space", "1", "2", "3", "F", "P", "Del", "Escape")
ACTIONS = ("undo", "undo", "redo", "clear_wishes", "plan", "plan", "plan", "stop", "live",
           "compare", "dark", "chinese", "reset_layout", "about", "save")  # fmt: skip
NEAR = 6
"""What was done last is told with a failure."""

PAINTED = 50
PATIENCE = 1.0
"""How long a plan is waited for before it is stopped [s]."""


class Monkey:
    """Does what a person could do, in an order that a seed decides."""

    def __init__(self, window, folder: Path, seed: int) -> None:
        self.window, self.session, self.folder = window, window.session, folder
        self.dice = random.Random(seed)
        self.mouse = Hand(window)
        self.ordered = [window.session._planned_state]
        self.done: deque[str] = deque(maxlen=NEAR)
        self.said = self.count = 0
        self._watch()
        self._make_files()
        self._deeds = (
            (self.act, 14), (self.edit_field, 20), (self.pin, 8), (self.drag, 8),
            (self.menu, 6), (self.forbid, 4), (self.point, 10), (self.move_cursor, 10),
            (self.press_key, 8), (self.play, 3), (self.map_page, 6), (self.zoom, 3),
            (self.tab, 5), (self.open_file, 3), (self.drop_file, 3), (self.export, 2),
            (self.preview, 3), (self.pause, 4), (self.select_row, 3), (self.fixture, 2),
        )  # fmt: skip

    def _watch(self) -> None:
        """Note which inputs were ordered to be planned, since the project was opened."""
        session = self.session
        plan, open_ = session.plan, session.open

        def ordered() -> None:
            self.ordered.append(session.document.state)
            plan()

        def begun(state, *, saved=True) -> None:
            self.ordered.clear()
            open_(state, saved=saved)

        session.plan, session.open = ordered, begun
        self.window.actions_table["plan"].triggered.disconnect()
        self.window.actions_table["plan"].triggered.connect(ordered)
        session.message.connect(self._hear)
        # Nobody is there to choose a file in a dialog of the desktop.
        self.window.setup.path.choose = lambda: None

    def _hear(self, message) -> None:
        self.said += 1
        assert message.severity in {"info", "warning", "error"}
        assert message.text.strip()
        assert "Traceback" not in message.text

    def _make_files(self) -> None:
        self.files = [SMALL, SMALL, CELLS / "groove_hw300.toml", EXAMPLES / "groove_hw300.csv"]
        for name, data in (
            ("broken.posopt", b"{"), ("broken.toml", b"[["), ("broken.csv", b"x,y\n1,\n"),
            ("none.ls", b"/PROG"), ("picture.png", b"\x89PNG"),
        ):  # fmt: skip
            (self.folder / name).write_bytes(data)
            self.files.append(self.folder / name)
        self.project = self.folder / "monkey.posopt"
        save_project(self.session.document.state, self.project)
        self.files += [self.project, self.folder / "missing.posopt"]

    def step(self) -> None:
        """Do something, and let the window live for a moment."""
        deeds, weights = zip(*self._deeds, strict=True)
        deed = self.dice.choices(deeds, weights)[0]
        self.done.append(deed.__name__)
        self.count += 1
        # Painting takes most of the time; every fiftieth step shows what has become of it.
        self.window.setUpdatesEnabled(self.count % PAINTED == 0)
        deed()
        QApplication.processEvents()

    def note(self, what: object) -> None:
        self.done[-1] += f" {what}"

    def act(self) -> None:
        name = self.dice.choice(ACTIONS)
        self.note(name)
        person(self.window).name = str(self.project)
        self.window.actions_table[name].trigger()

    def edit_field(self) -> None:
        form = self.window.setup.form
        section = self.dice.choice([one for one in form.sections if one.fields])
        chosen = self.dice.choice(section.fields)
        row = field(self.window, chosen.key)
        editor = self.dice.choice(row.editors)
        text = self.dice.choice(TYPED)
        self.note(f"{chosen.key} {text}")
        if chosen.kind is Kind.CHOICE:
            index = self.dice.randrange(editor.count())
            editor.setCurrentIndex(index)
            editor.activated.emit(index)
        elif chosen.kind in {Kind.FLAG, Kind.SUBSET}:
            editor.click()
        elif chosen.kind in {Kind.TEXT, Kind.WORDS}:
            editor.setText(text)
            editor.editingFinished.emit()
        elif self.dice.random() < 0.5:
            editor.stepBy(self.dice.choice((-3, -1, 1, 2)))
        else:
            editor.selectAll()
            QTest.keyClicks(editor, text)
            press(editor, "Return")

    def _cell(self):
        model = self.window.map.canvas.model
        if model is None:
            return None
        row = self.dice.randrange(model.rows)
        return self.dice.randrange(model.waypoints), float(model.leans[row])

    def pin(self) -> None:
        cell = self._cell()
        if cell is None:
            return
        if self.dice.random() < 0.5:
            self.mouse.double_click(*cell)
        else:
            self.session.pin(cell[0], cell[1])

    def drag(self) -> None:
        cell, line = self._cell(), self.window.map.canvas.line
        if cell is None or len(line) == 0:
            return
        waypoint = min(cell[0], len(line) - 1)
        self.mouse.drag(waypoint, float(line[waypoint]), cell[1] / 2.0, cell[1], button=LEFT)

    def preview(self) -> None:
        """A drag that is given up."""
        cell, line = self._cell(), self.window.map.canvas.line
        if cell is None or len(line) == 0:
            return
        waypoint = min(cell[0], len(line) - 1)
        self.mouse.move(waypoint, float(line[waypoint]))
        self.mouse.press(waypoint, float(line[waypoint]))
        self.mouse.move(*cell)
        self.window.map.leave()
        self.mouse.release(*cell)

    def menu(self) -> None:
        canvas, cell = self.window.map.canvas, self._cell()
        if cell is None:
            return
        menu = self.window.map.wishes.menu(canvas.cell_at(self.mouse.place(*cell)))
        actions = [one for one in menu.actions() if one.isEnabled() and not one.isSeparator()]
        if actions:
            chosen = self.dice.choice(actions)
            self.note(chosen.text())
            chosen.trigger()
        menu.deleteLater()

    def forbid(self) -> None:
        one, other = self._cell(), self._cell()
        if one is None or other is None:
            return
        if self.dice.random() < 0.5:
            first, last = sorted((one[0], other[0]))
            low, high = sorted((one[1] / 60.0, other[1] / 60.0))
            self.session.forbid(Region(first, min(last, first + 3), low, high))
        else:
            self.mouse.press(*one, RIGHT)
            self.mouse.move(*other)
            self.mouse.release(*other, RIGHT)
        if self.dice.random() < 0.5:
            self.session.allow(self.dice.randrange(3))

    def point(self) -> None:
        cell = self._cell()
        if cell is None:
            return
        self.mouse.move(*cell)
        if self.dice.random() < 0.2:
            QApplication.sendEvent(self.window.map.canvas, QEvent(QEvent.Type.Leave))

    def move_cursor(self) -> None:
        slider = self.window.timeline._slider
        slider.setValue(self.dice.randint(slider.minimum(), slider.maximum()))
        if self.dice.random() < 0.2:
            self.session.set_place(self.dice.uniform(-10.0, 1e4))

    def press_key(self) -> None:
        keys = self.dice.choice(KEYS)
        self.note(keys)
        self.window.map.setFocus()
        press(self.window.map, keys)

    def play(self) -> None:
        playback = self.window.timeline.playback
        playback.set_speed(self.dice.choice(SPEEDS))
        playback.set_loop(self.dice.random() < 0.5)
        playback.toggle()

    def map_page(self) -> None:
        header = self.window.map.header
        what = self.dice.randrange(4)
        self.note(what)
        if what == 0:
            header.set_layer(self.dice.choice(list(Layer)))
        elif what == 1:
            header.page_box.setCurrentIndex(self.dice.randrange(max(header.page_box.count(), 1)))
        elif what == 2:
            header.set_lines(self.dice.sample([one.value for one in Scheme], 2))
        else:
            header.edges_action.toggle()

    def zoom(self) -> None:
        low = self.dice.uniform(-20.0, 60.0)
        self.window.map.canvas.setXRange(low, low + self.dice.uniform(0.1, 60.0))
        if self.dice.random() < 0.5:
            self.window.map.canvas.fit()

    def tab(self) -> None:
        window = self.window
        tabs = self.dice.choice((window.tabs, window.curves.tabs, window.results.tabs))
        tabs.setCurrentIndex(self.dice.randrange(tabs.count()))

    def open_file(self) -> None:
        file = self.dice.choice(self.files)
        self.note(file.name)
        person(self.window).name = str(file)
        if self.dice.random() < 0.2:
            self.window.actions_table["new"].trigger()
        else:
            self.window.actions_table["open"].trigger()

    def drop_file(self) -> None:
        file = self.dice.choice(self.files)
        self.note(file.name)
        drop(self.dice.choice((self.window, self.window.setup)), QUrl.fromLocalFile(str(file)))

    def export(self) -> None:
        self.window.actions_table["export"].trigger()
        dialog = self.window._dialogs.get("export")
        if dialog is not None and self.dice.random() < 0.6:
            dialog.hide()

    def select_row(self) -> None:
        results = self.window.results
        rows = results.sorted.rowCount()
        if rows:
            results._on_row(results.sorted.index(self.dice.randrange(rows), 0))

    def fixture(self) -> None:
        setup = self.window.setup
        if self.dice.random() < 0.5:
            setup.fixtures.add("box")
        else:
            setup.fixtures.remove(self.dice.randrange(3))

    def pause(self) -> None:
        QTest.qWait(self.dice.randrange(30))

    def check(self) -> None:
        """What holds at any moment."""
        session, document, window = self.session, self.session.document, self.window
        steps, index = document._steps, document._index
        assert document.state is steps[index].state
        assert len(steps) <= HISTORY_LIMIT
        assert document.can_undo == (index > 0)
        assert document.can_redo == (index + 1 < len(steps))
        for name, can in (("undo", document.can_undo), ("redo", document.can_redo)):
            assert window.actions_table[name].isEnabled() == can
        if session.result is not None:
            planned = session._planned_state
            assert any(planned is one for one in self.ordered), "a plan of another project"
            assert session.stale == (
                (planned.cell, planned.files) != (document.state.cell, document.state.files)
            )
            assert window.map.shown.result is session.result
            assert len(session.sequence.nodes) == len(session.result.problem.toolpath)
        else:
            assert session.answer is None
            assert session.report is None
        assert 0 <= session.cursor < max(session.waypoints, 1)
        assert window.results.messages.count() <= MESSAGES + 500
        assert len(window.results._said) <= MESSAGES
        assert window.actions_table["stop"].isEnabled() == session.planning
        assert QApplication.activeModalWidget() is None

    def check_at_rest(self) -> None:
        """What holds once nothing is on its way any more."""
        session = self.session
        self.window.setUpdatesEnabled(True)
        end = time.monotonic() + PATIENCE
        wait(lambda: not session.planning or time.monotonic() > end)
        # A monkey may have asked for a sweep that takes minutes; it then stops.
        session.stop()
        settle(self.window)
        self.check()
        state = session.document.state
        try:
            state.problem()
        except PosoptError as error:
            assert str(session.problem_error) == str(error)  # noqa: PT017 - either way is sound
            assert session.problem is None
        else:
            assert session.problem_error is None
            assert session.problem is not None
        if session.result is not None and not session.stale:
            wishes = bool(state.pins or state.regions)
            assert (session.answer is not None) == wishes
            if session.answer is not None and session.answer.sequence is not None:
                for one in state.pins:
                    lean = session.sequence.angles[one.waypoint, 0]
                    assert abs(lean - one.lean) < 1e-9
        if session.document.can_undo:
            session.document.undo()
            session.document.redo()
            assert session.document.state is state
            settle(self.window)


def run(window, folder, seed, count, rest):
    """Let a monkey do so many things; what it did last stands in the failure."""
    monkey = Monkey(window, folder, seed)
    with logged_defects() as defects:
        for number in range(count):
            monkey.step()
            try:
                assert not defects
                monkey.check()
                if number % rest == rest - 1:
                    monkey.check_at_rest()
            except AssertionError as error:
                last = ", ".join(monkey.done)
                raise AssertionError(f"after {number + 1} steps, last {last}: {error}") from error
        window.session.stop()
        monkey.check_at_rest()
        assert not defects


def test_500_things_in_any_order_keep_the_window_consistent(qapp, qtbot, tmp_path):
    with opened(tmp_path, SMALL) as window:
        window.session.start()
        wait(lambda: window.session.result is not None)
        run(window, tmp_path, seed=20260101, count=500, rest=100)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(4))
def test_20000_things_in_any_order_keep_the_window_consistent(qapp, qtbot, tmp_path, seed):
    with opened(tmp_path, SMALL) as window:
        window.session.start()
        wait(lambda: window.session.result is not None)
        run(window, tmp_path, seed=seed, count=5_000, rest=250)
