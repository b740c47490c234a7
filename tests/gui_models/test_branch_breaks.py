"""A branch that changes within a pass is told and marked; lines on two branches are two lines."""

from dataclasses import replace

import numpy as np
import pytest

import solver
from posopt_gui.viewmodels.branch_breaks import branch_break, branch_changes
from posopt_gui.viewmodels.map_lines import drawn_alike, end_words, line_of, places_apart
from posopt_gui.viewmodels.map_model import BEST_OF_ALL, Choice, MapModel
from posopt_gui.viewmodels.verdicts import plan_note


def plain(text, **values):
    return text.format(**values)


@pytest.fixture(scope="module")
def result():
    return solver.plan(solver.load_cell("groove_hw300"))


def nodes_on(result, slot, lean_row):
    """A node at one lean on one branch for every waypoint."""
    candidate = result.candidates.nodes.candidate
    found = []
    for waypoint in range(len(result.candidates.outcome)):
        own = (candidate[:, 0] == waypoint) & (candidate[:, 1] == lean_row)
        rows = np.flatnonzero(own & (candidate[:, 2] == slot))
        found.append(int(rows[0]))
    return np.array(found)


def two_branches(result):
    """A row of leans that two branches hold at every waypoint, and both their nodes."""
    candidates = result.candidates
    for row in range(len(candidates.orientations)):
        held = [
            slot
            for slot in range(len(candidates.branches))
            if (candidates.outcome[:, row, slot] == 0).all()
        ]
        if len(held) > 1:
            return [nodes_on(result, slot, row) for slot in held[:2]]
    raise AssertionError("no lean is held by two branches")


def test_changes_count_within_passes_alone():
    branch = np.array([0, 0, 1, 1, 0, 0, 2])
    assert branch_changes(branch, np.array([0, 0, 0, 1, 1, 1, 1])).tolist() == [1, 3, 5]
    assert branch_changes(branch, np.array([0, 0, 1, 1, 2, 2, 2])).tolist() == [5]
    assert branch_changes(branch, np.array([0, 0, 1, 1, 2, 2, 3])).tolist() == []


def test_a_sequence_that_changes_its_branch_within_a_pass_is_a_warning(result):
    sequence = result.sequence
    assert branch_break(result.problem, sequence, plain) is None
    assert plan_note(result, sequence, plain).severity == "info"
    branch = sequence.branch.copy()
    branch[28:] += 1
    note = plan_note(result, replace(sequence, branch=branch), plain)
    assert note.severity == "warning"
    assert note.waypoint == 27
    assert note.text == ("The arm changes its branch between waypoints 28 and 29, within pass 1.")
    branch[40:] -= 1
    again = branch_break(result.problem, replace(sequence, branch=branch), plain)
    assert again.text.endswith("such changes in all: 2.")


def test_both_warnings_are_said_together(result):
    sequence = result.sequence
    branch, clearance = sequence.branch.copy(), sequence.clearance.copy()
    branch[28:] += 1
    clearance[10] = 0.02
    both = plan_note(result, replace(sequence, branch=branch, clearance=clearance), plain)
    assert "changes its branch" in both.text
    assert "less than the" in both.text


def test_the_map_marks_where_the_branch_changes(result):
    one, other = two_branches(result)
    mixed = np.concatenate([one[:28], other[28:]])
    model = MapModel(result.candidates)
    line = line_of(result.candidates, "f", mixed)
    assert model.branch_breaks(line.candidate[:, 2]).tolist() == [28.5]
    straight = line_of(result.candidates, "f", one)
    assert model.branch_breaks(straight.candidate[:, 2]).tolist() == []


def test_lines_of_the_same_leans_on_two_branches_are_two_lines_with_their_branches(result):
    found, branches = result.candidates, result.candidates.branches
    one, other = two_branches(result)
    lines = (line_of(found, "exact", one), line_of(found, "f2", other))
    np.testing.assert_array_equal(lines[0].lean, lines[1].lean)
    drawn, _ = drawn_alike(lines, BEST_OF_ALL, 1, 1)
    assert len(drawn) == 2
    slots = [int(line.candidate[0, 2]) for line in drawn]
    assert end_words(drawn, branches, plain) == tuple(
        f"{name} · branch {branches[slot]}"
        for name, slot in zip(("exact", "f2"), slots, strict=True)
    )
    assert places_apart(drawn) == (0, 1)
    same = (lines[0], line_of(found, "f2", one))
    alike, _ = drawn_alike(same, Choice(), 1, 1)
    assert end_words(alike, branches, plain) == ("exact, f2",)
