"""The tables of `posopt bench --peers` as JSON and as lines for people."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

from solver.benchmarks.peers import GraphTiming, PeerTables, SearchTiming
from solver.benchmarks.peers_distance import DistanceTiming
from solver.benchmarks.peers_kinematics import KinematicsTiming
from solver.units import MM_PER_M, MS_PER_S

US_PER_S = 1e6
BYTES_PER_MB = 1e6


def peers_document(tables: PeerTables) -> dict[str, Any]:
    """Everything as plain values: times in [s], lengths in [m], memory in bytes."""
    return {
        "format": "posopt-bench",
        "version": 1,
        "cell": tables.cell,
        "bounds": asdict(tables.bounds),
        "graphs": [_graph_document(one) for one in tables.graphs],
        "kinematics": [asdict(one) for one in tables.kinematics],
        "distances": [asdict(one) for one in tables.distances],
    }


def _graph_document(graph: GraphTiming) -> dict[str, Any]:
    document = asdict(graph)
    document["size"] = {**asdict(graph.size), "candidates": graph.size.candidates}
    document["searches"] = [{**asdict(one), "outcome": one.outcome.value} for one in graph.searches]
    return document


def peers_lines(tables: PeerTables) -> Iterator[str]:
    """All tables as Markdown, with a sentence on what the numbers are."""
    bounds = tables.bounds
    yield (
        f"Medians of processor time of one thread, at most {bounds.repeats} runs. A search runs in "
        f"a process of its own with at most {bounds.seconds:g} s and "
        f"{bounds.memory / 1e9:g} GB; memory is the growth of its resident memory, at its peak, "
        "over the loaded graph."
    )
    for graph in tables.graphs:
        yield ""
        yield from _graph_lines(tables.cell, graph)
    yield ""
    yield from _kinematics_lines(tables.kinematics)
    yield ""
    yield from _distance_lines(tables.distances)


def _graph_lines(cell: str, graph: GraphTiming) -> Iterator[str]:
    yield (
        f"{cell}, {graph.size}: {graph.size.candidates:,} candidates, {graph.nodes:,} nodes, "
        f"{graph.edges:,} edges, at most {graph.widest_layer:,} nodes a layer"
    )
    if graph.one_thread is not None and graph.all_threads is not None:
        yield (
            f"candidates in {_time(graph.one_thread)} on one thread, "
            f"{_time(graph.all_threads)} on {graph.threads} (wall time, "
            f"{graph.one_thread / graph.all_threads:.2f} times as fast), "
            f"{_memory(graph.peak_bytes)}"
        )
    if graph.exact_one_thread is not None and graph.exact_two_threads is not None:
        yield (
            f"exact search of every node in {_time(graph.exact_one_thread)} on one thread, "
            f"{_time(graph.exact_two_threads)} on two (wall time, "
            f"{graph.exact_one_thread / graph.exact_two_threads:.2f} times as fast)"
        )
    yield ""
    heads = ("search", "runs", "build", "search alone", "ratio", "memory", "cost", "cost - exact")
    yield from _table(heads, [_search_row(one) for one in graph.searches])


def _search_row(one: SearchTiming) -> tuple[str, ...]:
    if one.build is None or one.solve is None or one.peak_bytes is None:
        text = f"{one.outcome.value}{f' ({one.note})' if one.note else ''}"
        return (one.search, text, *[""] * 6)
    cost = "no sequence" if one.cost is None else f"{one.cost:.9f}"
    apart = "" if one.cost_difference is None else f"{one.cost_difference:.1e}"
    build = "-" if one.build < 1e-4 else _time(one.build)
    return (
        one.search,
        str(one.runs),
        build,
        _time(one.solve),
        _ratio(one.ratio),
        _memory(one.peak_bytes),
        cost,
        apart,
    )


def _kinematics_lines(rows: tuple[KinematicsTiming, ...]) -> Iterator[str]:
    yield f"Inverse kinematics, all branches of {rows[0].poses:,} flange poses of the cell"
    yield ""
    heads = ("method", "a pose", "ratio", "solutions", "residual", "unmatched", "difference [rad]")
    yield from _table(
        heads,
        [
            (one.method, one.note, *[""] * 5)
            if one.per_pose is None
            else (
                one.method,
                f"{US_PER_S * one.per_pose:.2f} us",
                _ratio(one.ratio),
                f"{one.solutions:,}",
                f"{one.residual:.1e}",
                "" if one.unmatched is None else f"{one.unmatched:,}",
                "" if one.difference is None else f"{one.difference:.1e}",
            )
            for one in rows
        ],
    )


def _distance_lines(rows: tuple[DistanceTiming, ...]) -> Iterator[str]:
    yield (
        "Distances of convex bodies; errors against proven bounds that are at most "
        f"{MM_PER_M * max(one.known_to for one in rows):.1e} mm apart"
    )
    yield ""
    heads = ("pairs", "method", "number", "a pair", "ratio", "over by up to", "by more than 1 um")
    yield from _table(
        (*heads, "under by up to"),
        [
            (one.pairs_of, one.method, one.note, *[""] * 5)
            if one.per_pair is None or one.over is None or one.under is None
            else (
                one.pairs_of,
                one.method,
                f"{one.pairs:,}",
                f"{US_PER_S * one.per_pair:.2f} us",
                _ratio(one.ratio),
                f"{MM_PER_M * one.over:.3g} mm",
                f"{one.overstated:,}",
                f"{MM_PER_M * one.under:.3g} mm",
            )
            for one in rows
        ],
    )


def _table(heads: tuple[str, ...], rows: list[tuple[str, ...]]) -> Iterator[str]:
    yield f"| {' | '.join(heads)} |"
    yield "|---" * len(heads) + "|"
    for row in rows:
        yield f"| {' | '.join(row)} |"


def _time(value: float) -> str:
    return f"{value:,.2f} s" if value >= 1.0 else f"{MS_PER_S * value:.3g} ms"


def _memory(value: int) -> str:
    return f"{value / BYTES_PER_MB:,.1f} MB"


def _ratio(value: float | None) -> str:
    if value is None:
        return ""
    return f"{value:,.0f}" if value >= 100.0 else f"{value:.3g}"
