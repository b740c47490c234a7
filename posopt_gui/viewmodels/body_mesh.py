"""Surfaces of collision bodies and of beams, for drawing only."""

from __future__ import annotations

import math

import numpy as np

from posopt_gui.viewmodels.surface_mesh import Colour, Surface, coloured, outward
from solver.collision.convex_hull import hull_triangles
from solver.model.shapes import Box, Capsule, Cylinder, Hull, Mesh, Shape, Sphere
from solver.model.workpiece import BeamSection
from solver.transforms import FloatArray, IntArray

AROUND = 40
"""Sides of a drawn circle."""

ARC = 10
"""Pieces of a drawn quarter or root arc."""


def body_surface(shape: Shape, colour: Colour) -> Surface:
    """The surface of a shape in its body frame."""
    match shape:
        case Sphere():
            vertices, faces = _turned(_half_circle(shape.radius, 0.0))
        case Capsule():
            vertices, faces = _turned(_half_circle(shape.radius, shape.length / 2.0))
        case Cylinder():
            half = shape.length / 2.0
            rim = [(0.0, -half), (shape.radius, -half), (shape.radius, half), (0.0, half)]
            vertices, faces = _turned(np.array(rim))
        case Box():
            vertices, faces = _box(shape.size)
        case Hull():
            faces, vertices = hull_triangles(shape.vertices)
        case Mesh():
            vertices, faces = shape.vertices, shape.faces
        case _:
            raise TypeError(f"{type(shape).__name__} cannot be drawn")
    return coloured(vertices, faces, colour)


def _half_circle(radius: float, half: float) -> FloatArray:
    """(k, 2) outline (distance from z, z) of a ball, drawn apart along z by `half` each way."""
    angle = np.linspace(-math.pi / 2.0, math.pi / 2.0, 2 * ARC + 1)
    outline = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    outline[[0, -1], 0] = 0.0
    if half == 0.0:
        return outline
    shift = np.array([0.0, half])
    return np.concatenate([outline[: ARC + 1] - shift, outline[ARC:] + shift])


def _turned(outline: FloatArray) -> tuple[FloatArray, IntArray]:
    """Turn an outline (distance from z, z), upward and with both ends on z, about z."""
    angle = np.arange(AROUND) * (2.0 * math.pi / AROUND)
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    rings = outline[1:-1]
    body = np.empty((len(rings), AROUND, 3))
    body[..., :2] = rings[:, None, :1] * circle
    body[..., 2] = rings[:, None, 1]
    poles = np.array([(0.0, 0.0, outline[0, 1]), (0.0, 0.0, outline[-1, 1])])
    vertices = np.concatenate([body.reshape(-1, 3), poles])
    return vertices, closed_rings(len(rings), AROUND)


def closed_rings(rings: int, around: int) -> IntArray:
    """Faces of rings of `around` vertices each, then a first and a last pole that close them."""
    here = np.arange(around)
    there = (here + 1) % around
    first, last = rings * around, rings * around + 1
    faces = [np.column_stack([np.full(around, first), there, here])]
    for ring in range(rings - 1):
        low, high = ring * around, (ring + 1) * around
        faces.append(np.column_stack([low + here, low + there, high + there]))
        faces.append(np.column_stack([low + here, high + there, high + here]))
    top = (rings - 1) * around
    faces.append(np.column_stack([top + here, top + there, np.full(around, last)]))
    return np.concatenate(faces).astype(np.int64)


def _box(size: FloatArray) -> tuple[FloatArray, IntArray]:
    signs = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    faces = [
        (0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1),
        (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3),
    ]  # fmt: skip
    return signs * (size / 2.0), np.array(faces, np.int64)


def beam_surface(section: BeamSection, length: float, colour: Colour) -> Surface:
    """The steel of a beam in the beam frame, root arcs included."""
    right = _right_outline(section)
    left = right * (-1.0, 1.0)
    count = len(right)
    ring = np.concatenate([right, left[::-1]])
    vertices = np.array([(x, y, z) for x in (-length / 2.0, length / 2.0) for y, z in ring])
    here = np.arange(2 * count)
    there = (here + 1) % (2 * count)
    far = 2 * count
    faces = [
        np.column_stack([here, there, far + there]),
        np.column_stack([here, far + there, far + here]),
    ]
    level = np.arange(count - 1)
    mirror = 2 * count - 1 - level
    # Each strip of the end face lies between two heights of the outline; where both are the same
    # it is flat, and there only to leave no gap.
    for start, flip in ((0, True), (far, False)):
        a, b = start + level, start + level + 1
        c, d = start + mirror - 1, start + mirror
        strips = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
        faces.append(strips[:, ::-1] if flip else strips)
    return coloured(vertices, outward(vertices, np.concatenate(faces)), colour)


def _right_outline(section: BeamSection) -> FloatArray:
    """(k, 2) outline (y, z) of the half with y > 0, upward."""
    tip, top = section.width / 2.0, section.height / 2.0
    web, root, inner = section.web / 2.0, section.root, top - section.flange
    upper = [(tip, inner), (tip, top)]
    if root > 0.0:
        angle = np.linspace(math.pi, math.pi / 2.0, ARC + 1)
        arc = np.column_stack([np.cos(angle), np.sin(angle)]) * root + (web + root, inner - root)
        upper = [*map(tuple, arc), *upper]
    else:
        upper = [(web, inner), *upper]
    half = np.array(upper)
    return np.concatenate([half[::-1] * (1.0, -1.0), half])
