"""The two shipped cells written again from their sources, in plain numpy and coal.

Nothing of the product is imported. Lengths in m, angles in rad, poses in the floor frame (the
mounting face of the robot). Sources: kinematics and limits of FANUC manual B-82874EN/06 and the
public ros-industrial description; bodies fitted to its meshes; the paper's capsules; GB/T 11263.

A root fillet is non-convex. Here it is a fan of triangular prisms from the root corner to
chords of its arc. Four chords are the fewest whose sagitta r (1 - cos(pi / (4 k))) stays under
0.5 mm at r = 20 mm; the steel itself is approached with forty.
"""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np

MM, DEG = 1e-3, np.pi / 180.0
FULL, PAPER = "groove_hw300", "groove_paper"

# Modified D-H rows (Craig): alpha_{i-1}, a_{i-1}, d_i, offset of the matrix angle.
DENAVIT_HARTENBERG = (
    (0.0, 0.0, 0.525, 0.0),
    (-90.0, 0.150, 0.0, -90.0),
    (0.0, 0.790, 0.0, 0.0),
    (-90.0, 0.250, 0.835, 0.0),
    (90.0, 0.0, 0.0, 0.0),
    (-90.0, 0.0, 0.0, 0.0),
)
FLANGE_FROM_WRIST, TCP_FROM_FLANGE = 0.100, 0.410
LOWER = np.array([-170.0, -100.0, -185.0, -200.0, -140.0, -270.0]) * DEG
UPPER = np.array([170.0, 160.0, 273.12, 200.0, 140.0, 270.0]) * DEG
ELBOW = np.array([-90.0, 190.0]) * DEG  # of J2 + J3
COST_RANGES = np.array([340.0, 260.0, 458.12, 400.0, 280.0, 540.0]) * DEG
LEAST_MANIPULABILITY = 0.01
SAFETY, NEAR, DEPTH, SELF = 50.0 * MM, 2.0 * MM, 0.5 * MM, 10.0 * MM

BEAM_Y = (-0.700, 0.300)  # floor y: the beam's length of 1 m about -0.200
CENTRE_X, CENTRE_Z = 0.900, 0.600
HALF_HEIGHT, FLANGE, HALF_WIDTH, HALF_WEB, ROOT = 0.150, 0.015, 0.150, 0.005, 0.020


def turn(axis: str, angle: float) -> np.ndarray:
    """(4, 4) rotation about x, y or z."""
    one, two = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    matrix = np.eye(4)
    matrix[one, one] = matrix[two, two] = np.cos(angle)
    matrix[one, two], matrix[two, one] = -np.sin(angle), np.sin(angle)
    return matrix


def shift(x: float, y: float, z: float) -> np.ndarray:
    """(4, 4) translation."""
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


def model_of(pendant: np.ndarray) -> np.ndarray:
    """D-H angles of pendant joints."""
    j1, j2, j3, j4, j5, j6 = pendant
    return np.array([j1, j2, -(j2 + j3), -j4, -j5, -j6])


def pendant_of(model: np.ndarray) -> np.ndarray:
    """Pendant joints of D-H angles."""
    t1, t2, t3, t4, t5, t6 = model
    return np.array([t1, t2, -t3 - t2, -t4, -t5, -t6])


def frames_of(pendant: np.ndarray) -> list[np.ndarray]:
    """The six D-H frames in the floor frame."""
    frames, pose = [], np.eye(4)
    for (alpha, a, d, offset), angle in zip(DENAVIT_HARTENBERG, model_of(pendant), strict=True):
        step = turn("x", alpha * DEG) @ shift(a, 0, 0)
        pose = pose @ step @ turn("z", angle + offset * DEG) @ shift(0, 0, d)
        frames.append(pose)
    return frames


def flange_of(pendant: np.ndarray) -> np.ndarray:
    """Pose of the flange in the floor frame by the D-H product."""
    return frames_of(pendant)[-1] @ shift(0, 0, FLANGE_FROM_WRIST)


