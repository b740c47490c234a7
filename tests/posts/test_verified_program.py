from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ls_examples import GOLDEN, golden_program, move, program
from program_examples import m20ia

from solver.errors import InputError, RefusedError
from solver.io import verified_program
from solver.io.ls_reader import read_program
from solver.io.posts import POSTS, PostOptions
from solver.model.toolpath import Event, EventKind

EVENTS = st.one_of(
    st.builds(Event, st.just(EventKind.DWELL), value=st.floats(1e-6, 327.6)),
    st.builds(
        Event,
        st.just(EventKind.DIGITAL_OUTPUT),
        st.integers(1, 9999).map(str),
        st.sampled_from([0.0, 1.0]),
    ),
    st.builds(
        Event, st.just(EventKind.CALL), st.from_regex(r"[A-Z][A-Z0-9_]{0,6}9", fullmatch=True)
    ),
    st.sampled_from([Event(EventKind.SPINDLE_ON), Event(EventKind.SPINDLE_OFF)]),
)
MOVES = st.builds(
    lambda row, speed, cnt, events: move(row, cnt=cnt, events=tuple(events), **speed),
    st.lists(st.floats(-400, 400), min_size=6, max_size=6),
    st.fixed_dictionaries({"percent": st.integers(1, 100)})
    | st.fixed_dictionaries({"linear": st.floats(0.001, 2.0)})
    | st.fixed_dictionaries({"duration": st.floats(1e-6, 32.0)}),
    st.none() | st.integers(0, 100),
    st.lists(EVENTS, max_size=2),
)


def names(folder):
    return [one.name for one in folder.iterdir()]


def accept(_found):
    """A recheck that finds nothing wrong."""


JOINT = POSTS["fanuc-joint"]


def write_verified(asked, path, verify, post=JOINT):
    return verified_program.write_verified(asked, path, verify, PostOptions(), post, m20ia())


def rendered(asked):
    (file,) = JOINT.render(asked, PostOptions(), m20ia())
    return file


def differences(asked, text):
    found = (read_program(text, f"{asked.name}.LS"),)
    return list(verified_program.differences(asked, found, PostOptions(), m20ia()))


def post_that_writes(change):
    """A post that goes wrong: `change` is applied to the text of the sound one."""

    def render(asked, options, robot):
        (file,) = JOINT.render(asked, options, robot)
        return (file._replace(text=change(file.text)),)

    return replace(JOINT, render=render)


def post_that_renders(change):
    """A post that goes wrong: `change` is applied to the program before it is rendered."""
    return replace(
        JOINT, render=lambda asked, options, robot: JOINT.render(change(asked), options, robot)
    )


@given(moves=st.lists(MOVES, min_size=1, max_size=4), uframe=st.integers(0, 9))
def test_what_the_post_writes_never_differs_from_the_program(moves, uframe):
    asked = program(*moves, uframe=uframe, remarks=(" a remark",))
    assert differences(asked, rendered(asked).text) == []


def test_the_file_is_written_and_what_was_read_back_is_what_was_rechecked(tmp_path):
    seen = []
    path = tmp_path / "GROOVE_3.LS"
    written = write_verified(golden_program(), path, seen.append)
    assert path.read_bytes() == GOLDEN.read_bytes()
    assert written.paths == (path,)
    assert written.stale == ()
    assert seen == [written.found]
    (found,) = written.found
    assert np.array_equal(found.path_joints(), golden_program().joints)
    assert names(tmp_path) == ["GROOVE_3.LS"]


def test_the_final_name_does_not_exist_while_the_recheck_runs(tmp_path):
    path = tmp_path / "PROGRAM.LS"
    seen = []
    write_verified(program(), path, lambda _found: seen.append(path.exists()))
    assert seen == [False]


