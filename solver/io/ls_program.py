"""What a FANUC .LS file holds, as its reader found it: degrees and millimetres of the file.

Only the properties that say so return radians and metres.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from solver.errors import InputError, Place
from solver.transforms import FloatArray
from solver.units import DEG, MM

JOINT_NAMES = ("J1", "J2", "J3", "J4", "J5", "J6")
CARTESIAN_NAMES = ("X", "Y", "Z", "W", "P", "R")


@dataclass(frozen=True, slots=True)
class Axis:
    """One value of a position: `value` in `unit` ('deg' or 'mm'), None where untaught."""

    name: str
    value: float | None
    unit: str


@dataclass(frozen=True, slots=True)
class GroupPosition:
    """The position of one motion group.

    `uframe` and `utool` are None where the file says F (none); `config` is the CONFIG string of
    a Cartesian position. `axes` are J1, J2, ... or X, Y, Z, W, P, R; `extra` holds E1, E2, ...
    """

    group: int
    uframe: int | None
    utool: int | None
    config: str | None
    axes: tuple[Axis, ...]
    extra: tuple[Axis, ...]

    @property
    def is_joint(self) -> bool:
        """Whether the position is given in joints."""
        return self.axes[0].name == JOINT_NAMES[0]


@dataclass(frozen=True, slots=True)
class Position:
    """One entry of /POS; `label` is the comment beside its number."""

    number: int
    label: str
    groups: tuple[GroupPosition, ...]
    place: Place

    @property
    def first(self) -> GroupPosition:
        """The first group that is given, GP1 in all programs of an arm."""
        return self.groups[0]

    @property
    def arm(self) -> GroupPosition | None:
        """GP1, which moves the arm; None where the position is one of other groups only."""
        return self.first if self.first.group == 1 else None

    @property
    def joints_deg(self) -> tuple[float, ...]:
        """J1 to J6 of the arm exactly as written [deg]."""
        arm = self._needed_arm()
        if not arm.is_joint:
            raise InputError(f"P[{self.number}] is Cartesian, joints were expected", self.place)
        if tuple(axis.name for axis in arm.axes) != JOINT_NAMES:
            raise InputError(
                f"P[{self.number}] has {len(arm.axes)} joints, six were expected", self.place
            )
        for axis in arm.axes:
            if axis.unit != "deg":
                raise InputError(
                    f"{axis.name} of P[{self.number}] is in {axis.unit}, degrees were expected",
                    self.place,
                )
        return self._taught()

    @property
    def joints(self) -> FloatArray:
        """(6,) pendant joints of the arm [rad]."""
        return np.array(self.joints_deg) * DEG

    @property
    def cartesian(self) -> tuple[FloatArray, FloatArray]:
        """X Y Z (3,) [m] and W P R (3,) [rad] of the arm, frame_from_tool."""
        if self._needed_arm().is_joint:
            raise InputError(
                f"P[{self.number}] is given in joints, X Y Z W P R was expected", self.place
            )
        values = np.array(self._taught())
        return values[:3] * MM, values[3:] * DEG

    def _needed_arm(self) -> GroupPosition:
        if self.arm is None:
            raise InputError(
                f"P[{self.number}] holds GP{self.first.group} but not GP1, the arm", self.place
            )
        return self.arm

    def _taught(self) -> tuple[float, ...]:
        values = []
        for axis in self._needed_arm().axes:
            if axis.value is None:
                raise InputError(
                    f"{axis.name} of P[{self.number}] was never taught (********)", self.place
                )
            values.append(axis.value)
        return tuple(values)


@dataclass(frozen=True, slots=True)
class Speed:
    """A speed: `value` in `unit`; None where a register or max_speed gives it (see `text`)."""

    value: float | None
    unit: str
    text: str


@dataclass(frozen=True, slots=True)
class Motion:
    """One motion instruction.

    Attributes
    ----------
    letter : str
        J, L, C, A or S.
    positions : tuple of int
        Numbers of the positions it goes through, the last one being its end; two for C. Empty
        where the target is no P[n]: a position register, or a number from a register.
    targets : tuple of str
        The targets as written.
    termination : str
        'FINE', 'CNT', or a corner region or distance as written ('CR10', 'CD50'); `cnt` is the
        value of CNT, None for the others and where a register gives it.
    options : tuple of str
        Everything after the termination, as written.
    uframe, utool : int or None
        The frame and tool numbers selected above it; None before the first selection and
        where a register gives them.
    """

    letter: str
    positions: tuple[int, ...]
    targets: tuple[str, ...]
    speed: Speed
    termination: str
    cnt: int | None
    options: tuple[str, ...]
    uframe: int | None
    utool: int | None
    place: Place


@dataclass(frozen=True, slots=True)
class Instruction:
    """One program line: its text without number and semicolon, and its motion if it is one.

    `number` is the line number as written, None where the file gives none.
    """

    number: int | None
    text: str
    motion: Motion | None
    place: Place


@dataclass(frozen=True, slots=True)
class ProgramFile:
    """A whole .LS file.

    `kind` is the word after the name ('Macro', ...), `attributes` the entries of /ATTR by their
    keys as written (strings without quotes), `remarks` the texts of the `!` lines. `uframe` and
    `utool` are the first numbers selected by UFRAME_NUM and UTOOL_NUM.
    """

    file: str
    name: str
    kind: str
    attributes: Mapping[str, str]
    remarks: tuple[str, ...]
    uframe: int | None
    utool: int | None
    instructions: tuple[Instruction, ...]
    positions: Mapping[int, Position]
    application: tuple[str, ...] = ()
    """Entries of /APPL, which can change how the robot moves."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "attributes", MappingProxyType(dict(self.attributes)))
        object.__setattr__(self, "positions", MappingProxyType(dict(self.positions)))

    @property
    def moves(self) -> tuple[Motion, ...]:
        """All motions, in the order of the file."""
        return tuple(one.motion for one in self.instructions if one.motion is not None)

    @property
    def comment(self) -> str:
        """The COMMENT attribute, '' where there is none."""
        return self.attributes.get("COMMENT", "")

    def path_positions(self) -> tuple[Position, ...]:
        """Positions in the order in which the motions name them.

        Raises
        ------
        InputError
            When a motion goes to something that the file does not hold (a register).
        """
        found: list[Position] = []
        for motion in self.moves:
            if not motion.positions:
                raise InputError(
                    f"the move to {' '.join(motion.targets)} goes to a register, whose value the "
                    "file does not hold",
                    motion.place,
                )
            found.extend(self.positions[number] for number in motion.positions)
        return tuple(found)

    def path_joints(self) -> FloatArray:
        """(n, 6) pendant joints in the order of the motions [rad]; Cartesian ones are refused."""
        return np.array([one.joints for one in self.path_positions()]).reshape(-1, 6)

    def frame_conflicts(self) -> tuple[str, ...]:
        """Sentences on positions whose UF or UT differs from the selected frame or tool.

        Such a move faults at run time (INTP-251, INTP-253).
        """
        sentences = []
        for motion in self.moves:
            for number in motion.positions:
                group = self.positions[number].first
                for what, taught, selected in (
                    ("UF", group.uframe, motion.uframe),
                    ("UT", group.utool, motion.utool),
                ):
                    if taught is not None and selected is not None and taught != selected:
                        sentences.append(
                            f"{motion.place}: P[{number}] was taught in {what} {taught}, "
                            f"but {selected} is selected"
                        )
        return tuple(sentences)
