"""Arrays of the 3D panel against closed forms, trimesh, the path itself and the plan."""

import csv
import math
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

import solver
from posopt_gui.viewmodels.body_mesh import beam_surface, body_surface
from posopt_gui.viewmodels.robot_mesh import (
    YELLOW,
    link_meshes,
    lofted,
    read_outlines,
    section_polygon,
    silhouette_file,
)
from posopt_gui.viewmodels.scene_model import (
    TRAIL_STEPS,
    cell_model,
    ghost_at,
    joints_at,
    tcp_trail,
)
from posopt_gui.viewmodels.scene_notes import candidate_line, note_lines
from posopt_gui.viewmodels.scene_probe import PoseProbe, Touch
from posopt_gui.viewmodels.surface_mesh import coloured, shaded
from posopt_gui.views.camera import PRESETS, Camera, close_up, fitted, picked
from solver.candidates.outcomes import Outcome
from solver.errors import InputError
from solver.model.shapes import Box, Capsule, Cylinder, Hull, Sphere


@pytest.fixture(scope="module")
def result():
    return solver.plan(solver.load_cell("groove_hw300"))


@pytest.fixture(scope="module")
def cell(result):
    return cell_model(result.problem)


@pytest.fixture(scope="module")
def robot():
    return solver.load_robot("fanuc_m20ia")


def closed(surface):
    return trimesh.Trimesh(surface.vertices, surface.faces, process=False)


def test_every_lofted_link_is_closed_and_wound_outward(robot):
    outlines = read_outlines(silhouette_file(robot))
    assert [one.link for one in outlines] == list(range(7))
    for outline in outlines:
        mesh = closed(lofted(outline))
        assert mesh.is_watertight
        assert mesh.is_winding_consistent
        assert mesh.volume > 0.0


def test_the_loft_reaches_as_far_as_the_file_says_in_all_16_directions(robot):
    file = silhouette_file(robot)
    lines = [x for x in file.read_text(encoding="utf-8").splitlines() if not x.startswith("#")]
    surfaces = {one.link: lofted(one) for one in read_outlines(file)}
    angle = np.radians(np.arange(16) * 22.5)
    for row in csv.DictReader(lines):
        link = 0 if row["link"] == "base_link" else int(row["link"][-1])
        axis = "xyz".index(row["axis"])
        vertices = surfaces[link].vertices * 1e3
        ring = vertices[np.abs(vertices[:, axis] - float(row["station_mm"])) < 1e-6]
        u, v = np.delete(ring, axis, axis=1).T
        reach = (u[:, None] * np.cos(angle) + v[:, None] * np.sin(angle)).max(axis=0)
        stated = np.array([float(row[f"h{k * 22.5:g}"]) for k in range(16)])
        # The figures are rounded to 0.1 mm, so that flat sections are not quite consistent.
        assert reach == pytest.approx(stated, abs=0.25), row


@given(st.lists(st.tuples(st.floats(-1, 1), st.floats(-1, 1)), min_size=1, max_size=12))
@settings(max_examples=60, deadline=None)
def test_a_section_polygon_contains_the_points_that_its_reaches_were_measured_on(points):
    angle = np.arange(16) * math.pi / 8
    normals = np.column_stack([np.cos(angle), np.sin(angle)])
    reach = (np.array(points) @ normals.T).max(axis=0)
    corners = section_polygon(reach)
    assert np.all(corners @ normals.T <= reach + 1e-9)
    assert (corners @ normals.T).max(axis=0) == pytest.approx(reach, abs=1e-9)


@pytest.mark.parametrize(
    "line",
    [
        "link_9,z,1" + ",1" * 16,
        "link_1,w,1" + ",1" * 16,
        "link_1,z,1,2",
        "link_1,z,nan" + ",1" * 16,
    ],
)
def test_a_bad_line_of_a_silhouette_is_named(tmp_path: Path, line):
    file = tmp_path / "silhouette.csv"
    file.write_text(f"# comment\nlink,axis,station\n{line}\n", encoding="utf-8")
    with pytest.raises(InputError, match="line 3"):
        read_outlines(file)


def test_the_flange_ends_where_the_robot_has_it_at_zero_joints(cell):
    pose = cell.links_at(np.zeros(6))[6]
    corners = cell.links[6].corners @ pose[:3, :3].T + pose[:3, 3]
    assert corners[:, 0].max() * 1e3 == pytest.approx(1085.0, abs=0.2)
    middle = (corners.min(axis=0) + corners.max(axis=0)) / 2.0 * 1e3
    assert middle[1:] == pytest.approx([0.0, 1040.0], abs=0.5)


