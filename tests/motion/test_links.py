import itertools
from dataclasses import replace

import link_cells as cells
import numpy as np
import pytest
from hypothesis import given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st

from solver.collision.scene import build_scene
from solver.errors import Cancelled, InputError, RefusedError
from solver.kinematics.configuration import configuration
from solver.model.program import MotionKind, SpeedUnit, rounded_joints
from solver.model.program_settings import LinkSettings, Withdrawal
from solver.model.toolpath import Event, EventKind, Role
from solver.motion.links import linked_moves
from solver.motion.pass_ends import beyond_reach
from solver.units import DEG, MM

ROUNDING = 0.05 * MM
"""What the rounding of joints to 0.001 deg can move the TCP by [m]."""

TRAVEL = np.array([1.00125 - 0.937125, 0.6, 0.0]) / np.hypot(1.00125 - 0.937125, 0.6)
"""Direction of the groove in the floor frame, by hand from the cell's description."""

DENSE = 1.8 * MM
"""Step of the oracle's samples, finer than the 2 mm of the product [m]."""
LOW_WALL = cells.box("low_wall", (0.8, -0.2, 0.61), (1.0, -0.19, 0.80))
TALL_WALL = cells.box("tall_wall", (0.85, -0.23, 0.61), (1.4, -0.22, 1.4))
ROOF = cells.box("roof", (0.5, -0.7, 1.45), (1.4, 0.3, 1.47))


@pytest.fixture(scope="module")
def groove():
    return cells.Groove()


@pytest.fixture(scope="module")
def coal():
    return pytest.importorskip("coal", reason="the distance oracle has wheels for Linux alone")


def linked(groove, *fixtures, **settings):
    return linked_moves(cells.with_links(groove.problem, *fixtures, **settings), groove.contact)


def generated(moves):
    return [move for move in moves if move.waypoint is None]


def link_of(moves):
    """Moves from the first retract, left out, to the second approach position."""
    retract = next(
        at for at, (one, two) in enumerate(itertools.pairwise(moves))
        if one.role is Role.LEAD_OUT and two.role is not Role.LEAD_OUT
    )  # fmt: skip
    approach = next(at for at in range(retract + 1, len(moves)) if moves[at].role is Role.APPROACH)
    return moves[retract], moves[retract + 1 : approach + 1]


def assert_free(problem, oracle, moves, step, clearance):
    """Every move but those along the path keeps every distance, by the oracle's own samples."""
    for before, move in itertools.pairwise(moves):
        if before.role is Role.CONTACT and move.role is Role.CONTACT:
            continue
        touches = cells.may_touch(before, move)
        for joints in cells.followed(problem, before.joints, move, step):
            assert cells.within_limits(problem, joints)
            # The oracle's bodies are those of the cell to 1 um.
            assert oracle.lack(joints, clearance, touches_web=touches) <= 2e-6


def test_moves_come_in_the_order_of_a_grinding_pass(groove):
    on = (Event(EventKind.SPINDLE_ON), Event(EventKind.DWELL, value=1.0))
    off = (Event(EventKind.SPINDLE_OFF),)
    moves = linked(groove, home=cells.HOME, before=on, after=off)
    first, second = map(len, groove.contact)
    onto, out = [Role.APPROACH, Role.LEAD_IN], [Role.LEAD_OUT, Role.LEAD_OUT]
    assert [move.role for move in moves] == [
        Role.LINK,
        *onto, *[Role.CONTACT] * first, *out,
        *onto, *[Role.CONTACT] * second, *out,
        Role.LINK,
    ]  # fmt: skip
    assert [move.waypoint for move in moves if move.waypoint is not None] == [*range(24)]
    assert np.array_equal(moves[0].joints, rounded_joints(cells.HOME))
    assert np.array_equal(moves[-1].joints, moves[0].joints)
    for at in (1, 5 + first):
        approach, start, contact = moves[at : at + 3]
        assert approach.kind is MotionKind.JOINT
        assert approach.speed.value == 20.0
        assert (approach.cnt, approach.events) == (None, on)
        assert (start.kind, start.cnt, start.events) == (MotionKind.LINEAR, None, ())
        assert start.speed.value == pytest.approx(0.1)
        assert (contact.kind, contact.cnt) == (MotionKind.LINEAR, 100)
        assert (contact.speed.unit, contact.speed.value) == (SpeedUnit.LINEAR, 0.02)
    for at in (2 + first, 4 + first + 2 + second):
        last, end, retract = moves[at : at + 3]
        assert last.cnt == 100
        assert (end.kind, end.speed.value) == (MotionKind.LINEAR, 0.02)
        assert (retract.kind, retract.cnt, retract.events) == (MotionKind.LINEAR, None, off)
        assert retract.speed.value == pytest.approx(0.1)
    # What lies between the ends of a pass is as it was given.
    assert moves[4 : 2 + first] == groove.contact[0][1:-1]


