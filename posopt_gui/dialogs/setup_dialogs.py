"""The dialogs of the setup panel: opened when it asks, one of each at a time."""

from __future__ import annotations

from PySide6.QtCore import QObject
from PySide6.QtWidgets import QDialog

from posopt_gui.controllers.session import Session
from posopt_gui.dialogs.path_dialog import PathDialog
from posopt_gui.dialogs.placement_dialog import PlacementDialog
from posopt_gui.viewmodels.path_preview import PathPreview
from posopt_gui.views.setup_view import SetupView


class SetupDialogs(QObject):
    """Opens the dialogs of a setup panel; none of them blocks the window."""

    def __init__(self, session: Session, setup: SetupView) -> None:
        super().__init__(setup)
        self._session, self._setup = session, setup
        self.path: PathDialog | None = None
        self.placement: PlacementDialog | None = None
        setup.path_questions.connect(self._ask_path)
        setup.placement_wanted.connect(self._ask_placement)

    def _ask_path(self, preview: PathPreview) -> None:
        if self.path is not None:
            self.path.close()
        self.path = PathDialog(self._session, preview, self._setup)
        self.path.finished.connect(self._path_done)
        self.path.show()

    def _ask_placement(self) -> None:
        if self.placement is None:
            self.placement = PlacementDialog(self._session, self._setup)
            self.placement.finished.connect(self._placement_done)
        _show(self.placement)

    def _path_done(self) -> None:
        self.path = None

    def _placement_done(self) -> None:
        self.placement = None


def _show(dialog: QDialog) -> None:
    dialog.show()
    dialog.raise_()
    dialog.activateWindow()
