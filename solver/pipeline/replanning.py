"""Planning again through what a person asked for: pinned places and forbidden regions.

The graph of the first plan is searched again without the nodes that the wishes exclude, so an
answer takes as long as one exact search, or two where the cheapest would change its branch
within a pass.
"""

from __future__ import annotations

from collections.abc import Sequence as Rows
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from solver.analysis.check import down_mm
from solver.analysis.result import PlanningResult, Sequence
from solver.candidates.outcomes import Outcome
from solver.model.settings import Scheme
from solver.model.wishes import Pin, Region
from solver.pipeline.planning import changes_branch, layered_graph, optimum_among
from solver.progress import Monitor, SilentMonitor
from solver.search.graph import LayeredGraph
from solver.search.reachability import diagnose_cut
from solver.transforms import FloatArray
from solver.units import DEG_PER_RAD, MM_PER_M

ANGLE_SLACK = 1e-9
"""How far an angle may lie from a pinned one [rad]."""


@dataclass(frozen=True, slots=True, eq=False)
class Replanned:
    """The answer to a set of wishes.

    Attributes
    ----------
    sequence : Sequence or None
        The cheapest sequence that fulfils them, None where there is none.
    price : float
        What they add to the cost of the plan without them; inf where there is none.
    extra_cost : (k,) array
        What passing each node would add to this sequence; inf where nothing passes.
    layer : int or None
        The first waypoint (from 0) that cannot be passed, None with a sequence.
    reason : str
        Why, in a sentence; '' with a sequence.
    """

    sequence: Sequence | None
    price: float
    extra_cost: FloatArray
    layer: int | None = None
    reason: str = ""


def allowed_nodes(
    result: PlanningResult, pins: Rows[Pin], regions: Rows[Region]
) -> NDArray[np.bool_]:
    """(k,) which nodes the wishes and the hard minimum clearance leave."""
    candidates = result.candidates
    nodes = candidates.nodes
    allowed: NDArray[np.bool_] = nodes.clearance >= result.hard_minimum
    # Only the nodes of the waypoints that a wish is about are looked at: there are many others.
    for pin in pins:
        here = _nodes_between(result, pin.waypoint, pin.waypoint)
        _, orientation, slot, turn = nodes.candidate[here].T
        fits = np.abs(candidates.orientations[orientation, 0] - pin.lean) <= ANGLE_SLACK
        if pin.branch is not None:
            fits &= candidates.branches[slot] == pin.branch
        if pin.turn is not None:
            fits &= turn == pin.turn
        allowed[here] &= fits
    for region in regions:
        here = _nodes_between(result, region.first, region.last)
        _, orientation, slot, _ = nodes.candidate[here].T
        lean = candidates.orientations[orientation, 0]
        inside = (lean >= region.low - ANGLE_SLACK) & (lean <= region.high + ANGLE_SLACK)
        if region.branch is not None:
            inside &= candidates.branches[slot] == region.branch
        allowed[here] &= ~inside
    return allowed


def _nodes_between(result: PlanningResult, first: int, last: int) -> slice:
    """The nodes of the waypoints first..last; none where the path has none of these."""
    offsets = result.candidates.nodes.offsets
    count = len(offsets) - 1
    low, high = min(max(first, 0), count), min(max(last + 1, 0), count)
    return slice(int(offsets[low]), int(offsets[max(low, high)]))


def replan(
    result: PlanningResult,
    pins: Rows[Pin] = (),
    regions: Rows[Region] = (),
    monitor: Monitor | None = None,
) -> Replanned:
    """Find the cheapest sequence through pins and around regions, with its price.

    As in the plan, no pass changes its branch. The price is the difference of the exact costs
    with and without the wishes.

    Raises
    ------
    Cancelled
        When the monitor asks for it.
    """
    monitor = monitor or SilentMonitor()
    allowed = allowed_nodes(result, pins, regions)
    beyond = _beyond(result, pins, regions)
    if beyond:
        return _no_answer(result, len(result.problem.toolpath) - 1, beyond)
    # Where even the best minimum is under the safety distance, nothing can be spared for rounding.
    least = result.hard_minimum if result.clearance_met else -np.inf
    found = optimum_among(result.candidates, result.graph, allowed, least, monitor)
    if found is None:
        return _blocked(result, result.graph, allowed, pins)
    if changes_branch(found[0], result.problem):
        bound = layered_graph(result.candidates, one_branch=True)
        found = optimum_among(result.candidates, bound, allowed, least, monitor)
        if found is None:
            return _blocked(result, bound, allowed, pins)
    sequence, extra = found
    unbound = result.sequences.get(Scheme.EXACT)
    return Replanned(sequence, sequence.cost - (unbound.cost if unbound else 0.0), extra)


