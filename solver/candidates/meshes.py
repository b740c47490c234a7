"""Checks of postures against triangle meshes, after the kernels have passed them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from solver.candidates.margins import FilterMargin, pair_margin
from solver.candidates.outcomes import Outcome
from solver.collision.kernels_scene import FREE, HIT, MARGIN_BROKEN
from solver.collision.scene import CLEARANCE, CONTACT, CollisionScene, MeshRule
from solver.kinematics.kernels_arm import forward_many
from solver.progress import Monitor, checkpoint
from solver.transforms import FloatArray, rigid

POSTURES_PER_SURVEY = 4096
"""Postures whose boxes are looked at together: their poses take some megabytes."""


@dataclass(frozen=True, slots=True, eq=False)
class _Survey:
    """What bounding boxes tell of k postures against r rules.

    `poses` are those (k, 4, 4) of each moving row that has a rule, in fanuc_world; `bound`
    (k, r) lower bounds of the clearances, `least` (k, r) what the rules ask; `near` are the
    postures of which the bounds do not tell that every rule is kept and nothing comes nearer.
    """

    poses: dict[int, FloatArray]
    bound: FloatArray
    least: FloatArray
    near: NDArray[np.int64]


class MeshChecker:
    """Distances of the moving bodies to the scene's meshes (through python-fcl).

    Bounding boxes tell of all postures at once which of them may come near a mesh; python-fcl
    is asked of those alone.
    """

    def __init__(self, scene: CollisionScene) -> None:
        # python-fcl and trimesh are loaded only where a scene holds meshes.
        from solver.collision import mesh_distance  # noqa: PLC0415

        self._scene = scene
        self._bounds, self._measure = mesh_distance.lower_bounds, mesh_distance.mesh_clearance
        self._obstacles, self._proxies = scene.mesh_obstacles, scene.mesh_proxies

    def apply(
        self,
        joints: FloatArray,
        touch: NDArray[np.int64],
        arm: FloatArray,
        outcome: NDArray[np.uint8],
        clearance: FloatArray,
        monitor: Monitor,
    ) -> None:
        """Check every candidate that is still feasible; `outcome`, `clearance` are updated."""
        rows = np.argwhere(outcome == Outcome.FEASIBLE)
        for begin in range(0, len(rows), POSTURES_PER_SURVEY):
            n, o, b = piece = tuple(rows[begin : begin + POSTURES_PER_SURVEY].T)
            survey = self._survey(arm, joints[piece], touch[n], clearance[piece])
            for row in survey.near:
                checkpoint(monitor, "meshes", begin + int(row), len(rows))
                at = n[row], o[row], b[row]
                status, least, _, _ = self._check(survey, row, clearance[at])
                clearance[at] = least
                if status != FREE:
                    outcome[at] = Outcome.COLLISION if status == HIT else Outcome.MARGIN
            checkpoint(monitor, "meshes", begin + len(n), len(rows))

    def refine(
        self,
        arm: FloatArray,
        model: FloatArray,
        touch: NDArray[np.int64],
        status: NDArray[np.int64],
        clearance: FloatArray,
        names: list[tuple[str, str]],
        points: FloatArray,
    ) -> None:
        """Update the kernels' verdicts on postures (k, 6) that they found free."""
        free = np.flatnonzero(status == FREE)
        for begin in range(0, len(free), POSTURES_PER_SURVEY):
            piece = free[begin : begin + POSTURES_PER_SURVEY]
            survey = self._survey(arm, model[piece], touch[piece], clearance[piece])
            for near in survey.near:
                row = piece[near]
                found, least, pair, nearest = self._check(survey, near, clearance[row])
                status[row] = found
                if nearest is not None:
                    clearance[row], names[row], points[row] = least, pair, nearest

    def _survey(
        self, arm: FloatArray, model: FloatArray, touch: NDArray[np.int64], best: FloatArray
    ) -> _Survey:
        """Bounds of postures (k, 6) against every rule; `best` (k,) are their clearances so far."""
        frames = np.empty((len(model), 7, 3, 4))
        forward_many(arm, np.ascontiguousarray(model), frames)
        rules = self._scene.mesh_rules
        bound, least = np.empty((2, len(model), len(rules)))
        poses = {row: self._poses(frames, row) for row in {rule.row for rule in rules}}
        asked = np.empty_like(bound)
        for column, rule in enumerate(rules):
            proxy, obstacle = self._proxies[rule.row], self._obstacles[rule.mesh]
            bound[:, column] = self._bounds(proxy, poses[rule.row], obstacle)
            least[:, column] = self._least(rule, touch)
            asked[:, column] = np.maximum(least[:, column], best if rule.counts else -np.inf)
        return _Survey(poses, bound, least, np.flatnonzero((bound <= asked).any(axis=1)))

    def _check(
        self, survey: _Survey, row: int, best: float
    ) -> tuple[int, float, tuple[str, str], FloatArray | None]:
        """Status, clearance, names and points of one posture; `best` is the clearance so far.

        Names and points are those of the mesh pair that lowered the clearance, if any did.
        """
        names, points = ("", ""), None
        for column, rule in enumerate(self._scene.mesh_rules):
            least = survey.least[row, column]
            if survey.bound[row, column] > max(least, best if rule.counts else least):
                continue
            pose = survey.poses[rule.row][row]
            found = self._measure(self._proxies[rule.row], pose, self._obstacles[rule.mesh])
            if rule.counts:
                if found.distance < best:
                    best = found.distance
                    names, points = self._names(rule), _points(found)
                if best <= 0.0:
                    return HIT, best, names, points
            elif found.distance <= least:
                return MARGIN_BROKEN, np.nan, self._names(rule), _points(found)
        return FREE, best, names, points

    def merge_margins(
        self,
        arm: FloatArray,
        model: FloatArray,
        touch: int,
        clearance: float,
        rows: list[FilterMargin],
    ) -> tuple[float, list[FilterMargin]]:
        """Add the meshes' tightest pairs to the margins of an explanation."""
        frames = np.empty((1, 7, 3, 4))
        forward_many(arm, model[None], frames)
        found_rows = list(rows)
        for rule in self._scene.mesh_rules:
            (pose,) = self._poses(frames, rule.row)
            found = self._measure(self._proxies[rule.row], pose, self._obstacles[rule.mesh])
            kind = Outcome.COLLISION if rule.counts else Outcome.MARGIN
            margin = found.distance - (
                0.0 if rule.counts else float(self._least(rule, np.array(touch)))
            )
            names = " and ".join(self._names(rule))
            found_rows.append(pair_margin(kind, margin, names, _points(found)))
            if rule.counts:
                clearance = min(clearance, found.distance)
        tightest: dict[Outcome, FilterMargin] = {}
        for one in found_rows:
            if one.filter not in tightest or one.margin < tightest[one.filter].margin:
                tightest[one.filter] = one
        return clearance, [tightest[kind] for kind in sorted(tightest)]

    def _poses(self, frames: FloatArray, row: int) -> FloatArray:
        """Poses (k, 4, 4) of a moving body in fanuc_world, by the arm's frames (k, 7, 3, 4)."""
        packed = self._scene.packed
        carried = frames[:, packed.frame[row]]
        poses = np.zeros((len(frames), 4, 4))
        poses[:, 3, 3] = 1.0
        poses[:, :3] = carried @ rigid(packed.moving.rotation[row], packed.moving.position[row])
        return poses

    def _least(self, rule: MeshRule, touch: NDArray[np.int64]) -> FloatArray:
        """What a rule asks of passes that touch these groups [m]."""
        if rule.rule == CLEARANCE:
            return np.zeros(touch.shape)
        touches = (rule.rule == CONTACT) & (touch >= 0) & (rule.touch_group == touch)
        return np.where(touches, -rule.depth, rule.threshold)

    def _names(self, rule: MeshRule) -> tuple[str, str]:
        return str(self._scene.moving[rule.row]), str(self._scene.meshes[rule.mesh][0])


def _points(found: object) -> FloatArray:
    return np.array([found.point_on_body, found.point_on_mesh])  # type: ignore[attr-defined]