def test_a_robot_without_a_silhouette_is_drawn_as_its_bodies(robot, monkeypatch):
    monkeypatch.setattr(
        "posopt_gui.viewmodels.robot_mesh.silhouette_file", lambda _: Path("no such file")
    )
    meshes = link_meshes(robot, "full")
    assert set(meshes) == {one.link for one in robot.body_sets["full"]}


@pytest.mark.parametrize("name", ["HW300", "HEB300", "HEA320"])
def test_a_drawn_beam_has_the_steel_of_its_section(name):
    section = solver.load_beam(name)
    mesh = closed(beam_surface(section, 1.5, YELLOW))
    area = 2.0 * section.width * section.flange
    area += (section.height - 2.0 * section.flange) * section.web
    area += (4.0 - math.pi) * section.root**2
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(1.5 * area, rel=2e-3)
    assert mesh.extents == pytest.approx([1.5, section.width, section.height])


@pytest.mark.parametrize(
    ("shape", "volume"),
    [
        (Sphere(0.3), 4 / 3 * math.pi * 0.3**3),
        (Capsule(0.2, 0.5), 4 / 3 * math.pi * 0.2**3 + math.pi * 0.2**2 * 0.5),
        (Cylinder(0.2, 0.5), math.pi * 0.2**2 * 0.5),
        (Box(np.array([0.1, 0.2, 0.3])), 0.006),
        (Hull(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])), 1 / 6),
    ],
)
def test_drawn_bodies_are_closed_and_have_their_volume(shape, volume):
    mesh = closed(body_surface(shape, YELLOW))
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(volume, rel=0.02)
    assert mesh.volume > 0.0


def test_a_ball_is_shaded_smoothly_and_a_box_has_twelve_edges():
    ball = shaded(body_surface(Sphere(0.5), YELLOW))
    radial = ball.corners / np.linalg.norm(ball.corners, axis=1, keepdims=True)
    assert np.einsum("ij,ij->i", radial, ball.normals).min() > 0.99
    assert len(ball.edges) == 0
    box = shaded(body_surface(Box(np.array([1.0, 2.0, 3.0])), YELLOW))
    assert len(box.edges) == 2 * 12
    assert np.sort(np.abs(box.normals), axis=1) == pytest.approx(
        np.tile([0.0, 0.0, 1.0], (len(box.normals), 1)), abs=1e-6
    )


def test_normals_agree_with_trimesh_where_nothing_is_creased():
    sphere = trimesh.creation.icosphere(subdivisions=3)
    mesh = shaded(coloured(sphere.vertices, sphere.faces, YELLOW), crease=math.pi)
    expected = sphere.vertices[sphere.faces].reshape(-1, 3)
    assert mesh.normals == pytest.approx(expected, abs=2e-2)


def test_between_two_waypoints_the_joints_are_interpolated_linearly(result):
    pendant = result.sequence.pendant
    assert joints_at(pendant, 3.25) == pytest.approx(0.75 * pendant[3] + 0.25 * pendant[4])
    assert np.array_equal(joints_at(pendant, 0.0), pendant[0])
    assert np.array_equal(joints_at(pendant, len(pendant) - 1.0), pendant[-1])
    assert np.array_equal(joints_at(pendant, 1e9), pendant[-1])
    assert np.array_equal(joints_at(pendant[:1], 0.5), pendant[0])


def test_the_trail_passes_every_waypoint_of_the_path(result):
    trail = tcp_trail(result.problem, result.sequence.pendant)
    assert trail[::TRAIL_STEPS] == pytest.approx(result.problem.waypoint_poses[:, :3, 3], abs=1e-9)


def test_a_ghost_stands_on_its_waypoint_and_unreachable_cells_have_none(result):
    candidates, problem = result.candidates, result.problem
    for outcome in (Outcome.FEASIBLE, Outcome.COLLISION):
        waypoint, orientation, slot = map(int, np.argwhere(candidates.outcome == outcome)[0])
        ghost = ghost_at(result, waypoint, orientation, slot)
        assert ghost.outcome is outcome
        tcp = solver.forward(problem.robot, ghost.joints, problem.tool.tcp)
        expected = problem.waypoint_poses[waypoint]
        assert tcp[:3, 3] == pytest.approx(expected[:3, 3], abs=1e-9)
        lean = candidates.orientations[orientation, 0]
        assert math.acos(tcp[:3, 2] @ expected[:3, 2]) == pytest.approx(abs(lean), abs=1e-7)
    nowhere = np.argwhere(candidates.outcome == Outcome.UNREACHABLE)
    for cell in nowhere[:1]:
        assert ghost_at(result, *map(int, cell)) is None
    assert ghost_at(result, 10_000, 0, 0) is None


