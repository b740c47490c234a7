"""What instructions and calls of hand-written programs mean."""

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
    text,
    xyzwpr_of,
)

from solver.catalog.robots import load_robot
from solver.errors import InputError
from solver.io import ls_interpreter
from solver.io.ls_findings import TIME_ONLY, FindingKind
from solver.io.ls_interpreter import interpret
from solver.io.ls_program_set import program_set
from solver.io.ls_reader import read_program
from solver.model.toolpath import Event, EventKind


@pytest.fixture(scope="module")
def robot():
    return load_robot("fanuc_m20ia")


def test_events_follow_their_move_and_those_before_the_first_are_kept_apart(robot):
    found = of_lines(
        robot,
        "PAYLOAD[3:tool]\nDO[7]=OFF\nCALL SPINDLE_ON\nWAIT    .50(sec)\nJ P[1] 20% FINE\n"
        "!a remark\nDO[12:air]=ON\nWAIT  12.35(sec)\nJ P[2] 20% FINE\nCALL GLUE(1,R[2])\n"
        "MESSAGE[ done ]\nTIMER[1]=STOP\n//CALL NOTHING\n--eg:note\n\n   ",
    )
    assert not found.findings
    assert found.start_events == (
        Event(EventKind.DIGITAL_OUTPUT, "7", 0.0),
        Event(EventKind.CALL, "SPINDLE_ON"),
        Event(EventKind.DWELL, value=0.5),
    )
    first, second = found.program.moves
    assert first.events == (
        Event(EventKind.DIGITAL_OUTPUT, "12", 1.0),
        Event(EventKind.DWELL, value=12.35),
    )
    assert second.events == (Event(EventKind.CALL, "GLUE(1,R[2])"),)
    assert found.program.payload == 3
    assert found.unresolved == ("SPINDLE_ON", "GLUE")


@pytest.mark.parametrize(
    ("line", "kind"),
    [
        ("JMP LBL[1]", FindingKind.FLOW),
        ("LBL[1:again]", FindingKind.FLOW),
        ("IF R[1]=1,JMP LBL[2]", FindingKind.FLOW),
        ("IF (DI[1]=ON) THEN", FindingKind.FLOW),
        ("ELSE", FindingKind.FLOW),
        ("ENDIF", FindingKind.FLOW),
        ("SELECT R[1]=1,CALL A1", FindingKind.FLOW),
        ("       =2,CALL A2", FindingKind.FLOW),
        ("FOR R[1]=1 TO 3", FindingKind.FLOW),
        ("ENDFOR", FindingKind.FLOW),
        ("SKIP CONDITION DI[1]=ON", FindingKind.FLOW),
        ("END", FindingKind.FLOW),
        ("PAUSE", FindingKind.FLOW),
        ("ABORT", FindingKind.FLOW),
        ("RUN OTHER", FindingKind.FLOW),
        ("UALM[1]", FindingKind.FLOW),
        ("WAIT DI[1]=ON TIMEOUT,LBL[3]", FindingKind.FLOW),
        ("WAIT DI[1]=ON", FindingKind.WAITING),
        ("WAIT R[4]", FindingKind.WAITING),
        ("WAIT (!DI[2])", FindingKind.WAITING),
        ("DO[1]=PULSE,0.5sec", FindingKind.OUTPUT),
        ("DO[R[1]]=ON", FindingKind.OUTPUT),
        ("RO[7]=ON", FindingKind.OUTPUT),
        ("F[30:OFF:Conv]=(OFF)", FindingKind.OUTPUT),
        ("OVERRIDE=30%", FindingKind.SPEED),
        ("LINEAR_MAX_SPEED=100", FindingKind.SPEED),
        ("R[1]=R[1]+1", FindingKind.REGISTER),
        ("PR[1]=LPOS", FindingKind.REGISTER),
        ("PR[GP1:1,7:Trolley]=PR[GP1:1,7:Trolley]-R[15]", FindingKind.REGISTER),
        ("UFRAME[2]=PR[1]", FindingKind.REGISTER),
        ("$MCR.$GENOVERRIDE=50", FindingKind.REGISTER),
        ("OFFSET CONDITION PR[2]", FindingKind.REGISTER),
        ("PAYLOAD[R[1]]", FindingKind.REGISTER),
        ("CALL SR[1]", FindingKind.REGISTER),
        ("Weave Sine[1]", FindingKind.INSTRUCTION),
        ("SOFTFLOAT[1]", FindingKind.INSTRUCTION),
        ("SET PATH(241)", FindingKind.INSTRUCTION),
        ("CALL lower", FindingKind.INSTRUCTION),
        ("AUFRUF MAKRO050", FindingKind.INSTRUCTION),
        ("ENDE", FindingKind.INSTRUCTION),
        ("P_ANYTHING", FindingKind.INSTRUCTION),
        ("@odd", FindingKind.INSTRUCTION),
    ],
)
def test_an_instruction_that_cannot_be_followed_is_a_finding_that_quotes_it(robot, line, kind):
    found = of_lines(robot, f"J P[1] 20% FINE\n{line}\nJ P[2] 20% FINE")
    (finding,) = found.findings
    assert finding.kind is kind
    assert finding.place.line == 10
    assert line.strip() in finding.sentence
    assert len(found.program.moves) == 2


def test_waits_and_signals_are_told_from_what_changes_the_way(robot):
    found = of_lines(robot, "WAIT DI[1]=ON\nRO[7]=ON\nJ P[1] 20% FINE\nEND")
    assert [one.kind in TIME_ONLY for one in found.findings] == [True, True, False]


