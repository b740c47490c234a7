"""The layered graph of pose candidates, without stored edges."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from solver.errors import ModelError
from solver.transforms import FloatArray, IntArray

JOINTS = 6

STEP_TOLERANCE = 1e-12
"""How far a step may exceed its limit before the edge is gone [rad]."""

NO_PATH: IntArray = np.empty(0, dtype=np.int64)
NO_PATH.setflags(write=False)


class Subgraph(NamedTuple):
    """Part of a graph; `nodes` (k,) holds the number of each of its nodes in the whole graph."""

    graph: LayeredGraph
    nodes: IntArray


@dataclass(frozen=True, slots=True, eq=False)
class LayeredGraph:
    """Candidates in layers, one layer a waypoint; every layer is joined to the next.

    Edges are implied, never stored: memory grows with the number of nodes K. An edge costs
    ``gap_weight * sum(|delta theta_l| / range_l)``, or with `squared`
    ``gap_weight * sum((delta theta_l / range_l)^2)``. It exists only where every step of a
    pendant joint and the step of the lean stay within the limits of its gap.

    Attributes
    ----------
    offsets : (N + 1,) int array
        The nodes of layer i are ``offsets[i]:offsets[i + 1]``; a layer may be empty.
    joints : (K, 6) array
        Model angles [rad]; the cost is in model angles, as in the paper.
    ranges : (6,) array
        What a change of each model angle is divided by [rad].
    node_cost : (K,) array
        Finite and not negative; counts on the first layer too.
    gap_weight : (N - 1,) array
        Multiplier of the edge cost of each gap: 1 within a pass, the link weight between passes.
    steps, step_limits : (K, 6) and (N - 1, 6) arrays or None
        Pendant joints and the largest step of each over each gap [rad]; infinite: no bound.
    lean, lean_limits : (K,) and (N - 1,) arrays or None
        Lean and its largest step over each gap [rad]; infinite: no bound.

    Arrays are copied and read-only; one that is read-only already is shared.
    """

    offsets: IntArray
    joints: FloatArray
    ranges: FloatArray
    node_cost: FloatArray
    gap_weight: FloatArray
    steps: FloatArray | None = None
    step_limits: FloatArray | None = None
    lean: FloatArray | None = None
    lean_limits: FloatArray | None = None
    squared: bool = False

    def __post_init__(self) -> None:
        put = object.__setattr__
        put(self, "offsets", _kept("offsets", self.offsets, (-1,), np.int64))
        self._check_offsets()
        count, gaps = self.node_count, self.layer_count - 1
        shapes: dict[str, tuple[int, ...]] = {
            "joints": (count, JOINTS),
            "ranges": (JOINTS,),
            "node_cost": (count,),
            "gap_weight": (gaps,),
            "steps": (count, JOINTS),
            "step_limits": (gaps, JOINTS),
            "lean": (count,),
            "lean_limits": (gaps,),
        }
        for name, shape in shapes.items():
            values = getattr(self, name)
            if values is not None:
                put(self, name, _kept(name, values, shape, np.float64))
        self._check_values()

    def _check_offsets(self) -> None:
        offsets = self.offsets
        if len(offsets) < 2 or offsets[0] != 0 or np.any(np.diff(offsets) < 0):
            raise ModelError("graph: offsets must ascend from 0 and delimit at least one layer")

    def _check_values(self) -> None:
        for name in ("joints", "node_cost", "gap_weight", "ranges", "steps", "lean"):
            values = getattr(self, name)
            if values is not None and not np.all(np.isfinite(values)):
                raise ModelError(f"graph: {name} must be finite")
        if not np.all(self.ranges > 0.0):
            raise ModelError("graph: ranges must be positive")
        if np.any(self.node_cost < 0.0) or np.any(self.gap_weight < 0.0):
            raise ModelError("graph: node costs and gap weights cannot be negative")
        for name, limits in (("steps", "step_limits"), ("lean", "lean_limits")):
            bound = getattr(self, limits)
            if (getattr(self, name) is None) != (bound is None):
                raise ModelError(f"graph: {name} and {limits} come together or not at all")
            if bound is not None and not np.all(bound > 0.0):
                raise ModelError(f"graph: {limits} must be positive")

    @property
    def node_count(self) -> int:
        """Number of nodes, K."""
        return int(self.offsets[-1])

    @property
    def layer_count(self) -> int:
        """Number of layers, N."""
        return len(self.offsets) - 1

    @property
    def layer_sizes(self) -> IntArray:
        """(N,) number of nodes of each layer."""
        return np.diff(self.offsets)

    @property
    def edge_count(self) -> int:
        """Number of pairs of nodes of neighbouring layers, whatever the limits forbid."""
        sizes = self.layer_sizes
        return int(np.sum(sizes[:-1] * sizes[1:]))

    @property
    def bounded_gaps(self) -> NDArray[np.bool_]:
        """(N - 1,) whether any limit of the gap is finite."""
        bounded = np.zeros(self.layer_count - 1, dtype=np.bool_)
        if self.step_limits is not None:
            bounded |= np.isfinite(self.step_limits).any(axis=1)
        if self.lean_limits is not None:
            bounded |= np.isfinite(self.lean_limits)
        return bounded

    def layer(self, index: int) -> slice:
        """Return the nodes of one layer."""
        return slice(int(self.offsets[index]), int(self.offsets[index + 1]))

    def layer_of(self, nodes: ArrayLike) -> IntArray:
        """Return the layer of each of the given nodes."""
        layers: IntArray = np.searchsorted(self.offsets, np.asarray(nodes), side="right") - 1
        return layers.astype(np.int64)

    def edge_costs(self, gap: int, sources: ArrayLike, targets: ArrayLike) -> FloatArray:
        """Cost of edges over one gap, infinite where a limit forbids one; arguments broadcast."""
        source, target = np.asarray(sources), np.asarray(targets)
        change = self.joints[target] / self.ranges - self.joints[source] / self.ranges
        terms = change * change if self.squared else np.abs(change)
        # One after the other, as the kernels add: the same edge has the same cost to the bit.
        total = terms[..., 0]
        for joint in range(1, JOINTS):
            total = total + terms[..., joint]
        allowed = np.ones(total.shape, dtype=np.bool_)
        if self.steps is not None and self.step_limits is not None:
            step = np.abs(self.steps[target] - self.steps[source])
            allowed &= np.all(step <= self.step_limits[gap] + STEP_TOLERANCE, axis=-1)
        if self.lean is not None and self.lean_limits is not None:
            tilt = np.abs(self.lean[target] - self.lean[source])
            allowed &= tilt <= self.lean_limits[gap] + STEP_TOLERANCE
        return np.where(allowed, self.gap_weight[gap] * total, np.inf)

    def path_cost(self, path: ArrayLike) -> float:
        """Cost of a sequence of one node a layer; infinite where it uses a forbidden edge.

        Raises
        ------
        ModelError
            If the sequence does not hold exactly one node of every layer, in order.
        """
        nodes = np.asarray(path, dtype=np.int64)
        if nodes.shape != (self.layer_count,) or np.any(
            (nodes < self.offsets[:-1]) | (nodes >= self.offsets[1:])
        ):
            raise ModelError(f"a sequence holds one node of each of {self.layer_count} layers")
        cost = float(self.node_cost[nodes[0]])
        for gap in range(self.layer_count - 1):
            cost += float(self.edge_costs(gap, nodes[gap], nodes[gap + 1]))
            cost += float(self.node_cost[nodes[gap + 1]])
        return cost

    def subgraph(self, mask: ArrayLike) -> Subgraph:
        """Return the graph of the nodes where `mask` (K,) is true; its layers may become empty."""
        keep = np.asarray(mask, dtype=np.bool_)
        if keep.shape != (self.node_count,):
            raise ModelError(f"the mask of a graph of {self.node_count} nodes has one value each")
        nodes = np.flatnonzero(keep).astype(np.int64)
        part = replace(
            self,
            offsets=np.searchsorted(nodes, self.offsets).astype(np.int64),
            joints=_taken(self.joints, nodes),
            node_cost=_taken(self.node_cost, nodes),
            steps=None if self.steps is None else _taken(self.steps, nodes),
            lean=None if self.lean is None else _taken(self.lean, nodes),
        )
        return Subgraph(part, nodes)


def _taken(values: FloatArray, nodes: IntArray) -> FloatArray:
    """Return the values of some nodes, read-only, so that the graph need not copy them."""
    taken: FloatArray = np.take(values, nodes, axis=0)
    taken.setflags(write=False)
    return taken


def _kept(name: str, values: Any, shape: tuple[int, ...], dtype: Any) -> NDArray[Any]:
    """Return a read-only contiguous array of the given shape; -1 matches any length."""
    array = np.asarray(values)
    if array.ndim != len(shape) or any(
        want not in (-1, have) for want, have in zip(shape, array.shape, strict=True)
    ):
        raise ModelError(f"graph: {name} must have the shape {shape}, got {array.shape}")
    shared = array.dtype == dtype and array.flags.c_contiguous and not array.flags.writeable
    if not shared:
        array = np.array(array, dtype=dtype, order="C")
        array.setflags(write=False)
    return array
