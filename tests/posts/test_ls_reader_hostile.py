"""Whatever arrives, the reader answers with a program or with one sentence."""

import random
import re
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from ls_examples import GOLDEN, POINT, source

from solver.errors import InputError, Place
from solver.io.ls_program import ProgramFile
from solver.io.ls_reader import SIZE_LIMIT, read_program, read_program_file

DATA = GOLDEN.read_bytes()
NOWHERE = Place("")

# No number in it stays the same when it loses a digit.
SHARP_DATA = (
    b"/PROG  SHARP\r\n/ATTR\r\nLINE_COUNT\t= 8;\r\nDEFAULT_GROUP\t= 1,*,*,*,*;\r\n/MN\r\n"
    b"   1:  !a remark ;\r\n"
    b"   2:  UFRAME_NUM=2 ;\r\n"
    b"   3:  UTOOL_NUM=3 ;\r\n"
    b"   4:J P[1] 123msec CNT14    ;\r\n"
    b"   5:  WAIT  12.34(sec) ;\r\n"
    b"   6:  DO[12]=ON ;\r\n"
    b"   7:L P[2] 23mm/sec FINE Offset,PR[45]    ;\r\n"
    b"   8:  CALL PART67    ;\r\n"
    b"/POS\r\n"
    b"P[1]{\r\n   GP1:\r\n\tUF : 2, UT : 3,\t\r\n"
    b"\tJ1=    11.111 deg,\tJ2=   -22.222 deg,\tJ3=    33.333 deg,\r\n"
    b"\tJ4=  -144.444 deg,\tJ5=     5.555 deg,\tJ6=  -266.666 deg\r\n};\r\n"
    b"P[2]{\r\n   GP1:\r\n\tUF : 2, UT : 3,\t\tCONFIG : 'N U T, 1, -1, 2',\r\n"
    b"\tX =   912.345  mm,\tY =     -.456  mm,\tZ =     1.789  mm,\r\n"
    b"\tW =    -1.234 deg,\tP =      .567 deg,\tR =   178.912 deg\r\n};\r\n"
    b"/END\r\n"
)


def outcome(data):
    """The program read, or the refusal; anything else that is raised fails the test."""
    try:
        return read_program(data, "H.LS")
    except InputError as error:
        refusal = error
    assert str(refusal).startswith("H.LS")
    assert "\n" not in str(refusal)
    return refusal


def content(found):
    """Everything that a file says, places aside."""
    instructions = [
        (one.number, one.text, replace(one.motion, place=NOWHERE) if one.motion else None)
        for one in found.instructions
    ]
    positions = [replace(one, place=NOWHERE) for one in found.positions.values()]
    head = (found.name, found.kind, dict(found.attributes), found.uframe, found.utool)
    return head, instructions, positions


def accepted_as_the_same(data, asked=SHARP_DATA):
    found = outcome(data)
    return isinstance(found, ProgramFile) and content(found) == content(read_program(asked, "H.LS"))


def test_a_file_cut_at_any_byte_is_refused_until_its_end_mark_is_whole():
    end = DATA.index(b"/END") + len("/END")
    for length in range(end):
        assert isinstance(outcome(DATA[:length]), InputError), length
    for length in range(end, len(DATA) + 1):
        assert accepted_as_the_same(DATA[:length], DATA)


def test_a_file_whose_middle_is_missing_is_never_taken_for_the_program():
    end = SHARP_DATA.index(b"/END")
    for start in range(SHARP_DATA.index(b"/MN"), end):
        for length in (1, 9):
            if not SHARP_DATA[start : start + length].strip(b" \t\r\n"):
                continue
            cut = SHARP_DATA[:start] + SHARP_DATA[start + length :]
            assert not accepted_as_the_same(cut), (start, length)


def test_no_changed_digit_letter_or_sign_of_the_program_passes_for_the_program():
    assert accepted_as_the_same(SHARP_DATA)
    for offset in range(SHARP_DATA.index(b"/MN"), SHARP_DATA.index(b"/END")):
        old = SHARP_DATA[offset]
        if chr(old).isspace():
            continue
        for new in {old ^ 1, old ^ 4, ord("0"), ord(" "), ord(";"), ord("!")} - {old}:
            changed = SHARP_DATA[:offset] + bytes([new]) + SHARP_DATA[offset + 1 :]
            assert not accepted_as_the_same(changed), (offset, chr(old), chr(new))


