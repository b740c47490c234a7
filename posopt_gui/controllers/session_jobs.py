"""What the session has done off the window's thread."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from posopt_gui.document.project import ProjectState
    from solver.analysis.result import PlanningResult
    from solver.model.scheme import Scheme
    from solver.model.wishes import Pin, Region
    from solver.pipeline.program_check import ProgramReport
    from solver.pipeline.replanning import Replanned
    from solver.progress import Monitor


@dataclass(frozen=True, slots=True, eq=False)
class Planned:
    """Answer of a planning job: what was planned, and what came of it."""

    state: ProjectState
    result: PlanningResult
    answer: Replanned | None


def planned_by(state: ProjectState, schemes: tuple[Scheme, ...], monitor: Monitor) -> Planned:
    """Plan inputs, and answer their wishes."""
    from solver.pipeline.planning import plan  # noqa: PLC0415 - numba is loaded when it is needed

    result = plan(state.problem(), monitor, compare=schemes)
    return Planned(state, result, answered_by(result, state.pins, state.regions, monitor))


def answered_by(
    result: PlanningResult, pins: tuple[Pin, ...], regions: tuple[Region, ...], monitor: Monitor
) -> Replanned | None:
    """Answer wishes to a plan; None where there are none."""
    from solver.pipeline.replanning import replan  # noqa: PLC0415

    return replan(result, pins, regions, monitor) if pins or regions else None


def checked_by(result: PlanningResult, monitor: Monitor) -> ProgramReport:
    """Draft the program of a plan and check it."""
    from solver.pipeline.programming import ProgramOrder, draft_program  # noqa: PLC0415

    return draft_program(result, ProgramOrder(), monitor=monitor).report
