"""The user guide in a window of its own, so that no other program has to be there to read it."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, Final

from PySide6.QtCore import Qt, QTimer, QUrl
from PySide6.QtGui import QDesktopServices, QImage, QKeySequence, QResizeEvent, QShortcut
from PySide6.QtWidgets import QHBoxLayout, QTextBrowser, QToolButton, QVBoxLayout, QWidget

from posopt_gui.look import Look

SIZE: Final = (900, 760)
MARGIN: Final = 28
"""Room beside the text [px]."""

BROKEN: Final = re.compile("(?<=[\u3001-\u9fff\uff01-\uff5e])\n(?=[\u4e00-\u9fff\uff08])")
"""Where a line of Chinese words is broken in its file: no blank belongs there."""


class GuidePage(QTextBrowser):
    """Markdown with its pictures made as wide as the page at most."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setOpenExternalLinks(False)
        self.setOpenLinks(False)
        self.anchorClicked.connect(self._follow)
        self.document().setDocumentMargin(MARGIN)
        # All lines are broken and pictures scaled; a bar would only say that there was no bar yet.
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self._later = QTimer(self)
        self._later.setSingleShot(True)
        self._later.setInterval(120)
        self._later.timeout.connect(self.reload)

    def loadResource(self, kind: int, name: QUrl | str) -> Any:  # noqa: N802 - Qt's name
        """Scale pictures down to the page, and join broken lines of Chinese words."""
        file = self.source().resolved(QUrl(name)).toLocalFile()
        if file.lower().endswith(".md") and Path(file).is_file():
            return BROKEN.sub("", Path(file).read_text("utf-8"))
        if not file.lower().endswith((".png", ".svg")):
            return super().loadResource(kind, QUrl(name))
        image = QImage(file)
        room = max(self.viewport().width() - 2 * MARGIN - 12, 200)
        scale = self.devicePixelRatioF()
        if image.width() > room:
            smooth = Qt.TransformationMode.SmoothTransformation
            image = image.scaledToWidth(int(min(room * scale, image.width())), smooth)
            image.setDevicePixelRatio(image.width() / room)
        return image

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        """Scale the pictures anew, once it keeps still."""
        super().resizeEvent(event)
        if event.size().width() != event.oldSize().width():
            self._later.start()

    def reload(self) -> None:
        """Lay the page out again, at the same place."""
        bar = self.verticalScrollBar()
        share = bar.value() / max(bar.maximum(), 1)
        self.document().clear()
        super().reload()
        bar.setValue(round(share * bar.maximum()))

    def _follow(self, link: QUrl) -> None:
        """Other pages open here; what is no page, and what is elsewhere, in its own program."""
        url = self.source().resolved(link)
        if not url.isLocalFile():
            QDesktopServices.openUrl(url)
        elif url.path().endswith(".md") and Path(url.toLocalFile()).is_file():
            self.setSource(url)
            self.show_heading(url.fragment())
        elif Path(url.toLocalFile()).is_file():
            QDesktopServices.openUrl(url)

    def show_heading(self, anchor: str) -> None:
        """Scroll to the heading that a link names as its words in lower case with hyphens."""
        block = self.document().begin()
        while anchor and block.isValid():
            if block.blockFormat().headingLevel() and _anchor_of(block.text()) == anchor:
                top = self.document().documentLayout().blockBoundingRect(block).top()
                self.verticalScrollBar().setValue(int(top))
                return
            block = block.next()


def _anchor_of(heading: str) -> str:
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


class GuideWindow(QWidget):
    """The page, and buttons to go back and to the beginning."""

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent, Qt.WindowType.Window)
        self._look = look
        self.page = GuidePage()
        self._file = Path()
        self._back, self._home = QToolButton(), QToolButton()
        self._back.clicked.connect(self.page.backward)
        self._home.clicked.connect(lambda: self.open(self._file))
        self._back.setEnabled(False)
        self.page.backwardAvailable.connect(self._back.setEnabled)
        QShortcut(QKeySequence(Qt.Key.Key_Escape), self, self.close)
        row = QHBoxLayout()
        row.setContentsMargins(8, 6, 8, 2)
        row.addWidget(self._back)
        row.addWidget(self._home)
        row.addStretch(1)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addLayout(row)
        column.addWidget(self.page, 1)
        self.resize(*SIZE)
        look.language_changed.connect(self.retranslate)
        self.retranslate()

    def open(self, file: Path) -> None:
        """Show a guide, in the window's language where it is there."""
        self._file = file
        own = file.with_name(f"{file.stem}_{self._look.language}{file.suffix}")
        self.page.setSource(QUrl.fromLocalFile(str(own if own.is_file() else file)))

    def retranslate(self) -> None:
        """Set all texts again, and show the guide of the language."""
        tr = self._look.tr
        self.setWindowTitle(tr("Guide"))
        self._back.setText(tr("Back"))
        self._home.setText(tr("Beginning"))
        if self._file.is_file():
            self.open(self._file)