def test_two_payloads_are_a_finding_and_one_selected_twice_is_not(robot):
    assert not of_lines(robot, "PAYLOAD[1]\nJ P[1] 20% FINE\nPAYLOAD[1]").findings
    found = of_lines(robot, "PAYLOAD[1]\nJ P[1] 20% FINE\nPAYLOAD[2]")
    assert kinds(found) == [FindingKind.PAYLOAD]
    assert "1, 2" in found.findings[0].sentence


def test_a_program_without_moves_is_a_finding(robot):
    assert kinds(of_lines(robot, "CALL ELSEWHERE", "")) == [FindingKind.EMPTY]


def test_the_head_of_the_program_is_that_of_its_main_file(robot):
    program = of_lines(robot, "!one\n!two\nJ P[1] 20% FINE").program
    assert (program.name, program.comment, program.remarks) == ("TEST", "by hand", ("one", "two"))
    assert (program.date, program.time) == ("26-11-21", "10:00:00")
    assert (program.frame.number, program.tool.number) == (0, 1)


def test_date_and_time_are_found_under_a_localised_key(robot):
    source = text(FRAMES + "J P[1] 20% FINE", joint_point(1, HOME))
    localised = source.replace("CREATE", "ERSTELL").replace("DATE ", "TAG ")
    program = meant(robot, localised.replace("TIME ", "ZEIT ")).program
    assert (program.date, program.time) == ("26-11-21", "10:00:00")
    assert meant(robot, source.replace("DATE 26", "DATE x26")).program.date == ""


def files_of(**sources):
    return program_set(
        read_program(text(lines, points, name), f"{name}.LS")
        for name, (lines, points) in sources.items()
    )


def test_calls_are_followed_in_order_with_frames_events_and_sources(robot):
    files = files_of(
        MAIN=(FRAMES + "CALL PART1\nCALL SPINDLE_OFF\nCALL PART2\nCALL PART1", ""),
        PART1=("DO[1]=ON\nJ P[1] 20% FINE\nWAIT   1.00(sec)", joint_point(1, HOME)),
        PART2=("J P[1] 30% FINE", joint_point(1, HOME + 1)),
    )
    found = interpret(robot, numbered(0), numbered(1), files)
    assert not found.findings
    assert found.unresolved == ("SPINDLE_OFF",)
    moves = found.program.moves
    assert [move.source for move in moves] == ["PART1.LS:8", "PART2.LS:7", "PART1.LS:8"]
    assert [move.speed.value for move in moves] == [20, 30, 20]
    assert found.start_events == (Event(EventKind.DIGITAL_OUTPUT, "1", 1.0),)
    assert moves[0].events == (
        Event(EventKind.DWELL, value=1.0),
        Event(EventKind.CALL, "SPINDLE_OFF"),
    )
    assert moves[1].events == (Event(EventKind.DIGITAL_OUTPUT, "1", 1.0),)
    assert [one.file for one in found.position_use] == ["PART1.LS", "PART2.LS"]


def test_a_selection_inside_a_called_program_stays_after_it(robot):
    files = files_of(
        MAIN=(FRAMES + "CALL PART1\nJ P[1] 20% FINE", joint_point(1, HOME)),
        PART1=("UTOOL_NUM=2", ""),
    )
    found = interpret(robot, numbered(0), numbered(1), files)
    assert kinds(found) == [FindingKind.FRAME_SELECTION, FindingKind.FRAME_CONFLICT]
    assert found.findings[0].place.file == "PART1.LS"


@pytest.mark.parametrize(("moves", "lines"), [(500, 10**9), (10**9, 500)])
def test_programs_that_multiply_by_calls_are_refused(robot, monkeypatch, moves, lines):
    monkeypatch.setattr(ls_interpreter, "MOVE_LIMIT", moves)
    monkeypatch.setattr(ls_interpreter, "STEP_LIMIT", lines)
    parts = {"P0": (FRAMES + "CALL P1\n" * 30, "")}
    parts |= {f"P{n}": (f"CALL P{n + 1}\n" * 30, "") for n in range(1, 8)}
    files = files_of(**parts, P8=("J P[1] 20% FINE", joint_point(1, HOME)))
    with pytest.raises(InputError, match=rf"P\d.LS, line \d+, .*{moves} moves or {lines} lines"):
        interpret(robot, numbered(0), numbered(1), files)


RICH = text(
    FRAMES
    + "PAYLOAD[1]\n!remark\nJ P[1] 20% FINE\nL P[2] 50mm/sec CNT50 Offset,PR[4]\nCALL X1(2)\n"
    + "WAIT    .50(sec)\nC P[2]\n    :  P[3] 30cm/min FINE\nDO[3]=ON\nIF R[1]=1,CALL X2",
    joint_point(1, HOME)
    + cartesian_point(2, xyzwpr_of(flange(HOME + 3)), config(HOME + 3))
    + with_group_two(joint_point(3, HOME + 5)),
)


def test_whatever_the_reader_takes_is_interpreted_or_refused_with_a_place(robot):
    generator = np.random.default_rng(3)
    data = RICH.encode()
    interpreted = 0
    for _ in range(400):
        changed = bytearray(data)
        for _ in range(generator.integers(1, 4)):
            changed[generator.integers(len(data))] = generator.integers(32, 127)
        try:
            found, refusal = meant(robot, bytes(changed)), ""
        except InputError as error:
            found, refusal = None, str(error)
        if found is None:
            assert refusal.startswith("folder/TEST.LS, line")
            assert "\n" not in refusal
            continue
        interpreted += 1
        assert np.isfinite(found.program.joints).all()
        assert all(str(one).startswith("folder/TEST.LS") for one in found.findings)
    assert interpreted > 50
