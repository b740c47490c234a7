"""`@kernel`: a function compiled by numba, cached on disk under the hash of all kernels.

numba checks only the file of a kernel itself before it takes machine code from its cache; code
of other kernels is compiled into it and would stay as it was when their file changes. So the
cache folder is named by a hash over every file of this package that compiled code is made of:
after an update nothing of an earlier version can run.
"""

from __future__ import annotations

import hashlib
import os
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numba
from numba import njit

SOURCES = ("kernels*.py", "units.py", "kernel.py")
"""Files whose code or constants end up in compiled kernels."""


@cache
def sources_hash() -> str:
    """Hash over the names and contents of `SOURCES`, and numba's version."""
    digest = hashlib.sha256(numba.__version__.encode())
    root = Path(__file__).parent
    for path in sorted(one for pattern in SOURCES for one in root.rglob(pattern)):
        digest.update(path.relative_to(root).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


@cache
def cache_folder() -> Path:
    """Where compiled kernels are kept: NUMBA_CACHE_DIR if it is set, else the user's cache."""
    return _base_folder() / f"kernels-{sources_hash()}"


def _base_folder() -> Path:
    stated = os.environ.get("NUMBA_CACHE_DIR")
    if stated:
        return Path(stated)
    variable = "LOCALAPPDATA" if sys.platform == "win32" else "XDG_CACHE_HOME"
    stated = os.environ.get(variable)
    if stated:
        return Path(stated) / "posopt"
    usual = Path("AppData", "Local") if sys.platform == "win32" else Path(".cache")
    try:
        return Path.home() / usual / "posopt"
    except RuntimeError:  # a user without a home
        return Path(__file__).parent / "__pycache__"


def kernel(function: Callable[..., Any]) -> Any:
    """Compile without the interpreter lock, cached; floating-point rules stay strict."""
    return _cached(function)


def inline_kernel(function: Callable[..., Any]) -> Any:
    """Like `kernel`, and always inlined into its callers: for a few operations in hot loops."""
    return _cached(function, forceinline=True)


def _cached(function: Callable[..., Any], **options: bool) -> Any:
    # The cache's folder is fixed when the function is decorated; other packages that use numba
    # in this process keep their own.
    settings: Any = numba.config
    compiler: Any = njit
    before = settings.CACHE_DIR
    settings.CACHE_DIR = str(cache_folder())
    try:
        return compiler(cache=True, nogil=True, **options)(function)
    finally:
        settings.CACHE_DIR = before
