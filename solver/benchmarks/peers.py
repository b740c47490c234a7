"""`posopt bench --peers`: searches, inverse kinematics and distances beside those of others."""

from __future__ import annotations

import statistics
import tempfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from solver.benchmarks.peers_distance import DistanceTiming, time_distances
from solver.benchmarks.peers_graphs import CELL, GraphSize
from solver.benchmarks.peers_kinematics import KinematicsTiming, time_kinematics
from solver.benchmarks.peers_process import Answer, Bounds, Outcome, run_child
from solver.benchmarks.peers_search import GET_PEERS, SEARCHERS, Searcher, installed
from solver.catalog import load_cell
from solver.errors import PosoptError


@dataclass(frozen=True, slots=True)
class SearchTiming:
    """One search of one graph: medians of processor time [s], memory [bytes], and its cost.

    `build` is what the search needs before it can begin, such as the list of edges; `peak_bytes`
    the growth of resident memory over the loaded graph. `ratio` is the time of both over that
    of the first search, `cost_difference` the cost over the first search's. Where nothing was
    finished these are None.
    """

    search: str
    outcome: Outcome
    note: str
    runs: int
    build: float | None = None
    solve: float | None = None
    peak_bytes: int | None = None
    cost: float | None = None
    ratio: float | None = None
    cost_difference: float | None = None


@dataclass(frozen=True, slots=True)
class GraphTiming:
    """One graph: its size, wall times [s] of its candidates and of the exact search, searches.

    The exact search is that of every node, whose two directions can run at the same time.

    `peak_bytes` is the growth of resident memory while the candidates were generated.
    """

    size: GraphSize
    nodes: int
    edges: int
    widest_layer: int
    threads: int
    one_thread: float | None
    all_threads: float | None
    exact_one_thread: float | None
    exact_two_threads: float | None
    peak_bytes: int
    searches: tuple[SearchTiming, ...]


@dataclass(frozen=True, slots=True)
class PeerTables:
    """Everything that one run measured."""

    cell: str
    bounds: Bounds
    graphs: tuple[GraphTiming, ...]
    kinematics: tuple[KinematicsTiming, ...]
    distances: tuple[DistanceTiming, ...]


def measure_peers(
    sizes: Sequence[GraphSize],
    bounds: Bounds,
    *,
    small: bool = False,
    cell: str = CELL,
    tell: Callable[[str], None] = lambda _: None,
) -> PeerTables:
    """Measure all tables; `tell` is given a line when a part begins.

    `small` takes few poses and pairs, to see that everything runs. `cell` is a shipped cell or
    a cell's file.

    Raises
    ------
    InputError
        If the cell cannot be read.
    """
    problem = load_cell(cell)
    graphs = tuple(time_graph(size, bounds, tell, cell) for size in sizes)
    tell("inverse kinematics")
    kinematics = time_kinematics(problem, bounds.repeats, small=small)
    tell("distances")
    distances = time_distances(problem, bounds.repeats, small=small)
    return PeerTables(problem.name, bounds, graphs, tuple(kinematics), tuple(distances))


def time_graph(
    size: GraphSize, bounds: Bounds, tell: Callable[[str], None], cell: str = CELL
) -> GraphTiming:
    """Generate one graph and search it by every means, each in a process of its own."""
    with tempfile.TemporaryDirectory(prefix="posopt-") as folder:
        file = Path(folder) / "graph.npz"
        tell(f"graph {size}: candidates")
        job = {
            "job": "candidates",
            "cell": cell,
            "size": [size.waypoints, size.leans, size.leads, size.branches],
            "graph": str(file),
        }
        few = replace(bounds, repeats=min(bounds.repeats, 5))
        answer = run_child(job, few)
        if not answer.lines:
            raise PosoptError(
                f"the graph {size} could not be generated: {answer.outcome.value} {answer.note}"
            )
        facts, *runs = answer.lines
        searches = tuple(_compared(list(_searches(file, size, bounds, tell))))
    return GraphTiming(
        size=replace(size, waypoints=facts["waypoints"]),
        nodes=facts["nodes"],
        edges=facts["edges"],
        widest_layer=facts["widest_layer"],
        threads=facts["threads"],
        one_thread=median_of(runs, "one_thread"),
        all_threads=median_of(runs, "all_threads"),
        exact_one_thread=median_of(runs, "exact_one_thread"),
        exact_two_threads=median_of(runs, "exact_two_threads"),
        peak_bytes=facts["peak_bytes"],
        searches=searches,
    )


def _searches(
    file: Path, size: GraphSize, bounds: Bounds, tell: Callable[[str], None]
) -> Iterator[SearchTiming]:
    for one in SEARCHERS:
        if not installed(one.package):
            yield SearchTiming(one.name, Outcome.MISSING, GET_PEERS, 0)
            continue
        tell(f"graph {size}: {one.name}")
        job = {"job": "search", "search": one.name, "graph": str(file)}
        yield _timing(one, run_child(job, bounds))


def _timing(one: Searcher, answer: Answer) -> SearchTiming:
    """One row; runs that were finished count even where a later one met a bound."""
    if not answer.lines:
        return SearchTiming(one.name, answer.outcome, answer.note, 0)
    return SearchTiming(
        search=one.name,
        outcome=Outcome.FINISHED,
        note="",
        runs=len(answer.lines),
        build=median_of(answer.lines, "build"),
        solve=median_of(answer.lines, "search"),
        peak_bytes=max(line["peak_bytes"] for line in answer.lines),
        cost=answer.lines[0]["cost"],
    )


def _compared(rows: list[SearchTiming]) -> Iterator[SearchTiming]:
    """Set the ratio and the difference of cost to the first row."""
    first = rows[0]
    for row in rows:
        ratio = difference = None
        if row.build is not None and row.solve is not None:
            if first.build is not None and first.solve is not None:
                ratio = (row.build + row.solve) / (first.build + first.solve)
            if row.cost is not None and first.cost is not None:
                difference = row.cost - first.cost
        yield replace(row, ratio=ratio, cost_difference=difference)


def median_of(lines: Sequence[dict[str, Any]], key: str) -> float | None:
    """Median of a value over the runs, None without a run."""
    return statistics.median([line[key] for line in lines]) if lines else None
