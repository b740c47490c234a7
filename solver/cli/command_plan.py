"""`posopt plan`: the main job, from a cell to a written and checked program."""

from __future__ import annotations

import argparse
import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from solver.cli.arguments import positive_number
from solver.cli.output import TerminalMonitor, emit_json, refused, say
from solver.errors import RefusedError
from solver.model.settings import Scheme
from solver.units import MM

if TYPE_CHECKING:
    from solver.pipeline.programming import WrittenProgram

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
    parser.add_argument("--no-program", action="store_true", help="plan only, write no program")
    parser.add_argument(
        "--accept-clearance",
        metavar="MM",
        help="accept this least clearance where the safety distance cannot be met",
    )


def run(options: argparse.Namespace) -> int:
    """Plan, write and report."""
    from solver.analysis.report import result_document, summary
    from solver.catalog import load_cell
    from solver.pipeline.planning import plan
    from solver.pipeline.programming import check_program_settings, write_program

    accepted = None
    if options.accept_clearance is not None:
        accepted = positive_number(options.accept_clearance, "--accept-clearance") * MM
    problem = load_cell(options.cell, beam=options.beam, path=options.path)
    if options.scheme:
        scheme = Scheme(options.scheme)
        problem = replace(problem, settings=replace(problem.settings, scheme=scheme))
    target = Path(f"{problem.program.name}.LS" if options.out is None else options.out)
    if not options.no_program:
        check_program_settings(problem, target)
    monitor = TerminalMonitor()
    started = time.perf_counter()
    try:
        result = plan(problem, monitor, compare=(Scheme.EXACT, Scheme.F2))
    finally:
        monitor.close()
    seconds = time.perf_counter() - started
    written = None
    refusal = None
    if not options.no_program:
        try:
            written = write_program(result, target, accepted)
        except RefusedError as error:
            refusal = error
    if options.as_json != "-":
        say(summary(result))
        say(f"planned in {seconds:.2f} s")
    if options.as_json:
        emit_json(result_document(result, written, refusal), options.as_json)
    if refusal is not None:
        return refused(options.command, refusal)
    if written is not None and options.as_json != "-":
        _report(written, needless=accepted is not None and result.clearance_met)
    return 0


def _report(written: WrittenProgram, *, needless: bool) -> None:
    """Say what was written, and how near it comes at its positions and between them."""
    for check in written.checks:
        if check.name.startswith(("clearance", "between")):
            say(str(check))
    if needless:
        say("the safety distance is met; --accept-clearance was not needed")
    say(
        f"wrote {written.path}: {len(written.checks)} checks passed after reading it back "
        "(nominal model; verify in T1)"
    )
