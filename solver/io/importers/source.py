"""Reading a path file as bytes, and its bytes as text, with located refusals."""

from __future__ import annotations

import codecs
import stat
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from solver.errors import InputError, Place

MAX_BYTES: Final = 64 * 1024 * 1024
"""Larger files are refused unread."""

_UTF16_MARKS: Final = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)


@dataclass(frozen=True, slots=True)
class Source:
    """The bytes of a path file and the name that errors call it by."""

    file: str
    data: bytes

    def text(self, encoding: str | None = None) -> str:
        """Decode the bytes; None tries UTF-8, then GBK. A leading BOM is dropped.

        Raises
        ------
        InputError
            At the first NUL byte or the first byte that the encoding does not allow.
        """
        if self.data.startswith(_UTF16_MARKS):
            raise InputError(
                "the file is UTF-16 text, expected UTF-8 or GBK", Place(self.file, 1, 1)
            )
        nul = self.data.find(b"\0")
        if nul >= 0:
            raise InputError(
                "a NUL byte was found, so this is binary data; expected text", self.place(nul)
            )
        data = self.data.removeprefix(codecs.BOM_UTF8)
        skipped = len(self.data) - len(data)
        try:
            return data.decode(encoding or "utf-8")
        except UnicodeDecodeError as error:
            fault = error
        if encoding is None and not skipped:
            try:
                return data.decode("gbk")
            except UnicodeDecodeError as error:
                fault = max(fault, error, key=lambda one: one.start)
        expected = encoding.upper() if encoding else "UTF-8" if skipped else "UTF-8 or GBK"
        raise InputError(
            f"byte 0x{data[fault.start]:02X} does not belong here, expected {expected} text",
            self.place(skipped + fault.start),
        )

    def place(self, offset: int) -> Place:
        """Line and column of a byte, both from 1; the column counts bytes."""
        before = self.data[:offset].replace(b"\r\n", b"\n").replace(b"\r", b"\n")
        return Place(self.file, before.count(b"\n") + 1, len(before) - before.rfind(b"\n"))


def read_source(path: str | Path) -> Source:
    """Read a whole regular file of at most 64 MB.

    Raises
    ------
    InputError
        When it is missing, no regular file, too large or cannot be read.
    """
    place = Place(str(path))
    try:
        status = Path(path).stat()
        if stat.S_ISDIR(status.st_mode):
            raise InputError("this is a directory, expected a path file", place)
        if not stat.S_ISREG(status.st_mode):
            raise InputError("this is no regular file, expected a path file", place)
        if status.st_size <= MAX_BYTES:
            with Path(path).open("rb") as file:
                data = file.read(MAX_BYTES + 1)
    except FileNotFoundError:
        raise InputError("there is no such file, expected a path file", place) from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise InputError(
            f"the file cannot be read ({reason}), expected a readable one", place
        ) from error
    if status.st_size > MAX_BYTES or len(data) > MAX_BYTES:
        size = max(status.st_size, MAX_BYTES + 1)
        raise InputError(f"the file has {size:,} bytes, expected at most {MAX_BYTES:,}", place)
    return Source(str(path), data)
