"""The graphs on which searches are compared: candidates of a real cell, of any size."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from solver.benchmarks.measure import lengthened
from solver.candidates.generate import CANDIDATE_LIMIT, CandidateSet
from solver.errors import InputError
from solver.model.problem import PlanningProblem
from solver.model.settings import BRANCHES, Sweep
from solver.search.graph import LayeredGraph
from solver.units import DEG

CELL = "groove_hw300"
"""The cell whose path is resampled, where no other is asked for."""

LEAD_REACH = 10.0 * DEG
"""A lead sweep runs from minus to plus this angle [rad]."""

_SIZE = re.compile(r"\d{1,7}(x\d{1,7}){2,3}", re.ASCII)


@dataclass(frozen=True, slots=True)
class GraphSize:
    """Number of waypoints, lean angles, lead angles and branches."""

    waypoints: int
    leans: int
    leads: int
    branches: int

    @property
    def candidates(self) -> int:
        """Number of branch candidates."""
        return self.waypoints * self.leans * self.leads * self.branches

    def __str__(self) -> str:
        angles = f"({self.leans} x {self.leads})" if self.leads > 1 else f"{self.leans}"
        return f"{self.waypoints:,} x {angles} x {self.branches}"


STANDARD_SIZES = (
    GraphSize(50, 51, 1, 1),
    GraphSize(50, 51, 1, 8),
    GraphSize(500, 51, 1, 8),
    GraphSize(5000, 51, 1, 8),
    GraphSize(200, 51, 21, 8),
)

SMALL_SIZES = (GraphSize(12, 11, 1, 1), GraphSize(8, 11, 3, 8))


def parse_size(text: str) -> GraphSize:
    """Read WAYPOINTSxLEANSxBRANCHES or WAYPOINTSxLEANSxLEADSxBRANCHES.

    Raises
    ------
    InputError
        For any other text, and for a size that has no graph or too many candidates.
    """
    if not _SIZE.fullmatch(text):
        raise InputError(
            f"--sizes: expected WAYPOINTSxLEANSxBRANCHES or WAYPOINTSxLEANSxLEADSxBRANCHES, "
            f"such as 50x51x8 or 200x51x21x8, got {text!r}"
        )
    numbers = [int(part) for part in text.split("x")]
    leads = numbers[2] if len(numbers) == 4 else 1
    size = GraphSize(numbers[0], numbers[1], leads, numbers[-1])
    if size.waypoints < 2 or min(size.leans, leads) < 1 or not 1 <= size.branches <= BRANCHES:
        raise InputError(
            f"--sizes {text}: expected 2 or more waypoints, 1 or more angles and "
            f"1 to {BRANCHES} branches"
        )
    if size.candidates > CANDIDATE_LIMIT:
        raise InputError(
            f"--sizes {text}: {size.candidates:,} candidates, expected at most {CANDIDATE_LIMIT:,}"
        )
    return size


def sized_problem(problem: PlanningProblem, size: GraphSize) -> PlanningProblem:
    """The problem with its path resampled and its angles and branches as many as asked.

    Lean keeps the range of the cell's own sweep; lead runs over +-10 deg; branches are the
    first ones in their order. A path of several passes keeps their ends, so that it may have
    some waypoints more or fewer.
    """
    lean = problem.settings.lean
    settings = replace(
        problem.settings,
        lean=_sweep(lean.lower, lean.upper, size.leans),
        lead=_sweep(-LEAD_REACH, LEAD_REACH, size.leads),
        branches=tuple(range(size.branches)),
    )
    return replace(lengthened(problem, size.waypoints), settings=settings)


def _sweep(lower: float, upper: float, count: int) -> Sweep:
    if count == 1:
        return Sweep.fixed((lower + upper) / 2.0)
    return Sweep(lower, upper, (upper - lower) / (count - 1))


def joint_cost_graph(candidates: CandidateSet) -> LayeredGraph:
    """The graph of all feasible candidates under the joint cost alone, without bounds on steps."""
    nodes = candidates.nodes
    return LayeredGraph(
        offsets=nodes.offsets,
        joints=nodes.model,
        ranges=candidates.problem.robot.cost_ranges,
        node_cost=np.zeros(len(nodes)),
        gap_weight=np.ones(len(nodes.offsets) - 2),
    )


def save_graph(graph: LayeredGraph, path: Path) -> None:
    """Write what a graph of the joint cost consists of."""
    np.savez(path, offsets=graph.offsets, joints=graph.joints, ranges=graph.ranges)


def load_graph(path: Path) -> LayeredGraph:
    """Read a graph that :func:`save_graph` wrote."""
    with np.load(path) as arrays:
        offsets, joints, ranges = arrays["offsets"], arrays["joints"], arrays["ranges"]
    for array in (offsets, joints, ranges):
        array.setflags(write=False)
    return LayeredGraph(
        offsets, joints, ranges, np.zeros(len(joints)), np.ones(max(0, len(offsets) - 2))
    )


def thinned(graph: LayeredGraph, layers: int = 3, nodes: int = 16) -> LayeredGraph:
    """The first nodes of the first layers, for a run that is not counted."""
    kept = [
        np.arange(low, min(low + nodes, high))
        for low, high in zip(graph.offsets[:layers], graph.offsets[1:], strict=False)
    ]
    joints = graph.joints[np.concatenate(kept)]
    offsets = np.concatenate([[0], np.cumsum([len(one) for one in kept])])
    return LayeredGraph(
        offsets, joints, graph.ranges, np.zeros(len(joints)), np.ones(len(kept) - 1)
    )
