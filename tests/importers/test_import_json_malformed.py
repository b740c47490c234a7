"""Malformed JSON ends with one sentence that names line, column and the path of the value."""

from __future__ import annotations

import json
from typing import Any

import pytest
from path_examples import as_json, document, refused

from solver.errors import InputError
from solver.io.importers import ImportOptions, located_json

FILE = "path.json"
NOTHING_STATED = ImportOptions()
MARK = "@@@"


def marked(way: list[str | int], text: str) -> tuple[bytes, int, int]:
    """The example with the value at `way` replaced by raw text, and its line and column."""
    value = document()
    target: Any = value
    for step in way[:-1]:
        target = target[step]
    target[way[-1]] = MARK
    whole = json.dumps(value, indent=1)
    offset = whole.index(f'"{MARK}"')
    line = whole.count("\n", 0, offset) + 1
    column = offset - whole.rfind("\n", 0, offset)
    return whole.replace(f'"{MARK}"', text, 1).encode(), line, column


def check(way: list[str | int], text: str, shift: int = 0) -> InputError:
    data, line, column = marked(way, text)
    error = refused(data, FILE, NOTHING_STATED)
    assert error.place is not None
    assert (error.place.line, error.place.column) == (line, column + shift)
    return error


WAYPOINT: list[str | int] = ["passes", 0, "waypoints", 1]
NUMBERS: list[list[str | int]] = [
    [*WAYPOINT, "position", 1],
    [*WAYPOINT, "normal", 2],
    [*WAYPOINT, "travel", 0],
    ["passes", 1, "feed_mm_s"],
    ["passes", 1, "lean_deg"],
]
NO_JSON_NUMBERS = (
    "NaN", "nan", "Infinity", "-Infinity", "inf", "1_000", "01", "+1", ".5", "1.", "0x10", "1e",
    "1e999", "-1e999", "１２", "\u22125", "1.2.3", "--1", "True", "None", "undefined", "1j", "12mm",
)  # fmt: skip


@pytest.mark.parametrize("way", NUMBERS, ids=lambda way: str(way[-2:]))
@pytest.mark.parametrize("text", NO_JSON_NUMBERS)
def test_what_is_no_json_number_is_refused_where_it_stands(way: list[str | int], text: str) -> None:
    check(way, text)


@pytest.mark.parametrize("way", NUMBERS, ids=lambda way: str(way[-2:]))
@pytest.mark.parametrize("text", ['"5"', "null", "true", "[]", "{}", "[1]", '"NaN"'])
def test_a_value_of_another_kind_is_refused_with_its_path(way: list[str | int], text: str) -> None:
    error = check(way, text)
    assert error.place is not None
    path = "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in way)[1:]
    assert error.place.key == path
    assert "expected a number" in error.message


CASES: tuple[tuple[list[str | int], str, str], ...] = (
    (["format"], '"other"', "posopt-toolpath"),
    (["format"], "1", "posopt-toolpath"),
    (["version"], "2", "expected 1"),
    (["version"], '"1"', "expected 1"),
    (["version"], "true", "expected 1"),
    (["version"], "1.5", "expected 1"),
    (["frame"], '"world"', "beam, floor or fanuc_world"),
    (["frame"], "1", "text"),
    (["frame"], "null", "text"),
    (["unit"], '"inch"', "mm or m"),
    (["unit"], '""', "mm or m"),
    (["unit"], "1", "text"),
    (["passes"], "null", "array"),
    (["passes"], "{}", "array"),
    (["passes"], '"a"', "array"),
    (["passes", 0], "[]", "object"),
    (["passes", 0], "1", "object"),
    (["passes", 0], "null", "object"),
    (["passes", 0], "{}", "waypoints"),
    (["passes", 1, "name"], '"a"', "again"),
    (["passes", 0, "name"], '""', "empty"),
    (["passes", 0, "name"], "5", "text"),
    (["passes", 0, "name"], '"a\\nb"', "printable"),
    (["passes", 0, "name"], '"\\u0000"', "printable"),
    (["passes", 0, "feed_mm_s"], "0", "0 mm/s"),
    (["passes", 0, "feed_mm_s"], "-1", "-1 mm/s"),
    (["passes", 0, "feed_mm_s"], "20000", "10000"),
    (["passes", 0, "touches"], "3", "text"),
    (["passes", 1, "lean_deg"], "91", "90"),
    (["passes", 0, "waypoints"], "{}", "array"),
    (["passes", 0, "waypoints"], "null", "array"),
    (WAYPOINT, "[]", "object"),
    (WAYPOINT, "{}", "position"),
    (WAYPOINT, "null", "object"),
    (WAYPOINT, "[1, 2, 3]", "object"),
    ([*WAYPOINT, "position"], "[1, 2]", "3 numbers"),
    ([*WAYPOINT, "position"], "[1, 2, 3, 4]", "3 numbers"),
    ([*WAYPOINT, "position"], "[]", "3 numbers"),
    ([*WAYPOINT, "position"], "5", "3 numbers"),
    ([*WAYPOINT, "position"], '"1,2,3"', "3 numbers"),
    ([*WAYPOINT, "position"], '{"x": 1}', "3 numbers"),
    ([*WAYPOINT, "position"], "[1e6, 0, 0]", "100 m"),
    ([*WAYPOINT, "position"], "[0, 0, 5]", "repeats"),
    ([*WAYPOINT, "normal"], "[0, 0, 0]", "zero"),
    ([*WAYPOINT, "normal"], "[0, 0, 2]", "length of 2"),
    ([*WAYPOINT, "normal"], "[0, 0]", "3 numbers"),
    ([*WAYPOINT, "travel"], "[0, 0, 0]", "zero"),
    ([*WAYPOINT, "travel"], "[0, 0, -7]", "parallel"),
    ([*WAYPOINT, "travel"], "null", "3 numbers"),
    ([*WAYPOINT, "role"], '"cut"', "lead-in"),
    ([*WAYPOINT, "role"], "1", "text"),
    ([*WAYPOINT, "events"], '"dwell:1"', "array"),
    ([*WAYPOINT, "events"], "{}", "array"),
)


