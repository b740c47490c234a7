"""Writing files whole or not at all."""

from __future__ import annotations

import contextlib
import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from solver.errors import InputError, Place


def write_atomically(path: Path, data: bytes) -> None:
    """Put `data` under `path` so that a reader sees the old file or the new one, never a part.

    Raises
    ------
    InputError
        When the folder is missing, is no folder, or cannot be written; nothing is left then.
    """
    with staged(path, data):
        pass


@contextmanager
def staged(path: Path, data: bytes) -> Iterator[Path]:
    """Write `data` beside `path` under a name for the time being, and yield that name.

    When the block ends, the file moves to `path` in one step; when it raises, the file is
    removed and `path` keeps what it held. A killed process may leave the hidden `.posopt-*.tmp`
    file, never a part under the final name.
    """
    target = _checked_target(path)
    temporary = target.with_name(f".posopt-{secrets.token_hex(8)}.tmp")
    try:
        _write_through(temporary, data, target)
        yield temporary
        try:
            temporary.replace(target)
        except (OSError, ValueError) as error:
            raise _cannot_write(target, error) from error
    except BaseException:
        with contextlib.suppress(OSError):
            temporary.unlink(missing_ok=True)
        raise
    _flush_folder(target.parent)


def _checked_target(path: Path) -> Path:
    """Return `path` as absolute, so that a change of folder meanwhile cannot move the file.

    What a link points to is replaced, not the link.
    """
    try:
        target = Path(path).absolute()
        if target.is_symlink():
            target = target.resolve()
        if target.is_dir():
            raise InputError("is a folder, a file name was expected", Place(str(path)))
        if target.exists() and not target.is_file():
            raise InputError(
                "is a device or a pipe, which is not replaced; a file name was expected",
                Place(str(path)),
            )
        if not target.parent.is_dir():
            raise InputError(
                f"cannot be written, because the folder {target.parent} does not exist",
                Place(str(path)),
            )
    except (OSError, ValueError) as error:
        raise InputError(f"cannot be written ({error})", Place(repr(str(path)))) from error
    return target


def _write_through(temporary: Path, data: bytes, target: Path) -> None:
    try:
        with temporary.open("xb") as stream:
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())
    except OSError as error:
        raise _cannot_write(target, error) from error


def _cannot_write(target: Path, error: OSError | ValueError) -> InputError:
    reason = getattr(error, "strerror", None) or str(error)
    return InputError(f"cannot be written ({reason})", Place(str(target)))


def _flush_folder(folder: Path) -> None:
    """Make the new name survive a power cut, on systems that let a folder be flushed."""
    if os.name == "nt":
        return
    with contextlib.suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
