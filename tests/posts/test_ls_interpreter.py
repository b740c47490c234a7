"""What motions, frames and positions of hand-written programs mean."""

from __future__ import annotations

import numpy as np
import pytest
from ls_meaning import FRAMES, kinds, meant, numbered, of_lines, with_group_two
from ls_oracle import (
    HOME,
    cartesian_point,
    config,
    flange,
    joint_point,
    pose_of,
    text,
    xyzwpr_of,
)

from solver.catalog.robots import load_robot
from solver.io.ls_findings import FindingKind
from solver.model.program import MotionKind, SpeedUnit


@pytest.fixture(scope="module")
def robot():
    return load_robot("fanuc_m20ia")


@pytest.mark.parametrize(
    ("line", "kind", "value", "unit", "cnt"),
    [
        ("J P[1] 20% FINE", "J", 20.0, SpeedUnit.PERCENT, None),
        ("J P[1] 250msec CNT50", "J", 0.25, SpeedUnit.DURATION, 50),
        ("J P[1] 1235msec CNT0", "J", 1.235, SpeedUnit.DURATION, 0),
        ("J P[1] 1.5sec CNT100", "J", 1.5, SpeedUnit.DURATION, 100),
        ("J P[1] .5sek FINE", "J", 0.5, SpeedUnit.DURATION, None),
        ("L P[1] 50mm/sec FINE ACC100", "L", 0.05, SpeedUnit.LINEAR, None),
        ("L P[1] 12.5mm/sek FINE", "L", 0.0125, SpeedUnit.LINEAR, None),
        ("L P[1] 300cm/min FINE", "L", 0.05, SpeedUnit.LINEAR, None),
        ("L P[1] 120inch/min FINE", "L", 0.0508, SpeedUnit.LINEAR, None),
        ("L P[1] 800msec FINE", "L", 0.8, SpeedUnit.DURATION, None),
    ],
)
def test_kind_speed_and_rounding_of_a_motion_come_from_its_line(
    robot, line, kind, value, unit, cnt
):
    found = of_lines(robot, line)
    (move,) = found.program.moves
    assert not found.findings
    assert (move.kind, move.speed.unit, move.cnt) == (MotionKind(kind), unit, cnt)
    assert move.speed.value == pytest.approx(value, rel=1e-15)
    assert move.source == "TEST.LS:9"
    assert move.waypoint is None


@pytest.mark.parametrize(
    ("line", "kind", "moves"),
    [
        ("C P[1]    \n    :  P[2] 50mm/sec FINE", FindingKind.MOTION, 2),
        ("A P[1] 50mm/sec FINE", FindingKind.MOTION, 1),
        ("S P[1] 50mm/sec FINE", FindingKind.MOTION, 1),
        ("J P[1] 20% FINE ACC50", FindingKind.OPTION, 1),
        ("J P[1] 20% FINE ACC150", FindingKind.OPTION, 1),
        ("J P[1] 20% FINE Wjnt", FindingKind.OPTION, 1),
        ("J P[1] 20% FINE COORD", FindingKind.OPTION, 1),
        ("J P[1] 20% FINE Skip,LBL[2]", FindingKind.OPTION, 1),
        ("J P[1] 20% FINE TB    .10sec,CALL X", FindingKind.OPTION, 1),
        ("J P[1] 20% FINE INC", FindingKind.OPTION, 0),
        ("L P[1] 50mm/sec FINE Offset,PR[4:shift it]", FindingKind.OPTION, 0),
        ("L P[1] 50mm/sec FINE Offset", FindingKind.OPTION, 0),
        ("L P[1] 50mm/sec FINE Tool_Offset,PR[4]", FindingKind.OPTION, 0),
        ("J PR[1:home] 20% FINE", FindingKind.TARGET, 0),
        ("L P[R[3]] 50mm/sec FINE", FindingKind.TARGET, 0),
        ("J P[1] R[1]% FINE", FindingKind.SPEED, 1),
        ("L P[1] max_speed FINE", FindingKind.SPEED, 1),
        ("L P[1] WELD_SPEED FINE", FindingKind.SPEED, 1),
        ("L P[1] 45deg/sec FINE", FindingKind.SPEED, 1),
        ("J P[1] 0.5% FINE", FindingKind.SPEED, 1),
        ("J P[1] 20% CNT R[3:cnt]", FindingKind.TERMINATION, 1),
        ("L P[1] 50mm/sec CR10", FindingKind.TERMINATION, 1),
        ("L P[1] 50mm/sec CD50", FindingKind.TERMINATION, 1),
    ],
)
def test_a_motion_that_cannot_be_followed_is_a_finding(robot, line, kind, moves):
    found = of_lines(robot, line + "\nJ P[1] 20% FINE")
    assert kind in kinds(found)
    assert set(kinds(found)) == {kind}
    assert found.findings[0].place.line == 9
    assert "folder/TEST.LS, line 9" in str(found.findings[0])
    assert len(found.program.moves) == moves + 1


