import json
from dataclasses import replace
from pathlib import Path

import jsonschema
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ls_examples import move, program
from program_examples import FRAME, GOLDEN_FOLDER, TOOL, grind_program, m20ia

from solver.errors import InputError, ModelError, RefusedError
from solver.io.csv_moves_reader import read_csv_moves
from solver.io.json_program_reader import read_json_program
from solver.io.neutral_differences import program_differences, row_differences
from solver.io.posts import POSTS, PostOptions
from solver.io.verified_program import write_verified
from solver.model.toolpath import Event, EventKind, Role

SCHEMA = json.loads(
    (Path(__file__).parents[2] / "docs" / "schemas" / "program.schema.json").read_text("utf-8")
)

EVENTS = st.lists(
    st.one_of(
        st.builds(Event, st.just(EventKind.DWELL), value=st.floats(1e-6, 3600.0)),
        st.builds(
            Event,
            st.just(EventKind.DIGITAL_OUTPUT),
            st.integers(1, 9999).map(str),
            st.sampled_from([0.0, 1.0]),
        ),
        st.builds(
            Event, st.just(EventKind.CALL), st.from_regex(r"[A-Z][A-Z0-9_]{0,6}", fullmatch=True)
        ),
        st.sampled_from([Event(EventKind.SPINDLE_ON), Event(EventKind.SPINDLE_OFF)]),
    ),
    max_size=3,
).map(tuple)
MOVES = st.builds(
    lambda row, speed, **what: move(row, **speed, **what),
    st.lists(st.floats(-400, 400), min_size=6, max_size=6),
    st.fixed_dictionaries({"percent": st.floats(1, 100)})
    | st.fixed_dictionaries({"linear": st.floats(1e-5, 10.0)})
    | st.fixed_dictionaries({"duration": st.floats(1e-6, 1e4)}),
    cnt=st.none() | st.integers(0, 100),
    role=st.sampled_from(list(Role)),
    waypoint=st.none() | st.integers(0, 10_000),
    events=EVENTS,
)


def render(post, asked):
    (file,) = POSTS[post].render(asked, PostOptions(), m20ia())
    return file.text


@settings(max_examples=60)
@given(moves=st.lists(MOVES, min_size=1, max_size=3))
def test_what_the_table_says_never_differs_from_the_program(moves):
    asked = program(*moves, frame=FRAME, tool=TOOL)
    rows = read_csv_moves(render("csv", asked).encode(), "PROGRAM.csv")
    assert list(row_differences(asked, rows, m20ia())) == []


@settings(max_examples=60)
@given(
    moves=st.lists(MOVES, min_size=1, max_size=3),
    comment=st.text(max_size=20),
    remarks=st.lists(st.text(max_size=40), max_size=3),
    payload=st.none() | st.integers(1, 10),
)
def test_no_text_breaks_a_json_program(moves, comment, remarks, payload):
    asked = program(
        *moves, comment=comment, remarks=tuple(remarks), payload=payload, frame=FRAME, tool=TOOL
    )
    text = render("json", asked)
    jsonschema.validate(json.loads(text), SCHEMA)
    found = read_json_program(text.encode(), "PROGRAM.json")
    assert list(program_differences(asked, found)) == []
    assert found.remarks == tuple(remarks)


def test_half_a_character_is_refused():
    with pytest.raises(ModelError, match="half a character"):
        render("json", program(comment="\ud800"))


@pytest.mark.parametrize("post", ["csv", "json"])
def test_the_file_is_written_and_the_program_that_it_holds_is_rechecked(tmp_path, post):
    seen = []
    path = tmp_path / f"GRIND.{post}"
    written = write_verified(
        grind_program(), path, seen.append, PostOptions(), POSTS[post], m20ia()
    )
    assert seen == [written.found]
    assert written.paths == (path,)
    assert np.array_equal(written.found.joints, grind_program().joints)
    assert [one.events for one in written.found.moves] == [
        one.events for one in grind_program().moves
    ]


