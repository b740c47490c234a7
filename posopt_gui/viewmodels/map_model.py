"""The map's cells: waypoint x lean, one page per branch and turn, and one 'best of all'."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from posopt_gui.viewmodels.branch_breaks import branch_changes
from posopt_gui.viewmodels.map_colours import (
    CLASS_RANK,
    NO_VALUE_INDEX,
    REJECTED_INDEX,
    ByteArray,
    CellClass,
    Layer,
    Scale,
)
from solver.candidates.outcomes import Outcome
from solver.transforms import FloatArray, IntArray
from solver.units import DEG_PER_RAD, MM_PER_M

if TYPE_CHECKING:
    from solver.candidates.generate import CandidateSet

PERCENT = 100.0

RANK_WEIGHT = 1e6
"""What a worse class counts against any extra cost when the best of a cell is chosen."""


@dataclass(frozen=True, slots=True)
class Choice:
    """Which candidates a page shows; None is the best of all.

    `slot` is the branch's place in the candidates, `turn` the representative, `lead` and
    `spin` places in the sweeps of these angles.
    """

    slot: int | None = None
    turn: int | None = None
    lead: int | None = None
    spin: int | None = None


BEST_OF_ALL = Choice()


@dataclass(frozen=True, slots=True)
class Page:
    """A branch and turn that hold nodes; `letters` are those of its CONFIG, such as 'N U T'."""

    slot: int | None
    turn: int | None
    branch: int | None
    letters: str
    nodes: int


@dataclass(frozen=True, slots=True, eq=False)
class Cells:
    """What a page shows, n waypoints by m leans.

    Attributes
    ----------
    kind : (n, m) array
        Values of :class:`CellClass`.
    node : (n, m) array
        The node that stands in the cell, -1 for none.
    orientation, slot : (n, m) arrays
        The candidate that stands in the cell, rejected ones too.
    values : (n, m) array or None
        The layer's values in its scale's unit, nan where there are none; None by outcome.
    """

    layer: Layer
    choice: Choice
    kind: ByteArray
    node: IntArray
    orientation: IntArray
    slot: IntArray
    values: FloatArray | None

    def indices(self, scale: Scale | None) -> ByteArray:
        """(n, m) indices into the colour table."""
        if self.values is None or scale is None:
            return self.kind
        indices = scale.indices(self.values)
        return np.where(self.node < 0, REJECTED_INDEX, np.maximum(indices, NO_VALUE_INDEX)).astype(
            np.uint8
        )


@dataclass(frozen=True, slots=True)
class Reading:
    """A candidate under the mouse; angles in [deg], `turn` None where no node stands there."""

    waypoint: int
    row: int
    lean: float
    lead: float
    spin: float
    orientation: int
    slot: int
    branch: int
    turn: int | None
    turns: int
    kind: CellClass
    node: int | None


class MapModel:
    """Pages and cells of a set of candidates; it is derived once and never changes."""

    def __init__(self, candidates: CandidateSet) -> None:
        self.candidates = candidates
        settings = candidates.problem.settings
        self.leads = settings.lead.angles() * DEG_PER_RAD
        self.spins = settings.spin.angles() * DEG_PER_RAD
        self._others = len(self.leads) * len(self.spins)
        self.leans = candidates.orientations[:: self._others, 0] * DEG_PER_RAD
        self.waypoints = len(candidates.outcome)
        self._values: dict[Layer, FloatArray] = {}

    @property
    def rows(self) -> int:
        """Number of leans, m."""
        return len(self.leans)

    @property
    def lean_step(self) -> float:
        """Height of a cell [deg]."""
        return self.candidates.problem.settings.lean.step * DEG_PER_RAD

    def prepare(self) -> None:
        """Work out now what every page needs."""
        _ = self.pages, self.class_of, self._node_class, self._node_cell

    @cached_property
    def class_of(self) -> ByteArray:
        """(n, m, leads x spins, b) class of every branch candidate."""
        candidates = self.candidates
        kind = candidates.outcome.astype(np.uint8)
        safety = candidates.problem.settings.safety_distance
        with np.errstate(invalid="ignore"):
            near = (kind == Outcome.FEASIBLE) & (candidates.clearance < safety)
        kind[near] = CellClass.NEAR
        return kind.reshape(self.waypoints, self.rows, self._others, -1)

    @cached_property
    def _node_class(self) -> ByteArray:
        safety = self.candidates.problem.settings.safety_distance
        near = self.candidates.nodes.clearance < safety
        return np.where(near, CellClass.NEAR, CellClass.SAFE).astype(np.uint8)

    @cached_property
    def _node_cell(self) -> IntArray:
        """(k,) number of the cell of every node; it never falls, as the nodes are ordered."""
        candidate = self.candidates.nodes.candidate
        cell: IntArray = candidate[:, 0].astype(np.int64) * self.rows
        return cell + candidate[:, 1] // self._others

    @cached_property
    def pages(self) -> tuple[Page, ...]:
        """'Best of all', then every branch and turn that holds nodes."""
        nodes = self.candidates.nodes
        pages = [Page(None, None, None, "", len(nodes))]
        if len(nodes):
            keys = nodes.candidate[:, 2].astype(np.int64) * 256 + nodes.candidate[:, 3]
            counts = np.bincount(keys)
            for key in np.flatnonzero(counts):
                slot, turn = divmod(int(key), 256)
                branch = int(self.candidates.branches[slot])
                letters = self._letters(int(np.argmax(keys == key)))
                pages.append(Page(slot, turn, branch, letters, int(counts[key])))
        return tuple(pages)

    def _letters(self, node: int) -> str:
        from solver.kinematics.configuration import config_string  # noqa: PLC0415 - numba

        candidates = self.candidates
        joints = candidates.nodes.pendant[node]
        return config_string(candidates.problem.robot, joints).split(",")[0]

    def node_values(self, layer: Layer) -> FloatArray | None:
        """(k,) values that follow from the nodes alone; None where a search has to give them."""
        if layer not in self._values:
            if layer is Layer.CLEARANCE:
                self._values[layer] = self.candidates.nodes.clearance * MM_PER_M
            elif layer is Layer.MANIPULABILITY:
                self._values[layer] = self._manipulability()
            elif layer is Layer.LIMIT_MARGIN:
                self._values[layer] = limit_margin(self.candidates)
            else:
                return None
        return self._values[layer]

    def _manipulability(self) -> FloatArray:
        from solver.kinematics.jacobian import posture_manipulability  # noqa: PLC0415 - numba

        nodes = self.candidates.nodes
        return posture_manipulability(self.candidates.problem.robot, nodes.pendant)

    def cells(self, layer: Layer, choice: Choice, given: FloatArray | None = None) -> Cells:
        """The cells of a page.

        Parameters
        ----------
        layer : Layer
            What they are coloured by; in a cell of several candidates the best by it is shown.
        choice : Choice
            Which candidates take part.
        given : (k,) array, optional
            Values of the nodes from a search: the extra cost [%] for the layers by outcome
            and by extra cost, the order of expansion for the layers of these names.
        """
        values = self.node_values(layer)
        if values is None:
            missing = np.full(len(self.candidates.nodes), np.nan)
            values = missing if given is None else given
        node = self._best_nodes(layer, choice, values)
        kind, orientation, slot = self._best_candidates(choice)
        held = node >= 0
        candidate = self.candidates.nodes.candidate[node[held]]
        kind[held] = self._node_class[node[held]]
        orientation[held], slot[held] = candidate[:, 1], candidate[:, 2]
        shown = None
        if layer is not Layer.OUTCOME:
            shown = np.full(node.shape, np.nan)
            shown[held] = values[node[held]]
        return Cells(layer, choice, kind, node, orientation, slot, shown)

    def _best_nodes(self, layer: Layer, choice: Choice, values: FloatArray) -> IntArray:
        """(n, m) the node of least badness in each cell, the first of equal ones."""
        best = np.full(self.waypoints * self.rows, -1, dtype=np.int64)
        rows = np.flatnonzero(self._takes_part(choice))
        if not len(rows):
            return best.reshape(self.waypoints, self.rows)
        badness = self._badness(layer, rows, values[rows])
        cell = self._node_cell[rows]
        starts = np.flatnonzero(np.diff(cell, prepend=-1))
        least = np.minimum.reduceat(badness, starts)
        equal = np.flatnonzero(badness == np.repeat(least, np.diff(np.append(starts, len(rows)))))
        best[cell[starts]] = rows[equal[np.searchsorted(equal, starts)]]
        return best.reshape(self.waypoints, self.rows)

    def _badness(self, layer: Layer, rows: IntArray, values: FloatArray) -> FloatArray:
        if layer in {Layer.CLEARANCE, Layer.MANIPULABILITY, Layer.LIMIT_MARGIN}:
            return -values
        worst = RANK_WEIGHT / 2.0
        cost = np.minimum(np.where(np.isnan(values), worst, values), worst)
        if layer is Layer.OUTCOME:
            cost = cost - RANK_WEIGHT * CLASS_RANK[self._node_class[rows]]
        return cost

    def _takes_part(self, choice: Choice) -> NDArray[np.bool_]:
        candidate = self.candidates.nodes.candidate
        mask = np.ones(len(candidate), dtype=np.bool_)
        if choice.slot is not None:
            mask &= candidate[:, 2] == choice.slot
        if choice.turn is not None:
            mask &= candidate[:, 3] == choice.turn
        other = candidate[:, 1] % self._others
        if choice.lead is not None:
            mask &= other // len(self.spins) == choice.lead
        if choice.spin is not None:
            mask &= other % len(self.spins) == choice.spin
        return mask

    def _others_of(self, choice: Choice) -> IntArray:
        """Places of the chosen leads and spins among all their combinations."""
        other = np.arange(self._others)
        mask = np.ones(self._others, dtype=np.bool_)
        if choice.lead is not None:
            mask &= other // len(self.spins) == choice.lead
        if choice.spin is not None:
            mask &= other % len(self.spins) == choice.spin
        return np.flatnonzero(mask)

    def _best_candidates(self, choice: Choice) -> tuple[ByteArray, IntArray, IntArray]:
        """(n, m) class, orientation and slot of the candidate that came furthest."""
        others = self._others_of(choice)
        slots = np.arange(len(self.candidates.branches))
        if choice.slot is not None:
            slots = slots[choice.slot : choice.slot + 1]
        kind = self.class_of
        if len(others) < self._others:
            kind = kind[:, :, others]
        if len(slots) < kind.shape[3]:
            kind = kind[..., slots]
        kind = kind.reshape(self.waypoints, self.rows, -1)
        if choice.turn is not None:
            # A turn that a feasible posture does not have lies outside the joint limits.
            kind = np.where(np.isin(kind, (CellClass.SAFE, CellClass.NEAR)), 2, kind)
        place = CLASS_RANK[kind].argmax(axis=2)
        best = np.take_along_axis(kind, place[..., None], axis=2)[..., 0].astype(np.uint8)
        other = others[place // len(slots)]
        orientation = np.arange(self.rows)[None, :] * self._others + other
        return best, orientation.astype(np.int64), slots[place % len(slots)].astype(np.int64)

    def scale(self, layer: Layer, values: FloatArray | None) -> Scale | None:
        """The scale of a layer over all nodes, so that the pages can be compared."""
        if layer is Layer.OUTCOME:
            return None
        known = self.node_values(layer)
        values = known if known is not None else values
        finite = values[np.isfinite(values)] if values is not None else np.empty(0)
        low, high = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 1.0)
        settings = self.candidates.problem.settings
        if layer is Layer.CLEARANCE:
            return Scale(low, high, "mm", mark=settings.safety_distance * MM_PER_M)
        if layer is Layer.MANIPULABILITY:
            return Scale(low, high, "m³", 3)
        if layer is Layer.LIMIT_MARGIN:
            return Scale(low, high, "°")
        if layer is Layer.EXTRA_COST:
            return extra_cost_scale(high)
        return Scale(1.0, max(high, 2.0), "", reverse=True)

    def reading(self, cells: Cells, waypoint: int, row: int) -> Reading:
        """What stands in a cell."""
        orientation, slot = int(cells.orientation[waypoint, row]), int(cells.slot[waypoint, row])
        node = int(cells.node[waypoint, row])
        turn = int(self.candidates.nodes.candidate[node, 3]) if node >= 0 else None
        lean, lead, spin = self.candidates.orientations[orientation] * DEG_PER_RAD
        return Reading(
            waypoint, row, float(lean), float(lead), float(spin), orientation, slot,
            int(self.candidates.branches[slot]), turn,
            int(self.candidates.turns[waypoint, orientation, slot]),
            CellClass(int(cells.kind[waypoint, row])), node if node >= 0 else None,
        )  # fmt: skip

    def row_of(self, lean: float) -> int:
        """The row of cells that is nearest to a lean [deg]."""
        return int(np.abs(self.leans - lean).argmin())

    def row_of_orientation(self, orientation: int) -> int:
        """The row of cells that an orientation stands in."""
        return orientation // self._others

    def row_of_node(self, node: int) -> int:
        """The row of cells that a node stands in."""
        return self.row_of_orientation(int(self.candidates.nodes.candidate[node, 1]))

    @property
    def empty_layers(self) -> IntArray:
        """Waypoints without any node."""
        return np.flatnonzero(np.diff(self.candidates.nodes.offsets) == 0)

    @property
    def pass_starts(self) -> tuple[int, ...]:
        """First waypoint (from 0) of every pass but the first."""
        passes = self.candidates.problem.toolpath.passes
        return tuple(int(start) for start in np.cumsum([len(one) for one in passes])[:-1])

    def branch_breaks(self, slot: NDArray[np.signedinteger]) -> FloatArray:
        """(k,) places, in waypoints from 1, where a line's branch changes within a pass."""
        gaps = branch_changes(slot, self.candidates.problem.toolpath.pass_index)
        return gaps.astype(np.float64) + 1.5

    def known_values(self, node: int) -> dict[Layer, float]:
        """Values of a node that take no computation."""
        values = {layer: float(known[node]) for layer, known in self._values.items()}
        return values | {Layer.CLEARANCE: float(self.candidates.nodes.clearance[node]) * MM_PER_M}

    def counts(self, kind: ByteArray) -> dict[CellClass, int]:
        """Number of cells of every class that occurs."""
        found = np.bincount(kind.ravel(), minlength=len(CellClass))
        return {one: int(found[one]) for one in CellClass if found[one]}


