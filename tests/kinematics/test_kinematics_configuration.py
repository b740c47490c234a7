"""FANUC CONFIG: letters, turn numbers, reading, and choosing a solution by it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from solver.errors import InputError, Place
from solver.kinematics.arm import forward, inverse
from solver.kinematics.configuration import (
    Configuration,
    branch_of,
    choose,
    config_string,
    configuration,
    parse_configuration,
    turn_number,
)

configurations = st.builds(
    Configuration,
    st.booleans(),
    st.booleans(),
    st.booleans(),
    st.tuples(*[st.integers(-2, 2)] * 3),
)


@pytest.mark.parametrize(
    ("joints", "expected"),
    [
        ((0, 0, 0, 0, -90, 0), "N U T, 0, 0, 0"),
        ((0, 0, 0, 0, 90, 0), "F U T, 0, 0, 0"),
        ((0, 0, 73, 0, -90, 0), "N U T, 0, 0, 0"),
        ((0, 0, 74, 0, -90, 0), "N D T, 0, 0, 0"),
        ((0, 20, 54, 0, -90, 0), "N D T, 0, 0, 0"),
        ((0, 0, -106, 0, -90, 0), "N U T, 0, 0, 0"),
        ((0, 0, -107, 0, -90, 0), "N D T, 0, 0, 0"),
        ((0, 0, 254, 0, -90, 0), "N U T, 0, 0, 0"),
        ((0, -90, 0, 0, -90, 0), "N U T, 0, 0, 0"),
        ((0, -90, 60, 0, -90, 0), "N U B, 0, 0, 0"),
        ((0, -60, 160, 0, -90, 0), "N D B, 0, 0, 0"),
        ((0, 0, 0, 180, -90, -180), "N U T, 0, 1, -1"),
        ((0, 0, 0, 179.999, -90, -179.999), "N U T, 0, 0, 0"),
        ((0, 0, 0, -200, 20, 270), "F U T, 0, -1, 1"),
        ((-185, 0, 0, 0, 20, 539.999), "F U T, -1, 0, 1"),
        ((185, 0, 0, 0, 20, -540), "F U T, 1, 0, -2"),
    ],
)
def test_config_follows_the_controllers_rules(m20ia, joints, expected):
    assert config_string(m20ia, np.radians(joints)) == expected


def test_boundary_of_up_and_down_follows_the_robots_own_lengths(short_arm):
    boundary = math.degrees(math.atan2(0.335, 0.035))
    below, above = (np.radians([0, 10, boundary - 10 + off, 0, 20, 0]) for off in (-0.01, 0.01))
    assert configuration(short_arm, below).up
    assert not configuration(short_arm, above).up


@given(st.integers(-540_000, 540_000))
def test_turn_number_equals_the_rule_in_whole_thousandths_of_a_degree(thousandths):
    sign = (thousandths > 0) - (thousandths < 0)
    expected = sign * ((abs(thousandths) + 180_000) // 360_000)
    assert turn_number(math.radians(thousandths / 1000)) == expected


@pytest.mark.parametrize("sign", [1, -1])
def test_half_a_turn_that_lost_its_last_digit_still_counts_as_half_a_turn(sign):
    assert turn_number(sign * math.nextafter(math.pi, 0.0)) == sign
    assert turn_number(sign * math.radians(179.9999)) == 0


@given(configurations)
def test_config_strings_are_read_back_as_written(config):
    assert parse_configuration(str(config)) == config


@pytest.mark.parametrize("text", ["FUT,0,0,0", " F U T ,0 , 0,0 ", "F U T, 0, 0, 0"])
def test_spacing_of_a_config_string_does_not_matter(text):
    assert parse_configuration(text) == Configuration(True, True, True, (0, 0, 0))


@pytest.mark.parametrize(
    "text",
    [
        "",
        "F U T",
        "F U T, 0, 0",
        "U F T, 0, 0, 0",
        "F U T, 0, 0, x",
        "F U T, 0, 0, 0, 0",
        "F U T, ٠, 0, 0",
    ],
)
def test_anything_else_is_refused_with_its_place(text):
    with pytest.raises(InputError, match="not a CONFIG") as caught:
        parse_configuration(text, Place("A.LS", 12))
    assert str(caught.value).startswith("A.LS, line 12: ")
    assert "'N U T, 0, 0, 0'" in str(caught.value)


@pytest.mark.parametrize("name", ["m20ia", "short_arm"])
def test_config_is_unique_among_solutions_and_chooses_the_original(name, request):
    robot = request.getfixturevalue(name)
    generator = np.random.default_rng(21)
    compared = 0
    while compared < 150:
        joints = generator.uniform(robot.limits[:, 0], robot.limits[:, 1])
        if not robot.elbow_limits[0] < joints[1] + joints[2] < robot.elbow_limits[1]:
            continue
        solutions = inverse(robot, forward(robot, joints))
        assert len(set(solutions.config)) == len(solutions)
        turned = np.round(solutions.joints / (2 * math.pi), 9)
        keys = {(int(b), *t) for b, t in zip(solutions.branch, turned, strict=True)}
        assert len(keys) == len(solutions)
        wanted = configuration(robot, joints)
        assert str(wanted) in solutions.config
        np.testing.assert_allclose(choose(robot, solutions.joints, wanted), joints, atol=1e-9)
        compared += 1


@pytest.mark.parametrize("name", ["m20ia", "short_arm"])
def test_letters_and_branch_numbers_tell_the_same(name, request):
    robot = request.getfixturevalue(name)
    for joints in np.random.default_rng(22).uniform(-1.5, 1.5, (100, 6)):
        solutions = inverse(robot, forward(robot, joints))
        for row, branch, text in zip(
            solutions.joints, solutions.branch, solutions.config, strict=True
        ):
            config = parse_configuration(text)
            assert branch_of(robot, row) == branch
            # sigma > 0 means theta5 > 0, which is J5 < 0.
            assert branch == 4 * (not config.front) + 2 * (not config.up) + config.flip


def test_missing_config_is_an_error_that_lists_what_there_is(m20ia):
    solutions = inverse(m20ia, forward(m20ia, np.radians([0, 0, 0, 0, -90, 0])))
    with pytest.raises(InputError, match="no solution has CONFIG 'N U T, 2, 0, 0'") as caught:
        choose(m20ia, solutions.joints, parse_configuration("N U T, 2, 0, 0"))
    assert "'N U T, 0, 0, 0'" in str(caught.value)


def test_config_of_a_pose_without_solutions_is_an_error_too(m20ia):
    with pytest.raises(InputError, match="the pose has no solution"):
        choose(m20ia, [], parse_configuration("N U T, 0, 0, 0"))
