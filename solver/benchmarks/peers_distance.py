"""Distances of convex bodies beside python-fcl and coal: the time, and the error with it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from typing import Any, NamedTuple

import numpy as np

from solver.benchmarks.peers_bracket import Bracket, PosedBody, bracket
from solver.benchmarks.peers_kinematics import median_per_item
from solver.benchmarks.peers_pairs import (
    PairSet,
    ScenePostures,
    cell_pairs,
    random_pairs,
    scene_postures,
)
from solver.benchmarks.peers_search import GET_PEERS, installed
from solver.candidates.generate import generate
from solver.collision.convex_hull import hull_triangles
from solver.collision.kernels_distance import convex_distance
from solver.collision.kernels_shapes import BOX, CAPSULE, CYLINDER, SPHERE
from solver.model.problem import PlanningProblem
from solver.transforms import FloatArray

NOTICED = 1e-6
"""An over-statement beyond this counts [m]: as far as ours may be under the distance."""

Pairs = list[tuple[PosedBody, PosedBody]]


@dataclass(frozen=True, slots=True)
class DistanceTiming:
    """One way of measuring one set of pairs.

    `per_pair` is processor time [s]; `over` and `under` the largest over- and under-statement
    against proven bounds [m], `overstated` the number of pairs over by more than 1e-6 m;
    `known_to` the widest gap between the bounds [m]. Pairs that touch or overlap are left out.
    `ratio` is to ours with one pair a call. None where nothing was measured.
    """

    pairs_of: str
    method: str
    note: str
    pairs: int
    known_to: float
    per_pair: float | None = None
    ratio: float | None = None
    over: float | None = None
    under: float | None = None
    overstated: int | None = None


class Measured(NamedTuple):
    """Distances [m] of all pairs, and nearest points where the method gives them."""

    distance: FloatArray
    points: list[tuple[FloatArray, FloatArray]]


class Meter(NamedTuple):
    """A way of measuring: `prepare` turns pairs into the calls that are timed."""

    name: str
    package: str
    prepare: Callable[[Pairs], Callable[[], Measured]]


def time_distances(
    problem: PlanningProblem, repeats: int, *, small: bool = False
) -> list[DistanceTiming]:
    """Measure the cell's pairs at feasible postures, and boxes and cylinders at random."""
    postures = scene_postures(generate(problem), 2 if small else 30)
    count = 60 if small else 3000
    rows = _time_set(cell_pairs(postures), repeats, postures)
    for square in (True, False):
        rows += _time_set(random_pairs(count, square=square), repeats)
    return rows


def _time_set(
    pair_set: PairSet, repeats: int, postures: ScenePostures | None = None
) -> list[DistanceTiming]:
    present = [one for one in METERS if installed(one.package)]
    calls = {one.name: one.prepare(pair_set.pairs) for one in present}
    found = {name: call() for name, call in calls.items()}
    pairs = pair_set.pairs
    bounds = [
        bracket(a, b, [found[name].points[i] for name in found if found[name].points])
        for i, (a, b) in enumerate(pairs)
    ]
    apart = np.array([one.low > 0.0 for one in bounds])
    known_to = max((high - low for low, high in bounds if low > 0.0), default=0.0)
    count = int(np.count_nonzero(apart))
    rows: list[DistanceTiming] = []
    base = np.nan
    if postures is not None:
        spent = median_per_item(postures.distances, postures.pair_count, repeats)
        error = _errors(found[OURS].distance, bounds, apart)
        name = f"{OURS}, a posture's pairs in one call"
        rows.append(DistanceTiming(pair_set.name, name, "", count, known_to, spent, None, *error))
    for one in METERS:
        name = f"{one.name}, one pair a call"
        if one.name not in calls:
            note = f"not installed: {GET_PEERS}"
            rows.append(DistanceTiming(pair_set.name, name, note, count, known_to))
            continue
        spent = median_per_item(calls[one.name], len(pairs), repeats)
        base = spent if one.name == OURS else base
        error = _errors(found[one.name].distance, bounds, apart)
        rows.append(
            DistanceTiming(pair_set.name, name, "", count, known_to, spent, spent / base, *error)
        )
    return rows


