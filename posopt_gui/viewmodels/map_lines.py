"""Lines, bands and edges of the map."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from posopt_gui.viewmodels.map_model import Cells, Choice
from posopt_gui.viewmodels.number_words import listed
from solver.model.settings import Scheme
from solver.transforms import FloatArray, IntArray
from solver.units import DEG_PER_RAD

if TYPE_CHECKING:
    from solver.analysis.result import PlanningResult
    from solver.candidates.generate import CandidateSet
    from solver.errors import PosoptError
    from solver.pipeline.replanning import Replanned
    from solver.progress import Monitor
    from solver.search.graph import LayeredGraph

CHOSEN: Final = "chosen"
CONSTANT: Final = "constant"
BEFORE: Final = "before"

LINE_NAMES: Final[Mapping[str, str]] = {
    CHOSEN: "with your wishes",
    BEFORE: "without your wishes",
    Scheme.EXACT.value: "exact",
    Scheme.F.value: "f",
    Scheme.F1.value: "f1",
    Scheme.F2.value: "f2",
    CONSTANT: "constant lean",
}
"""What a line is called at its end."""

Translate = Callable[..., str]


@dataclass(frozen=True, slots=True, eq=False)
class MapLine:
    """A sequence on the map.

    `key` tells its style, `names` all that it is called (schemes that found the same);
    `waypoint` counts from 1, `lean` is in [deg]; `candidate` (n, 4) are its nodes' rows.
    """

    key: str
    names: tuple[str, ...]
    waypoint: FloatArray
    lean: FloatArray
    candidate: NDArray[np.int32]

    def on_page(self, choice: Choice, spins: int, others: int) -> NDArray[np.bool_]:
        """(n,) where the line runs on the shown page."""
        shown = np.ones(len(self.lean), dtype=np.bool_)
        other = self.candidate[:, 1] % others
        for wanted, found in (
            (choice.slot, self.candidate[:, 2]),
            (choice.turn, self.candidate[:, 3]),
            (choice.lead, other // spins),
            (choice.spin, other % spins),
        ):
            if wanted is not None:
                shown &= found == wanted
        return shown


def line_of(
    candidates: CandidateSet, key: str, nodes: IntArray, names: Iterable[str] = ()
) -> MapLine:
    """The line of a sequence of nodes."""
    candidate = candidates.nodes.candidate[nodes]
    lean = candidates.orientations[candidate[:, 1], 0] * DEG_PER_RAD
    names = tuple(names) or (LINE_NAMES[key],)
    return MapLine(key, names, np.arange(1.0, len(nodes) + 1.0), lean, candidate)


def sequence_lines(
    result: PlanningResult,
    answer: Replanned | None,
    shown: Iterable[str],
    constant: IntArray | None = None,
    paths: Mapping[Scheme, IntArray | None] | None = None,
) -> tuple[MapLine, ...]:
    """The chosen line first, then those to compare; equal ones are one line of several names.

    `shown` holds the schemes' names and CONSTANT; `constant` are the nodes of the best
    constant lean and `paths` those of further schemes, where they are known.
    """
    asked = answer.sequence if answer is not None else None
    wished = asked is not None
    chosen = asked if asked is not None else result.sequence
    first = CHOSEN if wished else result.scheme.value
    wanted: list[tuple[str, IntArray]] = [(first, chosen.nodes)]
    if wished:
        wanted.append((BEFORE, result.sequence.nodes))
    visible = set(shown)
    known = dict(paths or {}) | {one: found.nodes for one, found in result.sequences.items()}
    for scheme in Scheme:
        nodes = known.get(scheme)
        if nodes is not None and scheme.value in visible:
            wanted.append((scheme.value, nodes))
    if constant is not None and CONSTANT in visible:
        wanted.append((CONSTANT, constant))
    return _merged(result.candidates, wanted)


def _merged(candidates: CandidateSet, wanted: list[tuple[str, IntArray]]) -> tuple[MapLine, ...]:
    groups: list[tuple[str, IntArray, list[str]]] = []
    for key, nodes in wanted:
        same = next((names for _, other, names in groups if np.array_equal(other, nodes)), None)
        if same is None:
            groups.append((key, nodes, [LINE_NAMES[key]]))
        elif LINE_NAMES[key] not in same:
            same.append(LINE_NAMES[key])
    return tuple(line_of(candidates, key, nodes, names) for key, nodes, names in groups)


def drawn_alike(
    lines: Iterable[MapLine], choice: Choice, spins: int, others: int
) -> tuple[tuple[MapLine, ...], tuple[NDArray[np.bool_], ...]]:
    """Lines that look the same on a page as one, and where each of them runs on it.

    Lines of the same leans on another branch or turn are lines of their own.
    """
    drawn: list[MapLine] = []
    pages: list[NDArray[np.bool_]] = []
    for line in lines:
        page = line.on_page(choice, spins, others)
        for number, other in enumerate(drawn):
            if _look_alike(other, line) and np.array_equal(pages[number], page):
                drawn[number] = replace(other, names=other.names + line.names)
                break
        else:
            drawn.append(line)
            pages.append(page)
    return tuple(drawn), tuple(pages)


def _look_alike(one: MapLine, other: MapLine) -> bool:
    same_arm = np.array_equal(one.candidate[:, 2:4], other.candidate[:, 2:4])
    return same_arm and np.array_equal(one.lean, other.lean)


def end_words(
    lines: Iterable[MapLine], branches: IntArray, translate: Translate
) -> tuple[str, ...]:
    """What each line is called at its end; with its branches where these tell lines apart."""
    lines = tuple(lines)
    passed = [_arms(line, branches) for line in lines]
    turns = len({arms for arms, _ in passed}) == 1
    said = []
    for line, (own, own_turns) in zip(lines, passed, strict=True):
        words = listed(map(translate, line.names), translate)
        if len({*passed}) > 1 or len(own) > 1:
            shown = "/".join(map(str, own))
            words += " · " + translate("branch {number}", number=shown)
        if len({*passed}) > 1 and turns:
            shown = "/".join(str(one + 1) for one in own_turns)
            words += translate(", ") + translate("turn {number}", number=shown)
        said.append(words)
    return tuple(said)


def _arms(line: MapLine, branches: IntArray) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Branches and turns in the order in which a line passes them first."""
    slots = dict.fromkeys(line.candidate[:, 2].tolist())
    turns = dict.fromkeys(line.candidate[:, 3].tolist())
    return tuple(int(branches[slot]) for slot in slots), tuple(turns)


