"""Jobs that follow a plan: one after the other, when the window has shown what was before."""

import threading
import time

import pytest

from posopt_gui.workers.follow_ups import FollowUps
from posopt_gui.workers.jobs import JobLine
from posopt_gui.workers.threads import JobThreads
from posopt_gui.workers.turns import Turns


@pytest.fixture
def turns(qtbot):
    return Turns()


@pytest.fixture
def follow_ups(turns):
    made = FollowUps(turns)
    yield made
    assert made.close(10_000)


def test_jobs_run_one_at_a_time_in_their_order_and_off_the_windows_thread(follow_ups, qtbot):
    order, together, lock = [], [], threading.Lock()

    def job(number):
        def run():
            together.append(lock.acquire(blocking=False))
            order.append((number, threading.current_thread() is threading.main_thread()))
            lock.release()

        return run

    for number in range(6):
        follow_ups.start(job(number))
    qtbot.waitUntil(lambda: len(order) == 6)
    assert order == [(number, False) for number in range(6)]
    assert all(together)


def test_no_job_begins_while_the_window_has_something_to_do(follow_ups, turns, qtbot):
    done = []

    def piece(left):
        done.append("piece")
        time.sleep(0.03)
        if left:
            turns.ask(left, lambda: piece(left - 1))

    turns.ask("first", lambda: piece(4))
    follow_ups.start(lambda: done.append("job"))
    qtbot.waitUntil(lambda: "job" in done)
    assert done == ["piece"] * 5 + ["job"]


def test_a_job_does_not_wait_for_ever_for_a_busy_window(follow_ups, turns, qtbot):
    done = []

    def piece():
        if not done:
            turns.ask("again", piece)

    turns.ask("again", piece)
    follow_ups.start(lambda: done.append("job"))
    qtbot.waitUntil(lambda: done == ["job"], timeout=60_000)


def test_the_answer_of_a_job_is_shown_before_the_next_begins(follow_ups, turns, qtbot):
    seen = []
    shown = lambda answer: turns.ask(answer, lambda: seen.append(f"shown {answer}"))  # noqa: E731
    lines = [JobLine(follow_ups, None, shown) for _ in range(3)]
    for number, line in enumerate(lines):
        line.submit(lambda _, number=number: seen.append(f"job {number}") or number)
    qtbot.waitUntil(lambda: len(seen) == 6)
    assert seen == ["job 0", "shown 0", "job 1", "shown 1", "job 2", "shown 2"]


def test_a_job_that_was_cancelled_before_it_began_does_nothing(follow_ups, qtbot):
    begun = []
    line, other = JobLine(follow_ups), JobLine(follow_ups)
    told = []
    line.done.connect(told.append)
    line.submit(lambda _: begun.append("first"))
    line.submit(lambda _: begun.append("second"))
    other.submit(lambda _: begun.append("other"))
    qtbot.waitUntil(lambda: "other" in begun and "second" in begun)
    qtbot.waitUntil(lambda: bool(told))
    assert "first" not in begun


def test_a_job_that_fails_lets_the_next_begin(follow_ups, qtbot):
    failed, done = [], []
    line = JobLine(follow_ups, None, done.append, failed.append)
    other = JobLine(follow_ups, None, done.append)

    def fails(_):
        raise ValueError("of the test")

    line.submit(fails)
    other.submit(lambda _: 2)
    qtbot.waitUntil(lambda: done == [2])
    assert [str(one) for one in failed] == ["of the test"]


def test_closing_waits_for_what_runs_and_forgets_the_rest(turns, qtbot):
    follow_ups = FollowUps(turns)
    begun, let_go = threading.Event(), threading.Event()
    forgotten = []
    follow_ups.start(lambda: (begun.set(), let_go.wait(60)))
    follow_ups.start(lambda: forgotten.append(1))
    qtbot.waitUntil(begun.is_set)
    assert not follow_ups.close(20)
    let_go.set()
    assert follow_ups.close(10_000)
    qtbot.wait(100)
    assert forgotten == []


def test_a_thread_of_the_jobs_is_found_by_who_closes_the_window(follow_ups):
    assert follow_ups.findChildren(JobThreads)
