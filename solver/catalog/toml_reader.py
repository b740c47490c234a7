"""TOML files read with types and units; every complaint names the file, the key and the fix."""

from __future__ import annotations

import difflib
import math
import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

from solver.errors import InputError, ModelError, Place
from solver.units import DEG, MM

MAXIMUM_BYTES: Final = 5_000_000
"""Size above which a file is refused unread [bytes]."""

MAXIMUM_LENGTH: Final = 100.0
"""Largest length that a file may state [m]."""

MAXIMUM_ANGLE: Final = 36_000.0 * DEG
"""Largest angle, angular speed or acceleration that a file may state [rad, rad/s, rad/s^2]."""

MAXIMUM_NUMBER: Final = 1e9
"""Largest number without a length or an angle as its unit."""

MAXIMUM_TEXT: Final = 2_000
"""Longest text that a key may hold [characters]."""

MAXIMUM_PARTS: Final = 100
"""Most parts of a dotted key."""

_REQUIRED: Final = object()
_DOT: Final = re.compile(r"[^\s.][ \t]*\.")
_SYNTAX_PLACE: Final = re.compile(r"\s*\(at (?:line (\d+), column (\d+)|end of document)\)\s*$")


def read_toml(path: Path, data: bytes | None = None) -> Table:
    """Read a TOML file; the returned table is the whole document.

    `data` are its bytes where they are in memory already; `path` then only names it.

    Raises
    ------
    InputError
        If the file cannot be opened, is over 5 MB, is not UTF-8 or is not TOML; syntax errors
        carry line and column.
    """
    text = _text(_read(path) if data is None else data, path)
    file = str(path)
    _refuse_long_keys(text, file)
    try:
        values = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise _syntax_error(error, file, text) from None
    except RecursionError:
        raise InputError(
            "not usable TOML: tables or lists are nested too deeply", Place(file)
        ) from None
    except (ValueError, OverflowError):
        raise InputError("not usable TOML: a number has too many digits", Place(file)) from None
    return Table(values, file)


def _read(path: Path) -> bytes:
    """Read the bytes of a small file, with refusals as sentences."""
    place = Place(str(path))
    try:
        if path.is_dir():
            raise InputError("this is a folder; expected a TOML file", place)
        if path.exists() and not path.is_file():
            raise InputError("this is no regular file; expected a TOML file", place)
        with path.open("rb") as stream:
            return stream.read(MAXIMUM_BYTES + 1)
    except FileNotFoundError:
        raise InputError("the file does not exist", place) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "its name is not usable"
        raise InputError(f"the file cannot be read: {reason}", place) from None


def _text(data: bytes, path: Path) -> str:
    """Decode the bytes of a file without its byte-order mark, with refusals as sentences."""
    place = Place(str(path))
    if len(data) > MAXIMUM_BYTES:
        raise InputError("the file is larger than 5 MB; expected a small TOML file", place)
    if b"\0" in data:
        raise InputError("the file is binary; expected TOML text", place)
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        before = data[: error.start]
        line = before.count(b"\n") + 1
        column = error.start - (before.rfind(b"\n") + 1) + 1
        raise InputError(
            "the text is not UTF-8; save the file in UTF-8", Place(str(path), line, column)
        ) from None


def _refuse_long_keys(text: str, file: str) -> None:
    """Refuse keys of very many dotted parts: the parser takes quadratic time and space."""
    for piece in re.finditer(r"[^=,\[\]{}#\n]+", text):
        if piece[0].count(".") > MAXIMUM_PARTS and len(_DOT.findall(piece[0])) > MAXIMUM_PARTS:
            line = text.count("\n", 0, piece.start()) + 1
            raise InputError(
                f"expected keys of at most {MAXIMUM_PARTS} parts between dots", Place(file, line)
            )


