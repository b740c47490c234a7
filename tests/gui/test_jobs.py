"""Jobs off the window's thread: the newest answer counts, cancelled ones stay silent."""

import threading

import pytest
import shiboken6
from PySide6.QtCore import QObject

from posopt_gui.workers.jobs import JobLine
from posopt_gui.workers.threads import JobThreads
from solver.errors import Cancelled, InputError


@pytest.fixture
def line(qtbot):
    pool = JobThreads(2)
    made = JobLine(pool)
    yield made
    made.close()
    assert pool.wait(10_000)


def test_an_answer_comes_on_the_threads_of_the_window(line, qtbot):
    seen = []
    line.done.connect(lambda answer: seen.append((answer, threading.current_thread())))
    line.submit(lambda _: 41 + 1)
    qtbot.waitUntil(lambda: bool(seen))
    assert seen == [(42, threading.main_thread())]


def test_only_the_newest_of_many_answers_is_told(line, qtbot):
    seen = []
    line.done.connect(seen.append)
    for number in range(50):
        line.submit(lambda _, number=number: number)
    qtbot.waitUntil(lambda: 49 in seen)
    assert seen[-1] == 49
    assert not line.busy


def test_a_newer_job_cancels_the_older_one(line, qtbot):
    started = threading.Event()

    def endless(monitor):
        started.set()
        while not monitor.cancelled():
            pass
        raise Cancelled

    seen = []
    line.done.connect(seen.append)
    line.submit(endless)
    assert started.wait(5.0)
    line.submit(lambda _: "second")
    qtbot.waitUntil(lambda: seen == ["second"])


def test_stop_is_silent_and_ends_being_busy(line, qtbot):
    started = threading.Event()

    def endless(monitor):
        started.set()
        while not monitor.cancelled():
            pass
        return "late"

    told = []
    line.done.connect(told.append)
    line.failed.connect(told.append)
    states = []
    line.busy_changed.connect(states.append)
    line.submit(endless)
    assert started.wait(5.0)
    line.stop()
    assert not line.busy
    with qtbot.waitSignal(line.done):
        line.submit(lambda _: "next")
    assert told == ["next"]
    assert states[:2] == [True, False]


def test_an_error_is_handed_over(line, qtbot):
    def refuse(_):
        raise InputError("no")

    with qtbot.waitSignal(line.failed) as told:
        line.submit(refuse)
    assert isinstance(told.args[0], InputError)


def test_progress_of_a_dropped_job_is_not_told(line, qtbot):
    reports = []
    line.progress.connect(lambda *args: reports.append(args))

    def work(monitor):
        monitor.report("stage", 1, 1)

    with qtbot.waitSignal(line.done):
        line.submit(work)
    assert reports == [("stage", 1, 1)]
    line.close()
    line.submit(work)
    assert reports == [("stage", 1, 1)]


def test_a_job_that_waits_for_a_cancelled_one_is_busy_until_it_is_stopped_as_well(line, qtbot):
    started, free = threading.Event(), threading.Event()

    def slow(monitor):
        started.set()
        assert free.wait(10.0)
        raise Cancelled

    states, told = [], []
    line.busy_changed.connect(states.append)
    line.done.connect(told.append)
    line.submit(slow)
    assert started.wait(5.0)
    line.submit(lambda _: "second")
    assert line.busy
    line.stop()
    assert not line.busy
    line.submit(lambda _: "third")
    assert line.busy
    line.stop()
    assert states == [True, False, True, False]
    free.set()
    with qtbot.waitSignal(line.done):
        line.submit(lambda _: "fourth")
    assert told == ["fourth"]
    assert states == [True, False, True, False, True, False]


def test_destroying_a_view_does_not_wait_for_its_job():
    begun, let_go, ended = threading.Event(), threading.Event(), threading.Event()
    view = QObject()
    line = JobLine(JobThreads(1, view), view)

    def job(_):
        begun.set()
        let_go.wait(60)
        ended.set()

    line.submit(job)
    assert begun.wait(60)
    # As Python does with the last reference: the interpreter stays in the hand that destroys.
    shiboken6.delete(view)
    assert not ended.is_set()
    let_go.set()
    assert ended.wait(60)


def test_idle_threads_end_with_the_view_that_had_them(qtbot):
    view = QObject()
    threads = JobThreads(1, view)
    running = []
    threads.start(lambda: running.append(threading.current_thread()))
    qtbot.waitUntil(lambda: bool(running))
    assert running[0].is_alive()
    shiboken6.delete(view)
    running[0].join(60)
    assert not running[0].is_alive()
    assert threads is not None


def test_waiting_for_threads_says_whether_they_have_ended():
    let_go = threading.Event()
    threads = JobThreads(1)
    assert threads.wait()
    threads.start(lambda: let_go.wait(60))
    assert not threads.wait(20)
    let_go.set()
    assert threads.wait(60_000)
