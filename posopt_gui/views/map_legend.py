"""The legend of what the map shows."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from posopt_gui.viewmodels.map_colours import (
    CLASS_LABELS,
    CLASS_LETTERS,
    LAYER_LABELS,
    CellClass,
)
from posopt_gui.views.map_canvas import letter_colour
from posopt_gui.views.map_items import qcolour
from posopt_gui.views.map_shown import Shown
from posopt_gui.views.map_widgets import Bar, Chip, LegendStrip

Translate = Callable[..., str]


def show_legend(legend: LegendStrip, shown: Shown, *, known: bool, tr: Translate) -> None:
    """Show colours and their meaning; `known` tells whether a search has given its values."""
    theme = shown.colours.theme
    if shown.cells is None or shown.model is None:
        legend.set_legend(None, (), theme)
    elif shown.scale is None:
        found = shown.model.counts(shown.cells.kind)
        chips = [
            _class_chip(shown, kind, f"{tr(text)} {found[kind]:,}")
            for kind, text in CLASS_LABELS.items()
            if kind in found
        ]
        legend.set_legend(None, chips, theme)
    else:
        unit = f" [{shown.scale.unit}]" if shown.scale.unit else ""
        title = tr(LAYER_LABELS[shown.cells.layer]) + unit
        bar = Bar(title, shown.scale, shown.colours.table(shown.cells.layer))
        legend.set_legend(bar, _value_chips(shown, known, tr), theme)


def _class_chip(shown: Shown, kind: CellClass, text: str) -> Chip:
    colour = shown.colours.classes[kind]
    return Chip(qcolour(colour), CLASS_LETTERS[kind], qcolour(letter_colour(colour, 200)), text)


def _value_chips(shown: Shown, known: bool, tr: Translate) -> list[Chip]:
    cells = shown.cells
    if cells is None or cells.values is None:
        return []
    held = cells.node >= 0
    missing = int((held & ~np.isfinite(cells.values)).sum())
    if cells.layer.scheme is None:
        words = tr("no sequence passes")
    else:
        words = tr("never expanded") if known else tr("being worked out …")
    chips = []
    for count, text, colour in (
        (int((~held).sum()), tr("not feasible"), shown.colours.rejected),
        (missing, words, shown.colours.no_value),
    ):
        if count:
            tone = qcolour(shown.colours.theme.text)
            chips.append(Chip(qcolour(colour), "", tone, f"{text} {count:,}"))
    return chips
