"""Values and limits of the checks as the window says them."""

from __future__ import annotations

import math
from collections.abc import Callable

Translate = Callable[..., str]

ABOUT_CLEARANCE = ("clearance", "net margin", "near and contact bodies", "robot against itself")
ABOUT_PLACES = ("path", "tool angles", "links", "lifts", "linear moves", "lean ", "lead r", "spin ")
ABOUT_SPEEDS = ("feed", "lead speed", "link speed", "joint speed", "steps")
ABOUT_FILE = (
    "program name", "program flow", "cell digest", "hash", "stated", "accepted clearance",
    "frame and tool numbers", "position count",
)  # fmt: skip
"""Beginnings of the names of checks, from what matters most to a part to what the file is."""


def check_rank(name: str) -> int:
    """Place of a check in a list: clearance, between positions, path, feed, others, the file."""
    groups = (ABOUT_CLEARANCE, ("between positions",), ABOUT_PLACES, ABOUT_SPEEDS)
    if name.startswith(ABOUT_FILE):
        return len(groups) + 1
    found = (place for place, group in enumerate(groups) if name.startswith(group))
    return next(found, len(groups))


def check_figure(figure: str, unit: str, tr: Translate) -> str:
    """A figure of a check with its unit; what follows a degree sign stands apart."""
    if unit == "mm" and figure.isdecimal():
        # Lengths have a decimal everywhere in the window.
        figure += ".0"
    degrees, found, words = unit.partition("deg")
    if found and not degrees:
        shown = tr(unit) if words else "°"
        return f"{figure}{shown}" if shown.startswith("°") else f"{figure}°{words}"
    return f"{figure} {tr(unit).replace('^3', '³')}"


def figures(value: float, limit: float) -> tuple[str, str]:
    """A value and its limit in few figures, but as many as tell them apart."""
    for more in range(8):
        shown, bound = number(value, more), number(limit, more)
        if shown != bound or value == limit:
            break
    return shown, bound


def number(value: float, more: int = 0) -> str:
    """A value of a check in few figures, and `more` decimals; what is not known is a dash."""
    if math.isnan(value):
        return "\N{EN DASH}"
    if math.isinf(value):
        return "\N{INFINITY}" if value > 0.0 else "-\N{INFINITY}"
    size = abs(value)
    if 0.0 < size < 0.001:
        # What is less than nothing, or is to be told from its limit, keeps its figures.
        return "<0.001" if value > 0.0 and not more else f"{value:.1e}"
    decimals = 1 if size >= 100.0 else 2 if size >= 1.0 else 4
    text = f"{value:.{decimals + more}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text
