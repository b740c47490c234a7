"""Measures of a joint sequence: how far, how wide and how unevenly each joint moves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solver.transforms import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class JointMotion:
    """Per joint (6,) [rad]: cumulative variation, amplitude, standard deviation, largest step."""

    variation: FloatArray
    amplitude: FloatArray
    deviation: FloatArray
    largest_step: FloatArray

    def gain_over(self, reference: JointMotion) -> JointMotion:
        """Relative change against a reference: -0.9 means 90 % less; nan where it is at rest."""

        def gain(mine: FloatArray, other: FloatArray) -> FloatArray:
            moving = other > 1e-12
            return np.where(moving, mine / np.where(moving, other, 1.0) - 1.0, np.nan)

        return JointMotion(
            gain(self.variation, reference.variation),
            gain(self.amplitude, reference.amplitude),
            gain(self.deviation, reference.deviation),
            gain(self.largest_step, reference.largest_step),
        )


def joint_motion(pendant: FloatArray) -> JointMotion:
    """Measures of a sequence of pendant joints (n, 6) [rad]."""
    steps = np.abs(np.diff(pendant, axis=0))
    return JointMotion(
        steps.sum(axis=0), np.ptp(pendant, axis=0), pendant.std(axis=0), steps.max(axis=0)
    )


def mean_motion(motions: list[JointMotion]) -> JointMotion:
    """Mean of several sequences' measures."""
    return JointMotion(
        np.mean([one.variation for one in motions], axis=0),
        np.mean([one.amplitude for one in motions], axis=0),
        np.mean([one.deviation for one in motions], axis=0),
        np.mean([one.largest_step for one in motions], axis=0),
    )


def lean_edge_share(lean: FloatArray, lower: float, upper: float) -> float:
    """Share of waypoints whose lean lies on the edge of the range (all angles in [rad])."""
    if upper - lower < 1e-9:
        return 0.0
    edge = (np.abs(lean - lower) < 1e-9) | (np.abs(lean - upper) < 1e-9)
    return float(edge.mean())
