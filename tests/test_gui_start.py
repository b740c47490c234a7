"""The window starts, and says in one sentence when it cannot."""

from __future__ import annotations

import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement

REPOSITORY = Path(__file__).resolve().parents[1]


def run_window(environment: dict[str, str], *arguments: str) -> subprocess.CompletedProcess[str]:
    hidden = {"DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"}
    kept = {key: value for key, value in os.environ.items() if key not in hidden}
    return subprocess.run(
        [sys.executable, "-m", "posopt_gui.app", *arguments],
        cwd=REPOSITORY,
        env=kept | environment,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


@pytest.fixture
def offscreen(tmp_path):
    """A platform without a screen, and folders of the test for what the window writes."""
    folders = ("XDG_DATA_HOME", "XDG_CONFIG_HOME")
    return {"QT_QPA_PLATFORM": "offscreen"} | {name: str(tmp_path) for name in folders}


def test_window_opens_and_closes_with_exit_code_zero(offscreen):
    done = run_window(offscreen, "--smoke")
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr


def test_window_opens_the_cell_that_is_named_in_a_chosen_look(offscreen):
    look = ("--language", "zh_CN", "--theme", "dark")
    done = run_window(offscreen, "groove_paper", *look, "--smoke")
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("name", ["nowhere.posopt", "no_such_cell", "broken.posopt"])
def test_a_file_that_cannot_be_opened_is_one_sentence_and_exit_code_two(offscreen, tmp_path, name):
    (tmp_path / "broken.posopt").write_text("{", encoding="utf-8")
    file = tmp_path / name
    done = run_window(offscreen, str(file) if file.suffix else name, "--smoke")
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.count("\n") == 1
    assert done.stderr.startswith("posopt-gui: ")
    assert name in done.stderr


def test_what_the_command_takes_is_told_without_a_display():
    done = run_window({}, "--help")
    assert done.returncode == 0
    for word in ("CELL|PROJECT|PATH", "--language", "--theme"):
        assert word in done.stdout


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux lacks a display")
def test_missing_display_is_one_sentence_and_exit_code_two():
    done = run_window({})
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.count("\n") == 1
    assert "no display" in done.stderr
    assert "posopt plan" in done.stderr


def test_the_frame_of_the_window_needs_neither_kernels_nor_plots_nor_opengl():
    # They take seconds to load; the window is on screen before.
    program = "import sys, posopt_gui.start; print(*sorted(sys.modules))"
    done = subprocess.run(
        [sys.executable, "-c", program],
        cwd=REPOSITORY,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    loaded = set(done.stdout.split())
    assert "PySide6.QtWidgets" in loaded
    assert loaded.isdisjoint({"numba", "pyqtgraph", "OpenGL", "trimesh", "fcl", "scipy"})


def test_qt_calls_do_not_drop_references_to_none():
    # PySide6 6.12.0 loses one reference to None in every call that returns it; on Python 3.11,
    # where None is not immortal, the process aborts after some thousands of calls.
    program = """
import sys
from PySide6.QtWidgets import QApplication, QWidget

application = QApplication([])
widget = QWidget()
for call in (widget.hide, widget.parent, lambda: widget.setWindowTitle("x")):
    call()
    before = sys.getrefcount(None)
    for _ in range(500):
        call()
    print(sys.getrefcount(None) - before)
"""
    done = subprocess.run(
        [sys.executable, "-c", program],
        env=os.environ | {"QT_QPA_PLATFORM": "offscreen"},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    changes = [int(line) for line in done.stdout.split()]
    assert len(changes) == 3
    assert min(changes) > -100, changes


@pytest.mark.parametrize(
    ("python", "version", "allowed"),
    [
        ("3.11", "6.11.3", True),
        ("3.11", "6.12.0", False),
        ("3.11", "6.12.1", False),
        ("3.12", "6.12.0", True),
        ("3.13", "6.11.3", True),
    ],
)
def test_qt_is_pinned_below_6_12_for_python_under_3_12(python, version, allowed):
    project = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))
    requirements = [Requirement(text) for text in project["project"]["dependencies"]]
    qt = [
        requirement
        for requirement in requirements
        if requirement.name == "PySide6-Essentials"
        and (requirement.marker is None or requirement.marker.evaluate({"python_version": python}))
    ]
    assert len(qt) == 1
    assert qt[0].specifier.contains(version) is allowed
