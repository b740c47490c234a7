import json
import math
import re
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from posopt_gui.i18n import texts, translated
from posopt_gui.viewmodels.check_figures import figures, number
from posopt_gui.viewmodels.check_sentences import CHECK_NAMES, PATTERNS, UNITS, sentence
from posopt_gui.viewmodels.export_model import (
    FORMATS,
    LEAST_REASON,
    OVERRIDDEN,
    ExportForm,
    ExportStage,
    Situation,
    check_rows,
    export_view,
    format_of,
    override_target,
    waypoint_of,
    with_suffix,
)
from posopt_gui.viewmodels.number_words import typeset
from solver.analysis.check import Check
from solver.pipeline.program_check import ProgramReport
from solver.pipeline.programming import ProgramDraft, WrittenProgram

GOOD = Check("clearance", True, 50.0, 50.0, "mm", "nose against web at waypoint 3 (A.LS:9)")
BAD = Check("feed", False, 12.0, 10.0, "% beside the asked feed", "no contact moves", 4)


def english(text, **values):
    return text.format(**values) if values else text


def chinese(text, **values):
    found = translated("zh_CN", text)
    return found.format(**values) if values else found


def draft(*checks):
    return ProgramDraft(None, (("A.LS", "/PROG A"),), ProgramReport(tuple(checks), 1))


def passed(**changes):
    ready = Situation(
        form=ExportForm(path="/tmp/A.LS"), planned=True, current=True, draft=draft(GOOD),
        order_fault="",
    )  # fmt: skip
    return replace(ready, **changes)


def test_formats_name_the_posts_and_their_suffixes():
    from solver.io.posts import POSTS

    assert {one.post: one.suffix for one in FORMATS} == {
        name: post.suffix for name, post in POSTS.items()
    }


def test_constants_are_those_of_the_program_writer():
    from solver.pipeline import programming

    assert LEAST_REASON == programming.LEAST_REASON
    assert OVERRIDDEN == programming.OVERRIDDEN


def test_only_passed_checks_of_the_current_plan_and_a_usable_file_can_be_exported():
    assert export_view(passed(), english).can_export
    for change in (
        {"planned": False},
        {"planning": True},
        {"stale": True},
        {"blocked": "waypoint 3 has no feasible pose at all"},
        {"current": False},
        {"draft": None},
        {"fault": "no link"},
        {"writing": True},
        {"order_fault": None},
        {"order_fault": "there is no folder"},
        {"draft": draft(GOOD, BAD)},
    ):
        view = export_view(passed(**change), english)
        assert not view.can_export, change
        assert not view.can_override, change


def test_a_failed_check_can_be_overridden_for_a_reason_of_ten_characters_alone():
    refused = passed(draft=draft(GOOD, BAD))
    for reason, allowed in (("", False), ("123456789", False), ("  12345678  ", False),
                            ("1234567890", True)):  # fmt: skip
        view = export_view(replace(refused, form=ExportForm("csv", "/A.csv", reason=reason)),
                           english)  # fmt: skip
        assert view.can_override is allowed
        assert not view.can_export
        assert view.asks_reason


def test_a_reason_that_cannot_be_stamped_allows_no_override():
    form = ExportForm(path="/A.LS", reason="a long enough reason")
    view = export_view(passed(draft=draft(BAD), form=form, reason_fault="no ASCII"), english)
    assert not view.can_override
    assert view.reason_wrong
    assert view.reason_hint == "no ASCII"


def test_passed_checks_ask_for_no_reason_and_allow_no_override():
    view = export_view(passed(form=ExportForm(path="/A.LS", reason="a long reason")), english)
    assert not view.can_override
    assert not view.asks_reason


def test_a_stale_plan_is_said_and_planning_offered():
    view = export_view(passed(stale=True), english)
    assert view.stage is ExportStage.STALE
    assert view.offers_plan
    assert view.old
    assert "changed" in view.headline


def test_failed_lines_come_first_and_keep_their_order():
    checks = [replace(GOOD, name=f"g{i}") for i in range(3)]
    checks.insert(1, replace(BAD, name="b0"))
    checks.append(replace(BAD, name="b1"))
    assert [row.name for row in check_rows(checks, english)] == ["b0", "b1", "g0", "g1", "g2"]


def test_a_line_knows_its_waypoint_also_from_its_sentence_alone():
    assert waypoint_of(BAD) == 4
    assert waypoint_of(GOOD) == 2
    assert waypoint_of(replace(GOOD, detail="J5 at GROOVE.LS:40")) is None