def test_random_bytes_in_a_sound_file_never_raise_anything_else():
    rng = random.Random(1)
    for _ in range(800):
        data = bytearray(DATA)
        for _ in range(rng.randint(1, 3)):
            data[rng.randrange(len(data))] = rng.randrange(256)
        outcome(bytes(data))


@pytest.mark.long
def test_every_single_byte_change_is_read_or_refused():
    for offset in range(len(DATA)):
        for new in range(256):
            outcome(DATA[:offset] + bytes([new]) + DATA[offset + 1 :])


@given(st.binary(max_size=300))
def test_arbitrary_bytes_are_refused(data):
    assert isinstance(outcome(data), InputError)


@given(st.text(alphabet='/PROGMNSED \n\t:;=![]{}"0123456789.,JLC%*AT', max_size=120))
def test_texts_of_the_formats_own_characters_are_read_or_refused(text):
    outcome(text)
    outcome(source(text))
    outcome(source(positions=text))


@pytest.mark.parametrize(
    "value",
    [
        *("nan", "NaN", "inf", "-Infinity", "1_000", "1e3", "１２", "0x10", "", "-", ".", "1,5"),
        *("--1", "9" * 10, "9" * 3000, "1.2.3", "٣", "1 000", "1\u00a0"),
    ],
)
def test_what_is_no_plain_number_is_refused_with_line_and_column(value):
    text = source(positions=POINT.replace("-30.000", value))
    with pytest.raises(InputError) as caught:
        read_program(text, "H.LS")
    assert caught.value.place.line == 10
    assert caught.value.place.column > 20


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("J3=", "J2=", "in this order"),
        (",\tJ3=    30.000 deg", "", "in this order"),
        ("J3=    30.000 deg,", "J3=    30.000 deg", "expected"),
        ("-30.000 deg", "-30.000 rad", "number with its unit"),
        ("UT : 1,", "UT : 1000,", "UT :"),
        ("UF : 0, ", "", "UF :"),
        ("GP1", "GP9", "motion group"),
        ("   GP1:\n", "", "motion group"),
        ("P[1]{", "P[0]{", "1 to 32767"),
        ("P[1]{", "P[99999]{", "1 to 32767"),
        ("P[1]{", "P[1{", "']{'"),
        ("UT : 1,\t", "UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',", "no CONFIG"),
        ("J6=     0.000 deg", "J6=     0.000 deg,\tE2=  0.000 deg", "E1, E2"),
    ],
)
def test_a_malformed_position_is_refused(old, new, says):
    assert old in POINT
    with pytest.raises(InputError, match=re.escape(says)):
        read_program(source(positions=POINT.replace(old, new, 1)), "H.LS")


def test_a_cartesian_position_without_configuration_is_refused():
    point = (
        "P[1]{\n GP1:\n UF : 0, UT : 1,\n X = 0 mm, Y = 0 mm, Z = 0 mm, "
        "W = 0 deg, P = 0 deg, R = 0 deg\n};\n"
    )
    with pytest.raises(InputError, match=r"line 10, column 2: .*arm configuration is unknown"):
        read_program(source(positions=point), "H.LS")


def test_a_position_given_twice_is_refused_and_both_lines_are_named():
    with pytest.raises(InputError, match=r"line 13, .*P\[1\] is given twice, first in line 7"):
        read_program(source(positions=POINT + POINT), "H.LS")


