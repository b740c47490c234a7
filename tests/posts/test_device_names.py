"""Names that Windows keeps for devices were taken for programs."""

import pytest

from posopt_gui.viewmodels.check_sentences import sentence
from solver.catalog.cell_program import read_program
from solver.catalog.toml_reader import Table
from solver.errors import InputError, ModelError
from solver.io.posts.fanuc_text import program_name

# As "Naming Files, Paths, and Namespaces" lists them.
DEVICES = (
    "CON", "PRN", "AUX", "NUL", "COM1", "COM2", "COM9", "LPT1", "LPT5", "LPT9",
)  # fmt: skip


@pytest.mark.parametrize("name", DEVICES)
def test_a_device_of_windows_was_taken_for_a_program_name(name):
    with pytest.raises(ModelError, match=f"no device of Windows.*got '{name}'"):
        program_name(name, 36)


@pytest.mark.parametrize("name", ["CONTACT", "COM", "LPT", "COM10", "CON_1", "NULL", "AUX2"])
def test_names_that_only_begin_alike_are_taken(name):
    assert program_name(name, 36) == name


@pytest.mark.parametrize("key", ["name", "spindle_on"])
def test_a_cell_named_its_program_after_a_device(key):
    with pytest.raises(InputError, match="expected a name that is no device of Windows") as caught:
        read_program(Table({key: "LPT1"}, "cell.toml", "program"))
    assert caught.value.place.key == f"program.{key}"


def test_the_refusal_of_a_device_is_said_in_the_words_of_the_window():
    with pytest.raises(ModelError) as caught:
        program_name("CON", 36)
    asked = []

    def recorded(text, /, **values):
        asked.append(text)
        return text.format(**values) if values else text

    assert "CON" in sentence(str(caught.value), recorded)
    assert any("{name}" in text and "device of Windows" in text for text in asked)
