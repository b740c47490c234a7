"""Workpieces and fixtures from mesh files: STL, OBJ, PLY, glTF and GLB as one solid each."""

from __future__ import annotations

import io
import logging
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final, Literal

import numpy as np

from solver.collision.mesh_files import CheckedFile, checked_file
from solver.collision.mesh_topology import MAX_TRIANGLES, closed_mesh
from solver.errors import InputError, Place
from solver.model.shapes import Mesh
from solver.transforms import FloatArray, IntArray
from solver.units import MM

Unit = Literal["mm", "m"]
UNITS: Final[Mapping[str, float]] = {"mm": MM, "m": 1.0}


def load_mesh(path: str | Path, unit: Unit = "mm", data: bytes | None = None) -> Mesh:
    """Load a watertight mesh; several bodies in one file become one mesh.

    Parameters
    ----------
    path : str or Path
        An STL (ASCII or binary), OBJ, PLY, glTF or GLB file.
    unit : 'mm' or 'm'
        Unit of the file's coordinates. glTF means metres, but many programs write millimetres.
    data : bytes, optional
        The file's content, where it is in memory already.

    Returns
    -------
    Mesh
        In metres, wound outward (a mesh that is wholly inside out is turned), along the axes
        of the file; glTF means y upward, and nothing is turned here.

    Raises
    ------
    InputError
        Missing, empty, truncated, malformed, not finite, not watertight, inconsistently wound,
        flat, of absurd size, or referring to files outside its folder.
    """
    path = Path(path)
    place = Place(str(path))
    if unit not in UNITS:
        raise InputError(f"unknown unit {unit!r} of the mesh, expected 'mm' or 'm'", place)
    vertices, faces = _triangles(checked_file(path, data), place)
    mesh, _ = closed_mesh(vertices * UNITS[unit], faces, place)
    return mesh


@contextmanager
def _silent_trimesh() -> Iterator[None]:
    """Keep the library's warnings and log lines away from people: its failures become ours."""
    logger = logging.getLogger("trimesh")
    level = logger.level
    logger.setLevel(logging.CRITICAL + 1)
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            yield
    finally:
        logger.setLevel(level)


def _triangles(file: CheckedFile, place: Place) -> tuple[FloatArray, IntArray]:
    """All triangles of a checked file, in the file's unit."""
    with _silent_trimesh():
        try:
            import trimesh  # noqa: PLC0415 - half a second that only mesh files cost

            scene = trimesh.load(
                io.BytesIO(file.data),
                file_type=file.kind,
                resolver=file.parts,
                force="scene",
                process=False,
                skip_materials=True,
            )
            vertices, faces = _merged(scene, place)
        except InputError:
            raise
        except MemoryError as error:
            raise InputError("the mesh does not fit into memory", place) from error
        except Exception as error:  # the library raises whatever its parsers meet
            detail = " ".join(str(error).split())[:80]
            raise InputError(
                f"the file is damaged or of an unknown dialect ({type(error).__name__}: {detail})",
                place,
            ) from error
    if file.triangles is not None and len(faces) != file.triangles:
        raise InputError(
            f"{file.triangles} triangles were found but {len(faces)} could be read", place
        )
    return vertices, faces


def _merged(scene: Any, place: Place) -> tuple[FloatArray, IntArray]:
    """Concatenate the placed geometries of a scene."""
    names = sorted(scene.graph.nodes_geometry)
    placed = [scene.graph[name] for name in names]
    total = 0
    for _, name in placed:
        geometry = scene.geometry[name]
        if not hasattr(geometry, "faces"):
            raise InputError("it holds points or lines, expected triangles alone", place)
        total += len(geometry.faces)
        if total > MAX_TRIANGLES:
            raise InputError(f"the mesh has more than {MAX_TRIANGLES} triangles", place)
    if total == 0:
        raise InputError("the mesh holds no triangles", place)
    vertices: list[FloatArray] = []
    faces: list[IntArray] = []
    start = 0
    for transform, name in placed:
        geometry = scene.geometry[name]
        points = np.asarray(geometry.vertices, dtype=np.float64)
        rows = np.asarray(geometry.faces, dtype=np.int64)
        if rows.min() < 0 or rows.max() >= len(points):
            raise InputError(f"a triangle names a vertex beyond the {len(points)} given", place)
        linear = np.asarray(transform, dtype=np.float64)
        mirrored = np.linalg.det(linear[:3, :3]) < 0.0
        vertices.append(points @ linear[:3, :3].T + linear[:3, 3])
        faces.append((rows[:, ::-1] if mirrored else rows) + start)
        start += len(points)
    return np.concatenate(vertices), np.concatenate(faces)