def tcp_of(pendant: np.ndarray) -> np.ndarray:
    """Pose of the TCP, which is turned by 180 deg against the flange."""
    return flange_of(pendant) @ shift(0, 0, TCP_FROM_FLANGE) @ turn("z", np.pi)


def links_of(pendant: np.ndarray) -> dict[int, np.ndarray]:
    """Link frames, x forward, y left, z up at zero joints; a chain of its own, without D-H.

    Link 4 starts at the J4 axis above the J3 axis, link 5 at the wrist centre, 6 is the flange.
    """
    j1, j2, j3, j4, j5, j6 = pendant
    two = shift(0, 0, 0.525) @ turn("z", j1) @ shift(0.150, 0, 0) @ turn("y", j2)
    three = two @ shift(0, 0, 0.790) @ turn("y", -(j2 + j3))
    four = three @ shift(0, 0, 0.250) @ turn("x", -j4)
    five = four @ shift(0.835, 0, 0) @ turn("y", -j5)
    # The flange's z is the arm's forward, its x the arm's up.
    flange = five @ turn("x", -j6) @ shift(FLANGE_FROM_WRIST, 0, 0)
    flange = flange @ np.array([[0.0, 0, 1, 0], [0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 0, 1]])
    return {0: np.eye(4), 2: two, 3: three, 4: four, 5: five, 6: flange}


def manipulability_of(pendant: np.ndarray) -> float:
    """Absolute determinant of the geometric Jacobian at the wrist centre [m^3]."""
    frames = frames_of(pendant)
    end = frames[-1][:3, 3]
    columns = [np.r_[np.cross(f[:3, 2], end - f[:3, 3]), f[:3, 2]] for f in frames]
    return abs(float(np.linalg.det(np.array(columns))))


def representatives_of(pendant: np.ndarray) -> list[np.ndarray]:
    """All joint vectors of a posture, by full turns, inside joint limits and elbow bound."""
    options = [
        [angle for angle in q + 2 * np.pi * np.arange(-2, 3) if lo - 1e-12 <= angle <= hi + 1e-12]
        for q, lo, hi in zip(pendant, LOWER, UPPER, strict=True)
    ]
    vectors = map(np.array, itertools.product(*options))
    return [q for q in vectors if ELBOW[0] - 1e-12 <= q[1] + q[2] <= ELBOW[1] + 1e-12]


def shoulders_out_of_reach(tcp: np.ndarray) -> int:
    """How many of the two turrets (towards the wrist, away from it) cannot reach a TCP pose."""
    wrist = tcp[:3, 3] - (FLANGE_FROM_WRIST + TCP_FROM_FLANGE) * tcp[:3, 2]
    radius, height = np.hypot(wrist[0], wrist[1]), wrist[2] - 0.525
    forearm = np.hypot(0.250, 0.835)
    lengths = [np.hypot(radius - 0.150, height), np.hypot(radius + 0.150, height)]
    return sum(not abs(forearm - 0.790) <= length <= forearm + 0.790 for length in lengths)


class Solid(NamedTuple):
    """A body: `owner` decides how it is checked, `link` carries it (-1: the floor)."""

    name: str
    owner: str
    link: int
    shape: object
    pose: np.ndarray


def _bar(make, name, owner, link, start, end, radius, grow=0.0, flat=False):
    start, end = np.array(start) * MM, np.array(end) * MM
    length = float(np.linalg.norm(end - start))
    z = (end - start) / length
    x = np.cross(z, np.eye(3)[np.argmin(np.abs(z))])
    x /= np.linalg.norm(x)
    pose = np.eye(4)
    pose[:3, :3] = np.column_stack([x, np.cross(z, x), z])
    pose[:3, 3] = (start + end) / 2
    # A flat end moves outward with the surface; a round one does so with the radius.
    length += 2 * grow if flat else 0.0
    return Solid(name, owner, link, make(radius * MM + grow, length), pose)


def _box(coal, name, owner, link, low, high, grow=0.0):
    low, high = np.array(low) * MM, np.array(high) * MM
    return Solid(name, owner, link, coal.Box(*(high - low + 2 * grow)), shift(*(low + high) / 2))


