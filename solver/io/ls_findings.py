"""What the interpreter of .LS files cannot follow, or what stops a controller."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Final

from solver.errors import Place


class FindingKind(Enum):
    """What a finding is about."""

    MOTION = "motion type"
    """A C, A or S motion: its way is not straight; its positions are kept as linear moves."""

    OPTION = "motion option"
    """An option that may change where or how a move goes."""

    TARGET = "target in a register"
    """A move to PR[n], P[R[n]] and the like; it is left out of the program."""

    SPEED = "speed"
    """A speed that the file does not hold, or that the program cannot state."""

    TERMINATION = "termination"
    """A rounding that the file does not hold or that is no FINE and no CNT."""

    UNTAUGHT = "untaught position"
    """A move to ******** on which a controller stops; it is left out of the program."""

    GROUPS = "motion groups"
    """Another motion group moves too, or instead; a move without GP1 is left out."""

    EXTERNAL_AXES = "external axes"
    """A position moves axes beside the arm."""

    FRAME_SELECTION = "frame selection"
    """A move runs in a frame or with a tool that is unknown or not the expected one."""

    FRAME_CONFLICT = "frame conflict"
    """UF or UT of a position is not what is selected: the controller stops there."""

    CONFIGURATION = "configuration"
    """The file's decimals do not settle which posture or turn a Cartesian position means."""

    FLOW = "program flow"
    """Jumps, labels, conditions, loops, ends and pauses: lines are taken in order."""

    REGISTER = "register"
    """A register, variable or frame is set, or one decides what happens."""

    WAITING = "waiting"
    """A wait for something else than a time."""

    OUTPUT = "output"
    """An output that is no DO[n]=ON or OFF."""

    PAYLOAD = "payload"
    """Several payload schedules are selected."""

    INSTRUCTION = "unknown instruction"
    """Something that is not known to leave the robot where it is."""

    NAME = "program name"
    """A file holds a program of another name."""

    EMPTY = "no moves"
    """Nothing is left that could be checked."""


TIME_ONLY: Final = frozenset({FindingKind.WAITING, FindingKind.OUTPUT})
"""Kinds that leave the way of the robot as it is: only time and signals are not known."""


@dataclass(frozen=True, slots=True)
class Finding:
    """Something that the checks cannot follow, or that stops a controller.

    `place` is where it stands first, `count` in how many lines it stands.
    """

    kind: FindingKind
    sentence: str
    place: Place
    count: int = 1

    def __str__(self) -> str:
        more = f" (and {self.count - 1} more)" if self.count > 1 else ""
        return f"{self.place}: {self.sentence}{more}"


class FindingLog:
    """Collects findings; what is found again under the same key is counted, not repeated."""

    def __init__(self) -> None:
        self._found: dict[tuple[FindingKind, str, str], tuple[str, Place, set[int | None]]] = {}

    def add(self, kind: FindingKind, sentence: str, place: Place, key: str | None = None) -> None:
        """Note a finding; `key` tells it from others of its kind and file, as its sentence does."""
        identity = (kind, place.file, sentence if key is None else key)
        _, _, lines = self._found.setdefault(identity, (sentence, place, set()))
        lines.add(place.line)

    def findings(self) -> tuple[Finding, ...]:
        """All findings in the order in which they were met first."""
        return tuple(
            Finding(kind, sentence, place, len(lines))
            for (kind, _, _), (sentence, place, lines) in self._found.items()
        )
