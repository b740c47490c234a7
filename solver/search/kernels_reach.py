"""Compiled search for the pair of nodes that comes nearest to an allowed step."""

from __future__ import annotations

from solver.kernel import kernel
from solver.transforms import FloatArray, IntArray


@kernel
def nearest_pair(
    steps: FloatArray,
    lean: FloatArray,
    limits: FloatArray,
    sources: IntArray,
    target_low: int,
    target_high: int,
    best: FloatArray,
    pair: IntArray,
) -> None:
    """Lower best[0] to the least over pairs of the largest ratio of step to limit.

    Of equal pairs the first stays: sources in the given order, targets ascending.
    """
    for source in sources:
        for target in range(target_low, target_high):
            worst = 0.0
            if len(steps) > 0:
                for joint in range(6):
                    step = abs(steps[target, joint] - steps[source, joint])
                    worst = max(worst, step / limits[joint])
            if len(lean) > 0:
                worst = max(worst, abs(lean[target] - lean[source]) / limits[6])
            if worst < best[0]:
                best[0] = worst
                pair[0] = source
                pair[1] = target