@pytest.mark.parametrize("rule", Withdrawal)
def test_generated_points_lie_where_the_settings_put_them(groove, rule):
    lengths = {"lead_in": 0.012, "lead_in_height": 0.004, "lead_out": 0.02}
    moves = linked(
        groove, withdrawal=rule, approach=0.05, lead_out_height=0.007, home=None, **lengths
    )
    starts = [0, len(groove.contact[0]) + 4, len(moves)]
    for begin, end in itertools.pairwise(starts):
        own = moves[begin:end]
        where = cells.positions(own)
        back = [np.array([0.0, 0.0, 1.0])] * 2
        if rule is Withdrawal.TOOL:
            back = [-cells.tcp(own[at].joints)[:3, 2] for at in (2, -3)]
        wanted = {
            1: where[2] - 0.012 * TRAVEL + 0.004 * back[0],
            0: where[2] - 0.012 * TRAVEL + 0.054 * back[0],
            -2: where[-3] + 0.02 * TRAVEL + 0.007 * back[1],
            -1: where[-3] + 0.02 * TRAVEL + 0.057 * back[1],
        }
        for at, position in wanted.items():
            assert np.abs(where[at] - position).max() < ROUNDING
            contact = cells.tcp(own[2 if at >= 0 else -3].joints)
            assert np.abs(cells.tcp(own[at].joints)[:3, :3] - contact[:3, :3]).max() < 5e-5
    for move in generated(moves):
        assert np.array_equal(move.joints, rounded_joints(move.joints))


def test_without_a_lead_the_tool_comes_straight_onto_the_first_waypoint(groove):
    none = dict.fromkeys(("lead_in", "lead_in_height", "lead_out", "lead_out_height"), 0.0)
    moves = linked(groove, home=None, **none)
    assert [move.role for move in moves[:3]] == [Role.APPROACH, Role.CONTACT, Role.CONTACT]
    assert (moves[1].kind, moves[1].cnt, moves[1].waypoint) == (MotionKind.LINEAR, None, 0)
    assert moves[1].speed.value == pytest.approx(0.02)
    assert (moves[-2].role, moves[-2].cnt, moves[-1].role) == (Role.CONTACT, None, Role.LEAD_OUT)
    where = cells.positions(moves)
    assert np.linalg.norm(where[0] - where[1]) == pytest.approx(0.06, abs=ROUNDING)
    assert np.linalg.norm(where[-1] - where[-2]) == pytest.approx(0.06, abs=ROUNDING)


def test_a_waypoint_with_events_is_reached_exactly(groove):
    event = (Event(EventKind.DWELL, value=0.5),)
    one, other = groove.contact
    one = (replace(one[0], events=event), *one[1:-1], replace(one[-1], events=event))
    moves = linked_moves(cells.with_links(groove.problem, home=None), (one, other))
    for at in (2, 1 + len(one)):
        assert (moves[at].role, moves[at].cnt, moves[at].events) == (Role.CONTACT, None, event)


