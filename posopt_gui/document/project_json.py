"""JSON of a project: read strictly, and every fault told with its line and column."""

from __future__ import annotations

import json
import math
import re
from typing import TYPE_CHECKING, Any

from solver.errors import InputError, Place

if TYPE_CHECKING:
    from solver.io.importers.located_json import Document, Node


def strict_json(data: bytes, file: str) -> Any:
    """The value of a JSON text in UTF-8; a name that is given twice is refused, and so is NaN.

    Raises
    ------
    InputError
        At the first character that does not belong there; `file` is the name for it.
    """
    try:
        text = data.decode("utf-8-sig")
        return json.loads(
            text, parse_constant=_refuse, parse_float=_finite, object_pairs_hook=_once
        )
    except (ValueError, RecursionError) as error:
        reason, place = f"{str(error)[:80]!r}", Place(file)
        fault = _fault(data, file)
        if fault is not None:
            reason, place = fault.message, fault.place or place
        raise InputError(f"is no whole posopt project ({reason})", place) from error


def located(error: InputError, data: bytes) -> InputError:
    """The error with line and column of the key that it names, where the text has that key."""
    place = error.place
    if place is None or place.key is None or place.line is not None:
        return error
    # Reading with places takes time, which only a refusal costs.
    from solver.io.importers.located_json import parse_json  # noqa: PLC0415

    try:
        document = parse_json(place.file, data.decode("utf-8-sig"))
    except (InputError, ValueError):
        return error
    return InputError(error.message, document.place(_offset(document, place.key), place.key))


def _offset(document: Document, key: str) -> int:
    """Where the value of a key such as 'pins[2].lean' begins, or the deepest part that is there."""
    node: Node = document.root
    for part in re.findall(r"[^.\[\]]+", key):
        children = document.elements(node)
        if children is not None and part.isdecimal() and int(part) < len(children):
            node = children[int(part)]
        elif isinstance(node.value, dict) and part in node.value:
            node = node.value[part]
        else:
            break
    return node.offset


def _fault(data: bytes, file: str) -> InputError | None:
    """What is wrong with a text, told by a slower reader that knows places."""
    from solver.io.importers.located_json import parse_json  # noqa: PLC0415
    from solver.io.importers.source import Source  # noqa: PLC0415

    try:
        parse_json(file, Source(file, data).text("utf-8"))
    except InputError as error:
        return error
    return None


def _refuse(name: str) -> float:
    raise ValueError(f"{name} is no number")


def _finite(text: str) -> float:
    # JSON's grammar knows numbers that are too large for a float.
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"{text[:20]} is too large for a number")
    return value


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        raise ValueError("a name is given twice")
    return found
