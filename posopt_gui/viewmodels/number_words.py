"""Numbers and names of bodies as the window says them."""

from __future__ import annotations

import math
import re
from collections.abc import Callable

from solver.analysis.check import down_mm

Translate = Callable[..., str]

NOTHING = "–"
"""Stands for a value that there is none of."""

_JOINTS = re.compile(r"J\d")
_PART = re.compile(r"(?P<group>.+) \((?P<part>.+)\)")
_NEGATIVE_ZERO = re.compile(r"(?<![\w.])-(0(?:\.0+)?)(?![\d.]*[1-9])(?![\w])")
_DEGREES = re.compile(r"(?<=\d) deg\b")
_NUMBERED = re.compile(r"(?P<name>.+)_(?P<number>\d+)")


def decimal(value: float, decimals: int) -> str:
    """A number with a true minus; a dash where it is not finite."""
    return copied_decimal(value, decimals).replace("-", "−")


def copied_decimal(value: float, decimals: int) -> str:
    """A number as other programs read it, never a negative zero; a dash where it is not finite."""
    if not math.isfinite(value):
        return NOTHING
    return f"{round(value, decimals) + 0.0:.{decimals}f}"


def in_figures(value: float, figures: int = 10) -> str:
    """A number in its own figures, as many as it needs; never a negative zero."""
    return f"{value + 0.0:.{figures}g}"


def with_unit(number: str, unit: str) -> str:
    """A number with its unit, which a degree sign follows without a blank; '' for none."""
    if unit == "deg":
        return f"{number}°"
    return f"{number} {unit}" if unit else number


def plain_words(text: str) -> str:
    """Numbers of a sentence as the window says them: no negative zero, and ° for deg."""
    return _DEGREES.sub("°", _NEGATIVE_ZERO.sub(r"\1", text))


def signed(value: float, decimals: int) -> str:
    """A number with its sign, zero without."""
    if not math.isfinite(value):
        return NOTHING
    rounded = round(value, decimals) + 0.0
    words = f"{rounded:+.{decimals}f}" if rounded else f"{rounded:.{decimals}f}"
    return words.replace("-", "−")


def clearance_mm(clearance: float) -> str:
    """A clearance [m] in mm without its unit, rounded down, so that it is never over-stated."""
    return decimal(down_mm(clearance), 1)


def body_words(name: str, translate: Translate) -> str:
    """What a body is called: 'forearm (forearm_hub)' is the forearm hub."""
    found = _PART.fullmatch(name)
    part = found["part"] if found else name
    numbered = _NUMBERED.fullmatch(part)
    if numbered:
        return f"{translate(numbered['name'].replace('_', ' '))} {numbered['number']}"
    return translate(part.replace("_", " "))


def pair_words(one: str, other: str, translate: Translate) -> str:
    """Who against whom."""
    return translate(
        "{one} against {other}", one=body_words(one, translate), other=body_words(other, translate)
    )


def subject_words(subject: str, translate: Translate) -> str:
    """The subject of a filter: a joint, or two bodies."""
    if _JOINTS.match(subject):
        return subject.split(" ", maxsplit=1)[0]
    one, found, other = subject.partition(" and ")
    return pair_words(one, other, translate) if found else body_words(subject, translate)