def test_a_pass_with_its_own_way_onto_the_face_gets_none(groove):
    on, off = (Event(EventKind.SPINDLE_ON),), (Event(EventKind.SPINDLE_OFF),)
    plain = linked(groove, home=None)
    first = len(groove.contact[0])
    # The generated ends of the first pass, now as waypoints of the person.
    own = tuple(
        replace(move, role=role)
        for move, role in zip(
            (*plain[1 : first + 3], plain[first + 3]),
            (Role.LEAD_IN, *[Role.CONTACT] * first, Role.LEAD_OUT, Role.LEAD_OUT),
            strict=True,
        )
    )
    problem = cells.with_links(groove.problem, home=None, before=on, after=off)
    moves = linked_moves(problem, (own, groove.contact[1]))
    assert [move.role for move in moves[: len(own)]] == [move.role for move in own]
    assert moves[len(own)].role is Role.APPROACH
    assert (moves[0].kind, moves[0].cnt, moves[0].events) == (MotionKind.JOINT, None, on)
    assert (moves[len(own) - 1].cnt, moves[len(own) - 1].events) == (None, off)
    assert moves[1 : len(own) - 1] == own[1:-1]


def test_every_generated_move_is_free_by_dense_sampling(groove, coal):
    problem = cells.with_links(groove.problem, home=None)
    moves = linked_moves(problem, groove.contact)
    assert_free(problem, cells.FreeOracle(coal), moves, DENSE, 10.0 * MM)


def test_moves_from_and_to_home_are_free(groove, coal):
    problem = cells.with_links(groove.problem, home=cells.HOME)
    moves = linked_moves(problem, groove.contact)
    oracle = cells.FreeOracle(coal)
    assert_free(problem, oracle, moves[:2], 5.0 * MM, 10.0 * MM)
    assert_free(problem, oracle, moves[-2:], 5.0 * MM, 10.0 * MM)


def test_a_low_wall_makes_the_link_go_over_it(groove, coal):
    problem = cells.with_links(groove.problem, LOW_WALL, home=None)
    moves = linked_moves(problem, groove.contact)
    retract, link = link_of(moves)
    assert [move.role for move in link] == [Role.LINK, Role.LINK, Role.APPROACH]
    assert [move.kind for move in link] == [
        MotionKind.LINEAR, MotionKind.JOINT, MotionKind.LINEAR
    ]  # fmt: skip
    assert all(move.cnt is None for move in link)
    start, up, across, down = cells.positions([retract, *link])
    assert np.abs(up - start - [0.0, 0.0, 0.15]).max() < ROUNDING
    assert np.abs(across - down - [0.0, 0.0, 0.15]).max() < ROUNDING
    oracle = cells.FreeOracle(coal, [LOW_WALL])
    assert_free(problem, oracle, [retract, *link], DENSE, 10.0 * MM)
    # The wall does stand in the direct way.
    direct = retract.joints + np.linspace(0, 1, 60)[:, None] * (link[-1].joints - retract.joints)
    assert max(oracle.lack(joints, 10.0 * MM, touches_web=False) for joints in direct) > 0.0


def test_half_of_the_lift_serves_where_all_of_it_is_not_free(groove):
    low_roof = cells.box("low_roof", (0.5, -0.7, 1.60), (1.4, 0.3, 1.62))
    moves = linked(groove, LOW_WALL, low_roof, home=None, height=0.4)
    retract, link = link_of(moves)
    start, up, *_ = cells.positions([retract, *link])
    assert np.abs(up - start - [0.0, 0.0, 0.2]).max() < ROUNDING


def test_a_wall_with_a_roof_makes_the_planner_find_the_link(groove, coal):
    problem = cells.with_links(groove.problem, TALL_WALL, ROOF, home=None, height=0.3)
    moves = linked_moves(problem, groove.contact)
    retract, link = link_of(moves)
    assert all(move.kind is MotionKind.JOINT and move.cnt is None for move in link)
    assert len(link) >= 2
    oracle = cells.FreeOracle(coal, [TALL_WALL, ROOF])
    assert_free(problem, oracle, [retract, *link], DENSE, 10.0 * MM)


