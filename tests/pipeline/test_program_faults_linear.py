"""A fault put into a program of L moves, with Cartesian or joint positions, has its name."""

import re

import numpy as np
import pytest
from written_programs import (
    CARTESIAN,
    check_named,
    checks_of,
    edited,
    failed,
    planned,
    position,
    with_joints,
    with_line,
    with_speed,
    with_value,
    without_line,
    without_move,
    written,
)

from solver.analysis.motion_checks import linear_check
from solver.io.ls_reader import read_program
from solver.kinematics.arm import all_branches, forward
from solver.model.program import MotionKind, Move, Speed
from solver.units import DEG, DEG_PER_RAD

GROOVE, ZIGZAG = "groove_hw300", "zigzag_hw250"


def by(amount, axis, number=20):
    return lambda text: with_value(text, number, axis, lambda value: value + amount)


def in_position(number, old, new):
    def change(text):
        entry = position(text, number)
        return edited(text, entry, re.sub(old, new, entry, count=1))

    return change


def in_line(number, old, new):
    return lambda text: with_line(text, number, lambda line: line.replace(old, new))


def swapped(text):
    text = in_line(10, "P[10]", "P[999]")(text)
    return in_line(30, "P[30]", "P[10]")(text).replace("P[999]", "P[30]")


def config(number, new):
    return in_position(number, "'N U T, 0, 0, 0'", f"'{new}'")


def without(*numbers):
    def change(text):
        for number in numbers:
            text = without_move(text, number)
        return text

    return change


FAULTS = {
    "position 0.1 mm off": (GROOVE, by(0.1, "X"), "path position"),
    "orientation 0.1 deg off": (GROOVE, by(0.1, "W"), "lead range"),
    "sign left out": (
        GROOVE, lambda t: with_value(t, 20, "X", lambda value: -value), "path position",
    ),
    "positions swapped": (GROOVE, swapped, "path position"),
    "20 % too fast": (GROOVE, lambda t: with_speed(t, 20, "24mm/sec"), "feed"),
    "20 % too slow": (GROOVE, lambda t: with_speed(t, 20, "16mm/sec"), "feed"),
    "percent while grinding": (GROOVE, lambda t: with_speed(t, 20, "1%", "J"), "feed"),
    "a joint too fast on a link": (ZIGZAG, lambda t: with_speed(t, 31, "20msec"), "joint speed"),
    "another turn of J6": (GROOVE, config(25, "N U T, 0, 0, 1"), "motion"),
    "another turn of J6 downward": (GROOVE, config(25, "N U T, 0, 0, -1"), "motion"),
    "another turn of J4": (GROOVE, config(25, "N U T, 0, 1, 0"), "motion"),
    "another turn of J1": (GROOVE, config(25, "N U T, 1, 0, 0"), "motion"),
    "wrist flipped": (GROOVE, config(25, "F U T, 0, 0, 0"), "motion"),
    "elbow down": (GROOVE, config(25, "N D T, 0, 0, 0"), "motion"),
    "arm turned back": (GROOVE, config(25, "N U B, 0, 0, 0"), "motion"),
    "no CONFIG letter": (GROOVE, config(25, "X U T, 0, 0, 0"), "reach"),
    "out of reach": (GROOVE, by(3000.0, "X"), "reach"),
    "an offset": (GROOVE, in_line(20, "CNT100", "CNT100 Offset,PR[1]"), "program flow"),
    "a tool offset": (GROOVE, in_line(20, "CNT100", "CNT100 Tool_Offset,PR[1]"), "program flow"),
    "a coordinated move": (GROOVE, in_line(20, "CNT100", "CNT100 COORD"), "program flow"),
    "a circle": (GROOVE, in_line(20, "L P[20] ", "C P[20]\r\n    :  P[21] "), "program flow"),
    "a target in a register": (GROOVE, in_line(20, "P[20]", "PR[20]"), "program flow"),
    "a corner region": (GROOVE, in_line(20, "CNT100", "CR10"), "program flow"),
    "untaught position": (GROOVE, in_position(20, r"Z =.{10}", "Z =  ********"), "program flow"),
    "taught in another frame": (
        GROOVE, in_position(20, "UF : 1", "UF : 2"), "frame and tool numbers",
    ),
    "another tool everywhere": (
        GROOVE,
        lambda t: edited(t, "UTOOL_NUM=1", "UTOOL_NUM=2").replace("UT : 1", "UT : 2"),
        "frame and tool numbers",
    ),
    "the world's frame everywhere": (
        GROOVE,
        lambda t: edited(t, "UFRAME_NUM=1", "UFRAME_NUM=0").replace("UF : 1", "UF : 0"),
        "frame and tool numbers",
    ),
    "position line left out": (GROOVE, lambda t: without_line(t, 20), "position count"),
    "position driven to twice": (
        GROOVE, lambda t: with_line(t, 20, lambda line: 2 * line), "feed",
    ),
    "no position between two passes": (ZIGZAG, without(29, 30, 31, 32), "lifts"),
    "retract left out": (ZIGZAG, without(30), "lifts"),
    "retract and approach left out": (ZIGZAG, without(30, 31), "lifts"),
    "retract lowered into the other flange": (ZIGZAG, by(-150.0, "Y", 30), "links (sampled)"),
    "approach lowered into the web": (ZIGZAG, by(-100.0, "Y", 31), "links (sampled)"),
    "a corner of the path cut": (ZIGZAG, by(1.0, "X", 40), "path between positions (sampled)"),
}  # fmt: skip


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_in_cartesian_positions_is_caught_under_its_own_name(name):
    cell, change, expected = FAULTS[name]
    changed = change(written(cell, CARTESIAN))
    assert changed != written(cell, CARTESIAN)
    names = {one.name for one in checks_of(planned(cell).problem, changed) if not one.passed}
    assert expected in names
    assert "hash" in names


