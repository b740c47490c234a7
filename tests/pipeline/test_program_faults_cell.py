"""A program that is checked against a changed cell fails under the name of what changed."""

from dataclasses import replace

import numpy as np
import pytest
from written_programs import (
    ANY_CHANGE,
    CARTESIAN,
    JOINT,
    check_named,
    checks_of,
    failed,
    file_of,
    planned,
    written,
)

from solver.catalog import load_cell
from solver.errors import RefusedError
from solver.io.ls_reader import read_program
from solver.kinematics.arm import forward
from solver.model.program import Move, Speed, rounded_joints
from solver.model.program_settings import Accuracy, ContactMotion
from solver.model.settings import StepLimits, Sweep
from solver.model.shapes import Body, Box
from solver.model.toolpath import Event, EventKind
from solver.pipeline.planning import plan
from solver.pipeline.program_building import contact_moves, program_with
from solver.pipeline.program_check import inspect_moves
from solver.pipeline.programming import write_program
from solver.transforms import inverse, rigid, rotation_from_wpr
from solver.units import DEG, MM

GROOVE, ZIGZAG = "groove_hw300", "zigzag_hw250"
SPINDLE_ON, SPINDLE_OFF = Event(EventKind.SPINDLE_ON), Event(EventKind.SPINDLE_OFF)


def joints_of(cell):
    return read_program(written(cell), file_of(cell)).path_joints()


def with_box(problem, joints, offset=(0.0, 0.0, 0.0), size=30.0 * MM):
    """A box with its middle beside the TCP of a posture, `offset` in the tool's frame [m]."""
    tcp = forward(problem.robot, joints[None], problem.tool.tcp)[0]
    pose = inverse(problem.fanuc_world_from_floor) @ tcp @ rigid(position=offset)
    clamp = Body("clamp", Box(np.full(3, size)), pose)
    return replace(problem, fixtures=(*problem.fixtures, clamp))


def box_in_link(problem):
    joints = joints_of(ZIGZAG)
    return with_box(problem, (joints[29] + joints[30]) / 2.0)


def moved_beam(problem, by):
    piece = problem.workpiece
    return replace(problem, workpiece=replace(piece, placement=by @ piece.placement))


def turned_beam(problem):
    piece = problem.workpiece
    turn = rigid(rotation_from_wpr(0.0, 0.0, 0.5 * DEG))
    return replace(problem, workpiece=replace(piece, placement=piece.placement @ turn))


def with_tool(problem, **what):
    return replace(problem, tool=replace(problem.tool, **what))


def longer_tool(problem):
    return with_tool(problem, tcp=problem.tool.tcp @ rigid(position=(0.0, 0.0, 1.0 * MM)))


def with_settings(problem, **what):
    return replace(problem, settings=replace(problem.settings, **what))


def with_program(problem, **what):
    return replace(problem, program=replace(problem.program, **what))


def with_links(problem, **what):
    return with_program(problem, links=replace(problem.program.links, **what))


def with_pass(problem, **what):
    one, *rest = problem.toolpath.passes
    return replace(problem, toolpath=problem.toolpath.with_passes((replace(one, **what), *rest)))


def narrower_window(problem):
    windows = problem.robot.limits.copy()
    windows[1, 1] = joints_of(GROOVE)[:, 1].max() - 0.01
    return replace(problem, joint_windows=windows)


def moved_waypoint(problem):
    poses = problem.toolpath.passes[0].poses.copy()
    poses[25, :3, 3] += (0.0, 0.1 * MM, 0.0)
    return with_pass(problem, poses=poses)


STEP = np.array([np.inf] * 5 + [0.05 * DEG])

