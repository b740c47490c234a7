"""Sections against published second moments, and the geometry of their fillets."""

import itertools
import math

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from solver.catalog import beam_entries, load_beam
from solver.errors import ModelError, UnknownNameError
from solver.model.beam import FILLET_EXCESS, beam_bodies, beam_workpiece, point_in_steel
from solver.model.shapes import Box, Hull
from solver.model.workpiece import BeamSection

SECTIONS = [entry.section for entry in beam_entries()]
MM = 1e-3

# Second moments of area about the strong axis [cm^4]: GB/T 11263-1998 table 1 (HW), EN 10365 (HE).
PUBLISHED = {
    "HW100": 383, "HW125": 847, "HW150": 1660, "HW175": 2900, "HW200": 4770,
    "HW250": 10800, "HW300": 20500, "HW350": 40300, "HW400": 66900,
    "HEA100": 349.2, "HEA120": 606.2, "HEA140": 1033, "HEA160": 1673, "HEA180": 2510,
    "HEA200": 3692, "HEA220": 5410, "HEA240": 7763, "HEA260": 10450, "HEA280": 13670,
    "HEA300": 18260, "HEA320": 22930, "HEA340": 27690, "HEA360": 33090, "HEA400": 45070,
    "HEB100": 449.5, "HEB120": 864.4, "HEB140": 1509, "HEB160": 2492, "HEB180": 3831,
    "HEB200": 5696, "HEB220": 8091, "HEB240": 11260, "HEB260": 14920, "HEB280": 19270,
    "HEB300": 25170, "HEB320": 30820, "HEB340": 36660, "HEB360": 43190, "HEB400": 57680,
}  # fmt: skip


def outline(section: BeamSection, arc_points: int = 400) -> np.ndarray:
    """Closed polygon (y, z) of the whole profile, arcs as fine chords."""
    web, inner = section.web / 2, section.height / 2 - section.flange
    centre = np.array([web + section.root, inner - section.root])
    angles = np.linspace(math.pi, math.pi / 2, arc_points)
    arc = centre + section.root * np.column_stack([np.cos(angles), np.sin(angles)])
    tip = [[section.width / 2, inner], [section.width / 2, section.height / 2]]
    quarter = np.vstack([arc, tip])
    top = np.vstack([quarter, quarter[::-1] * (-1, 1)])
    return np.vstack([top, top[::-1] * (1, -1)])


def second_moment(polygon: np.ndarray) -> float:
    """Integral of z^2 over a polygon (Green's theorem)."""
    y0, z0 = polygon.T
    y1, z1 = np.roll(polygon, -1, axis=0).T
    cross = y0 * z1 - y1 * z0
    return abs(float(np.sum(cross * (z0 * z0 + z0 * z1 + z1 * z1)) / 12.0))


@pytest.mark.parametrize("section", SECTIONS, ids=lambda one: one.name)
def test_dimensions_reproduce_the_published_second_moment(section):
    computed = second_moment(outline(section)) * 1e8
    published = PUBLISHED[section.name]
    # Tables print three figures for HW and four for HE.
    figures = 3 if section.name.startswith("HW") else 4
    rounding = 0.5 * 10.0 ** (math.floor(math.log10(published)) + 1 - figures)
    assert abs(computed - published) <= max(3e-3 * published, rounding)


def test_every_section_of_the_three_series_is_there():
    assert {one.name for one in SECTIONS} == set(PUBLISHED)


@pytest.mark.parametrize("spelling", ["HW300", "hw300", "HW 300", " hw 300 "])
def test_a_section_is_found_whatever_its_spelling(spelling):
    section = load_beam(spelling)
    figures = (section.height, section.width, section.web, section.flange, section.root)
    assert figures == pytest.approx((0.3, 0.3, 0.010, 0.015, 0.020), abs=1e-15)


def test_the_later_edition_never_has_the_larger_root():
    later = [(entry.section.root, entry.later_root) for entry in beam_entries() if entry.later_root]
    assert len(later) == 9
    assert all(newer <= older for older, newer in later)


def test_an_unknown_section_names_its_nearest_relatives_first():
    with pytest.raises(UnknownNameError, match=r"no beam is called 'HW310' \(known: HW3[05]0"):
        load_beam("HW310")


def slices_of(section: BeamSection, corner: str = "fillet_top_left") -> list[np.ndarray]:
    """The (y, z) triangles of one fillet's slices."""
    hulls = [one for one in beam_bodies(section, 1.0) if one.group == corner]
    assert all(isinstance(one.shape, Hull) for one in hulls)
    return [one.shape.vertices[:3, 1:] for one in hulls]


@pytest.mark.parametrize("section", SECTIONS, ids=lambda one: one.name)
def test_slices_contain_the_fillet_and_exceed_it_by_at_most_half_a_millimetre(section):
    root = section.root
    corner = np.array([section.web / 2, section.height / 2 - section.flange])
    centre = corner + np.array([root, -root])
    rng = np.random.default_rng(1)
    # Steel: from the corner up to the arc, along rays through the arc's points.
    angle = rng.uniform(math.pi / 2, math.pi, 3000)
    arc = centre + root * np.column_stack([np.cos(angle), np.sin(angle)])
    steel = corner + (arc - corner) * rng.uniform(0.0, 1.0, (3000, 1))
    steel = np.vstack([steel, arc])
    inside = np.zeros(len(steel), bool)
    for triangle in slices_of(section):
        planes = ConvexHull(triangle).equations
        inside |= (steel @ planes[:, :2].T + planes[:, 2] <= 1e-12).all(axis=1)
    assert inside.all()
    # Excess: how far points of a slice lie beyond the arc, on the side of its centre.
    worst = 0.0
    for triangle in slices_of(section):
        weights = rng.dirichlet([0.4, 0.4, 0.4], 3000)
        chord = np.linspace(0.0, 1.0, 101)[:, None]
        points = np.vstack([weights @ triangle, triangle[1] * chord + triangle[2] * (1 - chord)])
        worst = max(worst, float((root - np.linalg.norm(points - centre, axis=1)).max()))
    assert worst <= FILLET_EXCESS + 1e-12
    assert worst > 0.1 * FILLET_EXCESS