def test_unknown_speed_and_rounding_are_replaced_by_the_fastest_and_widest(robot):
    found = of_lines(robot, "J P[1] R[1]% CNT R[2]\nL P[1] max_speed FINE")
    joint, linear = found.program.moves
    assert (joint.speed.value, joint.cnt, linear.speed.value) == (100.0, 100, 2.0)


def test_both_points_of_a_circular_move_are_kept(robot):
    found = of_lines(robot, "C P[1]\n    :  P[2] 50mm/sec FINE")
    assert [move.kind for move in found.program.moves] == [MotionKind.LINEAR] * 2
    assert [move.cnt for move in found.program.moves] == [100, None]
    assert np.degrees(found.program.joints[1]) == pytest.approx(HOME + 1)


def test_the_expected_offset_is_allowed_and_any_other_is_not(robot):
    lines = "J P[1] 20% FINE\nL P[2] 50mm/sec FINE Offset,PR[4:beam]"
    found = of_lines(robot, lines, offset=4)
    assert not found.findings
    assert (found.program.offset, found.offset_moves) == (4, (1,))
    other = of_lines(robot, lines, offset=5)
    assert kinds(other) == [FindingKind.OPTION]
    assert (other.program.offset, other.offset_moves) == (None, ())
    assert of_lines(robot, "J P[1] 20% FINE", offset=4).program.offset is None


def test_the_same_finding_in_many_lines_is_reported_once_and_counted(robot):
    (finding,) = of_lines(robot, "J P[1] 20% FINE Wjnt\n" * 5).findings
    assert finding.count == 5
    assert str(finding).endswith("(and 4 more)")


def test_frames_that_are_never_selected_are_findings(robot):
    found = meant(robot, text("J P[1] 20% FINE\nJ P[1] 20% FINE", joint_point(1, HOME)))
    assert kinds(found) == [FindingKind.FRAME_SELECTION] * 2
    assert "no UFRAME_NUM stands before the first move" in found.findings[0].sentence
    assert set(found.frames) == {(None, None), (0, 1)}


def test_another_frame_or_tool_is_a_finding_at_its_selection(robot):
    lines = "J P[1] 20% FINE\nUTOOL_NUM=2\nJ P[2] 20% FINE\nJ P[2] 20% FINE"
    found = of_lines(robot, lines, joint_point(1, HOME) + joint_point(2, HOME, 0, 2))
    (finding,) = found.findings
    assert finding.kind is FindingKind.FRAME_SELECTION
    assert finding.place.line == 10
    assert "UTOOL_NUM=2 applies to moves, 1 was expected" in finding.sentence
    assert len(found.program.moves) == 3
    assert found.frames == ((0, 1), (0, 2))


def test_a_selection_that_no_move_runs_under_is_no_finding(robot):
    source = text("UFRAME_NUM=7\nUFRAME_NUM=0\nUTOOL_NUM=1\nJ P[1] 20% FINE\nUTOOL_NUM=3",
                  joint_point(1, HOME))  # fmt: skip
    assert not meant(robot, source).findings


def test_a_taught_frame_that_is_not_selected_is_a_conflict(robot):
    found = of_lines(robot, "J P[1] 20% FINE", joint_point(1, HOME, 2, 1))
    (finding,) = found.findings
    assert finding.kind is FindingKind.FRAME_CONFLICT
    assert "P[1] was taught in UF 2, but 0 is selected" in finding.sentence
    assert "INTP-251" in finding.sentence
    assert (2, 1) in found.frames


def test_a_selection_from_a_register_is_a_finding_and_its_cartesian_moves_are_left_out(robot):
    point = cartesian_point(2, xyzwpr_of(flange(HOME)), "N U T, 0, 0, 0")
    found = of_lines(
        robot, "UFRAME_NUM=R[1]\nJ P[1] 20% FINE\nJ P[2] 20% FINE", joint_point(1, HOME) + point
    )
    assert set(kinds(found)) == {FindingKind.FRAME_SELECTION}
    assert len(found.program.moves) == 1


def test_a_cartesian_position_in_an_unknown_frame_is_left_out_and_not_guessed(robot):
    far = cartesian_point(1, np.array([5000, 0, 0, 0, 0, 0]), "N U T, 0, 0, 0", 3, 1)
    found = of_lines(robot, "UFRAME_NUM=3\nJ P[1] 20% FINE", far)
    assert FindingKind.FRAME_SELECTION in kinds(found)
    assert any("where P[1] lies is not known" in one.sentence for one in found.findings)
    assert not found.program.moves


