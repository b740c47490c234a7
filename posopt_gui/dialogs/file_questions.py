"""The questions about files, asked in the only modal windows that there are."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtWidgets import QFileDialog, QMessageBox, QWidget

from posopt_gui.controllers.files import CELL_SUFFIX, with_suffix
from posopt_gui.controllers.path_import import PATH_SUFFIXES
from posopt_gui.controllers.questions import Choice, Clash
from posopt_gui.document.project_file import SUFFIX
from posopt_gui.look import Look


class FileQuestions:
    """Asks with dialogs over a window."""

    def __init__(self, parent: QWidget, look: Look) -> None:
        self._parent, self._tr = parent, look.tr

    def unsaved(self, name: str) -> Choice:
        """Ask what to do with changes that were not saved."""
        box = QMessageBox(self._parent)
        box.setIcon(QMessageBox.Icon.Warning)
        box.setWindowTitle("posopt")
        box.setText(self._tr("Save the changes of {name}?", name=name))
        box.setInformativeText(self._tr("What is not saved is lost."))
        role = QMessageBox.ButtonRole
        save = box.addButton(self._tr("Save"), role.AcceptRole)
        discard = box.addButton(self._tr("Do not save"), role.DestructiveRole)
        cancel = box.addButton(self._tr("Cancel"), role.RejectRole)
        box.setDefaultButton(save)
        box.setEscapeButton(cancel)
        box.exec()
        clicked = box.clickedButton()
        if clicked is save:
            return Choice.SAVE
        return Choice.DISCARD if clicked is discard else Choice.CANCEL

    def written_meanwhile(self, name: str) -> Clash:
        """Ask what to do with a project file that is no longer as it was read or saved here."""
        box = QMessageBox(self._parent)
        box.setIcon(QMessageBox.Icon.Warning)
        box.setWindowTitle("posopt")
        words = "{name} was changed by another window or program since it was opened or saved here."
        box.setText(self._tr(words, name=name))
        box.setInformativeText(self._tr("Replacing it loses what was saved there."))
        role = QMessageBox.ButtonRole
        other = box.addButton(self._tr("Save as…"), role.AcceptRole)
        replace = box.addButton(self._tr("Replace"), role.DestructiveRole)
        cancel = box.addButton(self._tr("Cancel"), role.RejectRole)
        box.setDefaultButton(other)
        box.setEscapeButton(cancel)
        box.exec()
        clicked = box.clickedButton()
        if clicked is other:
            return Clash.OTHER_NAME
        return Clash.REPLACE if clicked is replace else Clash.CANCEL

    def open_name(self, folder: str) -> str:
        """Ask which project, cell or path to open."""
        words = self._tr("Projects, cells and paths")
        endings = (SUFFIX, CELL_SUFFIX, *PATH_SUFFIXES)
        names = " ".join(f"*{one} *{one.upper()}" for one in endings)
        kinds = f"{words} ({names})"
        return QFileDialog.getOpenFileName(self._parent, self._tr("Open"), folder, kinds)[0]

    def save_name(self, proposal: str, suffix: str) -> str:
        """Ask where to save, and whether a file that exists may be replaced."""
        kinds = f"*{suffix} (*{suffix})"
        # The dialog would ask about the name as typed, not about the one with its suffix.
        option = QFileDialog.Option.DontConfirmOverwrite
        title = self._tr("Save as")
        while proposal:
            proposal = QFileDialog.getSaveFileName(
                self._parent, title, proposal, kinds, options=option
            )[0]
            if proposal:
                path = with_suffix(Path(proposal), suffix)
                if not path.exists() or self.may_replace(path):
                    return str(path)
        return ""

    def may_replace(self, path: Path) -> bool:
        """Ask whether a file may be replaced."""
        words = self._tr("{name} exists already. Replace it?", name=path.name)
        answer = QMessageBox.question(self._parent, "posopt", words)
        return answer == QMessageBox.StandardButton.Yes
