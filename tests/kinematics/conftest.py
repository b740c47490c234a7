"""Robots for the tests of kinematics, built from published figures without any resource file."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from solver.model.robot import Robot

FANUC_MODEL_FROM_PENDANT = np.array(
    [
        [1, 0, 0, 0, 0, 0],
        [0, 1, 0, 0, 0, 0],
        [0, -1, -1, 0, 0, 0],
        [0, 0, 0, -1, 0, 0],
        [0, 0, 0, 0, -1, 0],
        [0, 0, 0, 0, 0, -1],
    ],
    dtype=float,
)


def _robot(
    name: str,
    lengths: tuple[float, float, float, float],
    flange: float,
    height: float,
    limits: list[list[float]],
    elbow: tuple[float, float],
) -> Robot:
    a1, a2, a3, d4 = lengths
    quarter = np.pi / 2
    wrist_from_flange = np.eye(4)
    wrist_from_flange[2, 3] = flange
    return Robot(
        name=name,
        title=name,
        dh=np.array(
            [
                [0, 0, 0, 0],
                [-quarter, a1, 0, -quarter],
                [0, a2, 0, 0],
                [-quarter, a3, d4, 0],
                [quarter, 0, 0, 0],
                [-quarter, 0, 0, 0],
            ]
        ),
        flange=wrist_from_flange,
        world_height=height,
        model_from_pendant=FANUC_MODEL_FROM_PENDANT,
        limits=np.radians(limits),
        speeds=np.radians([195, 175, 180, 360, 360, 550]),
        accelerations=np.radians([650, 583, 600, 1200, 1200, 1833]),
        elbow_limits=np.radians(elbow),
        cost_ranges=np.radians(np.diff(limits, axis=1)[:, 0]),
        payload=20.0,
        body_sets={"none": ()},
        neighbours=frozenset(),
    )


@pytest.fixture(scope="session")
def make_robot() -> Callable[..., Robot]:
    return _robot


@pytest.fixture(scope="session")
def m20ia() -> Robot:
    """FANUC M-20iA: D-H table and limits of manual B-82874EN/06."""
    return _robot(
        "M-20iA",
        (0.15, 0.79, 0.25, 0.835),
        0.1,
        0.525,
        [[-170, 170], [-100, 160], [-185, 273.12], [-200, 200], [-140, 140], [-270, 270]],
        (-106.0, 253.0),
    )


@pytest.fixture(scope="session")
def short_arm() -> Robot:
    """Another arm of the family: other lengths, more than a turn on most joints."""
    return _robot(
        "short arm",
        (0.05, 0.33, 0.035, 0.335),
        0.08,
        0.33,
        [[-185, 185], [-100, 145], [-140, 213], [-190, 190], [-125, 125], [-450, 450]],
        (-95.0, 260.0),
    )


@pytest.fixture(scope="session")
def even_arm() -> Robot:
    """An arm whose upper arm and forearm are equally long, so its wrist reaches the J2 axis."""
    return _robot(
        "even arm",
        (0.0, 0.5, 0.3, 0.4),
        0.05,
        0.4,
        [[-180, 180], [-180, 180], [-360, 360], [-360, 360], [-180, 180], [-360, 360]],
        (-170.0, 180.0),
    )
