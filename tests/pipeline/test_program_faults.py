"""A fault put into a written program, or a changed cell, is caught under its own name."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from solver.catalog import load_cell
from solver.io.ls_reader import read_program
from solver.model.toolpath import Event, EventKind
from solver.pipeline.planning import plan
from solver.pipeline.programming import build_program, check_program, write_program
from solver.transforms import rigid
from solver.units import MM

POSITION = re.compile(r"(P\[(\d+)\]\{\r\n   GP1:\r\n\tUF : 0, UT : 1,\t\r\n)(.*?)(\r\n\};)", re.S)
JOINT = re.compile(r"J(\d)=(.{10}) deg")


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    result = plan(load_cell("groove_hw300"))
    path = tmp_path_factory.mktemp("program") / "GROOVE.LS"
    write_program(result, path)
    return result, path.read_bytes().decode("ascii")


def failed(problem, text, file="GROOVE.LS", least=50.0 * MM, digest=False):
    """Names of the failed checks, without those that notice any change at all."""
    checks = check_program(problem, read_program(text, file), least)
    return {
        check.name
        for check in checks
        if not check.passed and (digest or check.name not in {"cell digest", "program text"})
    }


def change_joints(text, number, change):
    """Apply `change` to the six joints [deg] of one position."""

    def rewrite(match):
        if int(match[2]) != number:
            return match[0]
        joints = [float(value) for _, value in JOINT.findall(match[3])]
        changed = iter(change(joints))
        body = JOINT.sub(lambda one: f"J{one[1]}={next(changed):10.3f} deg", match[3])
        return match[1] + body + match[4]

    return POSITION.sub(rewrite, text)


def test_the_written_program_passes(written):
    result, text = written
    assert failed(result.problem, text, digest=True) == set()


@pytest.mark.parametrize("joint", range(6))
def test_a_joint_off_by_a_fiftieth_of_a_degree_leaves_the_path(written, joint):
    result, text = written

    def off(joints):
        return [value + 0.02 * (index == joint) for index, value in enumerate(joints)]

    assert failed(result.problem, change_joints(text, 7, off)) & {
        "path position",
        "spin range",
        "lead range",
    }


def test_coupling_left_out_leaves_the_path(written):
    result, text = written
    for number in range(1, 51):
        text = change_joints(text, number, lambda j: [j[0], j[1], j[2] + j[1], *j[3:]])
    assert "path position" in failed(result.problem, text)


def test_swapped_positions_leave_the_path(written):
    result, text = written
    swapped = text.replace("J P[10] ", "J P[99] ").replace("J P[30] ", "J P[10] ")
    assert "path position" in failed(result.problem, swapped.replace("J P[99] ", "J P[30] "))


def test_a_lost_position_is_counted(written):
    result, text = written
    lines = text.split("\r\n")
    kept = [line for line in lines if "J P[50] " not in line]
    assert "position count" in failed(result.problem, "\r\n".join(kept))


def test_a_moved_beam_is_noticed(written):
    result, text = written
    problem = result.problem
    moved = rigid(position=(0.0, 0.0, 0.005)) @ problem.workpiece.placement
    workpiece = replace(problem.workpiece, placement=moved)
    assert "path position" in failed(replace(problem, workpiece=workpiece), text)


def test_a_longer_tool_is_noticed(written):
    result, text = written
    tool = result.problem.tool
    longer = replace(tool, tcp=tool.tcp @ rigid(position=(0.0, 0.0, 0.001)))
    assert "path position" in failed(replace(result.problem, tool=longer), text)


def test_another_frame_or_tool_number_is_noticed(written):
    result, text = written
    assert "frame and tool numbers" in failed(result.problem, text.replace("UT : 1", "UT : 2"))
    other = text.replace("UTOOL_NUM=1", "UTOOL_NUM=2")
    assert "program flow" in failed(result.problem, other)


def test_a_renamed_program_is_noticed(written):
    result, text = written
    assert failed(result.problem, text, "OTHER.LS") == {"program name"}


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("J P[20] ", "L P[20] "),
        ("!verify in T1", "JMP LBL[1]"),
        ("!verify in T1", "R[1]=5"),
    ],
)
def test_what_the_checks_cannot_follow_fails(written, old, new):
    result, text = written
    if new.startswith("L"):
        line = next(line for line in text.split("\r\n") if "J P[20] " in line)
        text = text.replace(line, re.sub(r"J P\[20\] \S+", "L P[20] 20mm/sec", line))
    else:
        text = text.replace(old, new)
    assert failed(result.problem, text) == {"program flow"}


def test_a_motion_option_fails(written):
    result, text = written
    line = next(line for line in text.split("\r\n") if "J P[20] " in line)
    changed = line.replace("CNT100", "CNT100 Offset,PR[1]")
    assert failed(result.problem, text.replace(line, changed)) == {"program flow"}


def test_less_clearance_than_asked_fails(written):
    result, text = written
    assert failed(result.problem, text, least=50.5 * MM) == {"clearance"}


def test_a_narrower_joint_window_fails(written):
    result, text = written
    windows = result.problem.robot.limits.copy()
    windows[1, 1] = result.sequence.pendant[:, 1].max() - 0.01
    assert failed(replace(result.problem, joint_windows=windows), text) == {"joint limits"}


def test_a_fixture_in_the_way_fails(written):
    result, text = written
    fixture = replace(result.problem.fixtures[-1], pose=result.problem.workpiece.placement)
    problem = replace(result.problem, fixtures=(*result.problem.fixtures, fixture))
    assert "clearance" in failed(problem, text)


def test_nothing_is_written_when_a_check_fails_after_reading_back(written, tmp_path, monkeypatch):
    from solver.analysis.program_check import Check
    from solver.errors import RefusedError
    from solver.pipeline import programming

    result, _ = written
    broken = Check("clearance", False, 49.9, 50.0, "mm")
    monkeypatch.setattr(programming, "check_program", lambda *_: (broken,))
    with pytest.raises(RefusedError, match="clearance"):
        write_program(result, tmp_path / "X.LS")
    assert not list(tmp_path.iterdir())


def test_a_move_with_an_event_ends_fine(written):
    result, _ = written
    problem = result.problem
    one = problem.toolpath.passes[0]
    event = Event(EventKind.DWELL, value=0.5)
    toolpath = problem.toolpath.with_passes((replace(one, events={20: (event,)}),))
    program = build_program(replace(result, problem=replace(problem, toolpath=toolpath)))
    assert program.moves[20].cnt is None
    assert program.moves[20].events == (event,)
    assert program.moves[19].cnt == 100


def test_moves_take_the_time_of_their_distance_at_the_feed(written):
    result, _ = written
    program = build_program(result)
    positions = result.problem.toolpath.poses[:, :3, 3]
    distance = np.linalg.norm(np.diff(positions, axis=0), axis=1)
    durations = [move.duration for move in program.moves[1:]]
    assert np.allclose(durations, distance / result.problem.toolpath.passes[0].feed)
    assert program.moves[0].percent == result.problem.program.approach_percent


def test_the_program_says_where_it_comes_from(written):
    _, text = written
    assert "!CELL groove_hw300 ;" in text
    assert "!BEAM HW300 ;" in text
    assert not re.search(r"\b20[2-9]\d-", text)
    assert Path("GROOVE.LS").stem in text.splitlines()[0]


def test_self_pairs_that_a_cell_leaves_out_are_called_not_checked(written):
    result, text = written
    settings = replace(result.problem.settings, self_margin=None)
    checks = check_program(
        replace(result.problem, settings=settings), read_program(text, "GROOVE.LS"), 50.0 * MM
    )
    one = next(check for check in checks if check.name == "robot against itself")
    assert "NOT CHECKED" in one.detail


def test_a_cell_that_changed_since_is_noticed(written):
    """A copy of a cell under the same name is not the cell that was planned."""
    result, text = written
    narrower = replace(result.problem.settings, safety_distance=20.0 * MM)
    changed = replace(result.problem, settings=narrower)
    names = failed(changed, text, least=20.0 * MM, digest=True)
    assert names == {"cell digest", "program text"}


def test_a_full_turn_of_a_joint_between_positions_is_noticed(written):
    result, text = written
    turned = change_joints(text, 25, lambda j: [*j[:5], j[5] - 360.0 * (1 if j[5] > 0 else -1)])
    assert "joint speed" in failed(result.problem, turned)


def test_moves_that_are_too_fast_for_a_joint_are_noticed(written):
    result, text = written
    assert failed(result.problem, re.sub(r"\d+msec", "1msec", text)) == {"feed", "joint speed"}


@pytest.mark.parametrize("speed", ["10%", "100%", "500msec", "800msec", "2sec"])
def test_another_speed_while_grinding_is_noticed(written, speed):
    result, text = written
    line = next(line for line in text.split("\r\n") if "J P[20] " in line)
    changed = re.sub(r"J P\[20\] \S+", f"J P[20] {speed}", line)
    assert failed(result.problem, text.replace(line, changed)) == {"feed"}


def test_a_link_through_the_flange_is_noticed(written, tmp_path):
    """Both ends are sound; the straight joint move between them is not."""
    from solver.errors import RefusedError

    result, _ = written
    problem = result.problem
    one = problem.toolpath.passes[0]
    across = one.poses[-3:].copy()
    across[:, :3, 3] = [(0.300, 0.161, 0.1425), (0.290, 0.161, 0.1425), (0.280, 0.161, 0.1425)]
    passes = (
        replace(one, poses=one.poses[-3:], roles=one.roles[-3:]),
        replace(one, poses=across, roles=one.roles[-3:], touches=""),
    )
    linked = plan(replace(problem, toolpath=problem.toolpath.with_passes(passes)))
    with pytest.raises(RefusedError, match="between positions"):
        write_program(linked, tmp_path / "LINK.LS")
    assert not list(tmp_path.iterdir())


def test_the_sweep_between_positions_is_no_coarser_than_it_says(written):
    """Every vertex of the moving bodies moves at most 2 mm from sample to sample."""
    from solver.analysis.motion_check import SAMPLE_STEP, body_reach
    from solver.candidates.generate import build_scene
    from solver.kinematics.arm import forward_frames

    result, _ = written
    problem = result.problem
    scene = build_scene(problem)
    reach = body_reach(problem, scene)
    random = np.random.default_rng(5)
    for _ in range(200):
        joints = random.uniform(problem.robot.limits[:, 0], problem.robot.limits[:, 1])
        step = random.normal(size=6)
        step *= SAMPLE_STEP / (np.abs(step) @ reach)
        before, after = forward_frames(problem.robot, np.array([joints, joints + step]))
        for row, frame in enumerate(scene.packed.frame):
            away = random.normal(size=(20, 3))
            away *= scene.packed.radius[row] / np.linalg.norm(away, axis=1)[:, None]
            points = np.c_[scene.packed.moving.position[row] + away, np.ones(20)]
            moved = np.linalg.norm((points @ (after[frame] - before[frame]).T)[:, :3], axis=1)
            assert moved.max() <= SAMPLE_STEP + 1e-9


def test_an_accepted_clearance_is_stamped_only_where_it_is_needed(written, tmp_path):
    result, _ = written
    write_program(result, tmp_path / "A.LS", accepted_clearance=10.0 * MM)
    assert "ACCEPTED" not in (tmp_path / "A.LS").read_text("ascii")


@pytest.mark.parametrize("value", ["-100.000", "0.000", "nan", "1e9", ""])
def test_a_senseless_accepted_clearance_in_a_file_is_refused(written, value):
    from solver.errors import InputError
    from solver.pipeline.programming import required_clearance

    result, text = written
    changed = text.replace("!verify in T1", f"!ACCEPTED CLEARANCE {value} MM")
    with pytest.raises(InputError, match="clearance"):
        required_clearance(result.problem, read_program(changed, "GROOVE.LS"))


def edited(text, old, new):
    assert old in text
    return text.replace(old, new, 1)


DANGEROUS = {
    "first move in a millisecond": ("J P[1] 10% FINE", "J P[1] 1msec CNT100"),
    "first move at full speed": ("J P[1] 10% FINE", "J P[1] 100% FINE"),
    "last corner cut": ("msec FINE", "msec CNT100"),
    "corner from a register": ("CNT100", "CNT R[3]"),
    "another program is called": ("!verify in T1 ;", "CALL HOMEPOS ;"),
    "an output": ("!verify in T1 ;", "DO[1]=OFF ;"),
    "a long wait": ("!verify in T1 ;", "WAIT 999.00(sec) ;"),
    "a payload": ("!verify in T1 ;", "PAYLOAD[9] ;"),
    "a macro": ("/PROG  GROOVE", "/PROG  GROOVE Macro"),
    "a second group": ("1,*,*,*,*", "1,1,*,*,*"),
    "an external axis": (" deg\r\n};", " deg,\r\n\tE1=   500.000  mm\r\n};"),
    "no digest": ("!DIGEST", "!DIGES"),
    "less clearance": ("!verify in T1", "!ACCEPTED CLEARANCE 0.001 MM"),
}


@pytest.mark.parametrize("name", DANGEROUS)
def test_an_edit_that_leaves_the_positions_alone_is_noticed(written, name):
    result, text = written
    changed = edited(text, *DANGEROUS[name])
    checks = check_program(result.problem, read_program(changed, "GROOVE.LS"), 50.0 * MM)
    assert not all(check.passed for check in checks)


def test_another_tool_left_selected_at_the_end_is_noticed(written):
    result, text = written
    last = text.index("/POS")
    changed = text[:last] + "  58:  UTOOL_NUM=5 ;\r\n" + text[last:]
    checks = check_program(result.problem, read_program(changed, "GROOVE.LS"), 50.0 * MM)
    assert not all(check.passed for check in checks)


def test_a_joint_that_is_no_number_never_passes(written):
    from solver.analysis.motion_check import check_motion

    result, _ = written
    joints = result.sequence.pendant.copy()
    joints[5, 2] = np.nan
    checks = check_motion(result.problem, joints, np.full(50, 0.6))
    assert {one.name for one in checks if not one.passed} >= {
        "joint speed",
        "between positions (sampled)",
    }


def test_a_clearance_that_is_accepted_is_checked_as_it_is_stamped(tmp_path):
    from solver.errors import InputError

    result = plan(load_cell("groove_paper", beam="HW125"))
    with pytest.raises(InputError, match="at least"):
        write_program(result, tmp_path / "A.LS", accepted_clearance=1e-7)
    write_program(result, tmp_path / "A.LS", accepted_clearance=0.0300004)
    assert "ACCEPTED CLEARANCE 30.000 MM" in (tmp_path / "A.LS").read_text("ascii")