def _syntax_error(error: tomllib.TOMLDecodeError, file: str, text: str) -> InputError:
    """Turn the parser's complaint into a located sentence."""
    message = str(error)
    found = _SYNTAX_PLACE.search(message)
    reason = _SYNTAX_PLACE.sub("", message)
    reason = "".join(c if c.isprintable() else "?" for c in reason)[:200]
    if found and found.group(1):
        line, column = int(found.group(1)), int(found.group(2))
    else:
        line = text.count("\n") + 1
        column = len(text) - (text.rfind("\n") + 1) + 1
    return InputError(f"not TOML: {reason[:1].lower()}{reason[1:]}", Place(file, line, column))


def shown(value: object) -> str:
    """Show a found value as it may stand in a sentence: short, on one line, with its TOML type."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return repr(value if len(value) <= 40 else value[:37] + "...")
    if isinstance(value, Mapping):
        return "a table"
    if isinstance(value, list):
        return f"a list of {len(value)}"
    try:
        text = str(value)
    except ValueError:  # an integer with thousands of digits
        return "a number of thousands of digits"
    return text if len(text) <= 40 else text[:37] + "..."


class Table:
    """A TOML table that knows its place and which of its keys were asked for.

    Each method reads one key; `default` makes the key optional. `finish` on the whole document
    refuses every key that nobody asked for, in this table and all those below it.
    """

    def __init__(
        self, values: Mapping[str, Any], file: str, key: str = "", folder: Path | None = None
    ) -> None:
        self.file = file
        self.key = key
        self._folder = folder
        self._values = values
        self._asked: dict[str, None] = {}
        self._children: list[Table] = []

    @property
    def folder(self) -> Path:
        """The folder from which relative references start: the stated one, or the file's."""
        return Path(self.file).parent if self._folder is None else self._folder

    def place(self, key: str | None = None) -> Place:
        """Locate a key of this table, or of the table itself."""
        path = self._path(key) if key is not None else self.key
        return Place(self.file, key=path or None)

    def error(self, key: str | None, message: str) -> InputError:
        """Build an error about a key of this table (or about the table: None)."""
        return InputError(message, self.place(key))

    @contextmanager
    def located(self, key: str | None = None) -> Iterator[None]:
        """Give errors without a place that are raised inside the place of this table."""
        try:
            yield
        except InputError as error:
            if error.place is not None:
                raise
            kind = ModelError if isinstance(error, ModelError) else InputError
            raise kind(error.message, self.place(key)) from None

    @property
    def keys(self) -> tuple[str, ...]:
        """The keys that the file states here."""
        return tuple(self._values)

    def has(self, key: str) -> bool:
        """Whether the key is stated; asking makes it a known key."""
        self._asked[key] = None
        return key in self._values

    def get(self, key: str, expected: str, default: Any = _REQUIRED) -> Any:
        """Read the raw value of a key; a missing one is an error unless there is a default."""
        if self.has(key):
            return self._values[key]
        if default is _REQUIRED:
            message = f"the key is missing; expected {expected}"
            spare = [name for name in list(self._values)[:200] if name not in self._asked]
            close = difflib.get_close_matches(key, spare, n=1)
            if close:
                message += f" (found {shown(close[0])} instead)"
            raise self.error(key, message)
        return default

    def text(self, key: str, default: Any = _REQUIRED) -> str:
        """Read a text on one line."""
        value = self.get(key, "a text", default)
        return value if value is default else self._text(key, value)

    def name(self, key: str) -> str:
        """Read a name of letters, digits, '_', '-' and '.' (up to 64)."""
        value = self.text(key)
        if not re.fullmatch(r"[A-Za-z0-9_][A-Za-z0-9_.\-]{0,63}", value):
            raise self.error(
                key, f"expected a name of letters, digits, '_', '-' and '.', found {shown(value)}"
            )
        return value

    def choice(self, key: str, options: Sequence[str], default: Any = _REQUIRED) -> str:
        """One of the given texts."""
        expected = "one of " + ", ".join(repr(option) for option in options)
        value = self.get(key, expected, default)
        if value is not default and value not in options:
            close = difflib.get_close_matches(str(value), options, n=1)
            hint = f" (did you mean {close[0]!r}?)" if close else ""
            raise self.error(key, f"expected {expected}, found {shown(value)}{hint}")
        return str(value)

    def texts(self, key: str, default: Any = _REQUIRED) -> tuple[str, ...]:
        """Read a list of texts."""
        values = self._list(key, "texts", None, default)
        if values is default:
            return tuple(values)
        return tuple(self._text(f"{key}[{i}]", value) for i, value in enumerate(values))

    def boolean(self, key: str, default: Any = _REQUIRED) -> bool:
        """Read true or false."""
        value = self.get(key, "true or false", default)
        if not isinstance(value, bool):
            raise self.error(key, f"expected true or false, found {shown(value)}")
        return value

    def integer(self, key: str, low: int, high: int, default: Any = _REQUIRED) -> int:
        """Read a whole number in low..high."""
        value = self.get(key, f"a whole number {low} to {high}", default)
        return value if value is default else self._integer(key, value, low, high)

    def integers(
        self, key: str, low: int, high: int, count: int | None = None, default: Any = _REQUIRED
    ) -> tuple[int, ...]:
        """Read a list of whole numbers in low..high."""
        values = self._list(key, "whole numbers", count, default)
        if values is default:
            return tuple(values)
        return tuple(self._integer(f"{key}[{i}]", v, low, high) for i, v in enumerate(values))

    def number(
        self,
        key: str,
        default: Any = _REQUIRED,
        *,
        low: float = -MAXIMUM_NUMBER,
        high: float = MAXIMUM_NUMBER,
    ) -> float:
        """Read a finite number in low..high, in the unit that the key names (converted to SI)."""
        value = self.get(key, f"a number{_unit_words(key)}", default)
        return value if value is default else self._number(key, value, low, high)

    def numbers(self, key: str, count: int, default: Any = _REQUIRED) -> tuple[float, ...]:
        """Read a list of `count` finite numbers, in the unit that the key names, as SI."""
        values = self._list(key, f"numbers{_unit_words(key)}", count, default)
        if values is default:
            return values  # type: ignore[no-any-return]
        return tuple(self._number(f"{key}[{i}]", value) for i, value in enumerate(values))

    def matrix(self, key: str, rows: int, columns: int, limit: int) -> tuple[tuple[int, ...], ...]:
        """`rows` lists of `columns` whole numbers in -limit..limit."""
        values = self._list(key, f"lists of {columns} whole numbers", rows)
        table = Table({f"{key}[{i}]": row for i, row in enumerate(values)}, self.file, self.key)
        return tuple(table.integers(one, -limit, limit, columns) for one in table.keys)

    def text_pairs(self, key: str) -> tuple[tuple[str, str], ...]:
        """Read a list of pairs of texts."""
        pairs = []
        for index, row in enumerate(self._list(key, "pairs of texts", None)):
            place = f"{key}[{index}]"
            if not isinstance(row, list) or len(row) != 2:
                raise self.error(place, f"expected a list of 2 texts, found {shown(row)}")
            pairs.append((self._text(f"{place}[0]", row[0]), self._text(f"{place}[1]", row[1])))
        return tuple(pairs)

    def table(self, key: str) -> Table:
        """Read a table; a missing one is an error."""
        value = self.get(key, "a table")
        return self._child(key, value)

    def optional_table(self, key: str) -> Table | None:
        """Read a table, or None where the file has none."""
        return self._child(key, self._values[key]) if self.has(key) else None

    def tables(self, key: str, default: Any = _REQUIRED) -> tuple[Table, ...]:
        """Read a list of tables."""
        values = self._list(key, "tables", None, default)
        if values is default:
            return tuple(values)
        return tuple(self._child(f"{key}[{i}]", value) for i, value in enumerate(values))

    def finish(self) -> None:
        """Refuse keys that nobody asked for, here and in every table that was read."""
        for key in self._values:
            if key in self._asked:
                continue
            close = difflib.get_close_matches(key, self._asked, n=1, cutoff=0.5)
            if close:
                hint = f"did you mean {close[0]!r}?"
            else:
                hint = "known here: " + (", ".join(sorted(self._asked)) or "none")
            raise self.error(key, f"unknown key; {hint}")
        for child in self._children:
            child.finish()

    def _path(self, key: str) -> str:
        if not re.fullmatch(r"[\w\-\[\].]{1,80}", key):
            key = shown(key)
        return f"{self.key}.{key}" if self.key else key

    def _child(self, key: str, value: object) -> Table:
        if not isinstance(value, dict):
            raise self.error(key, f"expected a table, found {shown(value)}")
        child = Table(value, self.file, self._path(key), self._folder)
        self._children.append(child)
        return child

    def _list(self, key: str, what: str, count: int | None, default: Any = _REQUIRED) -> Any:
        expected = f"a list of {what}" if count is None else f"a list of {count} {what}"
        value = self.get(key, expected, default)
        if value is default:
            return value
        if not isinstance(value, list) or (count is not None and len(value) != count):
            raise self.error(key, f"expected {expected}, found {shown(value)}")
        return value

    def _text(self, key: str, value: object) -> str:
        if not isinstance(value, str):
            raise self.error(key, f"expected a text, found {shown(value)}")
        if not value.isprintable() or len(value) > MAXIMUM_TEXT:
            raise self.error(
                key, f"expected one line of up to {MAXIMUM_TEXT} characters, found {shown(value)}"
            )
        return value

    def _integer(self, key: str, value: object, low: int, high: int) -> int:
        if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
            raise self.error(key, f"expected a whole number {low} to {high}, found {shown(value)}")
        return value

    def _number(
        self, key: str, value: object, low: float = -MAXIMUM_NUMBER, high: float = MAXIMUM_NUMBER
    ) -> float:
        words = _unit_words(key)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise self.error(key, f"expected a number{words}, found {shown(value)}")
        if not (isinstance(value, int) or math.isfinite(value)):
            raise self.error(key, f"expected a finite number{words}, found {shown(value)}")
        factor, bound = _unit(key)
        # Compared before converting: a whole number of the file may be too large for a float.
        if abs(value) > bound / factor * (1.0 + 1e-12):
            raise self.error(
                key, f"expected at most {bound / factor:g}{words} either way, found {shown(value)}"
            )
        if not low <= value <= high:
            limits = f"at least {low:g}" if high >= MAXIMUM_NUMBER else f"{low:g} to {high:g}"
            raise self.error(key, f"expected {limits}{words}, found {shown(value)}")
        return float(value) * factor


