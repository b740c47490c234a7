"""Numbers, names and texts as a FANUC controller writes them; whatever would break is refused."""

from __future__ import annotations

import math
import re
import unicodedata
from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal
from numbers import Integral
from typing import Final

from solver.errors import ModelError
from solver.model.program import JOINT_DECIMALS
from solver.model.program_names import is_device_name
from solver.units import MM_PER_M

REMARK_LENGTH: Final = 32
COMMENT_LENGTH: Final = 16

LARGEST_ANGLE: Final = 9_999.999
"""Largest joint value that the field of ten characters is used for [deg]."""

LARGEST_LENGTH: Final = 99_999.999
"""Largest coordinate that the field of ten characters holds with its sign [mm]."""

SLOWEST: Final = 1
FASTEST: Final = 2_000
"""Smallest and largest TCP speed of a linear move [mm/s]."""

SPEED_STEP: Final = Decimal("0.1")
"""Step in which a TCP speed is written [mm/s]."""

SPEED_SLACK: Final = Decimal("1e-9")
"""How far a TCP speed may lie below its step and still be meant as that step [mm/s].

It is what metres per second in binary cost, and no more.
"""

LONGEST_MOVE: Final = 32_000
"""Longest motion time that can be given in milliseconds [ms]."""

LONGEST_DWELL: Final = Decimal("327.67")
"""Longest WAIT: controllers count hundredths of a second in 16 bits [s]."""

_NAME: Final = re.compile(r"[A-Z][A-Z0-9_]*")
_BREAKING: Final = frozenset(';"')


def angle_text(degrees: float) -> str:
    """Return `degrees` with three decimals, no zero before the point, and never '-0.000'."""
    return _field("a joint value", degrees, LARGEST_ANGLE, "deg")


def length_text(millimetres: float) -> str:
    """Return a coordinate [mm] in the same form as an angle."""
    return _field("a coordinate", millimetres, LARGEST_LENGTH, "mm")


def _field(what: str, value: float, largest: float, unit: str) -> str:
    if not abs(value) <= largest:
        raise ModelError(f"{what} must lie within +-{largest:.3f} {unit}, got {value:g}")
    text = f"{abs(value):.{JOINT_DECIMALS}f}"
    if float(text) == 0.0:
        return text
    sign = "-" if value < 0.0 else ""
    return sign + text.removeprefix("0")


def speed_text(speed: float) -> str:
    """Return a TCP speed [m/s] in mm/s: whole where it is, else one decimal, rounded down.

    Rounded down, so that the tool is never faster than asked; a speed that is a tenth but for
    what binary numbers cost is that tenth.
    """
    millimetres = _decimal(speed) * 1000 if math.isfinite(speed) else Decimal(0)
    steps = ((millimetres + SPEED_SLACK) / SPEED_STEP).to_integral_value(ROUND_FLOOR)
    posted = steps * SPEED_STEP
    if not SLOWEST <= posted <= FASTEST:
        raise ModelError(
            f"the TCP speed of a linear move is {SLOWEST} to {FASTEST} mm/s on the controller, "
            f"got {speed * MM_PER_M:g} mm/s"
        )
    return f"{posted:.0f}" if posted == int(posted) else f"{posted:.1f}"


def percent_text(percent: float) -> str:
    """Return a share of the joint speed, which a controller takes in whole percent."""
    whole = int(percent) if math.isfinite(percent) and percent == int(percent) else percent
    return str(whole_number("a joint speed in percent", whole, 1, 100))


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
    if is_device_name(name):
        raise ModelError(
            "a program name is no device of Windows (CON, PRN, AUX, NUL, COM1, LPT1 ...), where no "
            f"file can be called so, got {name!r}"
        )
    if len(name) > longest:
        raise ModelError(
            f"the program name {name[:50]!r} has {len(name)} characters, the controller takes "
            f"{longest}"
        )
    return name


def plain_text(what: str, text: str, longest: int) -> str:
    """Return `text` if it cannot break the file: short, printable ASCII, no ; or quote."""
    _check_characters(what, text)
    if len(text) > longest:
        raise ModelError(f"{what} has at most {longest} characters, got {len(text)}: {text[:50]!r}")
    if text.endswith(" "):
        raise ModelError(f"{what} must not end with a space, got {text!r}")
    return text


def stamped(prefix: str, text: str, longest: int = REMARK_LENGTH) -> tuple[str, ...]:
    """Break a text into remarks that all begin with `prefix`; no character is lost.

    What follows the prefixes, joined, is the text again. A remark cannot end with a space, so a
    space at which the text is broken begins the next remark; an empty text gives none.

    Raises
    ------
    ModelError
        When the text holds what a remark cannot (foreign letters, ; or a quote), ends with a
        space or has so many spaces in a row that a remark would hold nothing else.
    """
    _check_characters("a remark", prefix + text)
    room = longest - len(prefix)
    if room < 1:
        raise ModelError(f"the beginning {prefix[:50]!r} leaves no room in a remark of {longest}")
    remarks = []
    rest = text
    while rest:
        piece = rest[:room].rstrip(" ")
        if not piece:
            raise ModelError(
                f"a text for remarks ends with a space or has {room} spaces in a row: {text[:50]!r}"
            )
        if len(rest) <= room and piece != rest:
            raise ModelError(f"a text for remarks must not end with a space, got {text[-50:]!r}")
        remarks.append(prefix + piece)
        rest = rest[len(piece) :]
    return tuple(remarks)


def _check_characters(what: str, text: str) -> None:
    for column, character in enumerate(text, start=1):
        if " " <= character <= "~" and character not in _BREAKING:
            continue
        where = f"{character!r} at character {column} of {text[:50]!r}"
        if unicodedata.name(character, "").startswith("CJK"):
            raise ModelError(
                f"{what} cannot hold Chinese characters, since the controller reads printable "
                f"ASCII alone; write it in Latin letters (pinyin), got {where}"
            )
        raise ModelError(f'{what} takes printable ASCII without ; and ", got {where}')


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