def test_the_branch_changes_on_links_alone(groove):
    joints = groove.joints[1]
    problem = cells.with_links(groove.problem, home=cells.HOME)
    # The same contact with the wrist turned over.
    flipped = joints * [1, 1, 1, 1, -1, 1] + np.outer(
        np.ones(len(joints)), np.radians([0, 0, 0, 180, 0, -180])
    )
    contact = (groove.contact[0], cells.contact_moves(rounded_joints(flipped), 12))
    moves = linked_moves(problem, contact)
    config = [configuration(problem.robot, move.joints) for move in moves]
    letters = [(one.flip, one.up, one.front) for one in config]
    changes = [
        moves[at].role for at in range(1, len(moves)) if letters[at] != letters[at - 1]
    ]  # fmt: skip
    assert changes
    assert set(changes) <= {Role.LINK, Role.APPROACH}


def test_the_same_problem_gives_the_same_moves(groove):
    problem = cells.with_links(groove.problem, TALL_WALL, ROOF, home=None, height=0.3)
    runs = []
    for seed in (1, 2):
        np.random.seed(seed)  # noqa: NPY002 - what others do with numpy's state must not matter
        moves = linked_moves(problem, groove.contact)
        runs.append([(m.joints.tobytes(), m.kind, m.speed, m.cnt, m.role) for m in moves])
    assert runs[0] == runs[1]


def test_a_link_without_a_free_way_names_the_two_bodies(groove):
    # The windows keep the arm stretched out, so that it always crosses the pillar's radius.
    low, high = np.radians([-40, -20, -45, -200, -140, -270]), np.radians([60, 5, 5, 200, 140, 270])
    pillar = cells.box("pillar", (0.55, 0.45, 0.0), (0.65, 0.55, 3.0))
    home = np.radians([60.0, -10.0, -20.0, 0.0, -60.0, 0.0])
    problem = cells.with_links(groove.problem, pillar, home=home)
    problem = replace(problem, joint_windows=np.column_stack([low, high]))
    with pytest.raises(RefusedError) as caught:
        linked_moves(problem, groove.contact)
    text = str(caught.value)
    assert "from home to the approach position of pass 1" in text
    assert " and pillar" in text
    assert any(name in text for name in ("forearm", "elbow", "spindle", "adapter", "wrist"))
    assert "link height" in text


def test_a_lead_that_is_not_free_is_shortened(groove, coal):
    # The first waypoint is at y = -0.5; the ball may not come within 2 mm of a block before it.
    first = cells.tcp(groove.joints[0][0])[:3, 3]
    edge = float(first[1]) - 15.0 * MM
    block = cells.box("block", (0.80, edge - 0.02, 0.606), (1.05, edge, 0.64))
    moves = linked(groove, block, home=None)
    start, contact = cells.positions(moves[1:3])
    lead = (contact - start) @ TRAVEL - (cells.tcp(moves[2].joints)[:3, 2] @ TRAVEL) * 0.005
    assert moves[1].role is Role.LEAD_IN
    assert any(lead == pytest.approx(part * 10 * MM, abs=ROUNDING) for part in (0.75, 0.5, 0.25))
    assert start[1] - edge >= 10.0 * MM - ROUNDING
    oracle = cells.FreeOracle(coal, [block])
    assert_free(cells.with_links(groove.problem, block), oracle, moves[:3], DENSE, 10.0 * MM)


def beside_the_spindle(gap):
    """A block that the spindle, 100 mm thick, passes by at the first waypoint, y = -0.5."""
    return cells.box("block", (0.8, -0.65, 0.76), (1.0, -0.5 - 0.0502 - gap, 0.80))


