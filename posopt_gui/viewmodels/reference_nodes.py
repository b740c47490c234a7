"""The nodes that a reference passes, for drawing it; its measures come from the solver."""

from __future__ import annotations

import random

import numpy as np
from numpy.typing import NDArray

from solver.analysis.references import Reference, ReferenceKind
from solver.analysis.result import PlanningResult
from solver.search.exact import cheapest
from solver.transforms import IntArray

SEED_FACTOR = 1_000_003
"""Distance of the seeds of two problems in `solver.analysis.references`."""


def reference_nodes(result: PlanningResult, reference: Reference) -> IntArray | None:
    """(n,) node of every waypoint, None where the reference has no sequence.

    For the random lean these are the nodes of its first draw.
    """
    if not reference.found:
        return None
    if reference.kind is ReferenceKind.RANDOM:
        return _first_draw(result)
    wanted = np.full(len(result.problem.toolpath.passes), reference.lean)
    if reference.kind is ReferenceKind.NOMINAL:
        grid = result.problem.settings.lean.angles()
        wanted = np.array(
            [grid[np.abs(grid - one.lean).argmin()] for one in result.problem.toolpath.passes]
        )
    allowed = _leaning(result, wanted)
    if reference.kind is ReferenceKind.CONSTANT and reference.keeps_clearance:
        safety = result.problem.settings.safety_distance
        allowed &= result.candidates.nodes.clearance >= safety
    graph, parent = result.graph.subgraph(allowed)
    path, _ = cheapest(graph)
    return parent[path] if len(path) else None


def _leaning(result: PlanningResult, wanted: NDArray[np.float64]) -> NDArray[np.bool_]:
    """(k,) nodes of the lean that is wanted in their pass, with nominal lead and spin."""
    nodes, problem = result.candidates.nodes, result.problem
    angles = result.candidates.orientations[nodes.candidate[:, 1]]
    number = problem.toolpath.pass_index[nodes.candidate[:, 0]]
    lead = np.array([one.lead for one in problem.toolpath.passes])
    lead_off, spin_off = np.abs(angles[:, 1] - lead[number]), np.abs(angles[:, 2])
    chosen: NDArray[np.bool_] = np.abs(angles[:, 0] - wanted[number]) <= 1e-9
    chosen &= (lead_off <= lead_off.min() + 1e-9) & (spin_off <= spin_off.min() + 1e-9)
    return chosen


def _first_draw(result: PlanningResult) -> IntArray:
    source = random.Random(result.problem.settings.seed * SEED_FACTOR)
    layers = [_choices(result, waypoint) for waypoint in range(len(result.problem.toolpath))]
    return np.array([layer[int(source.random() * len(layer))] for layer in layers])


def _choices(result: PlanningResult, waypoint: int) -> IntArray:
    """One node per orientation on the plan's branch, of the turn nearest to the plan."""
    nodes, planned = result.candidates.nodes, int(result.sequence.nodes[waypoint])
    rows = np.arange(nodes.offsets[waypoint], nodes.offsets[waypoint + 1])
    rows = rows[nodes.candidate[rows, 2] == nodes.candidate[planned, 2]]
    away = np.abs(nodes.pendant[rows] - nodes.pendant[planned]).sum(axis=1)
    rows = rows[np.lexsort((rows, away, nodes.candidate[rows, 1]))]
    _, first = np.unique(nodes.candidate[rows, 1], return_index=True)
    return np.asarray(rows[first], dtype=np.int64)
