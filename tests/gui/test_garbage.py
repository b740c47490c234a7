"""Parts of a window in a cycle die on the window's thread, whichever thread makes garbage."""

import gc
import threading
from weakref import finalize

import pytest
from PySide6.QtWidgets import QWidget

from posopt_gui.workers import garbage
from posopt_gui.workers.garbage import GarbageCollector

CYCLES = 20_000


class Cycle:
    def __init__(self):
        self.itself = self


def make_garbage():
    for _ in range(CYCLES):
        Cycle()


def cycle_that_tells(told):
    made = Cycle()
    finalize(made, lambda: told.append(threading.current_thread()))


@pytest.fixture
def started(qtbot):
    gc.collect()
    made = GarbageCollector()
    made.start()
    yield made
    made.stop()
    gc.disable()  # the collector of all these tests goes on


def run_on_a_thread(work):
    thread = threading.Thread(target=work)
    thread.start()
    thread.join()


def test_what_a_worker_allocates_collects_nothing_on_its_thread(started, qtbot):
    told = []
    cycle_that_tells(told)
    run_on_a_thread(make_garbage)
    assert told == []
    qtbot.waitUntil(lambda: bool(told))
    assert told == [threading.main_thread()]


def test_without_the_collector_a_worker_would_collect(started):
    told = []
    started.stop()
    cycle_that_tells(told)
    run_on_a_thread(make_garbage)
    assert told
    assert told[0] is not threading.main_thread()


def test_old_garbage_is_collected_too(started, qtbot):
    told = []
    made = Cycle()
    finalize(made, lambda: told.append(threading.current_thread()))
    gc.collect()
    del made

    def collected():
        make_garbage()
        return bool(told)

    qtbot.waitUntil(collected, timeout=60_000)


def test_nothing_is_collected_where_nothing_is_due(started):
    told = []
    gc.collect()
    cycle_that_tells(told)
    started.collect()
    assert told == []


def test_a_widget_in_a_cycle_dies_on_the_thread_of_the_window(started, qtbot):
    told = []
    widget = QWidget()
    widget.itself = widget
    finalize(widget, lambda: told.append(threading.current_thread()))
    del widget
    run_on_a_thread(make_garbage)
    assert told == []
    qtbot.waitUntil(lambda: bool(told))
    assert told == [threading.main_thread()]


def test_what_is_old_is_looked_through_again_only_when_it_has_grown(qtbot, monkeypatch):
    collected, old = [], [100]
    monkeypatch.setattr(garbage, "PAUSE", 0.0)
    monkeypatch.setattr(gc, "get_count", lambda: (9_000, 90, 90))
    monkeypatch.setattr(gc, "get_threshold", lambda: (700, 10, 10))
    monkeypatch.setattr(gc, "get_objects", lambda generation: [0] * old[0])
    monkeypatch.setattr(gc, "collect", lambda generation=2: collected.append(generation))
    made = GarbageCollector()
    for size in (100, 110, 120, 126, 150, 160):
        old[0] = size
        made.collect()
    assert collected == [2, 1, 1, 2, 1, 2]