def test_bodies_contain_the_steel_and_nothing_far_from_it():
    section = load_beam("HW300")
    rng = np.random.default_rng(2)
    points = rng.uniform([-0.55, -0.16, -0.16], [0.55, 0.16, 0.16], (20_000, 3))
    inside = np.zeros(len(points), bool)
    for body in beam_bodies(section, 1.0):
        local = points - body.pose[:3, 3]
        if isinstance(body.shape, Box):
            inside |= (np.abs(local) <= body.shape.size / 2).all(axis=1)
        else:
            planes = ConvexHull(body.shape.vertices).equations
            inside |= (local @ planes[:, :3].T + planes[:, 3] <= 0.0).all(axis=1)
    depth = point_in_steel(section, 1.0, points)
    assert inside[depth > 1e-12].all()
    assert not inside[depth < -FILLET_EXCESS - 1e-12].any()
    assert 0.1 < inside.mean() < 0.5


def polygon_depth(polygon: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Signed distance to a polygon by brute force over its edges and even-odd crossing."""
    start, end = polygon, np.roll(polygon, -1, axis=0)
    edge = end - start
    keep = np.linalg.norm(edge, axis=1) > 0.0
    start, end, edge = start[keep], end[keep], edge[keep]
    depth = np.empty(len(points))
    for row, point in enumerate(points):
        share = np.clip(((point - start) * edge).sum(1) / (edge * edge).sum(1), 0.0, 1.0)
        distance = np.linalg.norm(start + share[:, None] * edge - point, axis=1).min()
        straddles = (start[:, 1] > point[1]) != (end[:, 1] > point[1])
        rise = np.where(straddles, edge[:, 1], 1.0)
        crossing = start[:, 0] + (point[1] - start[:, 1]) / rise * edge[:, 0]
        odd = np.count_nonzero(straddles & (crossing > point[0])) % 2
        depth[row] = distance if odd else -distance
    return depth


@pytest.mark.parametrize("name", ["HW300", "HEB400", "HW100"])
@pytest.mark.parametrize("root", [True, False])
def test_depth_in_the_profile_equals_brute_force_over_the_outline(name, root):
    section = load_beam(name)
    if not root:
        section = BeamSection("sharp", section.height, section.width, section.web, section.flange)
    rng = np.random.default_rng(3)
    half = np.array([section.width, section.height]) * 0.6
    flat = rng.uniform(-half, half, (500, 2))
    corner = np.array([section.web / 2, section.height / 2 - section.flange])
    near_root = corner + rng.uniform(-0.03, 0.03, (300, 2))
    flat = np.vstack([flat, near_root])
    # The outline's chords stay within 2.1e-9 m of the arc of the largest root.
    # At mid length of a long beam the ends are never the nearest surface.
    points = np.column_stack([np.zeros(len(flat)), flat])
    expected = polygon_depth(outline(section, 2000), flat)
    np.testing.assert_allclose(point_in_steel(section, 100.0, points), expected, rtol=0, atol=3e-9)


@pytest.mark.parametrize(
    ("point", "depth"),
    [
        ((0.495, 0.0, 0.0), 0.005),  # web, 5 mm from the surface and from the end
        ((0.498, 0.0, 0.0), 0.002),
        ((0.503, 0.0, 0.0), -0.003),
        ((0.503, 0.009, 0.0), -0.005),  # beyond the end and beside the web: 3-4-5
        ((0.0, 0.005, 0.0), 0.0),  # on the web's face
        ((0.0, 0.153, 0.154), -0.005),
        ((0.0, 0.0, 0.1425), 0.0075),
    ],
)
def test_depth_at_the_ends_and_on_faces(point, depth):
    sharp = BeamSection("sharp", 0.3, 0.3, 0.010, 0.015)
    assert point_in_steel(sharp, 1.0, [point])[0] == pytest.approx(depth, abs=1e-15)


def test_groups_are_those_that_passes_name():
    groups = beam_workpiece(load_beam("HW300"), 1.0, np.eye(4)).groups
    corners = [
        f"fillet_{a}_{b}" for a, b in itertools.product(("top", "bottom"), ("left", "right"))
    ]
    assert groups == ("web", "flange_top", "flange_bottom", *corners)
    bare = beam_workpiece(load_beam("HW300"), 1.0, np.eye(4), fillets=False)
    assert bare.groups == ("web", "flange_top", "flange_bottom")
    assert bare.section.root == 0.0


@pytest.mark.parametrize("length", [0.0, -1.0, math.nan, math.inf])
def test_a_beam_without_length_is_refused(length):
    with pytest.raises(ModelError, match="length must be positive"):
        beam_bodies(load_beam("HW300"), length)
