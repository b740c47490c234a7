"""H sections as geometry: bodies that contain the steel, and the exact steel itself.

Beam frame: origin at the section's centre at half the length, x along the beam, y across the
flanges, z along the height.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from solver.errors import ModelError
from solver.model.problem import PlanningProblem
from solver.model.shapes import Body, Box, Hull
from solver.model.workpiece import BeamSection, Workpiece
from solver.transforms import FloatArray, inverse, rigid
from solver.units import MM, MM_PER_M

FILLET_EXCESS: Final = 0.5 * MM
"""How far the convex slices of a root fillet may exceed the steel [m]."""

STEEL_TOLERANCE: Final = 0.01 * MM
"""Depth up to which a path point counts as lying on the surface, for files' rounding [m]."""

_CORNERS: Final = (("top_left", 1, 1), ("top_right", -1, 1), ("bottom_left", 1, -1),
                   ("bottom_right", -1, -1))  # fmt: skip
"""Root corners: name, sign of y, sign of z."""


def beam_bodies(section: BeamSection, length: float, fillets: bool = True) -> tuple[Body, ...]:
    """Bodies of a beam in the beam frame: web, two flanges and, if asked, four root fillets.

    Parameters
    ----------
    section : BeamSection
        Dimensions [m].
    length : float
        Length of the beam [m].
    fillets : bool
        Whether root fillets are modelled; a fillet is a fan of convex slices that contain the
        steel and exceed it by at most 0.5 mm.

    Returns
    -------
    tuple of bodies
        Groups 'web', 'flange_top', 'flange_bottom' and 'fillet_top_left' and so on.
    """
    if not (math.isfinite(length) and length > 0.0):
        raise ModelError(f"beam {section.name}: the length must be positive, got {length:g} m")
    clear = section.height - 2.0 * section.flange
    flange_centre = (section.height - section.flange) / 2.0
    flange = Box(np.array([length, section.width, section.flange]))
    bodies = [
        Body("web", Box(np.array([length, section.web, clear])), np.eye(4)),
        Body("flange_top", flange, rigid(position=(0.0, 0.0, flange_centre))),
        Body("flange_bottom", flange, rigid(position=(0.0, 0.0, -flange_centre))),
    ]
    if fillets and section.root > 0.0:
        for corner, side, up in _CORNERS:
            group = f"fillet_{corner}"
            for number, triangle in enumerate(_fillet_triangles(section), start=1):
                prism = _prism(triangle * (side, up), length)
                bodies.append(Body(f"{group}_{number}", prism, np.eye(4), group))
    return tuple(bodies)


def fillet_slices(radius: float) -> int:
    """Count the slices of a quarter arc whose chords stay within `FILLET_EXCESS` of it."""
    if radius <= FILLET_EXCESS:
        return 1
    # Sagitta r (1 - cos(delta / 2)) of a slice of the angle delta = (pi / 2) / count.
    half_angle = math.acos(1.0 - FILLET_EXCESS / radius)
    return math.ceil(math.pi / 4.0 / half_angle)


def _fillet_triangles(section: BeamSection) -> FloatArray:
    """(k, 3, 2) triangles (y, z) from the root corner at +y, +z to the arc's chords.

    The arc bends away from the steel, so that its chords lie outside the steel.
    """
    count = fillet_slices(section.root)
    corner = np.array([section.web / 2.0, section.height / 2.0 - section.flange])
    angle = np.linspace(math.pi, math.pi / 2.0, count + 1)
    centre = corner + section.root * np.array([1.0, -1.0])
    arc = centre + section.root * np.column_stack([np.cos(angle), np.sin(angle)])
    # The ends exactly on web and flange, where cosine and sine leave rounding.
    arc[0, 0], arc[-1, 1] = corner
    return np.array([[corner, arc[i], arc[i + 1]] for i in range(count)])


def _prism(triangle: FloatArray, length: float) -> Hull:
    ends = (-length / 2.0, length / 2.0)
    return Hull(np.array([(x, y, z) for x in ends for y, z in triangle]))


