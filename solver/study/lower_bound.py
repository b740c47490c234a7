"""A lower bound of the joint cost over all leans, not only those of a grid.

The lean range is cut into intervals. Over an interval every model angle stays within a box
around its middle, and no clearance rises by more than the bodies move. Dropping what cannot
keep the hard minimum and taking the cheapest way from box to box gives a cost that no sequence
of any leans can undercut. Intervals whose best sequence exceeds a known plan are left out, the
others halved, until the bound is close enough or there are too many.

Boxes alone lose at every waypoint what a box is wide. Most of it is not lost: with a sign s for
every joint and waypoint the cost |dq| of a gap is counted as |dq| - s' q' + s q, which sums to
the same over a whole sequence up to its two ends, and a joint that keeps its direction then
costs nothing wherever in the boxes it is.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace

import numpy as np

from solver.analysis.result import Sequence
from solver.candidates.generate import generate
from solver.candidates.outcomes import Outcome
from solver.collision.scene import CLEARANCE, CollisionScene
from solver.errors import PlanningError
from solver.kinematics.arm import forward_frames
from solver.model.problem import PlanningProblem
from solver.model.robot import JOINTS
from solver.model.settings import CostWeights, EdgeCost, Turns
from solver.progress import Monitor, checkpoint
from solver.study.published import Parameters
from solver.study.ragged import candidates_at, solve_exactly
from solver.transforms import FloatArray, IntArray
from solver.units import TURN

ROUNDING = 1e-9
"""What distances and costs may be off by rounding [m and 1]."""

STAGE = "lower bound"

TILE = 512
"""Source boxes that are compared with all targets at a time."""


OTHER_BRANCHES = 10
"""How much less work goes into a branch that the plan does not take."""


@dataclass(frozen=True, slots=True, eq=False)
class Boxes:
    """Boxes of model angles of all waypoints.

    `middle`, `half` (k, 6) are range-normalised; `offsets` (n + 1,) as in a layered graph;
    `interval` (k,) is the row of the interval that a box belongs to.
    """

    middle: FloatArray
    half: FloatArray
    offsets: IntArray
    interval: IntArray

    @property
    def pairs(self) -> int:
        """Pairs of boxes of neighbouring waypoints."""
        sizes = np.diff(self.offsets)
        return int((sizes[:-1] * sizes[1:]).sum())


@dataclass(frozen=True, slots=True, eq=False)
class LowerBound:
    """The bound, the plan's cost that it belongs to, and how finely it was computed.

    `value` is 0 where nothing better could be shown; `step` [rad] is the width of the
    last intervals, `pairs` what the last round compared; `branch` is the one that it is about.
    """

    branch: int
    value: float
    cost: float
    step: float
    pairs: int

    @property
    def gap(self) -> float:
        """Share of the plan's cost that a better choice of leans could save at most."""
        return (self.cost - self.value) / self.cost if self.cost > 0.0 else 0.0


def obstacle(problem: PlanningProblem) -> str:
    """Why no bound can be computed for a problem; '' where one can."""
    settings = problem.settings
    if len(settings.lead.angles()) > 1 or len(settings.spin.angles()) > 1:
        return "more than one angle is free"
    if len(settings.lean.angles()) < 2:
        return "the lean is fixed"
    if len(problem.toolpath.passes) > 1 and len(settings.branches) > 1:
        return "the branch may change between passes"
    if settings.edge_cost is not EdgeCost.ABSOLUTE or settings.weights != CostWeights():
        return "the cost is not the plain joint cost"
    return ""


def lower_bounds(
    problem: PlanningProblem, plan: Sequence, parameters: Parameters, monitor: Monitor
) -> tuple[LowerBound, ...]:
    """Bound the joint cost of every sequence whose clearance keeps the safety distance.

    `problem` must have no `obstacle`; `plan` is a sequence that keeps the safety distance, whose
    cost is the one to beat. Within a pass the branch does not change, so every branch is bounded
    for itself; the plan's own gets most of the work.
    """
    found = []
    for branch in problem.settings.branches:
        alone = replace(problem, settings=replace(problem.settings, branches=(branch,)))
        own = bool((plan.branch == branch).all())
        signs = _directions(plan if own else _own_plan(alone, monitor))
        most = parameters.bound_pairs // (1 if own else OTHER_BRANCHES)
        found.append(
            _branch_bound(alone, plan.joint_cost, signs, most, parameters.bound_gap, monitor)
        )
    return tuple(found)


def _own_plan(problem: PlanningProblem, monitor: Monitor) -> Sequence | None:
    """A plan of the problem's branch alone, as cheap as the grid allows; None without one."""
    try:
        return solve_exactly(generate(problem, monitor), monitor)[0]
    except PlanningError:
        return None


