"""Colours of the map in a theme."""

from __future__ import annotations

from dataclasses import dataclass

from posopt_gui.theme import OUTCOME_COLOURS, Theme
from posopt_gui.viewmodels.map_colours import (
    CIVIDIS,
    MORE_COLOURS,
    VIRIDIS,
    ByteArray,
    CellClass,
    Colour,
    Layer,
    class_table,
    colour_of,
    mixed,
    scale_table,
)
from solver.candidates.outcomes import Outcome


@dataclass(frozen=True, slots=True, eq=False)
class MapPalette:
    """Everything that is drawn has its colour here."""

    theme: Theme
    classes: dict[CellClass, Colour]
    rejected: Colour
    no_value: Colour

    def table(self, layer: Layer) -> ByteArray:
        """(256, 4) colours of the indices of a layer."""
        if layer is Layer.OUTCOME:
            return class_table(self.classes)
        places = CIVIDIS if layer.scheme else VIRIDIS
        return scale_table(places, self.rejected, self.no_value)


def palette(theme: Theme) -> MapPalette:
    """The colours of the map in a theme."""
    plot = colour_of(theme.plot)
    classes = {CellClass.SAFE: colour_of(theme.feasible), CellClass.NEAR: colour_of(theme.near)}
    for outcome in Outcome:
        if outcome is not Outcome.FEASIBLE:
            text = OUTCOME_COLOURS.get(outcome) or MORE_COLOURS[outcome]
            # A little of the ground keeps large areas from shouting; the line stays in front.
            classes[CellClass(int(outcome))] = mixed(
                colour_of(text), plot, 0.24 if theme.dark else 0.12
            )
    if theme.dark:
        classes[CellClass.NEAR] = mixed(classes[CellClass.NEAR], plot, 0.12)
    rejected = mixed(plot, colour_of(theme.raised), 0.75)
    no_value = mixed(plot, colour_of(theme.muted), 0.45)
    return MapPalette(theme, classes, rejected, no_value)
