"""Splitting a program that is too long for one file into parts, and naming them.

A part ends after a move that comes to rest (FINE) where its last half holds one: between two
passes as a rule. Else it ends after a contact move, where the controller may come to rest as
well, although the move says CNT: it need not look ahead into a program that it has yet to call.
"""

from __future__ import annotations

import string
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

from solver.errors import ModelError
from solver.io.posts.fanuc_text import program_name, stamped
from solver.io.posts.post import PostOptions
from solver.model.program import JointProgram, Move
from solver.model.toolpath import EventKind, Role

OWNER_PREFIX = "MAIN "
"""Begins the remarks of a part that name the main program; the part's number follows them."""


def line_count(program: JointProgram) -> int:
    """Number of program lines: remarks, selections, moves and events."""
    return _head_lines(program) + sum(map(_lines, program.moves))


def split_program(program: JointProgram, options: PostOptions) -> tuple[JointProgram, ...]:
    """Return the program alone where one file takes it, else the parts that a main one calls.

    Every part has the program's remarks, frame, tool and payload, and remarks of its own that
    say which part of which program it is.

    Raises
    ------
    ModelError
        When the lines of a part leave no room for a move with its events, when even the calls
        are too many for a file, or when no names are free for the parts.
    """
    name = program_name(program.name, options.name_length)
    if line_count(program) <= options.line_limit:
        return (program,)
    owner = stamped(OWNER_PREFIX, name)
    room = options.line_limit - _head_lines(program) - 1 - len(owner)
    bounds = [0, *_bounds(program, room, options.line_limit)]
    count = len(bounds) - 1
    if len(program.remarks) + count > options.line_limit:
        raise ModelError(
            f"program {name} needs {count} parts, whose calls and {len(program.remarks)} remarks "
            f"are more than the {options.line_limit} lines that one file takes"
        )
    return tuple(
        replace(
            program,
            name=part_name,
            remarks=(*owner, f"PART {number} OF {count}", *program.remarks),
            moves=program.moves[start:end],
        )
        for number, (part_name, (start, end)) in enumerate(
            zip(_part_names(program, count, options), pairwise(bounds), strict=True), start=1
        )
    )


def _head_lines(program: JointProgram) -> int:
    return len(program.remarks) + 2 + (program.payload is not None)


def _lines(move: Move) -> int:
    return 1 + len(move.events)


def _bounds(program: JointProgram, room: int, limit: int) -> Iterator[int]:
    """Yield the index behind the last move of every part."""
    start, total = 0, len(program.moves)
    while start < total:
        used: list[int] = []
        for move in program.moves[start:]:
            lines = (used[-1] if used else 0) + _lines(move)
            if lines > room:
                break
            used.append(lines)
        if not used:
            needed = limit - room + _lines(program.moves[start])
            raise ModelError(
                f"move {start + 1} needs {needed} lines with its events and the head of its "
                f"part, one file takes {limit}"
            )
        if start + len(used) < total:
            start += _cut(program.moves[start : start + len(used)], used, room)
        else:
            start = total
        yield start


def _cut(moves: Sequence[Move], used: Sequence[int], room: int) -> int:
    """Return how many of the moves that fit become a part."""
    second_half = [index for index, lines in enumerate(used) if 2 * lines > room]
    for wanted in (_rests, _grinds):
        for index in reversed(second_half):
            if wanted(moves[index]):
                return index + 1
    return len(moves)


def _rests(move: Move) -> bool:
    return move.cnt is None and move.role is not Role.LEAD_IN


def _grinds(move: Move) -> bool:
    return move.role is Role.CONTACT


def _part_names(program: JointProgram, count: int, options: PostOptions) -> list[str]:
    """Return NAME1, NAME2, ...: no two alike, and none that the program itself uses."""
    taken = {program.name, *_called(program, options)}
    for base in _bases(program.name):
        names = [f"{base}{number}" for number in range(1, count + 1)]
        if len(names[-1]) <= options.name_length and taken.isdisjoint(names):
            return names
    raise ModelError(
        f"no names of up to {options.name_length} characters are free for the {count} parts of "
        f"program {program.name}"
    )


def _bases(name: str) -> Iterator[str]:
    """Yield what the names of parts may begin with, the best first.

    A name that ends with a digit gets an underscore: part 1 of GROOVE1 is not part 11 of GROOVE.
    """
    for length in range(len(name), 0, -1):
        base = name[:length]
        yield f"{base}_" if base[-1].isdigit() else base
    yield from string.ascii_uppercase


def _called(program: JointProgram, options: PostOptions) -> Iterator[str]:
    for event in (event for move in program.moves for event in move.events):
        match event.kind:
            case EventKind.CALL:
                yield event.target
            case EventKind.SPINDLE_ON:
                yield options.spindle_on
            case EventKind.SPINDLE_OFF:
                yield options.spindle_off
            case _:
                pass
