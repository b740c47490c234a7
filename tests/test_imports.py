"""The solver stands alone: no Qt, no early numba, and layers that point one way."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[1]
WINDOW_PACKAGES = ("PySide6", "shiboken6", "pyqtgraph", "OpenGL", "posopt_gui")

REFUSE_WINDOW = f"""
import sys

class Refuse:
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in {WINDOW_PACKAGES!r}:
            raise ImportError(name + " is refused here")
        return None

sys.meta_path.insert(0, Refuse())
"""

IMPORT_EVERYTHING = """
import importlib
import pkgutil
import solver

names = [found.name for found in pkgutil.walk_packages(solver.__path__, "solver.")]
for name in names:
    if not name.endswith("__main__"):
        importlib.import_module(name)
"""


def run(program: str) -> subprocess.CompletedProcess[str]:
    environment = os.environ | {"PYTHONPATH": str(REPOSITORY)}
    return subprocess.run(
        [sys.executable, "-W", "error", "-c", program],
        env=environment,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )


def test_every_module_of_the_solver_imports_where_qt_is_refused():
    done = run(REFUSE_WINDOW + IMPORT_EVERYTHING + "print(len(names))")
    assert done.returncode == 0, done.stderr
    modules = list((REPOSITORY / "solver").rglob("*.py"))
    assert int(done.stdout) == len(modules) - 1  # all but solver itself


def test_every_module_of_the_solver_leaves_the_window_packages_unloaded():
    report = f"""
import sys
print(*sorted({{name.split(".")[0] for name in sys.modules}} & set({WINDOW_PACKAGES!r})))
"""
    done = run(IMPORT_EVERYTHING + report)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == []


@pytest.mark.parametrize("package", ["numba", "llvmlite", "fcl", "trimesh"])
def test_importing_solver_does_not_load(package):
    done = run(f"import solver, sys; print({package!r} in sys.modules)")
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == "False"


def test_importing_the_window_loads_no_qt_and_no_numba():
    done = run(
        "import posopt_gui.app, sys;"
        "print(*({name.split('.')[0] for name in sys.modules} & {'PySide6', 'numba'}))"
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == []


def test_layers_import_downwards_only():
    done = subprocess.run(
        [sys.executable, "-c", "from importlinter.cli import lint_imports_command as c; c()"],
        cwd=REPOSITORY,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "0 broken" in done.stdout
