"""Programs that were really planned and written, and faults to put into their text."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path

from solver.analysis.check import Check
from solver.analysis.result import PlanningResult
from solver.catalog import load_cell
from solver.io.ls_reader import read_program
from solver.model.problem import PlanningProblem
from solver.pipeline.planning import plan
from solver.pipeline.program_check import check_program
from solver.pipeline.programming import ProgramOrder, write_program
from solver.pipeline.remarks import required_clearance

JOINT, CARTESIAN = "fanuc-joint", "fanuc-cartesian"

ANY_CHANGE = frozenset({"hash", "cell digest"})
"""Checks that notice any change of the text or the cell, whatever it does."""

_POSITION = r"P\[{number}\]\{{\r\n   GP1:\r\n.*?\r\n\}};\r\n"
_JOINT = re.compile(r"J(\d)=(.{10}) deg")
_VALUE = re.compile(r"([XYZWPR]) =(.{10})( +(?:mm|deg))")


@cache
def planned(cell: str) -> PlanningResult:
    """The plan of a shipped cell, once for all tests of a run."""
    return plan(load_cell(cell))


@cache
def written(cell: str, post: str = JOINT) -> str:
    """The text of a shipped cell's program, written through all checks."""
    result = planned(cell)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / file_of(cell)
        write_program(result, path, ProgramOrder(post=post))
        return path.read_bytes().decode("ascii")


def file_of(cell: str) -> str:
    """The name of the file in which a cell's program belongs."""
    return f"{planned(cell).problem.program.name}.LS"


def checks_of(
    problem: PlanningProblem, text: str, file: str | None = None, least: float | None = None
) -> tuple[Check, ...]:
    """All checks of a text, in the file of its cell's program."""
    read = read_program(text, file or f"{problem.program.name}.LS")
    return check_program(
        problem, read, required_clearance(problem, read) if least is None else least
    )


def failed(
    problem: PlanningProblem, text: str, file: str | None = None, least: float | None = None
) -> set[str]:
    """Names of the failed checks, without those that notice any change at all."""
    checks = checks_of(problem, text, file, least)
    return {check.name for check in checks if not check.passed} - ANY_CHANGE


def check_named(name: str, checks: Sequence[Check]) -> Check:
    """The only check of a name."""
    (one,) = [check for check in checks if check.name == name]
    return one


def edited(text: str, old: str, new: str) -> str:
    """The text with its first `old` replaced, which must be there."""
    assert old in text, old
    return text.replace(old, new, 1)


def line_to(text: str, number: int) -> str:
    """The program line, with its end, that moves to a position."""
    (line,) = re.findall(rf"^ *\d+:[JLC] P\[{number}\] .*;\r\n", text, re.M)
    return line


def position(text: str, number: int) -> str:
    """The whole entry of a position in /POS."""
    (entry,) = re.findall(_POSITION.format(number=number), text, re.S)
    return entry


def without_move(text: str, number: int) -> str:
    """The text without a position and the line that moves to it."""
    return without_line(edited(text, position(text, number), ""), number)


def without_line(text: str, number: int) -> str:
    """The text without the line that moves to a position, which stays in /POS."""
    return edited(text, line_to(text, number), "")


def with_line(text: str, number: int, change: Callable[[str], str]) -> str:
    """The text with the line that moves to a position changed."""
    line = line_to(text, number)
    other = change(line)
    assert other != line
    return edited(text, line, other)


def with_speed(text: str, number: int, speed: str, letter: str | None = None) -> str:
    """The text with another speed, and motion type, of the line that moves to a position."""

    def change(line: str) -> str:
        return re.sub(
            rf"([JL]) P\[{number}\] \S+",
            lambda one: f"{letter or one[1]} P[{number}] {speed}",
            line,
        )

    return with_line(text, number, change)


def with_joints(text: str, number: int, change: Callable[[list[float]], Sequence[float]]) -> str:
    """The text with the six joints [deg] of a position changed."""
    entry = position(text, number)
    joints = iter(change([float(value) for _, value in _JOINT.findall(entry)]))
    return edited(text, entry, _JOINT.sub(lambda one: f"J{one[1]}={next(joints):10.3f} deg", entry))


def with_value(text: str, number: int, axis: str, change: Callable[[float], float]) -> str:
    """The text with one of X Y Z [mm] W P R [deg] of a position changed."""

    def rewrite(one: re.Match[str]) -> str:
        value = change(float(one[2])) if one[1] == axis else float(one[2])
        return f"{one[1]} ={value:10.3f}{one[3]}"

    entry = position(text, number)
    return edited(text, entry, _VALUE.sub(rewrite, entry))


def joint_off(joint: int, by: float) -> Callable[[list[float]], list[float]]:
    """Adds to one joint (1 to 6) an angle [deg]."""
    return lambda joints: [
        value + by * (index == joint) for index, value in enumerate(joints, start=1)
    ]
