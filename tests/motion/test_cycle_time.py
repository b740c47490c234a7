from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from solver.catalog.cells import load_cell
from solver.catalog.names import file_of
from solver.catalog.robots import load_robot
from solver.model.program import Move, Speed
from solver.model.toolpath import Event, EventKind, Role
from solver.motion.cycle_time import cycle_time
from solver.motion.feed import predict

SOUND = np.radians([10.0, 20.0, -15.0, 30.0, -60.0, 40.0])
REACH = np.full(6, 0.5)
SPEED, RATE = np.radians(195.0), np.radians(650.0)  # of J1


@pytest.fixture(scope="module")
def robot():
    return load_robot("fanuc_m20ia")


def turn(joint, degrees):
    change = np.zeros(6)
    change[joint] = np.radians(degrees)
    return change


def estimate(robot, changes, speeds, **other):
    """Cycle time of joint moves by `changes`; `other` holds one value per move of each field."""
    start, moves, feeds = SOUND, [], []
    tcp = load_cell("groove_paper").tool.tcp
    for index, (change, speed) in enumerate(zip(changes, speeds, strict=True)):
        fields = {name: values[index] for name, values in other.items()}
        moves.append(Move(start + change, speed, **fields))
        feeds.append(predict(robot, tcp, REACH, start, moves[-1]))
        start = moves[-1].joints
    return cycle_time(robot, moves, feeds)


def trapezoid(angle, speed, rate):
    """Time of a turn from rest to rest: at full speed in the middle, or a triangle."""
    if speed * speed / rate <= angle:
        return angle / speed + speed / rate
    return 2.0 * np.sqrt(angle / rate)


@pytest.mark.parametrize("percent", [10.0, 50.0, 100.0])
@pytest.mark.parametrize("degrees", [0.5, 5.0, 58.0, 120.0])
def test_one_move_between_stops_takes_the_time_of_its_trapezoid(robot, percent, degrees):
    found = estimate(robot, [turn(0, degrees)], [Speed.percent(percent)])
    expected = trapezoid(np.radians(degrees), SPEED * percent / 100.0, RATE)
    assert found.total == pytest.approx(expected, rel=1e-9)


def test_the_joint_that_accelerates_worst_sets_the_ramps(robot):
    weak = replace(robot, accelerations=np.radians([650, 583, 600, 100.0, 1200, 1833]))
    found = estimate(weak, [turn(0, 90.0) + turn(3, 90.0)], [Speed.percent(100.0)])
    assert found.total == pytest.approx(trapezoid(90.0, 195.0, 100.0))


@settings(max_examples=30)
@given(
    st.lists(st.floats(0.05, 1.0), min_size=2, max_size=6),
    st.floats(1.0, 150.0),
    st.floats(1.0, 100.0),
)
def test_a_turn_in_pieces_without_a_stop_takes_the_time_of_the_whole(pieces, degrees, percent):
    robot = load_robot("fanuc_m20ia")
    parts = degrees * np.array(pieces) / sum(pieces)
    found = estimate(
        robot,
        [turn(0, part) for part in parts],
        [Speed.percent(percent)] * len(parts),
        cnt=[100] * (len(parts) - 1) + [None],
    )
    expected = trapezoid(np.radians(degrees), SPEED * percent / 100.0, RATE)
    assert found.total == pytest.approx(expected, rel=1e-9)


def test_a_stop_between_two_moves_costs_two_ramps(robot):
    changes, speeds = [turn(0, 60.0), turn(0, 60.0)], [Speed.percent(50.0)] * 2
    through = estimate(robot, changes, speeds, cnt=[100, None])
    stopped = estimate(robot, changes, speeds, cnt=[None, None])
    assert stopped.total - through.total == pytest.approx(0.5 * SPEED / RATE)
    assert stopped.total == pytest.approx(2 * trapezoid(np.radians(60.0), SPEED / 2, RATE))


def test_the_robot_stops_at_the_end_whatever_the_last_termination_says(robot):
    changes, speeds = [turn(0, 60.0)], [Speed.percent(50.0)]
    assert estimate(robot, changes, speeds, cnt=[100]).total == pytest.approx(
        estimate(robot, changes, speeds, cnt=[None]).total
    )


def test_a_faster_move_after_a_slower_one_starts_at_its_pace(robot):
    """J1 at 10 deg/s, then J2 at 20 deg/s: one ramp up and one down, none between."""
    found = estimate(
        robot,
        [turn(0, 20.0), turn(1, 20.0)],
        [Speed.duration(2.0), Speed.duration(1.0)],
        cnt=[50, None],
    )
    assert found.total == pytest.approx(3.0 + 10.0 / 650.0 / 2.0 + 20.0 / 583.0 / 2.0)


def test_contact_other_moves_and_dwells_are_summed_apart(robot):
    dwell = Event(EventKind.DWELL, value=1.5)
    other = Event(EventKind.DIGITAL_OUTPUT, "1", 1.0)
    found = estimate(
        robot,
        [turn(0, 30.0), turn(1, 30.0), turn(0, -30.0), turn(2, 30.0)],
        [Speed.percent(50.0)] * 4,
        role=[Role.LINK, Role.CONTACT, Role.LEAD_OUT, Role.CONTACT],
        events=[(dwell, other), (), (dwell,), ()],
    )
    alone = [
        trapezoid(np.radians(30.0), np.radians(speed) / 2, np.radians(rate))
        for speed, rate in ((195, 650), (175, 583), (195, 650), (180, 600))
    ]
    assert found.waiting == pytest.approx(3.0)
    assert found.grinding == pytest.approx(alone[1] + alone[3])
    assert found.linking == pytest.approx(alone[0] + alone[2])
    assert found.total == pytest.approx(3.0 + sum(alone))


def test_a_dwell_stops_the_robot_at_a_rounded_corner_too(robot):
    dwell = Event(EventKind.DWELL, value=2.0)
    changes, speeds = [turn(0, 60.0), turn(0, 60.0)], [Speed.percent(50.0)] * 2
    found = estimate(robot, changes, speeds, cnt=[100, 100], events=[(dwell,), ()])
    stopped = estimate(robot, changes, speeds)
    assert found.total == pytest.approx(stopped.total + 2.0)


def test_a_move_to_where_the_robot_is_takes_no_time(robot):
    found = estimate(
        robot,
        [turn(0, 60.0), np.zeros(6), turn(0, 60.0)],
        [Speed.percent(50.0)] * 3,
        cnt=[100, 100, None],
    )
    assert found.total == pytest.approx(trapezoid(np.radians(120.0), SPEED / 2, RATE))


def test_the_estimate_shows_the_accelerations_that_it_assumes(robot):
    found = estimate(robot, [turn(0, 60.0)], [Speed.percent(50.0)])
    assert np.degrees(found.accelerations) == pytest.approx([650, 583, 600, 1200, 1200, 1833])
    assert any("accelerations" in one and "assumed" in one for one in robot.assumptions)


def test_no_moves_take_no_time(robot):
    assert cycle_time(robot, (), ()).total == 0.0


def test_unstated_accelerations_reach_full_speed_in_three_tenths_of_a_second(tmp_path):
    text = file_of("robots", "fanuc_m20ia", None).read_text("utf-8")
    lines = [line for line in text.splitlines() if not line.startswith("acceleration_deg_s2")]
    assert len(lines) == len(text.splitlines()) - 1
    path = tmp_path / "robot.toml"
    path.write_text("\n".join(lines), "utf-8")
    robot = load_robot(path)
    assert robot.accelerations == pytest.approx(robot.speeds / 0.3)
