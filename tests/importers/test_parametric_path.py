"""Paths on the faces of a beam lie on its surface, outside its steel, and look outward."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from solver.errors import InputError
from solver.io.importers import (
    FaceLine,
    ParametricPath,
    face_line_toolpath,
    parametric_toolpath,
)
from solver.io.importers.beam_faces import face_of
from solver.model.shapes import Body, Box
from solver.model.toolpath import Frame, Toolpath
from solver.model.workpiece import BeamSection, Workpiece
from solver.transforms import rigid, rotation_x, rotation_y, rotation_z

HW300 = BeamSection("HW300", 0.300, 0.300, 0.010, 0.015, 0.020)
HEA200 = BeamSection("HEA200", 0.190, 0.200, 0.0065, 0.010, 0.018)
FILLETS = tuple(f"fillet_{end}_{side}" for end in ("top", "bottom") for side in ("left", "right"))
FLAT = (
    "web_left", "web_right", "flange_top_outer", "flange_bottom_outer",
    *(f"flange_{end}_{kind}_{side}" for end in ("top", "bottom") for kind in ("inner", "edge")
      for side in ("left", "right")),
)  # fmt: skip


def beam(section: BeamSection = HW300, *, filleted: bool = True) -> Workpiece:
    """A beam of 1 m; its bodies only name the groups here."""
    groups = ("web", "flange_top", "flange_bottom", *(FILLETS if filleted else ()))
    bodies = tuple(Body(group, Box([1.0, 0.01, 0.01]), np.eye(4)) for group in groups)
    return Workpiece("beam", bodies, np.eye(4), section, 1.0)


def gap(section: BeamSection, root: float, y: float, z: float) -> float:
    """Signed distance from a point of the cross-section to the steel (negative inside).

    The steel is a web and two flanges, and in every inner corner what lies between the corner
    and the arc of the root radius. By symmetry one quarter is enough.
    """
    y, z = abs(y), abs(z)
    half_web, inner = section.web / 2, section.height / 2 - section.flange

    def box(y0: float, y1: float, z0: float, z1: float) -> float:
        dy, dz = max(y0 - y, y - y1), max(z0 - z, z - z1)
        return math.hypot(max(dy, 0), max(dz, 0)) + min(max(dy, dz), 0)

    distance = min(
        box(-1.0, half_web, -1.0, inner), box(-1.0, section.width / 2, inner, section.height / 2)
    )
    cy, cz = half_web + root, inner - root
    if root and half_web <= y <= cy and cz <= z <= inner:
        distance = root - math.hypot(y - cy, z - cz)
    return distance


@pytest.mark.parametrize("section", [HW300, HEA200], ids=lambda section: section.name)
@pytest.mark.parametrize("filleted", [True, False])
@pytest.mark.parametrize("name", FLAT)
def test_points_lie_on_a_flat_face_and_normals_point_out_of_the_steel(
    name: str, filleted: bool, section: BeamSection
) -> None:
    check_face(beam(section, filleted=filleted), name, section.root if filleted else 0.0)


@pytest.mark.parametrize("section", [HW300, HEA200], ids=lambda section: section.name)
@pytest.mark.parametrize("name", FILLETS)
def test_points_lie_on_a_fillet_and_normals_point_out_of_the_steel(
    name: str, section: BeamSection
) -> None:
    check_face(beam(section), name, section.root)
    with pytest.raises(InputError, match="no face"):
        face_of(beam(section, filleted=False), name)


def check_face(workpiece: Workpiece, name: str, root: float) -> None:
    """Check points from both edges, near them and between, in both directions."""
    section, face = workpiece.section, face_of(workpiece, name)
    assert section is not None
    generator = np.random.default_rng(1)
    for edge, share, lift, towards in itertools.product(
        face.edges, (1e-4, 0.3, 0.8, 1 - 1e-4), (0.0, 0.01), (1.0, -1.0)
    ):
        origin, sign = face.edges[edge]
        first, last = sorted(sign * (limit - origin) for limit in (face.lower, face.upper))
        start = towards * generator.uniform(-0.5, 0.0)
        end = start + towards * generator.uniform(0.01, 0.5)
        offset = first + share * (last - first)
        spec = ParametricPath(name, start, end, offset, edge, points=2, lift=lift)
        (one,) = parametric_toolpath(workpiece, spec).passes
        assert one.touches == face.touches
        np.testing.assert_allclose(one.poses[:, :3, 1], [[towards, 0, 0]] * 2, atol=1e-12)
        np.testing.assert_allclose(one.positions[:, 0], [start, end], atol=1e-12)
        point, normal = one.poses[0, 1:3, 3], -one.poses[0, 1:3, 2]
        assert math.hypot(*normal) == pytest.approx(1.0, abs=1e-12)
        foot = point - lift * normal
        assert abs(gap(section, root, *foot)) <= 1e-12
        assert gap(section, root, *point) >= -1e-12
        # A hair above the surface is air: the normal looks outward.
        hair = gap(section, root, *(foot + 1e-7 * normal))
        assert hair == pytest.approx(1e-7, abs=1e-12)


def test_an_offset_is_measured_from_the_named_edge() -> None:
    spec = ParametricPath("web_left", -0.1, 0.1, 0.030, points=2)
    for edge, z in (("top", 0.135 - 0.030), ("bottom", -0.135 + 0.030)):
        path = parametric_toolpath(beam(), replace(spec, edge=edge))
        np.testing.assert_allclose(path.poses[:, 1, 3], 0.005, atol=1e-15)
        np.testing.assert_allclose(path.poses[:, 2, 3], z, atol=1e-15)
    inner = parametric_toolpath(beam(), replace(spec, face="flange_top_inner_right"))
    np.testing.assert_allclose(inner.poses[:, 1:3, 3], [[-0.035, 0.135]] * 2, atol=1e-15)


def test_the_middle_of_a_fillet_lies_at_45_degrees() -> None:
    spec = ParametricPath("fillet_bottom_right", -0.1, 0.1, 0.020 * math.pi / 4, points=2)
    pose = parametric_toolpath(beam(), spec).poses[0]
    corner = np.array([-0.005, -0.135])
    centre = corner + np.array([-0.020, 0.020])
    np.testing.assert_allclose(pose[1:3, 3], centre + 0.020 * np.array([0.5**0.5, -(0.5**0.5)]))
    np.testing.assert_allclose(-pose[1:3, 2], [-(0.5**0.5), 0.5**0.5], atol=1e-12)


@pytest.mark.parametrize("zigzag", [True, False])
def test_zigzag_alternates_the_direction_and_one_way_does_not(zigzag: bool) -> None:
    spec = ParametricPath(
        "web_left", -0.4, 0.4, 0.030, points=5, passes=4, spacing=0.010, zigzag=zigzag
    )
    path = parametric_toolpath(beam(), spec)
    assert len(path.passes) == 4
    assert len({one.name for one in path.passes}) == 4
    for number, one in enumerate(path.passes):
        direction = -1.0 if zigzag and number % 2 else 1.0
        steps = np.diff(one.positions, axis=0)
        np.testing.assert_allclose(steps, [[direction * 0.2, 0, 0]] * 4, atol=1e-12)
        np.testing.assert_allclose(one.poses[:, :3, 1], [[direction, 0, 0]] * 5, atol=1e-12)
        np.testing.assert_allclose(one.positions[:, 2], 0.105 - 0.010 * number, atol=1e-12)


def test_a_tool_that_cuts_both_ways_need_not_turn_with_the_travel() -> None:
    spec = ParametricPath(
        "web_left", -0.4, 0.4, 0.030, points=3, passes=2, spacing=0.01, turn_with_travel=False
    )
    first, second = parametric_toolpath(beam(), spec).passes
    np.testing.assert_array_equal(first.poses[:, :3, :3], second.poses[:, :3, :3])
    assert second.positions[0, 0] > second.positions[-1, 0]


@given(st.floats(0.0005, 0.9), st.floats(0.02, 0.5))
@settings(max_examples=40, deadline=None)
def test_a_step_is_never_exceeded_and_never_halved_without_need(step: float, end: float) -> None:
    path = parametric_toolpath(beam(), ParametricPath("web_left", 0.0, end, 0.03, step=step))
    gaps = np.linalg.norm(np.diff(path.poses[:, :3, 3], axis=0), axis=1)
    assert gaps.max() <= step * (1 + 1e-9)
    assert len(gaps) == 1 or end / (len(gaps) - 1) > step * (1 - 1e-9)


def groove(section: BeamSection) -> tuple[Workpiece, Toolpath]:
    """The groove pass of the paper's reconstruction: web horizontal, stated orientation."""
    placement = rigid(rotation_z(math.pi / 2) @ rotation_x(-math.pi / 2), [0.9, -0.2, 0.6])
    # The columns are the beam's axes in the floor frame: x along y, y up, z along x.
    placement[:3, :3] = np.column_stack([[0, 1, 0], [0, 0, 1], [1, 0, 0]])
    workpiece = replace(beam(section, filleted=False), placement=placement)
    line = FaceLine(
        "web_left",
        (-0.3, 0.275),
        (0.3, 0.900),
        50,
        relative=True,
        orientation=rotation_y(math.radians(135.0)),
        orientation_frame=Frame.FLOOR,
    )
    return workpiece, face_line_toolpath(workpiece, line)


