"""Errors of the solver as sentences of the window, in its language."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from posopt_gui.viewmodels.check_sentences import sentence
from solver.errors import InputError, Place, PosoptError

Translate = Callable[..., str]


def error_words(error: PosoptError, tr: Translate) -> str:
    """An error's sentence: with name and line of a file, without the key of a cell."""
    if not isinstance(error, InputError):
        return capital(sentence(str(error), tr))
    text = sentence(error.message, tr)
    place = error.place
    if place is None or place.line is None:
        return capital(text)
    return f"{place_words(place, tr)}{tr(': ')}{text}"


def file_error_words(error: PosoptError, tr: Translate) -> str:
    """An error's sentence, after the name of the file that it is about where it names one."""
    if not isinstance(error, InputError) or error.place is None:
        return error_words(error, tr)
    return f"{place_words(error.place, tr)}{tr(': ')}{sentence(error.message, tr)}"


def place_words(place: Place, tr: Translate) -> str:
    """Name of a file, with line and column where they are known."""
    name = Path(place.file).name
    if place.line is None:
        return name
    if place.column is None:
        return tr("{file}, line {line}", file=name, line=place.line)
    return tr(
        "{file}, line {line}, column {column}", file=name, line=place.line, column=place.column
    )


def file_words(place: Place, tr: Translate) -> str:
    """Name of a file, with line and column or else the key where they are known."""
    if place.line is not None or place.key is None:
        return place_words(place, tr)
    return tr("{file}, key {key}", file=Path(place.file).name, key=place.key)


def capital(text: str) -> str:
    """The text with a capital letter at its beginning."""
    return text[:1].upper() + text[1:]
