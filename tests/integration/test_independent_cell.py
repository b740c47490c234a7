"""The planned cell against an oracle that shares no code with it: see cell_oracle.py."""

from __future__ import annotations

import itertools
import re
from dataclasses import replace
from pathlib import Path

import cell_oracle as oracle
import numpy as np
import pytest

import solver
from solver.candidates.generate import generate
from solver.candidates.kernels_candidates import pose_of_joints
from solver.candidates.outcomes import Outcome
from solver.cli.main import main
from solver.model.settings import EdgeCost, StepLimits, Sweep

coal = pytest.importorskip("coal", reason="coal, the distance oracle, has wheels for Linux alone")

MM, DEG = oracle.MM, oracle.DEG
TOLERANCE = 1e-6
"""What a distance may differ by, and how near its threshold a verdict may go either way [m]."""

WAYPOINTS = 50
REFERENCE = {oracle.PAPER: 135.0 * DEG, oracle.FULL: 150.0 * DEG}
LINE = {  # in the floor frame, by hand from the two cells' descriptions
    oracle.PAPER: ((0.937125, -0.500, 0.605), (1.0215, 0.100, 0.605)),
    oracle.FULL: ((0.937125, -0.500, 0.613), (1.00125, 0.100, 0.613)),
}
EXAMPLE = Path(__file__).parents[2] / "resources" / "examples" / "groove_hw300.csv"


class Sample:
    """Candidates of a cell, so many of every outcome, drawn with a stated seed."""

    def __init__(self, cell, per_outcome, **settings):
        problem = solver.load_cell(cell)
        problem = replace(problem, settings=replace(problem.settings, **settings))
        self.cell, self.candidates = cell, generate(problem)
        rng = np.random.default_rng(20260101)
        self.rows = {}
        for outcome, count in per_outcome.items():
            found = np.argwhere(self.candidates.outcome == outcome)
            chosen = rng.choice(len(found), min(count, len(found)), replace=False)
            self.rows[outcome] = [tuple(row) for row in found[np.sort(chosen)]]

    def of(self, *outcomes):
        """Rows with the pendant joints of the given outcomes."""
        for outcome in outcomes:
            for row in self.rows[outcome]:
                yield row, oracle.pendant_of(self.candidates.joints[row])

    def wanted(self, row):
        """TCP pose that a candidate has to have, in the floor frame."""
        start, end = map(np.array, LINE[self.cell])
        lean, lead, spin = self.candidates.orientations[row[1]]
        turned = oracle.turn("y", lean) @ oracle.turn("x", lead) @ oracle.turn("z", spin)
        where = start + (end - start) * row[0] / (WAYPOINTS - 1)
        return oracle.shift(*where) @ oracle.turn("y", REFERENCE[self.cell]) @ turned


FREE, REACH, LIMIT, FLAT, HIT, MARGIN, OWN = Outcome
SAMPLES = {
    "paper": (oracle.PAPER, {FREE: 150, FLAT: 10, HIT: 100}, {}),
    "full": (oracle.FULL, {FREE: 150, LIMIT: 80, FLAT: 24, HIT: 100}, {}),
    # Far out of the shipped range, where shank, ball and robot come too close as well.
    "wide": (
        oracle.FULL,
        {FREE: 100, REACH: 40, LIMIT: 60, HIT: 60, MARGIN: 100, OWN: 100},
        {
            "lean": Sweep(-90.0 * DEG, 90.0 * DEG, 10.0 * DEG),
            "lead": Sweep(-90.0 * DEG, 90.0 * DEG, 15.0 * DEG),
        },
    ),
}


@pytest.fixture(scope="module", params=SAMPLES)
def sample(request):
    cell, per_outcome, settings = SAMPLES[request.param]
    drawn = Sample(cell, per_outcome, **settings)
    # An outcome of which nothing was drawn would be compared with nothing.
    assert all(drawn.rows.values())
    return drawn


@pytest.fixture(scope="module")
def distances():
    return {cell: oracle.CellOracle(coal, cell) for cell in (oracle.PAPER, oracle.FULL)}


