"""Runs of :mod:`solver.benchmarks.peers_child`, and what became of them."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import Any, NamedTuple

from solver.benchmarks.peers_child import OUT_OF_MEMORY

WALL_FACTOR = 10.0
"""A child that has taken so many times its processor time, and a minute, is ended."""

GIGABYTE = 1e9


@dataclass(frozen=True, slots=True)
class Bounds:
    """What one measurement may use: processor time [s] and memory [bytes]; runs of each."""

    seconds: float = 120.0
    memory: float = 8.0 * GIGABYTE
    repeats: int = 9


class Outcome(Enum):
    """What became of a measurement."""

    FINISHED = "finished"
    TIME = "over the time bound"
    MEMORY = "over the memory bound"
    MISSING = "not installed"
    FAILED = "failed"


class Answer(NamedTuple):
    """The outcome, the objects that the child printed, and what it said of a failure."""

    outcome: Outcome
    lines: list[dict[str, Any]]
    note: str


def run_child(job: Mapping[str, Any], bounds: Bounds) -> Answer:
    """Do a job in a process of its own, with one thread for each linear algebra library."""
    limits = {"seconds": bounds.seconds, "memory": bounds.memory, "repeats": bounds.repeats}
    root = str(Path(__file__).resolve().parents[2])
    paths = [root, *filter(None, [os.environ.get("PYTHONPATH")])]
    threads = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
    child = subprocess.Popen(
        [sys.executable, "-m", "solver.benchmarks.peers_child", json.dumps({**job, **limits})],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        encoding="utf-8",
        env={**os.environ, **threads, "PYTHONPATH": os.pathsep.join(paths)},
    )
    late = False
    try:
        said, complaint = child.communicate(timeout=60.0 + WALL_FACTOR * bounds.seconds)
    except subprocess.TimeoutExpired:
        late = True
        child.kill()
        said, complaint = child.communicate()
    except BaseException:
        child.kill()
        child.wait()
        raise
    lines = [json.loads(line) for line in said.splitlines() if line.endswith("}")]
    outcome = Outcome.TIME if late else outcome_of(child.returncode)
    note = ""
    if outcome is Outcome.FAILED:
        note = f"exit code {child.returncode}: {(complaint.strip().splitlines() or [''])[-1]}"
    return Answer(outcome, lines, note)


def outcome_of(code: int) -> Outcome:
    """What an exit code says; the kernel ends a process for its time and for lack of memory."""
    if code == 0:
        return Outcome.FINISHED
    if code == OUT_OF_MEMORY:
        return Outcome.MEMORY
    if code == -signal.SIGXCPU:
        return Outcome.TIME
    return Outcome.FAILED
