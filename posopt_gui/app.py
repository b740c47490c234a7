"""Start of the window: a placeholder until there is one.

Qt is imported inside `main` only, so that importing this module needs no display and no
system library.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping, Sequence

TITLE = "posopt"
SENTENCE = "The window of posopt is not there yet; `posopt plan` on the command line works."
NO_DISPLAY = (
    "posopt-gui: no display was found (neither DISPLAY nor WAYLAND_DISPLAY is set); "
    "start it from a desktop session, or use `posopt plan`."
)


def has_display(platform: str, environment: Mapping[str, str]) -> bool:
    """Say whether Qt can open a window; only on Linux can it be seen beforehand."""
    if not platform.startswith("linux") or environment.get("QT_QPA_PLATFORM"):
        return True
    return bool(environment.get("DISPLAY") or environment.get("WAYLAND_DISPLAY"))


def main(arguments: Sequence[str] | None = None) -> int:
    """Show the placeholder and return the exit code; `--smoke` closes it at once."""
    if arguments is None:
        arguments = sys.argv[1:]
    if not has_display(sys.platform, os.environ):
        sys.stderr.write(NO_DISPLAY + "\n")
        return 2
    try:
        from PySide6.QtCore import Qt, QTimer  # noqa: PLC0415 - Qt only when a window is wanted
        from PySide6.QtWidgets import QApplication, QLabel, QMainWindow  # noqa: PLC0415
    except ImportError as error:
        sys.stderr.write(f"posopt-gui: Qt cannot be loaded ({error}); see README.md.\n")
        return 2

    application = QApplication([TITLE])
    window = QMainWindow()
    window.setWindowTitle(TITLE)
    label = QLabel(SENTENCE)
    label.setAlignment(Qt.AlignmentFlag.AlignCenter)
    label.setMargin(40)
    label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
    window.setCentralWidget(label)
    window.show()
    if "--smoke" in arguments:
        QTimer.singleShot(0, application.quit)
    return int(application.exec())


if __name__ == "__main__":
    sys.exit(main())
