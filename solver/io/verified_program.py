"""A robot program reaches its final name only after what is on disk was read back and checked."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from solver.errors import InputError, Place, PosoptError, RefusedError
from solver.io.atomic import staged, write_atomically
from solver.io.csv_moves_reader import read_csv_moves
from solver.io.json_program_reader import read_json_program
from solver.io.ls_differences import ls_differences, part_mark
from solver.io.ls_program import ProgramFile
from solver.io.ls_reader import SIZE_LIMIT, read_program, read_program_file
from solver.io.neutral_differences import program_differences, row_differences
from solver.io.posts.post import FileForm, Post, PostOptions
from solver.model.program import JointProgram
from solver.model.robot import Robot

Found = tuple[ProgramFile, ...] | JointProgram
"""What was read back: .LS files, the main one first, or the program that a CSV or JSON holds."""

_NUMBERED: Final = re.compile(r"[A-Z][A-Z0-9_]*[0-9]", re.ASCII)


@dataclass(frozen=True, slots=True)
class WrittenFiles:
    """Files that were written and read back.

    Attributes
    ----------
    paths : tuple of paths
        The main program first, then its parts.
    found : tuple of ProgramFile, or JointProgram
        What was read back.
    stale : tuple of paths
        Parts of an earlier, longer program of this name that still lie in the folder; nothing
        calls them any more.
    """

    paths: tuple[Path, ...]
    found: Found
    stale: tuple[Path, ...]


def write_verified(
    program: JointProgram,
    path: Path,
    verify: Callable[[Found], None],
    options: PostOptions,
    post: Post,
    robot: Robot,
) -> WrittenFiles:
    """Write a program, read all its files back from disk, check them, and only then name them.

    Parameters
    ----------
    program : JointProgram
        What is to be written; its joints are rounded already.
    path : Path
        The final name of the main program; its stem must be the program's name, under which a
        controller loads it. Parts lie beside it.
    verify : callable
        Gets what was read back and raises when it is not fit to run (kinematics, clearances).
        Whatever it raises passes through, and nothing is written.
    options : PostOptions
        What the controller accepts.
    post : Post
        What the files look like.
    robot : Robot
        Whose joints the program holds.

    Raises
    ------
    RefusedError
        When what was read back differs from the program; it says what and where. Files that
        bore the final names before keep their content.
    InputError
        When a file cannot be written, or a part would replace a file that is no part of this
        program. The parts get their names first and the main program last; when that fails in
        the middle, the files that were replaced already are put back.
    """
    path = Path(path)
    if path.stem.upper() != program.name or path.suffix.upper() != post.suffix.upper():
        raise InputError(
            f"program {program.name} belongs into a file of its name, "
            f"{program.name}{post.suffix}, not {path.name}",
            Place(str(path)),
        )
    rendered = post.render(program, options, robot)
    names = [path.name, *(f"{Path(one.name).stem}{path.suffix}" for one in rendered[1:])]
    paths = tuple(path.with_name(name) for name in names)
    data = [one.text.encode("utf-8") for one in rendered]
    _refuse_foreign_parts(paths[1:], program.name)
    with _placed_together(paths, data) as temporaries:
        found, faults = _read_back(program, options, post, robot, paths, temporaries, data)
        for difference in faults:
            raise RefusedError(f"{path.name} was not written: read back, {difference}")
        verify(found)
    stale = tuple(_stale_parts(path, program.name, paths)) if path.suffix.upper() == ".LS" else ()
    return WrittenFiles(paths, found, stale)


def differences(
    program: JointProgram,
    found: Found,
    options: PostOptions,
    robot: Robot,
    form: FileForm = FileForm.FANUC_JOINT,
) -> Iterator[str]:
    """Yield one sentence for every difference between a program and what was read.

    `form` says which positions .LS files must hold; a JointProgram is compared as it is.
    """
    if isinstance(found, JointProgram):
        return program_differences(program, found)
    return ls_differences(program, found, options, robot, form)


def _read_back(
    program: JointProgram,
    options: PostOptions,
    post: Post,
    robot: Robot,
    paths: Sequence[Path],
    temporaries: Sequence[Path],
    data: Sequence[bytes],
) -> tuple[Found, Iterator[str]]:
    """Return what stands on the disk and how it differs from the program."""
    main = paths[0].name
    try:
        on_disk = [temporary.read_bytes() for temporary in temporaries]
        match post.form:
            case FileForm.CSV:
                rows = read_csv_moves(on_disk[0], main)
                found: Found = replace(program, moves=tuple(row.move for row in rows))
                faults = row_differences(program, rows, robot)
            case FileForm.JSON:
                found = read_json_program(on_disk[0], main)
                faults = program_differences(program, found)
            case FileForm.FANUC_JOINT | FileForm.FANUC_CARTESIAN:
                pairs = zip(on_disk, paths, strict=True)
                found = tuple(read_program(one, path.name) for one, path in pairs)
                faults = ls_differences(program, found, options, robot, post.form)
    except (OSError, InputError) as error:
        raise RefusedError(f"{main} was not written: read back, {error}") from error
    for path, one, sent in zip(paths, on_disk, data, strict=True):
        if one != sent:
            raise RefusedError(
                f"{main} was not written: read back, the {len(one)} bytes of {path.name} differ "
                f"from the {len(sent)} that were sent to the disk"
            )
    return found, faults


@contextmanager
def _placed_together(paths: Sequence[Path], data: Sequence[bytes]) -> Iterator[list[Path]]:
    """Stage all files; when the block ends, they get their names, the first one last.

    When one of them cannot get its name, those that have theirs are put back as they were.
    """
    old = {path: path.read_bytes() if path.is_file() else None for path in paths[1:]}
    placed: list[Path] = []
    try:
        with ExitStack() as stack:
            yield [
                stack.enter_context(_noted(path, one, placed))
                for path, one in zip(paths, data, strict=True)
            ]
    except BaseException as error:
        if not placed:
            raise
        left = [path.name for path in placed if not _put_back(path, old.get(path))]
        if not left:
            raise
        raise InputError(
            f"{paths[0].name} was not written ({error}), but its parts {', '.join(left)} are "
            "already the new ones and could not be put back: write the program again before it "
            "is loaded",
            Place(str(paths[0])),
        ) from error


@contextmanager
def _noted(path: Path, data: bytes, placed: list[Path]) -> Iterator[Path]:
    with staged(path, data) as temporary:
        yield temporary
    placed.append(path)


def _put_back(path: Path, old: bytes | None) -> bool:
    """Give a name back what it held before; say whether that succeeded."""
    try:
        if old is None:
            path.unlink()
        else:
            write_atomically(path, old)
    except (OSError, PosoptError):
        return False
    return True


def _refuse_foreign_parts(paths: Sequence[Path], main: str) -> None:
    """Refuse to replace a file whose name posopt chose, unless it is a part of this program."""
    for path in paths:
        if path.exists() and not _is_part_of(path, main):
            raise InputError(
                f"is no part of {main}, but its name is needed for one; move it away or call the "
                "program otherwise",
                Place(str(path)),
            )


def _stale_parts(path: Path, main: str, written: Sequence[Path]) -> Iterator[Path]:
    """Yield the files beside `path` that say they are parts of `main` and were not written now."""
    kept = {one.name.upper() for one in written}
    for other in sorted(path.absolute().parent.iterdir()):
        if (
            other.suffix.upper() == ".LS"
            and other.name.upper() not in kept
            and _NUMBERED.fullmatch(other.stem.upper())
            and _is_part_of(other, main)
        ):
            yield other


def _is_part_of(path: Path, main: str) -> bool:
    with contextlib.suppress(OSError, PosoptError):
        if path.is_file() and path.stat().st_size <= SIZE_LIMIT:
            mark = part_mark(read_program_file(path).remarks)
            return mark is not None and mark.owner == main
    return False