def robot_bodies(coal, cell: str) -> list[Solid]:
    """Robot and tool; the complete bodies stand out by 0.2 mm for the rounding of figures."""
    if cell == PAPER:
        return [
            _bar(coal.Capsule, "base", "base", 0, (0, 0, 0), (0, 0, 525), 190),
            _bar(coal.Capsule, "upper_arm", "upper_arm", 2, (0, 0, 0), (0, 0, 790), 130),
            _bar(coal.Capsule, "forearm", "forearm", 4, (0, 0, 0), (835, 0, 0), 130),
            _bar(coal.Capsule, "end_effector", "tool", 6, (0, 0, 0), (0, 0, 245), 60),
        ]
    more = 0.2 * MM
    flat = {"grow": more, "flat": True}
    arm = (1.1, -143.6)
    return [
        _bar(coal.Cylinder, "base", "base", 0, (0, 0, 0), (0, 0, 642), 313.7, **flat),
        _bar(coal.Cylinder, "lower_arm", "lower_arm", 2, (*arm, -128), (*arm, 872), 133.1, **flat),
        _bar(coal.Capsule, "elbow", "elbow", 3, (72.4, 21.2, 6), (182.5, 0.1, 180), 199.4, more),
        _box(coal, "tube", "forearm", 4, (224, -119.2, -75.2), (700, 55.2, 75.2), more),
        _box(coal, "taper", "forearm", 4, (700, -119.2, -75.2), (770, 15, 75.2), more),
        _box(coal, "fork", "forearm", 4, (770, -119.2, -75.2), (835, -9, 75.2), more),
        _bar(coal.Cylinder, "hub", "forearm", 4, (835, -119.2, 0), (835, -31, 0), 78.6, **flat),
        Solid("wrist", "wrist", 5, coal.Sphere(107.2 * MM + more), np.eye(4)),
        _bar(coal.Cylinder, "adapter", "tool", 6, (0, 0, 0), (0, 0, 100), 60),
        _bar(coal.Cylinder, "spindle", "tool", 6, (0, 0, 100), (0, 0, 245), 50),
        _bar(coal.Cylinder, "nose", "tool", 6, (0, 0, 245), (0, 0, 310), 20),
        _bar(coal.Cylinder, "shank", "tool", 6, (0, 0, 310), (0, 0, 402), 3),
        Solid("ball", "tool", 6, coal.Sphere(8 * MM), shift(0, 0, 410 * MM)),
    ]


def fillet_prisms(chords: int) -> list[np.ndarray]:
    """Vertices (6, 3) of the prisms of all four root fillets."""
    prisms = []
    angles = np.linspace(0.0, np.pi / 2, chords + 1)
    # Across the arc from the web's face to the flange's, seen from the corner.
    arc = ROOT * np.column_stack([1 - np.sin(angles), 1 - np.cos(angles)])
    for side, up in itertools.product((1, -1), (1, -1)):
        corner = np.array([CENTRE_X + side * (HALF_HEIGHT - FLANGE), CENTRE_Z + up * HALF_WEB])
        points = corner + arc * (-side, up)
        for one, two in itertools.pairwise(points):
            prisms.append(np.array([(x, y, z) for y in BEAM_Y for x, z in (corner, one, two)]))
    return prisms


