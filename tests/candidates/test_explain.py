import numpy as np
import pytest

from solver.candidates.explain import explain
from solver.candidates.generate import generate
from solver.candidates.outcomes import Outcome
from solver.catalog import load_cell
from solver.errors import InputError


@pytest.fixture(scope="module", params=["groove_paper", "groove_hw300"])
def candidates(request):
    return generate(load_cell(request.param))


def test_explanations_agree_with_the_filters_that_stop_early(candidates):
    random = np.random.default_rng(3)
    shape = candidates.outcome.shape
    seen = set()
    for _ in range(400):
        n, o, b = (int(random.integers(size)) for size in shape)
        lean, lead, spin = candidates.orientations[o]
        found = explain(
            candidates.problem,
            n,
            lean,
            int(candidates.branches[b]),
            lead=lead,
            spin=spin,
            scene=candidates.scene,
        )
        outcome = Outcome(candidates.outcome[n, o, b])
        seen.add(outcome)
        if outcome in (Outcome.COLLISION, Outcome.MARGIN, Outcome.SELF_COLLISION):
            # Planning stops at whichever collision it meets first.
            assert found.outcome >= Outcome.COLLISION
            failed = {one.filter for one in found.filters if not one.passed}
            assert outcome in failed
        else:
            assert found.outcome == outcome
        if outcome is Outcome.FEASIBLE:
            assert found.clearance == pytest.approx(candidates.clearance[n, o, b], abs=1e-9)
    assert len(seen) >= 3


def test_a_margin_is_positive_exactly_when_its_filter_passes(candidates):
    for o in range(0, len(candidates.orientations), 7):
        for branch in candidates.branches:
            found = explain(
                candidates.problem,
                11,
                candidates.orientations[o, 0],
                int(branch),
                scene=candidates.scene,
            )
            for one in found.filters:
                assert one.passed == (one.margin > 0.0 or abs(one.margin) < 1e-9)


@pytest.mark.parametrize(("waypoint", "branch"), [(-1, 0), (50, 0), (0, 8), (0, -1)])
def test_a_candidate_that_does_not_exist_is_refused(candidates, waypoint, branch):
    with pytest.raises(InputError):
        explain(candidates.problem, waypoint, 0.0, branch)