def test_the_headline_states_the_checked_clearance_and_never_says_safe():
    view = export_view(passed(draft=draft(replace(GOOD, value=49.9))), english)
    assert "at least 49.9 mm" in view.headline
    assert "nominal model" in view.headline
    assert "safe" not in view.headline


def test_clearance_is_asked_for_only_where_the_plan_keeps_less_than_asked():
    assert export_view(passed(least=0.03, required=0.05), english).asks_clearance
    assert not export_view(passed(least=0.05, required=0.05), english).asks_clearance


def test_a_written_program_is_named_with_its_parts_and_its_override():
    paths = (Path("/x/A.LS"), Path("/x/A01.LS"))
    written = WrittenProgram(paths, None, ProgramReport((GOOD,)), None, (Path("/x/A02.LS"),))
    view = export_view(passed(written=written), english)
    assert view.note_tone == "good"
    assert all(name in view.note for name in ("A.LS", "A01.LS", "A02.LS"))
    view = export_view(passed(written=replace(written, override="because of it")), english)
    assert view.note_tone == "warning"


def test_a_form_becomes_the_order_of_the_writer():
    form = ExportForm("csv", "/A.csv", 0.0001, 0.03, "  a long enough reason ")
    assert form.order().override is None
    order = form.order(override=True)
    assert (order.override, order.post) == ("a long enough reason", "csv")
    assert (order.simplify, order.accepted_clearance) == (0.0001, 0.03)


@given(
    st.floats(allow_nan=False, allow_infinity=False, min_value=-1e6, max_value=1e6),
    st.floats(allow_nan=False, allow_infinity=False, min_value=-1e6, max_value=1e6),
)
def test_a_value_and_its_limit_read_differently_where_they_differ_by_a_millionth(value, limit):
    shown, bound = figures(value, limit)
    if abs(value - limit) > 1e-6 * max(abs(value), abs(limit), 1.0):
        assert shown != bound
    if shown.startswith("<"):
        assert 0.0 < value < float(shown[1:])
    else:
        near = 0.05 + 0.1 * abs(value) * (abs(value) < 1e-3)
        assert float(shown) == pytest.approx(value, abs=near)


def test_what_is_not_known_is_a_dash():
    assert number(math.nan) == "\N{EN DASH}"
    assert number(math.inf) == "\N{INFINITY}"
    assert number(50.0) == "50"
    assert number(0.0) == "0"


def test_suffix_and_override_change_the_name_alone():
    assert with_suffix("/a.b/GROOVE.LS", "csv") == str(Path("/a.b/GROOVE.csv"))
    assert with_suffix("", "csv") == ""
    assert override_target("/a/GROOVE.LS") == Path("/a/GROOVE_OVR.LS")
    assert format_of("nothing") is FORMATS[0]


def test_english_sentences_stay_as_they_are():
    for pattern in PATTERNS:
        text = re.sub(r"\{(\w+)\}", "x1", pattern)
        assert sentence(text, english) == typeset(text)


def test_all_words_of_the_checks_have_a_translation_with_the_same_names():
    known = texts("zh_CN")
    for text in (*PATTERNS, *CHECK_NAMES, *UNITS):
        assert text in known, text
        names = sorted(re.findall(r"\{(\w+)\}", text))
        assert sorted(re.findall(r"\{(\w+)\}", known[text])) == names, text


def test_a_sentence_with_names_and_numbers_is_said_in_chinese():
    text = "nose against flange_top at waypoint 48 (GROOVE.LS:92)"
    found = sentence(text, chinese)
    assert "48" in found
    assert "GROOVE.LS:92" in found
    assert not re.search(r"against|waypoint", found)


def test_check_names_are_those_that_the_solver_uses():
    folder = Path(__file__).parents[2] / "solver"
    source = "\n".join(path.read_text("utf-8") for path in sorted(folder.glob("[ap]*/*.py")))
    for name in CHECK_NAMES:
        base = re.sub(r"^(lean|lead|spin) range$", "{name} range", name)
        assert f'"{base}"' in source, name
    assert set(re.findall(r'Check\(\s*"([^"]+)"', source)) <= set(CHECK_NAMES)


def test_every_translation_of_the_area_keeps_its_names():
    path = Path(__file__).parents[2] / "resources" / "translations" / "zh_CN" / "export.json"
    for text, shown in json.loads(path.read_text("utf-8")).items():
        assert sorted(re.findall(r"\{\w+\}", text)) == sorted(re.findall(r"\{\w+\}", shown)), text
