"""`posopt plan`: the main job, from a cell to a written and checked program."""

from __future__ import annotations

import argparse
import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from solver.cli.arguments import add_resample, positive_number, resampled
from solver.cli.output import TerminalMonitor, emit_json, refused, say
from solver.errors import RefusedError
from solver.model.settings import Scheme
from solver.units import MM

if TYPE_CHECKING:
    from solver.model.problem import PlanningProblem
    from solver.pipeline.programming import ProgramOrder, WrittenProgram

HELP = "plan a cell, write its program and print the summary"
DEFAULT_CELL = "groove_hw300"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of this command."""
    parser.add_argument(
        "cell",
        nargs="?",
        default=DEFAULT_CELL,
        metavar="CELL",
        help=f"name or TOML file of a cell (default {DEFAULT_CELL})",
    )
    parser.add_argument("--path", metavar="F", help="another path file for the cell")
    add_resample(parser)
    parser.add_argument("--beam", metavar="NAME", help="another beam, such as HW250 or HEA200")
    parser.add_argument(
        "--scheme",
        choices=[scheme.value for scheme in Scheme],
        help="exact (proven optimum), or f, f1, f2 of the paper (default: the cell's)",
    )
    parser.add_argument(
        "--out",
        metavar="NAME.LS",
        help="where the program is written (default: the cell's program name in this folder)",
    )
    parser.add_argument(
        "--post",
        metavar="NAME",
        help="fanuc-joint, fanuc-cartesian, csv or json (default: the cell's)",
    )
    parser.add_argument(
        "--simplify",
        metavar="TOL",
        help="drop positions while the moved TCP stays within TOL mm of the path",
    )
    parser.add_argument("--no-program", action="store_true", help="plan only, write no program")
    parser.add_argument(
        "--accept-clearance",
        metavar="MM",
        help="accept this least clearance where the safety distance cannot be met",
    )
    parser.add_argument(
        "--override",
        metavar="REASON",
        help="write NAME_OVR.LS although checks fail; the reason is stamped into it",
    )


def run(options: argparse.Namespace) -> int:
    """Plan, write and report."""
    from solver.analysis.report import result_document, summary
    from solver.catalog import load_cell
    from solver.io.posts import post_named
    from solver.pipeline.planning import plan
    from solver.pipeline.programming import check_order, write_program

    order = _order(options)
    problem = load_cell(options.cell, beam=options.beam, path=options.path)
    problem = resampled(_titled(problem, options), options.resample)
    if options.scheme:
        scheme = Scheme(options.scheme)
        problem = replace(problem, settings=replace(problem.settings, scheme=scheme))
    suffix = post_named(order.post or problem.program.post).suffix
    target = Path(f"{problem.program.name}{suffix}" if options.out is None else options.out)
    if not options.no_program:
        check_order(problem, target, order)
    monitor = TerminalMonitor()
    written = None
    refusal = None
    started = time.perf_counter()
    try:
        result = plan(problem, monitor, compare=(Scheme.EXACT, Scheme.F2))
        seconds = time.perf_counter() - started
        if not options.no_program:
            try:
                written = write_program(result, target, order, monitor)
            except RefusedError as error:
                refusal = error
    finally:
        monitor.close()
    if options.as_json != "-":
        say(summary(result))
        say(f"planned in {seconds:.2f} s")
    if options.as_json:
        emit_json(result_document(result, written, refusal), options.as_json)
    if refusal is not None:
        return refused(options.command, _with_hint(refusal, options))
    if written is not None and options.as_json != "-":
        needless = order.accepted_clearance is not None and result.clearance_met
        count = None if order.simplify is None else len(problem.toolpath)
        _report(written, needless=needless, of_waypoints=count)
    return 0


def _titled(problem: PlanningProblem, options: argparse.Namespace) -> PlanningProblem:
    """The problem with what was put in place of the cell's own in its title."""
    beam = f"beam {problem.workpiece.name}" if options.beam else ""
    path = f"path {Path(options.path).name}" if options.path else ""
    changed = " and ".join(one for one in (beam, path) if one)
    if not changed:
        return problem
    return replace(problem, title=f"{problem.title or problem.name}; here with {changed}")


def _with_hint(refusal: RefusedError, options: argparse.Namespace) -> RefusedError:
    """The refusal, and what to do where the robot leaves the path between distant points."""
    if options.resample is not None or "path between positions" not in str(refusal):
        return refusal
    hint = "if the points of the path are far apart, --resample 10 puts one at least every 10 mm"
    return RefusedError(f"{refusal}; {hint}")


def _order(options: argparse.Namespace) -> ProgramOrder:
    from solver.io.posts import post_named
    from solver.pipeline.programming import ProgramOrder

    accepted = simplify = None
    if options.accept_clearance is not None:
        accepted = positive_number(options.accept_clearance, "--accept-clearance") * MM
    if options.simplify is not None:
        simplify = positive_number(options.simplify, "--simplify") * MM
    if options.post is not None:
        post_named(options.post)
    return ProgramOrder(accepted, options.post, simplify, options.override)


_SHOWN = ("clearance", "between", "links", "net", "path between", "feed")


def _report(written: WrittenProgram, *, needless: bool, of_waypoints: int | None) -> None:
    """Say what was written, how near it comes, how fast it runs, and what failed.

    `of_waypoints` is how many waypoints there were to simplify, None where that was not asked.
    """
    for check in written.checks:
        if check.name.startswith(_SHOWN) or not check.passed:
            say(str(check))
    if written.report.cycle is not None:
        cycle = written.report.cycle
        say(
            f"estimated cycle {cycle.total:.1f} s: {cycle.grinding:.1f} s grinding, "
            f"{cycle.linking:.1f} s on links, {cycle.waiting:.1f} s waiting "
            "(accelerations are assumed)"
        )
    if of_waypoints is not None:
        kept = sum(move.waypoint is not None for move in written.program.moves)
        dropped = of_waypoints - kept
        say(
            f"--simplify dropped {dropped} of {of_waypoints} positions"
            if dropped
            else "--simplify dropped no position: the program needs every one to keep what is asked"
        )
    if needless:
        say("the safety distance is met; --accept-clearance was not needed")
    names = ", ".join(map(str, written.paths))
    failed = len(written.report.failed)
    count = len(written.checks)
    if written.stale:
        stale = ", ".join(map(str, written.stale))
        say(f"parts of an earlier program still lie there, nothing calls them: {stale}")
    if written.override is not None:
        say(
            f"wrote {names} although {failed} of {count} checks failed: override "
            f"{written.override!r}, stamped into it"
        )
        return
    say(
        f"wrote {names}: {written.report.positions} positions, {count} checks passed after "
        "reading it back (nominal model; verify in T1)"
    )
