"""Bodies as TOML: shapes by the points that a drawing states, turned into posed shapes.

A body is ``{ name, group?, shape, ... }`` with

- ``shape = "box"``: `min_mm` and `max_mm`, or `centre_mm` and `size_mm`; `wpr_deg` turns the
  box about its centre;
- ``shape = "cylinder"`` (flat ends) or ``"capsule"``: the ends `from_mm` and `to_mm` of the axis
  (of a capsule: the centres of its round ends) and `radius_mm`;
- ``shape = "sphere"``: `centre_mm` and `radius_mm`.

What stands still may be a triangle mesh instead: `mesh`, a file beside the TOML file, and `unit`.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final, Literal

import numpy as np

from solver.catalog.toml_reader import Table
from solver.model.shapes import Body, Box, Capsule, ConvexShape, Cylinder, Sphere
from solver.transforms import FloatArray, rigid, rotation_from_wpr

SHAPES: Final = ("box", "cylinder", "capsule", "sphere")


def read_body(table: Table, inflation: float = 0.0) -> Body:
    """Read one body; `inflation` [m] moves its whole surface outward.

    Raises
    ------
    InputError
        If a key is missing or wrong, or the shape has no volume.
    """
    name = table.name("name")
    group = table.name("group") if table.has("group") else name
    shape = table.choice("shape", SHAPES)
    with table.located():
        if shape == "box":
            return Body(name, *_box(table, inflation), group)
        if shape == "sphere":
            return Body(name, *_sphere(table, inflation), group)
        return Body(name, *_round_bar(table, shape, inflation), group)


def read_mesh_body(
    table: Table, pose: FloatArray, files: Mapping[str, bytes] | None = None
) -> Body:
    """Read a body whose shape is a mesh file; `pose` (4, 4) is its owner_from_body.

    `files` holds mesh files in memory by the names that the table gives them.

    Raises
    ------
    InputError
        If a key is missing or wrong, or the file is no usable closed mesh.
    """
    from solver.collision.meshes import load_mesh  # noqa: PLC0415 - trimesh only where used

    name = table.name("name")
    group = table.name("group") if table.has("group") else name
    unit: Literal["mm", "m"] = "mm" if table.choice("unit", ("mm", "m"), "mm") == "mm" else "m"
    with table.located("mesh"):
        file = table.text("mesh")
        data = (files or {}).get(file)
        path = table.folder / file if data is None else Path(file)
        return Body(name, load_mesh(path, unit, data), pose, group)


def read_rotation(table: Table, key: str = "wpr_deg") -> FloatArray:
    """(3, 3) rotation of the optional W, P, R of a table; exact for multiples of 90 deg."""
    angles = table.numbers(key, 3, default=(0.0, 0.0, 0.0))
    return snapped(rotation_from_wpr(*angles))


def snapped(rotation: FloatArray) -> FloatArray:
    """Round entries of a rotation within rounding of -1, 0 or 1 to exactly that."""
    whole = np.round(rotation)
    return np.where(np.abs(rotation - whole) < 1e-15, whole + 0.0, rotation)


def _box(table: Table, inflation: float) -> tuple[ConvexShape, FloatArray]:
    if table.has("centre_mm") or table.has("size_mm"):
        centre = np.array(table.numbers("centre_mm", 3))
        size = np.array(table.numbers("size_mm", 3))
    else:
        low = np.array(table.numbers("min_mm", 3))
        high = np.array(table.numbers("max_mm", 3))
        for axis in range(3):
            if not low[axis] < high[axis]:
                raise table.error(f"max_mm[{axis}]", "expected more than the same entry of min_mm")
        centre, size = (low + high) / 2.0, high - low
    return Box(size + 2.0 * inflation), rigid(read_rotation(table), centre)


def _sphere(table: Table, inflation: float) -> tuple[ConvexShape, FloatArray]:
    centre = table.numbers("centre_mm", 3)
    return Sphere(table.number("radius_mm") + inflation), rigid(position=centre)


def _round_bar(table: Table, shape: str, inflation: float) -> tuple[ConvexShape, FloatArray]:
    start = np.array(table.numbers("from_mm", 3))
    end = np.array(table.numbers("to_mm", 3))
    radius = table.number("radius_mm")
    length = float(np.linalg.norm(end - start))
    if not length > 0.0:
        raise table.error("to_mm", "expected a point other than from_mm")
    pose = rigid(rotation_with_z_along((end - start) / length), (start + end) / 2.0)
    if shape == "capsule":
        return Capsule(radius + inflation, length), pose
    return Cylinder(radius + inflation, length + 2.0 * inflation), pose


def rotation_with_z_along(direction: FloatArray) -> FloatArray:
    """(3, 3) rotation whose z axis is the unit vector; exact along a coordinate axis."""
    helper = np.zeros(3)
    helper[int(np.argmin(np.abs(direction)))] = 1.0
    x = np.cross(helper, direction)
    x = x / np.linalg.norm(x)
    return np.column_stack([x, np.cross(direction, x), direction])
