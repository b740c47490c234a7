"""Wishes that the path has outgrown: beyond its end, or at another place than before."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from solver.units import MM

if TYPE_CHECKING:
    from solver.model.toolpath import Toolpath
    from solver.model.wishes import Pin, Region

Translate = Callable[..., str]

MOVED: Final = 0.5 * MM
"""A waypoint that is farther than this from where it was is another place of the path [m]."""


@dataclass(frozen=True, slots=True)
class Beyond:
    """Wishes about no waypoint of the path; waypoints and ends of regions count from 0."""

    pins: tuple[int, ...]
    regions: tuple[tuple[int, int], ...]
    count: int

    def words(self, tr: Translate) -> str:
        """All of them in a sentence."""
        numbers = [str(one + 1) for one in self.pins]
        if len(numbers) == 1 and not self.regions:
            words = (
                "The pin of waypoint {numbers} lies beyond the path, which has {count} waypoints."
            )
        elif not self.regions:
            words = (
                "The pins of waypoints {numbers} lie beyond the path, which has {count} waypoints."
            )
        else:
            numbers += [f"{first + 1}–{last + 1}" for first, last in self.regions]
            words = (
                "What is pinned or forbidden at waypoints {numbers} lies beyond the path, which "
                "has {count} waypoints."
            )
        return tr(words, numbers=tr(", ").join(numbers), count=self.count)


def beyond_path(pins: Sequence[Pin], regions: Sequence[Region], count: int) -> Beyond | None:
    """The wishes beyond a path of `count` waypoints, None where all are on it."""
    far = tuple(pin.waypoint for pin in pins if not 0 <= pin.waypoint < count)
    areas = tuple((one.first, one.last) for one in regions if one.first >= count or one.last < 0)
    return Beyond(far, areas, count) if far or areas else None


def wishes_on_path(
    pins: Sequence[Pin], regions: Sequence[Region], count: int
) -> tuple[tuple[Pin, ...], tuple[Region, ...]]:
    """The wishes without those beyond a path of `count` waypoints."""
    kept = tuple(pin for pin in pins if 0 <= pin.waypoint < count)
    return kept, tuple(one for one in regions if one.first < count and one.last >= 0)


def moved_pins(before: Toolpath, now: Toolpath, pins: Sequence[Pin]) -> tuple[int, ...]:
    """Pinned waypoints (from 0) that are elsewhere in the path's own frame than before."""
    shared = min(len(before), len(now))
    away = np.linalg.norm(
        now.poses[:shared, :3, 3] - before.poses[:shared, :3, 3], axis=1
    )  # a number that one of both has not is told of as beyond the path, or is new
    numbers = (pin.waypoint for pin in pins if 0 <= pin.waypoint < shared)
    return tuple(number for number in numbers if away[number] > MOVED)


def moved_words(numbers: Sequence[int], tr: Translate) -> str:
    """Pinned waypoints that are elsewhere, in a sentence."""
    shown = tr(", ").join(str(one + 1) for one in numbers)
    words = "Waypoint {number} is at another place of the path now; its pin holds the number."
    if len(numbers) > 1:
        words = (
            "Waypoints {number} are at other places of the path now; their pins hold the numbers."
        )
    return tr(words, number=shown)
