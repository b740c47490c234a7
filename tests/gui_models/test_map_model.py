"""The map's arrays against loops over the candidates, and its colours against their meaning."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest

import solver
from posopt_gui.viewmodels.map_colours import (
    NO_VALUE_INDEX,
    REJECTED_INDEX,
    CellClass,
    Layer,
)
from posopt_gui.viewmodels.map_lines import (
    BEFORE,
    CHOSEN,
    CONSTANT,
    answer_bands,
    constant_nodes,
    drawn_alike,
    error_bands,
    line_of,
    node_edges,
    runs,
    scheme_search,
    sequence_lines,
)
from posopt_gui.viewmodels.map_model import (
    BEST_OF_ALL,
    Choice,
    MapModel,
    extra_cost_percent,
)
from posopt_gui.viewmodels.map_readings import card
from solver.analysis.diagnosis import InfeasiblePathError
from solver.candidates.outcomes import Outcome
from solver.model.settings import Scheme, Sweep
from solver.model.wishes import Pin, Region
from solver.pipeline.replanning import replan

SCHEMES = (Scheme.EXACT, Scheme.F, Scheme.F1, Scheme.F2)
VALUED = (Layer.CLEARANCE, Layer.MANIPULABILITY, Layer.LIMIT_MARGIN, Layer.EXTRA_COST)


def plain(text, **values):
    return text.format(**values)


@pytest.fixture(scope="module")
def results():
    found = {
        name: solver.plan(solver.load_cell(name), compare=SCHEMES)
        for name in ("groove_paper", "groove_hw300")
    }
    problem = solver.load_cell("groove_hw300")
    some = replace(
        problem.settings,
        lean=Sweep(-0.3, 0.3, 0.1),
        lead=Sweep(-0.1, 0.1, 0.1),
        spin=Sweep(-0.2, 0.2, 0.4),
        branches=(0, 1, 6),
    )
    found["lead_and_spin"] = solver.plan(replace(problem, settings=some))
    return found


CELLS = ("groove_paper", "groove_hw300", "lead_and_spin")


def expected_value(result, node, layer):
    problem, nodes = result.problem, result.candidates.nodes
    joints = nodes.pendant[node]
    if layer is Layer.CLEARANCE:
        return nodes.clearance[node] * 1000.0
    if layer is Layer.MANIPULABILITY:
        return float(solver.manipulability(solver.jacobian(problem.robot, joints)))
    if layer is Layer.EXTRA_COST:
        return 100.0 * result.extra_cost[node] / result.sequences[Scheme.EXACT].cost
    low, high = problem.robot.elbow_limits
    slack = [joints[1] + joints[2] - low, high - joints[1] - joints[2]]
    for joint, (lower, upper) in zip(joints, problem.joint_limits, strict=True):
        slack += [joint - lower, upper - joint]
    return math.degrees(min(slack))


def nodes_of_cell(result, model, waypoint, row, choice):
    """All nodes of a cell on a page, by going through the list of nodes."""
    found = []
    nodes = result.candidates.nodes
    for node in range(nodes.offsets[waypoint], nodes.offsets[waypoint + 1]):
        _, orientation, slot, turn = nodes.candidate[node]
        angles = np.degrees(result.candidates.orientations[orientation])
        fits = (
            abs(angles[0] - model.leans[row]) < 1e-9
            and choice.slot in (None, slot)
            and choice.turn in (None, turn)
            and (choice.lead is None or abs(angles[1] - model.leads[choice.lead]) < 1e-9)
            and (choice.spin is None or abs(angles[2] - model.spins[choice.spin]) < 1e-9)
        )
        if fits:
            found.append(node)
    return found


def class_of(result, waypoint, orientation, slot):
    outcome = Outcome(result.candidates.outcome[waypoint, orientation, slot])
    if outcome is not Outcome.FEASIBLE:
        return CellClass(int(outcome))
    safety = result.problem.settings.safety_distance
    near = result.candidates.clearance[waypoint, orientation, slot] < safety
    return CellClass.NEAR if near else CellClass.SAFE


def choices_of(model):
    pages = [Choice(page.slot, page.turn) for page in model.pages]
    if len(model.leads) > 1:
        pages += [Choice(lead=1), Choice(lead=2, spin=0), Choice(0, 0, 1, 1)]
    return pages


def sampled(model, seed=3):
    generator = np.random.default_rng(seed)
    return [
        (int(generator.integers(model.waypoints)), int(generator.integers(model.rows)))
        for _ in range(25)
    ]


@pytest.mark.parametrize("name", CELLS)
def test_pages_hold_all_nodes_once_and_the_best_of_all_holds_every_node(results, name):
    result = results[name]
    model = MapModel(result.candidates)
    first, *others = model.pages
    assert (first.slot, first.turn, first.nodes) == (None, None, len(result.candidates.nodes))
    assert sum(page.nodes for page in others) == len(result.candidates.nodes)
    keys = {(int(slot), int(turn)) for _, _, slot, turn in result.candidates.nodes.candidate}
    assert {(page.slot, page.turn) for page in others} == keys
    for page in others:
        assert page.branch == result.candidates.branches[page.slot]
        rows = np.flatnonzero(
            (result.candidates.nodes.candidate[:, 2:] == (page.slot, page.turn)).all(axis=1)
        )
        joints = result.candidates.nodes.pendant[rows[0]]
        assert solver.config_string(result.problem.robot, joints).startswith(page.letters)


@pytest.mark.parametrize("name", CELLS)
@pytest.mark.parametrize("layer", VALUED)
def test_each_cell_shows_the_best_of_its_nodes_and_its_value(results, name, layer):
    result = results[name]
    model = MapModel(result.candidates)
    given = extra_cost_percent(result.extra_cost, result.sequences[Scheme.EXACT].cost)
    for choice in choices_of(model):
        cells = model.cells(layer, choice, given)
        for waypoint, row in sampled(model):
            held = nodes_of_cell(result, model, waypoint, row, choice)
            if not held:
                assert cells.node[waypoint, row] == -1
                assert np.isnan(cells.values[waypoint, row])
                continue
            values = [expected_value(result, node, layer) for node in held]
            best = min(values) if layer is Layer.EXTRA_COST else max(values)
            assert cells.node[waypoint, row] in held
            assert cells.values[waypoint, row] == pytest.approx(best, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("name", CELLS)
def test_by_outcome_a_cell_shows_the_candidate_that_came_furthest(results, name):
    order = [
        CellClass.UNREACHABLE, CellClass.JOINT_LIMIT, CellClass.SINGULAR, CellClass.COLLISION,
        CellClass.MARGIN, CellClass.SELF_COLLISION, CellClass.NEAR, CellClass.SAFE,
    ]  # fmt: skip
    result = results[name]
    model = MapModel(result.candidates)
    cells = model.cells(Layer.OUTCOME, BEST_OF_ALL)
    assert cells.values is None
    for waypoint, row in sampled(model, 5):
        seen = [
            class_of(result, waypoint, orientation, slot)
            for orientation, angles in enumerate(result.candidates.orientations)
            if abs(math.degrees(angles[0]) - model.leans[row]) < 1e-9
            for slot in range(len(result.candidates.branches))
        ]
        assert CellClass(cells.kind[waypoint, row]) is max(seen, key=order.index)
        shown = class_of(
            result, waypoint, cells.orientation[waypoint, row], cells.slot[waypoint, row]
        )
        assert shown is CellClass(cells.kind[waypoint, row])


def test_a_page_of_a_turn_shows_where_that_turn_is_outside_the_joint_limits(results):
    result = results["groove_hw300"]
    model = MapModel(result.candidates)
    page = max(model.pages, key=lambda one: one.turn or 0)
    cells = model.cells(Layer.OUTCOME, Choice(page.slot, page.turn))
    for waypoint in range(0, model.waypoints, 7):
        for row in range(0, model.rows, 5):
            own = class_of(result, waypoint, row, page.slot)
            turns = result.candidates.turns[waypoint, row, page.slot]
            lacks = own in {CellClass.SAFE, CellClass.NEAR} and turns <= page.turn
            wanted = CellClass.JOINT_LIMIT if lacks else own
            assert CellClass(cells.kind[waypoint, row]) is wanted
            assert (cells.node[waypoint, row] >= 0) == wanted.feasible


def test_groove_paper_counts_of_outcomes_are_the_published_ones(results):
    model = MapModel(results["groove_paper"].candidates)
    found = model.counts(model.cells(Layer.OUTCOME, BEST_OF_ALL).kind)
    feasible = found[CellClass.SAFE] + found[CellClass.NEAR]
    assert (feasible, found[CellClass.SINGULAR], found[CellClass.COLLISION]) == (1133, 10, 1407)


def test_by_outcome_the_best_of_a_cell_is_the_cheapest_of_its_best_class(results):
    result = results["groove_hw300"]
    model = MapModel(result.candidates)
    given = extra_cost_percent(result.extra_cost, result.sequences[Scheme.EXACT].cost)
    cells = model.cells(Layer.OUTCOME, BEST_OF_ALL, given)
    for waypoint, row in sampled(model, 9):
        held = nodes_of_cell(result, model, waypoint, row, BEST_OF_ALL)
        safe = [n for n in held if result.candidates.nodes.clearance[n] >= 0.05]
        if safe:
            cheapest = min(given[node] for node in safe)
            shown = given[cells.node[waypoint, row]]
            assert shown == cheapest or shown == pytest.approx(cheapest, abs=1e-8)


@pytest.mark.parametrize("name", CELLS)
def test_a_reading_names_what_stands_in_the_cell(results, name):
    result = results[name]
    model = MapModel(result.candidates)
    cells = model.cells(Layer.CLEARANCE, BEST_OF_ALL)
    for waypoint, row in sampled(model, 11):
        reading = model.reading(cells, waypoint, row)
        angles = np.degrees(result.candidates.orientations[reading.orientation])
        assert (reading.lean, reading.lead, reading.spin) == pytest.approx(tuple(angles))
        assert reading.lean == pytest.approx(model.leans[row])
        assert reading.branch == result.candidates.branches[reading.slot]
        if reading.node is None:
            assert reading.turn is None
            assert not reading.kind.feasible
        else:
            row_of_node = result.candidates.nodes.candidate[reading.node]
            assert tuple(row_of_node) == (
                waypoint, reading.orientation, reading.slot, reading.turn
            )  # fmt: skip


def test_the_card_tells_every_filter_of_the_explanation_and_never_overstates_a_clearance(results):
    result = results["groove_hw300"]
    model = MapModel(result.candidates)
    cells = model.cells(Layer.OUTCOME, BEST_OF_ALL)
    for waypoint, row in sampled(model, 13):
        reading = model.reading(cells, waypoint, row)
        lean = float(result.candidates.orientations[reading.orientation, 0])
        explained = solver.explain(
            result.problem, waypoint, lean, reading.branch, turn=reading.turn or 0
        )
        words = card(model, reading, {Layer.EXTRA_COST: math.inf}, explained, plain)
        assert words.rows[0].value == "no sequence passes"
        assert len(words.rows) == 1 + len(explained.filters)
        assert words.title.startswith(f"Waypoint {waypoint + 1} ")
        for line, one in zip(words.rows[1:], explained.filters, strict=True):
            assert line.passed == one.passed
            number = float(re.match(r"[+−]?[\d.]+", line.margin)[0].replace("−", "-"))
            if one.filter is Outcome.COLLISION:
                # As in the inspector: a clearance, and what it is beyond the safety distance.
                kept = one.margin - 1000.0 * result.problem.settings.safety_distance
                assert kept - 0.1 - 1e-9 <= number <= kept + 1e-9
                found = float(line.value.removesuffix(" mm").replace("−", "-"))
                assert one.margin - 0.1 - 1e-9 <= found <= one.margin + 1e-9
            elif one.unit == "mm":
                assert one.margin - 0.1 - 1e-9 <= number <= one.margin + 1e-9
        labels = [line.label for line in words.rows]
        assert len(set(labels)) == len(labels)


def test_empty_layers_are_those_without_a_node(results):
    candidates = results["groove_paper"].candidates
    assert len(MapModel(candidates).empty_layers) == 0
    shortened = replace(candidates.nodes, offsets=np.array([0, 3, 3, 5, 5]))
    assert MapModel(replace(candidates, nodes=shortened)).empty_layers.tolist() == [1, 3]


def test_rejected_cells_and_nodes_without_a_value_have_colours_of_their_own(results):
    result = results["groove_hw300"]
    model = MapModel(result.candidates)
    given = extra_cost_percent(result.extra_cost, result.sequences[Scheme.EXACT].cost)
    cells = model.cells(Layer.EXTRA_COST, BEST_OF_ALL, given)
    indices = cells.indices(model.scale(Layer.EXTRA_COST, given))
    assert ((indices == REJECTED_INDEX) == (cells.node < 0)).all()
    passes = np.isfinite(cells.values)
    assert ((indices == NO_VALUE_INDEX) == ((cells.node >= 0) & ~passes)).all()
    assert (cells.values[passes] >= 0.0).all()
    chosen = result.sequences[Scheme.EXACT].nodes
    row = result.candidates.nodes.candidate[chosen, 1]
    assert cells.values[np.arange(model.waypoints), row] == pytest.approx(0.0, abs=1e-7)
    assert (indices[np.arange(model.waypoints), row] >= 254).all()


@pytest.mark.parametrize("scheme", [Scheme.F, Scheme.F1, Scheme.F2])
@pytest.mark.parametrize("name", ["groove_paper", "groove_hw300"])
def test_the_search_that_is_run_again_is_the_one_of_the_plan(results, name, scheme):
    result = results[name]
    path, order = scheme_search(result, scheme)
    assert (path == result.sequences[scheme].nodes).all()
    closed = order[np.isfinite(order)]
    assert len(closed) == result.sequences[scheme].expanded
    assert sorted(closed) == list(range(1, len(closed) + 1))
    assert np.isfinite(order[path]).all()
    assert order[path[-1]] == len(closed)


def test_the_constant_lean_runs_at_one_lean_and_keeps_the_safety_distance(results):
    result = results["groove_hw300"]
    nodes = constant_nodes(result)
    line = line_of(result.candidates, CONSTANT, nodes)
    reference = solver.references(result)[1]
    assert line.lean == pytest.approx(math.degrees(reference.lean))
    assert result.candidates.nodes.clearance[nodes].min() == reference.least_clearance
    assert line.waypoint.tolist() == list(range(1, 51))


def test_the_chosen_line_comes_first_and_equal_ones_share_it(results):
    result = results["groove_paper"]
    lines = sequence_lines(result, None, [scheme.value for scheme in SCHEMES])
    assert lines[0].key == "exact"
    assert lines[0].lean == pytest.approx(np.degrees(result.sequence.angles[:, 0]))
    named = [name for line in lines for name in line.names]
    assert sorted(named) == sorted({"exact", "f", "f1", "f2"})
    for line in lines:
        for name in line.names:
            nodes = result.sequences[Scheme(name)].nodes
            assert (line.candidate == result.candidates.nodes.candidate[nodes]).all()


def test_with_wishes_the_answer_is_chosen_and_the_plan_without_them_stays(results):
    result = results["groove_hw300"]
    lean = float(np.radians(6.0))
    answer = replan(result, [Pin(24, lean)])
    chosen, before = sequence_lines(result, answer, [])
    assert (chosen.key, before.key) == (CHOSEN, BEFORE)
    assert chosen.lean[24] == pytest.approx(6.0)
    assert before.lean == pytest.approx(np.degrees(result.sequence.angles[:, 0]))


def test_lines_on_different_branches_are_never_one(results):
    result = results["groove_hw300"]
    lines = sequence_lines(result, None, ["exact", "f2"])
    first, other = lines
    assert (first.lean == other.lean).all()
    assert first.candidate[0, 2:].tolist() != other.candidate[0, 2:].tolist()
    together, _ = drawn_alike(lines, BEST_OF_ALL, 1, 1)
    assert [line.names for line in together] == [("exact",), ("f2",)]
    own = Choice(int(first.candidate[0, 2]), int(first.candidate[0, 3]))
    apart, pages = drawn_alike(lines, own, 1, 1)
    assert len(apart) == 2
    assert pages[0].all()
    assert not pages[1].any()


def test_an_impossible_wish_becomes_a_band_with_its_reason(results):
    result = results["groove_hw300"]
    answer = replan(result, [], [Region(30, 30, -1.0, 1.0)])
    (band,) = answer_bands(answer)
    assert band.waypoint == 30
    assert "waypoint 31" in band.text
    assert answer_bands(replan(result, [Pin(3, 0.1745329251994330)])) == ()
    assert answer_bands(None) == ()


def test_empty_layers_of_a_failed_plan_become_bands():
    problem = solver.load_cell("groove_hw300")
    placement = problem.workpiece.placement.copy()
    placement[0, 3] += 1.1
    moved = replace(problem, workpiece=replace(problem.workpiece, placement=placement))
    with pytest.raises(InfeasiblePathError) as caught:
        solver.plan(moved)
    model = MapModel(solver.generate(moved))
    bands = error_bands(caught.value, map(int, model.empty_layers))
    assert [band.waypoint for band in bands] == model.empty_layers.tolist()
    assert bands[0].text == str(caught.value.empty[0])
    spans = runs(bands)
    covered = [layer for first, last, _ in spans for layer in range(first, last + 1)]
    assert covered == model.empty_layers.tolist()


def test_edges_of_a_node_go_to_every_shown_node_beside_it_that_a_step_may_reach(results):
    result = results["groove_hw300"]
    model = MapModel(result.candidates)
    cells = model.cells(Layer.CLEARANCE, Choice(0, 0))
    node = int(result.sequence.nodes[20])
    limits = np.full((model.waypoints - 1, 6), np.inf)
    limits[:, :] = np.radians(8.0)
    graph = replace(result.graph, steps=result.candidates.nodes.pendant, step_limits=limits)
    x, y = node_edges(graph, cells, model.leans, node, model.row_of_node(node))
    drawn = {(float(a), round(float(b), 6)) for a, b in zip(x[1::2], y[1::2], strict=True)}
    pendant = result.candidates.nodes.pendant
    wanted = set()
    for other in (19, 21):
        for row in range(model.rows):
            there = cells.node[other, row]
            if there >= 0 and np.abs(pendant[there] - pendant[node]).max() <= np.radians(8.0):
                wanted.add((other + 1.0, round(float(model.leans[row]), 6)))
    assert drawn == wanted
    assert 0 < len(wanted) < 2 * model.rows
    assert (x[0::2] == 21.0).all()
