"""Checks of postures against triangle meshes, after the kernels have passed them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from solver.candidates.margins import FilterMargin, pair_margin
from solver.candidates.outcomes import Outcome
from solver.collision.kernels_scene import FREE, HIT, MARGIN_BROKEN
from solver.collision.scene import CLEARANCE, CONTACT, CollisionScene, MeshRule
from solver.kinematics.kernels_arm import forward_frames
from solver.progress import Monitor, checkpoint
from solver.transforms import FloatArray, rigid


class MeshChecker:
    """Distances of the moving bodies to the scene's meshes (through python-fcl)."""

    def __init__(self, scene: CollisionScene) -> None:
        # python-fcl and trimesh are loaded only where a scene holds meshes.
        from solver.collision import mesh_distance, mesh_proxy  # noqa: PLC0415

        self._scene = scene
        self._bound, self._measure = mesh_distance.lower_bound, mesh_distance.mesh_clearance
        self._obstacles = [mesh_distance.MeshObstacle(mesh, pose) for _, mesh, pose in scene.meshes]
        self._proxies = [mesh_proxy.ConvexProxy(shape) for shape in scene.shapes]

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
        for done, (n, o, b) in enumerate(rows):
            checkpoint(monitor, "meshes", done, len(rows))
            status, least, _, _ = self.check(
                arm, joints[n, o, b], int(touch[n]), clearance[n, o, b]
            )
            clearance[n, o, b] = least
            if status != FREE:
                outcome[n, o, b] = Outcome.COLLISION if status == HIT else Outcome.MARGIN

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
        for row in np.flatnonzero(status == FREE):
            found, least, pair, nearest = self.check(
                arm, model[row], int(touch[row]), clearance[row]
            )
            status[row] = found
            if nearest is not None:
                clearance[row], names[row], points[row] = least, pair, nearest

    def check(
        self, arm: FloatArray, model: FloatArray, touch: int, best: float
    ) -> tuple[int, float, tuple[str, str], FloatArray | None]:
        """Status, clearance, names and points of one posture; `best` is the clearance so far.

        Names and points are those of the mesh pair that lowered the clearance, if any did.
        """
        frames = np.empty((7, 3, 4))
        forward_frames(arm, model, frames)
        names, points = ("", ""), None
        for rule in self._scene.mesh_rules:
            pose = self._pose(frames, rule.row)
            proxy, obstacle = self._proxies[rule.row], self._obstacles[rule.mesh]
            least = self._least(rule, touch)
            if self._bound(proxy, pose, obstacle) > max(least, best if rule.counts else least):
                continue
            found = self._measure(proxy, pose, obstacle)
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
        frames = np.empty((7, 3, 4))
        forward_frames(arm, model, frames)
        found_rows = list(rows)
        for rule in self._scene.mesh_rules:
            pose = self._pose(frames, rule.row)
            found = self._measure(self._proxies[rule.row], pose, self._obstacles[rule.mesh])
            kind = Outcome.COLLISION if rule.counts else Outcome.MARGIN
            margin = found.distance - (0.0 if rule.counts else self._least(rule, touch))
            names = " and ".join(self._names(rule))
            found_rows.append(pair_margin(kind, margin, names, _points(found)))
            if rule.counts:
                clearance = min(clearance, found.distance)
        tightest: dict[Outcome, FilterMargin] = {}
        for one in found_rows:
            if one.filter not in tightest or one.margin < tightest[one.filter].margin:
                tightest[one.filter] = one
        return clearance, [tightest[kind] for kind in sorted(tightest)]

    def _pose(self, frames: FloatArray, row: int) -> FloatArray:
        packed = self._scene.packed
        frame = np.vstack([frames[packed.frame[row]], [0.0, 0.0, 0.0, 1.0]])
        return frame @ rigid(packed.moving.rotation[row], packed.moving.position[row])

    def _least(self, rule: MeshRule, touch: int) -> float:
        if rule.rule == CLEARANCE:
            return 0.0
        if rule.rule == CONTACT and touch >= 0 and rule.touch_group == touch:
            return -rule.depth
        return rule.threshold

    def _names(self, rule: MeshRule) -> tuple[str, str]:
        return str(self._scene.moving[rule.row]), str(self._scene.meshes[rule.mesh][0])


def _points(found: object) -> FloatArray:
    return np.array([found.point_on_body, found.point_on_mesh])  # type: ignore[attr-defined]
