"""Which pose the 3D panel shows: of the plan, or a candidate that is looked at; its measures."""

from __future__ import annotations

from typing import TYPE_CHECKING

from posopt_gui.controllers.session import Hover, Session

if TYPE_CHECKING:
    from posopt_gui.viewmodels.scene_model import CellModel, Ghost
    from posopt_gui.viewmodels.scene_probe import PoseProbe, PoseReport
    from solver.transforms import FloatArray


class Looked:
    """Joints, measures and notes of the pose that stands in the picture, and of its ghost."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self.report: PoseReport | None = None
        self.ghost_report: PoseReport | None = None
        self.ghost: Hover | None = None

    @property
    def shown_report(self) -> PoseReport | None:
        """What is drawn: of the ghost as soon as it is measured, else of the pose."""
        return self.report if self.ghost_report is None else self.ghost_report

    def pose_of(self, candidate: Hover | None) -> Ghost | None:
        """The pose of a candidate, None where the arm does not reach it."""
        from posopt_gui.viewmodels.scene_model import ghost_at  # noqa: PLC0415 - with the canvas

        result = self._session.result
        if candidate is None or result is None:
            return None
        return ghost_at(result, candidate.waypoint, candidate.orientation, candidate.branch)

    def joints(self, cell: CellModel) -> FloatArray:
        """(6,) the solid pose: of the chosen candidate, of the plan, or at home."""
        from posopt_gui.viewmodels.scene_model import joints_at  # noqa: PLC0415

        candidate = self.pose_of(self._session.kept)
        if candidate is not None:
            return candidate.joints
        sequence = self._session.sequence
        return cell.rest if sequence is None else joints_at(sequence.pendant, self._session.place)

    def measure(self, cell: CellModel, probe: PoseProbe | None) -> None:
        """Clearance and contact of the solid pose; of a stale plan nothing is said."""
        session = self._session
        whole = session.place == session.cursor
        known = not session.stale and session.sequence is not None and self._fits(probe)
        self.report = None
        if probe is not None and known and (probe.quick or whole):
            self.report = probe.measure(self.joints(cell), session.cursor)

    def measure_ghost(self, probe: PoseProbe | None) -> None:
        """Clearance and contact of the ghost."""
        pose = self.pose_of(self.ghost)
        self.ghost_report = None
        known = pose is not None and not self._session.stale and self._fits(probe)
        if probe is not None and pose is not None and self.ghost is not None and known:
            self.ghost_report = probe.measure(pose.joints, self.ghost.waypoint)

    def _fits(self, probe: PoseProbe | None) -> bool:
        """Whether what measures belongs to the plan, and not to the one before it."""
        result = self._session.result
        return probe is not None and result is not None and probe.problem is result.problem

    def notes(self, cell: CellModel | None) -> list[str]:
        """Lines about what is shown."""
        from posopt_gui.viewmodels.scene_notes import (  # noqa: PLC0415 - with the canvas
            candidate_line,
            note_lines,
        )

        session = self._session
        tr = session.look.tr
        if session.problem is None and session.problem_error is not None:
            return [tr("The drawing shows the cell before the last change.")]
        of = self.ghost if self.ghost_report is not None else session.kept
        lines = note_lines(tr, cell, self.shown_report, stale=session.stale)
        if of is None or session.result is None or not of.stands_in(session.result.candidates):
            return lines
        words = candidate_line(session.result, of.waypoint, of.orientation, of.branch, tr)
        return [words, *lines]