def test_the_clearance_line_is_as_long_as_the_clearance_of_the_plan(result):
    probe = PoseProbe(result.problem, result.candidates.scene)
    for waypoint in (0, 17, 49):
        report = probe.measure(result.sequence.pendant[waypoint], waypoint)
        length = float(np.linalg.norm(report.points[1] - report.points[0]))
        # The plan's poses are rounded before export; the line is that of the pose as it is.
        assert report.clearance == pytest.approx(result.sequence.clearance[waypoint], abs=5e-5)
        assert length == pytest.approx(report.clearance, abs=2e-6)
        assert float(report.millimetres.removesuffix(" mm")) <= report.clearance * 1e3 + 1e-6


def shifted(result, waypoint, by):
    """Joints that put the TCP of a waypoint's pose somewhere else."""
    problem, joints = result.problem, result.sequence.pendant[waypoint]
    pose = solver.forward(problem.robot, joints, problem.tool.tcp)
    pose[:3, 3] += by
    found = solver.inverse(problem.robot, pose, problem.tool.tcp).joints
    return found[np.argmin(np.abs(found - joints).max(axis=1))]


@pytest.mark.parametrize(
    ("lower", "touch"),
    [(0.0, Touch.GROUND), (0.3e-3, Touch.GROUND), (1.2e-3, Touch.TOO_DEEP)],
)
def test_the_patch_turns_red_beyond_the_allowed_depth(result, lower, touch):
    # The web lies level, its upper face 8 mm under the ball's centre; 0.5 mm are allowed.
    probe = PoseProbe(result.problem, result.candidates.scene)
    report = probe.measure(shifted(result, 20, (0.0, 0.0, -lower)), 20)
    assert [one.touch for one in report.patches] == [touch]
    assert report.patches[0].group == "web"
    assert report.patches[0].depth == pytest.approx(lower, abs=2e-5)
    assert report.patches[0].normal == pytest.approx([0.0, 0.0, 1.0], abs=1e-3)


def test_a_lifted_ball_has_no_patch_and_one_in_the_flange_a_red_one(result):
    problem = result.problem
    probe = PoseProbe(problem, result.candidates.scene)
    assert probe.measure(shifted(result, 20, (0.0, 0.0, 2e-3)), 20).patches == ()
    place = problem.waypoint_poses[20][:3, 3]
    section = problem.workpiece.section
    centre = (problem.fanuc_world_from_floor @ problem.workpiece.placement)[:3, 3]
    # Beam z is floor x: the ball's centre at the inside of the far flange, above the fillet.
    inside = centre[0] + section.height / 2 - section.flange - 5e-3
    by = (inside - place[0], 0.0, 0.04)
    report = probe.measure(shifted(result, 20, by), 20)
    assert [(one.touch, one.group) for one in report.patches] == [(Touch.ANOTHER, "flange_top")]


def test_a_pose_that_collides_says_how_deep_as_the_explanation_of_its_filters_does(result):
    candidates = result.candidates
    probe = PoseProbe(result.problem, candidates.scene)
    for waypoint, orientation, slot in np.argwhere(candidates.outcome == Outcome.COLLISION)[::60]:
        ghost = ghost_at(result, int(waypoint), int(orientation), int(slot))
        report = probe.measure(ghost.joints, int(waypoint))
        lean = float(candidates.orientations[orientation, 0])
        told = solver.explain(result.problem, int(waypoint), lean, int(candidates.branches[slot]))
        (margin,) = (one.margin for one in told.filters if one.filter is Outcome.COLLISION)
        assert report.clearance * 1e3 == pytest.approx(margin, abs=1e-6)
        assert report.clearance <= 0.0
        assert np.linalg.norm(report.points[1] - report.points[0]) == pytest.approx(
            -report.clearance, abs=1e-5
        )


