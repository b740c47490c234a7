"""The checks that docs/robot_program.md lists are those that there are, with their limits."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from solver.catalog import load_cell
from solver.io.ls_findings import FindingKind
from solver.io.ls_program_set import program_set
from solver.io.ls_reader import read_program
from solver.model.program import JointProgram
from solver.pipeline.planning import plan
from solver.pipeline.program_check import check_program, inspect_moves, inspect_program
from solver.pipeline.programming import (
    ProgramOrder,
    draft_program,
    ordered_program,
    write_program,
)
from solver.units import DEG

DOCS = Path(__file__).parents[1] / "docs"
PAGE = (DOCS / "robot_program.md").read_text("utf-8")


def rows() -> dict[str, tuple[str, str]]:
    """What the table says of each check, and the limit that it states."""
    found = {}
    for line in PAGE.split("| check | what it says |")[1].split("\n\n")[0].splitlines()[2:]:
        names, meaning, limit, _ = (cell.strip() for cell in line.strip("|").split("|"))
        found |= dict.fromkeys(re.findall("`(.+?)`", names), (meaning, limit))
    return found


def documented() -> set[str]:
    return set(rows())


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """The checks of the default cell's and the zig-zag's programs, as they were written."""
    folder = tmp_path_factory.mktemp("programs")
    checks = {}
    for cell in ("groove_hw300", "zigzag_hw250"):
        result = plan(load_cell(cell))
        checks[cell] = write_program(result, folder / "CHECKED.LS").checks
    return checks


@pytest.fixture(scope="module")
def special():
    """Checks that a sound program of a plain cell does not meet."""
    problem = load_cell("groove_hw300")
    steps = replace(problem.settings.steps, joints=np.full(6, 20.0 * DEG))
    bounded = replace(problem, settings=replace(problem.settings, steps=steps))
    program = ordered_program(plan(bounded), "STEPS", ProgramOrder())
    short: JointProgram = replace(program, moves=program.moves[:1])
    moved = replace(problem, program=replace(problem.program, offset=5))
    ((name, text),) = draft_program(plan(moved), ProgramOrder(post="fanuc-cartesian")).files
    accepted = text.replace("!verify in T1", "!ACCEPTED CLEARANCE 10.000 MM")
    return [
        *check_program(moved, read_program(accepted, name), 0.05),
        *inspect_moves(bounded, program, 0.05).checks,
        *inspect_moves(bounded, short, 0.05).checks,
    ]


def test_every_check_of_a_written_program_is_documented(written):
    for cell, checks in written.items():
        undocumented = [check.name for check in checks if check.name not in documented()]
        assert not undocumented, cell


def test_every_documented_check_exists(written, special):
    names = {check.name for checks in (*written.values(), special) for check in checks}
    assert {"motion", "steps"} <= names
    assert documented() == names


def test_documented_limits_are_those_of_the_checks(written, special):
    stated = {name: re.match(r"`([0-9.]+)`", limit) for name, (_, limit) in rows().items()}
    fixed = {name: float(found[1]) for name, found in stated.items() if found}
    assert len(fixed) > 15
    for checks in (*written.values(), special):
        for check in checks:
            if check.name in fixed:
                assert check.limit == pytest.approx(fixed[check.name]), check.name


def test_documented_assumptions_are_those_of_the_checks(written):
    for check in written["zigzag_hw250"]:
        if check.assumed:
            assert "**assumed**" in rows()[check.name][0].lower(), check.name


def test_a_program_that_cannot_be_followed_shows_no_further_checks():
    problem = load_cell("groove_hw300")
    joints = "J1= 0 deg, J2= 0 deg, J3= 0 deg, J4= 0 deg, J5= -90 deg, J6= 0 deg"
    lines = ["/PROG A", "/ATTR", "/MN", "1: JMP LBL[1] ;", "2:J P[1] 10% FINE ;", "/POS"]
    lines += ["P[1]{", "GP1:", "UF : 1, UT : 1,", joints, "};", "/END", ""]
    text = "\n".join(lines)
    report = inspect_program(problem, program_set([read_program(text, "A.LS")]), 0.05)
    assert "program flow" in [check.name for check in report.failed]
    assert {check.name for check in report.checks} <= documented()
    assert "clearance" not in [check.name for check in report.checks]


def test_every_finding_of_the_interpreter_is_documented():
    page = (DOCS / "fanuc_ls.md").read_text("utf-8")
    table = page.split("| finding | what it is |")[1].split("\n\n")[0]
    named = {line.split("|")[1].strip() for line in table.splitlines()[2:]}
    assert named == {kind.value for kind in FindingKind}
