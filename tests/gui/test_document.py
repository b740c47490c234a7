"""The document: values by key, undo and redo of everything, and what was saved."""

from dataclasses import replace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from posopt_gui.document.document import Document
from posopt_gui.document.project import key_of_error, state_of_cell
from solver.catalog import load_cell
from solver.errors import InputError
from solver.model.wishes import Pin
from solver.pipeline.digest import problem_digest


@pytest.fixture
def document(planned_state, qapp):
    return Document(planned_state)


@pytest.mark.parametrize("cell", ["groove_hw300", "groove_paper", "zigzag_hw250"])
def test_a_cell_opened_as_a_project_is_the_same_problem(cell):
    assert problem_digest(state_of_cell(cell).problem()) == problem_digest(load_cell(cell))


def test_a_value_changes_and_comes_back(document):
    document.set_value("beam.section", "HW250")
    assert document.value("beam.section") == "HW250"
    assert document.modified
    document.undo()
    assert document.value("beam.section") == "HW300"
    assert not document.modified
    document.redo()
    assert document.value("beam.section") == "HW250"


def test_changes_of_one_field_in_a_row_are_one_step(document):
    for value in (430.0, 440.0, 450.5):
        document.set_value("beam.lower_edge_mm", value)
    document.undo()
    assert not document.can_undo


def test_a_list_entry_can_be_changed_added_and_removed(document):
    document.set_value("fixtures.0.min_mm", [1.0, 2.0, 3.0])
    assert document.value("fixtures.0.min_mm") == [1.0, 2.0, 3.0]
    count = len(document.value("fixtures"))
    document.set_value(f"fixtures.{count}", {"name": "new", "shape": "box"})
    assert document.value(f"fixtures.{count}.name") == "new"
    document.set_value(f"fixtures.{count}", None)
    assert len(document.value("fixtures")) == count


def test_a_saved_state_is_not_modified_until_it_changes_again(document):
    document.set_value("beam.length_mm", 900.0)
    document.mark_saved()
    assert not document.modified
    document.set_value("beam.length_mm", 901.0)
    assert document.modified
    document.undo()
    assert document.value("beam.length_mm") == 900.0
    assert not document.modified


def test_an_error_names_the_key_of_the_document(planned_state):
    with pytest.raises(InputError) as caught:
        planned_state.with_value("settings.manipulability_m3", "much").problem()
    assert key_of_error(caught.value) == "settings.manipulability_m3"
    with pytest.raises(InputError) as caught:
        planned_state.with_value("fixtures.1.min_mm", [0.0, 0.0]).problem()
    assert key_of_error(caught.value).startswith("fixtures.1.min_mm")


EDITS = st.one_of(
    st.just("undo"),
    st.just("redo"),
    st.tuples(st.sampled_from(["beam.length_mm", "beam.lower_edge_mm"]), st.integers(1, 5)),
    st.tuples(st.just("pin"), st.integers(0, 5)),
)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=60)
@given(st.lists(EDITS, max_size=30))
def test_undo_goes_back_to_the_beginning_and_redo_to_the_end(planned_state, qapp, edits):
    document = Document(planned_state)
    for edit in edits:
        if edit == "undo":
            document.undo()
        elif edit == "redo":
            document.redo()
        elif edit[0] == "pin":
            document.set_pins((Pin(edit[1], 0.0),), "pin")
        else:
            document.set_value(edit[0], float(edit[1]))
    last = document.state
    while document.can_redo:
        document.redo()
    end = document.state
    while document.can_undo:
        document.undo()
    assert document.state == planned_state
    while document.can_redo:
        document.redo()
    assert document.state == end
    assert replace(last) == last
