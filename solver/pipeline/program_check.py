"""Every check of a program that was read from files: one list, before writing and after."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from solver.analysis.check import Check, unfinished
from solver.analysis.feed_checks import LineFeed, cycle_of, feed_checks, line_feeds, predictions
from solver.analysis.motion_checks import linear_check, motion_checks, net_check
from solver.analysis.order_checks import order_checks
from solver.analysis.position_checks import position_checks
from solver.analysis.spans import find_spans
from solver.analysis.trace import trace
from solver.errors import InputError, RefusedError
from solver.io.ls_findings import FindingKind
from solver.io.ls_hash import content_hash, stated_hash
from solver.io.ls_interpreter import Interpretation, interpret
from solver.io.ls_program import ProgramFile
from solver.io.ls_program_set import ProgramSet, program_set
from solver.kinematics.arm import forward
from solver.model.problem import PlanningProblem
from solver.model.program import JointProgram
from solver.model.toolpath import Event
from solver.motion.cycle_time import CycleTime
from solver.pipeline.digest import problem_digest
from solver.pipeline.remarks import (
    ACCEPTED_REMARK,
    CLEARANCE_REMARK,
    DIGEST_REMARK,
    POSE_REMARK,
    pose_remarks,
    remark_value,
    stated_clearance,
)
from solver.progress import Monitor
from solver.units import MM_PER_M

_NOTED = {FindingKind.WAITING}
"""Waiting for a signal leaves the way and the events as they are."""

_FRAMES = {FindingKind.FRAME_SELECTION, FindingKind.FRAME_CONFLICT}


@dataclass(frozen=True, slots=True, eq=False)
class ProgramReport:
    """What was found out about a program.

    `feeds` holds the predicted speed of every contact move and `cycle` the estimated time; they
    are empty and None where the motion could not be followed.
    """

    checks: tuple[Check, ...]
    positions: int = 0
    feeds: tuple[LineFeed, ...] = ()
    cycle: CycleTime | None = None

    @property
    def failed(self) -> tuple[Check, ...]:
        """The checks that did not pass."""
        return tuple(check for check in self.checks if not check.passed)


def check_program(
    problem: PlanningProblem,
    written: ProgramFile | ProgramSet,
    least_clearance: float,
    monitor: Monitor | None = None,
) -> tuple[Check, ...]:
    """All checks of a program that was read, with the programs that it calls.

    Nothing of a plan is used, only the cell; `least_clearance` [m] is what every contact
    position has to keep: the safety distance, or what was accepted.

    Raises
    ------
    Cancelled
        When the monitor asks for it.
    """
    programs = written if isinstance(written, ProgramSet) else program_set((written,))
    return inspect_program(problem, programs, least_clearance, monitor).checks


def inspect_program(
    problem: PlanningProblem,
    programs: ProgramSet,
    least_clearance: float,
    monitor: Monitor | None = None,
) -> ProgramReport:
    """Check a program that was read, and predict its feed and time; see `check_program`."""
    head = [_name_check(programs), *_stated_checks(problem, programs)]
    try:
        read = interpret(
            problem.robot, problem.user_frame, problem.user_tool, programs,
            offset=problem.program.offset,
        )  # fmt: skip
    except (InputError, RefusedError) as error:
        return ProgramReport((*head, unfinished("reach", "positions", str(error))))
    count = len(read.program.moves)
    head.append(Check("reach", True, 0, 0, "unreachable", f"{count} positions solved"))
    flow = _flow_check(read)
    head += [flow, _frame_check(problem, read), _count_check(read)]
    if not flow.passed:
        return ProgramReport(tuple(head), count)
    found = inspect_moves(problem, read.program, least_clearance, read.start_events, monitor)
    if problem.program.offset is not None:
        head.append(_offset_check(problem, read))
    stated = _clearance_statement(programs.main, found.checks)
    return replace(found, checks=(*head, *found.checks, *stated))


def restated(
    report: ProgramReport, problem: PlanningProblem, programs: ProgramSet
) -> ProgramReport:
    """The report with what the program says of itself compared again; its moves are the same."""
    stated = [
        _name_check(programs),
        *_stated_checks(problem, programs),
        *_clearance_statement(programs.main, report.checks),
    ]
    fresh = {check.name: check for check in stated}
    checks = [fresh.pop(check.name, check) for check in report.checks]
    return replace(report, checks=(*checks, *fresh.values()))


def inspect_moves(
    problem: PlanningProblem,
    program: JointProgram,
    least_clearance: float,
    start_events: tuple[Event, ...] = (),
    monitor: Monitor | None = None,
) -> ProgramReport:
    """The checks of the moves themselves, wherever they come from; see `check_program`."""
    followed = trace(problem, program, monitor)
    if isinstance(followed, str):
        linear = linear_check(problem.robot, program.moves)
        return ProgramReport((unfinished("motion", "moves", followed), linear), len(program.moves))
    positions = position_checks(followed, least_clearance)
    clearance = next(check for check in positions if check.name == "clearance")
    feeds = predictions(followed)
    checks = (
        *positions,
        *motion_checks(followed, feeds),
        net_check(followed, clearance.value / MM_PER_M),
        *feed_checks(followed, feeds),
        *order_checks(followed, start_events),
    )
    return ProgramReport(
        checks, len(program.moves), line_feeds(followed, feeds), cycle_of(followed, feeds)
    )


def _name_check(programs: ProgramSet) -> Check:
    files = list(programs.programs.values())
    wrong = [one for one in files if Path(one.file).stem.upper() != one.name]
    shown = wrong[0] if wrong else programs.main
    detail = f"{shown.name} in {shown.file}"
    return Check("program name", not wrong, len(wrong), 0, "differing", detail)


def _stated_checks(problem: PlanningProblem, programs: ProgramSet) -> list[Check]:
    """What the program says of itself: the cell it was made for, and its own content."""
    checks = []
    expected = problem_digest(problem)
    digest = remark_value(programs.main, DIGEST_REMARK)
    if digest is not None:
        detail = f"written for {digest}, this cell is {expected}"
        same = digest == expected
        checks.append(Check("cell digest", same, int(not same), 0, "differing", detail))
    stated = stated_hash(programs.main)
    found = content_hash(programs.programs.values())
    if stated is not None:
        same = stated == found
        detail = f"states {stated}, its content is {found}"
        checks.append(Check("hash", same, int(not same), 0, "differing", detail))
    accepted = remark_value(programs.main, ACCEPTED_REMARK)
    if accepted is not None:
        sound = stated == found
        detail = f"{accepted} stands in a remark" + ("" if sound else " without a matching hash")
        checks.append(Check("accepted clearance", sound, int(not sound), 0, "unproven", detail))
    return [*checks, *_frame_statements(problem, programs.main)]


def _frame_statements(problem: PlanningProblem, main: ProgramFile) -> list[Check]:
    """What remarks say of user frame and tool, which a person may copy into the controller."""
    expected = set(pose_remarks(problem))
    stated = [one.strip() for one in main.remarks if POSE_REMARK.match(one)]
    if not stated:
        return []
    wrong = [one for one in stated if one not in expected]
    detail = f"{wrong[0]!r} is not the cell's" if wrong else "as in the cell"
    return [Check("stated frames", not wrong, len(wrong), 0, "differing", detail)]


def _flow_check(read: Interpretation) -> Check:
    """Whether the text does what the checks assume: plain J and L moves, in order."""
    findings = [one for one in read.findings if one.kind not in _FRAMES | _NOTED]
    notes = [str(one) for one in read.findings if one.kind in _NOTED]
    detail = str(findings[0]) if findings else "J and L moves in order"
    if read.unresolved:
        names = ", ".join(read.unresolved)
        notes.append(f"programs that are not beside it are assumed not to move: {names}")
    if notes and not findings:
        detail = "; ".join([detail, *notes])
    return Check(
        "program flow", not findings, len(findings), 0, "unknown", detail, assumed=bool(notes)
    )


def _frame_check(problem: PlanningProblem, read: Interpretation) -> Check:
    findings = [one for one in read.findings if one.kind in _FRAMES]
    detail = f"UF {problem.user_frame.number}, UT {problem.user_tool.number}"
    if findings:
        detail += f"; {findings[0]}"
    return Check("frame and tool numbers", not findings, len(findings), 0, "other", detail)


def _offset_check(problem: PlanningProblem, read: Interpretation) -> Check:
    """The offset is added to contact moves and to no others: one without it would cut in."""
    joints = read.program.joints
    tcp = forward(problem.robot, joints, problem.tool.tcp)[:, :3, 3]
    spans = find_spans(problem, tcp) or ()
    wanted = {row for span in spans for row in range(span.first, span.last + 1)}
    if not read.offset_moves:
        # Joint positions cannot carry one; they state none at all.
        wanted = set() if all(read.in_joints) else wanted
    wrong = sorted(wanted ^ set(read.offset_moves))
    register = f"PR[{problem.program.offset}]"
    detail = f"Offset,{register} on contact moves alone"
    if wrong:
        detail = f"Offset,{register} missing or misplaced at {read.program.moves[wrong[0]].source}"
    return Check("offset", not wrong, len(wrong), 0, "moves", detail)


def _count_check(read: Interpretation) -> Check:
    """Every position of /POS is the end of exactly one motion."""
    idle = [(one.file, number) for one in read.position_use for number in one.unused_numbers]
    again = [(one.file, number) for one in read.position_use for number in one.repeated_numbers]
    detail = f"{len(read.program.moves)} moves, each with a position of its own"
    if idle:
        detail = f"no motion goes to P[{idle[0][1]}] of {idle[0][0]}"
    elif again:
        detail = f"several motions go to P[{again[0][1]}] of {again[0][0]}"
    return Check("position count", not idle, len(idle), 0, "unused", detail)


def _clearance_statement(main: ProgramFile, checks: tuple[Check, ...]) -> list[Check]:
    stated = stated_clearance(main, CLEARANCE_REMARK)
    found = [check.value for check in checks if check.name == "clearance"]
    if stated is None or not found:
        return []
    value = stated * MM_PER_M
    sound = value <= found[0] + 1e-6
    return [Check("stated clearance", sound, value, found[0], "mm", "not above what was found")]
