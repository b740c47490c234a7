import string

import pytest
from hypothesis import given
from hypothesis import strategies as st

from solver.errors import ModelError
from solver.io.posts.fanuc_text import (
    angle_text,
    ascii_remark,
    dwell_text,
    plain_text,
    stamped,
)


@pytest.mark.parametrize(
    ("degrees", "text"),
    [
        (0.0, "0.000"),
        (-0.0, "0.000"),
        (-0.0004, "0.000"),
        (0.582, ".582"),
        (-0.398, "-.398"),
        (0.9996, "1.000"),
        (-0.9996, "-1.000"),
        (10.0, "10.000"),
        (-179.9996, "-180.000"),
        (-9999.999, "-9999.999"),
    ],
)
def test_angles_read_as_a_controller_writes_them(degrees, text):
    assert angle_text(degrees) == text


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(0.5, ".50"), (0.001, ".01"), (0.29, ".29"), (1.0, "1.00"), (1.001, "1.01"), (300, "300.00")],
)
def test_a_dwell_is_never_shorter_than_asked(seconds, text):
    assert dwell_text(seconds) == text


@given(text=st.text(max_size=100))
def test_any_text_becomes_a_remark_that_cannot_break_a_file(text):
    remark = ascii_remark(text)
    assert plain_text("a remark", remark, 32) == remark
    assert set(remark) <= set(string.printable) - set(string.whitespace[1:]) - set(';"')


@given(text=st.text(alphabet=string.ascii_letters + string.digits + "_-.:/", max_size=32))
def test_a_text_that_is_a_remark_already_stays_as_it_is(text):
    assert ascii_remark(text) == text


def test_accents_are_dropped_and_foreign_letters_become_question_marks():
    assert ascii_remark("Träger; 坡口\t 'α' \"x\"") == "Trager, ?? '?' 'x'"


def test_a_long_text_is_cut_to_the_length_of_a_remark():
    assert ascii_remark("clearance waived by the shift supervisor") == (
        "clearance waived by the shift su"
    )


def test_compatibility_forms_of_the_breaking_characters_do_not_come_back():
    assert ";" not in ascii_remark("a\u037eb；c")
    assert '"' not in ascii_remark("＂")


def test_a_refusal_names_the_character_and_its_place():
    with pytest.raises(ModelError, match=r"';' at character 3"):
        plain_text("a remark", "ab;c", 32)


@given(
    prefix=st.sampled_from(["", "R ", "OVERRIDE: "]),
    text=st.text(alphabet="ab c.,", max_size=120) | st.text(max_size=60),
)
def test_a_long_text_is_broken_into_remarks_without_losing_a_character(prefix, text):
    try:
        remarks = stamped(prefix, text)
    except ModelError:
        foreign = any(not " " <= one <= "~" or one in ';"' for one in text)
        assert foreign or text.endswith(" ") or " " * (32 - len(prefix)) in text
        return
    assert "".join(one.removeprefix(prefix) for one in remarks) == text
    assert all(one.startswith(prefix) for one in remarks)
    assert [plain_text("a remark", one, 32) for one in remarks] == list(remarks)


def test_a_reason_becomes_as_few_remarks_as_it_needs():
    reason = "fixture 3 is not there, cleared by the shift supervisor"
    assert stamped("OVR ", reason) == (
        "OVR fixture 3 is not there, clea",
        "OVR red by the shift supervisor",
    )
    assert list(map(len, stamped("OVR ", "x" * 60))) == [32, 32, 8]


def test_a_space_at_a_break_begins_the_next_remark():
    assert stamped("", "a" * 31 + " b") == ("a" * 31, " b")


def test_a_chinese_reason_is_refused_and_the_sentence_says_what_to_write():
    with pytest.raises(ModelError, match=r"cannot hold Chinese.*pinyin.*character 5"):
        stamped("OVR ", "夹具")


def test_a_prefix_that_fills_a_remark_is_refused():
    with pytest.raises(ModelError, match="leaves no room"):
        stamped("x" * 32, "reason")
