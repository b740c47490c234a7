"""Pins and forbidden regions: the cheapest sequence that fulfils them, and its price."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from solver.candidates.outcomes import Outcome
from solver.catalog import load_cell
from solver.model.settings import Scheme
from solver.model.wishes import Pin, Region
from solver.pipeline.planning import layered_graph, plan, rounded_clearance
from solver.pipeline.replanning import allowed_nodes, replan
from solver.search.exact import exact
from solver.units import DEG


@pytest.fixture(scope="module")
def planned():
    return plan(load_cell("groove_paper"))


def plain_optimum(result, allowed):
    """Cost and nodes of the cheapest sequence over allowed nodes, by plain dynamic programming."""
    nodes = result.candidates.nodes
    model = nodes.model / result.problem.robot.cost_ranges
    layers = [
        np.flatnonzero(allowed & (nodes.candidate[:, 0] == layer))
        for layer in range(len(result.problem.toolpath))
    ]
    value = np.zeros(len(layers[0]))
    for before, after in pairwise(layers):
        edges = np.abs(model[after][None] - model[before][:, None]).sum(axis=2)
        value = (value[:, None] + edges).min(axis=0)
    return float(value.min())


def fits(result, node, pins, regions):
    """Whether a node may be passed, by the words of the wishes."""
    candidates = result.candidates
    waypoint, orientation, slot, turn = map(int, candidates.nodes.candidate[node])
    branch, lean = candidates.branches[slot], candidates.orientations[orientation, 0]
    if candidates.nodes.clearance[node] < result.hard_minimum:
        return False
    for pin in pins:
        meant = pin.branch in (None, branch) and pin.turn in (None, turn)
        if pin.waypoint == waypoint and not (meant and abs(lean - pin.lean) < 1e-6):
            return False
    return not any(
        one.first <= waypoint <= one.last
        and one.low - 1e-6 <= lean <= one.high + 1e-6
        and one.branch in (None, branch)
        for one in regions
    )


@pytest.mark.parametrize("seed", range(10))
def test_wishes_leave_exactly_the_nodes_that_their_words_leave(planned, seed):
    """Also with two pins at one waypoint, and with wishes beyond both ends of the path."""
    rng = np.random.default_rng(seed)
    count, leans = len(planned.problem.toolpath), planned.candidates.orientations[:, 0]
    slots, turns = [None, *planned.candidates.branches], [None, 0, 1]
    pins = [
        Pin(int(waypoint), float(rng.choice(leans)), rng.choice(slots), rng.choice(turns))
        for waypoint in (*rng.integers(-2, count + 2, 3), count // 2, count // 2)
    ]
    regions = []
    for _ in range(3):
        first, last = sorted(rng.integers(-5, count + 5, 2).tolist())
        low, high = sorted(rng.choice(leans, 2).tolist())
        regions.append(Region(first, last, low, high, rng.choice(slots)))
    allowed = allowed_nodes(planned, pins, regions)
    wanted = [fits(planned, node, pins, regions) for node in range(len(allowed))]
    np.testing.assert_array_equal(allowed, wanted)


def test_without_wishes_nothing_changes_and_nothing_is_paid(planned):
    answer = replan(planned)
    assert answer.price == pytest.approx(0.0, abs=1e-12)
    np.testing.assert_array_equal(answer.sequence.nodes, planned.sequence.nodes)


@pytest.mark.parametrize("seed", range(8))
def test_a_pin_is_passed_at_the_price_of_plain_dynamic_programming(planned, seed):
    rng = np.random.default_rng(seed)
    nodes = planned.candidates.nodes
    possible = np.flatnonzero(np.isfinite(planned.extra_cost))
    chosen = possible[rng.choice(len(possible), 2, replace=False)]
    pins = [
        Pin(int(nodes.candidate[node, 0]), float(planned.candidates.lean[node])) for node in chosen
    ]
    pins = list({pin.waypoint: pin for pin in pins}.values())
    answer = replan(planned, pins)
    for pin in pins:
        assert answer.sequence.angles[pin.waypoint, 0] == pytest.approx(pin.lean)
    wanted = plain_optimum(planned, allowed_nodes(planned, pins, []))
    assert answer.sequence.cost == pytest.approx(wanted, abs=1e-12)
    assert answer.price == pytest.approx(wanted - planned.sequence.cost, abs=1e-12)


def test_the_price_of_one_pin_is_the_extra_cost_of_its_node(planned):
    nodes = planned.candidates.nodes
    node = int(np.flatnonzero(np.isfinite(planned.extra_cost) & (nodes.candidate[:, 0] == 20))[3])
    pin = Pin(20, float(planned.candidates.lean[node]), branch=0)
    assert replan(planned, [pin]).price == pytest.approx(planned.extra_cost[node], abs=1e-12)


def test_a_forbidden_region_is_left_out(planned):
    leans = planned.sequence.angles[10:20, 0]
    region = Region(10, 19, float(leans.min()), float(leans.max()))
    answer = replan(planned, regions=[region])
    moved = answer.sequence.angles[10:20, 0]
    assert np.all((moved < region.low - 1e-6) | (moved > region.high + 1e-6))
    wanted = plain_optimum(planned, allowed_nodes(planned, [], [region]))
    assert answer.sequence.cost == pytest.approx(wanted, abs=1e-12)


def test_a_region_of_another_branch_changes_nothing(planned):
    region = Region(0, 49, -25.0 * DEG, 25.0 * DEG, branch=5)
    assert replan(planned, regions=[region]).price == pytest.approx(0.0, abs=1e-12)


def test_a_layer_without_any_place_left_is_named(planned):
    answer = replan(planned, regions=[Region(7, 9, -1.0, 1.0)])
    assert answer.sequence is None
    assert answer.layer == 7
    assert "waypoint 8" in answer.reason


def test_a_pin_where_nothing_is_feasible_says_so(planned):
    answer = replan(planned, [Pin(12, 80.0 * DEG)])
    assert answer.sequence is None
    assert answer.layer == 12
    assert "pinned" in answer.reason


def test_a_branch_that_changes_within_a_pass_is_bound_to_links():
    """The graph with one branch a pass has no sequence from one branch into another."""
    problem = load_cell("groove_paper")
    settings = replace(problem.settings, branches=tuple(range(8)), safety_distance=0.0)
    result = plan(replace(problem, settings=settings), compare=(Scheme.EXACT,))
    candidates = result.candidates
    branch = candidates.branches[candidates.nodes.candidate[:, 2]]
    layer = candidates.nodes.candidate[:, 0]
    other = next(
        number
        for number in range(1, 8)
        if all(((branch == number) & (layer == one)).any() for one in range(25, 50))
    )
    allowed = np.where(layer < 25, branch == 0, branch == other)
    free, _ = layered_graph(candidates).subgraph(allowed)
    bound, _ = layered_graph(candidates, one_branch=True).subgraph(allowed)
    assert exact(free).found
    assert not exact(bound).found


def test_one_branch_along_each_pass_costs_what_the_free_optimum_costs_when_it_keeps_to_one():
    result = plan(load_cell("groove_hw300"))
    bound = layered_graph(result.candidates, one_branch=True)
    allowed = result.candidates.nodes.clearance >= result.hard_minimum
    graph, _ = bound.subgraph(allowed)
    assert exact(graph).cost == pytest.approx(result.sequence.cost, abs=1e-12)


@pytest.fixture(scope="module")
def groove():
    return plan(load_cell("groove_hw300"))


def branches_at(result, waypoint, lean):
    """Branches that are feasible and far enough away at a waypoint and a lean."""
    candidates = result.candidates
    at, _, slot, _ = candidates.nodes.candidate.T
    fits = (at == waypoint) & (np.abs(candidates.lean - lean) < 1e-9)
    fits &= candidates.nodes.clearance >= result.hard_minimum
    return set(candidates.branches[slot[fits]].tolist())


def test_a_pin_of_another_branch_does_not_change_the_branch_within_a_pass(groove):
    """The arm turned over between two waypoints, the tool 2.3 m away, and nothing was said."""
    own = int(groove.sequence.branch[20])
    others = branches_at(groove, 20, 14.0 * DEG) - {own}
    assert others
    for branch in others:
        answer = replan(groove, [Pin(20, 14.0 * DEG, branch)])
        if answer.sequence is None:
            assert "within a pass" in answer.reason
            assert f"waypoints {answer.layer} and {answer.layer + 1}," in answer.reason
            assert np.isinf(answer.price)
        else:
            assert set(answer.sequence.branch.tolist()) == {branch}


def test_pins_of_two_branches_in_one_pass_are_refused_with_the_waypoints(groove):
    leans = {0: 14.0 * DEG, 49: 9.0 * DEG}
    one, *others = branches_at(groove, 0, leans[0])
    other = next(iter(branches_at(groove, 49, leans[49]) - {one}), None)
    assert other is not None, others
    answer = replan(groove, [Pin(0, leans[0], one), Pin(49, leans[49], other)])
    assert answer.sequence is None
    assert "within a pass" in answer.reason


@pytest.mark.parametrize("waypoint", [50, 999])
def test_a_pin_beyond_the_end_of_the_path_is_not_passed_over(groove, waypoint):
    answer = replan(groove, [Pin(waypoint, 14.0 * DEG)])
    assert answer.sequence is None
    assert f"waypoint {waypoint + 1} lies beyond the path, which has 50" in answer.reason


def test_a_region_beyond_the_end_of_the_path_is_not_passed_over(groove):
    answer = replan(groove, regions=[Region(60, 70, -1.0, 1.0)])
    assert answer.sequence is None
    assert "waypoints 61 to 71 lies beyond the path" in answer.reason
    assert replan(groove, regions=[Region(49, 70, 0.3, 0.4)]).sequence is not None


def test_a_pin_that_comes_too_near_says_how_near(groove):
    candidates = groove.candidates
    near = (candidates.nodes.clearance < groove.hard_minimum) & (candidates.nodes.clearance > 0.02)
    node = int(np.flatnonzero(near)[0])
    waypoint, lean = int(candidates.nodes.candidate[node, 0]), float(candidates.lean[node])
    at = (candidates.nodes.candidate[:, 0] == waypoint) & (candidates.lean == lean)
    best = float(candidates.nodes.clearance[at].max())
    reason = replan(groove, [Pin(waypoint, lean)]).reason
    stated = float(reason.split(" comes to ")[1].split(" mm")[0])
    assert stated == pytest.approx(best * 1000.0 - 0.05, abs=0.0501)
    assert "50.0 mm that are kept" in reason


def test_a_rejected_pin_names_its_filter_and_one_off_the_steps_its_lean(groove):
    outcome = groove.candidates.outcome[10].max(axis=1)
    dead = next(o for o in range(len(outcome)) if not (groove.candidates.outcome[10, o] == 0).any())
    lean = float(groove.candidates.orientations[dead, 0])
    label = Outcome(int(groove.candidates.outcome[10, dead].max())).label
    assert replan(groove, [Pin(10, lean)]).reason.endswith(
        f"is rejected: {label}; pin another lean"
    )
    assert "0.50 deg, is none" in replan(groove, [Pin(10, 0.5 * DEG)]).reason


def test_a_pin_inside_a_forbidden_region_says_so(groove):
    answer = replan(groove, [Pin(10, 14.0 * DEG)], [Region(10, 10, 0.0, 20.0 * DEG)])
    assert answer.layer == 10
    assert "waypoint 11 lies in a forbidden region" in answer.reason


def test_the_joints_that_are_written_keep_the_clearance_under_pins_too(groove):
    """Rounded to the program's decimals a node on the edge falls under the safety distance."""
    nodes = groove.candidates.nodes
    order = np.argsort(np.abs(nodes.clearance - groove.hard_minimum))
    edge = [n for n in order if nodes.clearance[n] >= groove.hard_minimum][:40]
    for node in edge:
        waypoint, _, slot, turn = nodes.candidate[node]
        lean = float(groove.candidates.lean[node])
        pin = Pin(int(waypoint), lean, int(groove.candidates.branches[slot]), int(turn))
        answer = replan(groove, [pin])
        if answer.sequence is not None:
            rounded = rounded_clearance(groove.candidates, answer.sequence.nodes)
            assert rounded.min() >= groove.hard_minimum