def _branch_bound(
    problem: PlanningProblem,
    cost: float,
    directions: FloatArray | None,
    most_pairs: int,
    wanted_gap: float,
    monitor: Monitor,
) -> LowerBound:
    """The bound over one branch; the plan's cost where nothing in it is cheaper."""
    sweep, waypoints = problem.settings.lean, len(problem.toolpath)
    (branch,) = problem.settings.branches
    signs = np.zeros((waypoints, JOINTS)) if directions is None else directions
    count = int(np.ceil((sweep.upper - sweep.lower) / sweep.step - ROUNDING))
    step = (sweep.upper - sweep.lower) / count
    kept = [np.arange(count)] * waypoints
    bound = LowerBound(branch, 0.0, cost, step, 0)
    while True:
        boxes = _boxes(problem, kept, step, monitor)
        if boxes.pairs > most_pairs:
            return bound
        value, through = _cheapest_way(boxes, signs, monitor)
        bound = LowerBound(branch, float(np.clip(value, 0.0, cost)), cost, step, boxes.pairs)
        alive = np.unique(boxes.interval[through <= cost + ROUNDING])
        flat = np.concatenate(kept)
        owner = np.repeat(np.arange(len(kept)), [len(one) for one in kept])[alive]
        if bound.gap <= wanted_gap or not len(alive):
            return bound
        halves = 2 * flat[alive, None] + [0, 1]
        kept = [halves[owner == waypoint].ravel() for waypoint in range(len(kept))]
        step /= 2.0


def _directions(plan: Sequence | None) -> FloatArray | None:
    """(n, 6) sign of each joint's motion at each waypoint: that of the larger neighbouring step."""
    if plan is None:
        return None
    steps = np.diff(plan.model, axis=0)
    before = np.vstack([steps[:1], steps])
    after = np.vstack([steps, steps[-1:]])
    signs: FloatArray = np.sign(np.where(np.abs(before) > np.abs(after), before, after))
    return signs


def _boxes(problem: PlanningProblem, kept: list[IntArray], step: float, monitor: Monitor) -> Boxes:
    """Boxes of all intervals that may hold a pose which keeps the safety distance."""
    low, ranges = problem.settings.lean.lower, problem.robot.cost_ranges
    other = (float(problem.settings.lead.lower), float(problem.settings.spin.lower))

    def at(share: float) -> list[FloatArray]:
        return [
            np.column_stack([low + (one + share) * step, *(np.full(len(one), x) for x in other)])
            for one in kept
        ]

    middle, first, last = (candidates_at(problem, at(share), monitor) for share in (0.5, 0.0, 1.0))
    owner = np.repeat(np.arange(len(kept)), [len(one) for one in kept])
    rows, slots = np.nonzero(middle.outcome[:, 0, :] != Outcome.UNREACHABLE)
    centre = middle.joints[rows, 0, slots]
    ends = [_nearest_turn(one.joints[rows, 0, slots], centre) for one in (first, last)]
    bend = np.abs(ends[0] + ends[1] - 2.0 * centre)
    half = np.maximum(*(np.abs(one - centre) for one in ends)) + bend
    clearance = middle.clearance[rows, 0, slots]
    way = _body_way(problem, middle.scene, centre, ends)
    # A pose that an earlier filter rejects has no clearance; its interval is kept.
    fits = ~(clearance + way < problem.settings.safety_distance - ROUNDING)
    hit = middle.outcome[rows, 0, slots] == Outcome.COLLISION
    fits &= ~(hit & (way < problem.settings.safety_distance - ROUNDING))
    rows, centre, half = rows[fits], centre[fits], half[fits]
    turned, number = _within_limits(problem, centre, half)
    waypoint = owner[rows[number]]
    order = np.argsort(waypoint, kind="stable")
    return Boxes(
        turned[order] / ranges,
        half[number][order] / ranges,
        np.searchsorted(waypoint[order], np.arange(len(kept) + 1)).astype(np.int64),
        rows[number][order],
    )


def _nearest_turn(joints: FloatArray, to: FloatArray) -> FloatArray:
    """Joints shifted by whole turns to lie nearest to others."""
    shifted: FloatArray = joints - TURN * np.round((joints - to) / TURN)
    return shifted


def _within_limits(
    problem: PlanningProblem, centre: FloatArray, half: FloatArray
) -> tuple[FloatArray, IntArray]:
    """All turns of boxes that touch the joint limits, and the box that each is a turn of."""
    robot = problem.robot
    limits = problem.joint_limits
    if problem.settings.turns is Turns.PRINCIPAL:
        limits = np.column_stack(
            [np.maximum(limits[:, 0], -np.pi), np.minimum(limits[:, 1], np.pi)]
        )
    pendant = centre @ robot.pendant_from_model.T
    pendant -= TURN * np.ceil((pendant - np.pi) / TURN)
    reach = half @ np.abs(robot.pendant_from_model).T + ROUNDING
    turns: list[FloatArray] = []
    numbers: list[IntArray] = []
    fits = {
        shift: (pendant + shift * TURN + reach >= limits[:, 0])
        & (pendant + shift * TURN - reach <= limits[:, 1])
        for shift in (-1, 0, 1)
    }
    choices = [[shift for shift in fits if fits[shift][:, joint].any()] for joint in range(JOINTS)]
    for shifts in itertools.product(*choices):
        inside = np.logical_and.reduce([fits[s][:, j] for j, s in enumerate(shifts)])
        chosen = np.flatnonzero(inside)
        numbers.append(chosen)
        turns.append((pendant[chosen] + TURN * np.array(shifts)) @ robot.model_from_pendant.T)
    if not turns:
        return np.empty((0, JOINTS)), np.empty(0, dtype=np.int64)
    return np.concatenate(turns), np.concatenate(numbers)


