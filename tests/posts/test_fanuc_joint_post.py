import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from ls_examples import GOLDEN, golden_program, move, program
from program_examples import m20ia

from solver.errors import ModelError, UnknownNameError
from solver.io.ls_reader import read_program
from solver.io.posts import POSTS, PostOptions, fanuc_joint, post_named
from solver.model.program import MotionKind, Move, Speed
from solver.model.program_settings import ProgramSettings
from solver.model.toolpath import Event, EventKind

NAMES = st.from_regex(r"[A-Z][A-Z0-9_]{0,35}", fullmatch=True)
PRINTABLE = "".join(map(chr, range(32, 127)))
TEXTS = (
    st.text(max_size=20)
    | st.text(alphabet=PRINTABLE, max_size=33)
    | st.text(alphabet=PRINTABLE.replace(";", "").replace('"', ""), max_size=16)
)


def render_fanuc_joint(asked, options=None):
    """The text of a program that fits into one file."""
    (file,) = fanuc_joint.render_fanuc_joint(asked, options or PostOptions(), m20ia())
    assert file.name == f"{asked.name}.LS"
    return file.text


def written(text):
    """What stands between the numbers and the semicolons of /MN."""
    lines = text.split("/MN\r\n")[1].split("/POS")[0].split("\r\n")[:-1]
    return [line[5:-1] for line in lines]


def test_the_file_equals_the_one_written_by_hand_from_the_format_description():
    assert render_fanuc_joint(golden_program()).encode("ascii") == GOLDEN.read_bytes()


def test_the_same_program_always_gives_the_same_bytes():
    assert render_fanuc_joint(golden_program()) == render_fanuc_joint(golden_program())


@given(
    thousandths=st.lists(st.tuples(*[st.integers(-720_000, 720_000)] * 6), min_size=1, max_size=5)
)
def test_every_thousandth_of_a_degree_is_read_back_exactly(thousandths):
    rows = [[value / 1000 for value in row] for row in thousandths]
    text = render_fanuc_joint(program(*map(move, rows)))
    found = read_program(text.encode(), "P.LS")
    assert [list(one.joints_deg) for one in found.path_positions()] == rows
    assert np.array_equal(found.path_joints(), program(*map(move, rows)).joints)


@given(
    degrees=st.lists(
        st.floats(-400, 400)
        | st.sampled_from([0.0, -0.0, -0.0004, 0.0005, -0.0005, 179.9996, -179.9996, 0.9996]),
        min_size=6,
        max_size=6,
    )
)
def test_any_angle_is_read_back_within_half_a_thousandth_and_never_as_minus_zero(degrees):
    text = render_fanuc_joint(program(move(degrees)))
    found = read_program(text, "P.LS")
    assert np.abs(np.array(found.positions[1].joints_deg) - degrees).max() <= 0.0005 + 1e-9
    assert "-0.000" not in text
    assert "-.000" not in text
    assert " .000" not in text
    fields = [part.split(" deg")[0] for part in text.split("/POS")[1].split("=")[1:]]
    assert [len(field) for field in fields] == [10] * 6
    assert all(
        field.strip()[:2] not in {"0.", "-0"} or field.strip() == "0.000" for field in fields
    )


@given(name=NAMES, comment=TEXTS, remarks=st.lists(TEXTS, max_size=4))
def test_no_text_breaks_a_file_it_is_read_back_whole_or_refused(name, comment, remarks):
    asked = program(name=name, comment=comment, remarks=tuple(remarks))
    refused = None
    try:
        text = render_fanuc_joint(asked)
    except ModelError as error:
        refused = str(error)
    if refused is not None:
        assert "\n" not in refused
        return
    assert "; ;" not in text
    found = read_program(text.encode("ascii"), "P.LS")
    assert (found.name, found.comment, found.remarks) == (name, comment, tuple(remarks))
    assert len(found.moves) == 1


@given(
    duration=st.floats(1e-7, 32.0),
)
def test_a_posted_time_is_whole_milliseconds_and_never_shorter_than_asked(duration):
    text = render_fanuc_joint(program(move([0] * 6, duration=duration)))
    speed = read_program(text, "P.LS").moves[0].speed
    assert speed.unit == "msec"
    assert speed.value == int(speed.value) >= 1
    assert duration <= speed.value / 1000 < duration + 0.001 + 1e-12


def test_a_time_that_is_a_decimal_number_of_milliseconds_is_not_rounded_further():
    for count in range(1, 1000):
        text = render_fanuc_joint(program(move([0] * 6, duration=count / 1000)))
        assert written(text)[-1] == f"J P[1] {count}msec FINE    "


def test_line_count_is_the_number_of_program_lines():
    text = render_fanuc_joint(golden_program())
    assert read_program(text, "P.LS").attributes["LINE_COUNT"] == str(len(written(text)))


