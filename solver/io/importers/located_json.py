"""A strict JSON reader that knows the line and column of every value.

Stricter than the standard library's: no NaN or Infinity, no repeated members, no numbers that
overflow, and a bounded depth, so that no nesting exhausts the stack.
"""

from __future__ import annotations

import json
import math
import re
from bisect import bisect_right
from dataclasses import dataclass
from enum import Enum
from typing import Final

from solver.errors import InputError, Place
from solver.io.importers.naming import shown

MAX_DEPTH: Final = 32
"""Deepest nesting of arrays and objects."""

MAX_VALUES: Final = 4_000_000
"""Most values of a document; more would exhaust the memory of a small machine."""

_LONGEST_ROW: Final = 2000
"""Longer arrays of numbers [characters] are read value by value, so that they are counted."""

_LINE_END: Final = re.compile(r"\r\n|\n|\r")
_BLANK: Final = re.compile(r"[ \t\r\n]*+")
_STRING: Final = re.compile(r'"[^"\\\x00-\x1f]*+(?:\\.[^"\\\x00-\x1f]*+)*"')
_WORD: Final = re.compile(r'[^\s,:\[\]{}"]++')
_NUMBER: Final = re.compile(r"-?(?:0|[1-9][0-9]*)(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?")
_NUMBERS: Final = re.compile(
    r"\[([ \t\r\n]*+N[ \t\r\n]*+(?:,[ \t\r\n]*+N[ \t\r\n]*+)*)\]".replace("N", _NUMBER.pattern)
)
_SURROGATE: Final = re.compile("[\ud800-\udfff]")
_LITERALS: Final = {"true": True, "false": False, "null": None}


@dataclass(slots=True)
class Node:
    """A JSON value and the offset of its first character; `key` is the offset of its name.

    An array of numbers alone is a tuple, without a node for every number.
    """

    value: bool | float | str | tuple[float, ...] | list[Node] | dict[str, Node] | None
    offset: int
    key: int = -1


@dataclass(frozen=True, slots=True)
class Document:
    """A parsed text."""

    file: str
    text: str
    root: Node
    _starts: list[int]

    def place(self, offset: int, path: str | None = None) -> Place:
        """Return the line and column, both from 1, of the character at `offset`."""
        line = bisect_right(self._starts, offset)
        return Place(self.file, line, offset - self._starts[line - 1] + 1, path)

    def elements(self, array: Node) -> list[Node] | None:
        """Return the elements of an array, None where the value is none."""
        if isinstance(array.value, tuple):
            starts = _NUMBER.finditer(self.text, array.offset + 1)
            return [
                Node(*pair) for pair in zip(array.value, (m.start() for m in starts), strict=False)
            ]
        return array.value if isinstance(array.value, list) else None


def kind_of(node: Node) -> str:
    """Name the kind of a value, with the value where it is short."""
    value = node.value
    if isinstance(value, dict):
        return "an object"
    if isinstance(value, list | tuple):
        return "an array"
    if isinstance(value, str):
        return f"the text {shown(value)}"
    if value is None or isinstance(value, bool):
        return json.dumps(value)
    return f"{value:g}"


def parse_json(file: str, text: str) -> Document:
    """Parse a JSON text.

    Raises
    ------
    InputError
        At the first character that does not belong there.
    """
    starts = [0, *(end.end() for end in _LINE_END.finditer(text))]
    return Document(file, text, _Parser(file, text, starts).parse(), starts)


class _Expect(Enum):
    """What may come next."""

    VALUE = "a value"
    VALUE_OR_END = "a value or ]"
    KEY = "a name in double quotes"
    KEY_OR_END = "a name in double quotes or }"
    COLON = "a colon"
    COMMA_OR_END = "a comma or the end of the array or object"
    NOTHING = "nothing more"


