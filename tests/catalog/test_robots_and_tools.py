"""The shipped robot and tools against measured poses, and a second robot as data alone."""

import math

import numpy as np
import pytest
from catalog_mutations import changed, document, refusal, shipped

from solver.catalog import describe, list_names, load_robot, load_tool
from solver.catalog import names as catalog_names
from solver.errors import InputError, UnknownNameError
from solver.model.shapes import Box, Capsule, Cylinder, Sphere, ToolRole

MM = 1e-3


def craig(alpha, a, d, theta):
    """Rx(alpha) Tx(a) Rz(theta) Tz(d), written out."""
    ca, sa, c, s = math.cos(alpha), math.sin(alpha), math.cos(theta), math.sin(theta)
    return np.array(
        [
            [c, -s, 0, a],
            [s * ca, c * ca, -sa, -d * sa],
            [s * sa, c * sa, ca, d * ca],
            [0, 0, 0, 1],
        ]
    )


def flange_pose(robot, joints_deg):
    pose = np.eye(4)
    angles = robot.model_from_pendant @ np.radians(joints_deg)
    for (alpha, a, d, offset), angle in zip(robot.dh, angles, strict=True):
        pose = pose @ craig(alpha, a, d, angle + offset)
    return pose @ robot.flange


@pytest.mark.parametrize(
    ("joints", "position", "wpr"),
    [
        ((0, 0, 0, 0, 0, 0), (1085, 0, 1040), (180, -90, 0)),
        ((0, 0, 0, 0, -90, 0), (985, 0, 940), (180, 0, 0)),
        (
            (30, 20, -10, 15, -60, 45),
            (1154.9123, 640.9070, 752.4997),
            (155.7498, -2.8516, 80.8485),
        ),
        (
            (-45, 40, -30, 100, 50, -120),
            (1152.8598, -1046.1706, 360.5220),
            (-122.9172, -36.5431, -56.9336),
        ),
    ],
)
def test_the_data_of_the_m20ia_reproduce_measured_flange_poses(joints, position, wpr):
    pose = flange_pose(load_robot("fanuc_m20ia"), joints)
    np.testing.assert_allclose(pose[:3, 3] / MM, position, atol=1e-4)
    w, p, r = np.radians(wpr)
    roll = craig(w, 0, 0, 0)[:3, :3]
    pitch = np.array([[math.cos(p), 0, math.sin(p)], [0, 1, 0], [-math.sin(p), 0, math.cos(p)]])
    yaw = craig(0, 0, 0, r)[:3, :3]
    np.testing.assert_allclose(pose[:3, :3], yaw @ pitch @ roll, atol=2e-6)


def test_limits_and_ranges_are_those_of_the_maker():
    robot = load_robot("FANUC_M20iA")
    assert np.degrees(robot.limits).tolist() == pytest.approx(
        np.array([(-170, 170), (-100, 160), (-185, 273.12), (-200, 200), (-140, 140), (-270, 270)])
    )
    assert np.degrees(robot.speeds) == pytest.approx([195, 175, 180, 360, 360, 550])
    assert np.degrees(robot.cost_ranges) == pytest.approx([340, 260, 458.12, 400, 280, 540])
    assert robot.world_height == pytest.approx(0.525)
    assert robot.payload == 20.0
    assert robot.assumptions


def placed_ends(body):
    """Both ends of the axis of a capsule or cylinder in its link frame."""
    half = np.array([0.0, 0.0, body.shape.length / 2, 0.0])
    origin = np.array([0.0, 0.0, 0.0, 1.0])
    return [(body.pose @ (origin + sign * half))[:3] for sign in (-1, 1)]


def test_paper_bodies_are_the_stated_capsules_without_inflation():
    bodies = {one.body.name: one for one in load_robot("fanuc_m20ia").body_sets["paper"]}
    expected = {
        "base": (0, 0.190, (0, 0, 0), (0, 0, 0.525)),
        "upper_arm": (2, 0.130, (0, 0, 0), (0, 0, 0.790)),
        "forearm_capsule": (4, 0.130, (0, 0, 0), (0.835, 0, 0)),
    }
    assert bodies.keys() == expected.keys()
    for name, (link, radius, start, end) in expected.items():
        assert bodies[name].link == link
        assert isinstance(bodies[name].body.shape, Capsule)
        assert bodies[name].body.shape.radius == pytest.approx(radius, abs=1e-15)
        np.testing.assert_allclose(placed_ends(bodies[name].body), [start, end], atol=1e-15)


