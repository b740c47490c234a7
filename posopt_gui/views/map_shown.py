"""What the map shows at the moment; its parts read it, the view alone changes it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from posopt_gui.viewmodels.map_colours import Layer, Scale
from posopt_gui.viewmodels.map_model import (
    BEST_OF_ALL,
    Cells,
    Choice,
    MapModel,
    Reading,
    extra_cost_percent,
)
from posopt_gui.views.map_interaction import Cell
from posopt_gui.views.map_palette import MapPalette
from solver.model.settings import Scheme
from solver.transforms import FloatArray

if TYPE_CHECKING:
    from solver.analysis.result import PlanningResult
    from solver.pipeline.replanning import Replanned


@dataclass(slots=True, eq=False)
class Shown:
    """Model, page and colours; `model` without `result` holds the candidates of a failed plan."""

    colours: MapPalette
    model: MapModel | None = None
    result: PlanningResult | None = None
    layer: Layer = Layer.OUTCOME
    choice: Choice = BEST_OF_ALL
    cells: Cells | None = None
    scale: Scale | None = None
    extra_cost: FloatArray | None = None

    def holds(self, cell: Cell | None) -> bool:
        """Whether the shown grid has a cell; one of an older grid may lie beyond it."""
        model = self.model
        if cell is None or model is None:
            return False
        return 0 <= cell.waypoint < model.waypoints and 0 <= cell.row < model.rows

    def reading(self, cell: Cell | None) -> Reading | None:
        """What stands in a cell on the shown page, None where there is no such cell."""
        if cell is None or self.model is None or self.cells is None or not self.holds(cell):
            return None
        return self.model.reading(self.cells, cell.waypoint, cell.row)

    @property
    def plan_cost(self) -> float:
        """Cost of the exact plan without wishes; nan where it is not known."""
        sequences = self.result.sequences if self.result is not None else {}
        found = sequences.get(Scheme.EXACT)
        return found.cost if found is not None else float("nan")

    def take_extra_cost(self, answer: Replanned | None) -> None:
        """Take the extra costs [%] of the answer to wishes, or those of the plan."""
        self.extra_cost = None
        if self.result is None or np.isnan(self.plan_cost):
            return
        answered = answer is not None and answer.sequence is not None
        costs = answer.extra_cost if answer is not None and answered else self.result.extra_cost
        self.extra_cost = extra_cost_percent(costs, self.plan_cost)
