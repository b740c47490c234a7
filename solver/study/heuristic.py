"""How loose the paper's heuristic is, and admissible ones that are better."""

from __future__ import annotations

import numpy as np

from solver.costs.penalty import safety_penalty
from solver.model.settings import Scheme
from solver.search.exact import exact
from solver.search.graph import LayeredGraph
from solver.search.paper import heuristic_values
from solver.study.astar import astar
from solver.study.context import Study, plain_graph
from solver.study.sections import Column, Section, StudyTable, Value
from solver.transforms import FloatArray
from solver.units import MS_PER_S

GOAL_TILE = 512


def nearest_goal(graph: LayeredGraph) -> FloatArray:
    """(K,) least L1 distance of range-normalised joints to the last layer.

    By the triangle inequality no sequence of L1 edges is shorter; with gap weights below one
    it is scaled by the least that is to come.
    """
    points = graph.joints / graph.ranges
    goals = points[graph.layer(graph.layer_count - 1)]
    values = np.empty(graph.node_count)
    for low in range(0, graph.node_count, GOAL_TILE):
        part = points[low : low + GOAL_TILE]
        values[low : low + GOAL_TILE] = np.abs(part[:, None] - goals[None]).sum(axis=2).min(axis=1)
    least = np.minimum.accumulate(np.append(graph.gap_weight, 1.0)[::-1])[::-1]
    scaled: FloatArray = values * least[graph.layer_of(np.arange(graph.node_count))]
    return scaled


def least_edges(graph: LayeredGraph) -> FloatArray:
    """(K,) sum of the cheapest edge of every gap to come: the same for all nodes of a layer."""
    cheapest = []
    for gap in range(graph.layer_count - 1):
        source, target = (np.arange(graph.node_count)[graph.layer(one)] for one in (gap, gap + 1))
        costs = graph.edge_costs(gap, source[:, None], target[None, :])
        cheapest.append(float((costs + graph.node_cost[target]).min(initial=np.inf)))
    to_come = np.append(np.cumsum(cheapest[::-1])[::-1], 0.0)
    values: FloatArray = to_come[graph.layer_of(np.arange(graph.node_count))]
    return values


def least_to_go(graph: LayeredGraph, to_go: FloatArray) -> FloatArray:
    """(K,) the least exact cost to go of the layer: what any heuristic by layers can reach."""
    values = np.empty(graph.node_count)
    for layer in range(graph.layer_count):
        values[graph.layer(layer)] = to_go[graph.layer(layer)].min(initial=np.inf)
    return values


def heuristic(study: Study) -> Section:
    """Expanded nodes of the same A* on the same graph under several admissible heuristics."""
    title = "The heuristic is loose"
    graph = plain_graph(study.result.graph)
    if graph.node_count > study.parameters.heuristic_nodes:
        return Section(
            "heuristic",
            title,
            reason=f"the graph has {graph.node_count:,} nodes, which are too many to compare",
        )
    settings = study.problem.settings
    penalty = safety_penalty(study.result.candidates.nodes.clearance, settings.safety_distance)
    penalised = LayeredGraph(
        graph.offsets, graph.joints, graph.ranges, penalty, graph.gap_weight,
        graph.steps, graph.step_limits, graph.lean, graph.lean_limits,
    )  # fmt: skip
    seconds = study.timed(lambda: exact(graph))
    free, near = exact(graph).cost_to_go, exact(penalised).cost_to_go
    nearest = nearest_goal(graph)
    weight = settings.heuristic_weight
    kinds = {
        f"paper: {weight:g} x L2 to the nearest goal": (heuristic_values(graph, weight),) * 2,
        "L2 to the nearest goal": (heuristic_values(graph, 1.0),) * 2,
        "L1 to the nearest goal": (nearest,) * 2,
        "cheapest edge of every gap to come": (least_edges(graph), least_edges(penalised)),
        "least exact cost to go of the layer": (
            least_to_go(graph, free),
            least_to_go(penalised, near),
        ),
        "exact cost to go": (free, near),
    }
    rows: list[tuple[Value, ...]] = []
    shares = {}
    for name, (plain, safe) in kinds.items():
        low, high, mean = _tightness(plain, free)
        shares[name] = (low, high, mean)
        f1, f2 = astar(graph, plain), astar(penalised, safe)
        rows.append((name, f1.expanded, f2.expanded, f1.cost, f2.cost, low, mean, high))
    table = StudyTable(
        "heuristic",
        "One A*, several admissible heuristics",
        (
            Column("heuristic"),
            Column("expanded, f1's cost"),
            Column("expanded, f2's cost"),
            Column("f1 cost", "", 5),
            Column("f2 cost", "", 5),
            Column("least share of the true cost to go", "", 3),
            Column("mean share", "", 3),
            Column("largest share", "", 3),
        ),
        tuple(rows),
    )
    names = list(kinds)
    by = {str(row[0]): row for row in rows}
    low, high, _ = shares[names[0]]
    text = (
        f"The paper's heuristic estimates {low:.2f} to {high:.2f} of the true remaining cost, so "
        f"A* closes {by[names[0]][1]:,} nodes for f1 where the L1 distance, which is admissible "
        f"for the same reason, closes {by[names[2]][1]:,}, and the exact cost to go "
        f"{by[names[-1]][1]:,}.",
        "All of them find the same optimum. The exact cost to go is no free heuristic: it is the "
        "backward half of the exact dynamic programming, which already contains the answer. On a "
        "layered graph that is the whole search.",
    )
    numbers = {
        "expanded_f1": {name: by[name][1] for name in names},
        "expanded_f2": {name: by[name][2] for name in names},
        "f1_expanded_by_the_scheme": study.sequence(Scheme.F1).expanded,
    }
    times = StudyTable(
        "heuristic_time",
        "Time of exact dynamic programming in both directions",
        (Column("graph"), Column("nodes"), Column("time", "ms", 2, timing=True)),
        ((study.problem.name, graph.node_count, seconds * MS_PER_S),),
    )
    return Section("heuristic", title, text, (table, times), numbers=numbers)


def _tightness(values: FloatArray, true: FloatArray) -> tuple[float, float, float]:
    """Least, largest and mean share of the true cost to go, where there is any."""
    known = np.isfinite(true) & (true > 0.0)
    share = values[known] / true[known]
    return float(share.min()), float(share.max()), float(share.mean())
