"""Three sequences to compare a plan with: nominal lean, best constant lean, random lean.

The paper compares with a random lean, which nobody would program; a fair 'before' shows the
nominal lean and the best constant one beside it.
"""

from __future__ import annotations

import random
from dataclasses import dataclass
from enum import Enum

import numpy as np

from solver.analysis.metrics import JointMotion, joint_motion, mean_motion
from solver.analysis.result import PlanningResult, joint_cost
from solver.search.exact import cheapest
from solver.transforms import FloatArray, IntArray

RANDOM_DRAWS = 100
"""Sequences of random lean that are averaged."""


class ReferenceKind(Enum):
    """What a reference holds fixed."""

    NOMINAL = "nominal lean"
    CONSTANT = "best constant lean"
    RANDOM = "random lean"


@dataclass(frozen=True, slots=True, eq=False)
class Reference:
    """A sequence to compare with, or the reason why there is none.

    `joint_cost`, `least_clearance` [m], `mean_clearance` [m] and `motion` are means over the
    draws for the random lean. `lean` [rad] is the constant one. `keeps_clearance` tells
    whether the safety distance is kept throughout.
    """

    kind: ReferenceKind
    found: bool
    joint_cost: float = np.nan
    least_clearance: float = np.nan
    mean_clearance: float = np.nan
    lean: float = np.nan
    motion: JointMotion | None = None
    keeps_clearance: bool = False


def references(result: PlanningResult) -> tuple[Reference, Reference, Reference]:
    """Nominal, best constant and random lean on the feasible candidates of the result.

    All feasible candidates are allowed, those under the safety distance too, as a programmer
    without the tool would meet them; lead and spin are the nominal ones for the first two.
    """
    return nominal_lean(result), constant_lean(result), random_lean(result)


def _restricted(result: PlanningResult, allowed: np.ndarray) -> tuple[IntArray, float] | None:
    graph, parent = result.graph.subgraph(allowed)
    if np.any(np.diff(graph.offsets) == 0):
        return None
    path, cost = cheapest(graph)
    return (parent[path], cost) if len(path) else None


def _other_angles_nominal(result: PlanningResult) -> np.ndarray:
    """(k,) whether lead is the nominal of the pass and spin is zero, to half a grid step."""
    nodes, problem = result.candidates.nodes, result.problem
    angles = result.candidates.orientations[nodes.candidate[:, 1]]
    lead = np.array([one.lead for one in problem.toolpath.passes])
    number = problem.toolpath.pass_index[nodes.candidate[:, 0]]
    lead_off = np.abs(angles[:, 1] - lead[number])
    best_lead, best_spin = lead_off.min(), np.abs(angles[:, 2]).min()
    keep: np.ndarray = (lead_off <= best_lead + 1e-9) & (np.abs(angles[:, 2]) <= best_spin + 1e-9)
    return keep


def nominal_lean(result: PlanningResult) -> Reference:
    """The cheapest sequence that holds every pass's nominal lean (the grid's nearest)."""
    problem, nodes = result.problem, result.candidates.nodes
    grid = problem.settings.lean.angles()
    on_grid = np.array([grid[np.abs(grid - one.lean).argmin()] for one in problem.toolpath.passes])
    nearest = on_grid[problem.toolpath.pass_index[nodes.candidate[:, 0]]]
    allowed = np.isclose(result.candidates.lean, nearest, atol=1e-9, rtol=0.0)
    found = _restricted(result, allowed & _other_angles_nominal(result))
    if found is None:
        return Reference(ReferenceKind.NOMINAL, found=False)
    return _measured(result, ReferenceKind.NOMINAL, found[0])


def constant_lean(result: PlanningResult) -> Reference:
    """The cheapest sequence of one lean at every waypoint; ties go to the lower lean.

    Leans whose sequence keeps the safety distance come first; others only if there is none.
    """
    lean, clearance = result.candidates.lean, result.candidates.nodes.clearance
    usual = _other_angles_nominal(result)
    safe = clearance >= result.problem.settings.safety_distance
    for allowed in (usual & safe, usual):
        best: tuple[float, IntArray] | None = None
        for angle in result.problem.settings.lean.angles():
            found = _restricted(result, allowed & (np.abs(lean - angle) < 1e-9))
            if found is not None and (best is None or found[1] < best[0] - 1e-12):
                best = (found[1], found[0])
        if best is not None:
            return _measured(result, ReferenceKind.CONSTANT, best[1])
    return Reference(ReferenceKind.CONSTANT, found=False)


def random_lean(result: PlanningResult, draws: int = RANDOM_DRAWS) -> Reference:
    """Mean over seeded draws of a random feasible lean at each waypoint, on the plan's branch.

    Among the turns of a drawn lean the one nearest to the plan's joints is taken.
    """
    layers = [_lean_choices(result, waypoint) for waypoint in range(len(result.problem.toolpath))]
    motions, costs, least, mean, kept = [], [], [], [], []
    nodes = result.candidates.nodes
    ranges = result.problem.robot.cost_ranges
    for draw in range(draws):
        source = random.Random(result.problem.settings.seed * 1_000_003 + draw)
        chosen = np.array([layer[int(source.random() * len(layer))] for layer in layers])
        motions.append(joint_motion(nodes.pendant[chosen]))
        costs.append(joint_cost(nodes.model[chosen], ranges))
        least.append(float(nodes.clearance[chosen].min()))
        mean.append(float(nodes.clearance[chosen].mean()))
        kept.append(least[-1] >= result.problem.settings.safety_distance)
    return Reference(
        ReferenceKind.RANDOM,
        found=True,
        joint_cost=float(np.mean(costs)),
        least_clearance=float(np.mean(least)),
        mean_clearance=float(np.mean(mean)),
        motion=mean_motion(motions),
        keeps_clearance=all(kept),
    )


def _lean_choices(result: PlanningResult, waypoint: int) -> list[int]:
    """One node per orientation on the plan's branch, the turn nearest to the plan."""
    nodes, sequence = result.candidates.nodes, result.sequence
    planned = int(sequence.nodes[waypoint])
    slot = nodes.candidate[planned, 2]
    rows = np.arange(nodes.offsets[waypoint], nodes.offsets[waypoint + 1])
    rows = rows[nodes.candidate[rows, 2] == slot]
    distance = np.abs(nodes.pendant[rows] - nodes.pendant[planned]).sum(axis=1)
    best: dict[int, tuple[float, int]] = {}
    for row, away in zip(rows, distance, strict=True):
        key = int(nodes.candidate[row, 1])
        if key not in best or away < best[key][0]:
            best[key] = (float(away), int(row))
    return [row for _, row in best.values()]


def _measured(result: PlanningResult, kind: ReferenceKind, chosen: IntArray) -> Reference:
    nodes = result.candidates.nodes
    clearance: FloatArray = nodes.clearance[chosen]
    return Reference(
        kind,
        found=True,
        joint_cost=joint_cost(nodes.model[chosen], result.problem.robot.cost_ranges),
        least_clearance=float(clearance.min()),
        mean_clearance=float(clearance.mean()),
        lean=float(result.candidates.lean[chosen[0]]),
        motion=joint_motion(nodes.pendant[chosen]),
        keeps_clearance=bool(clearance.min() >= result.problem.settings.safety_distance),
    )
