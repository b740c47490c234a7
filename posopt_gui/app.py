"""Start of the window.

Qt is imported inside `main` only, so that importing this module needs no display and no
system library.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Mapping, Sequence

NO_DISPLAY = (
    "posopt-gui: no display was found (neither DISPLAY nor WAYLAND_DISPLAY is set); "
    "start it from a desktop session, or use `posopt plan`."
)
DEFAULT_CELL = "groove_hw300"


def has_display(platform: str, environment: Mapping[str, str]) -> bool:
    """Say whether Qt can open a window; only on Linux can it be seen beforehand."""
    if not platform.startswith("linux") or environment.get("QT_QPA_PLATFORM"):
        return True
    return bool(environment.get("DISPLAY") or environment.get("WAYLAND_DISPLAY"))


def parser() -> argparse.ArgumentParser:
    """The arguments of the command."""
    made = argparse.ArgumentParser("posopt-gui", description="the window of posopt")
    made.add_argument(
        "file",
        nargs="?",
        metavar="CELL|PROJECT|PATH",
        help="a cell by name or file, a project, or a path file",
    )
    made.add_argument("--language", choices=["en", "zh_CN"], help="language of the window")
    made.add_argument("--theme", choices=["light", "dark"], help="colours of the window")
    made.add_argument("--smoke", action="store_true", help="close it as soon as it shows")
    return made


def main(arguments: Sequence[str] | None = None) -> int:
    """Open the window and return the exit code."""
    options = parser().parse_args(sys.argv[1:] if arguments is None else list(arguments))
    if not has_display(sys.platform, os.environ):
        sys.stderr.write(NO_DISPLAY + "\n")
        return 2
    try:
        from posopt_gui.start import run  # noqa: PLC0415 - Qt only when a window is wanted
    except ImportError as error:
        sys.stderr.write(f"posopt-gui: Qt cannot be loaded ({error}); see README.md.\n")
        return 2
    return run(options.file, options.language, options.theme, smoke=options.smoke)


if __name__ == "__main__":
    sys.exit(main())
