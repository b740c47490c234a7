"""What the 3D panel has made away from the window's thread; the kernels are loaded in there."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from posopt_gui.viewmodels.scene_model import CellModel
    from posopt_gui.viewmodels.scene_probe import PoseProbe
    from solver.analysis.result import PlanningResult
    from solver.model.problem import PlanningProblem


def build_cell(problem: PlanningProblem) -> CellModel:
    """Build the meshes of a problem."""
    from posopt_gui.viewmodels.scene_model import cell_model  # noqa: PLC0415

    return cell_model(problem)


def build_probe(result: PlanningResult) -> PoseProbe:
    """Make the probe of a plan and use it once, so that its kernels are ready."""
    from posopt_gui.viewmodels.scene_probe import PoseProbe  # noqa: PLC0415

    probe = PoseProbe(result.problem, result.candidates.scene)
    probe.measure(result.sequence.pendant[0], 0)
    probe.prepare()
    return probe
