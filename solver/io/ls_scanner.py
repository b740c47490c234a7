"""A cursor over the text of an .LS file that knows its line and column."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterator
from typing import Final

from solver.errors import InputError, Place

EXCERPT: Final = 24
"""Characters of the file that an error quotes."""


class SourceText:
    """The text of a file with LF line ends, and the places of its characters."""

    def __init__(self, text: str, file: str) -> None:
        self.text = text
        self.file = file
        self._starts = [0]
        self._starts.extend(found.end() for found in re.finditer("\n", text))

    def place(self, offset: int) -> Place:
        """Line and column of the character at `offset`, both from 1."""
        line = bisect_right(self._starts, offset)
        return Place(self.file, line, offset - self._starts[line - 1] + 1)

    def lines(self, start: int, end: int) -> Iterator[tuple[int, int]]:
        """Yield the offsets of every line between two offsets, its LF left out."""
        while start < end:
            stop = self.text.find("\n", start, end)
            if stop < 0:
                stop = end
            yield start, stop
            start = stop + 1


class Scanner:
    """Reads tokens between two offsets of a source; `blank` matches what separates them.

    Every pattern must be free of ambiguous repetition, so that matching stays linear.
    """

    def __init__(self, source: SourceText, start: int, end: int, blank: re.Pattern[str]) -> None:
        self.source = source
        self.offset = start
        self.end = end
        self._blank = blank

    def skip(self) -> None:
        """Move past blanks."""
        found = self._blank.match(self.source.text, self.offset, self.end)
        if found is not None:
            self.offset = found.end()

    def at_end(self) -> bool:
        """Whether only blanks are left."""
        self.skip()
        return self.offset >= self.end

    def take(self, pattern: re.Pattern[str]) -> re.Match[str] | None:
        """Match `pattern` after blanks and move past it; None where it does not match."""
        self.skip()
        found = pattern.match(self.source.text, self.offset, self.end)
        if found is not None:
            self.offset = found.end()
        return found

    def need(self, pattern: re.Pattern[str], expected: str) -> re.Match[str]:
        """Match `pattern` after blanks, or raise that `expected` was not found here."""
        found = self.take(pattern)
        if found is None:
            raise self.error(f"expected {expected}, found {self.excerpt()}")
        return found

    def excerpt(self) -> str:
        """Return what stands here, short and quoted."""
        if self.offset >= self.end:
            return "the end"
        text = self.source.text[self.offset : min(self.end, self.offset + EXCERPT)]
        return repr(text.split("\n", 1)[0] or "\n")

    def error(self, message: str, offset: int | None = None) -> InputError:
        """Return an error at `offset`, or where the cursor stands."""
        return InputError(message, self.source.place(self.offset if offset is None else offset))
