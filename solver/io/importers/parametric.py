"""Paths on the faces of a beam from a few numbers, without a file."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from solver.errors import InputError, ModelError
from solver.io.importers.beam_faces import Face, face_of
from solver.io.importers.naming import listed, shown
from solver.io.importers.options import CONVENTIONS, DEFAULT_FEED, MAX_NOMINAL
from solver.io.importers.orientation import rotations_from_normals_and_travels
from solver.model.toolpath import Frame, Pass, Role, Toolpath
from solver.model.workpiece import Workpiece
from solver.transforms import FloatArray, frozen
from solver.units import MM_PER_M

MAX_POINTS: Final = 200_000
"""Most waypoints of a path."""

_ROUNDING: Final = 1e-12
"""Offsets may pass the rim of a face by this much [m], to forgive their rounding."""


@dataclass(frozen=True, slots=True)
class ParametricPath:
    """Parallel passes along a beam on one of its faces.

    Attributes
    ----------
    face : str
        Name of a face, see :mod:`solver.io.importers.beam_faces`.
    start, end : float
        Where the first pass begins and ends along the beam, x from its middle [m].
    offset : float
        Distance of the first pass from `edge` on the face; on a fillet along the arc [m].
    edge : str
        The edge that offsets are measured from; '' is the face's first: 'top' (else 'bottom')
        of the web, where it meets the flange's inner face; 'web' (else 'edge') of an inner
        flange face and 'web' (else 'flange') of a fillet; 'left' (else 'right') of an outer
        flange face; 'inner' (else 'outer') of a flange's edge.
    points, step : int and float
        Waypoints of a pass, or the largest distance between them [m]; one of the two.
    passes, spacing : int and float
        Number of passes, and how much farther from the edge each one lies [m].
    zigzag : bool
        Whether every second pass runs from `end` to `start`; else all run one way.
    turn_with_travel : bool
        Whether the reference orientation turns with the direction of a pass. False keeps that
        of the first pass, for tools that cut both ways.
    lift : float
        Distance of the TCP from the face along its normal, such as the radius of a ball [m].
    lean, lead : float
        Nominal angles [rad].
    feed : float
        Feed of every pass [m/s].
    convention : str
        See :class:`solver.io.importers.ImportOptions`.
    """

    face: str
    start: float
    end: float
    offset: float
    edge: str = ""
    points: int | None = None
    step: float | None = None
    passes: int = 1
    spacing: float = 0.0
    zigzag: bool = True
    turn_with_travel: bool = True
    lift: float = 0.0
    lean: float = 0.0
    lead: float = 0.0
    feed: float = DEFAULT_FEED
    convention: str = CONVENTIONS[0]
    name: str = "pass"

    def __post_init__(self) -> None:
        _check_finite(self.start, self.end, self.offset, self.spacing, self.lift, self.feed)
        _check_common(self.convention, self.lean, self.lead, self.feed, self.lift)
        if abs(self.end - self.start) < 1e-6:
            raise ModelError("a path along a beam must end elsewhere than it starts")
        if (self.points is None) == (self.step is None):
            raise ModelError("a path along a beam needs a number of points or a step, one of them")
        if self.step is not None and not 1e-6 <= self.step < math.inf:
            raise ModelError(f"the step of a path must be 0.001 mm or more, got {self.step:g} m")
        if self.passes < 1:
            raise ModelError(f"a path needs one pass or more, got {self.passes}")
        if self.passes > 1 and abs(self.spacing) < 1e-6:
            raise ModelError("the spacing of several passes must not be zero")
        if self.count < 2 or self.count * self.passes > MAX_POINTS:
            raise ModelError(
                f"a path needs 2 or more points a pass and at most {MAX_POINTS:,} altogether, "
                f"got {self.count} in each of {self.passes}"
            )

    @property
    def count(self) -> int:
        """Waypoints of a pass."""
        if self.points is not None:
            return self.points
        length = abs(self.end - self.start)
        return steps_of(length, self.step or length) + 1


@dataclass(frozen=True, slots=True, eq=False)
class FaceLine:
    """One straight pass between two points of a face, given by (along, offset).

    Attributes
    ----------
    start, end : pair of floats
        x from the middle of the beam [m], and the offset on the face.
    relative : bool
        False: offsets in [m] from `edge`. True: shares of the face, so that the line follows
        another section; on the web from its centre line (0) to the inner face of the top flange
        (+1, at H/2 - t2) or the bottom one (-1), on an inner flange face from the web's face to
        the flange's edge, on an outer one from the middle to the left edge, on a fillet from
        the web to the flange.
    orientation : (3, 3) array or None
        Reference orientation of every waypoint in `orientation_frame` (beam or floor); None
        makes it from normal and travel.
    """

    face: str
    start: tuple[float, float]
    end: tuple[float, float]
    points: int
    relative: bool = False
    edge: str = ""
    lift: float = 0.0
    orientation: FloatArray | None = None
    orientation_frame: Frame = Frame.FLOOR
    lean: float = 0.0
    lead: float = 0.0
    feed: float = DEFAULT_FEED
    convention: str = CONVENTIONS[0]
    name: str = "pass"

    def __post_init__(self) -> None:
        _check_finite(*self.start, *self.end, self.lift, self.feed)
        _check_common(self.convention, self.lean, self.lead, self.feed, self.lift)
        if not 2 <= self.points <= MAX_POINTS:
            raise ModelError(f"a line needs 2 to {MAX_POINTS:,} points, got {self.points}")
        if self.orientation_frame is Frame.FANUC_WORLD:
            raise ModelError("the orientation of a line is stated in the beam or the floor frame")
        if self.orientation is not None:
            object.__setattr__(self, "orientation", frozen(self.orientation, (3, 3)))


def parametric_toolpath(workpiece: Workpiece, spec: ParametricPath) -> Toolpath:
    """Build the passes of `spec` in the beam frame.

    The reference orientation comes from the outward normal and the travel direction; every
    waypoint is in contact, and `touches` is the group of the face.

    Raises
    ------
    InputError
        When the beam has no such face or edge, or a pass would leave the face.
    """
    face = face_of(workpiece, spec.face)
    _check_along(workpiece, spec.start, spec.end)
    _check_lift(face, spec.lift)
    along = np.linspace(spec.start, spec.end, spec.count)
    passes = []
    for number in range(spec.passes):
        offset = spec.offset + number * spec.spacing
        across = np.full(len(along), _across(face, spec.edge, offset))
        back = spec.zigzag and number % 2 == 1
        positions, normals = _placed(face, along[::-1] if back else along, across, spec.lift)
        towards = math.copysign(1.0, spec.end - spec.start)
        if back and spec.turn_with_travel:
            towards = -towards
        travels = np.tile([towards, 0.0, 0.0], (len(along), 1))
        rotations = rotations_from_normals_and_travels(normals, travels, spec.convention)
        name = spec.name if spec.passes == 1 else f"{spec.name} {number + 1}"
        passes.append(_pass(spec, name, face, positions, rotations))
    return Toolpath(tuple(passes), Frame.BEAM, source=f"{spec.face} of {workpiece.name}")


def face_line_toolpath(workpiece: Workpiece, spec: FaceLine) -> Toolpath:
    """Build the one pass of `spec` in the beam frame.

    Raises
    ------
    InputError
        When the beam has no such face or edge, or the line would leave the face.
    """
    face = face_of(workpiece, spec.face)
    (start, offset), (end, last_offset) = spec.start, spec.end
    _check_along(workpiece, start, end)
    _check_lift(face, spec.lift)
    first, last = (
        _within(face, one * face.unit) if spec.relative else _across(face, spec.edge, one)
        for one in (offset, last_offset)
    )
    along, across = np.linspace(start, end, spec.points), np.linspace(first, last, spec.points)
    positions, normals = _placed(face, along, across, spec.lift)
    travels = np.gradient(positions, axis=0)
    if not np.linalg.norm(np.diff(positions, axis=0), axis=1).min() >= 1e-6:
        raise InputError("the points of the line coincide, expected 1e-06 m or more between them")
    if spec.orientation is None:
        rotations = rotations_from_normals_and_travels(normals, travels, spec.convention)
    else:
        stated = spec.orientation
        if spec.orientation_frame is Frame.FLOOR:
            stated = workpiece.placement[:3, :3].T @ stated
        rotations = np.tile(stated, (spec.points, 1, 1))
    one = _pass(spec, spec.name, face, positions, rotations)
    return Toolpath((one,), Frame.BEAM, source=f"{spec.face} of {workpiece.name}")


def steps_of(length: float, step: float) -> int:
    """Return the fewest equal steps of at most `step` that cover `length`, one or more."""
    # A length that is a multiple of the step but for rounding takes no extra step.
    return max(1, math.ceil(length / step * (1.0 - 1e-12)))


def _placed(
    face: Face, along: FloatArray, across: FloatArray, lift: float
) -> tuple[FloatArray, FloatArray]:
    """Return (n, 3) lifted positions and (n, 3) outward normals."""
    points, normals = face.points(across)
    positions = np.column_stack([along, points + lift * normals])
    return positions, np.column_stack([np.zeros(len(along)), normals])


def _pass(
    spec: ParametricPath | FaceLine,
    name: str,
    face: Face,
    positions: FloatArray,
    rotations: FloatArray,
) -> Pass:
    poses = np.zeros((len(positions), 4, 4))
    poses[:, :3, :3] = rotations
    poses[:, :3, 3] = positions
    poses[:, 3, 3] = 1.0
    return Pass(
        poses=poses + 0.0,
        roles=(Role.CONTACT,) * len(positions),
        feed=spec.feed,
        lean=spec.lean,
        lead=spec.lead,
        touches=face.touches,
        name=name,
    )


def _across(face: Face, edge: str, offset: float) -> float:
    """Return the across coordinate of an offset from an edge."""
    chosen = edge or next(iter(face.edges))
    if chosen not in face.edges:
        raise InputError(
            f"face {face.name} has no edge {shown(edge)}, expected {listed(face.edges, 'or')}"
        )
    origin, sign = face.edges[chosen]
    return _within(face, origin + sign * offset, chosen, origin, sign)


def _within(
    face: Face, across: float, edge: str = "", origin: float = 0.0, sign: float = 1.0
) -> float:
    if face.lower - _ROUNDING <= across <= face.upper + _ROUNDING:
        return min(max(across, face.lower), face.upper)
    low, high = sorted(sign * (limit - origin) for limit in (face.lower, face.upper))
    if edge:
        raise InputError(
            f"the pass {sign * (across - origin) * MM_PER_M:.6g} mm from edge {edge} leaves face "
            f"{face.name}, expected {low * MM_PER_M:.6g} to {high * MM_PER_M:.6g} mm"
        )
    raise InputError(
        f"the relative offset {across / face.unit:.6g} leaves face {face.name}, expected "
        f"{face.lower / face.unit:.6g} to {face.upper / face.unit:.6g}"
    )


def _check_along(workpiece: Workpiece, *ends: float) -> None:
    half = workpiece.length / 2.0
    for end in ends:
        if abs(end) > half + _ROUNDING:
            raise InputError(
                f"the path reaches {end * MM_PER_M:.6g} mm along beam {workpiece.name}, expected "
                f"{-half * MM_PER_M:.6g} to {half * MM_PER_M:.6g} mm"
            )


def _check_lift(face: Face, lift: float) -> None:
    if face.radius and lift >= face.radius:
        raise InputError(
            f"a lift of {lift * MM_PER_M:.6g} mm does not fit into {face.name}, expected less "
            f"than its radius of {face.radius * MM_PER_M:.6g} mm"
        )


def _check_finite(*values: float) -> None:
    if not all(map(math.isfinite, values)):
        raise ModelError("the numbers of a path on a beam must be finite")


def _check_common(convention: str, lean: float, lead: float, feed: float, lift: float) -> None:
    if convention not in CONVENTIONS:
        raise ModelError(
            f"the convention of a path is {listed(CONVENTIONS, 'or')}, got {shown(convention)}"
        )
    if not (abs(lean) <= MAX_NOMINAL and abs(lead) <= MAX_NOMINAL):
        raise ModelError("nominal lean and lead must lie within +-90 deg")
    if feed <= 0.0 or lift < 0.0:
        raise ModelError("the feed of a path must be positive and its lift not negative")
