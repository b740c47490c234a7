"""A saved project gives the same result, bit for bit, wherever it is opened."""

import shutil
from dataclasses import replace

import numpy as np
import pytest

from posopt_gui.controllers.session_jobs import planned_by
from posopt_gui.document.project import state_of_cell
from posopt_gui.document.project_file import load_project, project_bytes, save_project
from solver.catalog.names import resource_folder
from solver.model.scheme import Scheme
from solver.model.wishes import Pin, Region
from solver.pipeline.programming import ProgramOrder, draft_program
from solver.progress import SilentMonitor
from solver.units import DEG


@pytest.fixture
def own_state(tmp_path):
    """The default cell with a tool file of its own, a pin and a forbidden region."""
    tools = tmp_path / "tools"
    tools.mkdir()
    shutil.copy(resource_folder() / "tools" / "die_grinder.toml", tools / "mine.toml")
    state = state_of_cell("groove_hw300").with_value("tool.model", str(tools / "mine.toml"))
    state = state.with_its_files()
    shutil.rmtree(tools)
    lean = planned_by(state, (Scheme.EXACT,), SilentMonitor()).result.sequence.angles[:, 0]
    pins = (Pin(30, float(lean[30]) + 2.0 * DEG, None, None),)
    regions = (Region(20, 24, float(lean[22]) - DEG / 3.0, float(lean[22]) + DEG / 7.0, None),)
    return replace(state, pins=pins, regions=regions)


def drafted(planned):
    """The robot program of a plan under its wishes."""
    result = planned.result
    sequences = {**result.sequences, Scheme.EXACT: planned.answer.sequence}
    shown = replace(result, sequences=sequences, scheme=Scheme.EXACT)
    return draft_program(shown, ProgramOrder()).files


def test_pins_regions_and_files_come_back_with_the_same_sequence_to_the_last_bit(
    own_state, tmp_path
):
    schemes = (Scheme.EXACT, Scheme.F2)
    before = planned_by(own_state, schemes, SilentMonitor())
    assert before.answer.sequence is not None
    assert not np.array_equal(before.answer.sequence.nodes, before.result.sequence.nodes)
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    save_project(own_state, folder / "work.posopt")
    state = load_project(folder / "work.posopt")
    assert state == own_state
    assert project_bytes(state) == (folder / "work.posopt").read_bytes()
    after = planned_by(replace(state, folder=str(folder)), schemes, SilentMonitor())
    for one, other in (
        (before.answer.sequence, after.answer.sequence),
        (before.result.sequence, after.result.sequence),
        (before.result.sequences[Scheme.F2], after.result.sequences[Scheme.F2]),
    ):
        assert one.nodes.tobytes() == other.nodes.tobytes()
        assert one.pendant.tobytes() == other.pendant.tobytes()
        assert (one.joint_cost, one.least_clearance) == (other.joint_cost, other.least_clearance)
    assert before.answer.price == after.answer.price
    assert drafted(before) == drafted(after)
