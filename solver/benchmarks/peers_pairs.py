"""Pairs of bodies whose distances are compared: of a cell's postures, and random ones."""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np

from solver.benchmarks.peers_bracket import PosedBody, posed
from solver.candidates.generate import CandidateSet
from solver.collision.kernels_scene import all_distances
from solver.collision.kernels_shapes import BOX, CYLINDER
from solver.collision.packed import PackedBodies
from solver.kinematics.kernels_arm import forward_frames
from solver.transforms import FloatArray, IntArray

NO_VERTICES: FloatArray = np.zeros((0, 3))
NO_VERTICES.setflags(write=False)


class PairSet(NamedTuple):
    """Pairs of posed bodies under a name."""

    name: str
    pairs: list[tuple[PosedBody, PosedBody]]


class ScenePostures(NamedTuple):
    """A cell's scene at some postures, for the kernel that measures all pairs of one posture.

    `frames` (k, 7, 3, 4) are the D-H frames of every posture.
    """

    candidates: CandidateSet
    frames: FloatArray

    def distances(self) -> None:
        """Measure every pair of every posture, as the planner's explanation does."""
        scene = self.candidates.scene.packed
        bodies, pairs = len(scene.frame), len(scene.self_pairs)
        rotations, positions = np.empty((bodies, 3, 3)), np.empty((bodies, 3))
        fixed, among = np.full(scene.rule.shape, np.inf), np.full(pairs, np.inf)
        points = np.empty((*scene.rule.shape, 2, 3))
        among_points = np.empty((pairs, 2, 3))
        for frames in self.frames:
            all_distances(scene, frames, rotations, positions, fixed, among, points, among_points)

    @property
    def pair_count(self) -> int:
        """Number of pairs that `distances` measures."""
        scene = self.candidates.scene.packed
        return len(self.frames) * (int(np.count_nonzero(scene.rule)) + len(scene.self_pairs))


def scene_postures(candidates: CandidateSet, count: int) -> ScenePostures:
    """Choose feasible candidates, spread evenly over all of them."""
    nodes = candidates.nodes
    chosen = np.linspace(0, len(nodes) - 1, min(count, len(nodes))).astype(np.int64)
    arm = np.array(candidates.problem.robot.arm_lengths)
    frames = np.empty((len(chosen), 7, 3, 4))
    for row, node in enumerate(chosen):
        forward_frames(arm, nodes.model[node], frames[row])
    return ScenePostures(candidates, frames)


def cell_pairs(scene: ScenePostures) -> PairSet:
    """Pairs of a moving and a fixed body that have a rule, and self pairs, at every posture."""
    packed = scene.candidates.scene.packed
    moving = [_part(packed.moving, row) for row in range(len(packed.frame))]
    fixed = [posed(*_shape(packed.fixed, row)) for row in range(packed.rule.shape[1])]
    pairs: list[tuple[PosedBody, PosedBody]] = []
    for frames in scene.frames:
        placed = [
            one._replace(
                rotation=np.ascontiguousarray(frames[f, :, :3] @ one.rotation),
                position=frames[f, :, :3] @ one.position + frames[f, :, 3],
            )
            for one, f in zip(moving, packed.frame, strict=True)
        ]
        pairs += [(placed[m], fixed[f]) for m, f in zip(*np.nonzero(packed.rule), strict=True)]
        pairs += [(placed[a], placed[b]) for a, b in packed.self_pairs]
    name = f"{scene.candidates.problem.name}, {len(scene.frames)} postures"
    return PairSet(name, pairs)


def _part(bodies: PackedBodies, row: int) -> PosedBody:
    return posed(*_shape(bodies, row))


def _shape(
    bodies: PackedBodies, row: int
) -> tuple[int, FloatArray, FloatArray, FloatArray, FloatArray]:
    vertices = np.ascontiguousarray(bodies.vertices[bodies.start[row] : bodies.stop[row]])
    return (
        int(bodies.kind[row]),
        bodies.size[row],
        vertices,
        bodies.rotation[row],
        bodies.position[row],
    )


def random_pairs(count: int, *, square: bool) -> PairSet:
    """Boxes and cylinders of 0.1 to 1 m, up to 3 m apart; square ones stand on one grid.

    Standing square is how a beam, its trestles and a robot at home stand.
    """
    random = np.random.default_rng(1)
    pairs = []
    kinds = itertools.cycle([(BOX, BOX), (BOX, CYLINDER), (CYLINDER, CYLINDER)])
    for _ in range(count):
        first, second = (_random_body(random, kind, square=square) for kind in next(kinds))
        pairs.append((first, second))
    return PairSet("standing square" if square else "turned at random", pairs)


def _random_body(random: np.random.Generator, kind: int, *, square: bool) -> PosedBody:
    size = random.uniform(0.05, 0.5, 3)
    position = random.uniform(-1.5, 1.5, 3)
    axes = random.normal(size=(3, 3))
    rotation, _ = np.linalg.qr(axes)
    if square:
        size, position = np.ceil(10.0 * size) / 10.0, np.round(position, 1)
        order: IntArray = random.permutation(3)
        rotation = np.eye(3)[order]
    rotation = rotation * np.sign(np.linalg.det(rotation))
    if kind == CYLINDER:
        size = np.array([size[0], size[1], 0.0])
    return PosedBody(
        kind, size, NO_VERTICES, np.ascontiguousarray(rotation), position, np.empty((0, 4))
    )
