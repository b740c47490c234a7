"""A fault put into the text of a written program with joint positions is caught under its name."""

import re

import pytest
from written_programs import (
    ANY_CHANGE,
    checks_of,
    edited,
    failed,
    file_of,
    joint_off,
    line_to,
    planned,
    position,
    with_joints,
    with_line,
    with_speed,
    without_line,
    without_move,
    written,
)

from solver.errors import InputError
from solver.io.ls_hash import content_hash, stated_hash
from solver.io.ls_reader import read_program
from solver.pipeline.remarks import required_clearance

GROOVE, ZIGZAG = "groove_hw300", "zigzag_hw250"

# P[1] of groove is home, P[2] the approach, P[3] the lead-in, P[4] to P[53] the waypoints.
# Of zigzag P[4] to P[28], P[33] to P[57] and P[62] to P[86] are waypoints; between the first two
# passes P[29] is the lead-out, P[30] the retract, P[31] the approach and P[32] the lead-in.


def without(*numbers):
    def change(text):
        for number in numbers:
            text = without_move(text, number)
        return text

    return change


def behind(number, *lines):
    """Adds lines behind the one that moves to a position."""
    added = "".join(f"   1:  {line} ;\r\n" for line in lines)
    return lambda text: with_line(text, number, lambda line: line + added)


def coupling_left_out(text):
    for number in range(1, text.count("\nP[") + 1):
        text = with_joints(text, number, lambda j: [j[0], j[1], j[2] + j[1], *j[3:]])
    return text


def swapped(one, other):
    def change(text):
        text = with_line(text, one, lambda line: line.replace(f"P[{one}]", "P[999]"))
        text = with_line(text, other, lambda line: line.replace(f"P[{other}]", f"P[{one}]"))
        return text.replace("P[999]", f"P[{other}]")

    return change


def in_position(number, old, new):
    def change(text):
        entry = position(text, number)
        return edited(text, entry, re.sub(old, new, entry, count=1))

    return change


def in_line(number, old, new):
    return lambda text: with_line(text, number, lambda line: line.replace(old, new))


def retract_and_lead_out_left_out(text):
    """The spindle still stops between the passes, but above the next one."""
    text = edited(without(29, 30)(text), "CALL SPINDLE_OFF    ;", "! ;")
    return behind(31, "CALL SPINDLE_OFF")(text)


def sixth_joint_turned(joints):
    return [*joints[:5], joints[5] - (360.0 if joints[5] > 0.0 else -360.0)]


def text(old, new):
    return lambda whole: edited(whole, old, new)


def second(old, new):
    def change(whole):
        first, rest = whole.split(old, 1)
        return first + old + edited(rest, old, new)

    return change


