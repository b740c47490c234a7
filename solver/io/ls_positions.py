"""The /POS section of an .LS file."""

from __future__ import annotations

import re
from typing import Final

from solver.io.ls_program import CARTESIAN_NAMES, Axis, GroupPosition, Position
from solver.io.ls_scanner import Scanner, SourceText

_BLANK: Final = re.compile(r"[ \t\n]*")
_HEAD: Final = re.compile(r"P[ \t]*\[[ \t]*([0-9]{1,5})[ \t]*")
_QUOTED_LABEL: Final = re.compile(r':[ \t]*"([^"\n]*)"')
_LABEL: Final = re.compile(r':([^\]"\n]*)')
_OPEN: Final = re.compile(r"\][ \t]*\{")
_CLOSE: Final = re.compile(r"\}[ \t]*;")
_GROUP: Final = re.compile(r"GP[ \t]*([1-8])[ \t]*:")
_FRAME: Final = re.compile(r"UF[ \t]*:[ \t]*([0-9]{1,3}|F)\b", re.ASCII)
_TOOL: Final = re.compile(r"UT[ \t]*:[ \t]*([0-9]{1,3}|F)\b", re.ASCII)
# German controllers write KONFIG and RX, RY, ...; an untaught position may have an empty CONFIG.
_CONFIG: Final = re.compile(r"[CK]ONFIG[ \t]*:[ \t]*'([^'\n]{0,40})'")
_COMMA: Final = re.compile(",")
_AXIS: Final = re.compile(r"(J[1-9]|E[1-9]|R?([XYZWPR]))[ \t]*=[ \t]*")
_VALUE: Final = re.compile(
    r"(?:(?P<number>[+-]?(?:[0-9]{1,9}(?:\.[0-9]{0,9})?|\.[0-9]{1,9}))|\*{1,20})"
    r"[ \t]*(?P<unit>deg|mm)\b",
    re.ASCII,
)

LARGEST_NUMBER: Final = 32_767


def read_positions(source: SourceText, start: int, end: int) -> dict[int, Position]:
    """Return the positions between two offsets by their numbers."""
    scanner = Scanner(source, start, end, _BLANK)
    positions: dict[int, Position] = {}
    while not scanner.at_end():
        begin = scanner.offset
        position = _position(scanner)
        if position.number in positions:
            first = positions[position.number].place.line
            raise scanner.error(
                f"P[{position.number}] is given twice, first in line {first}", begin
            )
        positions[position.number] = position
    return positions


def _position(scanner: Scanner) -> Position:
    scanner.skip()
    begin = scanner.offset
    number = int(scanner.need(_HEAD, "a position such as P[1]{")[1])
    if not 1 <= number <= LARGEST_NUMBER:
        raise scanner.error(f"positions are numbered 1 to {LARGEST_NUMBER}, got {number}", begin)
    label = scanner.take(_QUOTED_LABEL) or scanner.take(_LABEL)
    scanner.need(_OPEN, "']{' after the position's number")
    groups: list[GroupPosition] = []
    while not scanner.take(_CLOSE):
        before = scanner.offset
        group = _group(scanner)
        if groups and group.group <= groups[-1].group:
            raise scanner.error(f"GP{group.group} is out of order in P[{number}]", before)
        groups.append(group)
    if not groups:
        raise scanner.error(f"P[{number}] holds no motion group", begin)
    return Position(
        number, label[1].strip(" \t") if label else "", tuple(groups), scanner.source.place(begin)
    )


def _group(scanner: Scanner) -> GroupPosition:
    number = int(scanner.need(_GROUP, "a motion group such as GP1: or the end '};'")[1])
    uframe = _frame_number(scanner.need(_FRAME, "UF : with a number")[1])
    scanner.need(_COMMA, "a comma after UF")
    utool = _frame_number(scanner.need(_TOOL, "UT : with a number")[1])
    scanner.need(_COMMA, "a comma after UT")
    config = scanner.take(_CONFIG)
    if config is not None:
        scanner.need(_COMMA, "a comma after CONFIG")
    scanner.skip()
    begin = scanner.offset
    axes = [_axis(scanner)]
    while scanner.take(_COMMA):
        axes.append(_axis(scanner))
    main = tuple(axis for axis in axes if axis.name[0] != "E")
    extra = tuple(axis for axis in axes if axis.name[0] == "E")
    _check_names(scanner, begin, number, main, extra)
    is_joint = main[0].name[0] == "J"
    if (config is None) != is_joint:
        raise scanner.error(
            "a position in joints has no CONFIG"
            if is_joint
            else "a Cartesian position has no CONFIG, so its arm configuration is unknown",
            begin,
        )
    return GroupPosition(number, uframe, utool, config[1] if config else None, main, extra)


def _frame_number(text: str) -> int | None:
    return None if text == "F" else int(text)


def _axis(scanner: Scanner) -> Axis:
    heading = scanner.need(_AXIS, "an axis such as J1= or X =")
    name = heading[2] or heading[1]
    found = scanner.need(_VALUE, f"a number with its unit for {name}")
    number, unit = found["number"], found["unit"]
    expected = {"X": "mm", "Y": "mm", "Z": "mm", "W": "deg", "P": "deg", "R": "deg"}
    if expected.get(name, unit) != unit:
        raise scanner.error(f"{name} is given in {expected[name]}, not in {unit}", found.start())
    # Adding zero makes -0 the zero that it denotes.
    return Axis(name, None if number is None else float(number) + 0.0, unit)


def _check_names(
    scanner: Scanner, begin: int, group: int, main: tuple[Axis, ...], extra: tuple[Axis, ...]
) -> None:
    names = [axis.name for axis in main]
    joints = [f"J{index}" for index in range(1, len(names) + 1)]
    if not names or (names != joints and names != list(CARTESIAN_NAMES)):
        raise scanner.error(
            f"GP{group} must hold J1, J2, ... or X, Y, Z, W, P, R in this order, got "
            f"{', '.join(names[:10]) or 'none'}",
            begin,
        )
    if [axis.name for axis in extra] != [f"E{index}" for index in range(1, len(extra) + 1)]:
        raise scanner.error(f"external axes of GP{group} must be E1, E2, ... in order", begin)
