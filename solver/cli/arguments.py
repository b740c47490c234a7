"""Arguments of the command line: strict numbers, and errors of one line."""

from __future__ import annotations

import argparse
import math
import re
from typing import NoReturn

from solver.errors import InputError

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
