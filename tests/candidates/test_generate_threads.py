"""Candidates from several threads: the same bytes, progress in order, prompt cancelling."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np
import pytest

from solver.candidates.generate import POSES_PER_CALL, generate
from solver.catalog import load_cell
from solver.errors import Cancelled
from solver.model.settings import Sweep
from solver.units import DEG


@pytest.fixture(scope="module")
def problem():
    """The groove pass with lead as a second angle: some sixty pieces of work."""
    cell = load_cell("groove_hw300")
    lead = Sweep(-5.0 * DEG, 5.0 * DEG, 2.0 * DEG)
    return replace(cell, settings=replace(cell.settings, lead=lead))


class Recorder:
    """Keeps every report and cancels once so many have come."""

    def __init__(self, patience):
        self.patience, self.reports = patience, []

    def report(self, stage, done, total):
        self.reports.append((stage, done, total))

    def cancelled(self):
        return len(self.reports) >= self.patience


def same_bytes(one, other):
    return all(
        np.asarray(getattr(one, field.name)).tobytes()
        == np.asarray(getattr(other, field.name)).tobytes()
        for field in fields(one)
        if isinstance(getattr(one, field.name), np.ndarray)
    )


@pytest.mark.parametrize("threads", [2, 3])
def test_candidates_are_the_same_bytes_whatever_the_number_of_threads(problem, threads):
    alone, together = generate(problem, threads=1), generate(problem, threads=threads)
    assert len(alone.nodes) > 10_000
    assert same_bytes(alone, together)
    assert same_bytes(alone.nodes, together.nodes)


def test_progress_of_two_threads_is_told_as_that_of_one(problem):
    alone, together = Recorder(10**9), Recorder(10**9)
    generate(problem, alone, threads=1)
    generate(problem, together, threads=2)
    assert len(alone.reports) > 15_300 // POSES_PER_CALL
    assert alone.reports == together.reports


@pytest.mark.parametrize("patience", [1, 2, 7])
def test_two_threads_stop_at_the_report_that_asks_for_it(problem, patience):
    recorder = Recorder(patience)
    with pytest.raises(Cancelled):
        generate(problem, recorder, threads=2)
    assert len(recorder.reports) == patience


@pytest.mark.parametrize("threads", [1, 2])
def test_compiling_is_told_until_the_first_kernel_has_returned(problem, monkeypatch, threads):
    from solver.candidates import generate as module

    kernel, told, before = module.evaluate_poses, Recorder(10**9), []

    def watched(*arguments):
        if not before:
            before.extend(told.reports)
        kernel(*arguments)

    monkeypatch.setattr(module, "kernels_are_cached", lambda: False)
    monkeypatch.setattr(module, "evaluate_poses", watched)
    generate(problem, told, threads=threads)
    assert [stage for stage, _, _ in before] == ["compiling"]
    assert "candidates" in {stage for stage, _, _ in told.reports}