@pytest.mark.parametrize(
    ("joints", "position", "wpr"),
    [
        ((0, 0, 0, 0, -90, 0), (985, 0, 940), (180, 0, 0)),
        ((30, 20, -10, 15, -60, 45), (1154.9123, 640.9070, 752.4997), (155.7498, -2.8516, 80.8485)),
        (
            (-45, 40, -30, 100, 50, -120),
            (1152.8598, -1046.1706, 360.5220),
            (-122.9172, -36.5431, -56.9336),
        ),
    ],
)
def test_the_oracle_meets_measured_poses_and_its_two_chains_agree(joints, position, wpr):
    flange = oracle.flange_of(np.array(joints) * DEG)
    assert np.allclose(flange[:3, 3] / MM - (0, 0, 525), position, atol=6e-4)
    w, p, r = np.array(wpr) * DEG
    turned = oracle.turn("z", r) @ oracle.turn("y", p) @ oracle.turn("x", w)
    assert np.allclose(flange[:3, :3], turned[:3, :3], atol=2e-6)
    assert np.allclose(flange, oracle.links_of(np.array(joints) * DEG)[6], atol=1e-12)


def test_every_solved_candidate_puts_the_tcp_on_its_waypoint(sample):
    solved = [outcome for outcome in sample.rows if outcome != REACH]
    for row, pendant in sample.of(*solved):
        assert np.allclose(oracle.tcp_of(pendant), sample.wanted(row), rtol=0.0, atol=1e-9)


def test_reach_limits_and_manipulability_reject_what_the_oracle_rejects(sample):
    for _, pendant in sample.of(*(set(sample.rows) - {REACH, LIMIT})):
        assert oracle.representatives_of(pendant)
    for _, pendant in sample.of(*(set(sample.rows) & {LIMIT})):
        assert not oracle.representatives_of(pendant)
    for _, pendant in sample.of(*(set(sample.rows) - {REACH, LIMIT, FLAT})):
        assert oracle.manipulability_of(pendant) > oracle.LEAST_MANIPULABILITY - 1e-12
    for _, pendant in sample.of(*(set(sample.rows) & {FLAT})):
        assert oracle.manipulability_of(pendant) <= oracle.LEAST_MANIPULABILITY + 1e-12
    for row, _ in sample.of(*(set(sample.rows) & {REACH})):
        out = oracle.shoulders_out_of_reach(sample.wanted(row))
        assert out > 0
        assert np.sum(sample.candidates.outcome[row[:2]] == REACH) == 4 * out


def test_clearance_equals_the_least_distance_of_the_counted_pairs(sample, distances):
    for row, pendant in sample.of(FREE):
        stated = sample.candidates.clearance[row]
        exact = distances[sample.cell].margins(pendant).clearance
        assert stated <= exact + TOLERANCE
        assert stated >= exact - TOLERANCE


def test_feasible_candidates_keep_every_margin(sample, distances):
    for _, pendant in sample.of(FREE):
        found = distances[sample.cell].margins(pendant)
        assert found.clearance > -TOLERANCE
        assert found.near >= oracle.NEAR - TOLERANCE
        assert found.ball >= oracle.NEAR - TOLERANCE
        assert found.web >= -oracle.DEPTH - TOLERANCE
        assert found.own >= oracle.SELF - TOLERANCE


def test_rejected_candidates_break_what_their_outcome_names(sample, distances):
    for outcome in set(sample.rows) & {HIT, MARGIN, OWN}:
        for _, pendant in sample.of(outcome):
            found = distances[sample.cell].margins(pendant)
            if outcome == HIT:
                assert found.clearance <= TOLERANCE
            elif outcome == MARGIN:
                assert found.tool_spare <= TOLERANCE
            else:
                assert found.own <= oracle.SELF + TOLERANCE
                assert found.clearance > -TOLERANCE
                assert found.tool_spare > -TOLERANCE


