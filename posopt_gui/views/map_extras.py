"""What the map shows beyond the plan: worked out off the window's thread, when it is asked for."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Signal

from posopt_gui.viewmodels.map_colours import Layer
from posopt_gui.viewmodels.map_lines import constant_nodes, scheme_search
from posopt_gui.viewmodels.map_model import Choice, MapModel
from posopt_gui.workers.jobs import JobLine
from posopt_gui.workers.threads import JobThreads
from solver.model.settings import Scheme
from solver.transforms import FloatArray, IntArray

if TYPE_CHECKING:
    from solver.analysis.result import PlanningResult
    from solver.candidates.generate import CandidateSet
    from solver.model.problem import PlanningProblem
    from solver.progress import Monitor


@dataclass(slots=True, eq=False)
class Extras:
    """What is known of one plan; None stands for what could not be found."""

    orders: dict[Scheme, FloatArray] = field(default_factory=dict)
    paths: dict[Scheme, IntArray | None] = field(default_factory=dict)
    constant: list[IntArray | None] = field(default_factory=list)


class MapExtras(QObject):
    """Works out orders of expansion, lines to compare and the candidates of a failed plan."""

    changed = Signal()
    candidates_found = Signal(object)
    model_ready = Signal(object)
    cells_ready = Signal(object)
    """Cells and their scale."""

    explaining = Signal()
    """From now on `explain` is compiled and answers at once."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._pool = JobThreads(1, self)
        self._searches = self._line(self._searched)
        self._rejected = self._line(self.candidates_found.emit)
        self._warming = self._line(lambda _: self.explaining.emit())
        self._models = self._line(self.model_ready.emit)
        self._cells = self._line(self.cells_ready.emit)
        self._result: PlanningResult | None = None
        self._wanted: tuple[Scheme, ...] = ()
        self._wants_constant = False
        self.known = Extras()

    def _line(self, done: Callable[..., Any]) -> JobLine:
        line = JobLine(self._pool, self)
        line.done.connect(done)
        self.destroyed.connect(line.close)
        return line

    def set_result(self, result: PlanningResult | None) -> None:
        """Forget what was known of another plan."""
        for line in (self._searches, self._rejected, self._models, self._cells):
            line.stop()
        self._result, self.known = result, Extras()
        self._wanted, self._wants_constant = (), False

    def want(self, schemes: Iterable[Scheme], *, constant: bool) -> None:
        """Find what is not known yet; `changed` tells when it is."""
        result = self._result
        missing = tuple(one for one in schemes if one not in self.known.paths)
        lacks = constant and not self.known.constant
        if result is None or not (missing or lacks):
            return
        if self._searches.busy and (missing, lacks) == (self._wanted, self._wants_constant):
            return
        self._wanted, self._wants_constant = missing, lacks
        self._searches.submit(lambda monitor: _search(result, missing, lacks, monitor))

    def generate(self, problem: PlanningProblem) -> None:
        """Find the candidates of a problem that has no plan."""
        self._rejected.submit(lambda monitor: _generate(problem, monitor))

    def prepare(self, candidates: CandidateSet) -> None:
        """Make the model of many candidates."""
        self._models.submit(lambda _: _prepared(candidates))

    def colour(
        self, model: MapModel, layer: Layer, choice: Choice, given: FloatArray | None
    ) -> None:
        """Work out a page of many candidates."""
        self._cells.submit(lambda _: (model.cells(layer, choice, given), model.scale(layer, given)))

    def warm(self, candidates: CandidateSet) -> None:
        """Have the explanation of a candidate compiled."""
        self._warming.submit(lambda _: _explain_first(candidates))

    def close(self) -> None:
        """Cancel what is being worked out and wait for it."""
        for line in (self._searches, self._rejected, self._warming, self._models, self._cells):
            line.close()
        self._pool.wait()

    def _searched(self, found: Extras) -> None:
        self.known.orders |= found.orders
        self.known.paths |= found.paths
        self.known.constant += found.constant
        self.changed.emit()


def _search(
    result: PlanningResult, schemes: tuple[Scheme, ...], constant: bool, monitor: Monitor
) -> Extras:
    found = Extras()
    for scheme in schemes:
        path, order = scheme_search(result, scheme, monitor)
        found.paths[scheme], found.orders[scheme] = path, order
    if constant:
        found.constant.append(constant_nodes(result))
    return found


def _generate(problem: PlanningProblem, monitor: Monitor) -> CandidateSet:
    from solver.candidates.generate import generate  # noqa: PLC0415 - numba

    return generate(problem, monitor)


def _prepared(candidates: CandidateSet) -> MapModel:
    model = MapModel(candidates)
    model.prepare()
    return model


def _explain_first(candidates: CandidateSet) -> None:
    from solver.candidates.explain import explain  # noqa: PLC0415 - numba

    lean = float(candidates.orientations[0, 0])
    explain(candidates.problem, 0, lean, int(candidates.branches[0]), scene=candidates.scene)
