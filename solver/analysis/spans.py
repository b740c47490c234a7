"""Which positions of a program belong to which pass of the path, and to which place on it.

A program file does not say what its moves are for. The passes are found again from where the
TCP goes: each pass begins at the position nearest to its first waypoint and ends at the one
nearest to its last, in the order of the program.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solver.analysis.polyline import match, project
from solver.model.problem import PlanningProblem
from solver.model.toolpath import Pass
from solver.transforms import FloatArray, IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Span:
    """The positions `first` to `last` of a program that follow one pass.

    Attributes
    ----------
    number : int
        Number of the pass, from 0; `waypoint` is the number of its first waypoint.
    segment, share : (k,) arrays
        Place on the path of each position: segment of the pass, and 0..1 along it.
    distance : (k,) array
        Distance of each position from that place [m].
    """

    number: int
    which: Pass
    waypoint: int
    first: int
    last: int
    segment: IntArray
    share: FloatArray
    distance: FloatArray

    @property
    def arc(self) -> FloatArray:
        """(k,) place on the path as segment + share."""
        return self.segment + self.share


def find_spans(problem: PlanningProblem, positions: FloatArray) -> tuple[Span, ...] | None:
    """Spans of all passes among TCP positions (m, 3) in fanuc_world [m].

    None where the program has fewer positions than the passes have ends.
    """
    passes = problem.toolpath.passes
    wanted = problem.waypoint_poses[:, :3, 3]
    starts = np.cumsum([0, *map(len, passes)])
    ends: list[int] = []
    late: list[bool] = []
    for number, one in enumerate(passes):
        ends.append(int(starts[number]))
        late.append(False)
        if len(one) > 1:
            ends.append(int(starts[number + 1]) - 1)
            late.append(True)
    if len(positions) < len(ends):
        return None
    # A path that meets its own end again runs from the first visit to the last.
    rows = match(positions, wanted[ends], strictly=True, late=late)
    found = dict(zip(ends, rows.tolist(), strict=True))
    spans = []
    for number, one in enumerate(passes):
        begin, end = int(starts[number]), int(starts[number + 1])
        first, last = found[begin], found[end - 1]
        spans.append(_span(number, one, begin, wanted[begin:end], first, last, positions))
    return tuple(spans)


def _span(
    number: int,
    which: Pass,
    waypoint: int,
    path: FloatArray,
    first: int,
    last: int,
    positions: FloatArray,
) -> Span:
    own = positions[first : last + 1]
    if len(own) == len(path):
        node = np.arange(len(path), dtype=np.int64)
    else:
        node = match(path, own, strictly=False)
        node[0], node[-1] = 0, len(path) - 1
    segment, share = node.copy(), np.zeros(len(own))
    distance = np.linalg.norm(own - path[node], axis=1)
    if len(own) != len(path):
        for row in range(1, len(own) - 1):
            # A position between two waypoints lies on one of the two segments beside its node.
            low = max(int(node[row]) - 1, 0)
            near = project(own[row : row + 1], path[low : node[row] + 2])
            if near.distance[0] < distance[row] - 1e-9:
                segment[row] = low + near.segment[0]
                share[row] = near.share[0]
                distance[row] = near.distance[0]
    return Span(number, which, waypoint, first, last, segment, share, distance)