def _body_way(
    problem: PlanningProblem, scene: CollisionScene, centre: FloatArray, ends: list[FloatArray]
) -> FloatArray:
    """(k,) farthest that a point of a body which counts in the clearance moves in an interval [m].

    From the middle to either end a body's origin is displaced and the body turned; a point at
    the body's radius moves by no more than both together. The difference of both ways is added
    for what the motion bends in between.
    """
    packed = scene.packed
    counting = {rule.row for rule in scene.mesh_rules if rule.counts}
    counting |= set(np.flatnonzero((packed.rule == CLEARANCE).any(axis=1)).tolist())
    poses = [
        forward_frames(problem.robot, one @ problem.robot.pendant_from_model.T)
        for one in (centre, *ends)
    ]
    farthest = np.zeros(len(centre))
    for row in sorted(counting):
        frames = [one[:, packed.frame[row]] for one in poses]
        turns = [one[:, :3, :3] for one in frames]
        origins = [one[:, :3, :3] @ packed.moving.position[row] + one[:, :3, 3] for one in frames]
        ways = [
            np.linalg.norm(origins[end] - origins[0], axis=1)
            + packed.radius[row] * _turn_angle(turns[0], turns[end])
            for end in (1, 2)
        ]
        farthest = np.maximum(farthest, np.maximum(*ways) + np.abs(ways[0] - ways[1]))
    return farthest


def _turn_angle(one: FloatArray, other: FloatArray) -> FloatArray:
    """(k,) angle between rotations (k, 3, 3) [rad], accurate for small ones."""
    chord = np.linalg.norm(one - other, axis=(1, 2)) / np.sqrt(8.0)
    angle: FloatArray = 2.0 * np.arcsin(np.clip(chord, 0.0, 1.0))
    return angle


def _cheapest_way(
    boxes: Boxes, directions: FloatArray, monitor: Monitor
) -> tuple[float, FloatArray]:
    """Least cost from box to box, and (k,) the least through each box."""
    layers = [slice(a, b) for a, b in itertools.pairwise(boxes.offsets.tolist())]
    if any(one.start == one.stop for one in layers):
        return np.inf, np.full(len(boxes.middle), np.inf)
    forward = np.zeros(len(boxes.middle))
    backward = np.zeros(len(boxes.middle))
    first, last = layers[0], layers[-1]
    forward[first] = -(boxes.middle[first] @ directions[0]) - boxes.half[first] @ np.abs(
        directions[0]
    )
    backward[last] = boxes.middle[last] @ directions[-1] - boxes.half[last] @ np.abs(directions[-1])
    for gap in range(len(layers) - 1):
        source, target = layers[gap], layers[gap + 1]
        best = np.full(target.stop - target.start, np.inf)
        for part in _tiles(source):
            checkpoint(monitor, STAGE, gap, len(layers))
            way = _gap_bound(boxes, part, target, directions[gap], directions[gap + 1])
            best = np.minimum(best, (forward[part][:, None] + way).min(axis=0))
        forward[target] = best
    for gap in range(len(layers) - 2, -1, -1):
        source, target = layers[gap], layers[gap + 1]
        for part in _tiles(source):
            checkpoint(monitor, STAGE, gap, len(layers))
            way = _gap_bound(boxes, part, target, directions[gap], directions[gap + 1])
            backward[part] = (way + backward[target][None]).min(axis=1)
    through = forward + backward
    return float(through[last].min()), through


def _tiles(layer: slice) -> list[slice]:
    return [slice(low, min(low + TILE, layer.stop)) for low in range(layer.start, layer.stop, TILE)]


def _gap_bound(
    boxes: Boxes, source: slice, target: slice, before: FloatArray, after: FloatArray
) -> FloatArray:
    """(s, t) least of sum |q' - q| - after q' + before q over the boxes of each pair.

    |q' - q| is at least t (q' - q) for every t from -1 to 1, and what is then linear in q and
    q' has its least value in a corner of the boxes.
    """
    total = np.zeros((source.stop - source.start, target.stop - target.start))
    for joint in range(boxes.middle.shape[1]):
        q, h = boxes.middle[source, joint], boxes.half[source, joint]
        q_next, h_next = boxes.middle[target, joint], boxes.half[target, joint]
        s, s_next = float(before[joint]), float(after[joint])
        least: FloatArray | None = None
        for t in sorted({-1.0, s, s_next, 1.0}):
            from_source = (s - t) * q - abs(s - t) * h
            from_target = (t - s_next) * q_next - abs(t - s_next) * h_next
            value = from_source[:, None] + from_target[None, :]
            least = value if least is None else np.maximum(least, value)
        if least is not None:
            total += least
    return total
