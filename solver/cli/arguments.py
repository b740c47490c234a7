"""Arguments of the command line: strict numbers, and errors of one line."""

from __future__ import annotations

import argparse
import math
import re
from dataclasses import replace
from typing import TYPE_CHECKING, NoReturn

from solver.errors import InputError
from solver.units import MM

if TYPE_CHECKING:
    from solver.model.problem import PlanningProblem

_NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?", re.ASCII)


LARGEST = 1e6
"""Largest millimetres or degrees that are taken."""


class ExactParser(argparse.ArgumentParser):
    """A parser that takes options only by their full names and answers in one line."""

    def __init__(self, *args: object, **kwargs: object) -> None:
        kwargs["allow_abbrev"] = False
        super().__init__(*args, **kwargs)  # type: ignore[arg-type]
        # Lists such as -45,40,... are values, not options.
        self._negative_number_matcher = re.compile(r"^-\.?\d")

    def error(self, message: str) -> NoReturn:
        """Print one line to stderr and leave with exit code 2."""
        self.exit(2, f"{self.prog}: {message} (see {self.prog} --help)\n")


def number(text: str, what: str) -> float:
    """A finite decimal number of plain ASCII digits."""
    if not _NUMBER.fullmatch(text.strip()):
        raise InputError(f"{what}: expected a number, got {text.strip()!r}")
    value = float(text)
    if not math.isfinite(value):
        raise InputError(f"{what}: {text.strip()} is too large")
    if abs(value) > LARGEST:
        raise InputError(f"{what}: {text.strip()} is beyond {LARGEST:g}, the largest that is taken")
    return value


def six_numbers(text: str, what: str) -> tuple[float, ...]:
    """Six numbers separated by commas."""
    parts = text.split(",")
    if len(parts) != 6:
        raise InputError(f"{what}: expected six numbers separated by commas, got {len(parts)}")
    return tuple(number(part, f"{what}, value {i}") for i, part in enumerate(parts, start=1))


def positive_number(text: str, what: str) -> float:
    """A finite decimal number above zero."""
    value = number(text, what)
    if value <= 0.0:
        raise InputError(f"{what}: expected a number above zero, got {text.strip()}")
    return value


def add_resample(parser: argparse.ArgumentParser) -> None:
    """Declare --resample, which `resampled` takes."""
    parser.add_argument(
        "--resample",
        metavar="MM",
        help="put waypoints along the path so that neighbours are at most MM mm apart",
    )


def resampled(problem: PlanningProblem, step: str | None) -> PlanningProblem:
    """The problem with waypoints at most `step` mm apart; None keeps its own."""
    if step is None:
        return problem
    from solver.io.importers import resample

    length = positive_number(step, "--resample") * MM
    return replace(problem, toolpath=resample(problem.toolpath, length))