@pytest.mark.parametrize(
    ("post", "old", "new", "says"),
    [
        ("csv", "-30.000", "-30.001", "move 1: J2 reads -30.001"),
        ("csv", "41.843", "41.848", "move 1: its pose is 0.00[45]"),
        ("csv", '"N U T, 0, 0, 0"', '"F U T, 0, 0, 0"', "move 1: CONFIG reads"),
        ("csv", "dwell:0.5", "dwell:0.6", "move 2: its events"),
        ("csv", "12.5,mm/s", "12.50001,mm/s", "move 4: its speed"),
        ("csv", "L,100,mm/s,CNT50", "L,100,mm/s,CNT51", "move 3: its CNT reads 51 instead of 50"),
        ("csv", "contact,1,", "contact,2,", "move 4: its waypoint"),
        ("csv", "lead-in,", "lead-out,", "move 3: its role"),
        ("csv", "\r\n2,", "\r\n3,", "line 3, key number: '3' was not expected"),
        ("csv", "J1_deg", "J1", "header"),
        ("csv", "J,20,%", "J,20,mm/s", "a joint move takes a speed"),
        ("csv", "J,20,%", "J,nan,%", "key speed"),
        ("csv", "J,20,%", "J,20,%,FINE", "cells instead of"),
        ("csv", "spindle-on|", 'spindle-on"|', "expected spindle-on"),
        ("json", '"GRIND"', '"GRIND2"', "its name reads 'GRIND2'"),
        ("json", "-30.0,", "-30.001,", "move 1: J2 reads -30.001"),
        ("json", '"measured": true', '"measured": false', "the user frame reads 1, measured False"),
        ("json", "800.0", "800.1", "the user frame reads another pose"),
        ("json", "[0.8, 0.0, -0.6]", "[-0.8, 0.0, 0.6]", "is no rotation"),
        ("json", '"payload": 3', '"payload": null', "its payload schedule reads None"),
        ("json", '"cnt": 50', '"cnt": 50.5', "expected a whole number"),
        ("json", '"cnt": 50', '"cnt": 101', "CNT is 0 to 100"),
        ("json", '"cnt": 50', '"cnt": 50, "x": 1', "is no member"),
        ("json", '"version": 1', '"version": 2', "version 1 is read, found 2"),
        ("json", '"unit": "%"', '"unit": "mm/s"', "a joint move takes a speed"),
        ("json", "flange_from_tcp", "tcp_from_flange", "expected flange_from_tcp"),
        ("json", '"role": "link", ', "", "key moves.0..role: is missing"),
        ("json", '"value": 0.5', '"value": NaN', "NaN"),
    ],
)
def test_a_post_that_writes_something_else_is_found_out(tmp_path, post, old, new, says):
    sound = POSTS[post]

    def render_wrong(asked, options, robot):
        (file,) = sound.render(asked, options, robot)
        assert old in file.text
        return (file._replace(text=file.text.replace(old, new, 1)),)

    wrong = replace(sound, render=render_wrong)
    with pytest.raises(RefusedError, match=says) as caught:
        write_verified(
            grind_program(),
            tmp_path / f"GRIND{sound.suffix}",
            lambda _: None,
            PostOptions(),
            wrong,
            m20ia(),
        )
    assert "\n" not in str(caught.value)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("cut", [1, 2, 50, 400, 1390])
def test_a_table_that_was_cut_is_refused_or_too_short(cut):
    data = (GOLDEN_FOLDER / "GRIND.csv").read_bytes()[:-cut]
    try:
        rows = read_csv_moves(data, "GRIND.csv")
    except InputError:
        return
    assert list(row_differences(grind_program(), rows, m20ia()))


@settings(max_examples=200)
@given(at=st.integers(0, 1400), byte=st.integers(0, 255), post=st.sampled_from(["csv", "json"]))
def test_a_changed_byte_is_read_as_something_else_or_refused_with_a_sentence(at, byte, post):
    data = bytearray((GOLDEN_FOLDER / f"GRIND.{post}").read_bytes())
    data[at] = byte
    read = {"csv": read_csv_moves, "json": read_json_program}[post]
    fault = ""
    try:
        read(bytes(data), f"GRIND.{post}")
    except InputError as error:
        fault = str(error)
    assert "\n" not in fault


@pytest.mark.parametrize(
    ("event", "says"),
    [
        (Event(EventKind.DWELL, value=0.0), "dwell"),
        (Event(EventKind.DWELL, value=float("nan")), "dwell"),
        (Event(EventKind.DIGITAL_OUTPUT, "03", 1.0), "digital output"),
        (Event(EventKind.DIGITAL_OUTPUT, "3", 0.5), "digital output"),
        (Event(EventKind.CALL, "=1|x"), "program name"),
    ],
)
def test_an_event_that_a_table_cannot_hold_is_refused(event, says):
    with pytest.raises(ModelError, match=says) as caught:
        render("csv", program(move([0] * 6, events=(event,))))
    assert str(caught.value).startswith("move 1: ")


def test_a_table_has_no_place_for_an_offset():
    with pytest.raises(ModelError, match="offset"):
        render("csv", grind_program(offset=3))


@pytest.mark.parametrize("post", ["csv", "json"])
def test_a_program_without_moves_has_no_neutral_form(post):
    with pytest.raises(ModelError, match="no moves"):
        render(post, replace(program(), moves=()))