def places_apart(lines: Iterable[MapLine]) -> tuple[int, ...]:
    """How many lines before each one have the same leans, and would be covered by it."""
    before: list[MapLine] = []
    places = []
    for line in lines:
        places.append(sum(np.array_equal(one.lean, line.lean) for one in before))
        before.append(line)
    return tuple(places)


@dataclass(frozen=True, slots=True)
class Band:
    """A layer, or with `gap` the way to the next one, that breaks the sequence."""

    waypoint: int
    text: str
    gap: bool = False


def answer_bands(answer: Replanned | None) -> tuple[Band, ...]:
    """The layer that a person's wishes cut."""
    if answer is None or answer.sequence is not None or answer.layer is None:
        return ()
    return (Band(answer.layer, answer.reason),)


def error_bands(error: PosoptError | None, empty: Iterable[int]) -> tuple[Band, ...]:
    """The layers that leave no plan at all; `empty` are those without a node."""
    explained = {one.waypoint: str(one) for one in getattr(error, "empty", ())}
    bands = [Band(int(layer), explained.get(int(layer), "")) for layer in empty]
    known = {band.waypoint for band in bands}
    bands += [Band(layer, text) for layer, text in explained.items() if layer not in known]
    cut = getattr(error, "cut", None)
    if cut is not None:
        bands += [
            Band(one.gap, str(error) if number == 0 else "", gap=True)
            for number, one in enumerate(cut.gaps)
        ]
    return tuple(sorted(bands, key=lambda band: band.waypoint))


def runs(bands: Iterable[Band]) -> list[tuple[int, int, bool]]:
    """Neighbouring bands as one: first and last waypoint, and whether it is a gap."""
    found: list[tuple[int, int, bool]] = []
    for band in bands:
        if found and not band.gap and not found[-1][2] and found[-1][1] + 1 == band.waypoint:
            found[-1] = (found[-1][0], band.waypoint, False)
        else:
            found.append((band.waypoint, band.waypoint, band.gap))
    return found


def node_edges(
    graph: LayeredGraph, cells: Cells, leans: FloatArray, node: int, row: int
) -> tuple[FloatArray, FloatArray]:
    """Edges between a node and the shown nodes before and after it, as pairs of points (2 e,).

    `row` is the row of the node's lean.
    x are waypoints from 1, y leans [deg]; edges that a limit forbids are left out.
    """
    layer = int(graph.layer_of([node])[0])
    own = leans[row]
    x: list[FloatArray] = []
    y: list[FloatArray] = []
    for other in (layer - 1, layer + 1):
        if not 0 <= other < len(cells.node):
            continue
        rows = np.flatnonzero(cells.node[other] >= 0)
        ends = cells.node[other, rows]
        sources, targets = (ends, node) if other < layer else (node, ends)
        cost = graph.edge_costs(min(layer, other), sources, targets)
        rows = rows[np.isfinite(cost)]
        x.append(np.tile([layer + 1.0, other + 1.0], len(rows)))
        y.append(np.column_stack([np.full(len(rows), own), leans[rows]]).ravel())
    return np.concatenate(x or [np.empty(0)]), np.concatenate(y or [np.empty(0)])


def scheme_search(
    result: PlanningResult, scheme: Scheme, monitor: Monitor | None = None
) -> tuple[IntArray | None, FloatArray]:
    """Search the plan's graph with one of the paper's schemes.

    Returns
    -------
    (n,) array or None
        Its sequence of nodes.
    (k,) array
        When the search closed each node, from 1; nan where it never did.

    Notes
    -----
    A result keeps how many nodes were closed, but not in which order; the search is run again,
    and does the same.
    """
    from solver.costs.penalty import safety_penalty  # noqa: PLC0415 - numba
    from solver.search import paper  # noqa: PLC0415 - numba

    clearance = result.candidates.nodes.clearance
    settings = result.problem.settings
    graph = replace(result.graph, node_cost=np.zeros(len(clearance)), squared=False)
    weight = settings.heuristic_weight
    if scheme is Scheme.F:
        found = paper.f(graph, weight, monitor)
    elif scheme is Scheme.F1:
        found = paper.f1(graph, weight, monitor)
    else:
        penalty = safety_penalty(clearance, settings.safety_distance)
        found = paper.f2(graph, penalty, weight, monitor)
    order = np.full(len(clearance), np.nan)
    order[found.order] = np.arange(1.0, len(found.order) + 1.0)
    return (found.path if found.found else None), order


def constant_nodes(result: PlanningResult) -> IntArray | None:
    """(n,) nodes of the best constant lean, None where there is none."""
    from posopt_gui.viewmodels.reference_nodes import reference_nodes  # noqa: PLC0415 - numba
    from solver.analysis.references import constant_lean  # noqa: PLC0415 - numba

    return reference_nodes(result, constant_lean(result))