@pytest.mark.parametrize(("way", "text", "says"), CASES)
def test_a_value_that_does_not_fit_is_refused_where_it_stands(
    way: list[str | int], text: str, says: str
) -> None:
    assert says in check(way, text).message


@pytest.mark.parametrize("text", ["1", "null", '"dwell"', '"dwell:-1"', '"x|y"', "[]", '""'])
def test_an_event_that_does_not_fit_is_refused_where_it_stands(text: str) -> None:
    check([*WAYPOINT, "events"], f'["spindle-on", {text}]', shift=len('["spindle-on", '))


@pytest.mark.parametrize(
    ("way", "name"),
    [([], "pases"), (["passes", 0], "feed"), (WAYPOINT, "positon"), (WAYPOINT, "W" * 100)],
)
def test_an_unknown_member_is_refused_at_its_name(way: list[str | int], name: str) -> None:
    value = document()
    target: Any = value
    for step in way:
        target = target[step]
    target[name] = 0
    data = as_json(value)
    offset = data.index(f'"{name}"'.encode())
    error = refused(data, FILE, NOTHING_STATED)
    assert error.place is not None
    assert error.place.line == data.count(b"\n", 0, offset) + 1
    assert error.place.column == offset - data.rfind(b"\n", 0, offset)


@pytest.mark.parametrize(
    ("text", "line", "column"),
    [
        ("", 1, 1),
        ("  \n ", 2, 2),
        ("{", 1, 2),
        ("[", 1, 2),
        ("]", 1, 1),
        ("}", 1, 1),
        (",", 1, 1),
        (":", 1, 1),
        ("[1,]", 1, 4),
        ("[,1]", 1, 2),
        ("[1 2]", 1, 4),
        ("[1}", 1, 3),
        ('{"a":1]', 1, 7),
        ('{"a"}', 1, 5),
        ('{"a":}', 1, 6),
        ('{"a" 1}', 1, 6),
        ('{"a":1,}', 1, 8),
        ("{,}", 1, 2),
        ("{1:2}", 1, 2),
        ("{'a':1}", 1, 2),
        ("{a:1}", 1, 2),
        ('{"a":1 "b":2}', 1, 8),
        ('{"a":1,\n"a":2}', 2, 1),
        ('"abc', 1, 1),
        ('["a\nb"]', 1, 2),
        ('["a\tb"]', 1, 2),
        ('["\\x"]', 1, 2),
        ('["\\u12"]', 1, 2),
        ('["\\ud800"]', 1, 2),
        ("[tru]", 1, 2),
        ("[nul", 1, 2),
        ("{} {}", 1, 4),
        ("[]\n[]", 2, 1),
        ("[1]//c", 1, 4),
        ("/* c */ {}", 1, 1),
        ("[1\u30002]", 1, 3),
        ("\u00a0{}", 1, 1),
        ("[1]\r\n\r\nx", 3, 1),
        ("[1]\rx", 2, 1),
        ("[" * 100_000, 1, 33),
        ('{"a":' * 100_000, 1, 5 * 32 + 1),
        ("[" * 50_000 + "]" * 50_000, 1, 33),
        ("[" * 32 + "1" + "]" * 32, 1, 1),
    ],
    ids=lambda value: repr(value)[:30],
)
def test_what_is_no_json_is_refused_at_its_first_wrong_character(
    text: str, line: int, column: int
) -> None:
    error = refused(text.encode(), FILE, NOTHING_STATED)
    assert error.place is not None
    assert (error.place.line, error.place.column) == (line, column)


