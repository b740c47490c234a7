"""Where a sequence changes the arm's branch within a pass, which no robot can do as it grinds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from solver.transforms import IntArray

if TYPE_CHECKING:
    from solver.analysis.result import Sequence
    from solver.model.problem import PlanningProblem

Translate = Callable[..., str]


@dataclass(frozen=True, slots=True)
class BranchBreak:
    """A sentence, and the waypoint (from 0) before the first change."""

    text: str
    waypoint: int


def branch_changes(branch: NDArray[np.signedinteger], pass_index: IntArray) -> IntArray:
    """(k,) gaps within a pass over which the branch changes: 0 is between the first two."""
    changed: IntArray = np.flatnonzero((np.diff(branch) != 0) & (np.diff(pass_index) == 0))
    return changed


def branch_break(
    problem: PlanningProblem, sequence: Sequence, translate: Translate
) -> BranchBreak | None:
    """What is to be said of a sequence that changes its branch within a pass, else None."""
    index = problem.toolpath.pass_index
    if len(sequence.branch) != len(index):
        return None
    gaps = branch_changes(sequence.branch, index)
    if not len(gaps):
        return None
    first = int(gaps[0])
    values = {"one": first + 1, "other": first + 2, "number": int(index[first]) + 1}
    if len(gaps) == 1:
        text = translate(
            "The arm changes its branch between waypoints {one} and {other}, within pass {number}.",
            **values,
        )
    else:
        text = translate(
            "The arm changes its branch between waypoints {one} and {other}, within pass "
            "{number}; such changes in all: {count}.",
            **values, count=len(gaps),
        )  # fmt: skip
    return BranchBreak(text, first)
