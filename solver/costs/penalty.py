"""The paper's safety penalty of a pose."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from solver.errors import ModelError
from solver.transforms import FloatArray


def safety_penalty(clearance: ArrayLike, safety_distance: float) -> FloatArray:
    """Penalty ``exp(1 - d / d_safe)`` of a pose nearer than the safety distance, else 0.

    Parameters
    ----------
    clearance : (k,) array
        Clearance d of each pose [m]; infinite where nothing is near.
    safety_distance : float
        d_safe [m]; 0 penalises nothing.

    Returns
    -------
    (k,) array
        Dimensionless; it jumps from 1 to 0 at d_safe.

    Notes
    -----
    Safety term of the paper, printed ambiguously there; this reading reproduces its figures.
    """
    distance = np.asarray(clearance, dtype=np.float64)
    if np.any(np.isnan(distance)) or np.any(distance == -np.inf):
        raise ModelError("clearances must be numbers")
    if not (np.isfinite(safety_distance) and safety_distance >= 0.0):
        raise ModelError(f"the safety distance cannot be {safety_distance:g} m")
    penalty = np.zeros(distance.shape)
    if safety_distance > 0.0:
        near = distance < safety_distance
        penalty[near] = np.exp(1.0 - distance[near] / safety_distance)
    return penalty
