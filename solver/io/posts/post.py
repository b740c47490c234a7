"""What a post-processor is: a name, a file suffix and a function from program to texts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import Final, NamedTuple

from solver.errors import ModelError
from solver.model.program import JointProgram
from solver.model.program_settings import ProgramSettings
from solver.model.robot import Robot
from solver.units import DEG, MM

POSITION_TOLERANCE: Final = 0.002 * MM
"""How far the TCP of a Cartesian position may be from where the joints put it [m]."""

ANGLE_TOLERANCE: Final = 0.002 * DEG
"""The same for its orientation [rad]: three decimals of W, P and R give 0.0015 deg at worst."""

JOINT_TOLERANCE: Final = 0.1 * DEG
"""How far a Cartesian position, solved again, may be from the chosen joints [rad].

Near a singularity the three decimals of a pose leave the joints almost free.
"""


@dataclass(frozen=True, slots=True)
class PostOptions:
    """What the controller at hand accepts.

    Attributes
    ----------
    name_length : int
        Longest program name: 8 on older controllers, 36 on R-30iB and later.
    line_limit : int
        Most program lines in one file; a longer program is split.
    uframe_limit, utool_limit, payload_limit, register_limit : int
        Largest user frame, tool, payload schedule and position register of the controller.
    spindle_on, spindle_off : str
        Programs that are called to switch the spindle.
    """

    name_length: int = 36
    line_limit: int = 9_999
    uframe_limit: int = 9
    utool_limit: int = 10
    payload_limit: int = 10
    register_limit: int = 100
    spindle_on: str = "SPINDLE_ON"
    spindle_off: str = "SPINDLE_OFF"

    def __post_init__(self) -> None:
        if not 1 <= self.name_length <= 36:
            raise ModelError(f"a program name has 1 to 36 characters, got {self.name_length}")
        if not 1 <= self.line_limit <= 9_999:
            raise ModelError(f"a program has 1 to 9999 lines, got a limit of {self.line_limit}")
        limits = (self.uframe_limit, self.utool_limit, self.payload_limit, self.register_limit)
        if min(limits) < 0:
            raise ModelError(
                "the largest frame, tool, payload and register numbers cannot be negative"
            )

    @classmethod
    def of(cls, settings: ProgramSettings) -> PostOptions:
        """The options that a cell's program settings state; the rest is an R-30iB's."""
        return cls(
            name_length=settings.name_length,
            line_limit=settings.line_limit,
            spindle_on=settings.spindle_on,
            spindle_off=settings.spindle_off,
        )


DEFAULT_OPTIONS = PostOptions()
"""An R-30iB or later, with its usual ten tools and nine user frames."""


class FileForm(Enum):
    """What a post's files hold, which decides how they are read back and compared."""

    FANUC_JOINT = "FANUC .LS with joint positions"
    FANUC_CARTESIAN = "FANUC .LS with Cartesian positions"
    CSV = "a table of moves"
    JSON = "the neutral program"


class RenderedFile(NamedTuple):
    """One file of a rendered program: its name with suffix, and its text."""

    name: str
    text: str


Rendered = tuple[RenderedFile, ...]
"""All files of a rendered program, the main one first."""


@dataclass(frozen=True, slots=True)
class Post:
    """A post-processor: `render` turns a program into the texts of its files, or refuses it.

    `render` raises :class:`~solver.errors.ModelError` with a sentence when the program cannot
    be expressed; a text carries the file's own line ends. The robot is the one whose joints the
    program holds: a post that writes poses asks its kinematics.
    """

    name: str
    title: str
    suffix: str
    form: FileForm
    render: Callable[[JointProgram, PostOptions, Robot], Rendered]
