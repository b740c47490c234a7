"""From a planned sequence to a written program that was read back and checked."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from solver.analysis.check import Check, down_mm
from solver.analysis.result import PlanningResult
from solver.errors import InputError, RefusedError
from solver.io.ls_hash import HASH_REMARK, content_hash
from solver.io.ls_program_set import program_set
from solver.io.ls_reader import read_program
from solver.io.posts import Post, PostOptions, post_named
from solver.io.posts.post import FileForm
from solver.io.verified_program import Found, write_verified
from solver.model.problem import PlanningProblem
from solver.model.program import JointProgram, Move, Speed, rounded_joints
from solver.model.program_settings import ContactMotion
from solver.motion.corners import with_roundings
from solver.motion.links import linked_moves
from solver.pipeline.planning import rounded_clearance
from solver.pipeline.program_building import contact_moves, program_with
from solver.pipeline.program_check import (
    ProgramReport,
    inspect_moves,
    inspect_program,
    restated,
)
from solver.pipeline.remarks import NO_HASH
from solver.pipeline.simplify import simplified
from solver.progress import Monitor
from solver.units import MM, MM_PER_M

OVERRIDDEN = "_OVR"
"""Ends the name of a program that was written although a check failed."""

LEAST_REASON, LONGEST_REASON = 10, 200
"""Fewest and most characters of a reason for an override."""


@dataclass(frozen=True, slots=True)
class ProgramOrder:
    """How a program is to be written.

    Attributes
    ----------
    accepted_clearance : float or None
        Least clearance that a person accepts where the safety distance cannot be met [m].
    post : str or None
        Name of the post-processor; the cell's own where left out.
    simplify : float or None
        How far the moved TCP may leave the path where positions are dropped [m].
    override : str or None
        The reason for which a program is written although checks fail.
    """

    accepted_clearance: float | None = None
    post: str | None = None
    simplify: float | None = None
    override: str | None = None


@dataclass(frozen=True, slots=True)
class WrittenProgram:
    """A program that was written and read back: its files, main first, and its checks.

    `override` is the reason for which failed checks were passed over, None where all passed;
    `stale` are parts of an earlier program of this name that nothing calls any more.
    """

    paths: tuple[Path, ...]
    program: JointProgram
    report: ProgramReport
    override: str | None = None
    stale: tuple[Path, ...] = ()

    @property
    def checks(self) -> tuple[Check, ...]:
        """All checks of what was read back."""
        return self.report.checks

    @property
    def path(self) -> Path:
        """The main file."""
        return self.paths[0]


@dataclass(frozen=True, slots=True)
class ProgramDraft:
    """A program as it would be written: its files as (name, text), main first, and its checks.

    `override` is the reason that it needs, None where every check passes or none was given.
    """

    program: JointProgram
    files: tuple[tuple[str, str], ...]
    report: ProgramReport
    override: str | None = None


def draft_program(
    result: PlanningResult,
    order: ProgramOrder | None = None,
    name: str | None = None,
    monitor: Monitor | None = None,
) -> ProgramDraft:
    """Make and check a program without writing it; see `write_program`."""
    order = _stripped(order or ProgramOrder())
    problem = result.problem
    accepted, required = _required(result, order, refuse=False)
    post = post_named(order.post or problem.program.post)
    options = PostOptions.of(problem.program)
    title = (name or problem.program.name).upper()
    program = ordered_program(result, title, order, monitor)
    report = _inspected(problem, program, post, options, required, monitor)
    override = order.override if report.failed else None
    program = program_with(
        problem,
        title if override is None else title + OVERRIDDEN,
        program.moves,
        _found_clearance(report),
        accepted=accepted,
        override=override,
    )
    program = with_hash(program, post, options, problem)
    rendered = post.render(program, options, problem.robot)
    if post.suffix == ".LS":
        read = program_set(tuple(read_program(one.text, one.name) for one in rendered))
        report = restated(report, problem, read)
    files = tuple((one.name, one.text) for one in rendered)
    return ProgramDraft(program, files, report, override)


def _found_clearance(report: ProgramReport) -> float | None:
    """The clearance that the check of the positions found [m], None where it could not."""
    found = [check.value for check in report.checks if check.name == "clearance"]
    return found[0] * MM if found and np.isfinite(found[0]) else None


def write_program(
    result: PlanningResult,
    path: Path,
    order: ProgramOrder | None = None,
    monitor: Monitor | None = None,
) -> WrittenProgram:
    """Write the result's program, read it back and check it; nothing is left when a check fails.

    Raises
    ------
    RefusedError
        When a check fails and no override was given, or when links cannot be planned.
    InputError
        When the order or the file's name cannot be used.
    """
    order = _stripped(order or ProgramOrder())
    problem = result.problem
    check_order(problem, path, order)
    required = _required(result, order)[1]
    draft = draft_program(result, order, path.stem, monitor)
    if draft.report.failed and draft.override is None:
        raise _refusal(draft.report)
    reports: list[ProgramReport] = []

    def verify(found: Found) -> None:
        if isinstance(found, JointProgram):
            reports.append(inspect_moves(problem, found, required, (), monitor))
        else:
            reports.append(inspect_program(problem, program_set(found), required, monitor))
        if reports[-1].failed and draft.override is None:
            raise _refusal(reports[-1])

    target = path if draft.override is None else path.with_stem(path.stem + OVERRIDDEN)
    post = post_named(order.post or problem.program.post)
    options = PostOptions.of(problem.program)
    written = write_verified(draft.program, target, verify, options, post, problem.robot)
    return WrittenProgram(written.paths, draft.program, reports[-1], draft.override, written.stale)


def _stripped(order: ProgramOrder) -> ProgramOrder:
    return order if order.override is None else replace(order, override=order.override.strip())


def _refusal(report: ProgramReport) -> RefusedError:
    lines = "; ".join(str(check) for check in report.failed)
    return RefusedError(f"no program was written, since a check failed: {lines}")


def ordered_program(
    result: PlanningResult,
    name: str,
    order: ProgramOrder,
    monitor: Monitor | None = None,
) -> JointProgram:
    """The neutral program of the result's sequence, simplified and linked as ordered."""
    problem = _with_motion(result.problem, order)
    least = exported_clearance(result)
    passes = contact_moves(problem, rounded_joints(result.sequence.pendant))
    if order.simplify is not None:
        kept = min(least, problem.settings.safety_distance)
        passes = simplified(problem, passes, order.simplify, kept, monitor)
    moves = with_roundings(problem, linked(problem, passes, monitor))
    return program_with(problem, name, moves, None)