def test_groups_out_of_order_or_repeated_are_refused():
    body = POINT.split("{\n")[1].split("};")[0]
    with pytest.raises(InputError, match="GP1 is out of order"):
        read_program(source(positions="P[1]{\n" + body + body + "};\n"), "H.LS")


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("   1:J P[2] 20% FINE    ;", r"P\[2\], which /POS lacks"),
        ("   1:J P[1] 20% FINE", "does not end with ';'"),
        ("   1:J P[1] 20% FINE\n   2:J P[1] 20% FINE    ;", "line 5, .*does not end with ';'"),
        ("    :J P[1] 20% FINE\n    :J P[1] 20% FINE    ;", "second motion"),
        ("   1:J P[1] 20% FINE    ; ;", "ASBN-031"),
        ("   1:J P[1] 20% FINE ; J P[1] 20% FINE ;", "inside an instruction"),
        ("   1:  !two; remarks ;", "inside an instruction"),
        ("   1:  !two\n    :  lines ;", "goes on in the next line"),
        ("   1:J P[1] 20% FINE CNT5 J P[1] ;", "second motion"),
        ("   1:J P[1] 0% FINE    ;", "out of range"),
        ("   1:J P[1] 101% FINE    ;", "out of range"),
        ("   1:J P[1] 1_0% FINE    ;", "expected a speed"),
        ("   1:J P[1] ２０% FINE    ;", "expected a speed"),
        ("   1:J P[1] nan% FINE    ;", "expected a speed"),
        ("   1:J P[1] 20mm/sec FINE    ;", "a J move takes no speed in mm/sec"),
        ("   1:L P[1] 20% FINE    ;", "a L move takes no speed in %"),
        ("   1:J P[1] 20% CNT101    ;", "CNT is 0 to 100"),
        ("   1:J P[1] 20%    ;", "FINE or CNT0"),
        ("   1:J P[1] FINE    ;", "expected a speed"),
        ("   1:J P[1 20% FINE    ;", "expected a position"),
        ("   1:J P[x] 20% FINE    ;", "expected a position"),
        ("   1:JP[1] 20% FINE    ;", "motion letter"),
        ("   1:K P[1] 20% FINE    ;", "motion letter"),
        ("   1:C P[1] 20mm/sec FINE    ;", "expected a position"),
        ("   1:J P[1] 20% FINE [    ;", "motion option"),
        ("   1:12 J P[1] 20% FINE    ;", "expected an instruction"),
        ("   1 J P[1] 20% FINE    ;", "expected an instruction"),
    ],
)
def test_a_malformed_program_line_is_refused(line, says):
    with pytest.raises(InputError, match=says) as caught:
        read_program(source(line + "\n"), "H.LS")
    assert caught.value.place.line is not None
    assert caught.value.place.line >= 5


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("/PROG  SMALL\n", "", "line 1"),
        ("/PROG  SMALL", "/PROG", "name after /PROG"),
        ("SMALL\n", "SMALL\nstray\n", "line 2"),
        ("/MN\n", "", "unknown|missing|'='"),
        ("/POS\n", "", "instruction|/POS is missing"),
        ("/END\n", "", "/END is missing"),
        ("/END\n", "/END\nmore\n", "text after /END"),
        ("/END\n", "/END x\n", "text after /END"),
        ("/END\n", "/END\n/END\n", "out of order or repeated"),
        ("/MN\n", "/MN\n/MN\n", "out of order or repeated"),
        ("/POS\n", "/POSITIONS\n", "unknown section"),
        ("/MN\n", "/mn\n", "unknown section"),
        ("1,*,*,*,*;", "1,*,*,*,*", "ends with ';'"),
        ("= 1,*", " 1,*", "without '='"),
        ("*;\n", '*;\nCOMMENT = "open;\n', "ends with ';'"),
        ("*;\n", "*;\nDEFAULT_GROUP = 1;\n", "given twice"),
        ("*;\n", "*;\nTCD: A = 1, B;\n", "KEY = value"),
        ("*;\n", "*;\n\0", "control character"),
        ("\n", "\r", "control character"),
    ],
)
def test_a_malformed_frame_of_a_file_is_refused(old, new, says):
    assert old in source()
    with pytest.raises(InputError, match=says):
        read_program(source().replace(old, new), "H.LS")


@pytest.mark.parametrize(
    "data",
    [
        b"\0" * (SIZE_LIMIT + 1),
        b"\n" * SIZE_LIMIT,
        b" " * SIZE_LIMIT,
        b"/PROG  A\n/ATTR\n" + b'="' * 2000,
        b"/PROG " + b" " * 4000 + b"\n/MN\n/POS\n/END",
        source("UTOOL_NUM" + " " * 4000 + "x ;\n").encode()[:-5],
        source("J " + " " * 4000 + "P[ ;\n").encode(),
        source("J P[1] 1% FINE " + "a[" * 2000 + " ;\n").encode(),
        source("A" + "\n:" * 100_000).encode(),
        source(positions="P[1:" + '"' * 4000).encode(),
        source(positions="P[1]{\n" + " \n\t" * 100_000).encode(),
        source(positions="P[1]{" * 700).encode(),
    ],
    ids=range(12),
)
def test_files_of_absurd_size_or_depth_are_refused(data):
    assert isinstance(outcome(data), InputError)


def test_a_missing_file_a_folder_and_a_strange_name_are_refused(tmp_path):
    for path in (tmp_path / "NONE.LS", tmp_path, tmp_path / "a\0b"):
        with pytest.raises(InputError):
            read_program_file(path)


def test_the_source_of_a_refusal_is_short_even_when_the_file_is_not():
    assert len(str(outcome(source("   1:J " + "P[" * 1500 + " ;\n")))) < 200