def test_a_document_cut_off_anywhere_is_refused() -> None:
    data = as_json(document())
    for end in range(len(data) - 1):
        error = refused(data[:end], FILE, NOTHING_STATED)
        assert error.place is not None
        assert error.place.line is not None
        assert error.place.column is not None


def test_what_the_standard_library_refuses_is_refused() -> None:
    # Every single character of the example replaced by each of a few others.
    data = as_json({"format": "posopt-toolpath", "version": 1, "passes": [[1.5, True, None, "a"]]})
    for index in range(len(data)):
        for other in (b"[", b"}", b",", b'"', b"1", b" ", b"\\", b":", b"e"):
            text = data[:index] + other + data[index + 1 :]
            try:
                json.loads(text)
            except ValueError:
                error = refused(text, FILE, NOTHING_STATED)
                assert error.place is not None
                assert error.place.key is None


@pytest.mark.parametrize("extra", [{"quaternion": [1, 0, 0, 0]}, {"wpr_deg": [0, 0, 0]}])
def test_a_second_orientation_is_refused(extra: dict[str, Any]) -> None:
    value = document()
    value["passes"][0]["waypoints"][1] |= extra
    error = refused(as_json(value), FILE, NOTHING_STATED)
    assert error.place is not None
    assert error.place.key == "passes[0].waypoints[1].normal"


def test_a_travel_without_a_normal_is_refused() -> None:
    value = document()
    del value["passes"][0]["waypoints"][1]["normal"]
    error = refused(as_json(value), FILE, NOTHING_STATED)
    assert error.place is not None
    assert error.place.key == "passes[0].waypoints[1].travel"


def test_missing_members_are_refused() -> None:
    for name in ("format", "version", "passes"):
        value = document()
        del value[name]
        assert name in refused(as_json(value), FILE, NOTHING_STATED).message


def test_a_frame_that_nobody_states_is_refused() -> None:
    value = document()
    del value["frame"]
    assert "frame" in refused(as_json(value), FILE, NOTHING_STATED).message


def test_a_unit_other_than_the_imports_is_refused() -> None:
    error = refused(as_json(document()), FILE, ImportOptions(unit="m"))
    assert error.place is not None
    assert error.place.key == "unit"


@pytest.mark.parametrize("passes", [[], [{"waypoints": []}], [{"waypoints": [{}]}]])
def test_a_path_without_two_points_is_refused(passes: list[Any]) -> None:
    refused(as_json(document() | {"passes": passes}), FILE, NOTHING_STATED)


def test_one_point_is_refused() -> None:
    value = document()
    value["passes"] = [{"waypoints": value["passes"][0]["waypoints"][:1]}]
    assert "two or more" in refused(as_json(value), FILE, NOTHING_STATED).message


def test_more_waypoints_than_the_limit_are_refused_at_the_first_one_too_many() -> None:
    error = refused(as_json(document()), FILE, ImportOptions(row_limit=2))
    assert error.place is not None
    assert error.place.key == "passes[1].waypoints[0]"


@pytest.mark.parametrize("data", [b"\0", b"{\xff}", b"\xff\xfe{\0}\0", b'{"a":"\xb4\xd6\xff"}'])
def test_bytes_that_are_no_text_are_refused(data: bytes) -> None:
    error = refused(data, FILE, NOTHING_STATED)
    assert error.place is not None
    assert error.place.line == 1


def test_more_values_than_the_memory_is_meant_for_are_refused(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(located_json, "MAX_VALUES", 100)
    text = f"[{', '.join(['[[]]'] * 60)}]"
    assert "100" in refused(text.encode(), FILE, NOTHING_STATED).message
    assert "100" in refused(f"[{'1,' * 2000}1]".encode(), FILE, NOTHING_STATED).message


def test_places_are_found_quickly_in_a_document_of_many_passes() -> None:
    # Looking up the line of every pass anew made this quadratic.
    value = document()
    waypoints = value["passes"][0]["waypoints"]
    value["passes"] = [{"name": str(index), "waypoints": waypoints} for index in range(3000)]
    value["passes"].append({"name": "7", "waypoints": waypoints})
    error = refused(as_json(value), FILE, NOTHING_STATED)
    assert error.place is not None
    assert error.place.key == "passes[3000].name"
