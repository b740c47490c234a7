"""Candidates at orientations of each waypoint's own, where planning has one grid for all.

A path is repeated: every waypoint stands in it once for each of its orientations, already
turned by it. So the product's own generation and filters serve, and what they return is put
together again as candidates of the original problem.
"""

from __future__ import annotations

from collections.abc import Sequence as Rows
from dataclasses import replace

import numpy as np

from solver.analysis.result import Sequence
from solver.candidates.generate import CandidateSet, Nodes, generate
from solver.model.problem import PlanningProblem
from solver.model.settings import Sweep
from solver.model.toolpath import Role, Toolpath
from solver.pipeline.planning import changes_branch, exact_sequence, layered_graph
from solver.progress import Monitor
from solver.transforms import FloatArray


def candidates_at(
    problem: PlanningProblem, angles: Rows[FloatArray], monitor: Monitor
) -> CandidateSet:
    """Solve and filter orientations `angles[i]` (k_i, 3) of every waypoint i.

    Parameters
    ----------
    problem : PlanningProblem
        Its sweeps are not looked at; everything else holds.
    angles : one (k_i, 3) array a waypoint
        Lean, lead and spin [rad]; none may be empty.
    monitor : Monitor
        Told about progress and asked about cancelling.

    Returns
    -------
    CandidateSet
        Of the original problem. Its orientations are all rows of `angles`, one after the
        other; `joints`, `outcome` and `clearance` have one waypoint row for each of them and
        a single orientation.
    """
    poses = problem.toolpath.poses
    turned = [poses[waypoint] @ tool_poses(rows) for waypoint, rows in enumerate(angles)]
    passes, first = [], 0
    for one in problem.toolpath.passes:
        joined = np.concatenate(turned[first : first + len(one)])
        roles = (Role.CONTACT,) * len(joined)
        passes.append(replace(one, poses=joined, roles=roles, events={}))
        first += len(one)
    repeated = Toolpath(tuple(passes), problem.toolpath.frame)
    settings = replace(problem.settings, lean=Sweep.fixed(), lead=Sweep.fixed(), spin=Sweep.fixed())
    found = generate(replace(problem, toolpath=repeated, settings=settings), monitor)
    owner = np.repeat(np.arange(len(angles)), [len(rows) for rows in angles])
    candidate = found.nodes.candidate.copy()
    candidate[:, 1] = candidate[:, 0]
    candidate[:, 0] = owner[candidate[:, 1]]
    offsets = np.searchsorted(candidate[:, 0], np.arange(len(angles) + 1)).astype(np.int64)
    nodes = Nodes(candidate, found.nodes.model, found.nodes.pendant, found.nodes.clearance, offsets)
    return replace(found, problem=problem, orientations=np.concatenate(list(angles)), nodes=nodes)


def tool_poses(angles: FloatArray) -> FloatArray:
    """(k, 4, 4) reference_from_tool of (k, 3) lean, lead and spin [rad]: Ry Rx Rz."""
    (a, b, c), (d, e, f) = np.cos(angles).T, np.sin(angles).T
    poses = np.zeros((len(angles), 4, 4))
    poses[:, 0, :3] = np.column_stack([a * c + d * e * f, d * e * c - a * f, d * b])
    poses[:, 1, :3] = np.column_stack([b * f, b * c, -e])
    poses[:, 2, :3] = np.column_stack([a * e * f - d * c, d * f + a * e * c, a * b])
    poses[:, 3, 3] = 1.0
    return poses


def solve_exactly(candidates: CandidateSet, monitor: Monitor) -> tuple[Sequence, FloatArray, float]:
    """Optimal sequence, extra costs of all nodes and the kept minimum [m], as planning does."""
    graph = layered_graph(candidates)
    answer = exact_sequence(candidates, graph, monitor)
    if changes_branch(answer[0], candidates.problem):
        bound = layered_graph(candidates, one_branch=True)
        answer = exact_sequence(candidates, bound, monitor)
    return answer
