"""Pictures of every view in both themes, both languages and two sizes.

    python -m posopt_gui.screenshots OUT/ [--only NAME ...] [--looks ...] [--sizes 1440x900 ...]

It needs a display with OpenGL; Xvfb with Mesa's software drawing will do.
"""

from __future__ import annotations

import argparse
import itertools
import os
import sys
import tempfile
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from posopt_gui.app import NO_DISPLAY, has_display

if TYPE_CHECKING:
    from posopt_gui.screenshot_scenes import Scene
    from posopt_gui.screenshot_stage import Stage

SIZES = ("1280x800", "2560x1440")
THEMES = ("light", "dark")
LANGUAGES = ("en", "zh_CN")


@dataclass(frozen=True, slots=True)
class Look:
    """A size, a theme and a language."""

    size: str
    theme: str
    language: str

    @property
    def folder(self) -> str:
        """Where its pictures lie."""
        return f"{self.size}_{self.theme}_{self.language}"

    @property
    def pixels(self) -> tuple[int, int]:
        """Width and height of the window."""
        width, height = self.size.split("x")
        return int(width), int(height)


def parser() -> argparse.ArgumentParser:
    """The arguments of the command."""
    made = argparse.ArgumentParser("posopt_gui.screenshots", description="pictures of the window")
    made.add_argument("out", type=Path, metavar="OUT", help="folder for the pictures")
    made.add_argument("--only", nargs="+", metavar="NAME", help="only the pictures of that name")
    made.add_argument("--sizes", nargs="+", default=SIZES, metavar="WIDTHxHEIGHT")
    made.add_argument("--themes", nargs="+", default=THEMES, choices=THEMES)
    made.add_argument("--languages", nargs="+", default=LANGUAGES, choices=LANGUAGES)
    return made


def main(arguments: Sequence[str] | None = None) -> int:
    """Take the pictures and write MANIFEST.md beside them; returns the exit code."""
    options = parser().parse_args(sys.argv[1:] if arguments is None else list(arguments))
    if not has_display(sys.platform, os.environ):
        sys.stderr.write(NO_DISPLAY + "\n")
        return 2
    from posopt_gui.screenshot_scenes import SCENES  # noqa: PLC0415 - Qt is loaded when needed
    from posopt_gui.screenshot_stage import Stage  # noqa: PLC0415

    known = {scene.name for scene in SCENES}
    unknown = sorted(set(options.only or ()) - known)
    if unknown:
        sys.stderr.write(f"no picture is called {', '.join(unknown)}; known: {sorted(known)}\n")
        return 2
    scenes = [one for one in SCENES if not options.only or one.name in options.only]
    looks = [
        Look(*values)
        for values in itertools.product(options.sizes, options.themes, options.languages)
    ]
    with tempfile.TemporaryDirectory(prefix="posopt_") as folder:
        stage = Stage(Path(folder))
        for scene in scenes:
            take(stage, scene, looks, options.out)
            sys.stdout.write(f"{scene.name}\n")
            sys.stdout.flush()
        stage.close()
    write_manifest(options.out, scenes, looks)
    return 0


def take(stage: Stage, scene: Scene, looks: Iterable[Look], out: Path) -> list[Path]:
    """Take a scene's picture in each look, and leave the window as it was."""
    from posopt_gui.screenshot_stage import picture  # noqa: PLC0415

    written = []
    scene.begin(stage)
    for look in looks:
        stage.look(look.theme, look.language, look.pixels)
        widget = scene.show(stage)
        stage.drawn()
        path = out / look.folder / f"{scene.name}.png"
        path.parent.mkdir(parents=True, exist_ok=True)
        if not picture(widget).save(str(path)):
            raise OSError(f"{path} cannot be written")
        written.append(path)
        scene.hide(stage)
    scene.end(stage)
    return written


def write_manifest(out: Path, scenes: Iterable[Scene], looks: Iterable[Look]) -> None:
    """List what was taken."""
    lines = ["# Pictures of the window", "", "Folders: " + ", ".join(one.folder for one in looks)]
    lines += ["", "| picture | shows |", "| --- | --- |"]
    lines += [f"| {scene.name}.png | {scene.tells} |" for scene in scenes]
    (out / "MANIFEST.md").write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
