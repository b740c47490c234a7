"""Standard and improved search on every beam of the paper, published values beside."""

from __future__ import annotations

import numpy as np

from solver.analysis.result import PlanningResult
from solver.model.settings import Scheme
from solver.pipeline.planning import paper_sequence
from solver.progress import SilentMonitor
from solver.search.bottleneck import best_minimum_clearance
from solver.study.context import Study
from solver.study.published import PublishedRun
from solver.study.schemes import millimetres
from solver.study.sections import Column, Section, StudyTable, Value, counted, percent
from solver.units import MM_PER_M, MS_PER_S


def beams(study: Study) -> Section:
    """F and f2 on all beams, what each could keep at best, and the means that are published."""
    published = {one.name: one for one in study.published.beams}
    rows: list[tuple[Value, ...]] = []
    reasons = []
    changes: list[tuple[float, float]] = []
    for name in sorted(study.published.beam_names):
        result = study.on_beam(name)
        if isinstance(result, str):
            reasons.append(f"{name}: {result}")
            rows.append((name, *[None] * 14))
            continue
        known = published.get(name) if study.is_published_cell else None
        times = [_search_time(study, result, scheme) for scheme in (Scheme.F, Scheme.F2)]
        rows.append((name, *_measured(result), *times, *_known(known)))
        if name in published:
            f, f2 = result.sequences[Scheme.F], result.sequences[Scheme.F2]
            changes.append(
                (
                    f2.mean_clearance / f.mean_clearance - 1.0,
                    f2.least_clearance / f.least_clearance - 1.0,
                )
            )
    if not changes:
        return Section(
            "beams", "Beams", reason="the cell takes none of the other beams: " + "; ".join(reasons)
        )
    table = StudyTable(
        "beams",
        "Standard (f) and improved (f2) search on other beams",
        (
            Column("beam"),
            Column("f least clearance", "mm", 1),
            Column("f mean clearance", "mm", 1),
            Column("f expanded"),
            Column("f2 least clearance", "mm", 1),
            Column("f2 mean clearance", "mm", 1),
            Column("f2 expanded"),
            Column("f joint cost", "", 5),
            Column("f2 joint cost", "", 5),
            Column("best reachable minimum", "mm", 1),
            Column("f search time", "ms", 2, timing=True),
            Column("f2 search time", "ms", 2, timing=True),
            Column("published f least clearance", "mm", 1),
            Column("published f mean clearance", "mm", 1),
            Column("published f search time", "ms", 0),
        ),
        tuple(rows),
        " ".join(reasons),
    )
    mean, least = np.mean(changes, axis=0)
    numbers = {
        "mean_clearance_change": float(mean),
        "least_clearance_change": float(least),
        "beams": len(changes),
    }
    text = [
        f"Over {counted(len(changes), 'other beam')} f2 raises the mean clearance by "
        f"{percent(float(mean))} and the least by {percent(float(least))}.",
        _reach_words(study, table),
    ]
    if study.is_published_cell:
        improved = study.published.improved
        text.append(
            f"Published are {percent(improved['mean_clearance_change'])} and "
            f"{percent(improved['least_clearance_change'])}, and "
            f"{percent(improved['search_time_change'])} search time; of the improved search on the "
            "single beams no values are public. Beam and path of the other sections are placed by "
            "the rule of the cell, which is an assumption."
        )
    return Section("beams", "Beams", tuple(text), (table,), numbers=numbers)


def _measured(result: PlanningResult) -> tuple[Value, ...]:
    f, f2 = result.sequences[Scheme.F], result.sequences[Scheme.F2]
    best = best_minimum_clearance(result.graph, result.candidates.nodes.clearance)
    return (
        f.least_clearance * MM_PER_M,
        f.mean_clearance * MM_PER_M,
        f.expanded,
        f2.least_clearance * MM_PER_M,
        f2.mean_clearance * MM_PER_M,
        f2.expanded,
        f.joint_cost,
        f2.joint_cost,
        best * MM_PER_M,
    )


def _search_time(study: Study, result: PlanningResult, scheme: Scheme) -> float:
    candidates, graph, silent = result.candidates, result.graph, SilentMonitor()
    seconds = study.timed(lambda: paper_sequence(candidates, graph, scheme, silent))
    return seconds * MS_PER_S


def _known(run: PublishedRun | None) -> tuple[Value, ...]:
    if run is None:
        return None, None, None
    return (
        millimetres(run.least_clearance),
        millimetres(run.mean_clearance),
        run.search_time * MS_PER_S if run.search_time is not None else None,
    )


def _reach_words(study: Study, table: StudyTable) -> str:
    safe = study.problem.settings.safety_distance * MM_PER_M
    names = [
        str(row[0])
        for row, best in zip(table.rows, table.column("best reachable minimum"), strict=True)
        if isinstance(best, float) and best < safe
    ]
    if not names:
        return f"On every beam some sequence keeps {safe:g} mm."
    return f"No sequence at all keeps {safe:g} mm on {', '.join(names)}, whatever the search."