@pytest.mark.parametrize("failure", [RefusedError("too close"), ValueError(), KeyboardInterrupt()])
@pytest.mark.parametrize("old", [None, b"old program"])
def test_a_failed_recheck_leaves_nothing_but_an_older_file(tmp_path, failure, old):
    path = tmp_path / "PROGRAM.LS"
    if old is not None:
        path.write_bytes(old)

    def recheck(_found):
        raise failure

    with pytest.raises(type(failure)):
        write_verified(program(), path, recheck)
    assert names(tmp_path) == ([] if old is None else ["PROGRAM.LS"])
    assert old is None or path.read_bytes() == old


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("/PROG  GROOVE_3", "/PROG  GROOVE_4", "its name reads 'GROOVE_4' instead of 'GROOVE_3'"),
        ("/PROG  GROOVE_3", "/PROG  GROOVE_3  Macro", "its kind"),
        ("three moves", "free moves", "its comment"),
        ("!CELL groove_hw300", "!cell groove_hw200", "its remarks"),
        ("LINE_COUNT\t= 16", "LINE_COUNT\t= 15", "LINE_COUNT reads '15' instead of '16'"),
        ("CREATE\t\t= DATE 26", "CREATE\t\t= DATE 27", "its creation"),
        ("1,*,*,*,*", "*,1,*,*,*", "its motion group"),
        ("UFRAME_NUM=0", "UFRAME_NUM=1", "UFRAME_NUM reads 1 instead of 0"),
        ("UTOOL_NUM=1", "UTOOL_NUM=2", "UTOOL_NUM reads 2 instead of 1"),
        ("   5:J", "   6:J", "line 26 has number 6 instead of 5"),
        ("J P[1] 10%", "J P[1] 11%", "line 26 has the speed 11% instead of 10 %"),
        ("250msec", "249msec", "line 29 has the speed 249msec instead of 0.25 s"),
        ("250msec", "251msec", "251msec instead of 0.25 s"),
        ("250msec", "250sec", "250sec instead of 0.25 s"),
        ("1235msec", "50%", "50% instead of 1.2341 s"),
        ("CNT100", "CNT99", "rounds with CNT 99 instead of 100"),
        ("10% FINE", "10% CNT0", "ends with 'CNT' instead of 'FINE'"),
        ("10% FINE", "10% FINE Offset,PR[1]", "has the options"),
        ("J P[2] 250msec", "L P[2] 250msec", "moves with 'L' instead of 'J'"),
        ("J P[2] 250msec", "J PR[2] 250msec", "moves to"),
        ("J P[2] 250msec", "J P[3] 250msec", r"moves to \(3,\) instead of \(2,\)"),
        ("WAIT    .50", "WAIT    .51", r"line 28 reads 'WAIT    .51\(sec\)' instead of wait"),
        ("WAIT    .50", "WAIT    .49", "line 28 reads"),
        ("DO[3]=ON", "DO[4]=ON", r"'DO\[4\]=ON' instead of output 3 True"),
        ("DO[3]=ON", "DO[3]=OFF", "instead of output 3 True"),
        ("CALL PART2", "CALL PART3", "instead of call PART2"),
        ("  CALL SPINDLE_ON", "  LBL[1]", r"line 27 reads 'LBL\[1\]' instead of call SPINDLE_ON"),
        ("J2=   -30.000", "J2=   -30.001", r"P\[1\] has J2 = -30.001000 deg instead of -30.000000"),
        ("J2=   -30.000", "J2=   -30.0001", r"P\[1\] has J2 = -30.0001"),
        ("J2=   -30.000", "J2=  ********", r"P\[1\] has no joints .*never taught"),
        ("UF : 0, UT : 1", "UF : 0, UT : 2", r"P\[1\] has the tool 2 instead of 1"),
        ("UF : 0, UT : 1", "UF : 1, UT : 1", r"P\[1\] has the user frame 1 instead of 0"),
        ("P[4]{", 'P[4:"name"]{', r"P\[4\] has the name"),
        ("   12.345 deg", "   12.345 deg,\tE1= 0 mm", r"P\[4\] has external axes"),
        ("/END", "", "/END is missing"),
        ("/POS\r\n", "/POS\r\nP[5]{\r\n GP1:\r\n UF : 0, UT : 1,\r\n J1= 0 deg };\r\n", "numbered"),
        ("J P[4] 100% FINE", "  LBL[1]", r"line 35 reads 'LBL\[1\]' instead of move"),
    ],
)
def test_a_post_that_writes_something_else_is_found_out_and_nothing_is_left(
    tmp_path, old, new, says
):
    def change(text):
        assert old in text
        return text.replace(old, new, 1)

    with pytest.raises(RefusedError, match=says) as caught:
        write_verified(
            golden_program(), tmp_path / "GROOVE_3.LS", accept, post=post_that_writes(change)
        )
    assert str(caught.value).startswith("GROOVE_3.LS was not written: read back, ")
    assert names(tmp_path) == []