FAULTS = {
    "moved beam": (
        GROOVE, lambda p: moved_beam(p, rigid(position=(0.0, 0.0, 5.0 * MM))), "path position",
    ),
    "beam moved by 0.1 mm": (
        GROOVE, lambda p: moved_beam(p, rigid(position=(0.0, 0.0, 0.1 * MM))), "path position",
    ),
    "rotated beam": (GROOVE, turned_beam, "lead range"),
    "longer tool": (GROOVE, longer_tool, "path position"),
    "heavier tool": (GROOVE, lambda p: with_tool(p, mass=20.5), "payload"),
    "moved waypoint": (GROOVE, moved_waypoint, "path position"),
    "another frame number": (
        GROOVE, lambda p: with_program(p, uframe=2), "frame and tool numbers",
    ),
    "another tool number": (GROOVE, lambda p: with_program(p, utool=2), "frame and tool numbers"),
    "another payload number": (GROOVE, lambda p: with_program(p, payload=2), "payload"),
    "another spindle program": (ZIGZAG, lambda p: with_program(p, spindle_on="SPIN"), "events"),
    "a longer dwell": (
        ZIGZAG,
        lambda p: with_links(p, before=(SPINDLE_ON, Event(EventKind.DWELL, "", 2.0))),
        "events",
    ),
    "air": (
        ZIGZAG,
        lambda p: with_links(p, after=(SPINDLE_OFF, Event(EventKind.DIGITAL_OUTPUT, "3", 0.0))),
        "events",
    ),
    "an event at a waypoint": (
        GROOVE, lambda p: with_pass(p, events={20: (Event(EventKind.DWELL, "", 0.5),)}), "events",
    ),
    "narrower joint window": (GROOVE, narrower_window, "joint limits"),
    "narrower elbow": (
        GROOVE,
        lambda p: replace(p, robot=replace(p.robot, elbow_limits=np.array([-90.0, -40.0]) * DEG)),
        "elbow bound",
    ),
    "slower joints": (
        ZIGZAG, lambda p: replace(p, robot=replace(p.robot, speeds=p.robot.speeds / 1000.0)),
        "joint speed",
    ),
    "narrower lean": (
        GROOVE, lambda p: with_settings(p, lean=Sweep(-5.0 * DEG, 5.0 * DEG, 1.0 * DEG)),
        "lean range",
    ),
    "farther from singularities": (
        GROOVE, lambda p: with_settings(p, manipulability=0.4), "singularity",
    ),
    "larger safety distance": (
        GROOVE, lambda p: with_settings(p, safety_distance=50.5 * MM), "clearance",
    ),
    "larger self margin": (
        GROOVE, lambda p: with_settings(p, self_margin=200.0 * MM), "robot against itself",
    ),
    "less accurate than it is clear": (
        GROOVE, lambda p: replace(p, accuracy=Accuracy(20.0 * MM, 20.0 * MM, 10.0 * MM)),
        "net margin",
    ),
    "tighter path": (
        GROOVE, lambda p: with_program(p, path_tolerance=0.03 * MM),
        "path between positions (sampled)",
    ),
    "tighter corners": (
        ZIGZAG, lambda p: with_program(p, path_tolerance=0.1 * MM),
        "path at rounded corners (estimated)",
    ),
    "another feed": (GROOVE, lambda p: with_pass(p, feed=0.025), "feed"),
    "smaller steps of the joints": (
        GROOVE, lambda p: with_settings(p, steps=StepLimits(joints=STEP)), "steps",
    ),
    "smaller steps of the lean": (
        GROOVE, lambda p: with_settings(p, steps=StepLimits(lean=0.1 * DEG)), "steps",
    ),
    "wider links": (GROOVE, lambda p: with_links(p, clearance=60.0 * MM), "links (sampled)"),
    "a fixture in a link": (ZIGZAG, box_in_link, "links (sampled)"),
    "a fixture beside the pass": (
        GROOVE, lambda p: with_box(p, joints_of(GROOVE)[28], (0.0, 0.1, -0.25)), "clearance",
    ),
    "a fixture in the pass": (
        GROOVE, lambda p: with_box(p, joints_of(GROOVE)[28], (0.0, 0.0, -0.25)),
        "between positions (sampled)",
    ),
    "a fixture at the burr": (
        GROOVE, lambda p: with_box(p, joints_of(GROOVE)[28], (0.0, 0.0, 10.0 * MM)),
        "near and contact bodies",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", FAULTS)
def test_a_changed_cell_is_caught_under_the_name_of_what_changed(name):
    cell, change, expected = FAULTS[name]
    changed = change(planned(cell).problem)
    names = {one.name for one in checks_of(changed, written(cell)) if not one.passed}
    assert expected in names
    assert "cell digest" in names
    assert "hash" not in names


@pytest.mark.parametrize("name", ["longer tool", "narrower lean", "larger safety distance"])
def test_a_changed_cell_is_caught_in_a_cartesian_program_too(name):
    _, change, _ = FAULTS[name]
    changed = change(planned(GROOVE).problem)
    checks = checks_of(changed, written(GROOVE, CARTESIAN))
    assert not check_named("cell digest", checks).passed


def test_less_is_asked_than_the_program_keeps():
    """A copy of a cell under the same name is not the cell that was planned."""
    changed = with_settings(planned(GROOVE).problem, safety_distance=20.0 * MM)
    checks = checks_of(changed, written(GROOVE))
    assert [one.name for one in checks if not one.passed] == ["cell digest"]


def test_a_moved_frame_carries_a_cartesian_program_and_no_joint_program():
    moved = moved_beam(planned(GROOVE).problem, rigid(position=(0.0, 3.0 * MM, 2.0 * MM)))
    assert "path position" not in failed(moved, written(GROOVE, CARTESIAN))
    assert "path position" in failed(moved, written(GROOVE, JOINT))


def test_a_fixture_behind_the_web_is_no_fault():
    problem = with_box(planned(GROOVE).problem, joints_of(GROOVE)[28], (0.0, 0.0, 0.15))
    assert failed(problem, written(GROOVE)) == set()


def test_a_clearance_that_is_not_known_is_never_shown():
    """Where self pairs are too close at every position, the clearance was given as infinite."""
    problem = with_settings(planned(GROOVE).problem, self_margin=200.0 * MM)
    one = check_named("clearance", checks_of(problem, written(GROOVE)))
    assert not one.passed
    assert np.isnan(one.value)
    assert "not known" in one.detail


def test_the_pair_that_is_too_close_between_positions_is_named():
    """A pair of the robot with itself was reported as spindle and flange."""
    problem = with_settings(planned(GROOVE).problem, self_margin=200.0 * MM)
    one = check_named("between positions (sampled)", checks_of(problem, written(GROOVE)))
    assert not one.passed
    assert "flange" not in one.detail


def test_self_pairs_that_a_cell_leaves_out_are_called_not_checked():
    problem = with_settings(planned(GROOVE).problem, self_margin=None)
    one = check_named("robot against itself", checks_of(problem, written(GROOVE)))
    assert "NOT CHECKED" in one.detail


def test_a_cell_without_a_declared_accuracy_says_so():
    problem = replace(planned(GROOVE).problem, accuracy=None)
    one = check_named("net margin", checks_of(problem, written(GROOVE)))
    assert one.passed
    assert one.assumed
    assert "NO ACCURACY DECLARED" in one.detail


def test_the_net_margin_is_what_is_left_of_the_least_clearance():
    checks = checks_of(planned(ZIGZAG).problem, written(ZIGZAG))
    net = check_named("net margin", checks)
    names = ("clearance", "between positions (sampled)", "links (sampled)")
    least = min(check_named(name, checks).value for name in names)
    # 1 mm of the robot, 2 mm of the beam, 0.5 mm of the TCP; all are rounded down to 0.1 mm.
    assert abs(net.value - (least - 3.5)) < 0.1 + 1e-9
    assert "robot 1, workpiece 2 and TCP 0.5 mm" in net.detail


def test_a_link_through_the_flange_is_noticed(tmp_path):
    """Both ends are sound; the straight joint move between them is not."""
    problem = load_cell(GROOVE)
    one = problem.toolpath.passes[0]
    across = one.poses[-3:].copy()
    across[:, :3, 3] = [(0.300, 0.161, 0.1425), (0.290, 0.161, 0.1425), (0.280, 0.161, 0.1425)]
    passes = (
        replace(one, poses=one.poses[-3:], roles=one.roles[-3:]),
        replace(one, poses=across, roles=one.roles[-3:], touches=""),
    )
    unlinked = with_program(problem, links=None)
    result = plan(replace(unlinked, toolpath=problem.toolpath.with_passes(passes)))
    with pytest.raises(RefusedError, match=r"links.*come too close.*lifts"):
        write_program(result, tmp_path / "GROOVE.LS")
    assert not list(tmp_path.iterdir())


def test_a_joint_that_is_no_number_never_passes():
    problem = planned(GROOVE).problem
    joints = joints_of(GROOVE)
    moves = [Move(row, Speed.duration(0.6)) for row in joints]
    broken = joints[20].copy()
    broken[2] = np.nan
    moves[20] = Move(broken, Speed.duration(0.6))
    report = inspect_moves(problem, program_with(problem, "GROOVE", tuple(moves), 0.0), 0.0)
    assert report.failed


@pytest.mark.parametrize("motion", ContactMotion)
def test_a_move_with_an_event_ends_fine(motion):
    """What happens at a waypoint happens there, not while its corner is being cut."""
    problem = with_program(planned(GROOVE).problem, contact=motion)
    dwell = (Event(EventKind.DWELL, value=0.5),)
    changed = with_pass(problem, events={20: dwell})
    (moves,) = contact_moves(changed, rounded_joints(planned(GROOVE).sequence.pendant))
    assert [row for row, move in enumerate(moves) if move.cnt is None] == [0, 20, 49]
    assert moves[20].events == dwell
    assert moves[19].events == ()


def test_every_check_that_is_listed_can_fail():
    """A verdict that nothing can turn is no check."""
    import test_program_faults
    import test_program_faults_linear

    listed = {one.name for one in checks_of(planned(ZIGZAG).problem, written(ZIGZAG))}
    shown = {expected for _, _, expected in FAULTS.values()} | ANY_CHANGE
    shown |= {expected for _, _, expected in test_program_faults.FAULTS.values()}
    shown |= {expected for _, _, expected in test_program_faults_linear.FAULTS.values()}
    elsewhere = {
        "round trip",  # of tests/analysis: a posture that kinematics cannot give back
        "branch along passes",
        "linear moves",
        "tool angles between positions (sampled)",
    }
    assert listed - shown <= elsewhere
