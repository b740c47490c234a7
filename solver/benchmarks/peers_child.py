"""One measurement in a process of its own, with bounds on processor time and memory (Linux).

``python -m solver.benchmarks.peers_child '{"job": ...}'`` prints one JSON object a line, each
flushed at once: what was finished before a bound was met is not lost.
"""

from __future__ import annotations

import json
import math
import sys
import time
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

from solver.benchmarks.measure import LEAST_TIME
from solver.benchmarks.peers_graphs import (
    SMALL_SIZES,
    GraphSize,
    joint_cost_graph,
    load_graph,
    save_graph,
    sized_problem,
    thinned,
)
from solver.benchmarks.peers_search import searcher
from solver.candidates.generate import generate, usable_cores
from solver.catalog import load_cell
from solver.search.exact import exact

OUT_OF_MEMORY = 3
"""Exit code where the bound on memory was met."""


def main(text: str) -> int:
    """Do the job that a JSON text describes."""
    job = json.loads(text)
    bound_memory(int(job["memory"]))
    try:
        measure_candidates(job) if job["job"] == "candidates" else measure_search(job)
    except MemoryError:
        return OUT_OF_MEMORY
    return 0


def measure_candidates(job: Mapping[str, Any]) -> None:
    """Generate and search a graph on one thread and on several, and write the graph."""
    cell = load_cell(job["cell"])
    exact(thinned(joint_cost_graph(generate(sized_problem(cell, SMALL_SIZES[0])))))
    problem = sized_problem(cell, GraphSize(*job["size"]))
    before = start_memory()
    candidates = generate(problem)
    peak = peak_memory() - before
    graph = joint_cost_graph(candidates)
    save_graph(graph, Path(job["graph"]))
    sizes = graph.layer_sizes
    say(
        waypoints=graph.layer_count,
        nodes=graph.node_count,
        edges=graph.edge_count,
        widest_layer=int(sizes.max()),
        peak_bytes=peak,
        threads=usable_cores(),
    )
    del candidates
    bound_time(job["seconds"])
    for _ in range(job["repeats"]):
        alone = wall_time(partial(generate, problem, threads=1))
        together = wall_time(partial(generate, problem, threads=usable_cores()))
        say(
            one_thread=alone,
            all_threads=together,
            exact_one_thread=wall_time(partial(exact, graph, threads=1)),
            exact_two_threads=wall_time(partial(exact, graph, threads=2)),
        )


def measure_search(job: Mapping[str, Any]) -> None:
    """Build and search a graph, again and again within the time that is allowed.

    The time is that of the thread: under a bound on processor time the kernel tells the time of
    the process by ticks of some milliseconds only.
    """
    method = searcher(job["search"])
    graph = load_graph(Path(job["graph"]))
    method.prepare(thinned(graph))()
    before = start_memory()
    bound_time(job["seconds"])
    times: list[float] = []
    while enough_time(times, job):
        started = time.thread_time()
        solve = method.prepare(graph)
        built = time.thread_time()
        cost = solve()
        ended = time.thread_time()
        del solve
        times.append(ended - started)
        say(
            build=built - started,
            search=ended - built,
            cost=cost if math.isfinite(cost) else None,
            peak_bytes=peak_memory() - before,
        )


def enough_time(times: list[float], job: Mapping[str, Any]) -> bool:
    """Whether another run is wanted: as many as asked, more of a short one, fewer of a long one."""
    if not times:
        return True
    spent = sum(times)
    if spent + max(times) > job["seconds"] / 4.0:
        return False
    return len(times) < job["repeats"] or (spent < LEAST_TIME and len(times) < 100 * job["repeats"])


def wall_time(action: Callable[[], object]) -> float:
    """Time of one run on the clock [s]."""
    started = time.perf_counter()
    action()
    return time.perf_counter() - started


def bound_memory(limit: int) -> None:
    """Let allocations beyond `limit` [bytes] of private memory fail."""
    import resource  # noqa: PLC0415 - there is none on Windows

    resource.setrlimit(resource.RLIMIT_DATA, (limit, limit))


def bound_time(limit: float) -> None:
    """End this process once it has used so much more processor time [s]."""
    import resource  # noqa: PLC0415 - there is none on Windows

    stop = math.ceil(time.process_time() + limit)
    resource.setrlimit(resource.RLIMIT_CPU, (stop, stop + 5))


def start_memory() -> int:
    """Resident memory now [bytes]; its peak is counted from here on."""
    Path("/proc/self/clear_refs").write_text("5", encoding="ascii")
    return status("VmRSS")


def peak_memory() -> int:
    """Largest resident memory since :func:`start_memory` [bytes]."""
    return status("VmHWM")


def status(key: str) -> int:
    """A memory figure of this process [bytes]."""
    for line in Path("/proc/self/status").read_text(encoding="ascii").splitlines():
        if line.startswith(f"{key}:"):
            return 1024 * int(line.split()[1])
    raise OSError(f"/proc/self/status has no {key}")


def say(**values: Any) -> None:
    """Print one object a line."""
    print(json.dumps(values), flush=True)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