def test_a_move_that_was_dropped_is_found_out(tmp_path):
    short = post_that_renders(lambda asked: replace(asked, moves=asked.moves[:-1]))
    asked = program(move([1] * 6), move([2] * 6))
    with pytest.raises(RefusedError, match="instructions instead of"):
        write_verified(asked, tmp_path / "PROGRAM.LS", accept, post=short)
    assert names(tmp_path) == []


def test_moves_in_another_order_are_found_out(tmp_path):
    turned = post_that_renders(lambda asked: replace(asked, moves=asked.moves[::-1]))
    asked = program(move([1] * 6), move([2] * 6))
    with pytest.raises(RefusedError, match=r"P\[1\] has J1 = 2.000000 deg instead of 1.000000"):
        write_verified(asked, tmp_path / "PROGRAM.LS", accept, post=turned)


@pytest.mark.parametrize("on_disk", [b"", GOLDEN.read_bytes()[:-40], b"\0" * 2000])
def test_a_disk_that_lost_what_was_sent_is_found_out(tmp_path, monkeypatch, on_disk):
    monkeypatch.setattr(Path, "read_bytes", lambda _path: on_disk)
    with pytest.raises(RefusedError, match=r"GROOVE_3\.LS was not written"):
        write_verified(golden_program(), tmp_path / "GROOVE_3.LS", accept)
    assert names(tmp_path) == []


def test_a_disk_that_changed_a_byte_without_meaning_is_found_out(tmp_path, monkeypatch):
    changed = GOLDEN.read_bytes().replace(b"OWNER\t\t", b"OWNER\t ")
    monkeypatch.setattr(Path, "read_bytes", lambda _path: changed)
    with pytest.raises(RefusedError, match=r"bytes of GROOVE_3\.LS differ"):
        write_verified(golden_program(), tmp_path / "GROOVE_3.LS", accept)


@pytest.mark.parametrize("name", ["OTHER.LS", "PROGRAM.TXT", "PROGRAM", "PROGRAM.LS.LS"])
def test_a_file_that_is_not_named_as_its_program_is_refused(tmp_path, name):
    with pytest.raises(InputError, match=r"into a file of its name, PROGRAM\.LS"):
        write_verified(program(), tmp_path / name, accept)
    assert names(tmp_path) == []


def test_the_case_of_the_file_name_does_not_matter(tmp_path):
    write_verified(program(), tmp_path / "program.ls", accept)
    assert names(tmp_path) == ["program.ls"]


def test_a_name_that_no_controller_takes_leaves_nothing(tmp_path):
    with pytest.raises(InputError, match="program name"):
        write_verified(program(name="A B"), tmp_path / "A B.LS", accept)
    assert names(tmp_path) == []


@settings(max_examples=25)
@given(
    row=st.lists(st.integers(-360_000, 360_000), min_size=6, max_size=6),
    joint=st.integers(0, 5),
    step=st.sampled_from([-1, 1]),
)
def test_a_thousandth_of_a_degree_in_any_joint_is_a_difference(row, joint, step):
    other = list(row)
    other[joint] += step
    text = rendered(program(move([value / 1000 for value in other]))).text
    asked = program(move([value / 1000 for value in row]))
    (difference,) = differences(asked, text)
    assert f"J{joint + 1} = " in difference
