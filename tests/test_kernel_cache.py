"""Machine code of an earlier version can never run: caches are named by all kernels' sources."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import solver
from solver.kernel import cache_folder

SCRIPT = """
import numpy as np
from solver.kinematics.kernels_arm import manipulability, manipulability_many
out = np.zeros(1)
manipulability_many(np.array([0.15, 0.79, 0.25, 0.835]), np.full((1, 6), 0.3), out)
from solver.kernel import cache_folder
print(out[0], cache_folder().name)
"""


def test_an_edited_kernel_reaches_the_kernels_that_call_it_from_the_cache(tmp_path):
    """The cached caller holds the callee's machine code, which numba does not check."""
    package = tmp_path / "solver"
    shutil.copytree(
        Path(solver.__file__).parent, package, ignore=shutil.ignore_patterns("__pycache__")
    )
    environment = os.environ | {
        "PYTHONPATH": str(tmp_path),
        "NUMBA_CACHE_DIR": str(tmp_path / "cache"),
        # The edit below keeps time and size, by which Python would take its old bytecode.
        "PYTHONDONTWRITEBYTECODE": "1",
    }

    def run():
        found = subprocess.run(
            [sys.executable, "-c", SCRIPT],
            env=environment,
            cwd=tmp_path,
            text=True,
            capture_output=True,
            check=True,
        )
        value, folder = found.stdout.split()
        return float(value), folder

    before, folder = run()
    assert run() == (before, folder)
    shapes = package / "collision" / "kernels_shapes.py"
    shapes.write_text(shapes.read_text("utf-8") + "\n# changed\n", "utf-8")
    arm = package / "kinematics" / "kernels_arm.py"
    stamp = arm.stat()
    arm.write_text(arm.read_text("utf-8").replace("abs(a2 *", "abs(a3 *"), "utf-8")
    os.utime(arm, ns=(stamp.st_atime_ns, stamp.st_mtime_ns))
    after, changed = run()
    assert changed != folder
    assert after != before


def test_every_kernel_uses_the_folder_named_by_the_sources():
    from solver.candidates.kernels_candidates import evaluate_poses
    from solver.search.kernels_sweep import sweep

    for one in (evaluate_poses, sweep):
        assert str(one.stats.cache_path).startswith(str(cache_folder()))
