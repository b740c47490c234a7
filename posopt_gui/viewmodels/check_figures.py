"""Values and limits of the checks as the window says them."""

from __future__ import annotations

import math
from collections.abc import Callable

Translate = Callable[..., str]


def check_figure(figure: str, unit: str, tr: Translate) -> str:
    """A figure of a check with its unit; what follows a degree sign stands apart."""
    degrees, found, words = unit.partition("deg")
    if found and not degrees:
        shown = tr(unit) if words else "°"
        return f"{figure}{shown}" if shown.startswith("°") else f"{figure}°{words}"
    return f"{figure} {tr(unit)}"


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
        return f"{value:.1e}"
    decimals = 1 if size >= 100.0 else 2 if size >= 1.0 else 4
    text = f"{value:.{decimals + more}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text
