"""`posopt distance`: the certified distance between two posed shapes of a JSON file."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np

from solver.cli.output import emit_json
from solver.cli.poses import pose_from_xyzwpr
from solver.errors import InputError, Place
from solver.model.shapes import Box, Capsule, ConvexShape, Cylinder, Hull, Sphere
from solver.units import MM, MM_PER_M

HELP = "distance between two convex bodies"
SIZE_LIMIT = 10_000_000


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of this command (`--json F` names the input here)."""
    parser.description = (
        'the file holds {"a": BODY, "b": BODY}; a BODY has "shape" (sphere, capsule, cylinder, '
        'box, hull), its sizes (radius_mm, length_mm, size_mm, vertices_mm) and "pose" '
        "[X, Y, Z, W, P, R]"
    )


def run(options: argparse.Namespace) -> int:
    """Measure and print JSON."""
    from solver.collision.distance import distance

    if options.as_json in (None, "-"):
        raise InputError("name the JSON file with the two bodies: posopt distance --json F")
    document = _read(options.as_json)
    bodies = [_body(document, key, options.as_json) for key in ("a", "b")]
    found = distance(*bodies[0], *bodies[1])
    emit_json(
        {
            "format": "posopt-distance",
            "version": 1,
            "distance_mm": found.distance * MM_PER_M,
            "separated": found.distance > 0.0,
            "depth_is_estimate": found.distance <= 0.0,
            "point_a_mm": np.asarray(found.point_a) * MM_PER_M,
            "point_b_mm": np.asarray(found.point_b) * MM_PER_M,
        },
        "-",
    )
    return 0


def _read(file: str) -> dict[str, Any]:
    def refuse(text: str) -> float:
        raise InputError(f"{text} is no finite number", Place(file))

    try:
        path = Path(file)
        if path.stat().st_size > SIZE_LIMIT:
            raise InputError("the file is larger than 10 MB", Place(file))
        document = json.loads(path.read_text(encoding="utf-8-sig"), parse_constant=refuse)
    except OSError as error:
        raise InputError(f"cannot read the file: {error.strerror or error}", Place(file)) from error
    except UnicodeDecodeError as error:
        raise InputError("the file is not UTF-8 text", Place(file)) from error
    except json.JSONDecodeError as error:
        raise InputError(
            f"not JSON: {error.msg}", Place(file, error.lineno, error.colno)
        ) from error
    except RecursionError as error:
        raise InputError("the JSON is nested too deeply", Place(file)) from error
    if not isinstance(document, dict):
        raise InputError('expected an object with "a" and "b"', Place(file))
    return document


def _body(document: dict[str, Any], key: str, file: str) -> tuple[ConvexShape, Any]:
    table = document.get(key)
    if not isinstance(table, dict):
        raise InputError("expected an object", Place(file, key=key))
    shape = _shape(table, key, file)
    pose = _numbers(table.get("pose", [0, 0, 0, 0, 0, 0]), f"{key}.pose", file, (6,))
    return shape, pose_from_xyzwpr(pose)


def _shape(table: dict[str, Any], key: str, file: str) -> ConvexShape:
    def length(name: str) -> float:
        return float(_numbers(table.get(name), f"{key}.{name}", file, ())) * MM

    kind = table.get("shape")
    try:
        if kind == "sphere":
            return Sphere(length("radius_mm"))
        if kind == "capsule":
            return Capsule(length("radius_mm"), length("length_mm"))
        if kind == "cylinder":
            return Cylinder(length("radius_mm"), length("length_mm"))
        if kind == "box":
            return Box(_numbers(table.get("size_mm"), f"{key}.size_mm", file, (3,)) * MM)
        if kind == "hull":
            where = f"{key}.vertices_mm"
            return Hull(_numbers(table.get("vertices_mm"), where, file, (-1, 3)) * MM)
    except InputError as error:
        if error.place is not None:
            raise
        raise InputError(error.message, Place(file, key=key)) from error
    raise InputError(
        f"expected sphere, capsule, cylinder, box or hull, got {kind!r}",
        Place(file, key=f"{key}.shape"),
    )


def _numbers(value: Any, key: str, file: str, shape: tuple[int, ...]) -> Any:
    place = Place(file, key=key)
    try:
        array = np.array(value, dtype=object)
    except ValueError as error:
        raise InputError("expected a regular list of numbers", place) from error
    fits = array.ndim == len(shape) and all(
        want in (-1, have) for want, have in zip(shape, array.shape, strict=True)
    )
    numeric = all(
        isinstance(item, int | float) and not isinstance(item, bool) for item in array.ravel()
    )
    if not (fits and numeric):
        wanted = "a number" if not shape else f"numbers of shape {shape}".replace("-1", "n")
        raise InputError(f"expected {wanted}", place)
    try:
        numbers = array.astype(np.float64)
    except OverflowError as error:
        raise InputError("a number is too large", place) from error
    if not (np.isfinite(numbers).all() and (np.abs(numbers) < 1e6).all()):
        raise InputError("a number is too large (1e6 at most)", place)
    return numbers
