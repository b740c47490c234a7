"""The paper's main table: f, f1 and f2 with the exact scheme and the best constant lean beside."""

from __future__ import annotations

from solver.analysis.result import Sequence
from solver.model.problem import PlanningProblem
from solver.model.settings import Scheme
from solver.pipeline.planning import exact_sequence, paper_sequence
from solver.progress import SilentMonitor
from solver.search import paper
from solver.study.constant import best_constant
from solver.study.context import ALL_SCHEMES, Study, lean_range, plain_graph, second_difference
from solver.study.sections import Column, Section, StudyTable, Value, percent
from solver.units import DEG_PER_RAD, MM_PER_M, MS_PER_S

MOTION_COLUMNS = (
    Column("joint cost", "", 5),
    Column("least clearance", "mm"),
    Column("mean clearance", "mm"),
    Column("largest second difference", "deg", 3),
    Column("lean", "deg"),
)


def motion_cells(one: Sequence, problem: PlanningProblem) -> tuple[Value, ...]:
    """The values of `MOTION_COLUMNS`."""
    return (
        one.joint_cost,
        one.least_clearance * MM_PER_M,
        one.mean_clearance * MM_PER_M,
        second_difference(one, problem) * DEG_PER_RAD,
        lean_range(one),
    )


def millimetres(length: float | None) -> float | None:
    """A length for people; None stays None."""
    return None if length is None else length * MM_PER_M


def schemes(study: Study) -> Section:
    """f, f1, f2 and the exact scheme beside the best constant lean, on the cell's own beam."""
    result = study.result
    times = {scheme: _search_time(study, scheme) for scheme in ALL_SCHEMES}
    rows: list[tuple[Value, ...]] = []
    for scheme in ALL_SCHEMES:
        one, published = study.sequence(scheme), study.published_run(scheme)
        rows.append(
            (
                scheme.value,
                times[scheme] * MS_PER_S,
                one.expanded,
                *motion_cells(one, study.problem),
                published.search_time * MS_PER_S if published.search_time else None,
                published.expanded,
                millimetres(published.least_clearance),
                millimetres(published.mean_clearance),
            )
        )
    constant = best_constant(result)
    if constant is not None:
        rows.append(
            ("best constant lean", None, None, *motion_cells(constant, study.problem), *[None] * 4)
        )
    table = StudyTable(
        "schemes",
        f"Schemes on {result.problem.workpiece.name}",
        (
            Column("scheme"),
            Column("search time", "ms", 2, timing=True),
            Column("expanded"),
            *MOTION_COLUMNS,
            Column("published search time", "ms", 0),
            Column("published expanded"),
            Column("published least clearance", "mm", 1),
            Column("published mean clearance", "mm", 1),
        ),
        tuple(rows),
        "The search time is the median of the search alone, on the machine at hand.",
    )
    started = paper.f(plain_graph(result.graph), result.problem.settings.heuristic_weight)
    f, f2, best = (study.sequence(one) for one in (Scheme.F, Scheme.F2, Scheme.EXACT))
    text = (
        f"Scheme f passes at {f.least_clearance * MM_PER_M:.2f} mm, f2 at "
        f"{f2.least_clearance * MM_PER_M:.2f} mm for "
        f"{percent(f2.joint_cost / f.joint_cost - 1.0)} joint cost. Under a hard minimum of "
        f"{result.hard_minimum * MM_PER_M:.2f} mm the proven optimum of this grid costs "
        f"{best.joint_cost:.5f}.",
        "Expanded counts closed nodes of A*, stale entries left out. Before it, scheme f runs a "
        f"Dijkstra search that closes {started.dijkstra_expanded:,} more, which the comparison of "
        "expanded nodes does not show.",
    )
    numbers = {"dijkstra_expanded_of_f": started.dijkstra_expanded}
    return Section("schemes", "Schemes", text, (table, _changes(study, times)), numbers=numbers)


def _changes(study: Study, times: dict[Scheme, float]) -> StudyTable:
    """Changes of f2 against f and f1, and what is published of them."""
    f2 = study.sequence(Scheme.F2)
    own = bool(study.published_run(Scheme.F2).name)
    rows: list[tuple[Value, ...]] = []
    for scheme, suffix in ((Scheme.F, ""), (Scheme.F1, "_against_goals")):
        other = study.sequence(scheme)
        published = study.published.changes if own else {}
        known = [published.get(f"{kind}_change{suffix}") for kind in ("search_time", "expanded")]
        rows.append(
            (
                f"f2 against {scheme.value}",
                _hundredfold(times[Scheme.F2] / times[scheme] - 1.0),
                _hundredfold((f2.expanded or 0) / (other.expanded or 1) - 1.0),
                _hundredfold(f2.joint_cost / other.joint_cost - 1.0),
                _hundredfold(f2.least_clearance / other.least_clearance - 1.0),
                _hundredfold(f2.mean_clearance / other.mean_clearance - 1.0),
                *(None if one is None else _hundredfold(one) for one in known),
            )
        )
    return StudyTable(
        "changes",
        "Changes of f2",
        (
            Column("change"),
            Column("search time", "%", 1, timing=True),
            Column("expanded", "%", 1),
            Column("joint cost", "%", 1),
            Column("least clearance", "%", 1),
            Column("mean clearance", "%", 1),
            Column("published search time", "%", 1),
            Column("published expanded", "%", 1),
        ),
        tuple(rows),
    )


def _hundredfold(share: float) -> float:
    return 100.0 * share


def _search_time(study: Study, scheme: Scheme) -> float:
    result, silent = study.result, SilentMonitor()
    if scheme is Scheme.EXACT:
        return study.timed(lambda: exact_sequence(result.candidates, result.graph, silent))
    return study.timed(lambda: paper_sequence(result.candidates, result.graph, scheme, silent))