_UNITS: Final[tuple[tuple[str, float, float, str], ...]] = (
    ("_mm_s", MM, MAXIMUM_LENGTH, " in mm/s"),
    ("_mm", MM, MAXIMUM_LENGTH, " in mm"),
    ("_deg_s2", DEG, MAXIMUM_ANGLE, " in deg/s^2"),
    ("_deg_s", DEG, MAXIMUM_ANGLE, " in deg/s"),
    ("_deg", DEG, MAXIMUM_ANGLE, " in deg"),
    ("_kg", 1.0, MAXIMUM_NUMBER, " in kg"),
    ("_m3", 1.0, MAXIMUM_NUMBER, " in m^3"),
)


def _stem(key: str) -> str:
    """Drop the indices of a key: 'radii_mm[2]' is stated in what 'radii_mm' is."""
    return key.split("[", maxsplit=1)[0]


def _unit(key: str) -> tuple[float, float]:
    """Factor to SI and the largest magnitude in SI of the unit that a key names."""
    for suffix, factor, bound, _ in _UNITS:
        if _stem(key).endswith(suffix):
            return factor, bound
    return 1.0, MAXIMUM_NUMBER


def _unit_words(key: str) -> str:
    for suffix, _, _, words in _UNITS:
        if _stem(key).endswith(suffix):
            return words
    return ""
