"""Which positions of an .LS file its motions use."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

from solver.io.ls_program import ProgramFile


@dataclass(frozen=True, slots=True)
class PositionUse:
    """Numbers of the positions of a file that no motion uses, and that several use."""

    file: str
    unused_numbers: tuple[int, ...]
    repeated_numbers: tuple[int, ...]

    @property
    def unused(self) -> int:
        """How many positions no motion uses."""
        return len(self.unused_numbers)

    @property
    def repeated(self) -> int:
        """How many positions several motions use."""
        return len(self.repeated_numbers)


def position_use(files: Iterable[ProgramFile]) -> tuple[PositionUse, ...]:
    """Return the use of the positions of every file that holds any."""
    found = []
    for file in files:
        if not file.positions:
            continue
        uses = Counter(number for motion in file.moves for number in motion.positions)
        found.append(
            PositionUse(
                file=file.file,
                unused_numbers=tuple(one for one in sorted(file.positions) if not uses[one]),
                repeated_numbers=tuple(one for one in sorted(uses) if uses[one] > 1),
            )
        )
    return tuple(found)