class _Parser:
    """One pass over the text with a stack of the open arrays and objects."""

    def __init__(self, file: str, text: str, starts: list[int]) -> None:
        self._document = Document(file, text, Node(None, 0), starts)
        self._values = 0
        self._text, self._at = text, 0
        self._open: list[Node] = []
        self._name: tuple[str, int] = ("", -1)
        self._root: Node | None = None
        self._expect = _Expect.VALUE

    def parse(self) -> Node:
        text = self._text
        while True:
            blank = _BLANK.match(text, self._at)
            self._at = blank.end() if blank else self._at
            if self._at >= len(text):
                break
            mark = text[self._at]
            if mark in "[{":
                self._begin(mark)
            elif mark in "]}":
                self._end(mark)
            elif mark == ",":
                self._comma()
            elif mark == ":":
                self._require(_Expect.COLON)
                self._at += 1
                self._expect = _Expect.VALUE
            elif mark == '"':
                self._string()
            else:
                self._word()
        if self._root is None or self._expect is not _Expect.NOTHING:
            raise self._fault(
                f"the file ends where {self._expect.value} is expected (is it cut off?)"
            )
        return self._root

    def _begin(self, mark: str) -> None:
        if mark == "[" and self._plain_numbers():
            return
        node = Node([] if mark == "[" else {}, self._at)
        self._add(node)
        self._open.append(node)
        if len(self._open) > MAX_DEPTH:
            raise self._fault(
                f"arrays and objects are nested deeper than expected (at most {MAX_DEPTH})"
            )
        array = isinstance(node.value, list)
        self._expect = _Expect.VALUE_OR_END if array else _Expect.KEY_OR_END
        self._at += 1

    def _plain_numbers(self) -> bool:
        """Take an array of numbers at once; without a fault in it, that is the common case."""
        found = _NUMBERS.match(self._text, self._at)
        if not found or len(self._open) >= MAX_DEPTH or len(found[0]) > _LONGEST_ROW:
            return False
        numbers = tuple(map(float, found[1].split(",")))
        if not all(map(math.isfinite, numbers)):
            return False
        self._add(Node(numbers, self._at))
        self._at = found.end()
        return True

    def _end(self, mark: str) -> None:
        allowed = {"]": _Expect.VALUE_OR_END, "}": _Expect.KEY_OR_END}[mark]
        self._require(allowed, _Expect.COMMA_OR_END)
        container = list if mark == "]" else dict
        if not isinstance(self._open[-1].value, container):
            raise self._fault(
                f"{mark!r} was found, expected the end of {self._text[self._open[-1].offset]!r}"
            )
        self._open.pop()
        self._expect = _Expect.COMMA_OR_END if self._open else _Expect.NOTHING
        self._at += 1

    def _comma(self) -> None:
        self._require(_Expect.COMMA_OR_END)
        self._expect = _Expect.VALUE if isinstance(self._open[-1].value, list) else _Expect.KEY
        self._at += 1

    def _string(self) -> None:
        self._require(_Expect.VALUE, _Expect.VALUE_OR_END, _Expect.KEY, _Expect.KEY_OR_END)
        found = _STRING.match(self._text, self._at)
        if not found:
            raise self._fault(
                "a text is cut off or has a control character in it, expected a closing quote"
            )
        value = self._unescaped(found[0]) if "\\" in found[0] else found[0][1:-1]
        if self._expect in {_Expect.KEY, _Expect.KEY_OR_END}:
            members = self._open[-1].value
            if isinstance(members, dict) and value in members:
                raise self._fault(f"the member {shown(value)} is given twice, expected it once")
            self._name = (value, self._at)
            self._expect = _Expect.COLON
        else:
            self._add(Node(value, self._at))
        self._at = found.end()

    def _unescaped(self, text: str) -> str:
        try:
            value: str = json.loads(text)
        except ValueError:
            raise self._fault(
                f"{shown(text)} has an unknown escape, expected one of JSON's"
            ) from None
        if _SURROGATE.search(value):
            raise self._fault(f"{shown(text)} has an escape of half a character, expected a pair")
        return value

    def _word(self) -> None:
        self._require(_Expect.VALUE, _Expect.VALUE_OR_END)
        found = _WORD.match(self._text, self._at)
        word = found[0] if found else self._text[self._at]
        if word in _LITERALS:
            self._add(Node(_LITERALS[word], self._at))
        elif _NUMBER.fullmatch(word):
            number = float(word)
            if not math.isfinite(number):
                raise self._fault(f"the number {shown(word)} overflows, expected a finite number")
            self._add(Node(number, self._at))
        else:
            raise self._fault(
                f"found {shown(word)}, expected a plain number such as -12.5 or another JSON value"
            )
        self._at += len(word)

    def _add(self, node: Node) -> None:
        self._require(_Expect.VALUE, _Expect.VALUE_OR_END)
        self._values += 1
        if self._values > MAX_VALUES:
            raise self._fault(f"there are more values than expected (at most {MAX_VALUES:,})")
        self._expect = _Expect.COMMA_OR_END if self._open else _Expect.NOTHING
        if not self._open:
            self._root = node
            return
        parent = self._open[-1].value
        if isinstance(parent, list):
            parent.append(node)
        elif isinstance(parent, dict):
            name, node.key = self._name
            parent[name] = node

    def _require(self, *allowed: _Expect) -> None:
        if self._expect not in allowed:
            found = _STRING.match(self._text, self._at) or _WORD.match(self._text, self._at)
            token = found[0] if found else self._text[self._at]
            raise self._fault(f"found {shown(token)}, expected {self._expect.value}")

    def _fault(self, message: str) -> InputError:
        return InputError(message, self._document.place(self._at))