def test_full_bodies_are_a_fifth_of_a_millimetre_larger_than_their_figures():
    bodies = {one.body.name: one.body for one in load_robot("fanuc_m20ia").body_sets["full"]}
    base = bodies["base"]
    assert isinstance(base.shape, Cylinder)
    assert base.shape.radius == pytest.approx(0.3139)
    np.testing.assert_allclose(placed_ends(base), [(0, 0, -0.0002), (0, 0, 0.6422)], atol=1e-12)
    elbow = bodies["elbow"]
    assert isinstance(elbow.shape, Capsule)
    assert elbow.shape.radius == pytest.approx(0.1996)
    np.testing.assert_allclose(
        placed_ends(elbow), [(0.0724, 0.0212, 0.006), (0.1825, 0.0001, 0.18)], atol=1e-12
    )
    tube = bodies["forearm_tube"]
    assert isinstance(tube.shape, Box)
    np.testing.assert_allclose(tube.shape.size, [0.4764, 0.1748, 0.1508], atol=1e-12)
    np.testing.assert_allclose(tube.pose[:3, 3], [0.462, -0.032, 0.0], atol=1e-12)
    assert isinstance(bodies["wrist"].shape, Sphere)
    assert {one.group for one in bodies.values()} == {
        "base", "lower_arm", "elbow", "forearm", "wrist",
    }  # fmt: skip


def test_forearm_and_lower_arm_stay_apart_at_every_angle_that_the_elbow_bound_allows():
    coal = pytest.importorskip("coal")
    robot = load_robot("fanuc_m20ia")

    def geometry(shape):
        if isinstance(shape, Box):
            return coal.Box(*shape.size)
        return coal.Cylinder(shape.radius, shape.length)

    def turned(axis, angle, pose):
        rotation = np.eye(4)
        rotation[:3, :3] = axis_turn(axis, angle)
        return rotation @ pose

    def axis_turn(axis, angle):
        x, y, z = axis
        skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        return np.eye(3) + math.sin(angle) * skew + (1 - math.cos(angle)) * skew @ skew

    def distance(elbow, j4):
        least = math.inf
        for arm in lower:
            for one in forearm:
                pose = turned((1, 0, 0), j4, one.pose)
                pose[2, 3] += robot.dh[3, 1]
                pose = turned((0, -1, 0), elbow, pose)
                pose[2, 3] += robot.dh[2, 1]
                placed = [coal.Transform3s(p[:3, :3], p[:3, 3]) for p in (arm.pose, pose)]
                result = coal.DistanceResult()
                least = min(
                    least,
                    coal.distance(
                        geometry(arm.shape), placed[0], geometry(one.shape), placed[1],
                        coal.DistanceRequest(), result,
                    ),
                )  # fmt: skip
        return least

    bodies = [one.body for one in robot.body_sets["full"]]
    lower = [one for one in bodies if one.group == "lower_arm"]
    forearm = [one for one in bodies if one.group == "forearm"]
    low, high = robot.elbow_limits
    turns = np.radians(np.arange(-180, 180, 10))
    for elbow in (*np.linspace(low, low + 0.3, 4), 0.0, 1.2, *np.linspace(high - 0.3, high, 4)):
        assert min(distance(elbow, j4) for j4 in turns) > 0.010
    folded = math.radians(-106.67)
    assert max(distance(folded, j4) for j4 in turns) < 0.0


