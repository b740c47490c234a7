"""Malformed tables end with one sentence that names file, line and column."""

from __future__ import annotations

import codecs
from dataclasses import replace

import numpy as np
import pytest
from path_examples import FLOOR, HEADER, ROWS, changed, loaded, refused, table

from solver.errors import InputError
from solver.io.importers import ImportOptions
from solver.model.toolpath import Frame

NOT_NUMBERS = (
    "", "abc", "zero", "1_000", "１２", "nan", "NaN", "inf", "-inf", "+Infinity", "1e999", "-1e400",
    "0x10", "0b1", "1.2.3", "--1", "+-1", "1e", "e5", ".", "+", "-", "1 2", "1 000", "1'000", "1f",
    "True", "None", "1j", "1e5e5", "\u22125", "\u0663", "\u00b2", "\u00bd", "5\u00a0", "\u30005",
    "9" * 65, "1/2", "1%", "=1+1", "NULL", "#REF!", "1.5mm", "12°", "(1)", "1e+", "1e1.5",
)  # fmt: skip


@pytest.mark.parametrize("text", NOT_NUMBERS)
@pytest.mark.parametrize(
    ("field", "line"), [("x", 2), ("y", 3), ("nz", 4), ("tx", 5), ("feed", 2), ("lead", 4)]
)
def test_what_is_no_plain_number_is_refused_at_its_cell(text: str, field: str, line: int) -> None:
    error = refused(changed(line, field, text))
    assert error.place is not None
    assert (error.place.line, error.place.column) == (line, HEADER.index(field) + 1)
    assert error.message.startswith(f"{field} is ")


@pytest.mark.parametrize(
    ("line", "field", "text", "says"),
    [
        (2, "x", "100000.1", "100 m"),
        (3, "x", "-1e300", "100 m"),
        (4, "tx", "0", "travel direction is zero"),
        (4, "tx", "1e-12", "travel direction is zero"),
        (3, "x", "0", "repeats"),
        (3, "x", "0.0005", "repeats"),
        (5, "x", "20", "repeats"),
        (5, "pass", "a", "appears again"),
        (4, "pass", "", "empty"),
        (4, "pass", "p" * 65, "64"),
        (4, "pass", "bell\u0007", "printable"),
        (2, "feed", "0", "0 mm/s"),
        (2, "feed", "-5", "-5 mm/s"),
        (2, "feed", "1e6", "mm/s"),
        (3, "feed", "51", "inside pass 'a'"),
        (3, "touches", "flange_top", "inside pass 'a'"),
        (3, "lean", "1", "inside pass 'a'"),
        (5, "lead", "1", "inside pass 'b'"),
        (2, "lean", "90.5", "90"),
        (2, "lead", "-91", "-91"),
        (2, "role", "grinding", "lead-in"),
        (2, "role", "1", "lead-in"),
        (3, "events", "spindle", "spindle-on"),
        (3, "events", "spindle-on:1", "spindle-on"),
        (3, "events", "dwell", "dwell"),
        (3, "events", "dwell:", "empty"),
        (3, "events", "dwell:nan", "finite"),
        (3, "events", "dwell:-1", "-1"),
        (3, "events", "dwell:0", "0"),
        (3, "events", "dwell:3601", "3600"),
        (3, "events", "dwell:1_0", "1_0"),
        (3, "events", "do:3", "do:"),
        (3, "events", "do:3=2", "do:"),
        (3, "events", "do:0=1", "do:"),
        (3, "events", "do:a=1", "do:"),
        (3, "events", "do:３=1", "do:"),
        (3, "events", "call:", "call:"),
        (3, "events", "call:1A", "call:"),
        (3, "events", "call:A B", "call:"),
        (3, "events", f"call:{'A' * 37}", "call:"),
        (3, "events", "call:ſ", "call:"),
        (3, "events", "spindle-on|", "spindle-on"),
        (3, "events", "|", "spindle-on"),
    ],
)
def test_a_value_out_of_its_range_is_refused_at_its_cell(
    line: int, field: str, text: str, says: str
) -> None:
    error = refused(changed(line, field, text))
    assert error.place is not None
    assert (error.place.line, error.place.column) == (line, HEADER.index(field) + 1)
    assert says in error.message