def point_in_steel(section: BeamSection, length: float, points: ArrayLike) -> FloatArray:
    """Signed depth of points in the steel, root arcs included.

    Parameters
    ----------
    section : BeamSection
        Dimensions [m]; a root radius of 0 means sharp roots.
    length : float
        Length of the beam [m].
    points : (n, 3) array
        In the beam frame [m].

    Returns
    -------
    (n,) array
        Distance to the surface [m]: positive inside the steel, negative outside, exact.
    """
    where = np.asarray(points, dtype=np.float64).reshape(-1, 3)
    profile = _profile_depth(section, np.abs(where[:, 1]), np.abs(where[:, 2]))
    end = length / 2.0 - np.abs(where[:, 0])
    outside = np.hypot(np.minimum(profile, 0.0), np.minimum(end, 0.0))
    depth: FloatArray = np.where((profile > 0.0) & (end > 0.0), np.minimum(profile, end), -outside)
    return depth


def _profile_depth(section: BeamSection, y: FloatArray, z: FloatArray) -> FloatArray:
    """Signed depth in the infinite profile of points of its first quadrant (y, z >= 0)."""
    web, root = section.web / 2.0, section.root
    inner, top, tip = section.height / 2.0 - section.flange, section.height / 2.0, section.width / 2
    centre_y, centre_z = web + root, inner - root
    # Every straight piece of the outline, from its first to its last point.
    distance = np.minimum.reduce(
        [
            np.hypot(z - top, np.maximum(y - tip, 0.0)),
            np.hypot(y - tip, np.maximum(np.maximum(inner - z, z - top), 0.0)),
            np.hypot(z - inner, np.maximum(np.maximum(centre_y - y, y - tip), 0.0)),
            np.hypot(y - web, np.maximum(z - centre_z, 0.0)),
        ]
    )
    from_centre = np.hypot(y - centre_y, z - centre_z)
    before_arc = (y <= centre_y) & (z >= centre_z)
    distance = np.where(before_arc, np.minimum(distance, np.abs(from_centre - root)), distance)
    in_web = (y < web) & (z <= inner)
    in_flange = (y < tip) & (z > inner) & (z < top)
    in_fillet = before_arc & (z <= inner) & (from_centre > root)
    steel: FloatArray = np.where(in_web | in_flange | in_fillet, distance, -distance)
    return steel


def beam_workpiece(
    section: BeamSection, length: float, placement: FloatArray, fillets: bool = True
) -> Workpiece:
    """Build a beam as a workpiece; `placement` is floor_from_beam (4, 4).

    Without fillets the workpiece's section has a root radius of 0: the steel is that of its
    bodies.
    """
    modelled = section if fillets else replace(section, root=0.0)
    bodies = beam_bodies(modelled, length, fillets)
    return Workpiece(section.name, bodies, placement, modelled, length)


def check_path_outside_steel(problem: PlanningProblem, allowance: float = STEEL_TOLERANCE) -> None:
    """Refuse a path with a point deeper than `allowance` [m] inside the steel of its beam.

    Raises
    ------
    ModelError
        Names the pass, the waypoint, its position in the beam frame and the depth.
    """
    piece = problem.workpiece
    if piece.section is None:
        return
    beam_from_world = inverse(problem.fanuc_world_from_floor @ piece.placement)
    points = (beam_from_world @ problem.waypoint_poses)[:, :3, 3]
    depth = point_in_steel(piece.section, piece.length, points)
    inside = np.flatnonzero(depth > allowance)
    if len(inside) == 0:
        return
    first = int(inside[0])
    number = int(problem.toolpath.pass_index[first])
    name = problem.toolpath.passes[number].name or str(number + 1)
    x, y, z = points[first] * MM_PER_M
    others = f", and {len(inside) - 1} more of its points" if len(inside) > 1 else ""
    raise ModelError(
        f"the path {problem.toolpath.source or problem.name} enters the steel of beam "
        f"{piece.section.name}: pass {name}, waypoint {first + 1} at x {x:.3f}, y {y:.3f}, "
        f"z {z:.3f} mm of the beam frame lies {depth[first] * MM_PER_M:.3f} mm deep"
        f"{others}; expected at most {allowance * MM_PER_M:g} mm"
    )