def test_frames_come_before_the_first_motion_and_are_the_same_in_every_position():
    asked = program(move([1] * 6), move([2] * 6), uframe=3, utool=7, remarks=("a",))
    text = render_fanuc_joint(asked)
    assert written(text)[:4] == [
        "  !a ",
        "  UFRAME_NUM=3 ",
        "  UTOOL_NUM=7 ",
        "J P[1] 10% FINE    ",
    ]
    assert text.count("\tUF : 3, UT : 7,\t\r\n") == 2


@pytest.mark.parametrize(
    ("what", "says"),
    [
        ({"name": ""}, "program name"),
        ({"name": "groove"}, "upper-case"),
        ({"name": "1GROOVE"}, "begins with a letter"),
        ({"name": "GROOVE-1"}, "GROOVE-1"),
        ({"name": "GROOVE\n"}, "program name"),
        ({"name": "ＧＲＯＯＶＥ"}, "program name"),
        ({"name": "A" * 37}, "37 characters"),
        ({"comment": "seventeen letters"}, "at most 16"),
        ({"comment": 'quo"te'}, "character 4"),
        ({"comment": "tail "}, "end with a space"),
        ({"remarks": ("x" * 33,)}, "at most 32"),
        ({"remarks": ("end;",)}, "character 4"),
        ({"remarks": ("new\r\nline",)}, "printable ASCII"),
        ({"remarks": ("Träger",)}, "'ä'"),
        ({"remarks": (" ",)}, "end with a space"),
        ({"remarks": ("坡口 HW300",)}, "cannot hold Chinese"),
        ({"comment": "坡口"}, "cannot hold Chinese"),
        ({"uframe": -1}, "user frame"),
        ({"uframe": 10}, "0 to 9"),
        ({"utool": 11}, "0 to 10"),
        ({"utool": True}, "whole number"),
        ({"utool": 1.0}, "whole number"),
        ({"payload": 0}, "payload schedule"),
        ({"payload": 11}, "1 to 10"),
        ({"offset": 5}, r"PR\[5\].*fanuc-cartesian"),
        ({"date": "2026-11-21"}, "YY-MM-DD"),
        ({"date": "26-02-30"}, "YY-MM-DD"),
        ({"date": "２６-11-21"}, "YY-MM-DD"),
        ({"time": "24:00:00"}, "HH:MM:SS"),
        ({"time": "10:00:00\n"}, "HH:MM:SS"),
    ],
)
def test_what_does_not_fit_the_format_is_refused_with_a_sentence(what, says):
    with pytest.raises(ModelError, match=says):
        render_fanuc_joint(program(**what))


@pytest.mark.parametrize(
    ("events", "says"),
    [
        ((Event(EventKind.DWELL, value=0.0),), "dwell must be positive"),
        ((Event(EventKind.DWELL, value=math.nan),), "dwell must be positive"),
        ((Event(EventKind.DWELL, value=327.671),), "at most 327.67"),
        ((Event(EventKind.DIGITAL_OUTPUT, "x", 1.0),), "named by its number"),
        ((Event(EventKind.DIGITAL_OUTPUT, "0", 1.0),), "digital output"),
        ((Event(EventKind.DIGITAL_OUTPUT, "１", 1.0),), "named by its number"),
        ((Event(EventKind.DIGITAL_OUTPUT, "1", 0.5),), "set to 0 or 1"),
        ((Event(EventKind.CALL, "part 2"),), "program name"),
        ((Event(EventKind.CALL, "A;B"),), "program name"),
        ((Event(EventKind.CALL, "PROGRAM"),), "call itself"),
    ],
)
def test_an_event_that_a_controller_would_refuse_is_refused_and_says_at_which_move(events, says):
    with pytest.raises(ModelError, match=says) as caught:
        render_fanuc_joint(program(move([0] * 6), move([1] * 6, events=events)))
    assert str(caught.value).startswith("move 2: ")


@pytest.mark.parametrize("duration", [32.0001, 1e300])
def test_a_move_that_lasts_too_long_is_refused(duration):
    with pytest.raises(ModelError, match="move 1: "):
        render_fanuc_joint(program(move([0] * 6, duration=duration)))


def test_joints_that_were_not_rounded_before_they_were_checked_are_refused():
    sharp = replace(move([0] * 6), joints=np.radians([0.0, 10.0004, 0, 0, 0, 0]))
    with pytest.raises(ModelError, match=r"position 1: J2 is 10\.0004"):
        render_fanuc_joint(program(sharp))


@pytest.mark.parametrize("value", [math.nan, math.inf, 10_000.0])
def test_joints_that_no_field_holds_are_refused(value):
    with pytest.raises(ModelError):
        render_fanuc_joint(program(replace(move([0] * 6), joints=np.radians([value] * 6))))