@pytest.mark.parametrize(
    ("text", "says"), [("0", "zero"), ("1.01", "1.01"), ("-0.5", "0.5"), ("0.998", "0.998")]
)
def test_a_normal_that_is_not_of_length_one_is_refused_at_its_x(text: str, says: str) -> None:
    error = refused(changed(3, "nz", text))
    assert error.place is not None
    assert (error.place.line, error.place.column) == (3, HEADER.index("nx") + 1)
    assert says in error.message


def test_a_normal_within_the_tolerance_is_normalised() -> None:
    rotation = loaded(changed(3, "nz", "1.0009")).poses[1, :3, :3]
    np.testing.assert_allclose(rotation.T @ rotation, np.eye(3), atol=1e-15)


def test_a_normal_parallel_to_the_travel_is_refused_at_the_travel() -> None:
    for travel in ("0,0,1", "0,0,-3", "0.0009,0,1"):
        rows = "".join(f"{x},0,0,0,0,1,{travel}\n" for x in range(2))
        error = refused(f"x,y,z,nx,ny,nz,tx,ty,tz\n{rows}".encode())
        assert error.place is not None
        assert (error.place.line, error.place.column) == (2, 7)
        assert "parallel" in error.message


def test_a_travel_from_neighbours_that_is_parallel_to_the_normal_says_where_it_came_from() -> None:
    error = refused(b"x,y,z,nx,ny,nz\n0,0,0,0,0,1\n0,0,5,0,0,1\n0,0,9,0,0,1\n")
    assert error.place is not None
    assert error.place.line == 2
    assert "neighbouring" in error.message


def test_a_pass_of_one_point_with_a_normal_alone_is_refused() -> None:
    data = b"x,y,z,nx,ny,nz,pass\n0,0,0,0,0,1,a\n1,0,0,0,0,1,a\n2,0,0,0,0,1,b\n"
    error = refused(data)
    assert error.place is not None
    assert error.place.line == 4


@pytest.mark.parametrize("quaternion", ["0,0,0,0", "1,1,0,0", "0.99,0,0,0", "1.002,0,0,0"])
def test_a_quaternion_that_is_not_of_length_one_is_refused(quaternion: str) -> None:
    error = refused(f"x,y,z,qw,qx,qy,qz\n0,0,0,1,0,0,0\n1,0,0,{quaternion}\n".encode())
    assert error.place is not None
    assert (error.place.line, error.place.column) == (3, 4)


HEADERS = (
    ("x,y", 1, None, "z"),
    ("y,z", 1, None, "x"),
    ("x,y,z,qw,qx,qy", 1, None, "qz"),
    ("x,y,z,w,p", 1, None, "r"),
    ("x,y,z,nx,ny", 1, None, "nz"),
    ("x,y,z,nx,ny,nz,tx", 1, None, "ty and tz"),
    ("x,y,z,tx,ty,tz", 1, 4, "normal"),
    ("x,y,z,x", 1, 4, "again"),
    ("x,y,z,X (mm)", 1, 4, "again"),
    ("x,y,z,pass,工序", 1, 5, "again"),
    ("x,y,z,fead", 1, 4, "feed"),
    ("x,y,z,", 1, 4, "no title"),
    ("x,y,z,q1", 1, 4, "q1"),
    ("x_mm,y_m,z_mm", 1, 2, "unit"),
    ("x [mm],y [mm],z", 1, 3, "unit"),
    ("x,y,z[m]", 1, 3, "unit"),
    ("x[in],y[in],z[in]", 1, 1, "mm or m"),
    ("x[],y[],z[]", 1, 1, "mm or m"),
    ("x[deg],y[deg],z[deg]", 1, 1, "mm or m"),
    ("x,y,z,w[rad],p,r", 1, 4, "deg"),
    ("x,y,z,feed[m]", 1, 4, "mm/s"),
    ("x,y,z,feed[rpm]", 1, 4, "mm/s"),
    ("x,y,z,pass[mm]", 1, 4, "none"),
    ("x,y,z,qw_mm,qx,qy,qz", 1, 4, "none"),
    ("x,y,z,qw,qx,qy,qz,w,p,r", 1, 8, "twice"),
    ("x,y,z,w,p,r,nx,ny,nz", 1, 7, "twice"),
    ("x y z", 1, None, "comma"),
    ("x", 1, None, "comma"),
    ("1,2,3", 1, 1, "'1'"),
    ('"x,y,z', 1, 1, "quote"),
    ('"x"y,y,z', 1, 1, "quote"),
    ('x,y,"z', 1, 3, "quote"),
    ("\n\nx,y", 3, None, "z"),
    ("# x\nx,y,z,fead", 2, 4, "feed"),
    ("# frame: moon\nx,y,z", 1, None, "beam"),
    ("# frame: beam\nx,y,z", 1, None, "floor"),
    ("# unit: ft\nx,y,z", 1, None, "mm"),
    ("# unit: m\nx_mm,y_mm,z_mm", 2, 1, "unit"),
    ("# frame: floor\n# frame: beam\nx,y,z", 2, None, "again"),
    ("x,y,z\n# frame: floor", 2, None, "above"),
)


