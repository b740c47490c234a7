"""Both directions of the exact search at the same time: the same bytes, and no thread left."""

import threading
import time

import numpy as np
import pytest
from search_oracles import StoppingMonitor, random_graph

from solver.errors import Cancelled
from solver.search import exact as module
from solver.search.exact import exact
from solver.search.graph import LayeredGraph


def wide_graph(seed, sizes):
    random = np.random.default_rng(seed)
    count = sum(sizes)
    return LayeredGraph(
        np.concatenate([[0], np.cumsum(sizes)]),
        random.normal(size=(count, 6)),
        np.full(6, 3.0),
        random.uniform(size=count),
        np.ones(len(sizes) - 1),
    )


GRAPHS = [
    wide_graph(1, [300] * 60),
    wide_graph(2, [2500, 1, 2600, 40]),
    wide_graph(3, [5, 0, 7]),
    wide_graph(4, [9]),
    random_graph(5, layers=40, limits=True),
]


@pytest.fixture(autouse=True)
def no_thread_is_left():
    before = set(threading.enumerate())
    yield
    assert set(threading.enumerate()) <= before


@pytest.mark.parametrize("graph", GRAPHS, ids=lambda graph: f"{graph.edge_count} edges")
def test_two_threads_give_the_bytes_of_one(graph):
    one, two = exact(graph, threads=1), exact(graph, threads=2)
    assert one.cost == two.cost
    for name in ("path", "cost_so_far", "cost_to_go"):
        assert getattr(one, name).tobytes() == getattr(two, name).tobytes()


def test_a_large_graph_takes_two_threads_and_a_small_one_stays_in_one(monkeypatch):
    taken = []
    both = module._carry_both
    monkeypatch.setattr(module, "_carry_both", lambda *given: taken.append(1) or both(*given))
    exact(wide_graph(1, [100] * 20))
    assert not taken
    graph = wide_graph(1, [2500, 2500])
    assert graph.edge_count > module.THREADED_WORK
    exact(graph)
    assert taken == [1]


def test_progress_of_both_rises_to_its_end():
    monitor = StoppingMonitor()
    exact(wide_graph(1, [1500] * 12), monitor, threads=2)
    done = [part for _, part, _ in monitor.reports]
    totals = {total for _, _, total in monitor.reports}
    assert done == sorted(done)
    assert totals == {done[-1]}
    alone = StoppingMonitor()
    exact(wide_graph(1, [1500] * 12), alone, threads=1)
    assert alone.reports[-1] == monitor.reports[-1]


@pytest.mark.parametrize("question", [1, 2, 3, 6])
def test_cancelling_at_any_question_ends_both(question):
    monitor = StoppingMonitor(question)
    with pytest.raises(Cancelled):
        exact(wide_graph(1, [1500] * 12), monitor, threads=2)
    assert monitor.asked == question


def slow_direction(monkeypatch, forward):
    """One direction takes for ever, until its monitor is told to stop."""
    carry = module.carry

    def slow(graph, values, progress, **options):
        if options.get("forward", True) is not forward:
            carry(graph, values, progress, **options)
            return
        while True:
            time.sleep(0.001)
            progress.add(0)

    monkeypatch.setattr(module, "carry", slow)


@pytest.mark.parametrize("forward", [True, False])
def test_the_monitor_is_asked_while_one_direction_waits_for_the_other(monkeypatch, forward):
    slow_direction(monkeypatch, forward)
    monitor = StoppingMonitor(40)
    with pytest.raises(Cancelled):
        exact(wide_graph(1, [10, 10]), monitor, threads=2)


class BrokenError(RuntimeError):
    """Something that goes wrong inside."""


@pytest.mark.parametrize("forward", [True, False])
def test_what_goes_wrong_in_either_direction_ends_the_other_and_is_raised(monkeypatch, forward):
    slow_direction(monkeypatch, not forward)
    carry = module.carry

    def broken(graph, values, progress, **options):
        if options.get("forward", True) is forward:
            raise BrokenError
        carry(graph, values, progress, **options)

    monkeypatch.setattr(module, "carry", broken)
    with pytest.raises(BrokenError):
        exact(wide_graph(1, [10, 10]), threads=2)


@pytest.mark.parametrize("method", ["report", "cancelled"])
def test_a_monitor_that_fails_ends_both(monkeypatch, method):
    monitor = StoppingMonitor()
    slow_direction(monkeypatch, False)

    def fails(*_):
        raise KeyboardInterrupt

    setattr(monitor, method, fails)
    with pytest.raises(KeyboardInterrupt):
        exact(wide_graph(1, [10, 10]), monitor, threads=2)