def test_a_program_without_moves_is_refused():
    with pytest.raises(ModelError, match="no moves"):
        render_fanuc_joint(replace(program(), moves=()))


def test_a_program_of_9999_lines_is_one_file():
    moves = (move([0] * 6),) * 9_997
    assert "\r\n9999:J P[9997] 10% FINE    ;\r\n" in render_fanuc_joint(program(*moves))


def test_an_older_controller_takes_names_of_eight_characters():
    options = PostOptions(name_length=8, spindle_on="SPIN_ON", spindle_off="SPIN_OFF")
    assert "/PROG  GROOVE_3\r\n" in render_fanuc_joint(golden_program(), options)
    with pytest.raises(ModelError, match="takes 8"):
        render_fanuc_joint(program(name="GROOVE_33"), options)
    call = Event(EventKind.CALL, "PART_NO_2")
    with pytest.raises(ModelError, match="takes 8"):
        render_fanuc_joint(program(move([0] * 6, events=(call,))), options)


def test_the_spindle_is_switched_by_the_programs_that_the_options_name():
    moves = move([0] * 6, events=(Event(EventKind.SPINDLE_ON), Event(EventKind.SPINDLE_OFF)))
    options = PostOptions(spindle_on="GRIND", spindle_off="REST")
    assert written(render_fanuc_joint(program(moves), options))[-2:] == [
        "  CALL GRIND    ",
        "  CALL REST    ",
    ]


def test_posts_are_found_by_name_and_an_unknown_name_lists_the_known_ones():
    (file,) = post_named("fanuc-joint").render(golden_program(), PostOptions(), m20ia())
    assert file.text.encode() == GOLDEN.read_bytes()
    assert all(name == post.name for name, post in POSTS.items())
    with pytest.raises(UnknownNameError, match="fanuc-joint"):
        post_named("kuka")


@pytest.mark.parametrize(
    ("speed", "text"),
    [
        (0.05, "50"),
        (12.3e-3, "12.3"),
        (12.3 * 1e-3, "12.3"),
        (0.0125, "12.5"),
        (0.1 + 0.2, "300"),
        (2.0 / 60.0, "33.3"),
        (0.00199999, "1.9"),
        (0.001, "1"),
        (2.0, "2000"),
        (1.99999, "1999.9"),
    ],
)
def test_a_speed_is_whole_or_a_tenth_and_never_above_the_one_asked(speed, text):
    line = written(render_fanuc_joint(program(move([0] * 6, linear=speed))))[-1]
    assert line == f"L P[1] {text}mm/sec FINE    "


@given(speed=st.floats(0.001, 2.0))
def test_a_posted_speed_is_at_most_a_tenth_of_a_millimetre_below_the_one_asked(speed):
    text = render_fanuc_joint(program(move([0] * 6, linear=speed)))
    posted = read_program(text, "P.LS").moves[0].speed
    assert posted.unit == "mm/sec"
    assert -1e-9 <= speed * 1000 - posted.value < 0.1


@pytest.mark.parametrize("speed", [0.0009999, 2.0001, 1e-9, 1e9])
def test_a_speed_that_no_controller_takes_is_refused(speed):
    with pytest.raises(ModelError, match="move 1: the TCP speed of a linear move is 1 to 2000"):
        render_fanuc_joint(program(move([0] * 6, linear=speed)))


@pytest.mark.parametrize("percent", [1.5, 99.9])
def test_a_share_of_the_joint_speed_is_whole_percent(percent):
    with pytest.raises(ModelError, match="percent must be a whole number"):
        render_fanuc_joint(program(move([0] * 6, percent=percent)))


def test_the_payload_is_selected_after_the_tool():
    text = render_fanuc_joint(program(payload=4))
    assert written(text)[:3] == ["  UFRAME_NUM=0 ", "  UTOOL_NUM=1 ", "  PAYLOAD[4] "]


def test_a_cell_states_what_its_controller_accepts():
    stated = ProgramSettings(name_length=8, line_limit=500, spindle_on="ON", spindle_off="OFF")
    assert PostOptions.of(stated) == PostOptions(
        name_length=8, line_limit=500, spindle_on="ON", spindle_off="OFF"
    )
    assert PostOptions.of(ProgramSettings()) == PostOptions()


def test_a_linear_move_may_take_a_time():
    slow = Move(np.zeros(6), Speed.duration(0.25), MotionKind.LINEAR)
    assert written(render_fanuc_joint(program(slow)))[-1] == "L P[1] 250msec FINE    "


def test_the_file_in_the_documentation_is_the_hand_checked_one():
    page = Path(__file__).parents[2].joinpath("docs", "fanuc_ls.md").read_text(encoding="utf-8")
    shown = page.split("```text\n")[1].split("```")[0]
    assert shown.replace("→", "\t").replace("\n", "\r\n").encode("ascii") == GOLDEN.read_bytes()
