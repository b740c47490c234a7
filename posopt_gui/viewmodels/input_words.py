"""Errors of the inputs as sentences that name the field as the form calls it."""

from __future__ import annotations

from posopt_gui.viewmodels.cell_facts import Catalogue, Facts, Files
from posopt_gui.viewmodels.cell_form import Form, form_of
from posopt_gui.viewmodels.check_sentences import sentence
from posopt_gui.viewmodels.error_words import Translate, capital, error_words, file_words
from posopt_gui.viewmodels.form_types import Cell, at
from posopt_gui.viewmodels.project_files import PROJECT, key_of_file
from solver.errors import InputError, PosoptError
from solver.model.robot import Robot
from solver.model.tool import Tool


def input_words(error: PosoptError, cell: Cell, tr: Translate) -> str:
    """An error of the inputs: what the form calls the field, or a file's line and column."""
    place = error.place if isinstance(error, InputError) else None
    if not isinstance(error, InputError) or place is None or place.line is not None:
        return error_words(error, tr)
    text = sentence(error.message, tr)
    if place.file == PROJECT:
        name = field_name(cell, dotted(place.key or ""), tr)
        return f"{name}{tr(': ')}{text}" if name else capital(text)
    name = field_name(cell, key_of_file(cell, place.file) or "", tr)
    where = file_words(place, tr)
    return tr(": ").join([name, where, text] if name else [where, text])


def input_key(error: PosoptError, cell: Cell) -> str | None:
    """The dotted key of the cell that an error is about; None where it is about no single one."""
    place = error.place if isinstance(error, InputError) else None
    if place is None:
        return None
    if place.key is not None and place.line is None and key_of_file(cell, place.file) is None:
        return dotted(place.key)
    return key_of_file(cell, place.file)


def field_name(cell: Cell, key: str, tr: Translate) -> str:
    """What the form calls the value of a dotted key; '' for a key that it does not know."""
    if not key:
        return ""
    parts = key.split(".")
    fixture = int(parts[1]) if parts[0] == "fixtures" and parts[1:2] and parts[1].isdecimal() else 0
    form = _form(cell, fixture)
    section_name, field_key = form.place_of(key)
    if not section_name:
        return ""
    words = [tr(form.section(section_name).title)]
    if parts[0] == "fixtures" and at(cell, f"fixtures.{fixture}.name") is not None:
        words.append(str(at(cell, f"fixtures.{fixture}.name")))
    field = form.field(field_key)
    if field is not None:
        label, last = tr(field.label), parts[-1]
        if key != field_key and last.isdecimal() and int(last) < len(field.parts):
            label = f"{label} {tr(field.parts[int(last)])}"
        if label != words[0]:
            words.append(label)
    return tr(", ").join(words)


def dotted(key: str) -> str:
    """A key of a file with the indices of its lists between dots."""
    return key.replace("[", ".").replace("]", "")


class _Names(Catalogue):
    """A catalogue of nothing: the names of fields follow from the cell alone, without reading."""

    def __init__(self) -> None:
        self.beams, self.robots, self.tools = (), (), ()

    def robot(self, name: object, folder: str, files: Files) -> Robot | None:
        """No robot."""
        return None

    def tool(self, name: object, folder: str, files: Files) -> Tool | None:
        """No tool."""
        return None


def _form(cell: Cell, fixture: int) -> Form:
    nothing = Facts(None, None, None, None, None, {})
    return form_of(cell, _Names(), nothing, {}, fixture)
