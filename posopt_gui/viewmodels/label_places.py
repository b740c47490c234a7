"""Where the names of lines stand: near the end of their line, and on no line."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from solver.transforms import FloatArray

Box = tuple[float, float, float, float]
"""Left, top, right and bottom [px]; y counts downward."""

Curve = tuple[FloatArray, FloatArray]
"""x (n,), rising, and y (n,) of a line [px]."""

GAP: Final = 5.0
"""Least room between a name and any line, and to the frame [px]."""

SAMPLES: Final = 12
"""Places over the width of a name at which lines are asked for."""

TRIES: Final = 6
"""How many places further from the end of the line are tried."""

STEPS: Final = 3
"""How many places further from the line are tried."""


def label_places(
    curves: Sequence[Curve], widths: Sequence[float], height: float, room: Box
) -> list[tuple[float, float]]:
    """Left and top of each line's name, the first line's chosen first.

    As near to the visible end of its line as there is a place that lies on no line and no
    other name; where there is none, the place that covers least.
    """
    taken: list[Box] = []
    for curve, width in zip(curves, widths, strict=True):
        best, least = (room[0], room[1], room[0] + width, room[1] + height), np.inf
        for box in _places(curve, width, height, room):
            covered = sum(_crosses(one, box) for one in curves)
            covered += 2 * sum(_overlap(one, box) for one in taken)
            if covered < least:
                best, least = box, covered
            if not covered:
                break
        taken.append(best)
    return [(box[0], box[1]) for box in taken]


def _places(curve: Curve, width: float, height: float, room: Box) -> Iterator[Box]:
    """Places beside a line, the best first: at its end, further back, then further away."""
    x, y = curve
    end = float(np.clip(min(room[2], x[-1]), room[0] + width, room[2])) - GAP
    for step in range(STEPS):
        for number in range(TRIES):
            right = end - number * 0.5 * width
            if right - width < room[0]:
                break
            samples = np.interp(np.linspace(right - width, right, SAMPLES), x, y)
            away = step * (height + GAP)
            for top in (samples.min() - GAP - height - away, samples.max() + GAP + away):
                if room[1] + GAP <= top and top + height + GAP <= room[3]:
                    yield right - width, top, right, top + height


def _crosses(curve: Curve, box: Box) -> bool:
    x, y = curve
    places = np.linspace(box[0], box[2], SAMPLES)
    found = np.interp(places, x, y, left=np.inf, right=np.inf)
    near = (found > box[1] - GAP + 1.0) & (found < box[3] + GAP - 1.0)
    between = np.diff(np.sign(found - (box[1] + box[3]) / 2.0)) != 0
    return bool(near.any() or between[np.isfinite(found[1:])].any())


def _overlap(one: Box, other: Box) -> bool:
    across = one[0] < other[2] + GAP and other[0] < one[2] + GAP
    return across and one[1] < other[3] + 2.0 and other[1] < one[3] + 2.0
