"""Wrong inputs are told by the names that the form gives its fields."""

import pytest

from posopt_gui.document.project import state_of_cell
from posopt_gui.i18n import translated
from posopt_gui.viewmodels.cell_facts import Catalogue
from posopt_gui.viewmodels.cell_form import cell_form
from posopt_gui.viewmodels.input_words import field_name, input_key, input_words
from posopt_gui.viewmodels.project_files import PROJECT
from solver.errors import InputError, Place


def english(text, **values):
    return text.format(**values) if values else text


def chinese(text, **values):
    found = translated("zh_CN", text)
    return found.format(**values) if values else found


@pytest.fixture(scope="module")
def state():
    return state_of_cell("groove_hw300")


def error_of(state):
    with pytest.raises(InputError) as caught:
        state.problem()
    return caught.value


WRONG = {
    "beam.length_mm": (-5.0, "Beam: beam HW300: the length"),
    "beam.section": ("HW999", "Beam, Section: "),
    "settings.manipulability_m3": (-1.0, "Limits and clearance, Manipulability: "),
    "robot.model": ("gone.toml", "Robot"),
    "robot.windows_deg": ({"J2": [10.0, -10.0]}, "Robot, J2 window: "),
    "tool.model": ("no_such_tool", "Tool"),
    "cell.name": ("two words", "Cell, Name: "),
}


@pytest.mark.parametrize(("key", "value", "words"), [(k, *v) for k, v in WRONG.items()], ids=WRONG)
def test_a_wrong_value_is_called_by_its_field_in_both_languages(state, key, value, words):
    wrong = state.with_value(key, value)
    error = error_of(wrong)
    text = input_words(error, wrong.cell, english)
    assert words in text
    assert "cell.toml" not in text
    assert key not in text
    assert input_key(error, wrong.cell).startswith(key.split(".")[0])
    local = input_words(error, wrong.cell, chinese)
    assert local != text
    assert key not in local


def test_a_wrong_row_of_the_path_file_is_told_with_line_and_column(state):
    (name,) = state.files
    lines = state.files[name].splitlines(keepends=True)
    row = next(n for n, line in enumerate(lines) if line[:1] in b"-0123456789")
    lines[row + 2] = lines[row + 2].replace(b",", b",oops", 1)
    wrong = type(state)(state.cell, {name: b"".join(lines)}, folder=state.folder)
    error = error_of(wrong)
    text = input_words(error, wrong.cell, english)
    assert text.startswith(f"{name}, line {row + 3}, column 2: ")
    assert input_key(error, wrong.cell) == "path"


def test_what_is_wrong_in_a_file_of_the_project_is_told_with_field_file_and_key(state):
    wrong = state.with_value("robot.model", "own.toml")
    wrong = type(state)(wrong.cell, {**wrong.files, "own.toml": b"[robot]\n"}, folder="")
    error = error_of(wrong)
    text = input_words(error, wrong.cell, english)
    assert text.startswith("Robot: own.toml, key robot.name: the key is missing")
    assert input_key(error, wrong.cell) == "robot.model"


def test_every_field_of_the_form_has_a_name_of_its_own(state):
    form = cell_form(state.cell, Catalogue(), folder=state.folder, files=state.files)
    named = {}
    for section in form.sections:
        for field in section.fields:
            words = field_name(state.cell, field.key, english)
            assert words.endswith(field.label)
            named.setdefault(words, []).append(field.key)
    assert {words: keys for words, keys in named.items() if len(keys) > 1} == {}


def test_an_error_of_no_field_is_its_sentence_alone(state):
    error = InputError("the path enters the steel", Place(PROJECT))
    assert input_words(error, state.cell, english) == "The path enters the steel"
    assert input_key(error, state.cell) is None
    assert field_name(state.cell, "no.such.key", english) == ""
