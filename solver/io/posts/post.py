"""What a post-processor is: a name, a file suffix and a function from program to text."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from solver.errors import ModelError
from solver.model.program import JointProgram


@dataclass(frozen=True, slots=True)
class PostOptions:
    """What the controller at hand accepts.

    Attributes
    ----------
    name_length : int
        Longest program name: 8 on older controllers, 36 on R-30iB and later.
    line_limit : int
        Most program lines in one file.
    uframe_limit, utool_limit : int
        Largest user frame and tool number of the controller.
    spindle_on, spindle_off : str
        Programs that are called to switch the spindle.
    """

    name_length: int = 36
    line_limit: int = 9_999
    uframe_limit: int = 9
    utool_limit: int = 10
    spindle_on: str = "SPINDLE_ON"
    spindle_off: str = "SPINDLE_OFF"

    def __post_init__(self) -> None:
        if not 1 <= self.name_length <= 36:
            raise ModelError(f"a program name has 1 to 36 characters, got {self.name_length}")
        if not 1 <= self.line_limit <= 9_999:
            raise ModelError(f"a program has 1 to 9999 lines, got a limit of {self.line_limit}")
        if min(self.uframe_limit, self.utool_limit) < 0:
            raise ModelError("the largest frame and tool numbers cannot be negative")


DEFAULT_OPTIONS = PostOptions()
"""An R-30iB or later, with its usual ten tools and nine user frames."""


@dataclass(frozen=True, slots=True)
class Post:
    """A post-processor: `render` turns a program into the text of one file, or refuses it.

    `render` raises :class:`~solver.errors.ModelError` with a sentence when the program cannot
    be expressed; its text is pure ASCII and carries the file's own line ends.
    """

    name: str
    title: str
    suffix: str
    render: Callable[[JointProgram, PostOptions], str]
