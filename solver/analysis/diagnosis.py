"""When there is no sequence: which waypoints or steps break it, why, and by how much."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from solver.candidates.explain import Explanation, explain
from solver.candidates.generate import CandidateSet
from solver.candidates.margins import FilterMargin
from solver.candidates.outcomes import Outcome
from solver.errors import PlanningError
from solver.search.graph import LayeredGraph
from solver.search.reachability import Cut, diagnose_cut
from solver.units import DEG_PER_RAD


@dataclass(frozen=True, slots=True, eq=False)
class EmptyLayer:
    """A waypoint without any feasible candidate.

    `rejected` counts the branch candidates by the filter that rejected them; `nearest` is,
    among those that got furthest, the candidate that misses its filter `missed` by least.
    """

    waypoint: int
    rejected: Mapping[Outcome, int]
    nearest: Explanation
    missed: FilterMargin

    def __str__(self) -> str:
        worst = self.missed
        counts = ", ".join(f"{count} {kind.label}" for kind, count in self.rejected.items())
        return (
            f"waypoint {self.waypoint + 1} has no feasible pose ({counts}); nearest is lean "
            f"{self.nearest.lean * DEG_PER_RAD:g} deg on branch {self.nearest.branch}, where "
            f"{-worst.margin:.3g} {worst.unit} are missing: {worst.subject} ({worst.filter.label})"
        )


_ADVICE = {
    Outcome.FEASIBLE: "try another place of the beam",
    Outcome.UNREACHABLE: "try the beam nearer to the robot, or a wider lean range",
    Outcome.JOINT_LIMIT: "try a wider lean range, all branches, or wider joint windows",
    Outcome.SINGULAR: "try a wider lean range, or a lower bound of manipulability",
    Outcome.COLLISION: "try a wider lean range, all branches, or another place of the beam",
    Outcome.MARGIN: "look at the height of the path over the surface and at what its pass touches",
    Outcome.SELF_COLLISION: "try a wider lean range or another place of the beam",
}


class InfeasiblePathError(PlanningError):
    """No sequence: `empty` lists layers without candidates, `cut` where steps are too large.

    `waypoints` is the number of empty layers, `candidates` what was tried, None where it is not
    at hand.
    """

    def __init__(
        self,
        empty: tuple[EmptyLayer, ...],
        waypoints: int,
        cut: Cut | None,
        candidates: CandidateSet | None = None,
    ) -> None:
        self.empty, self.waypoints, self.cut = empty, waypoints, cut
        self.candidates = candidates
        if empty:
            more = f"; {waypoints} waypoints in all have none" if waypoints > 1 else ""
            message = f"no sequence: {empty[0]}{more}; {_ADVICE[empty[0].missed.filter]}"
        elif cut is not None:
            advice = "try wider step limits, a lower feed or a finer lean step"
            message = f"no sequence: {_cut_words(cut)}; {advice}"
        else:
            message = "no sequence under the asked clearance; try a smaller safety distance"
        super().__init__(message)


def _cut_words(cut: Cut) -> str:
    first = cut.gaps[0]
    what = "the lean" if first.joint is None else f"J{first.joint}"
    return (
        f"from waypoint {first.gap + 1} to {first.gap + 2} {what} would have to step by "
        f"{first.step * DEG_PER_RAD:.3g} deg or more, where {first.limit * DEG_PER_RAD:.3g} deg "
        f"are allowed (steps that are too large: {len(cut.gaps)})"
    )


def no_sequence(
    candidates: CandidateSet, graph: LayeredGraph, explained: int = 3
) -> InfeasiblePathError:
    """Say why the graph has no sequence; the first few empty layers are looked into."""
    empty = np.flatnonzero(np.diff(graph.offsets) == 0)
    if len(empty):
        layers = tuple(_empty_layer(candidates, int(w)) for w in empty[:explained])
        return InfeasiblePathError(layers, len(empty), None, candidates)
    return InfeasiblePathError((), 0, diagnose_cut(graph), candidates)


def _empty_layer(candidates: CandidateSet, waypoint: int) -> EmptyLayer:
    outcome = candidates.outcome[waypoint]
    counts = np.bincount(outcome.ravel(), minlength=len(Outcome))
    furthest = Outcome(int(outcome.max()))
    rejected = {kind: int(counts[kind]) for kind in Outcome if counts[kind]}
    tried = np.argwhere(outcome == furthest)
    explanations = (
        explain(
            candidates.problem,
            waypoint,
            float(candidates.orientations[o, 0]),
            int(candidates.branches[slot]),
            lead=float(candidates.orientations[o, 1]),
            spin=float(candidates.orientations[o, 2]),
            scene=candidates.scene,
        )
        for o, slot in tried[:: max(1, len(tried) // 200)]
    )
    nearest = max(explanations, key=lambda one: _missed(one, furthest).margin)
    return EmptyLayer(waypoint, rejected, nearest, _missed(nearest, furthest))


def _missed(explanation: Explanation, furthest: Outcome) -> FilterMargin:
    """The failed filter of the stage that was reached; collisions of all kinds are one stage."""
    failed = [one for one in explanation.filters if not one.passed]
    of_stage = [one for one in failed if one.filter == furthest]
    return min(of_stage or failed, key=lambda one: one.margin)
