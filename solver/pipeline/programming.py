"""From a planned sequence to a written program, and from a program back to its checks."""

from __future__ import annotations

import re
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

import numpy as np

from solver.analysis.motion_check import check_motion
from solver.analysis.program_check import Check, check_positions
from solver.analysis.result import PlanningResult, Sequence
from solver.costs.steps import gap_times
from solver.errors import InputError, RefusedError
from solver.io.ls_program import ProgramFile
from solver.io.posts.fanuc_joint import render_fanuc_joint
from solver.io.verified_program import differences, write_verified
from solver.model.problem import PlanningProblem
from solver.model.program import JointProgram, Move, rounded_joints
from solver.model.toolpath import Event
from solver.pipeline.digest import problem_digest
from solver.pipeline.flow_check import check_flow
from solver.transforms import FloatArray
from solver.units import MM, MM_PER_M

CELL_REMARK = "CELL "
BEAM_REMARK = "BEAM "
ACCEPTED_REMARK = "ACCEPTED CLEARANCE "
DIGEST_REMARK = "DIGEST "


@dataclass(frozen=True, slots=True)
class WrittenProgram:
    """A program that was written and read back: where, and the checks it passed."""

    path: Path
    checks: tuple[Check, ...]


def build_program(
    result: PlanningResult,
    name: str | None = None,
    sequence: Sequence | None = None,
    accepted_clearance: float | None = None,
) -> JointProgram:
    """The joint program of a sequence (the result's own by default).

    Moves within a pass last as long as their distance takes at the feed; the first move of
    each pass goes at the cell's approach speed and ends FINE.
    """
    joints = rounded_joints((sequence or result.sequence).pendant)
    title = name or result.problem.program.name
    return program_of(result.problem, joints, title, accepted_clearance)


def program_of(
    problem: PlanningProblem, joints: FloatArray, name: str, accepted: float | None = None
) -> JointProgram:
    """The program that a problem asks for, through pendant joints (n, 6) [rad], rounded already."""
    times = gap_times(problem)
    events = _events(problem)
    last = len(joints) - 1
    moves = []
    for index, row in enumerate(joints):
        arriving = np.nan if index == 0 else float(times[index - 1])
        leaving = np.nan if index == last else float(times[index])
        fine = np.isnan(arriving) or np.isnan(leaving)
        moves.append(
            Move(
                joints=row,
                percent=problem.program.approach_percent if np.isnan(arriving) else None,
                duration=None if np.isnan(arriving) else arriving,
                # What happens at a waypoint happens there, not while its corner is being cut.
                cnt=None if fine or index in events else 100,
                waypoint=index,
                events=events.get(index, ()),
            )
        )
    return _program(problem, name, tuple(moves), accepted)


def _program(
    problem: PlanningProblem, name: str, moves: tuple[Move, ...], accepted: float | None
) -> JointProgram:
    settings = problem.program
    return JointProgram(
        name=name.upper(),
        comment=settings.comment,
        remarks=_remarks(problem, accepted),
        uframe=settings.uframe,
        utool=settings.utool,
        moves=moves,
        date=settings.date,
        time=settings.time,
    )


def _events(problem: PlanningProblem) -> dict[int, tuple[Event, ...]]:
    events: dict[int, tuple[Event, ...]] = {}
    first = 0
    for one in problem.toolpath.passes:
        events |= {first + index: what for index, what in one.events.items()}
        first += len(one)
    return events


def _remarks(problem: PlanningProblem, accepted: float | None) -> tuple[str, ...]:
    section = problem.workpiece.section
    lines = [f"{CELL_REMARK}{problem.name}"]
    if section is not None:
        lines.append(f"{BEAM_REMARK}{section.name}")
    lines.append(f"{DIGEST_REMARK}{problem_digest(problem)}")
    if accepted is not None:
        lines.append(f"{ACCEPTED_REMARK}{accepted * MM_PER_M:.3f} MM")
    return (*lines, "checked on the nominal model", "verify in T1")


def write_program(
    result: PlanningResult, path: Path, accepted_clearance: float | None = None
) -> WrittenProgram:
    """Write the result's program, read it back and check it; nothing is left when a check fails.

    `accepted_clearance` [m] is the least clearance that a person accepts where the safety
    distance cannot be met; it is stamped into the program.
    """
    problem = result.problem
    required = problem.settings.safety_distance
    least = result.sequence.least_clearance
    if accepted_clearance is not None and accepted_clearance < required and least < required:
        # As it will be stamped, so that what is checked now is what is checked later.
        accepted_clearance = round(accepted_clearance * MM_PER_M, 3) * MM
        if accepted_clearance <= 0.0:
            raise InputError("an accepted clearance must be at least 0.001 mm")
        required = accepted_clearance
    else:
        accepted_clearance = None
    if least < required:
        raise RefusedError(
            f"no program was written: the best sequence keeps only {_down(least)} mm of the "
            f"{required * MM_PER_M:g} mm asked; change the cell, or accept less with "
            f"--accept-clearance {_down(least)}"
        )
    program = build_program(result, path.stem, accepted_clearance=accepted_clearance)
    checks: list[Check] = []

    def verify(written: ProgramFile) -> None:
        checks.extend(check_program(problem, written, required_clearance(problem, written)))
        failed = [check for check in checks if not check.passed]
        if failed:
            lines = "; ".join(str(check) for check in failed)
            raise RefusedError(f"no program was written, since a check failed: {lines}")

    write_verified(program, path, verify)
    return WrittenProgram(path, tuple(checks))