def test_a_candidate_is_named_with_its_verdict(result):
    def tr(text, **values):
        return text.format(**values)

    outcome = result.candidates.outcome
    waypoint, orientation, slot = map(int, np.argwhere(outcome == Outcome.COLLISION)[0])
    lean = math.degrees(result.candidates.orientations[orientation, 0])
    words = candidate_line(result, waypoint, orientation, slot, tr)
    assert words == (
        f"Candidate at waypoint {waypoint + 1}, lean {lean:.0f}°: collision".replace("-", "−")
    )


def test_the_notes_name_bodies_in_words_and_contact_that_is_not_allowed(result, cell):
    def tr(text, **values):
        return text.format(**values)

    probe = PoseProbe(result.problem, result.candidates.scene)
    good = note_lines(tr, cell, probe.measure(result.sequence.pendant[20], 20), stale=False)
    assert len(good) == 2
    assert "_" not in good[0]
    assert good[1] == "Cable package: not modelled, not checked"
    deep = probe.measure(shifted(result, 20, (0.0, 0.0, -1.2e-3)), 20)
    words = note_lines(tr, cell, deep, stale=True)
    assert words[0].startswith("Pose and trail belong to the plan before")
    assert "Contact: 1.20 mm into the web, more than allowed" in words


def test_the_cell_has_its_tool_workpiece_and_note_on_cables(cell, result):
    assert not cell.cables
    low, high = cell.fixed.bounds
    assert low[2] == pytest.approx(cell.floor)
    assert high[0] == pytest.approx(0.9 + result.problem.workpiece.section.height / 2, abs=1e-6)
    assert len(cell.path.points) == len(result.problem.toolpath)
    assert set(cell.bounding) == {one.link for one in result.problem.robot_bodies} | {6}


def seen(camera: Camera, points, aspect):
    """Places of points in the picture, -1 to 1 across and upward."""
    local = (points - camera.centre) @ camera.axes.T
    half = math.tan(math.radians(camera.field) / 2.0)
    ahead = camera.distance - local[:, 2]
    assert np.all(ahead > 0.0)
    return local[:, 0] / ahead / half, local[:, 1] / ahead / half * aspect


@pytest.mark.parametrize("direction", PRESETS.values(), ids=PRESETS)
@pytest.mark.parametrize("aspect", [0.6, 1.6, 3.0])
def test_fitting_shows_everything_and_little_else(cell, direction, aspect):
    points = cell.points_at(cell.rest)
    camera = fitted(points, *direction, aspect, 34.0)
    across, upward = (np.abs(x).max() for x in seen(camera, points, aspect))
    assert across <= 1.0
    assert upward <= 1.0
    assert max(across, upward) > 0.75


@given(st.floats(1, 799), st.floats(1, 399), st.sampled_from(list(PRESETS.values())))
@settings(max_examples=60, deadline=None)
def test_a_ray_passes_the_points_that_are_seen_at_its_pixel(x, y, direction):
    camera = Camera(np.array([0.3, -0.2, 0.5]), 2.0, *direction)
    origin, unit = camera.ray(x, y, 800, 400)
    for distance in (0.5, 3.0):
        across, upward = seen(camera, (origin + distance * unit)[None], 2.0)
        assert across[0] == pytest.approx(x / 400 - 1.0, abs=1e-9)
        assert upward[0] == pytest.approx(1.0 - y / 200, abs=1e-9)


def test_a_click_means_the_nearest_point_within_reach():
    points = np.array([[1.0, 0.0, 0.0], [1.0, 0.02, 0.0], [-1.0, 0.0, 0.0]])
    origin, ahead = np.zeros(3), np.array([1.0, 0.0, 0.0])
    assert picked(points, origin, ahead, 1e-3) == 0
    assert picked(points[1:], origin, ahead, 1e-3) is None
    assert picked(points[2:], origin, ahead, 1.0) is None
    assert picked(points[:0], origin, ahead, 1.0) is None


def test_the_close_up_looks_at_the_tool_from_outside_the_work(result):
    problem = result.problem
    tcp = solver.forward(problem.robot, result.sequence.pendant[10], problem.tool.tcp)
    camera = close_up(tcp, problem.waypoint_poses[-1, :3, 3] - problem.waypoint_poses[0, :3, 3], 34)
    across, upward = seen(camera, tcp[None, :3, 3], 1.6)
    assert abs(across[0]) < 0.5
    assert abs(upward[0]) < 0.8
    assert camera.axes[2] @ tcp[:3, 2] < 0.0
