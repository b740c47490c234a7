"""A grid of orientations refined around the optimum until a refinement gains next to nothing."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from solver.analysis.result import Sequence
from solver.candidates.generate import CandidateSet
from solver.model.problem import PlanningProblem
from solver.model.settings import PlanningSettings, Sweep
from solver.progress import Monitor
from solver.study.published import Parameters
from solver.study.ragged import candidates_at, solve_exactly
from solver.transforms import FloatArray, IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Round:
    """One refinement: the lean step [rad], nodes, the optimum and its gain over the round before.

    `gain` is a share of the cost before, nan in the first round.
    """

    step: float
    nodes: int
    sequence: Sequence
    gain: float


@dataclass(frozen=True, slots=True, eq=False)
class Refined:
    """All rounds; `ended` says in words why there is no further one."""

    problem: PlanningProblem
    rounds: tuple[Round, ...]
    hard_minimum: float
    ended: str

    @property
    def sequence(self) -> Sequence:
        """The last round's optimum."""
        return self.rounds[-1].sequence


@dataclass(frozen=True, slots=True, eq=False)
class Lattice:
    """Orientations as whole steps about lean, lead and spin from the lower ends of the sweeps.

    `rows[i]` (k_i, 3) are those of waypoint i; `most` (3,) is the last step of each sweep.
    """

    lower: FloatArray
    step: FloatArray
    most: IntArray
    rows: tuple[IntArray, ...]

    def angles(self) -> list[FloatArray]:
        """(k_i, 3) orientations of every waypoint [rad]."""
        return [self.lower + self.step * rows for rows in self.rows]

    def halved(self, kept: list[IntArray]) -> Lattice:
        """Half the step, with the kept orientations and everything one new step around them."""
        free = self.most > 0
        most = 2 * self.most
        axes = [np.arange(-1, 2) if one else np.zeros(1, np.int64) for one in free]
        around = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
        rows = []
        for part in kept:
            grown = (2 * part[:, None, :] + around[None]).reshape(-1, 3)
            inside = np.all((grown >= 0) & (grown <= most), axis=1)
            rows.append(np.unique(grown[inside], axis=0))
        step = np.where(free, self.step / 2.0, self.step)
        return Lattice(self.lower, step, most, tuple(rows))


def first_lattice(settings: PlanningSettings, waypoints: int) -> Lattice:
    """The grid of the settings, the same for every waypoint."""
    sweeps: tuple[Sweep, ...] = (settings.lean, settings.lead, settings.spin)
    counts = [len(one.angles()) for one in sweeps]
    grid = np.stack(np.meshgrid(*map(np.arange, counts), indexing="ij"), axis=-1).reshape(-1, 3)
    return Lattice(
        np.array([one.lower for one in sweeps]),
        np.array([one.step for one in sweeps]),
        np.array(counts) - 1,
        (grid,) * waypoints,
    )


def refine(problem: PlanningProblem, parameters: Parameters, monitor: Monitor) -> Refined:
    """Halve the steps of all swept angles around what is nearly optimal, round after round.

    Every round solves the graph of its orientations exactly, under every constraint of the
    problem and the hard minimum that the first round could keep. The optimum of a round is
    among the orientations of the next, so the cost never rises.

    Raises
    ------
    InfeasiblePathError
        When the first grid holds no sequence.
    """
    lattice = first_lattice(problem.settings, len(problem.toolpath))
    rounds: list[Round] = []
    hard, low_gains, ended = np.inf, 0, "all halvings were made"
    for _ in range(parameters.refine_halvings + 1):
        candidates = candidates_at(problem, lattice.angles(), monitor)
        sequence, extra, kept_minimum = solve_exactly(candidates, monitor)
        if not rounds and kept_minimum < problem.settings.safety_distance:
            # From here on what the first grid can keep is required of the finer ones.
            problem = replace(
                problem, settings=replace(problem.settings, safety_distance=kept_minimum)
            )
        hard = min(hard, kept_minimum)
        gain = 1.0 - sequence.cost / rounds[-1].sequence.cost if rounds else float("nan")
        rounds.append(Round(float(lattice.step[0]), len(candidates.nodes), sequence, gain))
        low_gains = low_gains + 1 if gain < parameters.refine_gain else 0
        if low_gains >= parameters.refine_patience:
            ended = "the gain per halving fell below the bound"
            break
        kept = _near_optimal(candidates, lattice, extra, parameters.refine_keep * sequence.cost)
        lattice = lattice.halved(kept)
        branches = len(problem.settings.branches)
        if sum(map(len, lattice.rows)) * branches > parameters.refine_nodes:
            ended = "a finer grid would hold too many orientations"
            break
    return Refined(problem, tuple(rounds), float(hard), ended)


def _near_optimal(
    candidates: CandidateSet, lattice: Lattice, extra: FloatArray, most: float
) -> list[IntArray]:
    """Lattice rows of every waypoint whose best sequence exceeds the optimum by at most `most`."""
    flat = np.concatenate(lattice.rows)
    near = candidates.nodes.candidate[extra <= most]
    return [
        flat[np.unique(near[near[:, 0] == waypoint, 1])] for waypoint in range(len(lattice.rows))
    ]
