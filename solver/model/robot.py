"""A six-axis robot with a spherical wrist: geometry, limits, pendant convention and bodies."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from solver.errors import ModelError
from solver.model.shapes import Body
from solver.transforms import FloatArray, frozen

JOINTS = 6

TOOL_GROUP = "tool"
"""Name among the neighbours that stands for all bodies of the tool; no group of the robot."""

FLOOR_GROUP = "floor"
"""Name among the neighbours that stands for the floor; no group of the robot."""


@dataclass(frozen=True, slots=True, eq=False)
class LinkBody:
    """A body fixed to a link (0 is the base, 6 the flange).

    `body.pose` is link_from_body. A link frame has its origin on the joint's axis and is
    parallel to fanuc_world when all pendant joints are zero (x forward, y left, z up).
    """

    link: int
    body: Body

    def __post_init__(self) -> None:
        if not 0 <= self.link <= JOINTS:
            raise ModelError(f"body {self.body.name!r}: link must be 0 to 6, got {self.link}")


@dataclass(frozen=True, slots=True, eq=False)
class Robot:
    """A robot as data; joint vectors are the pendant's J1..J6 [rad] unless named 'model'.

    Attributes
    ----------
    dh : (6, 4) array
        Rows alpha_{i-1} [rad], a_{i-1} [m], d_i [m], offset_i [rad] of the modified D-H table;
        the matrix angle of row i is the model angle theta_i plus offset_i. The base frame is
        fanuc_world.
    flange : (4, 4) array
        wrist_from_flange: the flange in the sixth D-H frame (origin at the wrist centre).
    world_height : float
        Height of fanuc_world above the floor frame (mounting face) [m].
    model_from_pendant : (6, 6) array
        Linear map theta = model_from_pendant @ J, couplings between J2 and J3 included.
    limits, speeds : (6, 2) [rad] and (6,) [rad/s] arrays
        Of the pendant's joints.
    accelerations : (6,) array
        Of the pendant's joints [rad/s^2]; only the estimate of a cycle time reads them.
    elbow_limits : (2,) array
        Bounds of J2 + J3 [rad]: the elbow cannot fold through itself.
    cost_ranges : (6,) array
        Ranges that normalise model angles in the joint cost [rad].
    body_sets : mapping of name to bodies
        Alternatives of one robot's bodies, such as complete ones and a paper's.
    neighbours : set of pairs of groups
        Bodies that always touch and are never checked against each other.
    """

    name: str
    title: str
    dh: FloatArray
    flange: FloatArray
    world_height: float
    model_from_pendant: FloatArray
    limits: FloatArray
    speeds: FloatArray
    accelerations: FloatArray
    elbow_limits: FloatArray
    cost_ranges: FloatArray
    payload: float
    body_sets: Mapping[str, tuple[LinkBody, ...]]
    neighbours: frozenset[frozenset[str]]
    assumptions: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        put = object.__setattr__
        put(self, "dh", frozen(self.dh, (JOINTS, 4)))
        put(self, "flange", frozen(self.flange, (4, 4)))
        put(self, "model_from_pendant", frozen(self.model_from_pendant, (JOINTS, JOINTS)))
        put(self, "limits", frozen(self.limits, (JOINTS, 2)))
        put(self, "speeds", frozen(self.speeds, (JOINTS,)))
        put(self, "accelerations", frozen(self.accelerations, (JOINTS,)))
        put(self, "elbow_limits", frozen(self.elbow_limits, (2,)))
        put(self, "cost_ranges", frozen(self.cost_ranges, (JOINTS,)))
        put(self, "body_sets", MappingProxyType(dict(self.body_sets)))
        self._check_structure()
        groups = {one.body.group for bodies in self.body_sets.values() for one in bodies}
        if reserved := groups & {TOOL_GROUP, FLOOR_GROUP}:
            raise ModelError(
                f"robot {self.name}: {sorted(reserved)[0]!r} cannot be a group of its bodies, "
                "since it names the tool or the floor among the neighbours"
            )
        for joint, (low, high) in enumerate(self.limits, start=1):
            if not low < high:
                raise ModelError(f"robot {self.name}: J{joint} limits are empty or reversed")
        if not self.elbow_limits[0] < self.elbow_limits[1]:
            raise ModelError(f"robot {self.name}: elbow limits are empty or reversed")
        rates = np.concatenate([self.speeds, self.accelerations, self.cost_ranges])
        if not (np.isfinite(rates).all() and np.all(rates > 0.0)):
            raise ModelError(
                f"robot {self.name}: speeds, accelerations and cost ranges must be positive"
            )

    def _check_structure(self) -> None:
        """Refuse geometry that the closed-form inverse does not solve."""
        quarter = np.pi / 2
        alpha = np.array([0.0, -quarter, 0.0, -quarter, quarter, -quarter])
        offset = np.array([0.0, -quarter, 0.0, 0.0, 0.0, 0.0])
        sound = (
            np.allclose(self.dh[:, 0], alpha, atol=1e-12)
            and np.allclose(self.dh[:, 3], offset, atol=1e-12)
            and np.all(self.dh[[0, 4, 5], 1] == 0.0)
            and np.all(self.dh[[0, 1, 2, 4, 5], 2] == 0.0)
            and self.dh[2, 1] > 0.0
            and self.dh[3, 2] > 0.0
        )
        if not sound:
            raise ModelError(
                f"robot {self.name}: the D-H table must be that of an arm with a spherical wrist: "
                "alpha (0, -90, 0, -90, 90, -90), only a1, a2 > 0, a3 and d4 > 0 non-zero, "
                "offset -90 on joint 2"
            )
        if abs(np.linalg.det(self.model_from_pendant)) < 1e-9:
            raise ModelError(f"robot {self.name}: the pendant convention cannot be inverted")

    @property
    def pendant_from_model(self) -> FloatArray:
        """(6, 6) inverse of `model_from_pendant`."""
        return np.asarray(np.linalg.inv(self.model_from_pendant), dtype=np.float64)

    @property
    def arm_lengths(self) -> tuple[float, float, float, float]:
        """a1, a2, a3, d4 of the D-H table [m]."""
        return (
            float(self.dh[1, 1]),
            float(self.dh[2, 1]),
            float(self.dh[3, 1]),
            float(self.dh[3, 2]),
        )
