"""What the instructions of an .LS file mean, motions aside."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from solver.io.ls_findings import FindingKind
from solver.model.toolpath import Event, EventKind

EXCERPT: Final = 60
"""Characters of an instruction that a finding quotes."""

_LABEL: Final = r"[ \t]*(?::[^\]]*)?\]"
_WAIT: Final = re.compile(
    r"WAIT[ \t]+([0-9]{1,6}(?:\.[0-9]{0,4})?|\.[0-9]{1,4})[ \t]*\(sec\)", re.ASCII
)
_OUTPUT: Final = re.compile(rf"DO\[[ \t]*([0-9]{{1,5}}){_LABEL}[ \t]*=[ \t]*(ON|OFF)", re.ASCII)
_CALL: Final = re.compile(r"CALL[ \t]+([A-Z_][A-Z0-9_]*)[ \t]*(\(.*\))?", re.ASCII)
_PAYLOAD: Final = re.compile(rf"PAYLOAD\[[ \t]*([0-9]{{1,3}}){_LABEL}", re.ASCII)
_SELECTION: Final = re.compile(
    r"(UFRAME_NUM|UTOOL_NUM)[ \t]*(?:\[([^\]]*)\][ \t]*)?=[ \t]*(?:([0-9]{1,3})|.*)", re.ASCII
)
_FIRST_GROUP: Final = re.compile(r"\bGP1\b")
_ANY_CALL: Final = re.compile(r"\bCALL[ \t]+([A-Z_][A-Z0-9_]*)(?![A-Za-z0-9_\-])", re.ASCII)

_SILENT: Final = re.compile(
    r"!.*|--.*|//.*|-+|MESSAGE[ \t]*\[.*\]|TIMER\[.*\][ \t]*=[ \t]*(?:START|STOP|RESET)|"
)
"""Remarks, lines remarked out, texts and timers: nothing moves."""

_UNFOLLOWED: Final = tuple(
    (re.compile(pattern), kind, reason)
    for pattern, kind, reason in (
        (
            r"(?:JMP|LBL|IF|ELSE|ENDIF|SELECT|FOR|ENDFOR|SKIP|END|ABORT|PAUSE|RUN|UALM|WHEN"
            r"|ERROR_PROG|RESUME_PROG|MONITOR|ENDMONITOR|RETURN_PATH_DSBL)(?![A-Za-z0-9_])|="
            r"|WAIT\b.*\bLBL\b",
            FindingKind.FLOW,
            "the lines are taken in order, without jumps, conditions and pauses",
        ),
        (
            r"WAIT(?![A-Za-z0-9_])",
            FindingKind.WAITING,
            "how long that takes is not known",
        ),
        (
            r"OVERRIDE|JOINT_MAX_SPEED|LINEAR_MAX_SPEED",
            FindingKind.SPEED,
            "it changes the speed of the moves",
        ),
        (
            r"(?:DO|RO|GO|AO|SO|UO|WO|F|M)[ \t]*\[",
            FindingKind.OUTPUT,
            "of the outputs only DO[n]=ON and OFF are followed",
        ),
        (
            r"(?:R|PR|AR|SR|VR|P|UFRAME|UTOOL)[ \t]*\[|\$|(?:TOOL_|V)?OFFSET\b|PAYLOAD\b"
            r"|CALL[ \t]+[A-Z]*R\[",
            FindingKind.REGISTER,
            "what a register, variable or frame holds is not known",
        ),
    )
)


@dataclass(frozen=True, slots=True)
class Call:
    """CALL of a program: its name, and its arguments with their parentheses or ''."""

    name: str
    arguments: str


@dataclass(frozen=True, slots=True)
class Selection:
    """UFRAME_NUM or UTOOL_NUM of group 1; `number` is None where a register gives it."""

    what: str
    number: int | None


@dataclass(frozen=True, slots=True)
class Payload:
    """Selection of a payload schedule."""

    number: int


@dataclass(frozen=True, slots=True)
class Unfollowed:
    """Something that cannot be followed, and why."""

    kind: FindingKind
    sentence: str


Meaning = Event | Call | Selection | Payload | Unfollowed | None
"""None: it does nothing that a program needs to hold."""


def meaning(text: str) -> Meaning:
    """Return what an instruction that is no motion does."""
    text = text.strip(" \t")
    if _SILENT.fullmatch(text):
        return None
    for pattern, read in _KNOWN:
        if found := pattern.fullmatch(text):
            return read(found)
    for pattern, kind, reason in _UNFOLLOWED:
        if pattern.match(text):
            return Unfollowed(kind, f"cannot follow {text[:EXCERPT]!r}: {reason}")
    return Unfollowed(
        FindingKind.INSTRUCTION,
        f"cannot follow {text[:EXCERPT]!r}: it is not known to leave the robot where it is",
    )


def called_programs(text: str) -> tuple[str, ...]:
    """Names of all programs that an instruction may call, conditional calls included."""
    if text.lstrip(" \t").startswith(("!", "--", "//")):
        return ()
    return tuple(found[1] for found in _ANY_CALL.finditer(text))


def _selection(found: re.Match[str]) -> Selection | Unfollowed:
    if found[2] is not None and not _FIRST_GROUP.search(found[2]):
        return Unfollowed(
            FindingKind.GROUPS, f"{found[0][:EXCERPT]!r} is for another motion group than the arm's"
        )
    return Selection(found[1], None if found[3] is None else int(found[3]))


_KNOWN: Final[tuple[tuple[re.Pattern[str], Callable[[re.Match[str]], Meaning]], ...]] = (
    (_WAIT, lambda found: Event(EventKind.DWELL, value=float(found[1]))),
    (
        _OUTPUT,
        lambda found: Event(EventKind.DIGITAL_OUTPUT, str(int(found[1])), float(found[2] == "ON")),
    ),
    (_CALL, lambda found: Call(found[1], found[2] or "")),
    (_PAYLOAD, lambda found: Payload(int(found[1]))),
    (_SELECTION, _selection),
)