def _errors(
    distance: FloatArray, bounds: list[Bracket], apart: np.ndarray[Any, np.dtype[np.bool_]]
) -> tuple[float, float, int]:
    """Largest over- and under-statement [m], and how many are over by more than `NOTICED`."""
    low, high = np.array(bounds)[apart].reshape(-1, 2).T
    over = distance[apart] - high
    under = low - distance[apart]
    return (
        max(0.0, float(over.max(initial=0.0))),
        max(0.0, float(under.max(initial=0.0))),
        int(np.count_nonzero(over > NOTICED)),
    )


def _ours(pairs: Pairs) -> Callable[[], Measured]:
    witness = np.zeros((len(pairs), 2, 3))
    rows = [(*a[:5], *b[:5], witness[i]) for i, (a, b) in enumerate(pairs)]

    def measure() -> Measured:
        distance = np.array([convex_distance(*row) for row in rows])
        return Measured(distance, [(one[0], one[1]) for one in witness])

    return measure


def _fcl(pairs: Pairs) -> Callable[[], Measured]:
    fcl = import_module("fcl")
    rows = [(_fcl_object(fcl, a), _fcl_object(fcl, b)) for a, b in pairs]
    request = fcl.DistanceRequest()

    def measure() -> Measured:
        found = [fcl.distance(a, b, request, fcl.DistanceResult()) for a, b in rows]
        return Measured(np.array(found), [])

    return measure


def _fcl_object(fcl: Any, body: PosedBody) -> Any:
    x, y, z = (float(value) for value in body.size)
    if body.kind == SPHERE:
        shape = fcl.Sphere(x)
    elif body.kind == CAPSULE:
        shape = fcl.Capsule(y, 2.0 * x)
    elif body.kind == CYLINDER:
        shape = fcl.Cylinder(y, 2.0 * x)
    elif body.kind == BOX:
        shape = fcl.Box(2.0 * x, 2.0 * y, 2.0 * z)
    else:
        faces, grown = hull_triangles(body.vertices)
        counted = np.column_stack([np.full(len(faces), 3), faces])
        shape = fcl.Convex(grown, len(faces), counted.ravel())
    return fcl.CollisionObject(shape, fcl.Transform(body.rotation, body.position))


def _coal(pairs: Pairs) -> Callable[[], Measured]:
    coal = import_module("coal")
    shapes: dict[int, Any] = {}
    rows = [
        (
            _coal_shape(coal, a, shapes),
            coal.Transform3s(a.rotation, a.position),
            _coal_shape(coal, b, shapes),
            coal.Transform3s(b.rotation, b.position),
        )
        for a, b in pairs
    ]
    request, result = coal.DistanceRequest(), coal.DistanceResult()

    def measure() -> Measured:
        found, points = [], []
        for row in rows:
            result.clear()
            found.append(coal.distance(*row, request, result))
            points.append((result.getNearestPoint1(), result.getNearestPoint2()))
        return Measured(np.array(found), points)

    return measure


def _coal_shape(coal: Any, body: PosedBody, hulls: dict[int, Any]) -> Any:
    x, y, z = (float(value) for value in body.size)
    if body.kind == SPHERE:
        return coal.Sphere(x)
    if body.kind == CAPSULE:
        return coal.Capsule(y, 2.0 * x)
    if body.kind == CYLINDER:
        return coal.Cylinder(y, 2.0 * x)
    if body.kind == BOX:
        return coal.Box(2.0 * x, 2.0 * y, 2.0 * z)
    key = id(body.vertices)  # one array stands for one body, which is kept by the pairs
    if key not in hulls:
        points = coal.StdVec_Vec3s()
        points.extend(list(body.vertices))
        hulls[key] = coal.Convex.convexHull(points, False, "")
    return hulls[key]


OURS = "posopt"
METERS = (Meter(OURS, "", _ours), Meter("python-fcl", "fcl", _fcl), Meter("coal", "coal", _coal))
"""All ways of measuring, ours first."""
