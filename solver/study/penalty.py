"""The penalty of f2 as a hard filter, and where it makes the search look at more nodes."""

from __future__ import annotations

import numpy as np

from solver.analysis.result import PlanningResult
from solver.costs.penalty import safety_penalty
from solver.model.settings import Scheme
from solver.search import paper
from solver.study.context import Study, plain_graph
from solver.study.sections import Column, Section, StudyTable, Value
from solver.units import MM_PER_M

SAME_COST = 1e-9


def penalty(study: Study) -> Section:
    """On every beam: f2 beside f1 on the nodes that keep the safety distance alone."""
    rows: list[tuple[Value, ...]] = []
    equal, more = [], []
    for name in sorted({*study.published.beam_names, study.problem.workpiece.name}):
        result = study.on_beam(name)
        if isinstance(result, str):
            continue
        row = _compared(result)
        rows.append((name, *row))
        layers, f1, f2, _, same, *_ = row
        if same:
            equal.append(name)
        if isinstance(f1, int) and isinstance(f2, int) and f2 > f1:
            more.append(f"{name} ({f1:,} to {f2:,}, layers without a safe node: {layers})")
    table = StudyTable(
        "penalty",
        "f2 beside f1 on the nodes that keep the safety distance",
        (
            Column("beam"),
            Column("layers without a safe node"),
            Column("f1 expanded"),
            Column("f2 expanded"),
            Column("filtered f1 expanded"),
            Column("same sequence and cost"),
            Column("f2 objective", "", 4),
            Column("of it joint cost", "", 4),
        ),
        tuple(rows),
    )
    scale = _scale(study)
    text = (
        "Deleting every node under the safety distance and running f1 gives the same sequence, "
        f"cost and count of expanded nodes as f2 on {', '.join(equal) or 'none of the beams'}: "
        "wherever a safe sequence exists the penalty acts as a filter, which is simpler and says "
        "what it does.",
        "That f2 expands fewer nodes is a property of the scene. It expands more than f1 on "
        f"{'; '.join(more)}. Where a layer holds no safe node, every sequence carries penalties "
        "that the heuristic knows nothing of."
        if more
        else "f2 expands no more nodes than f1 on any of these beams.",
        f"As an objective the penalty is crude: one pose at the safety distance already costs "
        f"{scale['at_distance']:.0f} where the whole motion of f1 costs {scale['motion']:.2f}, and "
        f"one touching pose costs {scale['touching']:.2f}, beside {scale['poses']:.0f} poses that "
        f"are {scale['near_mm']:g} mm too near with {scale['near']:.2f}. It also grows with the "
        "number of waypoints on the same path.",
    )
    numbers = {"equal": equal, "more_expanded": [one.split(" ")[0] for one in more], **scale}
    return Section("penalty", "The penalty is a hard filter", text, (table,), numbers=numbers)


def _compared(result: PlanningResult) -> tuple[Value, ...]:
    """The columns of the table after the beam's name."""
    settings, clearance = result.problem.settings, result.candidates.nodes.clearance
    graph = plain_graph(result.graph)
    f1, f2 = result.sequences[Scheme.F1], result.sequences[Scheme.F2]
    reduced, parent = graph.subgraph(clearance >= settings.safety_distance)
    empty = int(np.count_nonzero(np.diff(reduced.offsets) == 0))
    filtered, same = None, False
    if not empty:
        found = paper.f1(reduced, settings.heuristic_weight)
        filtered = found.expanded
        same = (
            found.found
            and np.array_equal(parent[found.path], f2.nodes)
            and abs(found.cost - f2.cost) <= SAME_COST
            and found.expanded == f2.expanded
        )
    return (empty, f1.expanded, f2.expanded, filtered, bool(same), f2.cost, f2.joint_cost)


def _scale(study: Study) -> dict[str, float]:
    """Penalties of a few poses beside the cost of the whole motion."""
    safe, parameters = study.problem.settings.safety_distance, study.parameters
    poses, depth = parameters.penalty_poses, parameters.penalty_near
    at_distance, touching, near = safety_penalty(
        [np.nextafter(safe, 0.0), 0.0, max(safe - depth, 0.0)], safe
    )
    return {
        "motion": study.sequence(Scheme.F1).joint_cost,
        "at_distance": float(at_distance),
        "touching": float(touching),
        "poses": float(poses),
        "near_mm": depth * MM_PER_M,
        "near": poses * float(near),
    }
