"""Colours of the map: what a cell is coloured by, its scale, and tables of colours."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum, IntEnum
from typing import Final

import numpy as np
from numpy.typing import NDArray

from solver.candidates.outcomes import Outcome
from solver.transforms import FloatArray

Colour = tuple[int, int, int, int]
"""Red, green, blue and opacity, 0..255."""

ByteArray = NDArray[np.uint8]


class Layer(Enum):
    """What the cells of the map are coloured by."""

    OUTCOME = "outcome"
    CLEARANCE = "clearance"
    MANIPULABILITY = "manipulability"
    LIMIT_MARGIN = "limit margin"
    EXTRA_COST = "extra cost"
    EXPANDED_F = "expanded f"
    EXPANDED_F1 = "expanded f1"
    EXPANDED_F2 = "expanded f2"

    @property
    def scheme(self) -> str | None:
        """Name of the scheme whose expanded order this is."""
        found = self.value.partition("expanded ")
        return found[2] or None


LAYER_CHOICES: Final[Mapping[Layer, str]] = {
    Layer.OUTCOME: "Outcome",
    Layer.CLEARANCE: "Clearance",
    Layer.MANIPULABILITY: "Manipulability",
    Layer.LIMIT_MARGIN: "Joint limits",
    Layer.EXTRA_COST: "Extra cost",
    Layer.EXPANDED_F: "Order of f",
    Layer.EXPANDED_F1: "Order of f1",
    Layer.EXPANDED_F2: "Order of f2",
}
"""Short names, for the choice."""

LAYER_LABELS: Final[Mapping[Layer, str]] = {
    Layer.OUTCOME: "Outcome",
    Layer.CLEARANCE: "Clearance",
    Layer.MANIPULABILITY: "Manipulability",
    Layer.LIMIT_MARGIN: "Distance to joint limits",
    Layer.EXTRA_COST: "Extra cost of passing here",
    Layer.EXPANDED_F: "Order of expansion, scheme f",
    Layer.EXPANDED_F1: "Order of expansion, scheme f1",
    Layer.EXPANDED_F2: "Order of expansion, scheme f2",
}


class CellClass(IntEnum):
    """What became of a cell; feasible ones are told apart by the safety distance."""

    SAFE = 0
    UNREACHABLE = 1
    JOINT_LIMIT = 2
    SINGULAR = 3
    COLLISION = 4
    MARGIN = 5
    SELF_COLLISION = 6
    NEAR = 7

    @property
    def feasible(self) -> bool:
        """Whether the solver holds a node for it."""
        return self in {CellClass.SAFE, CellClass.NEAR}


CLASS_RANK: Final = np.array([8, 1, 2, 3, 4, 5, 6, 7], dtype=np.uint8)
"""(classes,) how far a cell of each class came; 'best of all' shows the furthest."""

CLASS_LABELS: Final[Mapping[CellClass, str]] = {
    CellClass.SAFE: "feasible",
    CellClass.NEAR: "under the safety distance",
    CellClass.JOINT_LIMIT: "joint limit",
    CellClass.SINGULAR: "singular",
    CellClass.COLLISION: "collision",
    CellClass.MARGIN: "tool too close",
    CellClass.SELF_COLLISION: "robot too close to itself",
    CellClass.UNREACHABLE: "out of reach",
}

CLASS_LETTERS: Final[Mapping[CellClass, str]] = {
    CellClass.SAFE: "",
    CellClass.NEAR: "d",
    CellClass.JOINT_LIMIT: "J",
    CellClass.SINGULAR: "S",
    CellClass.COLLISION: "C",
    CellClass.MARGIN: "T",
    CellClass.SELF_COLLISION: "R",
    CellClass.UNREACHABLE: "U",
}
"""Letters beside the colours, for those who do not tell the colours apart."""

MORE_COLOURS: Final[Mapping[Outcome, str]] = {
    Outcome.MARGIN: "#882255",
    Outcome.SELF_COLLISION: "#0072B2",
}
"""Colours of the outcomes that a theme does not name."""

REJECTED_INDEX: Final = 0
"""Index of a cell without a node in the layers of values."""

NO_VALUE_INDEX: Final = 1
"""Index of a node without a value: no sequence passes it, or the search never came to it."""

FIRST_INDEX: Final = 2
"""First index of the scale; the last is 255."""

VIRIDIS: Final = (
    "#440154", "#481769", "#472C7A", "#423F85", "#3B518B", "#33628D", "#2C718E", "#26818E",
    "#21908C", "#1F9F88", "#27AD80", "#3DBC73", "#5CC862", "#81D34C", "#AADC31", "#D5E219",
    "#FDE725",
)  # fmt: skip
"""Places of the colour map viridis at equal distances."""

CIVIDIS: Final = (
    "#00204D", "#002B68", "#05366E", "#2C416C", "#404D6B", "#51586C", "#60646F", "#6E6F73",
    "#7C7B78", "#8B8779", "#9B9477", "#ACA174", "#BCAF6F", "#CEBC67", "#E0CB5D", "#F2DA4F",
    "#FFEA46",
)  # fmt: skip
"""Places of the colour map cividis at equal distances."""


def colour_of(text: str, opacity: int = 255) -> Colour:
    """The colour of a text '#RRGGBB'."""
    return int(text[1:3], 16), int(text[3:5], 16), int(text[5:7], 16), opacity


def mixed(one: Colour, other: Colour, share: float) -> Colour:
    """A colour between two: `share` 0 is the first, 1 the other."""
    red, green, blue, opacity = (
        round(a + (b - a) * share) for a, b in zip(one, other, strict=True)
    )
    return red, green, blue, opacity


def gradient(places: tuple[str, ...], count: int) -> ByteArray:
    """(count, 4) colours of a colour map."""
    known = np.array([colour_of(text) for text in places], dtype=np.float64)
    at = np.linspace(0.0, len(places) - 1.0, count)
    columns = [np.interp(at, np.arange(len(places)), known[:, c]) for c in range(4)]
    return np.round(np.column_stack(columns)).astype(np.uint8)


def class_table(colours: Mapping[CellClass, Colour]) -> ByteArray:
    """(256, 4) colour of every index in the layer of outcomes."""
    table = np.zeros((256, 4), dtype=np.uint8)
    for kind, colour in colours.items():
        table[kind] = colour
    return table


def scale_table(places: tuple[str, ...], rejected: Colour, no_value: Colour) -> ByteArray:
    """(256, 4) colour of every index in the layers of values; yellow is good."""
    table = np.empty((256, 4), dtype=np.uint8)
    table[REJECTED_INDEX] = rejected
    table[NO_VALUE_INDEX] = no_value
    table[FIRST_INDEX:] = gradient(places, 256 - FIRST_INDEX)
    return table


@dataclass(frozen=True, slots=True)
class Tick:
    """A labelled place on the colour bar, at a share 0..1 of its length."""

    share: float
    text: str


@dataclass(frozen=True, slots=True)
class Scale:
    """From values to shares of the colour bar.

    Attributes
    ----------
    low, high : float
        Values at the bar's ends, in `unit`.
    reverse : bool
        Whether small values are the good ones.
    knee : float
        Below it the scale is about linear, above it logarithmic; 0 is linear throughout.
    decimals : int
        Of the numbers at the bar.
    mark : float
        A value that is marked on the bar (the safety distance); nan for none.
    """

    low: float
    high: float
    unit: str
    decimals: int = 0
    reverse: bool = False
    knee: float = 0.0
    mark: float = math.nan

    def place(self, values: FloatArray) -> FloatArray:
        """Place 0..1 on the bar, from low to high; values outside are held at its ends."""
        span = self.high - self.low
        if span <= 0.0:
            return np.full(np.shape(values), 1.0 if not self.reverse else 0.0)
        with np.errstate(invalid="ignore"):
            share = (np.clip(values, self.low, self.high) - self.low) / span
            if self.knee > 0.0:
                ratio = span / self.knee
                share = np.log1p(share * ratio) / math.log1p(ratio)
        return np.asarray(share, dtype=np.float64)

    def indices(self, values: FloatArray) -> ByteArray:
        """Index into the colour table; values that are not finite have none."""
        finite = np.isfinite(values)
        share = self.place(np.where(finite, values, self.low))
        if self.reverse:
            share = 1.0 - share
        index = FIRST_INDEX + np.round(share * (255 - FIRST_INDEX))
        return np.where(finite, index, NO_VALUE_INDEX).astype(np.uint8)

    def text(self, value: float) -> str:
        """A value as it stands beside the bar."""
        return f"{value:,.{self.decimals}f}".replace("-", "−")

    def ticks(self, most: int = 6) -> tuple[Tick, ...]:
        """Round values within the scale with their places."""
        values = _round_logarithmic(self) if self.knee > 0.0 else _round_linear(self, most)
        places = self.place(np.array(values, dtype=np.float64))
        return tuple(
            Tick(float(place), self.text(value))
            for value, place in zip(values, places, strict=True)
        )


def _round_linear(scale: Scale, most: int) -> list[float]:
    span = scale.high - scale.low
    if span <= 0.0:
        return [scale.low]
    rough = span / most
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(power * f for f in (1.0, 2.0, 5.0, 10.0) if power * f >= rough * (1.0 - 1e-9))
    step = max(step, 10.0**-scale.decimals)
    first = math.ceil(scale.low / step - 1e-9)
    last = math.floor(scale.high / step + 1e-9)
    return [number * step for number in range(first, last + 1)]


def _round_logarithmic(scale: Scale) -> list[float]:
    values, place = [0.0], 0.0
    power = 10.0 ** math.floor(math.log10(scale.knee))
    while power <= scale.high:
        for value in (power, 3.0 * power):
            at = float(scale.place(np.array([value]))[0])
            # Numbers nearer than this would run into each other.
            if scale.knee <= value <= scale.high and at - place >= 0.11:
                values.append(value)
                place = at
        power *= 10.0
    return values