FAULTS = {
    "coupling left out": (GROOVE, coupling_left_out, "path position"),
    "coupling left out in all passes": (ZIGZAG, coupling_left_out, "path position"),
    **{
        f"J{joint} 0.1 deg off": (
            GROOVE,
            lambda whole, joint=joint: with_joints(whole, 20, joint_off(joint, 0.1)),
            "spin range" if joint == 6 else "path position",
        )
        for joint in range(1, 7)
    },
    **{
        f"J{joint} 0.01 deg off": (
            GROOVE,
            lambda whole, joint=joint: with_joints(whole, 20, joint_off(joint, 0.01)),
            "path position",
        )
        for joint in range(1, 6)
    },
    "swapped positions": (GROOVE, swapped(10, 30), "path position"),
    "swapped neighbours": (GROOVE, swapped(10, 11), "path between positions (sampled)"),
    "positions of two passes swapped": (ZIGZAG, swapped(10, 40), "path position"),
    "another tool": (GROOVE, text("UTOOL_NUM=1", "UTOOL_NUM=2"), "frame and tool numbers"),
    "another frame": (GROOVE, text("UFRAME_NUM=1", "UFRAME_NUM=2"), "frame and tool numbers"),
    "the world's frame": (GROOVE, text("UFRAME_NUM=1", "UFRAME_NUM=0"), "frame and tool numbers"),
    "no tool selected": (GROOVE, text("UTOOL_NUM=1", "!no tool"), "frame and tool numbers"),
    "taught in another frame": (
        GROOVE, in_position(20, "UF : 1", "UF : 2"), "frame and tool numbers",
    ),
    "taught with another tool": (
        GROOVE, in_position(20, "UT : 1", "UT : 2"), "frame and tool numbers",
    ),
    "renamed program": (GROOVE, text("/PROG  GROOVE", "/PROG  GROOVY"), "program name"),
    "lead-out left out": (ZIGZAG, without(29), "path at rounded corners (estimated)"),
    "onto the face at full speed": (
        GROOVE, lambda t: with_speed(t, 4, "2000mm/sec", "L"), "lead speed",
    ),
    "a rounded corner above the face": (
        GROOVE, in_line(3, "FINE", "CNT100"), "links at rounded corners (estimated)",
    ),
    "first move at full speed": (GROOVE, lambda t: with_speed(t, 1, "100%"), "link speed"),
    "first move in a millisecond": (GROOVE, lambda t: with_speed(t, 1, "1msec"), "link speed"),
    "first move on a straight line": (
        GROOVE, lambda t: with_speed(t, 1, "2000mm/sec", "L"), "link speed",
    ),
    "link at full speed": (ZIGZAG, lambda t: with_speed(t, 31, "100%"), "link speed"),
    "down to the face at full speed": (
        ZIGZAG, lambda t: with_speed(t, 3, "2000mm/sec", "L"), "link speed",
    ),
    "a corner is rounded where the spindle is called": (
        ZIGZAG, in_line(30, "FINE", "CNT100"), "events",
    ),
    "an output of the robot itself": (GROOVE, behind(20, "RO[1]=ON"), "program flow"),
    "a tracking frame of an application": (
        GROOVE, text("/MN\r\n", "/APPL\r\nLINE_TRACK ;\r\n/MN\r\n"), "program flow",
    ),
    "motions without the arm's group": (
        GROOVE, text("= 1,*,*,*,*;", "= *,*,*,*,*;"), "program flow",
    ),
    "a payload in the middle": (GROOVE, behind(20, "PAYLOAD[2]"), "program flow"),
    "a remark on another frame": (
        GROOVE, text("!UF1 X 900.000", "!UF1 X 950.000"), "stated frames",
    ),
    "less clearance accepted": (
        GROOVE, text("!verify in T1", "!ACCEPTED CLEARANCE 0.001 MM"), "accepted clearance",
    ),
    "percent while grinding": (GROOVE, lambda t: with_speed(t, 20, "1%"), "feed"),
    "20 % too fast": (GROOVE, lambda t: with_speed(t, 20, "513msec"), "feed"),
    "20 % too slow": (GROOVE, lambda t: with_speed(t, 20, "740msec"), "feed"),
    "linear and too fast": (GROOVE, lambda t: with_speed(t, 20, "24mm/sec", "L"), "feed"),
    "a second instead of its share": (GROOVE, lambda t: with_speed(t, 20, "2sec"), "feed"),
    "a joint too fast on the path": (
        GROOVE, lambda t: with_speed(t, 20, "1msec"), "joint speed",
    ),
    "a joint too fast on a link": (ZIGZAG, lambda t: with_speed(t, 31, "20msec"), "joint speed"),
    "a full turn between positions": (
        GROOVE, lambda t: with_joints(t, 25, sixth_joint_turned), "joint speed",
    ),
    "beyond a joint's limit": (
        GROOVE, lambda t: with_joints(t, 25, sixth_joint_turned), "joint limits",
    ),
    "no position between two passes": (ZIGZAG, without(29, 30, 31, 32), "lifts"),
    "through the face between two passes": (ZIGZAG, without(29, 30, 31, 32), "links (sampled)"),
    "retract left out": (ZIGZAG, without(30), "lifts"),
    "retract and approach left out": (ZIGZAG, without(30, 31), "lifts"),
    "retract and lead-out left out": (ZIGZAG, retract_and_lead_out_left_out, "lifts"),
    "begins on the face": (ZIGZAG, without(1, 2, 3), "lifts"),
    "begins at the lead-in": (ZIGZAG, without(1, 2), "lifts"),
    "ends at the lead-out": (ZIGZAG, without(88, 89), "lifts"),
    "spindle not started": (ZIGZAG, text("  CALL SPINDLE_ON ", "  !ALL SPINDLE_ON "), "events"),
    "spindle not started again": (ZIGZAG, second("CALL SPINDLE_ON", "!CALL ON"), "events"),
    "spindle not stopped": (ZIGZAG, text("CALL SPINDLE_OFF", "!CALL OFF"), "events"),
    "spindle stopped while grinding": (ZIGZAG, behind(40, "CALL SPINDLE_OFF"), "events"),
    "another program called": (GROOVE, behind(1, "CALL HOMEPOS"), "events"),
    "an output on the path": (ZIGZAG, behind(10, "DO[1]=ON"), "events"),
    "an output on a link": (ZIGZAG, behind(30, "DO[1]=ON"), "events"),
    "dwell left out": (ZIGZAG, text("  WAIT   1.00(sec)", "  !AIT"), "events"),
    "dwell cut short": (ZIGZAG, text("WAIT   1.00(sec)", "WAIT    .10(sec)"), "events"),
    "a long wait on the face": (GROOVE, behind(20, "WAIT 999.00(sec)"), "events"),
    "position line left out": (GROOVE, lambda t: without_line(t, 20), "position count"),
    "position left out": (GROOVE, without(20), "feed"),
    "position driven to twice": (
        GROOVE, lambda t: with_line(t, 20, lambda line: 2 * line), "feed",
    ),
    "position written twice": (
        GROOVE,
        lambda t: edited(t, position(t, 21), position(t, 20).replace("P[20]", "P[21]")),
        "path position",
    ),
    "a jump": (GROOVE, behind(20, "JMP LBL[1]"), "program flow"),
    "a condition": (GROOVE, behind(20, "IF R[1]=1,JMP LBL[1]"), "program flow"),
    "a skipped end": (GROOVE, behind(20, "END"), "program flow"),
    "a register": (GROOVE, behind(20, "R[1]=5"), "program flow"),
    "a position register": (GROOVE, behind(20, "PR[1]=LPOS"), "program flow"),
    "an override of the speed": (GROOVE, behind(20, "OVERRIDE=100%"), "program flow"),
    "an offset": (GROOVE, in_line(20, "CNT100", "CNT100 Offset,PR[1]"), "program flow"),
    "an increment": (GROOVE, in_line(20, "CNT100", "CNT100 INC"), "program flow"),
    "a target in a register": (GROOVE, in_line(20, "P[20]", "PR[20]"), "program flow"),
    "a corner from a register": (GROOVE, in_line(20, "CNT100", "CNT R[3]"), "program flow"),
    "untaught position": (
        GROOVE, in_position(20, r"J3=.{10}", "J3=  ********"), "program flow",
    ),
    "a second group": (GROOVE, text("1,*,*,*,*", "1,1,*,*,*"), "program flow"),
    "an external axis": (
        GROOVE, text(" deg\r\n};", " deg,\r\n\tE1=   500.000  mm\r\n};"), "program flow",
    ),
    "another payload": (GROOVE, text("  PAYLOAD[1]", "  PAYLOAD[2]"), "payload"),
    "no payload": (GROOVE, text("  PAYLOAD[1]", "  !AYLOAD[1]"), "payload"),
    "two payloads": (GROOVE, behind(20, "PAYLOAD[2]"), "program flow"),
    "clearance overstated": (
        GROOVE, text("MIN CLEARANCE 50.0", "MIN CLEARANCE 50.1"), "stated clearance",
    ),
    "written for another cell": (GROOVE, text("!DIGEST ", "!DIGEST 0"), "cell digest"),
}  # fmt: skip


