"""Numbers of path files: plain ASCII decimals and nothing that merely looks like one."""

from __future__ import annotations

import math
import re
from typing import Final

from solver.io.importers.naming import shown

_PLAIN: Final = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_DECIMAL_COMMA: Final = re.compile(r"[+-]?[0-9]+,[0-9]+(?:[eE][+-]?[0-9]+)?")
_NOT_FINITE: Final = re.compile(r"[+-]?(?:nan|inf|infinity)", re.IGNORECASE)
_LONGEST: Final = 64


def read_number(text: str) -> float:
    """Return the value of a plain ASCII decimal with an optional sign and exponent.

    Raises
    ------
    ValueError
        With a clause ('is ..., expected ...') that the caller puts behind the field's name.
    """
    if len(text) <= _LONGEST and _PLAIN.fullmatch(text):
        value = float(text)
        if math.isfinite(value):
            return value
        raise ValueError(f"is {shown(text)}, which overflows; expected a finite number")
    raise ValueError(f"is {_fault(text)}, expected a plain decimal number such as -12.5")


def _fault(text: str) -> str:
    if not text:
        return "empty"
    if _DECIMAL_COMMA.fullmatch(text):
        return f"{shown(text)} with a decimal comma (write a point)"
    if _NOT_FINITE.fullmatch(text):
        return f"{shown(text)}, which is not finite"
    return shown(text)
