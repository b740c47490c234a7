"""How a motion of an .LS file goes: kind, speed, termination and options."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

from solver.io.ls_findings import FindingKind
from solver.io.ls_program import Motion
from solver.model.program import MotionKind, Speed
from solver.units import CM_PER_M, M_PER_INCH, MM_PER_M, MS_PER_S, S_PER_MIN

FASTEST_LINEAR: Final = 2.0
"""Stands for a TCP speed that is not known [m/s]: that of max_speed on common controllers."""

FASTEST_PERCENT: Final = 100.0
SLOWEST_PERCENT: Final = 1.0

WIDEST_CNT: Final = 100
"""Stands for a rounding that is not known."""

_UNITS: Final[Mapping[str, tuple[Callable[[float], Speed], float, float]]] = MappingProxyType(
    {
        "%": (Speed.percent, 1.0, 1.0),
        "mm/sec": (Speed.linear, 1.0, MM_PER_M),
        "cm/min": (Speed.linear, 1.0, CM_PER_M * S_PER_MIN),
        "inch/min": (Speed.linear, M_PER_INCH, S_PER_MIN),
        "sec": (Speed.duration, 1.0, 1.0),
        "msec": (Speed.duration, 1.0, MS_PER_S),
    }
)
"""How a speed is made of its number, and the number's factor and divisor.

A divisor of a whole number keeps 1235 msec the float nearest to 1.235 s.
"""

_OFFSET: Final = re.compile(r"Offset,PR\[[ \t]*([0-9]{1,4})[ \t]*(?::[^\]]*)?\]", re.ASCII)
_HARMLESS: Final = re.compile(r"ACC[ \t]*100", re.ASCII)
_RELATIVE: Final = re.compile(r"INC|Tool_Offset.*|VOFFSET.*|Offset.*", re.IGNORECASE)
_WITH_VALUE: Final = frozenset({"ACC", "CR", "CD", "Offset,", "Tool_Offset,", "Skip,", "TB", "TA"})


@dataclass(frozen=True, slots=True)
class Manner:
    """How a motion goes.

    Attributes
    ----------
    offset : bool
        Whether the expected position register is added to its target.
    displaced : bool
        Whether its target is somewhere else than its position says.
    problems : tuple of (kind, sentence)
        What cannot be followed.
    """

    kind: MotionKind
    speed: Speed
    cnt: int | None
    offset: bool
    displaced: bool
    problems: tuple[tuple[FindingKind, str], ...]


def manner(motion: Motion, offset: int | None) -> Manner:
    """Return how `motion` goes; `offset` is the position register that it may add, or None.

    What is not known is replaced by the fastest speed and the widest rounding, beside a problem.
    """
    problems: list[tuple[FindingKind, str]] = []
    kind = MotionKind.JOINT if motion.letter == "J" else MotionKind.LINEAR
    if motion.letter not in {"J", "L"}:
        problems.append(
            (
                FindingKind.MOTION,
                f"a {motion.letter} move, whose way is not straight, is not checked",
            )
        )
    if not motion.positions:
        problems.append(
            (
                FindingKind.TARGET,
                f"the move to {' '.join(motion.targets)} goes to a register, whose value the file "
                "does not hold",
            )
        )
    speed, problem = _speed(motion, kind)
    if problem:
        problems.append((FindingKind.SPEED, problem))
    cnt = motion.cnt
    if motion.termination != "FINE" and cnt is None:
        cnt = WIDEST_CNT
        problems.append(
            (
                FindingKind.TERMINATION,
                f"the rounding {motion.termination} is not known from the file",
            )
        )
    added, displaced = False, False
    for option in _options(motion):
        found = _OFFSET.fullmatch(option)
        if found is not None and offset is not None and int(found[1]) == offset:
            added = True
        elif not _HARMLESS.fullmatch(option):
            displaced = displaced or _RELATIVE.fullmatch(option) is not None
            problems.append(
                (FindingKind.OPTION, f"motion option {option!r} may change how or where it moves")
            )
    return Manner(kind, speed, cnt, added, displaced, tuple(problems))


def _options(motion: Motion) -> list[str]:
    """Return the options, a value that stands behind a blank joined to its word."""
    options: list[str] = []
    for part in motion.options:
        if options and options[-1] in _WITH_VALUE:
            options[-1] += part
        else:
            options.append(part)
    return options


def _speed(motion: Motion, kind: MotionKind) -> tuple[Speed, str]:
    """Return the speed and, where it is not the file's, why."""
    asked, value = motion.speed, motion.speed.value
    percent = kind is MotionKind.JOINT
    fastest = Speed.percent(FASTEST_PERCENT) if percent else Speed.linear(FASTEST_LINEAR)
    if value is None:
        return fastest, f"the speed {asked.text} is not known from the file"
    if asked.unit not in _UNITS:
        return fastest, f"the speed {asked.text} is one of the orientation, not of the TCP"
    if asked.unit == "%" and value < SLOWEST_PERCENT:
        slowest = Speed.percent(SLOWEST_PERCENT)
        return slowest, f"the speed {asked.text} is below {SLOWEST_PERCENT:g} %"
    make, factor, divisor = _UNITS[asked.unit]
    return make(value * factor / divisor), ""
