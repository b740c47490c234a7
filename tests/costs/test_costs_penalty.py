import math

import numpy as np
import pytest

from solver.costs.penalty import safety_penalty
from solver.errors import ModelError


@pytest.mark.parametrize(
    ("clearance", "penalty"),
    [
        (0.0, math.e),
        (0.025, math.exp(0.5)),
        (0.05 * (1 - 1e-12), 1.0),
        (0.05, 0.0),
        (0.06, 0.0),
        (math.inf, 0.0),
        (-0.05, math.exp(2.0)),
    ],
)
def test_the_penalty_is_the_papers(clearance, penalty):
    assert safety_penalty([clearance], 0.05)[0] == pytest.approx(penalty, rel=1e-11)


def test_three_poses_just_inside_cost_more_than_one_that_touches():
    assert safety_penalty([0.0], 0.05).sum() < safety_penalty([0.049] * 3, 0.05).sum()


def test_without_a_safety_distance_nothing_is_penalised():
    assert safety_penalty([0.0, -0.01, 1.0], 0.0).tolist() == [0.0, 0.0, 0.0]


@pytest.mark.parametrize(("clearance", "distance"), [(math.nan, 0.05), (-math.inf, 0.05)])
def test_a_clearance_that_is_no_number_is_refused(clearance, distance):
    with pytest.raises(ModelError):
        safety_penalty(np.array([clearance]), distance)


@pytest.mark.parametrize("distance", [-0.01, math.nan, math.inf])
def test_a_safety_distance_that_is_no_length_is_refused(distance):
    with pytest.raises(ModelError):
        safety_penalty(np.array([0.1]), distance)
