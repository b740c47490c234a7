import base64
import re
import struct
import zlib
from html.parser import HTMLParser

import pytest

from posopt_gui.i18n import translated
from posopt_gui.viewmodels.report_page import ReportContent, report_page
from solver.errors import InputError

VOID = {"meta", "br", "img", "link", "hr", "input"}


def png(width, height):
    def chunk(kind, data):
        checksum = struct.pack(">I", zlib.crc32(kind + data))
        return struct.pack(">I", len(data)) + kind + data + checksum

    rows = b"".join(b"\0" + b"\x50\x80\xb0" * width for _ in range(height))
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    parts = (b"IHDR", head), (b"IDAT", zlib.compress(rows)), (b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunk(*one) for one in parts)


class Page(HTMLParser):
    """Collects tags, attributes and the texts of cells, and finds tags that do not match."""

    def __init__(self, text):
        super().__init__()
        self.open, self.tags, self.rows, self.text = [], [], [], []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)
        if tag == "tr":
            self.rows.append([])
        if tag in {"td", "th"}:
            self.rows[-1].append("")

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text.append(data)
        if self.open and self.open[-1] in {"td", "th"}:
            self.rows[-1][-1] += data


def said(language):
    def tr(text, **values):
        found = translated(language, text)
        return found.format(**values) if values else found

    return tr


@pytest.fixture(scope="module")
def planned():
    import solver
    from solver.pipeline.programming import draft_program

    result = solver.plan(solver.load_cell("groove_hw300"))
    return result, draft_program(result)


@pytest.fixture(scope="module")
def pictures():
    return {"map": png(4, 3), "curves": png(5, 3), "scene": png(6, 3)}


@pytest.fixture(scope="module")
def page(planned, pictures):
    return report_page(ReportContent(*planned, pictures), said("en"))


def test_the_page_is_whole_and_holds_the_checks_and_every_waypoint(page, planned):
    result, draft = planned
    found = Page(page)
    for check in draft.report.checks:
        assert any(row[:2] == ["passed", check.name] for row in found.rows), check.name
    numbers = [row[0] for row in found.rows if len(row) == 16]
    assert numbers == ["#", *map(str, range(1, len(result.problem.toolpath) + 1))]


def test_joints_of_the_table_are_the_pendants_in_degrees(page, planned):
    result, _ = planned
    row = next(one for one in Page(page).rows if len(one) == 16 and one[0] == "7")
    shown = [float(one) for one in row[4:10]]
    assert shown == pytest.approx(result.sequence.pendant[6] * 57.29577951308232, abs=6e-4)


def test_no_clearance_is_said_to_be_more_than_was_found(page, planned):
    result, _ = planned
    rows = [one for one in Page(page).rows if len(one) == 16 and one[0] != "#"]
    for row, clearance in zip(rows, result.sequence.clearance, strict=True):
        assert float(row[12]) <= clearance * 1e3 + 1e-6


def test_nothing_is_loaded_from_elsewhere(page):
    for tag, attributes in Page(page).tags:
        assert tag not in {"script", "link", "iframe", "object"}
        for name in ("src", "href", "srcset", "data"):
            assert attributes.get(name, "data:").startswith("data:")
    assert not re.search(r"url\(|@import|https?://", page)


def test_pictures_are_the_given_bytes_with_words_for_them(page, pictures):
    images = [attributes for tag, attributes in Page(page).tags if tag == "img"]
    found = {base64.b64decode(one["src"].partition(",")[2]) for one in images}
    assert found == set(pictures.values())
    assert all(one["alt"] for one in images)


def test_missing_pictures_are_left_out(planned):
    page = report_page(ReportContent(*planned, {"scene": b""}), said("en"))
    assert "<img" not in page


def test_what_is_no_picture_is_refused(planned):
    with pytest.raises(InputError, match="scene is no PNG"):
        report_page(ReportContent(*planned, {"scene": b"GIF89a"}), said("en"))


def test_equal_inputs_give_equal_bytes(page, pictures):
    import solver
    from solver.pipeline.programming import draft_program

    result = solver.plan(solver.load_cell("groove_hw300"))
    again = report_page(ReportContent(result, draft_program(result), pictures), said("en"))
    assert again == page


def test_a_reason_is_shown_as_text_never_as_markup(planned):
    reason = '<script>alert("1")</script> & more'
    page = report_page(ReportContent(*planned, {}, reason), said("en"))
    assert reason in "".join(Page(page).text)
    assert "<script" not in page


def test_hash_and_assumptions_are_stated(page, planned):
    result, draft = planned
    remark = next(one for one in draft.program.remarks if one.startswith("HASH "))
    text = "".join(Page(page).text)
    assert remark.removeprefix("HASH ") in text
    for one in (*result.problem.assumptions, *result.problem.robot.assumptions):
        assert one in text


def test_the_page_speaks_chinese_throughout(planned, pictures):
    found = Page(report_page(ReportContent(*planned, pictures), said("zh_CN"), "zh_CN"))
    assert ("html", {"lang": "zh-CN"}) in found.tags
    text = " ".join(one for one in found.text if "@page" not in one)
    # Names and the hash are the same in every language.
    kept = r"fanuc_world|die_grinder|groove_hw300|exact|\b[0-9a-f]{12}\b"
    assert re.findall(r"[a-z]{4,}", re.sub(kept, "", text)) == []
