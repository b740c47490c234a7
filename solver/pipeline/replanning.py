"""Planning again through what a person asked for: pinned places and forbidden regions.

The graph of the first plan is searched again without the nodes that the wishes exclude, so an
answer takes as long as one exact search.
"""

from __future__ import annotations

from collections.abc import Sequence as Rows
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from solver.analysis.result import PlanningResult, Sequence, sequence_of
from solver.model.settings import Scheme
from solver.model.wishes import Pin, Region
from solver.progress import Monitor, SilentMonitor
from solver.search.exact import ExactResult, exact
from solver.search.graph import LayeredGraph
from solver.search.reachability import diagnose_cut
from solver.transforms import FloatArray

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
    waypoint, _, slot, turn = nodes.candidate.T
    branch, lean = candidates.branches[slot], candidates.lean
    allowed: NDArray[np.bool_] = nodes.clearance >= result.hard_minimum
    for pin in pins:
        fits = np.abs(lean - pin.lean) <= ANGLE_SLACK
        if pin.branch is not None:
            fits &= branch == pin.branch
        if pin.turn is not None:
            fits &= turn == pin.turn
        allowed &= (waypoint != pin.waypoint) | fits
    for region in regions:
        inside = (waypoint >= region.first) & (waypoint <= region.last)
        inside &= (lean >= region.low - ANGLE_SLACK) & (lean <= region.high + ANGLE_SLACK)
        if region.branch is not None:
            inside &= branch == region.branch
        allowed &= ~inside
    return allowed


def replan(
    result: PlanningResult,
    pins: Rows[Pin] = (),
    regions: Rows[Region] = (),
    monitor: Monitor | None = None,
) -> Replanned:
    """Find the cheapest sequence through pins and around regions, with its price.

    The price is the difference of the exact costs with and without the wishes.

    Raises
    ------
    Cancelled
        When the monitor asks for it.
    """
    monitor = monitor or SilentMonitor()
    allowed = allowed_nodes(result, pins, regions)
    graph, parent = result.graph.subgraph(allowed)
    nothing = np.full(len(allowed), np.inf)
    empty = np.flatnonzero(np.diff(graph.offsets) == 0)
    if len(empty):
        layer = int(empty[0])
        return Replanned(None, np.inf, nothing, layer, _empty_reason(result, layer, pins))
    outcome = exact(graph, monitor)
    if not outcome.found:
        layer = _cut_layer(graph)
        reason = f"no allowed step leads from waypoint {layer + 1} to waypoint {layer + 2}"
        return Replanned(None, np.inf, nothing, layer + 1, reason)
    return _answer(result, outcome, parent, nothing)


def _answer(
    result: PlanningResult, outcome: ExactResult, parent: NDArray[np.int64], extra: FloatArray
) -> Replanned:
    extra[parent] = outcome.extra_cost
    sequence = sequence_of(
        result.candidates, Scheme.EXACT, parent[outcome.path], float(outcome.cost)
    )
    unbound = result.sequences.get(Scheme.EXACT)
    price = float(outcome.cost) - (unbound.cost if unbound is not None else 0.0)
    return Replanned(sequence, price, extra)


def _empty_reason(result: PlanningResult, layer: int, pins: Rows[Pin]) -> str:
    own = result.candidates.nodes.candidate[:, 0] == layer
    number = layer + 1
    if not own.any():
        return f"waypoint {number} has no feasible pose at all"
    if any(pin.waypoint == layer for pin in pins):
        return (
            f"the pinned place of waypoint {number} is not feasible, or comes nearer than the "
            "required clearance; pin another lean"
        )
    return f"every feasible pose of waypoint {number} is forbidden; make the region smaller"


def _cut_layer(graph: LayeredGraph) -> int:
    cut = diagnose_cut(graph)
    return int(cut.gaps[0].gap) if cut is not None else 0
