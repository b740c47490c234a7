"""A link around obstacles: rapidly-exploring random trees from both of its ends (RRT-Connect).

The search is written here because OMPL, the library for this, is heavy and has no Windows
wheels, and because the program's bytes may depend on nothing but the cell: the trees are grown
with a seeded generator and bounded by a count of checked postures, never by time.

Edges are joint moves. Joint limits and the bound of J2 + J3 are linear in the pendant's joints,
so what is inside at both ends is inside all along. Edges are looked at coarsely while the trees
grow; the way that is found is checked like any other move, in samples of 2 mm.

Source: Kuffner and LaValle, RRT-Connect: an efficient approach to single-query path planning,
ICRA 2000.
"""

from __future__ import annotations

import itertools

import numpy as np

from solver.model.program import MotionKind, rounded_joints
from solver.motion.link_checks import MoveChecker
from solver.motion.trajectory import SAMPLE_STEP
from solver.transforms import FloatArray
from solver.units import DEG, MM

EXTENSION = 0.25
"""Longest edge of a tree: what no point of a body exceeds along it [m]."""

EDGE_STEPS = (20.0 * MM, 7.0 * MM, SAMPLE_STEP)
"""Steps of the look at an edge while the trees grow [m]; the finer ones serve where the first let
a way pass that the check in samples of 2 mm does not."""

FURTHER_WAYS = 1
"""Ways that are sought once there is one, so that the quickest of them can be taken."""

STOP = 0.3
"""What a further stop may save at full joint speed and is not worth [s]."""

SPARE = SAMPLE_STEP / 2.0 + 0.1 * MM
"""Clearance that postures of the trees have to spare: what the check of a move takes off for
what lies between its samples, and what rounding the joints can take [m]."""

POSTURE_LIMIT = 60_000
"""Postures that the trees of one attempt may check."""

MESH_SHARE = 20
"""Times fewer postures, and no further ways, where triangle meshes make each one slow."""

SAMPLE_LIMIT = 4_000
"""Random postures that the trees of one attempt may draw."""

SPREAD = 40.0 * DEG
"""Standard deviation of half of the samples about the straight way [rad]."""

SHORTCUTS = 24
"""Corners that are pulled in turn to shorten a way."""


def plan_link(
    checker: MoveChecker, start: FloatArray, end: FloatArray, seed: tuple[int, ...]
) -> tuple[FloatArray, ...] | None:
    """Find joint moves from one posture to another, away from any face.

    Parameters
    ----------
    checker : MoveChecker
        Says which postures and moves are free.
    start, end : (6,) arrays
        Pendant joints [rad], free and inside the limits.
    seed : tuple of ints
        The same seed gives the same way.

    Returns
    -------
    tuple of (6,) arrays or None
        Where the moves end, the last one at `end`; rounded to the export's decimals. None when
        no way was found within the bounds of the search.
    """
    ways: list[list[FloatArray]] = []
    for attempt, step in enumerate(EDGE_STEPS):
        if (way := _found(checker, start, end, step, (*seed, attempt))) is not None:
            ways.append(way)
            break
    else:
        return None
    for further in range(0 if checker.scene.meshes else FURTHER_WAYS):
        way = _found(checker, start, end, step, (*seed, len(EDGE_STEPS) + further))
        if way is not None:
            ways.append(way)
    speeds = checker.problem.robot.speeds
    return tuple(min(ways, key=lambda one: _duration(one, speeds))[1:])


def _found(
    checker: MoveChecker, start: FloatArray, end: FloatArray, step: float, seed: tuple[int, ...]
) -> list[FloatArray] | None:
    """The way of one search, shortened and checked; None when it finds none that is free."""
    search = _Search(checker, step, np.random.default_rng(seed))
    way = search.connect(start, end)
    if way is None:
        return None
    way = [start, *(rounded_joints(one) for one in way[1:-1]), end]
    free = all(search.is_free(one, other) for one, other in itertools.pairwise(way))
    return search.shortened(way) if free else None


def _duration(way: list[FloatArray], speeds: FloatArray) -> float:
    """Time of a way at full joint speeds, its stops included [s]."""
    moved = np.abs(np.diff(way, axis=0))
    return float((moved / speeds).max(axis=1).sum()) + STOP * len(moved)


class _Tree:
    """Postures that are reached from one end, each with the one that it was reached from."""

    def __init__(self, root: FloatArray) -> None:
        self.joints = np.empty((256, 6))
        self.parent: list[int] = []
        self.add(root, -1)

    def add(self, joints: FloatArray, parent: int) -> int:
        if len(self.parent) == len(self.joints):
            self.joints = np.concatenate([self.joints, np.empty_like(self.joints)])
        self.joints[len(self.parent)] = joints
        self.parent.append(parent)
        return len(self.parent) - 1

    def nearest(self, joints: FloatArray, reach: FloatArray) -> int:
        return int(np.argmin(np.abs(self.joints[: len(self.parent)] - joints) @ reach))

    def way(self, node: int) -> list[FloatArray]:
        """Postures from the root to a node."""
        way = []
        while node >= 0:
            way.append(self.joints[node].copy())
            node = self.parent[node]
        return way[::-1]


