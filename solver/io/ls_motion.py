"""A motion instruction of an .LS file."""

from __future__ import annotations

import re
from typing import Final

from solver.io.ls_program import Motion, Speed
from solver.io.ls_scanner import Scanner, SourceText

# A line break inside an instruction is followed by a colon: the line continues.
_BLANK: Final = re.compile(r"[ \t]*(?:\n[ \t]*:[ \t]*)*")
_LETTER: Final = re.compile(r"([JLCAS])[ \t]")
_ATTEMPT: Final = re.compile(r"([A-Za-z])[ \t]*@?PR?[ \t]*\[")
_TARGET: Final = re.compile(
    r"@?(?:P\[[ \t]*(?P<number>[0-9]{1,5})[ \t]*(?::[^\]\n]*)?\]"
    r"|P\[[ \t]*A?R\[[^\]\n]*\][^\]\n]*\]|PR\[[ \t]*A?R\[[^\]\n]*\][^\]\n]*\]|PR\[[^\]\n]*\])"
)
_SPEED: Final = re.compile(
    r"(?:(?P<value>[0-9]{1,6}(?:\.[0-9]{0,4})?|\.[0-9]{1,4})|A?R\[[^\]\n]*\])[ \t]*"
    r"(?P<unit>%|mm/se[ck]|cm/min|inch/min|deg/se[ck]|se[ck]|mse[ck])(?=[ \t\n]|$)"
    r"|(?P<word>max_speed|max_Geschw\.|WELD_SPEED)(?=[ \t\n]|$)",
    re.ASCII,
)
_TERMINATION: Final = re.compile(
    r"(?P<fine>FINE)(?=[ \t\n]|$)|CNT[ \t]*(?:(?P<cnt>[0-9]{1,3})(?=[ \t\n]|$)|A?R\[[^\]\n]*\])"
    r"|(?P<corner>C[RD])[ \t]*(?:[0-9]{1,4}(?:,[0-9]{1,4})?(?=[ \t\n]|$)|A?R\[[^\]\n]*\])"
)
_OPTION: Final = re.compile(r"(?:[^\s\[\]]|\[[^\]\n]*\])+")
_NESTED_MOTION: Final = re.compile(r"[JLCAS]$|@?P\[")


def looks_like_motion(text: str) -> bool:
    """Whether an instruction's text begins as a motion does, however badly it goes on."""
    return _ATTEMPT.match(text) is not None


def read_motion(
    source: SourceText, start: int, end: int, uframe: int | None, utool: int | None
) -> Motion:
    """Read the motion between two offsets; `uframe` and `utool` are selected there."""
    scanner = Scanner(source, start, end, _BLANK)
    scanner.skip()
    begin = scanner.offset
    letter = scanner.need(_LETTER, "a motion letter J, L, C, A or S before the position")[1]
    found = [_target(scanner)]
    if letter == "C":
        found.append(_target(scanner))
    numbers = tuple(int(one["number"]) for one in found if one["number"] is not None)
    speed = _speed(scanner, letter)
    termination = scanner.need(_TERMINATION, "FINE or CNT0 to CNT100 after the speed")
    cnt = None if termination["cnt"] is None else int(termination["cnt"])
    if cnt is not None and cnt > 100:
        raise scanner.error(f"CNT is 0 to 100, got {cnt}", termination.start())
    return Motion(
        letter=letter,
        positions=numbers if len(numbers) == len(found) else (),
        targets=tuple(one[0] for one in found),
        speed=speed,
        termination=termination["fine"] or (termination[0] if termination["corner"] else "CNT"),
        cnt=cnt,
        options=_options(scanner),
        uframe=uframe,
        utool=utool,
        place=source.place(begin),
    )


def _target(scanner: Scanner) -> re.Match[str]:
    return scanner.need(_TARGET, "a position such as P[1]")


def _speed(scanner: Scanner, letter: str) -> Speed:
    found = scanner.need(_SPEED, "a speed such as 20% or 250mm/sec")
    if found["word"] is not None:
        return Speed(None, found["word"], found[0])
    # German controllers write sek.
    unit = found["unit"].replace("sek", "sec")
    if (letter == "J") != (unit == "%") and unit not in {"sec", "msec"}:
        raise scanner.error(f"a {letter} move takes no speed in {unit}", found.start())
    if found["value"] is None:
        return Speed(None, unit, found[0])
    value = float(found["value"])
    if value <= 0.0 or (unit == "%" and value > 100.0):
        raise scanner.error(f"the speed {found[0]} is out of range", found.start())
    return Speed(value, unit, found[0])


def _options(scanner: Scanner) -> tuple[str, ...]:
    options = []
    while not scanner.at_end():
        option = scanner.need(_OPTION, "a motion option")
        if _NESTED_MOTION.match(option[0]):
            raise scanner.error(
                "a second motion in one instruction: a ';' is missing before it", option.start()
            )
        options.append(option[0])
    return tuple(options)
