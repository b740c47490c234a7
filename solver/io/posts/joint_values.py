"""The joints of a move as the decimals that stand in a file."""

from __future__ import annotations

from typing import Final

import numpy as np

from solver.errors import ModelError
from solver.model.program import JOINT_DECIMALS, Move
from solver.units import DEG_PER_RAD

ROUNDING_SLACK: Final = 1e-9
"""How far a joint may lie from its rounded value [deg]: what radians cost, and no more."""


def joint_degrees(move: Move) -> list[float]:
    """Return J1 to J6 [deg] with the file's decimals.

    Raises
    ------
    ModelError
        When a joint is not finite, or was not rounded before it was checked: what was checked
        is then not what would stand in the file.
    """
    degrees = move.joints * DEG_PER_RAD
    if not np.isfinite(degrees).all():
        raise ModelError("holds a joint that is not finite")
    rounded = np.round(degrees, JOINT_DECIMALS) + 0.0
    off = np.abs(degrees - rounded)
    if np.any(off > ROUNDING_SLACK):
        joint = int(np.argmax(off))
        raise ModelError(
            f"J{joint + 1} is {degrees[joint]:.9f} deg and was not rounded to "
            f"{JOINT_DECIMALS} decimals before it was checked"
        )
    return [float(value) for value in rounded]
