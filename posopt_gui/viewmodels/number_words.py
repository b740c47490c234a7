"""Numbers and names of bodies as the window says them."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable
from functools import reduce

from solver.analysis.check import down_mm

Translate = Callable[..., str]

NOTHING = "–"
"""Stands for a value that there is none of."""

_JOINTS = re.compile(r"J\d")
_PART = re.compile(r"(?P<group>.+) \((?P<part>.+)\)")
_NEGATIVE_ZERO = re.compile(r"(?<![\w.])-(0(?:\.0+)?)(?![\d.]*[1-9])(?![\w])")
_DEGREES = re.compile(r"(?<=\d) deg\b")
_MINUS = re.compile(r"(?<![^\s(])-(?=\d)")
_EITHER = re.compile(r"\+-(?=\d)")
_NUMBERED = re.compile(r"(?P<name>.+)_(?P<number>\d+)")

_TRADE_WORDS = {
    "flange_top": "upper flange",
    "flange_bottom": "lower flange",
    "fillet_top_left": "upper left fillet",
    "fillet_top_right": "upper right fillet",
    "fillet_bottom_left": "lower left fillet",
    "fillet_bottom_right": "lower right fillet",
}
"""What the trade calls a group, where it is not the group's own name."""


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


def typeset(text: str) -> str:
    """The same with a true minus and ±, as in all numbers that are read and not typed."""
    return _MINUS.sub("−", _EITHER.sub("±", plain_words(text)))


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


def group_words(name: str) -> str:
    """A group of bodies in English words: 'flange_top' is the upper flange."""
    return _TRADE_WORDS.get(name, name.replace("_", " "))


def body_words(name: str, translate: Translate) -> str:
    """What a body is called: 'forearm (forearm_hub)' is the forearm hub."""
    found = _PART.fullmatch(name)
    part = found["part"] if found else name
    numbered = _NUMBERED.fullmatch(part)
    if numbered:
        return f"{translate(group_words(numbered['name']))} {numbered['number']}"
    return translate(group_words(part))


def pair_words(one: str, other: str, translate: Translate) -> str:
    """Who against whom."""
    return translate(
        "{one} against {other}", one=body_words(one, translate), other=body_words(other, translate)
    )


def listed(names: Iterable[str], translate: Translate) -> str:
    """Names one after the other, in the manner of the language."""
    return reduce(lambda one, other: translate("{one}, {other}", one=one, other=other), names)


def subject_words(subject: str, translate: Translate) -> str:
    """The subject of a filter: a joint, or two bodies."""
    if _JOINTS.match(subject):
        return subject.split(" ", maxsplit=1)[0]
    one, found, other = subject.partition(" and ")
    return pair_words(one, other, translate) if found else body_words(subject, translate)