def test_a_second_robot_with_other_lengths_needs_no_code(tmp_path):
    tree = shipped("robots", "fanuc_m20ia")
    tree["robot"] |= {"name": "longer_arm", "title": "Longer arm", "world_height_mm": 450}
    tree["dh"]["a_mm"] = [0, 75, 840, 215, 0, 0]
    tree["dh"]["d_mm"] = [0, 0, 0, 890, 0, 0]
    tree["flange"]["position_mm"] = [0, 0, 90]
    tree["limits"]["lower_deg"][0] = -185
    file = tmp_path / "longer_arm.toml"
    file.write_text(document(tree))
    robot = load_robot(file)
    assert robot.name == "longer_arm"
    assert robot.arm_lengths == pytest.approx((0.075, 0.840, 0.215, 0.890))
    position = flange_pose(robot, np.zeros(6))[:3, 3]
    np.testing.assert_allclose(position, [0.075 + 0.890 + 0.090, 0.0, 0.840 + 0.215], atol=1e-12)
    assert load_robot(str(file)).limits[0, 0] == pytest.approx(math.radians(-185))


@pytest.mark.parametrize(
    ("path", "value", "said"),
    [
        (("dh", "a_mm"), [0, 150, -790, 250, 0, 0], "arm with a spherical wrist"),
        (("dh", "alpha_deg"), [0, -90, 0, -90, 90, 90], "arm with a spherical wrist"),
        (("limits", "upper_deg"), [170, -160, 273, 200, 140, 270], r"lower limit of J2"),
        (("limits", "elbow_deg"), [190, -90], "elbow limits are empty"),
        (("limits", "speed_deg_s"), [195, 175, 0, 360, 360, 550], "must be positive"),
        (("pendant", "model_from_pendant"), [[0] * 6] * 6, "cannot be inverted"),
        (("pendant", "model_from_pendant"), [[0.5] * 6] * 6, "expected a whole number"),
        (("bodies", "full"), [], "one body or more"),
        (("bodies", "full", 0, "radius_mm"), -1, "must be a positive length"),
        (("bodies", "full", 0, "to_mm"), [0, 0, 0], "a point other than from_mm"),
        (("bodies", "full", 0, "shape"), "cylindre", "did you mean 'cylinder'"),
        (("bodies", "full", 3, "max_mm"), [0, 0, 0], "the same entry of min_mm"),
        (("bodies", "full", 0, "link"), 7, "whole number 0 to 6"),
        (("neighbours", 0), ["base", "flor"], "no body is called 'flor'"),
        (("neighbours", 0), ["base", "base"], "two different groups"),
        (("neighbours", 0), ["base"], "a list of 2 texts"),
        (("inflation", "full_mm"), -1.0, "at least 0"),
        (("robot", "name"), "a b", "expected a name"),
    ],
)
def test_a_robot_that_contradicts_itself_is_refused(path, value, said, tmp_path):
    file = tmp_path / "bad.toml"
    file.write_text(document(changed(shipped("robots", "fanuc_m20ia"), path, value)))
    error = refusal(load_robot, file)
    assert said in str(error)


def test_tools_reach_from_the_flange_to_the_tcp():
    paper, grinder = load_tool("paper_tool"), load_tool("die_grinder")
    robot = load_robot("fanuc_m20ia")
    for tool in (paper, grinder):
        wrist_from_tcp = robot.flange @ tool.tcp
        np.testing.assert_allclose(wrist_from_tcp[:3, 3], [0, 0, 0.510], atol=1e-15)
        # The paper's tool transform is Rz(180 deg).
        np.testing.assert_array_equal(wrist_from_tcp[:3, :3], np.diag([-1.0, -1.0, 1.0]))
    (capsule,) = paper.bodies
    behind = [0.410 - end[2] for end in placed_ends(capsule.body)]
    assert sorted(behind) == pytest.approx([0.165, 0.410])
    assert capsule.body.shape.radius == pytest.approx(0.06)
    assert capsule.role is ToolRole.CLEARANCE


