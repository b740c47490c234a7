"""The offset of a position register is added to every contact move and to no other."""

import re
from dataclasses import replace

import pytest

from solver.catalog import load_cell
from solver.io.ls_reader import read_program
from solver.pipeline.planning import plan
from solver.pipeline.program_check import check_program
from solver.pipeline.programming import ProgramOrder, draft_program

OFFSET = " Offset,PR[5]"


@pytest.fixture(scope="module")
def drafted():
    problem = load_cell("groove_hw300")
    problem = replace(problem, program=replace(problem.program, offset=5))
    draft = draft_program(plan(problem), ProgramOrder(post="fanuc-cartesian"))
    ((_, text),) = draft.files
    return problem, text


def failed(drafted, change):
    problem, text = drafted
    changed = change(text)
    checks = check_program(problem, read_program(changed, "GROOVE.LS"), 0.05)
    return {one.name for one in checks if not one.passed}


def without(number):
    line = re.compile(rf"(L P\\[{number}\\] [^;]*?) Offset,PR\\[5\\]".replace("\\\\", "\\"))
    return lambda text: line.sub(r"\1", text)


def test_the_written_program_has_the_offset_on_contact_moves_alone(drafted):
    assert failed(drafted, lambda text: text) == set()
    assert drafted[1].count(OFFSET) == 50


@pytest.mark.parametrize("number", [4, 20, 53])
def test_a_contact_move_without_its_offset_is_noticed(drafted, number):
    assert failed(drafted, without(number)) == {"hash", "offset"}


def test_no_offset_at_all_is_noticed(drafted):
    assert failed(drafted, lambda text: text.replace(OFFSET, "")) == {"hash", "offset"}


def test_an_offset_of_the_approach_is_noticed(drafted):
    def change(text):
        return re.sub(r"(L P\[3\] \S+ FINE)", r"\1 Offset,PR[5]", text)

    assert failed(drafted, change) == {"hash", "offset"}