def fixed_bodies(coal, cell: str, chords: int = 4) -> list[Solid]:
    """Beam, trestles and floor; the paper's cell has the beam's three boxes alone."""
    inner = HALF_HEIGHT - FLANGE
    ends = np.array(BEAM_Y) / MM
    x, z = CENTRE_X / MM, CENTRE_Z / MM
    low_z, high_z = z - HALF_WIDTH / MM, z + HALF_WIDTH / MM
    spans = {
        "web": (-inner, inner, z - HALF_WEB / MM, z + HALF_WEB / MM),
        "far_flange": (inner, HALF_HEIGHT, low_z, high_z),
        "near_flange": (-HALF_HEIGHT, -inner, low_z, high_z),
    }
    solids = [
        _box(coal, name, "beam", -1, (x + a / MM, ends[0], low), (x + b / MM, ends[1], high))
        for name, (a, b, low, high) in spans.items()
    ]
    if cell == PAPER:
        return solids
    for number, vertices in enumerate(fillet_prisms(chords)):
        points = coal.StdVec_Vec3s()
        points.extend(list(vertices))
        hull = coal.Convex.convexHull(points, False, "")
        solids.append(Solid(f"fillet {number}", "beam", -1, hull, np.eye(4)))
    solids.append(_box(coal, "trestle", "trestle", -1, (825, -700, 0), (975, -550, 450)))
    solids.append(_box(coal, "trestle", "trestle", -1, (825, 150, 0), (975, 300, 450)))
    ground = coal.Halfspace(np.array([0.0, 0.0, 1.0]), 0.0)
    return [*solids, Solid("floor", "floor", -1, ground, np.eye(4))]


TOUCHING = {
    frozenset(pair)
    for pair in (
        ("base", "floor"), ("base", "lower_arm"), ("lower_arm", "elbow"), ("elbow", "forearm"),
        ("forearm", "wrist"), ("wrist", "tool"),
    )
}  # fmt: skip


class Margins(NamedTuple):
    """Distances of one posture [m], negative where bodies overlap.

    `clearance` is over all bodies but shank and ball; `near` the shank's; `ball` that of the
    ball from everything but the web, `web` from the web; `own` of robot and tool among
    themselves. Infinite where a cell has no such pair.
    """

    clearance: float
    near: float
    ball: float
    web: float
    own: float

    @property
    def tool_spare(self) -> float:
        """By how much the margins of shank and ball are kept, at worst."""
        return min(self.near - NEAR, self.ball - NEAR, self.web + DEPTH)

    @property
    def spare(self) -> float:
        """By how much all margins that do not count in the clearance are kept, at worst."""
        return min(self.tool_spare, self.own - SELF)


class CellOracle:
    """Distances of one cell by coal."""

    def __init__(self, coal, cell: str, chords: int = 4) -> None:
        self.coal = coal
        self.moving = robot_bodies(coal, cell)
        self.fixed = [(s, self._place(s.pose)) for s in fixed_bodies(coal, cell, chords)]
        self.own_pairs = [] if cell == PAPER else [
            (one, two)
            for one, two in itertools.combinations(range(len(self.moving)), 2)
            if self.moving[one].owner != self.moving[two].owner
            and frozenset((self.moving[one].owner, self.moving[two].owner)) not in TOUCHING
        ]  # fmt: skip
        self.request = coal.DistanceRequest()
        self.request.enable_signed_distance = True
        self.request.gjk_tolerance = 1e-9
        self.request.gjk_max_iterations = 1000

    def _place(self, pose: np.ndarray):
        return self.coal.Transform3s(pose[:3, :3], pose[:3, 3])

    def _gap(self, one, place, other, other_place) -> float:
        found = self.coal.DistanceResult()
        return self.coal.distance(one, place, other, other_place, self.request, found)

    def margins(self, pendant: np.ndarray, touches_web: bool = True) -> Margins:
        """Every margin of a posture; where no pass touches the web it is like any other body."""
        links = links_of(pendant)
        places = [self._place(links[solid.link] @ solid.pose) for solid in self.moving]
        least = dict.fromkeys(Margins._fields, np.inf)
        for solid, place in zip(self.moving, places, strict=True):
            for other, other_place in self.fixed:
                if frozenset((solid.owner, other.owner)) in TOUCHING:
                    continue
                kind = {"shank": "near", "ball": "ball"}.get(solid.name, "clearance")
                if kind == "ball" and other.name == "web" and touches_web:
                    kind = "web"
                gap = self._gap(solid.shape, place, other.shape, other_place)
                least[kind] = min(least[kind], gap)
        for one, two in self.own_pairs:
            gap = self._gap(
                self.moving[one].shape, places[one], self.moving[two].shape, places[two]
            )
            least["own"] = min(least["own"], gap)
        return Margins(**least)