def _blocked(
    result: PlanningResult, graph: LayeredGraph, allowed: NDArray[np.bool_], pins: Rows[Pin]
) -> Replanned:
    """Where the allowed nodes break, and why."""
    reduced, _ = graph.subgraph(allowed)
    empty = np.flatnonzero(np.diff(reduced.offsets) == 0)
    if len(empty):
        layer = int(empty[0])
        return _no_answer(result, layer, _empty_reason(result, layer, pins))
    cut = diagnose_cut(reduced)
    if cut is None:
        reason = "rounded to the program's decimals, every sequence comes nearer than is kept"
        return _no_answer(result, 0, f"{reason}; try other wishes")
    layer = int(cut.gaps[0].gap)
    if graph is result.graph:
        reason = f"no allowed step leads from waypoint {layer + 1} to waypoint {layer + 2}"
    else:
        reason = (
            f"the branch would have to change between waypoints {layer + 1} and {layer + 2}, "
            "within a pass; pin poses of one branch"
        )
    return _no_answer(result, layer + 1, reason)


def _no_answer(result: PlanningResult, layer: int, reason: str) -> Replanned:
    return Replanned(None, np.inf, np.full(len(result.candidates.nodes), np.inf), layer, reason)


def _beyond(result: PlanningResult, pins: Rows[Pin], regions: Rows[Region]) -> str:
    """The first wish that is about no waypoint of the path, in a sentence; '' without one."""
    count = len(result.problem.toolpath)
    for pin in pins:
        if not 0 <= pin.waypoint < count:
            return (
                f"the pin of waypoint {pin.waypoint + 1} lies beyond the path, which has {count} "
                "waypoints; take it away"
            )
    for region in regions:
        if region.first >= count or region.last < 0:
            return (
                f"the forbidden region of waypoints {region.first + 1} to {region.last + 1} lies "
                f"beyond the path, which has {count} waypoints; take it away"
            )
    return ""


def _empty_reason(result: PlanningResult, layer: int, pins: Rows[Pin]) -> str:
    own = result.candidates.nodes.candidate[:, 0] == layer
    number = layer + 1
    if not own.any():
        return f"waypoint {number} has no feasible pose at all"
    for pin in pins:
        if pin.waypoint == layer:
            return f"{_pin_reason(result, pin)}; pin another lean"
    return f"every feasible pose of waypoint {number} is forbidden; make the region smaller"


def _pin_reason(result: PlanningResult, pin: Pin) -> str:
    """Why no sequence may pass a pinned place."""
    candidates, number = result.candidates, pin.waypoint + 1
    passing = allowed_nodes(result, [pin], [])
    passing &= candidates.nodes.candidate[:, 0] == pin.waypoint
    if passing.any():
        return f"the pinned pose of waypoint {number} lies in a forbidden region"
    near = np.abs(candidates.orientations[:, 0] - pin.lean) <= ANGLE_SLACK
    if not near.any():
        lean = pin.lean * DEG_PER_RAD
        return f"the pinned lean of waypoint {number}, {lean:.2f} deg, is none of the map's"
    slots = [
        slot for slot, branch in enumerate(candidates.branches) if pin.branch in (None, branch)
    ]
    outcome = candidates.outcome[pin.waypoint][near][:, slots]
    free = outcome == Outcome.FEASIBLE
    if not free.any():
        # The filters are asked in their order: the largest got furthest.
        furthest = Outcome(int(outcome.max(initial=int(Outcome.UNREACHABLE))))
        return f"the pinned pose of waypoint {number} is rejected: {furthest.label}"
    clearance = candidates.clearance[pin.waypoint][near][:, slots][free].max()
    return (
        f"the pinned pose of waypoint {number} comes to {down_mm(clearance):.1f} mm, "
        f"nearer than the {result.hard_minimum * MM_PER_M:.1f} mm that are kept"
    )