class _Search:
    """One attempt, with its own random numbers and its own count of postures."""

    def __init__(self, checker: MoveChecker, step: float, random: np.random.Generator) -> None:
        self.checker, self.step, self.random = checker, step, random
        self.reach = checker.reach
        self.left = POSTURE_LIMIT // (MESH_SHARE if checker.scene.meshes else 1)

    def connect(self, start: FloatArray, end: FloatArray) -> list[FloatArray] | None:
        trees = (_Tree(start), _Tree(end))
        for draw in range(SAMPLE_LIMIT):
            self.checker.refuse_cancelled()
            if self.left <= 0:
                return None
            grown, other = trees[draw % 2], trees[1 - draw % 2]
            node = self._grow(grown, self._sample(start, end), once=True)
            if node is None:
                continue
            target = grown.joints[node].copy()
            met = self._grow(other, target, once=False)
            if met is not None and np.array_equal(other.joints[met], target):
                forward, backward = grown.way(node), other.way(met)[::-1]
                way = [*forward, *backward[1:]]
                return way if draw % 2 == 0 else way[::-1]
        return None

    def _sample(self, start: FloatArray, end: FloatArray) -> FloatArray:
        """Half of the samples lie about the straight way, half anywhere inside the limits."""
        problem = self.checker.problem
        limits = problem.joint_limits
        low, high = problem.robot.elbow_limits
        while True:
            if self.random.random() < 0.5:
                share = self.random.random()
                joints = start + share * (end - start) + self.random.normal(0.0, SPREAD, 6)
                joints = np.clip(joints, limits[:, 0], limits[:, 1])
            else:
                joints = self.random.uniform(limits[:, 0], limits[:, 1])
            if low <= joints[1] + joints[2] <= high:
                return joints

    def _grow(self, tree: _Tree, target: FloatArray, *, once: bool) -> int | None:
        """Extend a tree towards a posture by one edge, or until it arrives or is blocked.

        Returns the last node that was added, None when there is none.
        """
        node = tree.nearest(target, self.reach)
        added = None
        while self.left > 0:
            here = tree.joints[node].copy()
            away = float(np.abs(target - here) @ self.reach)
            if away == 0.0:
                return node
            there = target if away <= EXTENSION else here + EXTENSION / away * (target - here)
            if not self._edge_is_free(here, there):
                break
            node = added = tree.add(there, node)
            if once or there is target:
                break
        return added

    def _edge_is_free(self, one: FloatArray, other: FloatArray) -> bool:
        """Look at the end first, which is blocked most often, then at all of the edge."""
        self.left -= 1
        if not self.checker.free_postures(other[None], SPARE)[0]:
            return False
        count = int(np.ceil(float(np.abs(other - one) @ self.reach) / self.step))
        if count <= 1:
            return True
        share = np.arange(1, count)[:, None] / count
        self.left -= count - 1
        return bool(self.checker.free_postures(one + share * (other - one), SPARE).all())

    def is_free(self, one: FloatArray, other: FloatArray) -> bool:
        """Whether a joint move is free by the check that counts."""
        return self.checker.obstruction(one, other, MotionKind.JOINT) is None

    def shortened(self, way: list[FloatArray]) -> list[FloatArray]:
        """Leave out what can be left out, then pull random corners towards the way's inside."""
        way = self._without_detours(way)
        for _ in range(SHORTCUTS // (MESH_SHARE if self.checker.scene.meshes else 1)):
            if len(way) <= 2:
                return way
            self._pull(way)
        return self._without_detours(way)

    def _without_detours(self, way: list[FloatArray]) -> list[FloatArray]:
        kept, at = [way[0]], 0
        while at < len(way) - 1:
            farther = range(len(way) - 1, at + 1, -1)
            at = next((far for far in farther if self.is_free(way[at], way[far])), at + 1)
            kept.append(way[at])
        return kept

    def _pull(self, way: list[FloatArray]) -> None:
        """Move one corner towards the middle of its neighbours, where both moves stay free."""
        corner = int(self.random.integers(1, len(way) - 1))
        before, after = way[corner - 1], way[corner + 1]
        share = self.random.uniform(0.2, 1.0)
        pulled = rounded_joints(way[corner] + share * ((before + after) / 2.0 - way[corner]))
        if self.is_free(before, pulled) and self.is_free(pulled, after):
            way[corner] = pulled
