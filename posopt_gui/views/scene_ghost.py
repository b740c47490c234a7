"""The ghost of the 3D panel: the candidate under the mouse, as a see-through robot."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from PySide6.QtCore import QObject, QTimer

from posopt_gui.controllers.session import Hover, Session
from solver.candidates.outcomes import Outcome

if TYPE_CHECKING:
    from posopt_gui.views.scene_view import SceneView

OPACITY: Final = 0.42

QUICK: Final = 0.008
"""A drawing that takes longer than this [s] shows the ghost only where the mouse rests."""

REST: Final = 40
"""How long it has to rest then [ms]."""


class SceneGhost(QObject):
    """Follows the session's hover; where drawing is slow it does not hold up the mouse."""

    def __init__(self, session: Session, view: SceneView) -> None:
        super().__init__(view)
        self._session, self._view = session, view
        self._rest = QTimer(self)
        self._rest.setSingleShot(True)
        self._rest.setInterval(REST)
        self._rest.timeout.connect(self._show)
        session.hover_changed.connect(self._on_hover)

    def catch_up(self) -> None:
        """Show at once what is waiting for the mouse to rest."""
        if self._rest.isActive():
            self._rest.stop()
            self._show()

    def _on_hover(self, hover: Hover | None) -> None:
        canvas = self._view.canvas
        if canvas is None:
            return
        if hover is None or canvas.seconds < QUICK:
            self._rest.stop()
            self._show()
        else:
            self._rest.start()

    def _show(self) -> None:
        canvas, result, hover = self._view.canvas, self._session.result, self._session.hover
        if canvas is None:
            return
        if hover is None or result is None:
            canvas.show_ghost(None)
            return
        from posopt_gui.viewmodels.scene_model import ghost_at  # noqa: PLC0415 - with the canvas
        from posopt_gui.views.scene_items import rgba  # noqa: PLC0415 - loads OpenGL

        ghost = ghost_at(result, hover.waypoint, hover.orientation, hover.branch)
        if ghost is None:
            canvas.show_ghost(None)
            return
        theme = self._session.look.theme
        feasible = ghost.outcome is Outcome.FEASIBLE
        colour = theme.accent if feasible else theme.outcome(ghost.outcome)
        canvas.show_ghost(ghost.joints, rgba(colour, OPACITY))
