"""The ghost of the 3D panel: the candidate under the mouse, as a see-through robot."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from PySide6.QtCore import QObject, QTimer

from posopt_gui.controllers.session import Hover, Session
from posopt_gui.views.refresh import REST as HAND_RESTS
from solver.candidates.outcomes import Outcome

if TYPE_CHECKING:
    from posopt_gui.views.scene_looked import Looked
    from posopt_gui.views.scene_view import SceneView

OPACITY: Final = 0.42

QUICK: Final = 0.008
"""A drawing that takes longer than this [s] shows the ghost only where the mouse rests."""

REST: Final = 40
"""How long it has to rest then [ms]."""

MEASURED_AFTER: Final = 30
"""How long after it was shown a ghost is measured [ms]: it is not to hold up the mouse."""


class SceneGhost(QObject):
    """Follows the session's hover; where drawing is slow it does not hold up the mouse."""

    def __init__(self, session: Session, view: SceneView, looked: Looked) -> None:
        super().__init__(view)
        self._session, self._view, self._looked = session, view, looked
        self._measuring = QTimer(self)
        self._measuring.setSingleShot(True)
        self._measuring.setInterval(MEASURED_AFTER)
        self._measuring.timeout.connect(view.measure_ghost)
        self._rest = QTimer(self)
        self._rest.setSingleShot(True)
        self._rest.setInterval(REST)
        self._rest.timeout.connect(self._show)
        session.hover_changed.connect(self._on_hover)
        session.kept_changed.connect(lambda _: self._on_hover(session.hover))

    def catch_up(self) -> None:
        """Show at once what is waiting for the mouse to rest."""
        if self._rest.isActive():
            self._rest.stop()
            self._show()
        if self._measuring.isActive():
            self._measuring.stop()
            self._view.measure_ghost()

    def _on_hover(self, hover: Hover | None) -> None:
        canvas = self._view.canvas
        if canvas is None:
            return
        if hover is None or canvas.seconds < QUICK:
            self._rest.stop()
            self._show()
        else:
            # A drawing at every step of a drag would hold up the line that follows the hand.
            self._rest.start(HAND_RESTS if self._session.previewing else REST)

    def _show(self) -> None:
        canvas, hover = self._view.canvas, self._session.hover
        if canvas is None:
            return
        # What is chosen stands there in full already.
        chosen = self._session.kept
        hover = None if chosen is not None and _same_pose(hover, chosen) else hover
        ghost = self._looked.pose_of(hover)
        self._looked.ghost = hover if ghost is not None else None
        if self._looked.ghost_report is not None:
            self._looked.ghost_report = None
            self._view.show_report()
        if ghost is None:
            self._measuring.stop()
            canvas.show_ghost(None)
            return
        from posopt_gui.views.scene_items import rgba  # noqa: PLC0415 - loads OpenGL

        self._measuring.start()
        theme = self._session.look.theme
        feasible = ghost.outcome is Outcome.FEASIBLE
        colour = theme.accent if feasible else theme.outcome(ghost.outcome)
        canvas.show_ghost(ghost.joints, rgba(colour, OPACITY))


def _same_pose(one: Hover | None, other: Hover) -> bool:
    """Whether two candidates are in the same place; turns put every body there."""
    return one is not None and (one.waypoint, one.orientation, one.branch) == (
        other.waypoint,
        other.orientation,
        other.branch,
    )