def test_the_die_grinder_is_closed_from_flange_to_ball_and_has_three_roles():
    bodies = {one.body.name: one for one in load_tool("die_grinder").bodies}
    roles = {name: one.role.value for name, one in bodies.items()}
    assert roles == {
        "adapter": "clearance", "spindle": "clearance", "nose": "clearance",
        "shank": "near", "ball": "contact",
    }  # fmt: skip
    ends = [placed_ends(bodies[name].body) for name in ("adapter", "spindle", "nose", "shank")]
    stations = [float(end[2]) for pair in ends for end in pair]
    assert stations == pytest.approx([0, 0.1, 0.1, 0.245, 0.245, 0.31, 0.31, 0.402])
    assert bodies["ball"].body.pose[2, 3] == pytest.approx(0.410)
    assert (bodies["shank"].margin, bodies["ball"].depth) == pytest.approx((0.002, 0.0005))


@pytest.mark.parametrize(
    ("path", "value", "said"),
    [
        (("tool", "mass_kg"), -1, "expected at least 0 in kg"),
        (("bodies", 0, "role"), "near-by", "did you mean 'near'"),
        (("bodies", 1, "name"), "adapter", "two bodies are called 'adapter'"),
        (("bodies", 3, "margin_mm"), -2.0, "key bodies[3].margin_mm: expected 0 to 1000 in mm"),
        (("bodies", 3, "margin_mm"), 1000.1, "key bodies[3].margin_mm: expected 0 to 1000 in mm"),
        (("bodies", 4, "margin_mm"), 2000, "key bodies[4].margin_mm: expected 0 to 1000 in mm"),
        (("bodies", 4, "depth_mm"), -0.1, "key bodies[4].depth_mm: expected 0 to 20 in mm"),
        (("bodies", 4, "depth_mm"), 20.1, "key bodies[4].depth_mm: expected 0 to 20 in mm"),
        (("bodies", 0, "margin_mm"), 2.0, "unknown key"),
    ],
)
def test_a_tool_that_contradicts_itself_is_refused(path, value, said, tmp_path):
    file = tmp_path / "bad.toml"
    file.write_text(document(changed(shipped("tools", "die_grinder"), path, value)))
    assert said in str(refusal(load_tool, file))


def test_the_largest_margin_and_depth_are_accepted(tmp_path):
    tree = changed(shipped("tools", "die_grinder"), ("bodies", 4, "margin_mm"), 1000)
    file = tmp_path / "wide.toml"
    file.write_text(document(changed(tree, ("bodies", 4, "depth_mm"), 20)))
    ball = load_tool(file).bodies[4]
    assert (ball.margin, ball.depth) == pytest.approx((1.0, 0.020))


@pytest.mark.parametrize("kind", ["robots", "tools", "beams", "cells"])
def test_every_shipped_entry_is_listed_with_a_line_about_it(kind):
    entries = describe(kind)
    assert list_names(kind) == tuple(one.name for one in entries)
    assert all(one.title and one.title.isprintable() for one in entries)


def test_an_unknown_kind_or_name_says_what_there_is():
    with pytest.raises(InputError, match="expected one of robots, tools, beams, cells"):
        list_names("posts")
    with pytest.raises(UnknownNameError, match=r"no robot is called 'm20' \(known: fanuc_m20ia\)"):
        load_robot("m20")
    with pytest.raises(UnknownNameError, match=r"known: die_grinder, paper_tool"):
        load_tool("die grindr")


def test_a_checkout_without_the_installed_data_package_uses_its_own_folder(monkeypatch):
    def missing(name):
        raise ModuleNotFoundError(name)

    monkeypatch.setattr(catalog_names.importlib.resources, "files", missing)
    folder = catalog_names.resource_folder()
    assert (folder / "robots" / "fanuc_m20ia.toml").is_file()


def test_installed_data_are_found_through_the_data_package(monkeypatch, tmp_path):
    (tmp_path / "tools").mkdir()
    tree = changed(shipped("tools", "paper_tool"), ("tool", "name"), "installed")
    (tmp_path / "tools" / "installed.toml").write_text(document(tree))
    monkeypatch.setattr(catalog_names.importlib.resources, "files", lambda _: tmp_path)
    assert load_tool("Installed").name == "installed"
    monkeypatch.setattr(catalog_names.importlib.resources, "files", lambda _: tmp_path / "nowhere")
    with pytest.raises(InputError, match="the shipped data are missing"):
        load_tool("paper_tool")
