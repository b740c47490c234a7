"""What a JSON text of a path or a project says that does not belong there.

The more special ones stand first; {names} are what differs.
"""

from __future__ import annotations

from typing import Final

JSON_SENTENCES: Final[tuple[str, ...]] = (
    "is no whole posopt project (a NUL byte was found, so this is binary data; expected text)",
    "is no whole posopt project ({reason})",
    "the file ends where {what} is expected (is it cut off?)",
    "arrays and objects are nested deeper than expected (at most {count})",
    "there are more values than expected (at most {count})",
    "the member {name} is given twice, expected it once",
    "the number {found} overflows, expected a finite number",
    "a text is cut off or has a control character in it, expected a closing quote",
    "{found} has an unknown escape, expected one of JSON's",
    "{found} has an escape of half a character, expected a pair",
    "found {found}, expected a plain number such as {example} or another JSON value",
    "{mark} was found, expected the end of {start}",
    "found {found}, expected {what}",
)
