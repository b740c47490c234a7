"""Whether the program's text does what the position checks assume: plain moves, in order."""

from __future__ import annotations

import re
from typing import Final

from solver.analysis.program_check import Check
from solver.io.ls_program import ProgramFile

_KNOWN: Final = tuple(
    re.compile(pattern)
    for pattern in (
        r"!.*",
        r"--.*",
        r"UFRAME_NUM=\d+",
        r"UTOOL_NUM=\d+",
        r"PAYLOAD\[\d+\]",
        r"WAIT +\d*\.\d+\(sec\)",
        r"DO\[\d+\]=(ON|OFF)",
        r"CALL [A-Z][A-Z0-9_]*",
        r"",
    )
)
"""Instructions that move nothing and change no order."""


def check_flow(written: ProgramFile) -> Check:
    """Refuse what these checks cannot follow: other motions than J, options, jumps, registers."""
    for line in written.instructions:
        motion = line.motion
        if motion is None:
            known = any(pattern.fullmatch(line.text.strip()) for pattern in _KNOWN)
            problem = "" if known else f"cannot follow {line.text.strip()!r}"
        elif motion.letter != "J":
            problem = f"a {motion.letter} move, whose way between positions is not checked"
        elif motion.options:
            problem = f"motion option {' '.join(motion.options)!r} changes where the move ends"
        elif not motion.positions:
            problem = f"the move to {' '.join(motion.targets)} goes to a register"
        else:
            problem = ""
        if problem:
            return Check("program flow", False, 1, 0, "unknown", f"{line.place}: {problem}")
    conflicts = written.frame_conflicts()
    if conflicts:
        return Check("program flow", False, len(conflicts), 0, "conflicts", conflicts[0])
    return Check("program flow", True, 0, 0, "unknown", "J moves in order, no options")
