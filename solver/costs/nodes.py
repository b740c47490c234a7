"""Continuous node terms of the exact scheme, scaled by the length of path a waypoint stands for."""

from __future__ import annotations

import numpy as np

from solver.model.problem import PlanningProblem
from solver.model.toolpath import Pass
from solver.transforms import FloatArray, IntArray
from solver.units import DEG

DEVIATION_UNIT = 45.0 * DEG
"""Deviation from the nominal lean or lead that costs one weight when held all along [rad]."""


def path_shares(passes: tuple[Pass, ...]) -> FloatArray:
    """(n,) share of the whole path that each waypoint stands for; they sum to 1.

    A waypoint stands for half of the way to each neighbour in its pass. A path without length
    is shared equally.
    """
    shares = []
    for one in passes:
        steps = np.linalg.norm(np.diff(one.positions, axis=0), axis=1)
        share = np.zeros(len(one))
        share[:-1] += steps / 2
        share[1:] += steps / 2
        shares.append(share)
    joined = np.concatenate(shares)
    total = joined.sum()
    equal = np.full(len(joined), 1.0 / len(joined))
    shared: FloatArray = joined / total if total > 0.0 else equal
    return shared


def node_terms(
    problem: PlanningProblem, waypoint: IntArray, angles: FloatArray, clearance: FloatArray
) -> FloatArray:
    """(k,) weighted terms of nodes for clearance, lean and lead deviation.

    ``share * (w_c max(0, 1 - d/comfort)^2 + w_lean (dlean/45 deg)^2 + w_lead (dlead/45 deg)^2)``.
    `angles` (k, 3) are lean, lead, spin [rad], `clearance` (k,) [m]. Unlike the paper's penalty
    the terms are continuous in d and do not grow with the number of path points.
    """
    weights = problem.settings.weights
    passes = problem.toolpath.passes
    number = problem.toolpath.pass_index[waypoint]
    lean = np.array([one.lean for one in passes])[number]
    lead = np.array([one.lead for one in passes])[number]
    tight = np.maximum(0.0, 1.0 - clearance / weights.comfort)
    cost: FloatArray = (
        weights.clearance * tight**2
        + weights.lean * ((angles[:, 0] - lean) / DEVIATION_UNIT) ** 2
        + weights.lead * ((angles[:, 1] - lead) / DEVIATION_UNIT) ** 2
    )
    weighted: FloatArray = path_shares(passes)[waypoint] * cost
    return weighted