def limit_margin(candidates: CandidateSet) -> FloatArray:
    """(k,) distance of every node to the nearest joint limit, the elbow's included [deg]."""
    pendant, problem = candidates.nodes.pendant, candidates.problem
    limits = problem.joint_limits
    margin = np.full(len(pendant), np.inf)
    for joint in range(pendant.shape[1]):
        np.minimum(margin, pendant[:, joint] - limits[joint, 0], out=margin)
        np.minimum(margin, limits[joint, 1] - pendant[:, joint], out=margin)
    elbow = pendant[:, 1] + pendant[:, 2]
    low, high = problem.robot.elbow_limits
    least: FloatArray = np.minimum(margin, np.minimum(elbow - low, high - elbow))
    return least * DEG_PER_RAD


def extra_cost_percent(extra_cost: FloatArray, cost: float) -> FloatArray:
    """Extra costs as shares of the plan's cost [%]; inf and nan stay what they are."""
    return extra_cost * (PERCENT / cost) if cost > 0.0 else extra_cost * PERCENT


def extra_cost_scale(high: float) -> Scale:
    """A scale from nothing to `high` [%] that tells small extra costs apart too."""
    high = max(high, 1e-3)
    power = math.floor(math.log10(high / 100.0))
    return Scale(0.0, high, "%", max(0, -power), reverse=True, knee=10.0**power)