UNHASHED = {"a second group"}
"""Faults in the header, which the hash leaves out."""


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_caught_under_its_own_name(name):
    cell, change, expected = FAULTS[name]
    changed = change(written(cell))
    assert changed != written(cell)
    names = {one.name for one in checks_of(planned(cell).problem, changed) if not one.passed}
    assert expected in names
    assert "hash" in names or name in UNHASHED


@pytest.mark.parametrize("cell", [GROOVE, ZIGZAG])
def test_what_was_written_passes_every_check(cell):
    assert all(one.passed for one in checks_of(planned(cell).problem, written(cell)))


HASH_ALONE = {
    "J6 0.01 deg off": (GROOVE, lambda t: with_joints(t, 20, joint_off(6, 0.01))),
    "one joint by the last decimal": (GROOVE, lambda t: with_joints(t, 20, joint_off(1, 0.001))),
    "home left out": (ZIGZAG, without(1)),
    "no digest": (GROOVE, text("!DIGEST ", "!DIGES ")),
    "another remark": (GROOVE, text("!verify in T1", "!verified")),
    "another tool left selected": (GROOVE, behind(56, "UTOOL_NUM=5")),
}


@pytest.mark.parametrize("name", HASH_ALONE)
def test_an_edit_that_keeps_the_motion_sound_is_caught_by_the_hash_alone(name):
    cell, change = HASH_ALONE[name]
    checks = checks_of(planned(cell).problem, change(written(cell)))
    assert [one.name for one in checks if not one.passed] == ["hash"]