@pytest.mark.parametrize(("header", "line", "column", "says"), HEADERS)
def test_a_header_that_does_not_fit_is_refused(
    header: str, line: int, column: int | None, says: str
) -> None:
    error = refused(f"{header}\n1,2,3\n4,5,6\n".encode())
    assert error.place is not None
    assert (error.place.line, error.place.column) == (line, column)
    assert says in error.message


@pytest.mark.parametrize(
    ("body", "line", "column"),
    [
        ("1,2\n4,5,6", 3, 3),
        ("1,2,3\n4", 4, 2),
        ("1,2,3\n4,5", 4, 3),
        ("1,2,3,4\n4,5,6", 3, 4),
        ("1,2,3,\n4,5,6", 3, 4),
        ("1;2;3\n4;5;6", 3, 2),
        ("1,2,3\n4,5,\n", 4, 3),
        ("1,2,3\n,,", 4, 1),
        ('1,2,"3\n4,5,6', 3, 3),
        ('1,"2"2,3\n4,5,6', 3, 2),
        ("1,2,3", 3, None),
        ("", None, None),
        ("# nothing\n\n", None, None),
    ],
)
def test_rows_that_do_not_match_the_header_are_refused(
    body: str, line: int | None, column: int | None
) -> None:
    error = refused(f"# a comment\nx,y,z\n{body}".encode())
    assert error.place is not None
    assert (error.place.line, error.place.column) == (line, column)


@pytest.mark.parametrize("delimiter", [";", "\t"])
def test_a_decimal_comma_is_refused_with_a_hint(delimiter: str) -> None:
    rows = [("1,5", "2", "3"), ("4", "5", "6")]
    error = refused(table(rows, ("x", "y", "z"), delimiter))
    assert error.place is not None
    assert (error.place.line, error.place.column) == (2, 1)
    assert "decimal comma" in error.message


def test_a_row_that_begins_with_the_delimiter_semicolon_is_no_comment() -> None:
    error = refused(b"x;y;z\n1;2;3\n;5;6\n")
    assert error.place is not None
    assert (error.place.line, error.place.column) == (3, 1)


@pytest.mark.parametrize(
    ("data", "line", "column", "says"),
    [
        (b"", None, None, "no rows"),
        (b"\n\n", None, None, "no rows"),
        (b"# only\n", None, None, "no rows"),
        (codecs.BOM_UTF8, None, None, "no rows"),
        (b"\0", 1, 1, "NUL"),
        (b"x,y,z\n1,2,3\n4,\x005,6\n", 3, 3, "NUL"),
        (b"\x7fELF\x02\x01\x01\0", 1, 8, "NUL"),
        (b"PK\x03\x04\x14\x00\x06", 1, 6, "NUL"),
        ("x,y,z\n".encode("utf-16"), 1, 1, "UTF-16"),
        (codecs.BOM_UTF16_BE + b"\0x", 1, 1, "UTF-16"),
        (b"x,y,z\n1,2,3\n4,\xff,6\n", 3, 3, "0xFF"),
        (b"x,y,z,pass\n1,2,3,caf\xe9\n", 2, 10, "0xE9"),
        (codecs.BOM_UTF8 + "x,y,z,工序\n".encode("gbk"), 1, 10, "UTF-8"),
        (b"x,y,z\r\n1,2,3\r\n4,\x80\xff,6\r\n", 3, 3, "0x80"),
    ],
)
def test_what_is_no_text_is_refused_at_its_first_byte(
    data: bytes, line: int | None, column: int | None, says: str
) -> None:
    error = refused(data)
    assert error.place is not None
    assert (error.place.line, error.place.column) == (line, column)
    assert says in error.message


