"""Dotted keys of nested tables and lists, such as 'beam.section' or 'fixtures.0.min_mm'."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def value_at(container: Any, key: str) -> Any:
    """What a dotted key holds; None without."""
    found = container
    for part in key.split("."):
        found = _child(found, part)
        if found is None:
            return None
    return found


def changed_value(container: Any, key: str, value: Any) -> Any:
    """A copy with another value under a dotted key; None removes the key."""
    return _changed(container, key.split("."), value)


def _child(container: Any, part: str) -> Any:
    if isinstance(container, Mapping):
        return container.get(part)
    if isinstance(container, list) and part.isdecimal() and int(part) < len(container):
        return container[int(part)]
    return None


def _changed(container: Any, parts: list[str], value: Any) -> Any:
    first, rest = parts[0], parts[1:]
    if isinstance(container, list):
        items = list(container)
        index = int(first)
        if rest:
            items[index] = _changed(items[index], rest, value)
        elif value is None:
            del items[index]
        elif index == len(items):
            items.append(value)
        else:
            items[index] = value
        return items
    table = dict(container or {})
    if rest:
        table[first] = _changed(table.get(first, {}), rest, value)
    elif value is None:
        table.pop(first, None)
    else:
        table[first] = value
    return table