def test_frame_zero_and_tool_zero_are_known_although_not_expected(robot):
    joints = np.array([10, 5, -5, 20, -60, 30], dtype=float)
    point = cartesian_point(1, xyzwpr_of(flange(joints)), config(joints), 0, 0)
    beam = numbered(2, pose_of(np.array([900, 0, 0, 0, 0, 90])))
    source = text("UFRAME_NUM=0\nUTOOL_NUM=0\nJ P[1] 20% FINE", point)
    found = meant(robot, source, frame=beam)
    assert kinds(found) == [FindingKind.FRAME_SELECTION] * 2
    assert np.degrees(found.program.joints[0]) == pytest.approx(joints, abs=0.01)


def test_a_position_without_frame_numbers_counts_in_the_selected_frame(robot):
    joints = np.array([10, 5, -5, 20, -60, 30], dtype=float)
    frame = pose_of(np.array([900, 100, -200, 10, 20, 30]))
    point = cartesian_point(1, xyzwpr_of(np.linalg.inv(frame) @ flange(joints)), config(joints))
    point = point.replace("UF : 0, UT : 1", "UF : F, UT : F")
    source = text("UFRAME_NUM=2\nUTOOL_NUM=1\nJ P[1] 20% FINE", point)
    found = meant(robot, source, frame=numbered(2, frame))
    assert not found.findings
    assert np.degrees(found.program.joints[0]) == pytest.approx(joints, abs=0.01)


def test_selections_of_another_group_are_a_finding_and_do_not_count(robot):
    found = of_lines(robot, "UTOOL_NUM[GP2]=4\nUTOOL_NUM[GP2,GP1]=1\nJ P[1] 20% FINE")
    assert kinds(found) == [FindingKind.GROUPS]
    assert found.frames == ((0, 1),)


def test_an_untaught_position_is_a_finding_and_left_out(robot):
    points = joint_point(1, HOME).replace("   -90.000", "  ********") + joint_point(2, HOME)
    found = of_lines(robot, "J P[1] 20% FINE\nJ P[2] 20% FINE", points)
    assert kinds(found) == [FindingKind.UNTAUGHT]
    assert len(found.program.moves) == 1


def test_an_untaught_cartesian_position_with_an_empty_config_is_a_finding(robot):
    points = (
        "P[1]{\n   GP1:\n\tUF : F, UT : F,\t\tCONFIG : '',\n"
        "\tX = ********  mm,\tY = ********  mm,\tZ = ********  mm,\n"
        "\tW = ******** deg,\tP = ******** deg,\tR = ******** deg\n};\n"
    )
    assert FindingKind.UNTAUGHT in kinds(of_lines(robot, "J P[1] 20% FINE", points))


def test_another_moving_group_is_a_finding_and_the_arm_is_still_followed(robot):
    points = with_group_two(joint_point(1, HOME)) + with_group_two(joint_point(2, HOME + 1))
    found = of_lines(robot, "J P[1] 20% FINE\nJ P[2] 20% FINE", points)
    (finding,) = found.findings
    assert (finding.kind, finding.count) == (FindingKind.GROUPS, 2)
    assert "P[1] moves GP2" in finding.sentence
    assert len(found.program.moves) == 2


def test_a_position_of_another_group_alone_moves_no_arm(robot):
    points = joint_point(1, HOME).replace("GP1", "GP2") + joint_point(2, HOME)
    found = of_lines(robot, "J P[1] 20% FINE\nJ P[2] 20% FINE", points)
    assert kinds(found) == [FindingKind.GROUPS]
    assert len(found.program.moves) == 1


def test_more_groups_in_the_head_are_a_finding(robot):
    source = text(FRAMES + "J P[1] 20% FINE", joint_point(1, HOME)).replace("1,*,*", "1,1,*")
    assert kinds(meant(robot, source)) == [FindingKind.GROUPS]


def test_external_axes_are_a_finding(robot):
    points = joint_point(1, HOME).replace("0.000 deg\n}", "0.000 deg,\n\tE1=  10.000  mm\n}")
    found = of_lines(robot, "J P[1] 20% FINE", points)
    assert kinds(found) == [FindingKind.EXTERNAL_AXES]
    assert "P[1] moves E1" in found.findings[0].sentence
    assert len(found.program.moves) == 1


def test_unused_and_repeated_positions_are_counted(robot):
    points = "".join(joint_point(number, HOME) for number in (1, 2, 3, 4))
    (use,) = of_lines(
        robot, "J P[1] 20% FINE\nJ P[3] 20% FINE\nJ P[1] 20% FINE", points
    ).position_use
    assert (use.unused, use.repeated) == (2, 1)
    assert (use.unused_numbers, use.repeated_numbers) == ((2, 4), (1,))
