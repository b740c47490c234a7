"""The shipped cells against their stated figures, and cells of a user's own."""

import math

import numpy as np
import pytest
from catalog_mutations import changed, document, refusal, shipped

from solver.catalog import list_names, load_beam, load_cell
from solver.errors import InputError, ModelError, UnknownNameError
from solver.model.beam import check_path_outside_steel
from solver.model.settings import EdgeCost, Scheme, Turns
from solver.model.toolpath import Frame, Role

WEBS = {  # height H, flange width B, web t1, flange t2 [m]
    "HW125": (0.125, 0.125, 0.0065, 0.009),
    "HW150": (0.150, 0.150, 0.007, 0.010),
    "HW175": (0.175, 0.175, 0.0075, 0.011),
    "HW200": (0.200, 0.200, 0.008, 0.012),
    "HW250": (0.250, 0.250, 0.009, 0.014),
    "HW300": (0.300, 0.300, 0.010, 0.015),
    "HW350": (0.350, 0.350, 0.012, 0.019),
}


def pitch(degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def floor_points(problem):
    return problem.waypoint_poses[:, :3, 3] + (0.0, 0.0, 0.525)


def line(start, end, count=50):
    start, end = np.array(start), np.array(end)
    return start + (end - start) * np.arange(count)[:, None] / (count - 1)


@pytest.mark.parametrize("name", list_names("cells"))
def test_every_shipped_cell_loads_under_its_own_name(name):
    problem = load_cell(name)
    assert problem.name == name
    assert problem.title
    assert len(problem.toolpath) == {"zigzag_hw250": 75}.get(name, 50)


def test_the_paper_cell_has_exactly_the_reconstructed_path():
    problem = load_cell("groove_paper")
    expected = line((0.937125, -0.500, 0.605), (1.0215, 0.100, 0.605))
    np.testing.assert_allclose(floor_points(problem), expected, rtol=0, atol=1e-12)
    rotations = problem.waypoint_poses[:, :3, :3]
    np.testing.assert_allclose(rotations - pitch(135.0), 0.0, atol=1e-12)
    (one,) = problem.toolpath.passes
    assert one.touches == "web"
    assert set(one.roles) == {Role.CONTACT}


def test_the_paper_cell_has_three_boxes_and_nothing_else_around():
    problem = load_cell("groove_paper")
    assert problem.fixtures == ()
    extents = {}
    for body in problem.workpiece.bodies:
        pose = problem.workpiece.placement @ body.pose
        half = np.abs(pose[:3, :3]) @ body.shape.size / 2
        extents[body.name] = (pose[:3, 3] - half, pose[:3, 3] + half)
    expected = {
        "web": ((0.765, -0.7, 0.595), (1.035, 0.3, 0.605)),
        "flange_top": ((1.035, -0.7, 0.45), (1.05, 0.3, 0.75)),
        "flange_bottom": ((0.75, -0.7, 0.45), (0.765, 0.3, 0.75)),
    }
    assert extents.keys() == expected.keys()
    for name, box in expected.items():
        np.testing.assert_allclose(extents[name], box, rtol=0, atol=1e-12)


def test_the_paper_cell_plans_as_the_paper_does():
    problem = load_cell("groove_paper")
    settings = problem.settings
    assert (problem.bodies, problem.tool.name) == ("paper", "paper_tool")
    assert settings.branches == (0,)
    assert settings.turns is Turns.PRINCIPAL
    assert settings.self_margin is None
    assert settings.edge_cost is EdgeCost.ABSOLUTE
    assert settings.scheme is Scheme.EXACT
    assert settings.safety_distance == pytest.approx(0.05)
    assert np.degrees(settings.lean.angles()) == pytest.approx(np.arange(-25, 26))


@pytest.mark.parametrize("beam", WEBS)
def test_another_beam_in_the_paper_cell_keeps_lower_edge_centre_and_shares(beam):
    height, width, web, flange = WEBS[beam]
    problem = load_cell("groove_paper", beam=beam.lower())
    centre = 0.45 + width / 2
    np.testing.assert_allclose(problem.workpiece.placement[:3, 3], [0.9, -0.2, centre], atol=1e-12)
    reach = height / 2 - flange
    top = centre + web / 2
    expected = line((0.9 + 0.275 * reach, -0.5, top), (0.9 + 0.9 * reach, 0.1, top))
    np.testing.assert_allclose(floor_points(problem), expected, rtol=0, atol=1e-12)


def test_the_full_cell_has_the_stated_path_and_orientation():
    problem = load_cell("groove_hw300")
    expected = line((0.937125, -0.500, 0.613), (1.00125, 0.100, 0.613))
    np.testing.assert_allclose(floor_points(problem), expected, rtol=0, atol=1e-12)
    rotations = problem.waypoint_poses[:, :3, :3]
    np.testing.assert_allclose(rotations - pitch(150.0), 0.0, atol=1e-12)
    (one,) = problem.toolpath.passes
    assert one.touches == "web"
    assert one.feed == pytest.approx(0.020)
    assert problem.toolpath.frame is Frame.BEAM


def test_the_full_cell_stands_on_two_trestles_under_the_ends_of_the_beam():
    problem = load_cell("groove_hw300")
    boxes = {}
    for body in problem.fixtures:
        centre = body.pose[:3, 3]
        boxes[body.group] = (centre - body.shape.size / 2, centre + body.shape.size / 2)
    np.testing.assert_allclose(
        boxes["trestle_near"], [(0.825, -0.7, 0), (0.975, -0.55, 0.45)], atol=1e-12
    )
    np.testing.assert_allclose(
        boxes["trestle_far"], [(0.825, 0.15, 0), (0.975, 0.3, 0.45)], atol=1e-12
    )
    np.testing.assert_allclose(boxes["floor"], [(-5, -5, -1), (5, 5, 0)], atol=1e-12)


def test_the_full_cell_plans_with_complete_bodies_and_every_branch():
    problem = load_cell("groove_hw300")
    settings = problem.settings
    assert (problem.bodies, problem.tool.name) == ("full", "die_grinder")
    assert settings.branches == tuple(range(8))
    assert settings.turns is Turns.ALL
    assert settings.self_margin == pytest.approx(0.010)
    assert [one.margin for one in problem.tool.bodies[3:]] == pytest.approx([0.002, 0.002])
    assert problem.workpiece.section.root == pytest.approx(0.020)
    assert "fillet_top_left" in problem.workpiece.groups


def test_a_path_that_ends_in_the_steel_of_another_beam_says_where():
    with pytest.raises(ModelError) as caught:
        load_cell("groove_hw300", beam="HW200")
    sentence = str(caught.value)
    # The inside of the flange is 88 mm from the web's middle: the first point beyond the root
    # fillet's surface and its depth follow from the circle of radius 16 about (20, 72) mm.
    assert "groove_hw300.csv enters the steel of beam HW200" in sentence
    y = 13.0
    z = 37.125 + (101.25 - 37.125) * np.arange(50) / 49
    beyond = (np.hypot(y - 20.0, z - 72.0) - 16.0 > 0.5) & (z > 72.0)
    first = int(np.flatnonzero(beyond)[0])
    depth = math.hypot(y - 20.0, z[first] - 72.0) - 16.0
    assert f"waypoint {first + 1} at x {-300 + 600 * first / 49:.3f}, y 13.000" in sentence
    assert f"z {z[first]:.3f} mm of the beam frame lies {depth:.3f} mm deep" in sentence
    # Later points lie in the flange, 88 to 100 mm, until the last two come out of its far side.
    deep = np.minimum(z - 88.0, 100.0 - z) > 0.5
    assert f"and {np.count_nonzero(deep[first + 1 :])} more of its points" in sentence


def test_points_on_a_face_are_no_points_in_steel():
    problem = load_cell("groove_paper")
    check_path_outside_steel(problem, allowance=1e-12)


def test_unknown_cells_and_beams_are_named():
    with pytest.raises(UnknownNameError, match=r"no cell is called 'groove' \(known: groove_paper"):
        load_cell("groove")
    with pytest.raises(UnknownNameError, match="no beam is called 'IPE300'"):
        load_cell("groove_paper", beam="IPE300")


# Cells of a user's own -------------------------------------------------------------------------


@pytest.fixture
def own_cell(tmp_path):
    """A function that writes a changed copy of a shipped cell and loads it."""

    def write(changes, name="groove_paper", **load):
        tree = shipped("cells", name)
        for path, value in changes.items():
            tree = changed(tree, path, value)
        file = tmp_path / "own.toml"
        file.write_text(document(tree), encoding="utf-8")
        return load_cell(file, **load)

    write.folder = tmp_path
    return write


def test_a_section_may_be_given_by_its_dimensions(own_cell):
    beam = {
        "height_mm": 250, "width_mm": 200, "web_mm": 8, "flange_mm": 12, "length_mm": 1500,
        "position_mm": [900, -200, 600], "wpr_deg": [90, 0, 90],
    }  # fmt: skip
    problem = own_cell({("beam",): beam})
    section = problem.workpiece.section
    assert section.name == "custom"
    assert (section.height, section.flange, section.root) == pytest.approx((0.25, 0.012, 0.0))
    assert problem.workpiece.length == 1.5


def test_the_root_radius_of_a_named_section_may_be_replaced(own_cell):
    problem = own_cell({("beam", "root_mm"): 13}, "groove_hw300")
    assert problem.workpiece.section.root == pytest.approx(0.013)
    assert problem.workpiece.section.name == "HW300"


def test_a_placement_in_fanuc_world_is_525_mm_lower(own_cell):
    there = own_cell({("beam", "frame"): "fanuc_world", ("beam", "lower_edge_mm"): -75})
    np.testing.assert_allclose(
        there.workpiece.placement, load_cell("groove_paper").workpiece.placement, atol=1e-12
    )


def test_joint_windows_narrow_single_joints(own_cell):
    problem = own_cell({("robot", "windows_deg"): {"J1": [-90, 90], "J6": [-400, 180]}})
    assert np.degrees(problem.joint_limits[[0, 1, 5]]).ravel() == pytest.approx(
        [-90, 90, -100, 160, -270, 180]
    )


def test_references_in_a_cell_are_relative_to_its_file(own_cell):
    folder = own_cell.folder
    (folder / "own_robot.toml").write_text(
        document(changed(shipped("robots", "fanuc_m20ia"), ("robot", "name"), "own"))
    )
    (folder / "own_tool.toml").write_text(
        document(changed(shipped("tools", "paper_tool"), ("tool", "mass_kg"), 7))
    )
    series = shipped("beams", "hw")
    series["sections"] = [
        one | {"name": "own"} for one in series["sections"] if "300" in one["name"]
    ]
    (folder / "own_beam.toml").write_text(document(series))
    problem = own_cell(
        {
            ("robot", "model"): "own_robot.toml",
            ("tool", "model"): "./own_tool.toml",
            ("beam", "section"): "own_beam.toml",
        }
    )
    assert (problem.robot.name, problem.tool.mass) == ("own", 7.0)
    assert problem.workpiece.section.name == "own"


def test_another_path_file_states_its_frame_itself(tmp_path):
    file = tmp_path / "path.csv"
    file.write_text("# frame: floor\nx_mm,y_mm,z_mm\n940,-400,605\n960,0,605\n")
    problem = load_cell("groove_paper", path=file)
    np.testing.assert_allclose(
        floor_points(problem), [(0.94, -0.4, 0.605), (0.96, 0.0, 0.605)], atol=1e-12
    )
    # Without an orientation of its own it has the cell's, which is stated in fanuc_world.
    np.testing.assert_allclose(
        problem.waypoint_poses[:, :3, :3], np.tile(pitch(135.0), (2, 1, 1)), atol=1e-12
    )
    file.write_text("# frame: beam\nx_mm,y_mm,z_mm\n-200,5,40\n200,5,60\n")
    problem = load_cell("groove_paper", path=str(file))
    np.testing.assert_allclose(
        floor_points(problem), [(0.94, -0.4, 0.605), (0.96, 0.0, 0.605)], atol=1e-12
    )
    np.testing.assert_allclose(
        problem.waypoint_poses[:, :3, :3], np.tile(pitch(135.0), (2, 1, 1)), atol=1e-12
    )
    file.write_text("x_mm,y_mm,z_mm\n-200,5,40\n200,5,60\n")
    with pytest.raises(InputError, match="frame"):
        load_cell("groove_paper", path=file)


def test_a_path_may_run_along_a_face_in_several_passes(own_cell):
    path = {
        "feed_mm_s": 30,
        "parametric": {
            "face": "web_left", "from_along_mm": -100, "to_along_mm": 100, "offset_mm": 30,
            "points": 5, "passes": 3, "spacing_mm": 20,
        },
    }  # fmt: skip
    problem = own_cell({("path",): path})
    assert [len(one) for one in problem.toolpath.passes] == [5, 5, 5]
    heights = [float(one.positions[0, 2]) for one in problem.toolpath.passes]
    assert heights == pytest.approx([0.105, 0.085, 0.065])
    assert {one.feed for one in problem.toolpath.passes} == {0.030}


TETRAHEDRON = """solid t
facet normal 0 0 -1
outer loop
vertex 0 0 0
vertex 0 100 0
vertex 100 0 0
endloop
endfacet
facet normal 0 -1 0
outer loop
vertex 0 0 0
vertex 100 0 0
vertex 0 0 100
endloop
endfacet
facet normal -1 0 0
outer loop
vertex 0 0 0
vertex 0 0 100
vertex 0 100 0
endloop
endfacet
facet normal 1 1 1
outer loop
vertex 100 0 0
vertex 0 100 0
vertex 0 0 100
endloop
endfacet
endsolid t
"""


def test_a_fixture_may_be_a_triangle_mesh(own_cell):
    (own_cell.folder / "clamp.stl").write_text(TETRAHEDRON)
    fixture = {"name": "clamp", "mesh": "clamp.stl", "unit": "mm", "position_mm": [500, 0, 0]}
    problem = own_cell({("fixtures",): [fixture]})
    (body,) = problem.fixtures
    assert body.shape.vertices.max() == pytest.approx(0.1)
    assert body.pose[0, 3] == pytest.approx(0.5)
    with pytest.raises(InputError, match=r"none\.stl"):
        own_cell({("fixtures",): [fixture | {"mesh": "none.stl"}]})


BAD_CELLS = {
    "unknown robot": (("robot", "model"), "kuka", "no robot is called 'kuka'"),
    "unknown beam": (("beam", "section"), "HW301", "no beam is called 'HW301'"),
    "unknown body set": (("robot", "bodies"), "ful", "did you mean 'full'"),
    "window turned": (("robot", "windows_deg"), {"J1": [9, -9]}, "the lower angle before"),
    "window outside": (("robot", "windows_deg"), {"J1": [171, 180]}, "outside the robot's limits"),
    "window of J7": (("robot", "windows_deg"), {"J7": [1, 2]}, "unknown key"),
    "window of text": (("robot", "windows_deg"), {"J2": ["a", 2]}, "expected a number in deg"),
    "two positions": (("beam", "position_mm"), [1, 2, 3], "unknown key"),
    "no length": (("beam", "length_mm"), 0, "length must be positive"),
    "half a section": (("beam", "height_mm"), 300, "width_mm"),
    "two paths": (("path", "file"), "x.csv", "no second path"),
    "no path": (("path", "line"), None, "one of the keys file, line, parametric"),
    "no such face": (("path", "line", "face"), "web_up", "web_up"),
    "beyond the beam": (("path", "line", "to_along_mm"), 501, "501"),
    "into the flange": (("path", "line", "to_share"), 1.01, "1.01"),
    "one point": (("path", "line", "points"), 1, "whole number 2 to"),
    "no feed": (("path", "feed_mm_s"), 0, "more than 0"),
    "frame of a line": (("path", "frame"), "beam", "path.frame: the key belongs to a file"),
    "unit of a line": (("path", "unit"), "mm", "path.unit: the key belongs to a file"),
    "touch of a line": (("path", "touches"), "web", "path.touches: the key belongs to a file"),
    "resampled line": (("path", "resample_mm"), 5, "path.resample_mm: the key belongs to a file"),
    "frame of nothing": (
        ("path", "orientation_wpr_deg"),
        None,
        "path.orientation_frame: expected orientation_wpr_deg",
    ),
    "no workpiece": (("beam",), None, "a table [beam] or a table [workpiece]"),
    "sweep backward": (("settings", "lean_deg"), [25, -25, 1], "must run upward"),
    "sweep still": (("settings", "lean_deg"), [-25, 25, 0], "must be positive"),
    "sweep huge": (("settings", "lean_deg"), [-25, 25, 1e-9], "100,000 angles"),
    "branch 8": (("settings", "branches"), [0, 8], "whole number 0 to 7"),
    "branch twice": (("settings", "branches"), [0, 0], "ascending list"),
    "no branch": (("settings", "branches"), [], "ascending list"),
    "heuristic": (("settings", "heuristic_weight"), 1.1, "expected 0 to 1"),
    "scheme": (("settings", "scheme"), "f3", "expected one of 'exact', 'f', 'f1', 'f2'"),
    "margin true": (("settings", "self_margin_mm"), True, "expected a number in mm"),
    "comfort": (("settings", "weights"), {"comfort_mm": 0}, "comfort must be positive"),
    "steps": (("settings", "steps"), {"joints_deg": [1, 1, 1, 1, 1, 0]}, "must be positive"),
    "lower case": (("program", "name"), "groove", "A-Z, 0-9 and _"),
    "comment": (("program", "comment"), "a comment too long", "16 ASCII characters"),
    "date": (("program", "date"), "26-02-30", "'YY-MM-DD'"),
    "time": (("program", "time"), "24:00:00", "'HH:MM:SS'"),
    "approach": (("program", "approach_percent"), 101, "whole number 1 to 100"),
    "fixture twice": (
        ("fixtures",),
        [{"name": "a", "shape": "sphere", "centre_mm": [0, 0, 0], "radius_mm": 1}] * 2,
        "two fixtures are called 'a'",
    ),
}


@pytest.mark.parametrize(("path", "value", "said"), BAD_CELLS.values(), ids=BAD_CELLS)
def test_a_cell_that_contradicts_itself_is_refused_with_its_key(path, value, said, tmp_path):
    file = tmp_path / "bad.toml"
    file.write_text(document(changed(shipped("cells", "groove_paper"), path, value)))
    error = refusal(load_cell, file)
    assert said in str(error)
    assert error.place.key


def test_a_file_that_touches_an_unknown_group_is_told_the_nearest(own_cell):
    with pytest.raises(InputError, match=r"path\.touches: .*did you mean 'web'"):
        own_cell({("path", "touches"): "webb"}, "groove_hw300")


@pytest.mark.parametrize(
    ("key", "value"),
    [("frame", "beam"), ("unit", "mm"), ("touches", "web"), ("resample_mm", 5.0)],
)
def test_keys_of_files_are_refused_beside_parametric_passes(own_cell, key, value):
    passes = {
        "face": "web_left", "from_along_mm": -100, "to_along_mm": 100, "offset_mm": 30, "points": 5,
    }  # fmt: skip
    own_cell({("path",): {"parametric": passes}})
    with pytest.raises(InputError, match=rf"path\.{key}: the key belongs to a file"):
        own_cell({("path",): {"parametric": passes, key: value}})


def test_step_limits_and_weights_arrive_in_si(own_cell):
    settings = {
        "lead_deg": [-5, 5, 5],
        "weights": {"clearance": 0.5, "comfort_mm": 80, "link": 2},
        "steps": {"joints_deg": [10, 10, 10, 20, 20, 20], "lean_deg": 3, "at_feed": True},
        "edge_cost": "squared",
    }
    read = own_cell({("settings",): settings}).settings
    assert np.degrees(read.lead.angles()) == pytest.approx([-5, 0, 5])
    assert (read.weights.clearance, read.weights.comfort) == pytest.approx((0.5, 0.08))
    assert np.degrees(read.steps.joints) == pytest.approx([10, 10, 10, 20, 20, 20])
    assert math.degrees(read.steps.lean) == pytest.approx(3)
    assert np.isinf(read.steps.link_joints).all()
    assert read.steps.at_feed
    assert read.edge_cost is EdgeCost.SQUARED
    assert read.self_margin == pytest.approx(0.010)


def test_a_section_object_may_replace_the_beam():
    problem = load_cell("groove_paper", beam=load_beam("HEB300"))
    assert problem.workpiece.name == "HEB300"