def _with_motion(problem: PlanningProblem, order: ProgramOrder) -> PlanningProblem:
    """The problem with the contact motion that the post needs: Cartesian ones are linear."""
    post = post_named(order.post or problem.program.post)
    if post.form is not FileForm.FANUC_CARTESIAN:
        return problem
    return replace(problem, program=replace(problem.program, contact=ContactMotion.LINEAR))


def exported_clearance(result: PlanningResult) -> float:
    """Least clearance of the result's sequence at its exported, rounded joints [m]."""
    return float(rounded_clearance(result.candidates, result.sequence.nodes).min())


def linked(
    problem: PlanningProblem,
    passes: tuple[tuple[Move, ...], ...],
    monitor: Monitor | None = None,
) -> tuple[Move, ...]:
    """The moves of all passes in one row, with links where the cell has them."""
    if problem.program.links is None:
        return tuple(move for one in passes for move in one)
    return linked_moves(problem, passes, monitor)


def with_hash(
    program: JointProgram, post: Post, options: PostOptions, problem: PlanningProblem
) -> JointProgram:
    """The program with the hash of its own content among its remarks, if robots run the post."""
    if post.suffix != ".LS":
        remarks = tuple(one for one in program.remarks if not one.startswith(HASH_REMARK))
        return replace(program, remarks=remarks)
    rendered = post.render(program, options, problem.robot)
    content = content_hash(read_program(one.text, one.name) for one in rendered)
    remarks = tuple(one.replace(NO_HASH, content) for one in program.remarks)
    return replace(program, remarks=remarks)