@pytest.mark.parametrize(("clearance", "share"), [(6.0, 1.0), (10.0, 0.5), (14.0, 0.25)])
def test_the_lead_is_as_long_as_the_clearance_of_links_allows(groove, clearance, share, coal):
    block = beside_the_spindle(18.0 * MM)  # 8 mm at the start of the stated lead-in
    moves = linked(groove, block, home=None, clearance=clearance * MM)
    lead = np.diff(cells.positions(moves[1:3]), axis=0)[0, :2] @ TRAVEL[:2]
    back = -cells.tcp(moves[2].joints)[:2, 2] @ TRAVEL[:2]
    assert lead + 0.005 * back == pytest.approx(share * 10 * MM, abs=ROUNDING)
    assert_free(groove.problem, cells.FreeOracle(coal, [block]), moves[:3], DENSE, clearance * MM)


def test_too_little_clearance_is_stated_rounded_down(groove):
    block = beside_the_spindle(8.0 * MM)
    with pytest.raises(RefusedError) as caught:
        linked(groove, block, home=None, lead_in=0.0)
    text = str(caught.value)
    assert "between the lead-in start and the first waypoint spindle and block come" in text
    assert "(10 mm asked)" in text
    stated = float(text.split("come within ")[1].split(" mm", maxsplit=1)[0])
    assert 6.9 <= stated <= 8.0


def test_a_ramp_that_would_start_on_the_face_is_left_out(groove, coal):
    moves = linked(groove, home=None, lead_in_height=0.0)
    assert [move.role for move in moves[:2]] == [Role.APPROACH, Role.CONTACT]
    oracle = cells.FreeOracle(coal)
    on_face = cells.positions(moves[1:2])[0] - 0.01 * TRAVEL
    assert on_face[2] == pytest.approx(0.613, abs=ROUNDING)
    assert_free(groove.problem, oracle, moves[:2], DENSE, 10.0 * MM)


def windowed(groove, **limits):
    """The problem with links and a narrower upper limit of one joint [rad]."""
    problem = cells.with_links(groove.problem, home=None, lead_in=0.0, lead_in_height=0.0)
    window = problem.robot.limits.copy()
    window[2, 1] = limits["j3"]
    return replace(problem, joint_windows=window)


def test_an_approach_beyond_a_joint_limit_is_shortened(groove):
    plain = linked_moves(windowed(groove, j3=273.0 * DEG), groove.contact)
    full, contact = plain[0].joints[2], plain[1].joints[2]
    limit = contact + 0.5 * (full - contact)
    moves = linked_moves(windowed(groove, j3=limit), groove.contact)
    where = cells.positions(moves[:2])
    length = np.linalg.norm(where[0] - where[1])
    assert length == pytest.approx(0.02, abs=ROUNDING)
    back = -cells.tcp(moves[1].joints)[:3, 2]
    assert np.abs(where[0] - where[1] - length * back).max() < ROUNDING
    assert moves[0].joints[2] <= limit


def test_an_approach_that_no_length_brings_inside_the_limits_is_refused(groove):
    plain = linked_moves(windowed(groove, j3=273.0 * DEG), groove.contact)
    full, contact = plain[0].joints[2], plain[1].joints[2]
    limit = contact + 1e-4
    with pytest.raises(RefusedError) as caught:
        linked_moves(windowed(groove, j3=limit), groove.contact)
    assert str(caught.value).startswith("pass 1 (left): at the approach position")
    assert f"J3 exceeds its limit by {np.degrees(full - limit):.1f} deg" in str(caught.value)


def test_a_lead_out_of_reach_is_refused_with_how_far(groove):
    with pytest.raises(RefusedError) as caught:
        linked(groove, home=None, lead_in_height=2.0)
    text = str(caught.value)
    pose = cells.tcp(groove.joints[0][0])
    point = pose[:3, 3] - 0.01 * TRAVEL - 2.0 * pose[:3, 2]
    wrist = point - 0.51 * pose[:3, 2]
    shoulder = np.hypot(np.hypot(wrist[0], wrist[1]) - 0.150, wrist[2] - 0.525)
    beyond = shoulder - 0.790 - np.hypot(0.250, 0.835)
    assert "pass 1 (left)" in text
    assert "lead-in start" in text
    found = float(text.split("out of reach by ")[1].split(" mm", maxsplit=1)[0])
    assert found == pytest.approx(beyond / MM, abs=0.1)


