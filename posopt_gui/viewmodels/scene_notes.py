"""The notes in the corner of the 3D panel, as lines of text."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from posopt_gui.viewmodels.inspector_model import UNDER_SAFETY, VERDICTS
from posopt_gui.viewmodels.number_words import decimal, group_words
from posopt_gui.viewmodels.scene_model import CellModel
from posopt_gui.viewmodels.scene_probe import PoseReport, Touch
from solver.candidates.outcomes import Outcome
from solver.units import DEG_PER_RAD, MM_PER_M

if TYPE_CHECKING:
    from solver.analysis.result import PlanningResult

Translate = Callable[..., str]

ROUND = 1e-9
"""An angle that is nearer to a whole number than this is shown as one [deg]."""

PATCH_WORDS = {
    Touch.TOO_DEEP: "Contact: {depth} mm into the {body}, more than allowed",
    Touch.ANOTHER: "Contact: the tool enters the {body}, which it must not touch",
}
"""What is said of contact that is not allowed."""


def candidate_line(
    result: PlanningResult, waypoint: int, orientation: int, slot: int, tr: Translate
) -> str:
    """Which cell of the map is looked at, and what became of that candidate."""
    found = result.candidates
    cell = waypoint, orientation, slot
    outcome = Outcome(int(found.outcome[cell]))
    verdict = VERDICTS[outcome]
    safety = result.problem.settings.safety_distance
    if outcome is Outcome.FEASIBLE and float(found.clearance[cell]) < safety:
        verdict = UNDER_SAFETY
    lean = float(found.orientations[orientation, 0]) * DEG_PER_RAD
    return tr(
        "Candidate at waypoint {number}, lean {lean}°: {verdict}",
        number=waypoint + 1,
        lean=decimal(lean, 0 if abs(lean - round(lean)) < ROUND else 2),
        verdict=tr(verdict),
    )


def note_lines(
    tr: Translate, cell: CellModel | None, report: PoseReport | None, *, stale: bool
) -> list[str]:
    """Lines on the shown pose and on what is not checked; `stale` says that inputs changed."""
    lines = []
    if stale:
        lines.append(tr("Pose and trail belong to the plan before the last change."))
    if report is not None and report.points is not None:
        moving, fixed = (spoken(tr, name) for name in report.bodies)
        words = "Clearance {distance}: {moving} to {fixed}"
        lines.append(tr(words, distance=report.millimetres, moving=moving, fixed=fixed))
    if report is not None:
        lines += [
            tr(
                PATCH_WORDS[one.touch],
                depth=f"{one.depth * MM_PER_M:.2f}",
                body=spoken(tr, one.group),
            )
            for one in report.patches
            if one.touch in PATCH_WORDS
        ]
    if cell is not None and not cell.cables:
        lines.append(tr("Cable package: not modelled, not checked"))
    return lines


def spoken(tr: Translate, name: str) -> str:
    """The group of a body, named 'group' or 'group (body)', in words."""
    return tr(group_words(name.split(" (", maxsplit=1)[0]))
