"""Named check that the tool is lifted off the face before, between and behind the passes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from solver.analysis.check import Check
from solver.analysis.position_checks import at
from solver.analysis.spans import Span
from solver.analysis.trace import ProgramTrace
from solver.model.program import MotionKind
from solver.model.toolpath import Role
from solver.transforms import FloatArray
from solver.units import MM, MM_PER_M

LIFT = 7.0 * MM
"""How far the tool must come away from the line of travel: more than a lead does by its height."""

TILTED = math.sqrt(0.5)
"""Share of the approach that counts where the tool is tilted by 45 deg along the travel."""

SAME_POINT = 1e-6
"""Distance below which two waypoints give no direction of travel [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class _FaceEnd:
    """Where a pass begins or ends on the face.

    `position` is the number of the program's position there; `point` (3,) [m] and `along` (3,)
    give the line of travel, `along` being zero where a pass has a single point.
    """

    number: int
    position: int
    point: FloatArray
    along: FloatArray

    def lift(self, positions: FloatArray) -> FloatArray:
        """(k,) distances of positions (k, 3) from the line of travel [m]."""
        offset = positions - self.point
        offset = offset - np.outer(offset @ self.along, self.along)
        lift: FloatArray = np.linalg.norm(offset, axis=1)
        return lift


@dataclass(frozen=True, slots=True, eq=False)
class _Gap:
    """The free positions `first` to `last` beside the ends of one pass or two."""

    first: int
    last: int
    ends: tuple[_FaceEnd, ...]

    @property
    def words(self) -> str:
        """The passes beside the gap."""
        return " and ".join(f"pass {end.number + 1}" for end in self.ends)


def lift_check(trace: ProgramTrace) -> Check:
    """Between two passes, and where the cell has links before and behind, the tool is lifted.

    At least one position of each gap is lifted from the faces beside it, and every joint move,
    which follows no line, begins and ends at such positions. The line of travel is what counts:
    a lead goes along it.
    """
    links = trace.problem.program.links
    limit = LIFT if links is None else min(LIFT, TILTED * links.approach)
    least, where = np.inf, "one pass, the cell asks for no links"
    for number, gap in enumerate(_gaps(trace), start=1):
        lift, words = _gap_lift(trace, gap)
        if lift < least:
            least, where = lift, f"{words}, gap {number}, beside {gap.words}"
    unit = "mm off the line of travel"
    return Check(
        "lifts",
        least >= limit,
        least * MM_PER_M if np.isfinite(least) else least,
        limit * MM_PER_M,
        unit,
        where,
    )


def _gap_lift(trace: ProgramTrace, gap: _Gap) -> tuple[float, str]:
    """What a gap is lifted at least where it has to be [m], and words for where that is."""
    if gap.first > gap.last:
        return 0.0, "no position"
    tcp = trace.poses[:, :3, 3]
    lifts = np.min([end.lift(tcp) for end in gap.ends], axis=0)
    highest = gap.first + int(np.argmax(lifts[gap.first : gap.last + 1]))
    found, words = float(lifts[highest]), f"highest at {at(trace, highest)}"
    moves = trace.program.moves
    for end in range(max(gap.first, 1), min(gap.last + 2, len(moves))):
        if moves[end].kind is not MotionKind.JOINT or trace.contact[end - 1]:
            continue
        low = float(lifts[[end - 1, end]].min())
        if low < found:
            found, words = low, f"an end of the joint move to {at(trace, end)}"
    return found, words


def _gaps(trace: ProgramTrace) -> list[_Gap]:
    gaps = []
    for one, other in pairwise(trace.spans):
        ends = _face_end(trace, one, leaving=True), _face_end(trace, other, leaving=False)
        gaps.append(_Gap(ends[0].position + 1, ends[1].position - 1, ends))
    if trace.problem.program.links is not None:
        start = _face_end(trace, trace.spans[0], leaving=False)
        end = _face_end(trace, trace.spans[-1], leaving=True)
        gaps.insert(0, _Gap(0, start.position - 1, (start,)))
        gaps.append(_Gap(end.position + 1, len(trace.program.moves) - 1, (end,)))
    return gaps


def _face_end(trace: ProgramTrace, span: Span, *, leaving: bool) -> _FaceEnd:
    """The end of a pass on the face: waypoints of other roles than contact are off it."""
    roles = span.which.roles
    nodes = [number for number, role in enumerate(roles) if role is Role.CONTACT]
    nodes = nodes or list(range(len(roles)))
    low, high = nodes[0], nodes[-1]
    rows = [row for row, arc in enumerate(span.arc) if low <= arc <= high] or [0]
    if leaving:
        nodes, rows = nodes[::-1], rows[::-1]
    points = trace.problem.waypoint_poses[span.waypoint + np.array(nodes), :3, 3]
    inward = points - points[0]
    lengths = np.linalg.norm(inward, axis=1)
    apart = np.flatnonzero(lengths > SAME_POINT)
    along = inward[apart[0]] / lengths[apart[0]] if len(apart) else np.zeros(3)
    return _FaceEnd(span.number, span.first + rows[0], points[0], along)
