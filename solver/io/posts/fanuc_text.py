"""Numbers, names and texts as a FANUC controller writes them; whatever would break is refused."""

from __future__ import annotations

import math
import re
import unicodedata
from decimal import ROUND_CEILING, Decimal
from numbers import Integral
from typing import Final

from solver.errors import ModelError
from solver.model.program import JOINT_DECIMALS

REMARK_LENGTH: Final = 32
COMMENT_LENGTH: Final = 16

LARGEST_ANGLE: Final = 9_999.999
"""Largest joint value that the field of ten characters is used for [deg]."""

LONGEST_MOVE: Final = 32_000
"""Longest motion time that can be given in milliseconds [ms]."""

LONGEST_DWELL: Final = Decimal("327.67")
"""Longest WAIT: controllers count hundredths of a second in 16 bits [s]."""

_NAME: Final = re.compile(r"[A-Z][A-Z0-9_]*")
_BREAKING: Final = frozenset(';"')


def angle_text(degrees: float) -> str:
    """Return `degrees` with three decimals, no zero before the point, and never '-0.000'."""
    if not abs(degrees) <= LARGEST_ANGLE:
        raise ModelError(f"a joint value must lie within +-{LARGEST_ANGLE:g} deg, got {degrees:g}")
    text = f"{abs(degrees):.{JOINT_DECIMALS}f}"
    if float(text) == 0.0:
        return text
    sign = "-" if degrees < 0.0 else ""
    return sign + text.removeprefix("0")


def milliseconds(duration: float) -> int:
    """Return a duration [s] as whole milliseconds, rounded up so that no speed is exceeded.

    The shortest decimal that denotes the number decides: 0.28 s is 280 ms, although the binary
    number lies a hair above it.
    """
    if not math.isfinite(duration) or duration <= 0.0:
        raise ModelError(f"the duration of a move must be positive and finite, got {duration:g} s")
    whole = int((_decimal(duration) * 1000).to_integral_value(ROUND_CEILING))
    if whole > LONGEST_MOVE:
        raise ModelError(
            f"a move lasts at most {LONGEST_MOVE} ms on the controller, got {duration:g} s; "
            "add waypoints or a higher speed"
        )
    return whole


def dwell_text(seconds: float) -> str:
    """Return a dwell [s] in hundredths, rounded up, without a zero before the point."""
    if not math.isfinite(seconds) or seconds <= 0.0:
        raise ModelError(f"a dwell must be positive and finite, got {seconds:g} s")
    hundredths = _decimal(seconds).quantize(Decimal("0.01"), ROUND_CEILING)
    if hundredths > LONGEST_DWELL:
        raise ModelError(f"a dwell lasts at most {LONGEST_DWELL} s, got {seconds:g} s")
    return f"{hundredths:f}".removeprefix("0")


def _decimal(value: float) -> Decimal:
    return Decimal(repr(float(value)))


def whole_number(what: str, value: object, low: int, high: int) -> int:
    """Return `value` if it is an integer from `low` to `high`, or refuse it by name."""
    if isinstance(value, Integral) and not isinstance(value, bool) and low <= int(value) <= high:
        return int(value)
    raise ModelError(f"{what} must be a whole number from {low} to {high}, got {value!r}")


def program_name(name: str, longest: int) -> str:
    """Return `name` if a controller takes it: A-Z, 0-9 and _, a letter first, upper case."""
    if not _NAME.fullmatch(name):
        raise ModelError(
            f"a program name has upper-case letters A-Z, digits and _, and begins with a letter, "
            f"got {name[:50]!r}"
        )
    if len(name) > longest:
        raise ModelError(
            f"the program name {name[:50]!r} has {len(name)} characters, the controller takes "
            f"{longest}"
        )
    return name


def plain_text(what: str, text: str, longest: int) -> str:
    """Return `text` if it cannot break the file: short, printable ASCII, no ; or quote."""
    for column, character in enumerate(text, start=1):
        if not " " <= character <= "~" or character in _BREAKING:
            raise ModelError(
                f'{what} takes printable ASCII without ; and ", got {character!r} at character '
                f"{column} of {text[:50]!r}"
            )
    if len(text) > longest:
        raise ModelError(f"{what} has at most {longest} characters, got {len(text)}: {text[:50]!r}")
    if text.endswith(" "):
        raise ModelError(f"{what} must not end with a space, got {text!r}")
    return text


def ascii_remark(text: str, longest: int = REMARK_LENGTH) -> str:
    """Return any text as a remark: accents dropped, foreign characters as '?', cut to length.

    ';' becomes ',', a quote becomes an apostrophe, and runs of blanks and control characters
    become one space. The result always passes :func:`plain_text`.
    """
    text = text.replace(";", ",").replace('"', "'")
    letters = (one for one in unicodedata.normalize("NFKD", text) if not unicodedata.combining(one))
    spaced = "".join(" " if unicodedata.category(one)[0] in "ZC" else one for one in letters)
    plain = "".join(one if " " <= one <= "~" else "?" for one in " ".join(spaced.split()))
    # Compatibility forms may have brought the two characters back.
    return plain.replace(";", ",").replace('"', "'")[:longest].rstrip()