NO_FAULT = {
    "blanks before the semicolon": lambda t: re.sub(r" +;", ";", t),
    "blanks for tabs": lambda t: t.replace("\t", "  "),
    "other line ends": lambda t: t.replace("\r\n", "\n"),
    "no line numbers": lambda t: re.sub(r"(?m)^ +\d+:", ":", t),
    "more blanks": lambda t: re.sub(r"(?m)^( +\d+:)([JL]) ", r"\1  \2  ", t),
    "blanks behind the numbers": lambda t: re.sub(r"(J\d)= +", r"\1 = ", t),
    "another comment": lambda t: edited(t, '"posopt"', '"night shift"'),
    "written on another day": lambda t: edited(t, "DATE 26-01-01", "DATE 31-12-24"),
}  # fmt: skip


@pytest.mark.parametrize("name", NO_FAULT)
def test_an_edit_that_changes_nothing_is_no_fault(name):
    changed = NO_FAULT[name](written(GROOVE))
    assert changed != written(GROOVE)
    assert all(one.passed for one in checks_of(planned(GROOVE).problem, changed))


def test_a_program_in_a_file_of_another_name_is_noticed():
    checks = checks_of(planned(GROOVE).problem, written(GROOVE), "OTHER.LS")
    assert [one.name for one in checks if not one.passed] == ["program name"]


@pytest.mark.parametrize("kept", [0.1, 0.5, 0.9, 0.999])
def test_a_cut_file_is_refused_by_the_reader(kept):
    whole = written(GROOVE)
    with pytest.raises(InputError, match=r"GROOVE\.LS, line \d+.*missing"):
        read_program(whole[: int(kept * len(whole))], "GROOVE.LS")


def test_a_position_that_is_given_twice_is_refused_by_the_reader():
    entry = position(written(GROOVE), 20)
    with pytest.raises(InputError, match=r"P\[20\] is given twice"):
        read_program(edited(written(GROOVE), entry, entry + entry), "GROOVE.LS")


def test_a_line_to_a_position_that_is_not_there_is_refused_by_the_reader():
    text = written(GROOVE)
    with pytest.raises(InputError, match=r"P\[20\]"):
        read_program(edited(text, position(text, 20), ""), "GROOVE.LS")


def test_any_change_of_a_digit_changes_the_hash():
    """Every position counts, not just those of the pass."""
    text = written(GROOVE)
    stated = stated_hash(read_program(text, "GROOVE.LS"))
    assert content_hash([read_program(text, "GROOVE.LS")]) == stated
    for number in range(1, 57):
        changed = with_joints(text, number, joint_off(1 + number % 6, 0.001))
        assert content_hash([read_program(changed, "GROOVE.LS")]) != stated


@pytest.mark.parametrize("value", ["-100.000", "0.000", "nan", "1e9", ""])
def test_a_senseless_accepted_clearance_in_a_file_is_refused(value):
    changed = edited(written(GROOVE), "!verify in T1", f"!ACCEPTED CLEARANCE {value} MM")
    with pytest.raises(InputError, match="clearance"):
        required_clearance(planned(GROOVE).problem, read_program(changed, "GROOVE.LS"))


def test_the_program_says_where_it_comes_from():
    text = written(ZIGZAG)
    assert "!CELL zigzag_hw250 ;" in text
    assert "!BEAM HW250 ;" in text
    assert "!UF1 X 900.000 Y -200.000 ;" in text
    assert "!UT1 Z 410.000 W 0.000 ;" in text
    assert "!verify in T1 ;" in text
    assert " safe" not in text.lower()
    assert text.startswith("/PROG  ZIGZAG\r\n")


def test_geometry_alone_decides_where_a_program_states_no_hash():
    """A program of another origin has neither hash nor digest, and its faults still have names."""
    plain = re.sub(r"(?m)^ +\d+:  !(HASH|DIGEST) .*\r\n", "", written(GROOVE))
    checks = checks_of(planned(GROOVE).problem, plain)
    assert all(one.passed for one in checks)
    assert not ANY_CHANGE & {one.name for one in checks}
    off = with_joints(plain, 20, joint_off(3, 0.1))
    assert "path position" in failed(planned(GROOVE).problem, off, file_of(GROOVE))
    assert line_to(plain, 20) == line_to(off, 20)
