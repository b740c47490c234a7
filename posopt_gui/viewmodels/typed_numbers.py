"""What a person types into a field for a number: the number, or why it is none."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

Translate = Callable[..., str]

LIMIT: Final = 1e9
"""Magnitudes beyond this are refused."""

_NUMBER: Final = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?", re.IGNORECASE)
_THOUSANDS: Final = re.compile(r"[+-]?[1-9]\d{0,2},\d{3}")
"""A comma that may stand for thousands as well as for decimals."""


@dataclass(frozen=True, slots=True)
class Refusal:
    """A typed text that is not taken: as it was typed, and whether it is a number too large."""

    text: str
    too_large: bool = False


def read_number(text: str) -> float | Refusal:
    """Read a number with a point or a comma for its decimals; nothing is guessed.

    A comma before exactly three digits could mean thousands, and is refused. Wide digits of a
    Chinese keyboard and a true minus are read as their plain ones.
    """
    plain = unicodedata.normalize("NFKC", text.strip()).replace("−", "-")
    if plain.count(",") == 1 and not _THOUSANDS.fullmatch(plain) and "." not in plain:
        plain = plain.replace(",", ".")
    if not _NUMBER.fullmatch(plain):
        return Refusal(text)
    number = float(plain)
    return number if abs(number) <= LIMIT else Refusal(text, too_large=True)


def refusal_words(refusal: Refusal, bounds: str, translate: Translate, unit: str = "") -> str:
    """Why a text is not taken; `bounds` is the range of its field in words, '' for none."""
    if not refusal.too_large:
        words = "{text} is not taken; write 1000.5: a point for decimals, no separators."
        return translate(words, text=refusal.text)
    if not bounds:
        bounds = translate("Up to {high}{unit} either way", high=f"{LIMIT:,.0f}", unit=unit)
    words = "{text} is not taken, it is out of range. {range}."
    return translate(words, text=refusal.text, range=bounds)
