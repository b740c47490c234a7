"""A wheel installed somewhere else finds its resources and plans, with no Qt at hand."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import venv
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[1]
NOT_PACKED = {"__pycache__", ".DS_Store"}
Command = Callable[..., subprocess.CompletedProcess[str]]

pytestmark = pytest.mark.wheel


def run(*arguments: str | Path, cwd: Path) -> subprocess.CompletedProcess[str]:
    hidden = {"PYTHONPATH", "PYTHONHOME", "VIRTUAL_ENV", "DISPLAY"}
    return subprocess.run(
        [str(argument) for argument in arguments],
        cwd=cwd,
        env={key: value for key, value in os.environ.items() if key not in hidden},
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build the wheel from a copy, so that the working tree stays as it is."""
    folder = tmp_path_factory.mktemp("wheel")
    source = folder / "source"
    source.mkdir()
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(REPOSITORY / name, source)
    for name in ("solver", "posopt_gui", "resources", "docs"):
        skip = shutil.ignore_patterns(*NOT_PACKED)
        shutil.copytree(REPOSITORY / name, source / name, ignore=skip)
    options = ("--no-deps", "--no-build-isolation", "--disable-pip-version-check")
    built = run(*(sys.executable, "-m", "pip", "wheel", *options, "-w", folder, source), cwd=folder)
    assert built.returncode == 0, built.stdout + built.stderr
    (path,) = folder.glob("posopt-*.whl")
    return path


@pytest.fixture(scope="module")
def posopt(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Command:
    """Install the wheel into an environment that shares the dependencies but refuses Qt."""
    home = tmp_path_factory.mktemp("elsewhere")
    venv.create(home / "venv", with_pip=False)
    paths = sysconfig.get_paths(vars={"base": str(home / "venv"), "platbase": str(home / "venv")})
    scripts, packages = Path(paths["scripts"]), Path(paths["purelib"])
    installed = run(
        *(sys.executable, "-m", "pip", "--python", scripts / "python"),
        *("install", "--no-deps", "--no-index", "--disable-pip-version-check", wheel),
        cwd=home,
    )
    assert installed.returncode == 0, installed.stdout + installed.stderr
    shared = {sysconfig.get_path("purelib"), sysconfig.get_path("platlib")}
    (packages / "dependencies.pth").write_text("\n".join(sorted(shared)), encoding="utf-8")
    for name in ("PySide6", "shiboken6", "pyqtgraph", "OpenGL"):
        refusal = f"raise ImportError({name!r} ' is not installed here')\n"
        (packages / f"{name}.py").write_text(refusal, encoding="utf-8")

    def command(*arguments: str | Path, cwd: Path, program: str = "posopt"):
        return run(scripts / program, *arguments, cwd=cwd)

    return command


def test_wheel_holds_every_module_and_every_resource(wheel):
    packed = set(zipfile.ZipFile(wheel).namelist())
    expected = set()
    for folder, name in (
        ("solver", "solver"),
        ("posopt_gui", "posopt_gui"),
        ("resources", "posopt_resources"),
        ("docs", "posopt_docs"),
    ):
        for path in (REPOSITORY / folder).rglob("*"):
            if path.is_file() and not NOT_PACKED.intersection(path.parts):
                expected.add(f"{name}/{path.relative_to(REPOSITORY / folder).as_posix()}")
    assert expected - packed == set()
    assert {name for name in packed if ".dist-info/" not in name} - expected == set()


def test_installed_wheel_is_what_runs(posopt, tmp_path):
    program = "import solver, posopt_resources as r; print(solver.__file__); print(r.__file__)"
    done = posopt("-c", program, cwd=tmp_path, program="python")
    assert done.returncode == 0, done.stderr
    for line in done.stdout.splitlines():
        assert "elsewhere" in Path(line).as_posix()
        assert not Path(line).is_relative_to(REPOSITORY)


def test_installed_wheel_brings_the_guide_with_its_pictures(posopt, tmp_path):
    program = "from posopt_gui.controllers.guide import guide_file; print(guide_file())"
    done = posopt("-c", program, cwd=tmp_path, program="python")
    assert done.returncode == 0, done.stderr
    guide = Path(done.stdout.strip())
    assert "elsewhere" in guide.as_posix()
    for page in (guide, guide.with_name("window_zh_CN.md")):
        targets = re.findall(r"\]\(([^)#]+)[^)]*\)", page.read_text("utf-8"))
        assert any(target.endswith(".png") for target in targets)
        assert [one for one in targets if not (page.parent / one).is_file()] == []


def test_installed_wheel_lists_its_cells(posopt, tmp_path):
    done = posopt("list", "cells", "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "groove_hw300" in json.dumps(json.loads(done.stdout))
    assert "groove_paper" in done.stdout


def test_installed_wheel_plans_the_default_cell_and_writes_its_program(posopt, tmp_path):
    done = posopt("plan", "--out", "GROOVE.LS", cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    program = (tmp_path / "GROOVE.LS").read_bytes()
    assert program.startswith(b"/PROG  GROOVE")
    assert program.rstrip().endswith(b"/END")
    checked = posopt("check", "GROOVE.LS", cwd=tmp_path)
    assert checked.returncode == 0, checked.stdout + checked.stderr
