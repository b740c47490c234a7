"""How found text and lists of names appear in sentences."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

SHOWN_LENGTH = 40
"""Longer texts are cut in messages."""


def shown(text: object) -> str:
    """Return `text` quoted on one line, cut to a readable length."""
    whole = str(text)
    if len(whole) > SHOWN_LENGTH:
        return repr(whole[:SHOWN_LENGTH]) + "..."
    return repr(whole)


def listed(names: Iterable[str], last: str = "and") -> str:
    """Join names in a row: 'a, b and c'."""
    items = list(names)
    if len(items) < 2:
        return "".join(items)
    return f"{', '.join(items[:-1])} {last} {items[-1]}"


def suggestion(name: str, known: Iterable[str]) -> str:
    """Give a closing hint such as ' (did you mean feed?)', or nothing."""
    near = difflib.get_close_matches(name[:SHOWN_LENGTH].casefold(), list(known), n=1)
    return f" (did you mean {near[0]}?)" if near else ""