def _down(clearance: float) -> str:
    """A clearance in mm, rounded down to 0.1 mm."""
    return f"{np.floor(clearance * MM_PER_M * 10.0) / 10.0:.1f}"


def check_program_settings(problem: PlanningProblem, path: Path) -> None:
    """Refuse, before anything is planned, what no program could be written with.

    The file's name, the frame and tool numbers, the comment and the remarks are rendered with
    a single position.
    """
    if path.suffix.upper() != ".LS":
        raise InputError(f"{path}: a FANUC program file ends in .LS")
    if not path.absolute().parent.is_dir():
        raise InputError(f"{path}: there is no folder {path.parent}")
    if path.exists() and not path.is_file():
        raise InputError(f"{path}: it exists and is no regular file")
    home = Move(joints=np.zeros(6), percent=problem.program.approach_percent)
    render_fanuc_joint(_program(problem, path.stem, (home,), None))


def required_clearance(problem: PlanningProblem, written: ProgramFile) -> float:
    """What the program has to keep [m]: the safety distance, or less where it says so."""
    accepted = accepted_clearance(problem, written)
    return problem.settings.safety_distance if accepted is None else accepted


def accepted_clearance(problem: PlanningProblem, written: ProgramFile) -> float | None:
    """The clearance below the safety distance that a program's remark accepts [m], or None."""
    for remark in written.remarks:
        if remark.startswith(ACCEPTED_REMARK):
            text = remark.removeprefix(ACCEPTED_REMARK).removesuffix("MM").strip()
            if not re.fullmatch(r"[0-9]{1,4}[.][0-9]{3}", text) or float(text) <= 0.0:
                raise InputError(f"{written.file}: remark {remark!r} names no clearance above 0")
            return min(float(text) * MM, problem.settings.safety_distance)
    return None


def check_program(
    problem: PlanningProblem, written: ProgramFile, least_clearance: float
) -> tuple[Check, ...]:
    """All checks of a program that was read from a file."""
    frames = {(one.first.uframe, one.first.utool) for one in written.positions.values()}
    frames |= {(move.uframe, move.utool) for move in written.moves}
    wanted = (problem.program.uframe, problem.program.utool)
    wrong = len(frames - {wanted})
    numbers = Check(
        "frame and tool numbers", wrong == 0, wrong, 0, "other", f"UF {wanted[0]}, UT {wanted[1]}"
    )
    flow = check_flow(written)
    named = Path(written.file).stem.upper() == written.name
    name = Check(
        "program name", named, int(not named), 0, "differing", f"{written.name} in {written.file}"
    )
    head = (name, flow, numbers, *_digest_check(problem, written))
    if not flow.passed:
        return head
    joints = written.path_joints()
    positions = check_positions(problem, joints, least_clearance)
    if len(joints) != len(problem.toolpath):
        return (*head, *positions)
    text = _text_check(problem, written, joints)
    return (*head, text, *positions, *check_motion(problem, joints, _durations(written)))


def _text_check(problem: PlanningProblem, written: ProgramFile, joints: FloatArray) -> Check:
    """Whether all but the joints is what posopt writes for this problem.

    Speeds, terminations, events, groups, axes, marks and remarks: whatever else stands in the
    file could move the robot otherwise than checked.
    """
    accepted = accepted_clearance(problem, written)
    expected = program_of(problem, rounded_joints(joints), written.name, accepted)
    found = list(islice(differences(expected, written), 100))
    detail = found[0] if found else "speeds, events, groups and remarks as the cell asks"
    if accepted is not None:
        detail += f"; ACCEPTED CLEARANCE {accepted * MM_PER_M:.3f} MM"
    return Check("program text", not found, len(found), 0, "differences", detail)


def _digest_check(problem: PlanningProblem, written: ProgramFile) -> tuple[Check, ...]:
    """Whether the program was written for this very cell, where it says for which one."""
    expected = problem_digest(problem)
    stated = [
        remark.removeprefix(DIGEST_REMARK).strip()
        for remark in written.remarks
        if remark.startswith(DIGEST_REMARK)
    ]
    other = sum(one != expected for one in stated)
    detail = f"written for {', '.join(stated)}, this cell is {expected}"
    return (Check("cell digest", not other, other, 0, "differing", detail),) if stated else ()


def _durations(written: ProgramFile) -> FloatArray:
    """(n,) time of each move [s], nan where the program gives a share of the speed."""
    factors = {"msec": 1e-3, "sec": 1.0}
    times = []
    for move in written.moves:
        known = move.speed.unit in factors and move.speed.value is not None
        seconds = float(move.speed.value or 0.0) * factors.get(move.speed.unit, np.nan)
        times += [seconds if known else np.nan] * len(move.positions)
    return np.array(times)