REACHING_DOWN = np.array([[-60, 20, -90, -180, -110, -180], [30, 90, -30, 180, 110, 180]]) * DEG
"""Range of joints in which the tool comes near trestles, floor and the beam's underside."""


class Postures:
    """Postures round the nodes of the full cell, as the product's check sees them."""

    def __init__(self, count):
        problem = solver.load_cell(oracle.FULL)
        candidates = generate(problem)
        self.arm, self.scene = np.array(problem.robot.arm_lengths), candidates.scene
        rng = np.random.default_rng(5)
        node = candidates.nodes.pendant[rng.integers(len(candidates.nodes), size=count)]
        reach = rng.random((2, count, 1)) * 0.5
        self.one, self.other = node + rng.normal(size=(2, count, 6)) * reach
        # Every other posture belongs to a pass that touches the web, the rest to none.
        self.touch = np.where(np.arange(count) % 2, self.scene.touch_number("web"), -1)

    def check(self, pendant, touch):
        """Status, clearance and nearest bodies, at unrounded joints."""
        model = np.array([oracle.model_of(joints) for joints in pendant])
        status, clearance, nearest, _ = pose_of_joints(self.arm, self.scene.packed, model, touch)
        return status, clearance, [self.scene.fixed[row].name for row in nearest[:, 1]]

    def flips(self):
        """Postures just behind the place where a verdict changes, what broke there, and touch."""
        inside, outside = (self.check(one, self.touch)[0] == 0 for one in (self.one, self.other))
        kept = np.flatnonzero(inside & ~outside)
        free, broken, touch = self.one[kept], self.other[kept], self.touch[kept]
        for _ in range(50):
            middle = (free + broken) / 2
            passed = self.check(middle, touch)[0] == 0
            free[passed], broken[~passed] = middle[passed], middle[~passed]
        return broken, self.check(broken, touch)[0], touch


@pytest.fixture(scope="module")
def postures():
    return Postures(2000)


def test_a_verdict_flips_where_the_oracle_meets_the_threshold(postures, distances):
    found = [
        (status, distances[oracle.FULL].margins(joints, touches_web=touch >= 0))
        for joints, status, touch in zip(*postures.flips(), strict=True)
    ]
    for status, count in ((1, 100), (2, 100), (3, 30)):
        margins = [one for which, one in found if which == status]
        spare = [
            {1: one.clearance, 2: one.tool_spare, 3: one.own - oracle.SELF}[status]
            for one in margins
        ]
        assert len(spare) >= count
        assert np.abs(spare).max() <= TOLERANCE


def test_clearance_is_exact_away_from_the_path_as_well(postures, distances):
    status, clearance, _ = postures.check(postures.one, postures.touch)
    for index in np.flatnonzero(status == 0)[::3]:
        exact = distances[oracle.FULL].margins(postures.one[index]).clearance
        assert abs(clearance[index] - exact) <= TOLERANCE


def test_clearance_is_exact_where_trestles_and_floor_are_nearest(postures, distances):
    low = np.random.default_rng(11).uniform(*REACHING_DOWN, (20_000, 6))
    status, clearance, names = postures.check(low, np.full(len(low), -1))
    for name in ("trestle_near", "trestle_far", "floor"):
        rows = [row for row, near in enumerate(names) if near == name and status[row] == 0][:40]
        assert len(rows) >= 10
        for row in rows:
            exact = distances[oracle.FULL].margins(low[row]).clearance
            assert abs(clearance[row] - exact) <= TOLERANCE


def test_the_slices_of_a_fillet_never_overstate_the_clearance_from_the_steel(distances):
    steel = oracle.CellOracle(coal, oracle.FULL, chords=40)
    for _, pendant in Sample(oracle.FULL, {FREE: 60}).of(FREE):
        sliced, exact = (one.margins(pendant) for one in (distances[oracle.FULL], steel))
        for name in ("clearance", "near", "ball"):
            stated, true = getattr(sliced, name), getattr(exact, name)
            assert true - 0.5 * MM - TOLERANCE <= stated <= true + TOLERANCE


