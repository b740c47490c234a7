"""When there is no sequence, the error says where, why and by how much."""

from dataclasses import replace

import numpy as np
import pytest

from solver.analysis.diagnosis import InfeasiblePathError
from solver.candidates.outcomes import Outcome
from solver.catalog import load_cell
from solver.model.settings import StepLimits, Sweep
from solver.model.toolpath import Frame
from solver.pipeline.planning import plan
from solver.transforms import rigid
from solver.units import DEG


@pytest.fixture(scope="module")
def problem():
    return load_cell("groove_hw300")


def with_settings(problem, **changes):
    return replace(problem, settings=replace(problem.settings, **changes))


def failure(problem):
    with pytest.raises(InfeasiblePathError) as caught:
        plan(problem)
    assert caught.value.exit_code == 3
    assert len(str(caught.value).splitlines()) == 1
    return caught.value


def shifted(problem, waypoint, offset):
    one = problem.toolpath.passes[0]
    poses = one.poses.copy()
    poses[waypoint] = poses[waypoint] @ rigid(position=offset)
    return replace(problem, toolpath=problem.toolpath.with_passes((replace(one, poses=poses),)))


def test_out_of_reach_says_by_how_many_millimetres(problem):
    far = rigid(position=(0.0, 3.0, 0.0)) @ problem.workpiece.placement
    error = failure(replace(problem, workpiece=replace(problem.workpiece, placement=far)))
    assert set(error.empty[0].rejected) == {Outcome.UNREACHABLE}
    reach = next(one for one in error.empty[0].nearest.filters if not one.passed)
    assert reach.unit == "mm"
    assert -3000.0 < reach.margin < -500.0
    assert "out of reach" in str(error)


def test_a_waypoint_inside_steel_names_the_bodies_and_the_waypoint(problem):
    assert problem.toolpath.frame is Frame.BEAM
    error = failure(shifted(problem, 20, (0.0, 0.0, 0.004)))
    assert [layer.waypoint for layer in error.empty] == [20]
    assert "waypoint 21" in str(error)
    assert "ball and web" in str(error)


def test_a_manipulability_that_nothing_has_is_named(problem):
    error = failure(with_settings(problem, manipulability=5.0))
    assert "near a singularity" in str(error)
    assert "m^3" in str(error)


def test_windows_that_exclude_everything_are_named_with_the_joint(problem):
    windows = problem.robot.limits.copy()
    windows[4] = (100.0 * DEG, 120.0 * DEG)
    error = failure(replace(problem, joint_windows=windows))
    assert "deg are missing: J5" in str(error)


def test_steps_that_are_too_large_name_the_gap_and_the_joint(problem):
    steps = StepLimits(joints=np.full(6, 0.2 * DEG))
    error = failure(with_settings(problem, steps=steps))
    assert error.empty == ()
    assert error.cut is not None
    assert "J" in str(error)


def test_a_single_lean_is_a_plan_too(problem):
    fixed = with_settings(problem, lean=Sweep.fixed(12.0 * DEG))
    sequence = plan(fixed).sequence
    assert np.allclose(sequence.angles[:, 0], 12.0 * DEG)
