"""The notes in the corner of the 3D panel, as lines of text."""

from __future__ import annotations

from collections.abc import Callable

from posopt_gui.viewmodels.scene_model import CellModel
from posopt_gui.viewmodels.scene_probe import PoseReport, Touch
from solver.units import MM_PER_M

Translate = Callable[..., str]

PATCH_WORDS = {
    Touch.TOO_DEEP: "Contact: {depth} mm into the {body}, more than allowed",
    Touch.ANOTHER: "Contact: the tool enters the {body}, which it must not touch",
}
"""What is said of contact that is not allowed."""


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
    return tr(name.split(" (", maxsplit=1)[0].replace("_", " "))
