"""A program together with the programs that it calls."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Final

from solver.errors import InputError, Place
from solver.io.ls_instructions import called_programs
from solver.io.ls_program import ProgramFile
from solver.io.ls_reader import read_program_file

DEPTH_LIMIT: Final = 16
"""Deepest nesting of calls, the main program counted."""

FILE_LIMIT: Final = 1_000
"""Most files of one set."""

_SUFFIX: Final = ".LS"


@dataclass(frozen=True, slots=True, eq=False)
class ProgramSet:
    """A main program and every program that it calls and whose file is at hand.

    Attributes
    ----------
    programs : mapping of name to ProgramFile
        The main program and those called, by the upper-case names under which they are called.
    unresolved : tuple of str
        Called programs without a file, in the order of their first call.
    """

    main: ProgramFile
    programs: Mapping[str, ProgramFile]
    unresolved: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "programs", MappingProxyType(dict(self.programs)))


def read_program_set(path: Path) -> ProgramSet:
    """Read an .LS file and, for every `CALL NAME` in it and in those, NAME.LS beside it.

    File names are compared without case. A call without a file is no error: it is listed in
    `unresolved`.

    Raises
    ------
    InputError
        A file cannot be read, two files answer to one name, programs call each other in a
        circle, or calls are nested deeper than `DEPTH_LIMIT`.
    """
    path = Path(path)
    main = read_program_file(path)
    files = _program_files(path.parent)

    def find(name: str, caller: Place) -> ProgramFile | None:
        found = files.get(name, ())
        if len(found) > 1:
            raise InputError(
                f"CALL {name} could mean {' or '.join(one.name for one in found)}", caller
            )
        return read_program_file(found[0]) if found else None

    return _completed(main, find)


def program_set(files: Iterable[ProgramFile]) -> ProgramSet:
    """Return the set of programs at hand; the first one is the main program.

    Raises
    ------
    InputError
        There is none, two have one name, or they call each other in a circle or too deep.
    """
    named: dict[str, ProgramFile] = {}
    main: ProgramFile | None = None
    for file in files:
        main = main or file
        if file.name.upper() in named:
            raise InputError(f"program {file.name} is given twice", Place(file.file))
        named[file.name.upper()] = file
    if main is None:
        raise InputError("a set of programs needs a main program")
    return _completed(main, lambda name, _: named.get(name))


def _program_files(folder: Path) -> dict[str, tuple[Path, ...]]:
    try:
        entries = sorted(folder.iterdir())
    except OSError as error:
        raise InputError(f"cannot be listed ({error.strerror})", Place(str(folder))) from error
    found: dict[str, tuple[Path, ...]] = {}
    for entry in entries:
        if entry.suffix.upper() == _SUFFIX:
            name = entry.stem.upper()
            found[name] = (*found.get(name, ()), entry)
    return found


_STILL = re.compile(r"!.*|--.*|//.*|(DO|RO|GO|F)\[.*|WAIT .*|END|MESSAGE.*|")
"""Instructions that neither move the robot nor change how it is moved."""


def is_event(file: ProgramFile) -> bool:
    """Whether a called program only switches and waits, and so is an event of its caller."""
    return not file.moves and all(_STILL.fullmatch(one.text.strip()) for one in file.instructions)


def _completed(main: ProgramFile, find: Callable[[str, Place], ProgramFile | None]) -> ProgramSet:
    name = main.name.upper()
    programs = {name: main}
    unresolved: dict[str, None] = {}
    heights: dict[str, int] = {}

    def visit(name: str, chain: tuple[str, ...]) -> int:
        """Return how deep the calls below a program go, itself counted."""
        if name in heights:
            return heights[name]
        below = 0
        for callee, place in _calls(programs[name]):
            if callee in chain:
                circle = " > ".join((*chain[chain.index(callee) :], callee))
                raise InputError(f"the programs call each other in a circle: {circle}", place)
            if callee not in programs and callee not in unresolved:
                file = find(callee, place)
                if file is None or is_event(file):
                    unresolved[callee] = None
                else:
                    programs[callee] = file
            if len(programs) > FILE_LIMIT:
                raise InputError(f"more than {FILE_LIMIT} programs are called", place)
            if callee in programs:
                if len(chain) + heights.get(callee, 1) > DEPTH_LIMIT:
                    raise InputError(
                        f"calls are nested deeper than {DEPTH_LIMIT}: {' > '.join(chain)}", place
                    )
                below = max(below, visit(callee, (*chain, callee)))
        heights[name] = below + 1
        return below + 1

    visit(name, (name,))
    return ProgramSet(main, programs, tuple(unresolved))


def _calls(file: ProgramFile) -> Iterable[tuple[str, Place]]:
    for one in file.instructions:
        for name in called_programs(one.text):
            yield name, one.place
