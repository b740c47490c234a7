"""What planning returns: the sequence of each scheme and everything it was chosen from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from solver.candidates.generate import CandidateSet
from solver.kinematics.jacobian import posture_manipulability
from solver.model.problem import PlanningProblem
from solver.model.settings import Scheme
from solver.search.graph import LayeredGraph
from solver.transforms import FloatArray, IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Sequence:
    """One pose per waypoint.

    Attributes
    ----------
    nodes : (n,) array
        Node of every waypoint in the result's candidates.
    cost : float
        The scheme's objective.
    joint_cost : float
        Sum of range-normalised absolute changes of the model angles (the paper's edge cost).
    expanded : int or None
        Nodes closed by A*; None for the exact scheme, which has no such number.
    pendant, model : (n, 6) arrays [rad]
    angles : (n, 3) array
        Lean, lead and spin [rad].
    branch, turn : (n,) arrays
    clearance : (n,) array [m]
    manipulability : (n,) array [m^3]
    """

    scheme: Scheme
    nodes: IntArray
    cost: float
    joint_cost: float
    expanded: int | None
    pendant: FloatArray
    model: FloatArray
    angles: FloatArray
    branch: IntArray
    turn: IntArray
    clearance: FloatArray
    manipulability: FloatArray

    @property
    def least_clearance(self) -> float:
        """Smallest clearance of the sequence [m]."""
        return float(self.clearance.min())

    @property
    def mean_clearance(self) -> float:
        """Mean clearance over the waypoints [m]."""
        return float(self.clearance.mean())


def joint_cost(model: FloatArray, ranges: FloatArray) -> float:
    """Sum over steps and joints of |change of model angle| / range; (n, 6) and (6,) in [rad]."""
    return float((np.abs(np.diff(model, axis=0)) / ranges).sum())


def sequence_of(
    candidates: CandidateSet,
    scheme: Scheme,
    nodes: IntArray,
    cost: float,
    expanded: int | None = None,
) -> Sequence:
    """Collect what belongs to the chosen nodes of a candidate set."""
    table, robot = candidates.nodes, candidates.problem.robot
    chosen = table.candidate[nodes]
    model = table.model[nodes]
    return Sequence(
        scheme=scheme,
        nodes=nodes,
        cost=cost,
        joint_cost=joint_cost(model, robot.cost_ranges),
        expanded=expanded,
        pendant=table.pendant[nodes],
        model=model,
        angles=candidates.orientations[chosen[:, 1]],
        branch=candidates.branches[chosen[:, 2]],
        turn=chosen[:, 3].astype(np.int64),
        clearance=table.clearance[nodes],
        manipulability=posture_manipulability(robot, table.pendant[nodes]),
    )


@dataclass(frozen=True, slots=True, eq=False)
class PlanningResult:
    """Candidates, graph and the sequences that were found in it.

    Attributes
    ----------
    hard_minimum : float
        The clearance that every node of the exact sequence was required to have [m]: the
        safety distance, or the best reachable minimum where that cannot be met.
    clearance_met : bool
        Whether the safety distance could be required.
    extra_cost : (k,) array
        What passing through each node adds to the exact optimum; inf where no sequence
        under the hard minimum passes.
    """

    problem: PlanningProblem
    candidates: CandidateSet
    graph: LayeredGraph
    scheme: Scheme
    sequences: Mapping[Scheme, Sequence]
    hard_minimum: float
    clearance_met: bool
    extra_cost: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "sequences", MappingProxyType(dict(self.sequences)))

    @property
    def sequence(self) -> Sequence:
        """The sequence of the chosen scheme."""
        return self.sequences[self.scheme]
