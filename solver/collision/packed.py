"""A collision scene as the arrays that the kernels read."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from solver.transforms import FloatArray, IntArray


class PackedBodies(NamedTuple):
    """Bodies as arrays; rows of hulls' vertices are `vertices[start:stop]` in the body frame."""

    kind: IntArray
    size: FloatArray
    rotation: FloatArray
    position: FloatArray
    start: IntArray
    stop: IntArray
    vertices: FloatArray


class PackedScene(NamedTuple):
    """What the kernels read; all poses of fixed bodies are in fanuc_world.

    `frame` (m,) is the D-H frame that carries each moving body, `radius` (m,) that of the
    sphere about its origin that contains it; rows from `tool` on belong to the tool.
    `bound` holds a simple body around each fixed one, for culling: itself, or a box for a hull.
    Fixed bodies are ordered by cluster; `cluster_*` are boxes around them for culling.
    `rule`, `threshold` are (m, f);
    `touch_group` (f,) numbers the workpiece's groups (-1 elsewhere); `depth` (m,) belongs to
    contact bodies; `widest` (m,) is the largest threshold of a row, -inf where it has only
    clearance rules; `self_pairs` (p, 2) are rows of the moving bodies.
    """

    frame: IntArray
    radius: FloatArray
    tool: int
    moving: PackedBodies
    fixed: PackedBodies
    bound: PackedBodies
    cluster_half: FloatArray
    cluster_rotation: FloatArray
    cluster_position: FloatArray
    cluster_start: IntArray
    cluster_stop: IntArray
    cluster_rules: NDArray[np.bool_]
    rule: IntArray
    threshold: FloatArray
    touch_group: IntArray
    depth: FloatArray
    widest: FloatArray
    self_pairs: IntArray
    self_margin: float