@pytest.mark.parametrize("cell", [oracle.PAPER, oracle.FULL])
def test_every_representative_of_a_feasible_candidate_is_a_node(cell):
    candidates = generate(solver.load_cell(cell))
    nodes = candidates.nodes
    principal = cell == oracle.PAPER
    rng = np.random.default_rng(7)
    for row in rng.permutation(np.argwhere(candidates.outcome == FREE))[:100]:
        wanted = oracle.representatives_of(oracle.pendant_of(candidates.joints[tuple(row)]))
        if principal:
            wanted = [one for one in wanted if np.all(np.abs(one) <= np.pi)]
        mine = np.flatnonzero((nodes.candidate[:, :3] == row).all(axis=1))
        assert len(mine) == len(wanted) > 0
        apart = np.abs(nodes.pendant[mine][:, None] - np.array(wanted)).max(axis=2)
        assert apart.min(axis=1).max() < 1e-12
        for node in mine:
            assert np.allclose(oracle.model_of(nodes.pendant[node]), nodes.model[node], atol=1e-12)
            assert nodes.clearance[node] == candidates.clearance[tuple(row)]


@pytest.fixture(scope="module")
def written_joints(tmp_path_factory):
    """Joints [rad] of the program that `posopt plan` writes, from its first timed move's start on.

    What is timed in msec follows the path; the position before those moves begins it.
    """
    file = tmp_path_factory.mktemp("program") / "GROOVE.LS"
    assert main(["plan", "groove_hw300", "--out", str(file)]) == 0
    program, table = file.read_text("ascii").split("/POS")
    moves = re.findall(r"^ *\d+:[JL] P\[(\d+)\] (\S+)", program, re.MULTILINE)
    order = [int(number) for number, _ in moves]
    timed = [row for row, (_, speed) in enumerate(moves) if speed.endswith("msec")]
    assert timed == list(range(timed[0], timed[-1] + 1))
    value = r"J\d= *(-?\d*\.\d{3}) deg[\s,]*"
    found = re.findall(rf"P\[(\d+)\]\{{\s+GP1:\s+UF : 1, UT : 1,\s+{value * 6}\}};", table)
    positions = {int(number): np.array(joints, float) * DEG for number, *joints in found}
    assert len(positions) == len(found) == len(order)
    return [positions[number] for number in order[timed[0] - 1 : timed[-1] + 1]]


def path_of_the_example():
    """Waypoint poses (n, 4, 4) of the shipped CSV in the floor frame."""
    lines = EXAMPLE.read_text("utf-8").splitlines()
    rows = [line.split(",") for line in lines if line[:1] in "-0123456789"]
    floor_from_beam = oracle.shift(0.900, -0.200, 0.600)
    # The beam's x, y, z are the floor's y, z, x.
    floor_from_beam[:3, :3] = [[0, 0, 1], [1, 0, 0], [0, 1, 0]]
    poses = []
    for x, y, z, w, p, r in np.array(rows, float):
        turned = (oracle.turn(a, v * DEG) for a, v in (("z", r), ("y", p), ("x", w)))
        where = oracle.shift(x * MM, y * MM, z * MM)
        poses.append(floor_from_beam @ where @ np.linalg.multi_dot(list(turned)))
    return poses


def test_the_written_program_follows_the_path_and_keeps_every_limit(written_joints, distances):
    path = path_of_the_example()
    assert len(written_joints) == len(path) == WAYPOINTS
    for joints, wanted in zip(written_joints, path, strict=True):
        reached = oracle.tcp_of(joints)
        assert np.linalg.norm(reached[:3, 3] - wanted[:3, 3]) <= 0.03 * MM
        relative = wanted[:3, :3].T @ reached[:3, :3]
        lean = np.arctan2(relative[0, 2], relative[2, 2])
        assert np.allclose(relative, oracle.turn("y", lean)[:3, :3], atol=1e-4)
        assert abs(lean) <= 25.01 * DEG
        assert np.all(joints >= oracle.LOWER)
        assert np.all(joints <= oracle.UPPER)
        assert oracle.ELBOW[0] <= joints[1] + joints[2] <= oracle.ELBOW[1]
        assert oracle.manipulability_of(joints) > oracle.LEAST_MANIPULABILITY
        found = distances[oracle.FULL].margins(joints)
        assert found.clearance >= oracle.SAFETY - TOLERANCE
        assert found.spare >= -TOLERANCE