def _inspected(
    problem: PlanningProblem,
    program: JointProgram,
    post: Post,
    options: PostOptions,
    required: float,
    monitor: Monitor | None,
) -> ProgramReport:
    """Checks before anything is written: of the rendered text where the robot runs that."""
    if post.suffix != ".LS":
        return inspect_moves(problem, program, required, (), monitor)
    rendered = post.render(with_hash(program, post, options, problem), options, problem.robot)
    files = tuple(read_program(one.text, one.name) for one in rendered)
    return inspect_program(problem, program_set(files), required, monitor)


def _required(
    result: PlanningResult, order: ProgramOrder, *, refuse: bool = True
) -> tuple[float | None, float]:
    """The accepted clearance as it will be stamped, and what is required [m]."""
    required = result.problem.settings.safety_distance
    least = exported_clearance(result)
    accepted = order.accepted_clearance
    if accepted is not None and accepted < required and least < required:
        accepted = round(accepted * MM_PER_M, 3) * MM
        if accepted <= 0.0:
            raise InputError("an accepted clearance must be at least 0.001 mm")
        required = accepted
    else:
        accepted = None
    if refuse and least < required and order.override is None:
        raise RefusedError(
            f"no program was written: the best sequence keeps only {down_mm(least):.1f} mm of the "
            f"{required * MM_PER_M:g} mm asked; change the cell, or accept less with "
            f"--accept-clearance {down_mm(least):.1f}"
        )
    return accepted, required


def check_order(problem: PlanningProblem, path: Path, order: ProgramOrder) -> None:
    """Refuse, before anything is planned, what no program could be written with.

    The file's name, the frame and tool numbers, the comment, the remarks and the reason of an
    override are rendered with a single position.
    """
    post = post_named(order.post or problem.program.post)
    if path.suffix.upper() != post.suffix.upper():
        raise InputError(f"{path}: a file of {post.title} ends in {post.suffix}")
    if not path.absolute().parent.is_dir():
        raise InputError(f"{path}: there is no folder {path.parent}")
    targets = (
        [path, path.with_stem(path.stem + OVERRIDDEN)] if order.override is not None else [path]
    )
    for one in targets:
        if one.exists() and not one.is_file():
            raise InputError(f"{one}: it exists and is no regular file")
    limit = problem.program.path_tolerance
    if order.simplify is not None and not 0.0 < order.simplify <= limit:
        raise InputError(
            f"a tolerance for simplifying lies above 0 and up to the cell's path_tolerance_mm, "
            f"{limit * MM_PER_M:g} mm; got {order.simplify * MM_PER_M:g} mm"
        )
    reason = order.override.strip() if order.override is not None else None
    if reason is not None and not LEAST_REASON <= len(reason) <= LONGEST_REASON:
        raise InputError(
            f"an override needs a reason of at least {LEAST_REASON} characters and at most "
            f"{LONGEST_REASON}, got {len(reason)}: {reason[:50]!r}"
        )
    options = PostOptions.of(problem.program)
    for one in targets:
        speed = Speed.percent(problem.program.approach_percent)
        home = Move(joints=_probe(problem), speed=speed)
        program = program_with(problem, one.stem.upper(), (home,), None, override=reason)
        post.render(program, options, problem.robot)


def _probe(problem: PlanningProblem) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """A bent posture with every joint inside its limits, away from singularities."""
    limits = problem.robot.limits
    share = np.array([0.55, 0.45, 0.45, 0.55, 0.3, 0.55])
    return rounded_joints(limits[:, 0] + share * (limits[:, 1] - limits[:, 0]))
