"""The headless solver of posopt: from a grinding path and an H-beam to a checked robot program.

    import solver
    result = solver.plan(solver.load_cell("groove_hw300"))

Everything public is reachable from here and loaded when it is first used: kernels take a
moment to compile the first time. docs/api.md has an example of each name.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from solver.lazy_names import lazy_names

if TYPE_CHECKING:
    from solver.analysis.references import references as references
    from solver.analysis.report import result_document as result_document
    from solver.analysis.report import summary as summary
    from solver.analysis.result import PlanningResult as PlanningResult
    from solver.candidates.explain import explain as explain
    from solver.candidates.generate import generate as generate
    from solver.catalog import list_names as list_names
    from solver.catalog import load_beam as load_beam
    from solver.catalog import load_cell as load_cell
    from solver.catalog import load_robot as load_robot
    from solver.catalog import load_tool as load_tool
    from solver.collision.distance import distance as distance
    from solver.errors import PosoptError as PosoptError
    from solver.io.importers import load_toolpath as load_toolpath
    from solver.io.importers import parametric_toolpath as parametric_toolpath
    from solver.io.importers import resample as resample
    from solver.io.ls_program_set import read_program_set as read_program_set
    from solver.io.ls_reader import read_program as read_program
    from solver.kinematics.arm import forward as forward
    from solver.kinematics.arm import inverse as inverse
    from solver.kinematics.configuration import config_string as config_string
    from solver.kinematics.jacobian import jacobian as jacobian
    from solver.kinematics.jacobian import manipulability as manipulability
    from solver.model.problem import PlanningProblem as PlanningProblem
    from solver.model.settings import Scheme as Scheme
    from solver.pipeline.planning import layered_graph as layered_graph
    from solver.pipeline.planning import plan as plan
    from solver.pipeline.program_check import check_program as check_program
    from solver.pipeline.program_check import inspect_program as inspect_program
    from solver.pipeline.programming import ProgramOrder as ProgramOrder
    from solver.pipeline.programming import write_program as write_program
    from solver.search.exact import exact as exact

_HOME: Final = {
    "PlanningProblem": "solver.model.problem",
    "PlanningResult": "solver.analysis.result",
    "PosoptError": "solver.errors",
    "ProgramOrder": "solver.pipeline.programming",
    "Scheme": "solver.model.settings",
    "check_program": "solver.pipeline.program_check",
    "config_string": "solver.kinematics.configuration",
    "distance": "solver.collision.distance",
    "exact": "solver.search.exact",
    "explain": "solver.candidates.explain",
    "forward": "solver.kinematics.arm",
    "generate": "solver.candidates.generate",
    "inspect_program": "solver.pipeline.program_check",
    "inverse": "solver.kinematics.arm",
    "jacobian": "solver.kinematics.jacobian",
    "layered_graph": "solver.pipeline.planning",
    "list_names": "solver.catalog",
    "load_beam": "solver.catalog",
    "load_cell": "solver.catalog",
    "load_robot": "solver.catalog",
    "load_tool": "solver.catalog",
    "load_toolpath": "solver.io.importers",
    "manipulability": "solver.kinematics.jacobian",
    "parametric_toolpath": "solver.io.importers",
    "plan": "solver.pipeline.planning",
    "read_program": "solver.io.ls_reader",
    "read_program_set": "solver.io.ls_program_set",
    "references": "solver.analysis.references",
    "resample": "solver.io.importers",
    "result_document": "solver.analysis.report",
    "summary": "solver.analysis.report",
    "write_program": "solver.pipeline.programming",
}

__all__ = sorted(_HOME)  # noqa: PLE0605 - a list of strings, kept in one place

__getattr__, __dir__ = lazy_names(__name__, _HOME)