@pytest.mark.parametrize("cell", [GROOVE, ZIGZAG])
def test_what_was_written_passes_every_check(cell):
    assert all(one.passed for one in checks_of(planned(cell).problem, written(cell, CARTESIAN)))


def test_fewer_positions_on_a_straight_line_are_no_fault():
    """The moved TCP stays where it was; only the hash knows."""
    fewer = without(*range(15, 40))(written(GROOVE, CARTESIAN))
    assert failed(planned(GROOVE).problem, fewer) == set()


def all_linear(text):
    for number in range(5, 54):
        text = with_speed(text, number, "20mm/sec", "L")
    return text


def sixth_joint_turned(joints):
    return [*joints[:5], joints[5] - (360.0 if joints[5] > 0.0 else -360.0)]


def flipped(joints):
    """The same pose with the other wrist posture."""
    problem = planned(GROOVE).problem
    pose = forward(problem.robot, np.array([joints]) * DEG, problem.tool.tcp)[0]
    found = all_branches(problem.robot, pose, problem.tool.tcp).joints[1] * DEG_PER_RAD
    return found.round(3)


def test_linear_moves_between_joint_positions_are_sound():
    assert failed(planned(GROOVE).problem, all_linear(written(GROOVE))) == set()


@pytest.mark.parametrize("change", [sixth_joint_turned, flipped])
def test_a_linear_move_does_not_arrive_at_another_turn_or_branch(change):
    """The controller takes the shortest joint way, whatever the joints of the position say."""
    text = with_joints(all_linear(written(GROOVE)), 25, change)
    checks = checks_of(planned(GROOVE).problem, text)
    one = check_named("motion", checks)
    assert not one.passed
    assert "shortest joint way" in one.detail
    assert "GROOVE.LS:66" in one.detail


def test_a_joint_move_that_changes_the_branch_on_the_path_is_noticed():
    text = with_joints(written(GROOVE), 25, flipped)
    names = failed(planned(GROOVE).problem, text)
    assert names >= {
        "branch along passes",
        "singularity",
        "tool angles between positions (sampled)",
    }


def test_the_pose_of_a_changed_branch_itself_is_on_the_path():
    """Position checks alone would not see it."""
    text = with_joints(written(GROOVE), 25, flipped)
    names = failed(planned(GROOVE).problem, text)
    assert "path position" not in names


def linear(joints, source):
    return Move(joints, Speed.linear(0.02), MotionKind.LINEAR, source=source)


@pytest.mark.parametrize(
    "fault", [flipped, lambda joints: [*joints[:3], joints[3] + 190.0, *joints[4:]]]
)
def test_the_worst_linear_move_is_named_with_its_line(fault):
    """The worst line was shown as the best one before the first broken line."""
    robot = planned(GROOVE).problem.robot
    joints = read_program(written(GROOVE), "GROOVE.LS").path_joints()[3:53]
    moves = [linear(row, f"GROOVE.LS:{number}") for number, row in enumerate(joints, start=44)]
    sound = linear_check(robot, moves)
    assert sound.passed
    assert sound.value < 5.0
    moves[30] = linear(np.array(fault(joints[30] * DEG_PER_RAD)) * DEG, "GROOVE.LS:74")
    one = linear_check(robot, moves)
    assert not one.passed
    assert "GROOVE.LS:74" in one.detail or "GROOVE.LS:75" in one.detail
    assert one.value > 170.0