FREE_STEPS = np.full(7, np.inf)
BITING_STEPS = {  # of J1..J6 and lean [deg]: the optimum without them breaks them
    oracle.PAPER: np.array([3.0, 3.0, 3.0, 2.2, 3.0, 2.9, 1.5]),
    oracle.FULL: np.array([3.0, 3.0, 3.0, 0.7, 3.0, 1.4, 1.5]),
}


def plain_optimum(result, squared, steps):
    """Least cost of a sequence over the nodes that keep the safety distance."""
    nodes = result.candidates.nodes
    safe = nodes.clearance >= oracle.SAFETY
    lean = result.candidates.orientations[nodes.candidate[:, 1], 0]
    kept = [np.flatnonzero(safe & (nodes.candidate[:, 0] == i)) for i in range(WAYPOINTS)]
    value = np.zeros(len(kept[0]))
    for before, after in itertools.pairwise(kept):
        ends = ((nodes.pendant[one], lean[one]) for one in (before, after))
        value = (value[:, None] + edge_costs(*ends, squared, steps)).min(axis=0)
    return value.min()


def edge_costs(before, after, squared, steps):
    """(k, l) cost from nodes to nodes, given as their pendant joints and leans."""
    ends = ([oracle.model_of(j) / oracle.COST_RANGES for j in one[0]] for one in (before, after))
    first, second = map(np.array, ends)
    change = second - first[:, None]
    cost = (change**2 if squared else np.abs(change)).sum(axis=2)
    moved = np.abs(after[0] - before[0][:, None])
    tilted = np.abs(after[1] - before[1][:, None])
    allowed = (moved <= steps[:6] + 1e-12).all(axis=2) & (tilted <= steps[6] + 1e-12)
    return np.where(allowed, cost, np.inf)


def cost_of(sequence, squared, steps):
    """Cost of a sequence, edge by edge."""
    rows = [(sequence.pendant[i : i + 1], sequence.angles[i : i + 1, 0]) for i in range(WAYPOINTS)]
    pairs = itertools.pairwise(rows)
    return sum(edge_costs(before, after, squared, steps).item() for before, after in pairs)


@pytest.mark.parametrize("cell", [oracle.PAPER, oracle.FULL])
def test_the_sequence_is_the_optimum_of_plain_dynamic_programming(cell):
    result = solver.plan(solver.load_cell(cell))
    chosen = result.sequence
    assert result.clearance_met
    assert chosen.clearance.min() >= oracle.SAFETY
    assert abs(chosen.cost - plain_optimum(result, False, FREE_STEPS)) <= 1e-12
    assert abs(chosen.cost - cost_of(chosen, False, FREE_STEPS)) <= 1e-12


@pytest.mark.parametrize("cell", [oracle.PAPER, oracle.FULL])
def test_the_optimum_under_step_limits_is_that_of_plain_dynamic_programming(cell):
    problem = solver.load_cell(cell)
    steps = BITING_STEPS[cell] * DEG
    squared = replace(problem.settings, edge_cost=EdgeCost.SQUARED)
    limited = replace(squared, steps=StepLimits(joints=steps[:6], lean=steps[6]))
    free, bound = (solver.plan(replace(problem, settings=s)) for s in (squared, limited))
    assert cost_of(free.sequence, True, steps) == np.inf
    assert bound.clearance_met
    assert abs(bound.sequence.cost - plain_optimum(bound, True, steps)) <= 1e-12
    assert abs(bound.sequence.cost - cost_of(bound.sequence, True, steps)) <= 1e-12
