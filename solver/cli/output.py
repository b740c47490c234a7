"""What the commands print: JSON, tables and a progress bar."""

from __future__ import annotations

import contextlib
import json
import math
import os
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from solver.errors import InputError, PosoptError
from solver.io.atomic import write_atomically
from solver.progress import COMPILING

_BAR = 28
_FIRST_SHOWN = 0.5
_INTERVAL = 0.1
_COMPILING_NOTE = (
    "compiling the kernels; this takes up to a few minutes, once after an installation or update"
)


class TerminalMonitor:
    """A monitor with a progress bar on stderr, shown only on terminals and for long runs."""

    def __init__(self) -> None:
        self._shown = sys.stderr.isatty()
        self._started = self._last = time.monotonic()
        self._drawn = False

    def report(self, stage: str, done: int, total: int) -> None:
        """Draw the bar, at most ten times a second."""
        if stage == COMPILING:
            print(_COMPILING_NOTE, file=sys.stderr, flush=True)
            return
        now = time.monotonic()
        if not self._shown or now - self._started < _FIRST_SHOWN or now - self._last < _INTERVAL:
            return
        self._last, self._drawn = now, True
        share = done / total if total else 1.0
        filled = int(_BAR * share)
        bar = "#" * filled + "." * (_BAR - filled)
        sys.stderr.write(f"\r{stage:<12} [{bar}] {100 * share:3.0f} %")
        sys.stderr.flush()

    def cancelled(self) -> bool:
        """Never: Ctrl-C interrupts between two pieces of work."""
        return False

    def close(self) -> None:
        """Remove the bar."""
        if self._drawn:
            sys.stderr.write("\r" + " " * (_BAR + 24) + "\r")
            sys.stderr.flush()


def plain(value: Any) -> Any:
    """Arrays and tuples as lists, and numbers that JSON cannot hold as null."""
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def say(text: str) -> None:
    """Print a line; a reader that has gone away changes nothing about what is done."""
    try:
        print(text)
        sys.stdout.flush()
    except BrokenPipeError:
        with contextlib.suppress(OSError, ValueError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except OSError as error:
        raise InputError(f"the output cannot be written ({error.strerror})") from error


def check_json_target(target: str) -> None:
    """Refuse, before anything is done, a file that no document should or could be written to."""
    path = Path(target)
    if path.suffix.lower() != ".json":
        raise InputError(f"--json {target}: a file name ending in .json was expected")
    if not path.absolute().parent.is_dir():
        raise InputError(f"--json {target}: there is no folder {path.parent}")
    if path.exists() and not path.is_file():
        raise InputError(f"--json {target}: it exists and is no regular file")


def emit_json(document: Mapping[str, Any], target: str) -> None:
    """Write a document to a file, or to the screen for '-'."""
    text = json.dumps(plain(document), indent=2, ensure_ascii=False, allow_nan=False)
    if target == "-":
        say(text)
    else:
        write_atomically(Path(target), f"{text}\n".encode())


def refused(command: str, error: PosoptError) -> int:
    """Say why a command that has already reported its result fails; returns its exit code."""
    print(f"posopt {command}: {error}", file=sys.stderr)
    return error.exit_code
