"""The front as planning would give it: the plan of every hard minimum clearance there is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solver.analysis.result import PlanningResult, Sequence, sequence_of
from solver.candidates.generate import CandidateSet
from solver.model.settings import Scheme
from solver.pipeline.planning import changes_branch, layered_graph, rounded_clearance
from solver.progress import Monitor, checkpoint
from solver.search.bottleneck import best_minimum_clearance
from solver.search.exact import cheapest
from solver.search.graph import LayeredGraph
from solver.study.pareto import SAME_COST
from solver.transforms import FloatArray, IntArray

STAGE = "front"

SHARES = 1000
"""Units in which progress along the clearance is told."""

ROUNDED_AT_ONCE = 256
"""Nodes whose exported joints are checked between two questions about cancelling."""


@dataclass(frozen=True, slots=True, eq=False)
class FrontPlan:
    """One point of the front: the exact plan of every hard minimum from `lowest` to `kept` [m].

    `kept` is its least clearance, also with its joints rounded as they are exported.
    """

    sequence: Sequence
    lowest: float
    kept: float


def planned_front(result: PlanningResult, step: float, monitor: Monitor) -> tuple[FrontPlan, ...]:
    """Plans of the scheme `exact` for rising hard minima, by rising clearance and cost.

    They follow the rules of :func:`solver.plan`: exported joints keep the minimum too, a branch
    changes on links alone, and the objective is the cell's own. Each further plan has at least
    `step` [m] more clearance than the one before; with a step of zero no plan is left out.

    Raises
    ------
    Cancelled
        When the monitor asks for it.
    """
    search = _Search(result.candidates, monitor)
    found: list[FrontPlan] = []
    one = search.above(0.0)
    best = search.best() if one is not None else 0.0
    while one is not None:
        if found and found[-1].sequence.cost >= one.sequence.cost - SAME_COST:
            del found[-1]
        found.append(one)
        share = one.kept / best if best > 0.0 else 1.0
        checkpoint(monitor, STAGE, int(SHARES * min(share, 1.0)), SHARES)
        # The end of the front belongs to it, however near.
        one = search.above(float(np.nextafter(one.kept + step, np.inf))) or search.end(one.kept)
    return tuple(found)


class _Search:
    """The cheapest sequences of one candidate set under hard minima."""

    def __init__(self, candidates: CandidateSet, monitor: Monitor) -> None:
        self._candidates, self._monitor = candidates, monitor
        self._quiet = _Quiet(monitor)
        self._free = layered_graph(candidates)
        self._one_branch: LayeredGraph | None = None
        self._kept = candidates.nodes.clearance.copy()
        """Clearance of each node, lowered where its exported joints were found to be nearer."""
        self._rounded = np.zeros(len(self._kept), dtype=np.bool_)

    def above(self, least: float) -> FrontPlan | None:
        """The plan whose hard minimum is `least` [m], None where there is none."""
        while True:
            sequence = self._optimum(self._free, least)
            if sequence is not None and changes_branch(sequence, self._candidates.problem):
                if self._one_branch is None:
                    self._one_branch = layered_graph(self._candidates, one_branch=True)
                sequence = self._optimum(self._one_branch, least)
            if sequence is None:
                return None
            self._round(sequence.nodes)
            kept = float(self._kept[sequence.nodes].min())
            if kept >= least:
                return FrontPlan(sequence, least, kept)

    def end(self, beyond: float) -> FrontPlan | None:
        """The plan of the largest minimum of all, None where it is not beyond one [m]."""
        best = self.best()
        while best > beyond:
            found = self.above(best)
            if found is not None:
                return found
            # What was thought to be kept is lost when the joints are rounded.
            before, best = best, self.best()
            if best >= before:
                break
        return None

    def best(self) -> float:
        """The largest clearance that a sequence keeps, as far as is known [m]."""
        graph = self._one_branch or self._free
        return best_minimum_clearance(graph, self._kept, self._quiet)

    def _optimum(self, graph: LayeredGraph, least: float) -> Sequence | None:
        checkpoint(self._quiet, STAGE, 0, SHARES)
        part, parent = graph.subgraph(self._kept >= least)
        if np.any(np.diff(part.offsets) == 0):
            return None
        path, cost = cheapest(part, self._quiet)
        if not len(path):
            return None
        return sequence_of(self._candidates, Scheme.EXACT, parent[path], cost)

    def _round(self, nodes: IntArray) -> None:
        """Find out the clearance of nodes at their exported joints, once each."""
        new = nodes[~self._rounded[nodes]]
        for first in range(0, len(new), ROUNDED_AT_ONCE):
            checkpoint(self._quiet, STAGE, 0, SHARES)
            some = new[first : first + ROUNDED_AT_ONCE]
            clearance: FloatArray = rounded_clearance(self._candidates, some)
            self._kept[some] = np.minimum(self._kept[some], clearance)
        self._rounded[new] = True


class _Quiet:
    """A monitor for the many searches on the way: they can be cancelled, and tell nothing."""

    def __init__(self, monitor: Monitor) -> None:
        self._monitor = monitor

    def report(self, stage: str, done: int, total: int) -> None:
        """Ignore the report."""

    def cancelled(self) -> bool:
        """Whether the whole front is no longer wanted."""
        return self._monitor.cancelled()