def test_reach_ends_where_the_inverse_kinematics_ends(groove):
    problem = groove.problem
    pose = problem.fanuc_world_from_floor @ cells.tcp(groove.joints[0][0])
    rng = np.random.default_rng(7)
    for _ in range(200):
        moved = pose.copy()
        moved[:3, 3] = rng.uniform(-2.2, 2.2, 3)
        floor = np.linalg.inv(problem.fanuc_world_from_floor) @ moved
        out = cells.cell_oracle.shoulders_out_of_reach(floor)
        mine = sum(beyond_reach(problem, moved, branch) > 0.0 for branch in (0, 4))
        assert mine == out


def test_a_home_outside_the_limits_or_in_a_fixture_is_refused(groove):
    with pytest.raises(RefusedError, match=r"home position: J2 exceeds its limit by 5\.0 deg"):
        linked(groove, home=np.radians([0.0, 165.0, 0.0, 0.0, 0.0, 0.0]))
    ceiling = cells.box("ceiling", (0.3, -0.7, 1.5), (1.4, 0.3, 1.52))
    with pytest.raises(RefusedError, match=r"home position: .* and ceiling collide"):
        linked(groove, ceiling, home=cells.HOME)


def test_a_cell_without_links_is_refused(groove):
    with pytest.raises(InputError, match="states no links"):
        linked_moves(replace(groove.problem, program=replace(groove.problem.program, links=None)),
                     groove.contact)  # fmt: skip


def test_a_monitor_can_stop_the_search(groove):
    class Stopping:
        asked = 0

        def report(self, stage, done, total):
            pass

        def cancelled(self):
            self.asked += 1
            return self.asked > 40

    problem = cells.with_links(groove.problem, TALL_WALL, ROOF, home=None, height=0.3)
    with pytest.raises(Cancelled):
        linked_moves(problem, groove.contact, Stopping())


@hypothesis_settings(max_examples=12)
@given(
    lead=st.floats(0.0, 0.03),
    height=st.just(0.0) | st.floats(0.003, 0.02),
    approach=st.floats(0.005, 0.2),
    rule=st.sampled_from(Withdrawal),
)
def test_whatever_the_lengths_the_points_lie_in_the_plane_of_travel_and_withdrawal(
    groove, lead, height, approach, rule
):
    moves = linked(
        groove, home=None, lead_in=lead, lead_in_height=height, approach=approach, withdrawal=rule
    )
    count = next(at for at, move in enumerate(moves) if move.role is Role.CONTACT)
    where = cells.positions(moves[: count + 1])
    back = np.array([0.0, 0.0, 1.0])
    if rule is Withdrawal.TOOL:
        back = -cells.tcp(moves[count].joints)[:3, 2]
    start = where[count]
    if count == 2:
        ahead = (start - where[1] + height * back) @ TRAVEL
        assert -ROUNDING <= ahead <= lead + ROUNDING
        assert np.abs(start - ahead * TRAVEL + height * back - where[1]).max() < 2 * ROUNDING
        start = where[1]
    withdrawn = (where[0] - start) @ back
    assert min(approach, 0.01) - ROUNDING <= withdrawn <= approach + ROUNDING
    assert np.abs(start + withdrawn * back - where[0]).max() < 2 * ROUNDING


def test_bodies_and_touch_numbers_of_the_oracle_are_those_of_the_cell(groove, coal):
    scene = build_scene(cells.with_links(groove.problem, LOW_WALL))
    oracle = cells.FreeOracle(coal, [LOW_WALL])
    fillets = sum("fillet" in str(label) for label in scene.fixed)
    assert len(oracle.moving) == len(scene.moving)
    assert len(oracle.fixed) == len(scene.fixed)
    assert fillets == sum("fillet" in solid.name for solid, _ in oracle.fixed)
    assert LinkSettings().clearance == pytest.approx(10.0 * MM)