def test_the_groove_pass_of_the_paper_is_a_relative_line_on_the_web() -> None:
    workpiece, path = groove(HW300)
    assert path.frame is Frame.BEAM
    poses = workpiece.placement @ path.poses
    expected = np.linspace([0.937125, -0.500, 0.605], [1.0215, 0.100, 0.605], 50)
    np.testing.assert_allclose(poses[:, :3, 3], expected, atol=1e-12)
    np.testing.assert_allclose(poses[:, :3, :3], [rotation_y(math.radians(135.0))] * 50, atol=1e-12)


def test_a_relative_line_follows_another_section() -> None:
    workpiece, path = groove(HEA200)
    across = (workpiece.placement @ path.poses)[[0, -1], 0, 3] - 0.9
    np.testing.assert_allclose(across, np.array([0.275, 0.9]) * (0.095 - 0.010), atol=1e-12)


def test_a_line_without_stated_orientation_travels_along_itself() -> None:
    line = FaceLine("flange_top_outer", (-0.3, 0.05), (0.3, 0.25), 7, edge="right")
    path = face_line_toolpath(beam(), line)
    direction = np.array([0.6, 0.2, 0.0]) / math.hypot(0.6, 0.2)
    np.testing.assert_allclose(path.poses[:, :3, 1], [direction] * 7, atol=1e-12)
    np.testing.assert_allclose(path.poses[:, :3, 2], [[0, 0, -1]] * 7, atol=1e-12)
    np.testing.assert_allclose(path.poses[[0, -1], 1, 3], [-0.10, 0.10], atol=1e-12)


