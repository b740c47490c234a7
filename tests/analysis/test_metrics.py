import itertools
import math
import statistics

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from solver.analysis.check import down_mm
from solver.analysis.metrics import joint_motion, lean_edge_share, mean_motion

sequences = arrays(np.float64, (7, 6), elements=st.floats(-3.0, 3.0))


@given(sequences)
def test_measures_equal_their_definitions_in_plain_python(joints):
    found = joint_motion(joints)
    for joint in range(6):
        column = joints[:, joint].tolist()
        steps = [abs(b - a) for a, b in itertools.pairwise(column)]
        assert found.variation[joint] == pytest.approx(math.fsum(steps), abs=1e-12)
        assert found.amplitude[joint] == max(column) - min(column)
        assert found.deviation[joint] == pytest.approx(statistics.pstdev(column), abs=1e-9)
        assert found.largest_step[joint] == max(steps)


@given(sequences)
def test_gain_over_itself_is_zero_where_a_joint_moves(joints):
    motion = joint_motion(joints)
    gain = motion.gain_over(motion)
    moving = motion.variation > 1e-12
    assert np.all(gain.variation[moving] == 0.0)
    assert np.all(np.isnan(gain.variation[~moving]))


def test_mean_of_motions_is_the_mean_of_each_measure():
    one = joint_motion(np.array([[0.0] * 6, [1.0] * 6]))
    two = joint_motion(np.array([[0.0] * 6, [3.0] * 6]))
    assert np.allclose(mean_motion([one, two]).variation, 2.0)


def test_share_at_the_edge_counts_both_ends_and_ignores_a_fixed_lean():
    lean = np.array([-0.4, -0.4, 0.0, 0.2, 0.4])
    assert lean_edge_share(lean, -0.4, 0.4) == pytest.approx(0.6)
    assert lean_edge_share(np.zeros(5), 0.0, 0.0) == 0.0


@given(st.floats(0.0, 1.0))
def test_a_shown_clearance_is_never_more_than_the_clearance(clearance):
    shown = down_mm(clearance)
    assert shown <= clearance * 1000.0
    assert clearance * 1000.0 - shown < 0.1 + 1e-9
