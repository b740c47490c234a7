"""Triangle surfaces for drawing: welded corners, creased normals and feature edges."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from solver.transforms import FloatArray, IntArray

Colour = tuple[int, int, int, int]
"""Red, green, blue and opacity, 0 to 255."""

CREASE = math.radians(32.0)
"""Faces that meet at a larger angle are drawn with an edge between them [rad]."""

WELD = 1e-6
"""Vertices on the same grid of this width are one [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Surface:
    """A closed triangle surface in the frame of its owner.

    Attributes
    ----------
    vertices : (k, 3) array [m]
    faces : (m, 3) array
        Rows of the vertices, outward wound.
    colours : (m, 4) array of 0..255
        One colour a face.
    """

    vertices: FloatArray
    faces: IntArray
    colours: NDArray[np.uint8]


@dataclass(frozen=True, slots=True, eq=False)
class ShadedMesh:
    """A surface as a graphics card takes it.

    Attributes
    ----------
    corners, normals : (3 m, 3) float32 arrays
        Corners of the triangles [m] and the unit normals there.
    colours : (3 m, 4) array of 0..255
    edges : (2 e, 3) float32 array
        Ends of the feature edges [m].
    """

    corners: NDArray[np.float32]
    normals: NDArray[np.float32]
    colours: NDArray[np.uint8]
    edges: NDArray[np.float32]

    @property
    def bounds(self) -> FloatArray:
        """(2, 3) least and largest coordinates [m]."""
        return np.array([self.corners.min(axis=0), self.corners.max(axis=0)], dtype=np.float64)


def coloured(vertices: FloatArray, faces: IntArray, colour: Colour) -> Surface:
    """A surface of one colour."""
    return Surface(vertices, faces, np.tile(np.array(colour, np.uint8), (len(faces), 1)))


def moved(surface: Surface, pose: FloatArray) -> Surface:
    """The surface in the parent's frame; `pose` is parent_from_surface (4, 4)."""
    vertices = surface.vertices @ pose[:3, :3].T + pose[:3, 3]
    return Surface(vertices, surface.faces, surface.colours)


def merged(surfaces: Sequence[Surface]) -> Surface:
    """Several surfaces as one; they are not joined where they touch."""
    counts = [len(one.vertices) for one in surfaces]
    starts = np.concatenate([[0], np.cumsum(counts)[:-1]]).astype(np.int64)
    return Surface(
        np.concatenate([one.vertices for one in surfaces]),
        np.concatenate([one.faces + start for one, start in zip(surfaces, starts, strict=True)]),
        np.concatenate([one.colours for one in surfaces]),
    )


def outward(vertices: FloatArray, faces: IntArray) -> IntArray:
    """The faces, turned round where they enclose a negative volume."""
    a, b, c = (vertices[faces[:, corner]] for corner in range(3))
    volume = float(np.einsum("ij,ij->", a, np.cross(b, c)))
    return faces if volume >= 0.0 else faces[:, ::-1]


def shaded(surface: Surface, crease: float = CREASE) -> ShadedMesh:
    """Normals that are smooth within faces that meet at less than `crease` [rad]."""
    corners = surface.vertices[surface.faces]
    doubled = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(doubled, axis=1)
    kept = size > 1e-12
    corners, doubled = corners[kept], doubled[kept]
    unit = doubled / size[kept][:, None]
    weld = np.round(corners.reshape(-1, 3) / WELD).astype(np.int64)
    _, vertex = np.unique(weld, axis=0, return_inverse=True)
    vertex = vertex.ravel()
    face = np.repeat(np.arange(len(corners)), 3)
    normals = _smoothed(vertex, face, unit, doubled, math.cos(crease))
    edges = _feature_edges(vertex.reshape(-1, 3), unit, corners, math.cos(crease))
    return ShadedMesh(
        corners.reshape(-1, 3).astype(np.float32),
        normals.astype(np.float32),
        np.repeat(surface.colours[kept], 3, axis=0),
        edges.astype(np.float32),
    )


def _smoothed(
    vertex: IntArray, face: IntArray, unit: FloatArray, doubled: FloatArray, least: float
) -> FloatArray:
    """(3 m, 3) mean normals of the faces around each corner that turn little from its own."""
    order = np.argsort(vertex, kind="stable")
    counts = np.bincount(vertex)
    group_start = np.concatenate([[0], np.cumsum(counts)[:-1]])
    partners = counts[vertex[order]]
    left = np.repeat(np.arange(len(order)), partners)
    within = np.arange(len(left)) - np.repeat(np.cumsum(partners) - partners, partners)
    right = group_start[vertex[order]][left] + within
    own, other = face[order[left]], face[order[right]]
    alike = np.einsum("ij,ij->i", unit[own], unit[other]) >= least
    sums = np.zeros((len(order), 3))
    np.add.at(sums, order[left[alike]], doubled[other[alike]])
    length = np.linalg.norm(sums, axis=1, keepdims=True)
    mean: FloatArray = np.where(length > 0.0, sums / np.maximum(length, 1e-300), unit[face])
    return mean


def _feature_edges(
    vertex: IntArray, unit: FloatArray, corners: FloatArray, least: float
) -> FloatArray:
    """(2 e, 3) ends of the edges whose two faces meet at a larger angle."""
    sides = np.concatenate([vertex[:, [0, 1]], vertex[:, [1, 2]], vertex[:, [2, 0]]])
    ends = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    face = np.tile(np.arange(len(vertex)), 3)
    key = np.sort(sides, axis=1)
    order = np.lexsort((key[:, 1], key[:, 0]))
    same = np.all(key[order][1:] == key[order][:-1], axis=1)
    first, second = order[:-1][same], order[1:][same]
    turn = np.einsum("ij,ij->i", unit[face[first]], unit[face[second]])
    found: FloatArray = ends[first[turn < least]].reshape(-1, 3)
    return found
