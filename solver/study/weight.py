"""The heuristic's weight by sampling, with the edges of the published range and of the cost."""

from __future__ import annotations

from typing import Literal

from solver.search.heuristic_weight import sample_heuristic_weight
from solver.study.context import Study
from solver.study.sections import Column, Section, StudyTable, Value

EDGES: tuple[tuple[Literal["l2", "l1"], str], ...] = (
    ("l2", "Euclidean (L2)"),
    ("l1", "absolute (L1, the cost)"),
)


def weight(study: Study) -> Section:
    """Ratio of graph distance to direct distance over random pairs, for several seeds."""
    parameters = study.parameters
    rows: list[tuple[Value, ...]] = []
    span: dict[str, tuple[float, float]] = {}
    for edge, title in EDGES:
        found = [
            sample_heuristic_weight(
                study.result.graph, parameters.weight_pairs, seed, edge, study.monitor
            )
            for seed in parameters.weight_seeds
        ]
        rows += [
            (title, seed, one.ratio_min, one.ratio_max, one.weight)
            for seed, one in zip(parameters.weight_seeds, found, strict=True)
        ]
        span[edge] = (min(one.ratio_min for one in found), max(one.ratio_max for one in found))
    table = StudyTable(
        "weight",
        f"Ratios over {parameters.weight_pairs} random pairs",
        (
            Column("edges"),
            Column("seed"),
            Column("least ratio", "", 3),
            Column("largest ratio", "", 3),
            Column("weight", "", 3),
        ),
        tuple(rows),
    )
    text = [
        f"With L2 edges the ratios lie between {span['l2'][0]:.2f} and {span['l2'][1]:.2f}, with "
        f"the L1 edges of the cost between {span['l1'][0]:.2f} and {span['l1'][1]:.2f}. An L1 "
        "edge is never shorter than an L2 one, so every weight up to one is admissible without "
        "any sampling.",
    ]
    if study.is_published_cell:
        low, high = study.published.weight_ratio
        text.append(
            f"The published range, {low:.2f} to {high:.2f}, appears with L2 edges alone, although "
            "the cost's edges are L1."
        )
    numbers = {edge: {"least": low, "largest": high} for edge, (low, high) in span.items()}
    return Section("weight", "Weight of the heuristic", tuple(text), (table,), numbers=numbers)