GOOD = {"face": "web_left", "start": -0.1, "end": 0.1, "offset": 0.03, "points": 5}


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        ({"face": "web"}, "web_left"),
        ({"face": "fillet_top"}, "fillet_top_left"),
        ({"edge": "left"}, "top or bottom"),
        ({"offset": 0.019}, "20 to 250 mm"),
        ({"offset": 0.251}, "20 to 250 mm"),
        ({"offset": -0.01}, "20 to 250 mm"),
        ({"offset": math.nan}, "finite"),
        ({"start": -0.501}, "-500 to 500 mm"),
        ({"end": 0.6}, "-500 to 500 mm"),
        ({"end": -0.1}, "elsewhere"),
        ({"end": math.inf}, "finite"),
        ({"points": 1}, "2 or more"),
        ({"points": None}, "one of them"),
        ({"step": 0.01}, "one of them"),
        ({"points": None, "step": 0.0}, "step"),
        ({"points": None, "step": math.inf}, "step"),
        ({"points": 150_000, "passes": 2, "spacing": 0.01}, "200,000"),
        ({"points": None, "step": 1e-6}, "200,000"),
        ({"passes": 0}, "pass"),
        ({"passes": 2}, "spacing"),
        ({"passes": 30, "spacing": 0.01}, "leaves"),
        ({"lift": -0.001}, "lift"),
        ({"face": "fillet_top_left", "offset": 0.01, "lift": 0.02}, "radius"),
        ({"face": "fillet_top_left", "offset": 0.032}, "leaves"),
        ({"feed": 0.0}, "feed"),
        ({"lean": 2.0}, "lean"),
        ({"convention": "any"}, "convention"),
    ],
)
def test_a_path_that_the_beam_does_not_have_is_refused(wrong: dict[str, Any], says: str) -> None:
    with pytest.raises(InputError) as caught:
        parametric_toolpath(beam(), ParametricPath(**(GOOD | wrong)))
    assert says in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        ({"end": (0.1, 0.9)}, "-0.851852 to 0.851852"),
        ({"end": (-0.1, 0.2)}, "coincide"),
        ({"points": 1}, "points"),
        ({"orientation_frame": Frame.FANUC_WORLD}, "beam or the floor"),
        ({"end": (0.7, 0.2)}, "500"),
        ({"end": (0.1, math.nan)}, "finite"),
    ],
)
def test_a_line_that_the_face_does_not_have_is_refused(wrong: dict[str, Any], says: str) -> None:
    good = {"face": "web_left", "start": (-0.1, 0.2), "end": (0.1, 0.3), "points": 5}
    with pytest.raises(InputError) as caught:
        face_line_toolpath(beam(), FaceLine(**(good | {"relative": True} | wrong)))
    assert says in str(caught.value)


def test_a_workpiece_without_section_has_no_faces() -> None:
    with pytest.raises(InputError, match="no section"):
        parametric_toolpath(replace(beam(), section=None), ParametricPath(**GOOD))