@pytest.mark.parametrize("encoding", ["utf-8", "ascii"])
def test_bytes_outside_the_stated_encoding_are_refused(encoding: str) -> None:
    data = "x,y,z,pass\n1,2,3,粗磨\n".encode("gbk")
    error = refused(data, options=replace(FLOOR, encoding=encoding))
    assert error.place is not None
    assert (error.place.line, error.place.column) == (2, 7)


def test_more_rows_than_the_limit_are_refused_at_the_first_one_too_many() -> None:
    error = refused(table(), options=replace(FLOOR, row_limit=3))
    assert error.place is not None
    assert error.place.line == 5
    assert "3" in error.message


def test_the_row_limit_itself_is_accepted_and_one_more_is_not() -> None:
    rows = "".join(f"{index},0,0\n" for index in range(2000))
    header = "x,y,z\n"
    error = refused(f"{header}{rows}".encode(), options=replace(FLOOR, row_limit=1999))
    assert error.place is not None
    assert error.place.line == 2001


def test_a_file_without_a_frame_is_refused_when_the_import_states_none() -> None:
    error = refused(table(), options=ImportOptions())
    assert "beam, floor or fanuc_world" in error.message


def test_points_without_orientation_are_refused_when_the_import_states_none() -> None:
    error = refused(b"x,y,z\n1,2,3\n4,5,6\n", options=ImportOptions(frame=Frame.BEAM))
    assert error.place is not None
    assert error.place.line == 2


@pytest.mark.parametrize(
    ("columns", "says"),
    [
        ({"x": "a", "y": "b"}, "z"),
        ({"x": "a", "y": "b", "z": "d"}, "'d'"),
        ({"x": "a", "y": "b", "z": "c", "speed": "a"}, "speed"),
        ({"x": 1, "y": 2, "z": 9}, "9"),
        ({"x": 1, "y": 2, "z": 0}, "0"),
        ({"x": 1, "y": "b", "z": 3}, "mixes"),
        ({}, "x"),
    ],
)
def test_a_mapping_that_does_not_fit_is_refused(columns: dict[str, str | int], says: str) -> None:
    error = refused(b"a,b,c\n1,2,3\n4,5,6\n", options=replace(FLOOR, columns=columns))
    assert says in error.message


@pytest.mark.parametrize(
    "wrong",
    [
        {"unit": "inch"},
        {"convention": "other"},
        {"encoding": "utf-7"},
        {"feed": 0.0},
        {"feed": float("nan")},
        {"lean": 2.0},
        {"lead": float("nan")},
        {"row_limit": 1},
        {"resample": 0.0},
        {"orientation": np.zeros((3, 3))},
        {"orientation": -np.eye(3)},
        {"orientation": np.eye(4)},
        {"orientation": [["a"] * 3] * 3},
    ],
)
def test_options_out_of_range_are_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(InputError, match=r"must|is|are"):
        replace(FLOOR, **wrong)


def test_a_cut_table_is_never_read_as_a_shorter_path_with_the_same_last_row() -> None:
    # A cut inside a row loses cells; a cut at the end of a row cannot be told from a short path.
    whole = table()
    last = whole.rindex(b"\n", 0, -1) + 1
    required = b",".join(cell.encode() for cell in ROWS[-1][:-1]) + b","
    for end in range(last + 1, last + len(required)):
        refused(whole[:end])


@pytest.mark.parametrize(
    "line", ["," * 200_000, "x[" + " " * 200_000, '"' * 200_001, "# frame:" + " " * 200_000 + "b b"]
)
def test_a_very_long_line_is_refused_without_long_work(line: str) -> None:
    refused(f"{line}\n1,2,3\n".encode())
    refused(f"x,y,z\n{line.strip('#')}\n".encode())


def test_a_failed_formula_in_the_first_cell_is_no_comment() -> None:
    for text in ("#REF!", "#N/A", "#DIV/0!"):
        assert "x is" in refused(changed(3, "x", text)).message
