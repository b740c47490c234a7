"""Texts of the window in other languages; the English text is the key."""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cache
from typing import Final

from solver.catalog.names import resource_folder

LANGUAGES: Final[Mapping[str, str]] = {"en": "English", "zh_CN": "简体中文"}
"""Languages by their codes, each in its own words."""


@cache
def texts(language: str) -> Mapping[str, str]:
    """All texts of a language; empty for English, whose texts are the keys."""
    folder = resource_folder() / "translations" / language
    found: dict[str, str] = {}
    for path in sorted(folder.glob("*.json")):
        found |= json.loads(path.read_text(encoding="utf-8"))
    return found


def translated(language: str, text: str) -> str:
    """A text in a language, or as it is where no translation is known."""
    return texts(language).get(text, text)
