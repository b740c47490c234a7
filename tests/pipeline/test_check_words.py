"""What the checks of a faulty program say is said in Chinese too, without an English word left."""

import re

import pytest
from test_program_faults import FAULTS
from test_program_faults_linear import FAULTS as LINEAR_FAULTS
from written_programs import CARTESIAN, JOINT, checks_of, planned, written

from posopt_gui.i18n import texts, translated
from posopt_gui.viewmodels.check_figures import check_figure
from posopt_gui.viewmodels.check_sentences import sentence

NAMES = {
    # instructions and selections of the controller, numbers of bytes, cells and tools
    "CONFIG", "FINE", "mm", "kg", "sec", "msec", "posopt", "groove_hw300", "zigzag_hw250",
    "die_grinder", "Offset", "simplify", "to",
}  # fmt: skip


def chinese(text, **values):
    found = translated("zh_CN", text)
    return found.format(**values) if values else found


def left_over(text):
    """English words in a Chinese text: not quoted, no hash and no instruction of the controller."""
    bare = re.sub(r"'[^']*'|“[^”]*”|[0-9a-f]{12}|[A-Z]+\.LS(:\d+)?|--\w+", "", text)
    words = re.findall(r"[A-Za-z_]*[a-z]{2,}[A-Za-z_0-9]*", bare)
    return [word for word in words if word not in NAMES]


def assert_chinese(checks):
    known = texts("zh_CN")
    for one in checks:
        assert one.name in known
        value = check_figure("7", one.unit, chinese)
        detail = sentence(one.detail, chinese)
        assert not left_over(value), (one.name, one.unit)
        assert not left_over(detail), (one.name, one.detail, detail)
        assert "-0.000" not in re.sub(r"\d-0\.000", "", detail)


ALL = {(JOINT, name): fault for name, fault in FAULTS.items()} | {
    (CARTESIAN, name): fault for name, fault in LINEAR_FAULTS.items()
}

OF_EACH_KIND = sorted({expected: key for key, (*_, expected) in reversed(ALL.items())}.values())
"""One fault for each check that one fails under."""


def checks_under(fault):
    post, _ = fault
    cell, change, _ = ALL[fault]
    return checks_of(planned(cell).problem, change(written(cell, post)))


@pytest.mark.parametrize("fault", OF_EACH_KIND, ids=str)
def test_a_failed_check_of_each_kind_is_said_in_chinese(fault):
    assert_chinese(checks_under(fault))


@pytest.mark.long
@pytest.mark.parametrize("fault", ALL, ids=str)
def test_the_checks_of_every_known_fault_are_said_in_chinese(fault):
    assert_chinese(checks_under(fault))
